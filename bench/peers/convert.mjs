// From the GLSL ES of WebGL 2 to what glslang takes for Vulkan with relaxed rules (uniforms outside of blocks, bindings and
// locations by itself). GLSL 4.50 it becomes, and not ES 3.10: that would forbid functions that are named as built-in ones.

/** Extensions of WebGL 2 that need no directive in GLSL 4.50, which has what they add. */
const kIncluded = /^\s*#\s*extension\s+GL_(OES_standard_derivatives|OES_texture_3D|EXT_(shader_texture_lod|frag_depth|draw_buffers))\b/;
const kVersion = /^\s*#\s*version\s+(.*?)\s*$/;
const kPrecision = /\bprecision\s+(lowp|mediump|highp)\s+\w+\s*;/g;
/** Names in GLSL ES 3.00, words of the language in GLSL for Vulkan. */
const kWords = /\b(buffer|precise|sampler|samplerShadow|shared|subpassInput)\b/g;
const kHead = ['#version 450', 'precision highp float;', 'precision highp int;'];

/** The text without comments, each line where it was. */
function withoutComments(text) {
  return text.replace(/\/\*[\s\S]*?\*\/|\/\/[^\n]*/g, (comment) => comment.replace(/[^\n]+/g, ' '));
}

/**
 * The fragment shader as GLSL 4.50 for `glslangValidator -V -R --auto-map-bindings --auto-map-locations`. All of it is `highp`,
 * as ours are: a compiler for desktops ignores less, and glslang must not mark it. Throws where the text is not GLSL ES 3.00.
 */
export function vulkanGlsl(source) {
  const lines = withoutComments(source.replace(/\r\n?/g, '\n')).split('\n');
  const first = lines.findIndex((line) => line.trim() !== '');
  const version = kVersion.exec(lines[first] ?? '')?.[1];
  if (version !== '300 es') {
    throw new Error(`the shader is not of "#version 300 es" but of ${version ? `"#version ${version}"` : 'no version'}`);
  }
  const body = lines.slice(first + 1).map((line) => {
    if (kIncluded.test(line)) return '';
    // A precision stands in macros, too, in `#ifdef`s or among other code; after the head it has nothing left to say.
    return line.replace(kPrecision, '').replace(/\b(lowp|mediump)\b/g, 'highp').replace(kWords, '$1_');
  });
  return [...kHead, ...body].join('\n').replace(/\n{3,}/g, '\n\n');
}
