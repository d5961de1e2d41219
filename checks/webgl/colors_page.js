// What runs in the page for lacquer-essl-colors: every point is a pixel of float targets, covered by a triangle of its
// own with the same inputs at its corners.
'use strict';

var gl = null;

/// Numbers are not discarded colours when they are this.
var kUntouched = -1.5e38;

function openContext() {
  gl = document.createElement('canvas').getContext('webgl2', {antialias: false});
  if (!gl || !gl.getExtension('EXT_color_buffer_float')) return null;
  gl.getExtension('OES_texture_float_linear');
  return gl.getParameter(gl.RENDERER);
}

function vertexText(inputs) {
  const type = (components) => components === 1 ? 'float' : `vec${components}`;
  const attributes = inputs.map((i, n) => `layout(location = ${n}) in ${type(i.components)} a${n};\n`);
  const results = inputs.map((i) => `out ${type(i.components)} ${i.name};\n`);
  const copies = inputs.map((i, n) => `    ${i.name} = a${n};\n`);
  return `#version 300 es
uniform bool back;
${attributes.join('')}${results.join('')}
void main() {
    float x = gl_VertexID == 1 ? 3.0 : -1.0;
    float y = gl_VertexID == 2 ? 3.0 : -1.0;
    gl_Position = back ? vec4(y, x, 0.5, 1.0) : vec4(x, y, 0.5, 1.0);
${copies.join('')}}\n`;
}

function compiled(type, text) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

function programOf(work) {
  const program = gl.createProgram();
  gl.attachShader(program, compiled(gl.VERTEX_SHADER, vertexText(work.inputs)));
  gl.attachShader(program, compiled(gl.FRAGMENT_SHADER, work.essl));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

function bytesOf(text) {
  return Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
}

/// Each block's buffer, bound where it is; what each point binds anew is returned as a function of the point.
function bindBlocks(work, program) {
  const alignment = gl.getParameter(gl.UNIFORM_BUFFER_OFFSET_ALIGNMENT);
  const blocks = work.blocks.map((block, place) => {
    const index = gl.getUniformBlockIndex(program, block.name);
    if (index === gl.INVALID_INDEX) return null;
    gl.uniformBlockBinding(program, index, place);
    const bytes = bytesOf(block.bytes);
    const size = block.perPoint ? bytes.length / work.points : bytes.length;
    const stride = Math.ceil(size / alignment) * alignment;
    const copies = block.perPoint ? work.points : 1;
    const data = new Uint8Array(stride * copies);
    for (let i = 0; i < copies; ++i) data.set(bytes.subarray(i * size, (i + 1) * size), i * stride);
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.UNIFORM_BUFFER, buffer);
    gl.bufferData(gl.UNIFORM_BUFFER, data, gl.STATIC_DRAW);
    return {place, buffer, size, stride: block.perPoint ? stride : 0};
  }).filter((block) => block !== null);
  return (point) => {
    for (const {place, buffer, size, stride} of blocks)
      gl.bindBufferRange(gl.UNIFORM_BUFFER, place, buffer, point * stride, size);
  };
}

/// A list's bytes as the texels of a texture of integers, row by row.
function listTexture(list, work, point) {
  const bytes = bytesOf(list.bytes);
  const size = list.perPoint ? bytes.length / work.points : bytes.length;
  const own = bytes.subarray((list.perPoint ? point : 0) * size).subarray(0, size);
  const width = Math.min(1024, Math.max(1, Math.ceil(size / 16)));
  const height = Math.max(1, Math.ceil(size / 16 / width));
  const padded = new Uint8Array(16 * width * height);
  padded.set(own);
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32UI, width, height, 0, gl.RGBA_INTEGER, gl.UNSIGNED_INT,
                new Uint32Array(padded.buffer));
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  return texture;
}

/// A cube has one colour: of each point, or of all.
function cubeColor(texture, point) {
  const at = texture.texels.length > 4 ? 4 * point : 0;
  return texture.texels.slice(at, at + 4);
}

function targetOf(image) {
  return {cube: gl.TEXTURE_CUBE_MAP, '2d-array': gl.TEXTURE_2D_ARRAY}[image.shape] ?? gl.TEXTURE_2D;
}

function uploadTexels(image, target, point) {
  if (image.compares) {
    const depths = Float32Array.from({length: image.width * image.height}, (_, i) => image.texels[4 * i]);
    gl.texImage2D(target, 0, gl.DEPTH_COMPONENT32F, image.width, image.height, 0, gl.DEPTH_COMPONENT, gl.FLOAT, depths);
    gl.texParameteri(target, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.texParameteri(target, gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
  } else if (image.shape === '2d-array') {
    const layers = image.texels.length / (4 * image.width * image.height);
    gl.texImage3D(target, 0, gl.RGBA32F, image.width, image.height, layers, 0, gl.RGBA, gl.FLOAT,
                  new Float32Array(image.texels));
  } else if (image.shape === 'cube') {
    const texel = new Float32Array(cubeColor(image, point));
    for (let face = 0; face < 6; ++face)
      gl.texImage2D(gl.TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, gl.RGBA32F, 1, 1, 0, gl.RGBA, gl.FLOAT, texel);
  } else {
    gl.texImage2D(target, 0, gl.RGBA32F, image.width, image.height, 0, gl.RGBA, gl.FLOAT,
                  new Float32Array(image.texels));
  }
}

function imageTexture(image, point) {
  const target = targetOf(image);
  const texture = gl.createTexture();
  gl.bindTexture(target, texture);
  uploadTexels(image, target, point);
  const wraps = {repeat: gl.REPEAT, clamp: gl.CLAMP_TO_EDGE, mirror: gl.MIRRORED_REPEAT};
  gl.texParameteri(target, gl.TEXTURE_WRAP_S, wraps[image.wrap[0]]);
  gl.texParameteri(target, gl.TEXTURE_WRAP_T, wraps[image.wrap[1]]);
  const filter = image.nearest || image.shape === 'cube' ? gl.NEAREST : gl.LINEAR;
  gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, filter);
  return texture;
}

/// Textures by unit; of those that points have for themselves, the one that this point has.
function bindTextures(work, program) {
  const all = [...work.lists.map((list) => ({...list, list: true})), ...work.textures];
  all.forEach((one, unit) => gl.uniform1i(gl.getUniformLocation(program, one.name), unit));
  const cache = new Map();
  return (point) => all.forEach((one, unit) => {
    const own = one.list ? one.perPoint : one.shape === 'cube' && one.texels.length > 4;
    const key = `${unit} ${own ? point : ''}`;
    gl.activeTexture(gl.TEXTURE0 + unit);
    if (!cache.has(key)) cache.set(key, one.list ? listTexture(one, work, point) : imageTexture(one, point));
    gl.bindTexture(targetOf(one), cache.get(key));
  });
}

function makeTargets(count, width, height) {
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  const buffers = [];
  for (let i = 0; i < count; ++i) {
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, texture, 0);
    buffers.push(gl.COLOR_ATTACHMENT0 + i);
  }
  gl.drawBuffers(buffers);
  for (let i = 0; i < count; ++i) gl.clearBufferfv(gl.COLOR, i, [kUntouched, kUntouched, kUntouched, kUntouched]);
}

function drawPoints(work, program, width) {
  const blocks = bindBlocks(work, program);
  const textures = bindTextures(work, program);
  const back = gl.getUniformLocation(program, 'back');
  gl.enable(gl.SCISSOR_TEST);
  for (let point = 0; point < work.points; ++point) {
    gl.scissor(point % width, Math.floor(point / width), 1, 1);
    gl.uniform1i(back, work.backFacing[point] ? 1 : 0);
    blocks(point);
    textures(point);
    work.inputs.forEach((input, n) => {
      const value = [0, 0, 0, 1];
      for (let c = 0; c < input.components; ++c) value[c] = input.values[point * input.components + c];
      gl.vertexAttrib4fv(n, value);
    });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
  gl.disable(gl.SCISSOR_TEST);
}

function readBack(location, width, height) {
  const pixels = new Float32Array(4 * width * height);
  gl.readBuffer(gl.COLOR_ATTACHMENT0 + location);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
  return pixels;
}

function run(work) {
  try {
    const program = programOf(work);
    const width = Math.min(work.points, 64);
    const height = Math.ceil(work.points / width);
    makeTargets(Math.max(...work.outputs) + 1, width, height);
    gl.viewport(0, 0, width, height);
    gl.useProgram(program);
    drawPoints(work, program, width);
    const outputs = work.outputs.map((location) => readBack(location, width, height).slice(0, 4 * work.points));
    const error = gl.getError();
    if (error !== gl.NO_ERROR) return {error: `WebGL error ${error}`};
    const untouched = Math.fround(kUntouched);
    const discarded = Array.from({length: work.points}, (_, p) => outputs.every((rgba) => rgba[4 * p] === untouched));
    // JSON has no infinity and no NaN.
    const spelled = (x) => Number.isFinite(x) ? x : String(x);
    return {outputs: outputs.map((rgba) => Array.from(rgba, spelled)), discarded};
  } catch (error) {
    return {error: error.message};
  }
}
