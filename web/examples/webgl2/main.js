// A glTF file in WebGL 2 with shaders that are made in the page: `npm install`, then any static server, then
// index.html?file.gltf. For files with one buffer; each primitive is drawn with its material, under one lamp.
import { load } from 'lacquer';

const gl = document.querySelector('canvas').getContext('webgl2');
const url = new URL(location.search.slice(1) || 'triangle.gltf', location.href);
let gltf, buffer, images, scene;
const kOptions = { targets: ['essl'], ibl: false, lights: { directional: 1 } };
const kBlocks = ['Frame', 'Lights', 'Object', 'Material'];
const kNames = { POSITION: 'in_position', NORMAL: 'in_normal', TANGENT: 'in_tangent', COLOR_0: 'in_color_0' };

async function open() {
  const bytes = new Uint8Array(await (await fetch(url)).arrayBuffer());
  gltf = JSON.parse(new TextDecoder().decode(bytes));
  buffer = await (await fetch(new URL(gltf.buffers[0].uri, url))).arrayBuffer();
  images = await Promise.all((gltf.images ?? []).map(async ({ uri, bufferView, mimeType }) => {
    const { byteOffset = 0, byteLength = 0 } = gltf.bufferViews[bufferView] ?? {};
    const blob = uri ? await (await fetch(new URL(uri, url))).blob() : new Blob([new Uint8Array(buffer, byteOffset, byteLength)], { type: mimeType });
    return createImageBitmap(blob, { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
  }));
  scene = (await load()).scene(bytes, 'file.gltf');
}

/** A program, and the bytes of its blocks by the fields that the shader's interface tells. */
function prepare(primitive) {
  const attributes = Object.keys(primitive.attributes).filter((name) => name !== 'POSITION');
  const graph = scene.graph(primitive.material, kOptions, attributes);
  const shader = graph.generate(kOptions);
  const program = gl.createProgram();
  for (const [stage, kind] of [['vertex', gl.VERTEX_SHADER], ['fragment', gl.FRAGMENT_SHADER]]) {
    const part = gl.createShader(kind);
    gl.shaderSource(part, shader.text('essl', stage));
    gl.compileShader(part);
    gl.attachShader(program, part);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const values = {
    view_projection: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -0.1, 0, 0, 0, 0, 1], // seen from +z, [-1, 1] in x and y
    camera_position: [0, 0, 5],
    position: [0.4, 0.5, 0.77], // of a directional light: to it
    radiance: [3, 3, 3],
    direction: [-0.4, -0.5, -0.77],
    spot_offset: [1],
    model: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
    normal_matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
  };
  const blocks = shader.interface.uniforms.map(({ block, role, size, fields }) => {
    const data = role === 'material' ? shader.pack() : new Uint8Array(size);
    const view = new DataView(data.buffer);
    if (role !== 'material') {
      for (const { name, offset } of fields) (values[name] ?? []).forEach((x, i) => view.setFloat32(offset + 4 * i, x, true));
    }
    return { block, data };
  });
  return { program, blocks, slots: Object.entries(graph.toJson().textures ?? {}) };
}

function texture(program, name, { texture: index, srgb }, unit) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texImage2D(gl.TEXTURE_2D, 0, srgb ? gl.SRGB8_ALPHA8 : gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, images[gltf.textures[index].source]);
  gl.generateMipmap(gl.TEXTURE_2D);
  gl.uniform1i(gl.getUniformLocation(program, name), unit);
}

/** An accessor as an attribute of the current vertex array. */
function attribute(program, name, index) {
  const location = gl.getAttribLocation(program, kNames[name] ?? name.replace('TEXCOORD_', 'in_texcoord_'));
  if (location < 0) return;
  const { bufferView, byteOffset = 0, componentType, normalized = false, type } = gltf.accessors[index];
  const view = gltf.bufferViews[bufferView];
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, new Uint8Array(buffer, view.byteOffset ?? 0, view.byteLength), gl.STATIC_DRAW);
  gl.enableVertexAttribArray(location);
  gl.vertexAttribPointer(location, Number(type.slice(3)), componentType, normalized, view.byteStride ?? 0, byteOffset);
}

function draw(primitive) {
  const { program, blocks, slots } = prepare(primitive);
  gl.bindVertexArray(gl.createVertexArray());
  for (const [name, index] of Object.entries(primitive.attributes)) attribute(program, name, index);
  gl.useProgram(program);
  slots.forEach(([name, slot], unit) => texture(program, name, slot, unit));
  for (const { block, data } of blocks) {
    const binding = kBlocks.indexOf(block);
    const at = gl.getUniformBlockIndex(program, block);
    if (at === gl.INVALID_INDEX) continue;
    gl.uniformBlockBinding(program, at, binding);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, binding, gl.createBuffer());
    gl.bufferData(gl.UNIFORM_BUFFER, data, gl.STATIC_DRAW);
  }
  const accessor = gltf.accessors[primitive.indices];
  if (!accessor) return gl.drawArrays(gl.TRIANGLES, 0, gltf.accessors[primitive.attributes.POSITION].count);
  const view = gltf.bufferViews[accessor.bufferView];
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint8Array(buffer, view.byteOffset ?? 0, view.byteLength), gl.STATIC_DRAW);
  gl.drawElements(gl.TRIANGLES, accessor.count, accessor.componentType, accessor.byteOffset ?? 0);
}

open().then(() => {
  gl.clearColor(0.1, 0.1, 0.12, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  for (const mesh of gltf.meshes) mesh.primitives.forEach(draw);
  document.title = 'drawn';
});
