// Watches WebGL 2 while another renderer draws: the text of the fragment shader that draws the ball, and its colours as
// floats, before anything is stored with 8 bits.
const sources = new WeakMap();
const fragmentOf = new WeakMap();
const gl2 = WebGL2RenderingContext.prototype;
const original = {};
let wanted = null;

function wrap(name, before) {
  original[name] = gl2[name];
  gl2[name] = function (...args) {
    before(this, ...args);
    return original[name].apply(this, args);
  };
}

wrap('shaderSource', (gl, shader, text) => sources.set(shader, text));
wrap('attachShader', (gl, program, shader) => {
  if (gl.getShaderParameter(shader, gl.SHADER_TYPE) === gl.FRAGMENT_SHADER) fragmentOf.set(program, shader);
});

/** What is bound when a program draws: its lone uniforms by their paths, and the bytes of its blocks by their names. */
function boundTo(gl, program) {
  const uniforms = {}, blocks = {};
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
    const { name, size } = gl.getActiveUniform(program, i), bare = name.replace(/\[0\]$/, '');
    for (let k = 0; k < size; ++k) {
      const path = bare === name ? name : `${bare}[${k}]`, location = gl.getUniformLocation(program, path);
      const value = location && gl.getUniform(program, location);
      if (value !== null) uniforms[path] = typeof value === 'object' ? [...value].map(Number) : Number(value);
    }
  }
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORM_BLOCKS); ++i) {
    const place = gl.getActiveUniformBlockParameter(program, i, gl.UNIFORM_BLOCK_BINDING);
    const size = gl.getActiveUniformBlockParameter(program, i, gl.UNIFORM_BLOCK_DATA_SIZE);
    const buffer = gl.getIndexedParameter(gl.UNIFORM_BUFFER_BINDING, place), was = gl.getParameter(gl.UNIFORM_BUFFER_BINDING);
    const bytes = new Uint8Array(size);
    gl.bindBuffer(gl.UNIFORM_BUFFER, buffer);
    gl.getBufferSubData(gl.UNIFORM_BUFFER, gl.getIndexedParameter(gl.UNIFORM_BUFFER_START, place), bytes);
    gl.bindBuffer(gl.UNIFORM_BUFFER, was);
    blocks[gl.getActiveUniformBlockName(program, i)] = [...bytes];
  }
  return { uniforms, blocks };
}

/** A picture in 32-bit floats with depth, in place of what is bound. */
function floatTarget(gl, size) {
  if (!gl.getExtension('EXT_color_buffer_float')) throw new Error('the browser draws no floats');
  const target = gl.createFramebuffer(), color = gl.createRenderbuffer(), depth = gl.createRenderbuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  const attach = (buffer, format, place) => {
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, format, size, size);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
  };
  attach(color, gl.RGBA32F, gl.COLOR_ATTACHMENT0);
  attach(depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT);
  return target;
}

/** Draws what was about to be drawn into a target of its own, and puts back what was bound. */
function drawAside(gl, draw) {
  const bound = [
    gl.getParameter(gl.DRAW_FRAMEBUFFER_BINDING), gl.getParameter(gl.READ_FRAMEBUFFER_BINDING),
    gl.getParameter(gl.RENDERBUFFER_BINDING), gl.getParameter(gl.VIEWPORT), gl.getParameter(gl.PIXEL_PACK_BUFFER_BINDING),
  ];
  const { size } = wanted;
  const target = floatTarget(gl, size);
  if (bound[4]) gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
  gl.viewport(0, 0, size, size);
  gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
  gl.clearBufferfv(gl.DEPTH, 0, [1]);
  draw();
  const pixels = new Float32Array(size * size * 4);
  gl.readPixels(0, 0, size, size, gl.RGBA, gl.FLOAT, pixels);
  gl.deleteFramebuffer(target);
  gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, bound[0]);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, bound[1]);
  gl.bindRenderbuffer(gl.RENDERBUFFER, bound[2]);
  gl.viewport(...bound[3]);
  if (bound[4]) gl.bindBuffer(gl.PIXEL_PACK_BUFFER, bound[4]);
  return pixels;
}

wrap('drawElements', (gl, ...args) => {
  if (!wanted || args[1] !== wanted.indices) return;
  const { found } = wanted, program = gl.getParameter(gl.CURRENT_PROGRAM);
  found.source = sources.get(fragmentOf.get(program));
  found.bound = boundTo(gl, program);
  found.pixels = drawAside(gl, () => original.drawElements.apply(gl, args));
  found.error = gl.getError();
});

/** Calls `draw`, which draws one frame; the last draw of the ball in it. */
export async function capture({ size, indices }, draw) {
  wanted = { size, indices, found: {} };
  await draw();
  const { found } = wanted;
  wanted = null;
  if (!found.source) throw new Error('nothing drew the ball');
  if (found.error) throw new Error(`WebGL error ${found.error}`);
  return { source: found.source, bound: found.bound, pixels: [...found.pixels] };
}

/** A canvas of the picture's size on the page. */
export function canvasOf({ size }) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  document.body.replaceChildren(canvas);
  return canvas;
}
