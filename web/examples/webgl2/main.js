// A glTF file in WebGL 2 with shaders that are made in the page: `npm install`, then any static server, then
// index.html?file.glb. What has a material is drawn with it, seen from +z, under one lamp.
import { load } from '@lacquer-shaders/lacquer';
import { bounds, fetchGltf, geometry, image, sourceOf } from '@lacquer-shaders/lacquer/gltf';

const canvas = document.querySelector('canvas');
const gl = canvas.getContext('webgl2');
const kOptions = { targets: ['essl'], ibl: false, lights: { directional: 1 } };
const kLamp = { position: [0.4, 0.5, 0.77], direction: [-0.4, -0.5, -0.77], radiance: [3, 3, 3], spot_offset: 1 };

/** What the block Frame has for a camera that sees all of it. */
function frameOf({ middle: [x, y, z], radius }) {
  const eye = [x, y, z + 3 * radius];
  const projection = new DOMMatrix([2.8, 0, 0, 0, 0, 2.8, 0, 0, 0, 0, -3, -1, 0, 0, -8 * radius, 0]); // from 2 to 4 radii away
  return { view_projection: projection.translate(-eye[0], -eye[1], -eye[2]).toFloat32Array(), camera_position: eye };
}

function programOf(shader) {
  const program = gl.createProgram();
  for (const [stage, kind] of [['vertex', gl.VERTEX_SHADER], ['fragment', gl.FRAGMENT_SHADER]]) {
    const part = gl.createShader(kind);
    gl.shaderSource(part, shader.text('essl', stage));
    gl.compileShader(part);
    gl.attachShader(program, part);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

async function bindTexture(file, { texture, srgb }) {
  const of = file.json.textures[texture];
  const { wrapS = gl.REPEAT, wrapT = gl.REPEAT } = file.json.samplers?.[of.sampler] ?? {};
  const bitmap = await image(file, sourceOf(of));
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texImage2D(gl.TEXTURE_2D, 0, srgb ? gl.SRGB8_ALPHA8 : gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
  gl.generateMipmap(gl.TEXTURE_2D);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrapS);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrapT);
}

async function draw(file, scene, { material, attributes, indices, model, normal }, frame) {
  const graph = scene.graph(material, kOptions, [...attributes.keys()].filter((name) => name !== 'POSITION'));
  const shader = graph.generate(kOptions);
  const { uniforms, textures, inputs } = shader.interface; // what is bound, and where
  const program = programOf(shader);
  gl.useProgram(program);

  const values = { Frame: frame, Lights: kLamp, Object: { model, normal_matrix: normal } };
  for (const { block, flat } of uniforms) {
    const index = gl.getUniformBlockIndex(program, block);
    if (index !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, index, flat);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, flat, gl.createBuffer());
    gl.bufferData(gl.UNIFORM_BUFFER, values[block] ? shader.block(block, values[block]) : shader.pack(), gl.STATIC_DRAW);
  }

  const slots = graph.toJson().textures;
  for (const { name, flat } of textures) {
    gl.uniform1i(gl.getUniformLocation(program, name), flat);
    gl.activeTexture(gl.TEXTURE0 + flat);
    await bindTexture(file, slots[name]);
  }

  gl.bindVertexArray(gl.createVertexArray());
  for (const { name, location } of inputs) {
    const { data, size } = attributes.get(name);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, size, gl.FLOAT, false, 0, 0);
  }
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
  gl.drawElements(gl.TRIANGLES, indices.length, gl.UNSIGNED_INT, 0);
  for (const handle of [shader, graph]) handle.free();
}

async function main() {
  const file = await fetchGltf(new URL(location.search.slice(1) || 'triangle.gltf', location.href));
  const scene = (await load()).scene(file.bytes, file.name);
  const drawables = geometry(file).filter(({ material }) => material >= 0);
  gl.clearColor(0.1, 0.1, 0.12, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  for (const each of drawables) await draw(file, scene, each, frameOf(bounds(drawables)));
  document.title = 'drawn';
}
main();
