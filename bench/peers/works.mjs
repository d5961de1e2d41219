// What is measured: the works of bench/works.cpp, the peers, and what each leaves out of a work.

const named = (file, ...names) => names.map((name) => ({ name, file, ibl: !name.endsWith('L') }));

/** In the order of bench/cost.json. */
export const kWorks = [
  ...named('w0', 'W0L', 'W0'), ...named('w1', 'W1L', 'W1'), ...named('w1off', 'W1off'), ...named('w2', 'W2'),
  ...named('w3', 'W3L', 'W3'), ...named('a', 'AL', 'A'), ...named('b', 'BL', 'B'), ...named('c', 'CL', 'C'),
];

/** What is behind a transmitting ball is another picture in every renderer. */
export const kNotDrawn = new Set(['BL', 'B']);

const kCoat = 'KHR_materials_coat';

/** The coat as a renderer knows it that has none but KHR_materials_clearcoat: what an exporter writes for it. */
function withClearcoat(work) {
  const [material] = work.materials, { [kCoat]: coat, ...others } = material.extensions;
  const clearcoat = { clearcoatFactor: coat.coatFactor, clearcoatRoughnessFactor: coat.coatRoughnessFactor };
  return {
    ...work,
    extensionsUsed: work.extensionsUsed.map((name) => (name === kCoat ? 'KHR_materials_clearcoat' : name)),
    materials: [{ ...material, extensions: { ...others, KHR_materials_clearcoat: clearcoat } }],
  };
}

const kNoCoat = "the coat's IOR, colour, darkening and anisotropy (it has no `KHR_materials_coat`; measured is a clearcoat)";

/** MaterialX's lobes read a tangent, whether they are anisotropic or not. */
function withTangents(work) {
  const [primitive] = work.meshes[0].primitives, attributes = { POSITION: 0, NORMAL: 1, TANGENT: 2, TEXCOORD_0: 3 };
  return { ...work, meshes: [{ primitives: [{ ...primitive, attributes }] }] };
}

const kMaterialX = {
  package: 'materialx', page: 'materialx', adapt: withTangents,
  leavesOut: {
    w3: "the rotation of the coat's anisotropy (`open_pbr_surface` has none)",
    b: 'what is behind the ball (it refracts the environment) and the attenuation (the generator drops volumes)',
  },
  differs: 'its numbers are constants, where all others have uniforms; compensates direct light, too; the diffuse lobe gets what the ' +
    "specular albedo by the view leaves, from a fit; a film's Fresnel by two terms of Airy's sum",
};

/**
 * `package` tells the version; `page` is the script in pages/; `leavesOut` has, for files of works, what the peer does not
 * draw: such a figure is not for the same work. `differs` is what its text and its pictures show. `environment` is MaterialX's
 * way to image-based light: see materialx.mjs.
 */
export const kPeers = [
  {
    name: 'khronos', title: 'Khronos glTF Sample Renderer', package: '@khronosgroup/gltf-viewer', page: 'khronos',
    leavesOut: { w3: kNoCoat }, fallback: { w3: withClearcoat },
    differs: 'compensates in the environment alone, with a Fresnel that roughness bounds (the rims of the pictures); weighs the ' +
      "coat's split sum by the view's Fresnel; one bent tap for an anisotropic environment; a third table of the sheen is never " +
      'uploaded in this version, so that nothing is dimmed under a sheen',
  },
  {
    name: 'three', title: 'three.js', package: 'three', page: 'three',
    leavesOut: { w3: kNoCoat }, fallback: { w3: withClearcoat },
    differs: 'compensates direct light, too; one mixed reflectance in direct light; widens roughness by the derivatives of the normal, ' +
      'which blunts highlights; a sheen with the visibility of Neubelt; one bent tap for an anisotropic environment',
  },
  {
    name: 'babylon', title: 'Babylon.js (PBR)', package: '@babylonjs/core', page: 'babylon',
    leavesOut: { w3: "the coat's darkening and anisotropy" },
    differs: 'compensates direct light, too; one mixed reflectance of dielectric and metal, and one film over it; diffuse environment ' +
      'from spherical harmonics, without a lookup; fades reflections below the horizon; a coat of the visibility of Kelemen, under ' +
      "which direct light is weighed by the half vector's Fresnel; a sheen with the visibility of Ashikhmin; one bent tap for an " +
      'anisotropic environment',
  },
  {
    name: 'babylon_openpbr', title: 'Babylon.js (OpenPBR)', package: '@babylonjs/core', page: 'babylon', openpbr: true, leavesOut: {},
    differs: "OpenPBR's layers: a clearcoat darkens what is below it and makes it rougher, a sheen is a fuzz; diffuse environment from " +
      'spherical harmonics; 16 taps of the environment for an anisotropic lobe, in a loop that the estimate counts eightfold; in ' +
      'direct light the slope of an anisotropic lobe is squared once more, which makes highlights narrower and brighter',
  },
  {
    ...kMaterialX, name: 'materialx_sampled', title: 'MaterialX (sampled)', environment: 'sampled',
    differs: `${kMaterialX.differs}; its default environment, 16 samples for each lobe, in loops that the estimate counts eightfold ` +
      'where the driver does not unroll them',
  },
  {
    ...kMaterialX, name: 'materialx_prefiltered', title: 'MaterialX (prefiltered)', environment: 'prefiltered',
    differs: 'as above, with one lookup for each lobe, which knows no anisotropy',
  },
];

/** Those of the gallery: MaterialX's two ways to an environment show the same one that is alike from all sides. */
export const kGalleryPeers = kPeers.filter(({ environment }) => environment !== 'sampled');

/** The work as a peer gets it. */
export const asFor = (peer, file, work) => (peer.fallback?.[file] ?? peer.adapt ?? ((same) => same))(work);
