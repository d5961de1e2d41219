// Shadows on the materials, as three.js computes them for its own: by its pieces of shaders, which are of the version that the
// application has, and of which each light's radiance takes its share.

/** A kind of three.js's shadows, by our uniform that has the element of the block Lights for each: what marks the light, what
 * three.js calls the kind, its function, and what of a shadow that takes beside the map. */
export const kShadows: Record<string, { light: string; count: string; call: string; under: string }> = {
  shadowed_directional: {
    light: 'isDirectionalLight', count: 'NUM_DIR_LIGHT_SHADOWS', under: '', call: call('getShadow', 'directional', 'directionalLight', 'vDirectionalShadowCoord[ i ]'),
  },
  shadowed_spot: {
    light: 'isSpotLight', count: 'NUM_SPOT_LIGHT_SHADOWS', under: '', call: call('getShadow', 'spot', 'spotLight', 'vSpotLightCoord[ i ]'),
  },
  shadowed_point: {
    light: 'isPointLight', count: 'NUM_POINT_LIGHT_SHADOWS', under: ' && !defined(SHADOWMAP_TYPE_VSM)', // which three.js has not for it
    call: call('getPointShadow', 'point', 'pointLight', 'vPointShadowCoord[ i ]', ['shadowCameraNear', 'shadowCameraFar']),
  },
};

function call(name: string, kind: string, light: string, coordinate: string, more: string[] = []): string {
  const of = (fields: string[]) => fields.map((field) => `${light}Shadows[ i ].${field}`);
  const given = [...of(['shadowMapSize', 'shadowIntensity', 'shadowBias', 'shadowRadius']), coordinate, ...of(more)];
  return `${name}(${kind}ShadowMap[ i ], ${given.join(', ')})`;
}

interface Added {
  /** Before the stage's text. */
  before: string[];
  /** In main(). */
  fill: string[];
}

/** Lines for scenes with shadows alone. */
const where = (lines: string[]): string[] => ['#ifdef USE_SHADOWMAP', ...lines, '#endif'];

/** Behind surface(), where three.js's names for the vertex are known: where it is on each map. */
export function vertexShadows(essl: string): Added {
  const normal = /^out vec3 v_normal;$/m.test(essl) ? 'mat3(viewMatrix) * v_normal' : 'vec3(0.0)';
  return {
    before: where(['#include <common>', '#include <shadowmap_pars_vertex>']),
    fill: where([
      '    vec4 worldPosition = lacquer_world;',
      `    vec3 transformedNormal = ${normal};`, '#include <shadowmap_vertex>',
    ]),
  };
}

/** Before surface(): how much of each light arrives. One element more stands for lights that the block has no room for. */
export function fragmentShadows(size: number): Added {
  const kinds = Object.entries(kShadows).flatMap(([uniform, { count, under, call }]) => [
    // Maps are samplers, which only a constant finds: three.js writes the loop out.
    `#if ${count} > 0${under}`, '#pragma unroll_loop_start', `for ( int i = 0; i < ${count}; i ++ ) {`,
    `    unshadowed[${uniform}[ i ]] = ${call};`, '}', '#pragma unroll_loop_end', '#endif',
  ]);
  return {
    before: where([
      '#ifndef PI2', '#define PI2 6.283185307179586', '#endif', '#include <packing>', '#include <shadowmap_pars_fragment>',
      'uniform bool receiveShadow;', ...Object.keys(kShadows).map((uniform) => `uniform int ${uniform}[${size}];`), `float unshadowed[${size + 1}];`,
    ]),
    fill: where([`    for (int i = 0; i <= ${size}; ++i) unshadowed[i] = 1.0;`, '    if (receiveShadow) {', ...kinds, '    }']),
  };
}

/** A fragment stage whose lights are dimmed by shadows. */
export function shadowed(text: string): string {
  const dimmed = '#ifdef USE_SHADOWMAP\n#define RADIANCE(i) (lights[i].radiance * unshadowed[i])\n#else\n#define RADIANCE(i) lights[i].radiance\n#endif';
  return text.replace(/lights\[(\w+)\]\.radiance\b/g, 'RADIANCE($1)').replace(/^void surface\(\)/m, `${dimmed}\n\nvoid surface()`);
}
