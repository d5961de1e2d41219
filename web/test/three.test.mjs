// Lacquer's materials in three.js, as web/package-lock.json has it: their colours beside the library's own, and what a
// renderer's scene brings along.
import assert from 'node:assert/strict';
import { cpSync, mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join } from 'node:path';
import { after, before, test } from 'node:test';
import { kPatience, kSlow, launch, listen, serve } from './browser.mjs';
import { inputs, output, read, realFiles, root } from './native.mjs';
import { assertAlike, drawnFiles } from './renderers.mjs';

const kModules = {
  three: './node_modules/three/build/three.module.js',
  'three/addons/': './node_modules/three/examples/jsm/',
  '@lacquer-shaders/lacquer': './node_modules/@lacquer-shaders/lacquer/index.js',
  '@lacquer-shaders/lacquer/three': './node_modules/@lacquer-shaders/lacquer/three.js',
};
const kPage = `<!doctype html><meta charset="utf-8"><title>three</title><link rel="icon" href="data:,">
<script type="importmap">${JSON.stringify({ imports: kModules })}</script>
<canvas width="64" height="64"></canvas><script type="module" src="harness.js"></script>`;

/** What GLTFLoader says of what it does not know itself. */
const kLoaders = /^THREE.GLTFLoader: Unknown extension|GPU stall/;

/** In the page: the modules as globals, and what the tests share. */
const kHarness = `
import * as THREE from 'three';
import * as lacquered from '@lacquer-shaders/lacquer/three';
import { load } from '@lacquer-shaders/lacquer';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
const canvas = document.querySelector('canvas');
const renderer = new THREE.WebGLRenderer({ canvas });
Object.assign(window, { THREE, lacquered, GLTFLoader, renderer, lacquer: await load() });
/** A scene's linear colours, row by row from below. */
window.colours = (scene, camera, size = 8) => {
  const target = new THREE.WebGLRenderTarget(size, size, { type: THREE.FloatType });
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  const rgba = new Float32Array(4 * size * size);
  renderer.readRenderTargetPixels(target, 0, 0, size, size, rgba);
  renderer.setRenderTarget(null);
  target.dispose();
  const error = renderer.getContext().getError();
  if (error !== 0) throw new Error('WebGL says ' + error);
  return Array.from(rgba);
};
/** A quad of two units in the plane z = 0, seen from z = 3 through a field of 1.5 units there. */
window.quad = () => {
  const geometry = new THREE.PlaneGeometry(2, 2);
  geometry.setAttribute('tangent', new THREE.Float32BufferAttribute(Array.from({ length: 16 }, (_, i) => (i % 4 === 0 || i % 4 === 3 ? 1 : 0)), 4));
  return new THREE.Mesh(geometry);
};
window.camera = () => {
  const camera = new THREE.OrthographicCamera(-0.75, 0.75, 0.75, -0.75, 0.1, 10);
  camera.position.z = 3;
  return camera;
};
window.lamp = () => {
  const lamp = new THREE.DirectionalLight(new THREE.Color(1, 0.9, 0.8), 2);
  lamp.position.set(0.3, 0.5, 0.9);
  return lamp;
};
document.title = 'ready';
`;

/** Filters surroundings beside the page. */
const kWorker = `
import { load } from './node_modules/@lacquer-shaders/lacquer/index.js';
onmessage = async ({ data }) => postMessage((await load()).environment(data, 'environment.hdr', { size: 32, samples: 64 }));
`;

let browser;
let server;
let folder;
let page;
let watched;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), 'lacquer-three-'));
  mkdirSync(join(folder, 'node_modules/@lacquer-shaders'), { recursive: true });
  symlinkSync(join(root, 'web/node_modules/three'), join(folder, 'node_modules/three'));
  symlinkSync(join(output, 'package'), join(folder, 'node_modules/@lacquer-shaders/lacquer'));
  writeFileSync(join(folder, 'index.html'), kPage);
  writeFileSync(join(folder, 'harness.js'), kHarness);
  writeFileSync(join(folder, 'worker.js'), kWorker);
  cpSync(join(root, 'web/examples/three'), join(folder, 'three'), { recursive: true });
  symlinkSync('../node_modules', join(folder, 'three/node_modules'));
  const [real] = realFiles();
  if (real) symlinkSync(dirname(dirname(real)), join(folder, 'assets'));
  cpSync(join(root, 'examples'), join(folder, 'examples'), { recursive: true, filter: (name) => !/\.(cpp|h|txt)$/.test(name) });
  server = await serve(folder);
  page = await browser.newPage();
  watched = listen(page, kSlow);
  await page.goto(`${server.url}/index.html`, { timeout: kPatience });
  await watched.unlessItFails(page.waitForFunction(() => document.title === 'ready', null, { timeout: kPatience }));
});
after(async () => {
  await browser?.close();
  server?.close();
  if (folder) rmSync(folder, { recursive: true });
});

/** Runs in the page; what the console says there fails the test, but for what `expected` matches. */
async function inPage(run, argument, expected = /^$/) {
  const from = watched.said.length;
  const result = await watched.unlessItFails(page.evaluate(run, argument));
  assert.deepEqual(watched.said.slice(from).filter((text) => !expected.test(text)), []);
  return result;
}

/** The colours of a material of a file without its pictures on a quad, and the library's own at the same points. */
async function besideTheLibrary({ text, material, texel, environment }) {
  const file = JSON.parse(text);
  const size = 8;
  const messages = [];
  const mesh = quad();
  const look = file.materials[material];
  const pictures = (file.textures ?? []).map(() => {
    const picture = new THREE.DataTexture(new Uint8Array(texel), 1, 1);
    picture.needsUpdate = true;
    return picture;
  });
  mesh.material = lacquered.materialFrom(lacquer, look, mesh, { textures: pictures, messages });
  mesh.material.side = THREE.DoubleSide;
  mesh.material.blending = THREE.NoBlending;
  const scene = new THREE.Scene();
  const light = lamp();
  scene.add(mesh, light);
  if (environment) lacquered.setEnvironment(scene, environment);
  const drawn = colours(scene, camera(), size);
  const l = light.position.clone().normalize().toArray();
  const radiance = light.color.toArray().map((x) => x * light.intensity);
  const points = Array.from({ length: size * size }, (_, i) => {
    const [x, y] = [i % size, Math.floor(i / size)].map((at) => ((at + 0.5) / size - 0.5) * 1.5);
    const eye = new THREE.Vector3(-x, -y, 3).normalize().toArray();
    return { n: [0, 0, 1], t: [1, 0, 0, 1], v: eye, l, light: radiance, uv0: [x / 2 + 0.5, y / 2 + 0.5], position: [x, y, 0] };
  });
  const images = (file.textures ?? []).map((_, i) => ({ uri: `${i}.png` }));
  const alone = { asset: file.asset, materials: [look], images, textures: images.map((_, source) => ({ source })) };
  const graph = lacquer.scene(JSON.stringify(alone), 'a.gltf').graph(0, {}, lacquered.attributesOf(mesh));
  const decoded = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
  const linear = (srgb) => texel.map((x, i) => (srgb && i < 3 ? decoded(x / 255) : x / 255));
  const texels = graph.textures().map(({ name, srgb }) => `${name}=${linear(srgb).join()}`);
  const { rgba } = graph.evaluate(points, { texels, ibl: false });
  mesh.material.dispose();
  return { drawn, expected: rgba.flat(), names: graph.textures().map(({ name }) => name), lod: mesh.material.looksThrough };
}

test('materials have the colours of the library under a lamp', async () => {
  let compared = 0;
  for (const file of inputs().filter((name) => name.startsWith('examples/') || name.startsWith('bench/'))) {
    const text = read(file).toString();
    const { materials } = JSON.parse(text);
    for (let material = 0; material < materials.length; ++material) {
      const { drawn, expected, lod } = await inPage(besideTheLibrary, { text, material, texel: [255, 255, 255, 255] });
      if (lod) continue; // what is behind is the scene's
      assertAlike(drawn, expected, `${file} ${materials[material].name}`);
      ++compared;
    }
  }
  assert.ok(compared > 20, `${compared}`);
});

test('pictures reach their slots, in their colour spaces', async () => {
  const text = read('examples/core.gltf').toString();
  const { materials } = JSON.parse(text);
  const material = materials.findIndex((each) => JSON.stringify(each).includes('Texture'));
  const { drawn, expected, names } = await inPage(besideTheLibrary, { text, material, texel: [200, 120, 180, 255] });
  assert.ok(names.length > 0);
  assertAlike(drawn, expected, materials[material].name);
});

test('surroundings light a scene, turned and dimmed as three.js has it', async () => {
  const at = await inPage(() => {
    const [width, height] = [64, 32];
    const data = new Float32Array(4 * width * height);
    // One where +x is, nothing elsewhere.
    for (let i = 0; i < width * height; ++i) data.set(i % width > width / 4 && i % width < (3 * width) / 4 ? [2, 1, 0.5, 1] : [0, 0, 0, 1], 4 * i);
    const picture = new THREE.DataTexture(data, width, height, THREE.RGBAFormat, THREE.FloatType);
    const form = { size: 32, samples: 64 };
    const environment = lacquered.environmentOf(lacquer, picture, form);
    const mesh = quad();
    const white = { pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1 } };
    const options = { switches: { turned_environment: true } };
    mesh.material = lacquered.materialFrom(lacquer, white, mesh, { options });
    const scene = new THREE.Scene();
    scene.add(mesh);
    const middle = () => colours(scene, camera(), 1).slice(0, 3);
    const dark = middle();
    lacquered.setEnvironment(scene, environment);
    const half = middle();
    scene.environmentIntensity = 0.5;
    const dimmed = middle();
    scene.environmentIntensity = 1;
    // The bright side is brought to +z, towards the viewer, and then away.
    scene.environmentRotation.y = -Math.PI / 2;
    const bright = middle();
    scene.environmentRotation.y = Math.PI / 2;
    const away = middle();
    lacquered.setEnvironment(scene, null);
    return { dark, half, dimmed, bright, away, none: middle() };
  });
  assert.deepEqual(at.dark, [0, 0, 0]);
  assert.deepEqual(at.none, [0, 0, 0]);
  assert.ok(at.half[0] > 0.8 && at.half[0] < 1.2, `${at.half}`);
  at.dimmed.forEach((x, i) => assert.ok(Math.abs(x - at.half[i] / 2) < 1e-3));
  assert.ok(at.bright[0] > 1.6, `${at.bright}`);
  assert.ok(at.away[0] < 0.3, `${at.away}`);
});

test('surroundings that a worker filtered are those of the page', async () => {
  const at = await inPage(async () => {
    const [width, height] = [32, 16];
    const head = new TextEncoder().encode(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`);
    const picture = new Uint8Array(head.length + 4 * width * height);
    picture.set(head);
    for (let i = 0; i < width * height; ++i) picture.set([128 + (i % 100), 64, i % 64, 128], head.length + 4 * i);
    const worker = new Worker('worker.js', { type: 'module' });
    const maps = await new Promise((done, failed) => {
      worker.onmessage = ({ data }) => done(data);
      worker.onerror = failed;
      worker.postMessage(picture);
    });
    worker.terminate();
    const texelsOf = ({ textures, levels }) => [levels, ...Object.entries(textures).map(([slot, cube]) =>
      [slot, [cube.image, ...cube.mipmaps.map(({ image }) => image)].map((faces) => faces.map((face) => Array.from(face.image.data))).flat(2)])];
    const wrong = [];
    for (const maps of [{ files: {}, environment_max_lod: 0 }, lacquer.environment(picture, 'a.hdr', { size: 32, samples: 64, dds: true })]) {
      try {
        lacquered.environmentOf(lacquer, maps);
      } catch (error) {
        wrong.push(error.message);
      }
    }
    const page = texelsOf(lacquered.environmentOf(lacquer, picture, { size: 32, samples: 64 }));
    return { wrong, page, worker: texelsOf(lacquered.environmentOf(lacquer, maps)) };
  });
  assert.match(at.wrong[0], /has the map environment_specular/);
  assert.match(at.wrong[1], /environment_specular is no KTX2 file of half floats/);
  assert.ok(at.page[1][1].length > 6 * 4 * 32 * 32, `${at.page[1][1].length}`);
  assert.deepEqual(at.worker, at.page);
});

test('numbers change without a program, and what was made is given back', async () => {
  const at = await inPage(() => {
    const mesh = quad();
    mesh.material = lacquered.materialFrom(lacquer, { extensions: { KHR_materials_clearcoat: { clearcoatFactor: 1 } } }, mesh);
    const scene = new THREE.Scene();
    scene.add(mesh, lamp());
    const first = colours(scene, camera());
    const { programs } = renderer.info;
    const one = programs.length;
    mesh.material.set({ base_color_factor: [0.1, 0.2, 0.3, 1] });
    const second = colours(scene, camera());
    const other = mesh.clone();
    other.material = mesh.material.clone();
    other.material.set({ base_color_factor: [1, 1, 1, 1] });
    scene.remove(mesh);
    scene.add(other);
    const third = colours(scene, camera());
    const still = programs.length;
    let refused = '';
    try {
      mesh.material.set({ base_colour: 1 });
    } catch (error) {
      refused = String(error);
    }
    mesh.material.dispose();
    other.material.dispose();
    return { first, second, third, one, still, left: programs.length, refused, names: mesh.material.parameters().map(({ name }) => name) };
  });
  assert.equal(at.still, at.one);
  assert.equal(at.left, at.one - 1);
  assert.ok(at.second[0] < at.first[0] / 2);
  assert.deepEqual(at.third, at.first);
  assert.match(at.refused, /no parameter base_colour; it has .*base_color_factor/);
  assert.ok(at.names.includes('base_color_factor'));
});

/** Which colours a mesh shows where, by its own material and by one of three.js: an array of both. */
async function covered(kind) {
  const base = quad();
  const { geometry } = base;
  let mesh = base;
  if (kind === 'skin') {
    const bones = [new THREE.Bone(), new THREE.Bone()];
    geometry.setAttribute('skinIndex', new THREE.Uint16BufferAttribute([0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0], 4));
    geometry.setAttribute('skinWeight', new THREE.Float32BufferAttribute([1, 0, 0, 0, 0.5, 0.5, 0, 0, 1, 0, 0, 0, 0.25, 0.75, 0, 0], 4));
    mesh = new THREE.SkinnedMesh(geometry);
    bones.forEach((bone) => mesh.add(bone));
    mesh.position.x = 0.1;
    mesh.updateMatrixWorld(true);
    mesh.bind(new THREE.Skeleton(bones));
    bones[0].rotation.z = 0.4;
    bones[1].position.set(0.3, -0.2, 0);
    bones[1].scale.setScalar(0.7);
  } else if (kind === 'morph') {
    const moved = [new THREE.Float32BufferAttribute([0.5, -0.5, 0, 0, 0, 0, 0, 0.7, 0, -0.3, 0, 0], 3)];
    geometry.morphAttributes.position = [new THREE.Float32BufferAttribute(new Float32Array(12), 3), ...moved];
    geometry.morphTargetsRelative = true;
    mesh = new THREE.Mesh(geometry);
    mesh.morphTargetInfluences = [1, 0.8];
  } else if (kind.startsWith('batch')) {
    mesh = new THREE.BatchedMesh(3, 16, 32);
    geometry.deleteAttribute('tangent');
    const small = new THREE.CircleGeometry(0.7, 5);
    const [first, second] = [mesh.addGeometry(geometry), mesh.addGeometry(small)];
    for (let i = 0; i < 3; ++i) {
      const turn = new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(0, 0, 1), i);
      const id = mesh.addInstance(i === 1 ? second : first);
      mesh.setMatrixAt(id, new THREE.Matrix4().compose(new THREE.Vector3(0.5 * i - 0.5, 0.2 * i, -i), turn, new THREE.Vector3(0.1 + 0.1 * i, 0.2, 1)));
      if (kind.endsWith('colours')) mesh.setColorAt(id, new THREE.Color().setRGB(...[[1, 0, 0], [0, 1, 0], [1, 0, 1]][i]));
    }
  } else if (kind === 'instances') {
    mesh = new THREE.InstancedMesh(geometry, undefined, 3);
    for (let i = 0; i < 3; ++i) {
      const turn = new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(0, 0, 1), i);
      const at = new THREE.Vector3(0.5 * i - 0.5, 0.2 * i, -i);
      mesh.setMatrixAt(i, new THREE.Matrix4().compose(at, turn, new THREE.Vector3(0.1 + 0.1 * i, 0.2, 1)));
    }
  }
  mesh.rotation.z = 0.2;
  const scene = new THREE.Scene();
  scene.add(mesh);
  const seen = (material) => {
    mesh.material = material;
    return colours(scene, camera(), 32).filter((_, i) => i % 4 < 3).map((x) => (x > 0.5 ? 1 : 0));
  };
  const unlit = { extensions: { KHR_materials_unlit: {} }, doubleSided: true };
  return [seen(lacquered.materialFrom(lacquer, unlit, mesh)), seen(new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }))];
}

test('skins, morph targets, instances and batches move it as they move three.js\'s own materials', async () => {
  for (const kind of ['plain', 'skin', 'morph', 'instances', 'batch', 'batch of colours']) {
    const [own, theirs] = await inPage(covered, kind);
    const sum = theirs.reduce((all, x) => all + x, 0);
    assert.ok(sum > 100 && (kind === 'plain' || sum < 3000), `${kind}: ${sum}`);
    const off = own.filter((x, i) => x !== theirs[i]).length;
    assert.ok(off <= 6, `${kind}: ${off} of ${sum} values`);
  }
});

test('fog, tone mapping and the colour space are the renderer\'s', async () => {
  const at = await inPage(() => {
    const mesh = quad();
    const glowing = { emissiveFactor: [0.5, 0.25, 1], pbrMetallicRoughness: { baseColorFactor: [0, 0, 0, 1] } };
    const scene = new THREE.Scene();
    scene.add(mesh);
    const theirs = new THREE.MeshBasicMaterial();
    theirs.color.setRGB(0.5, 0.25, 1);
    const own = lacquered.materialFrom(lacquer, glowing, mesh);
    const eye = new THREE.PerspectiveCamera(30, 1, 0.1, 10);
    eye.position.z = 3;
    const shown = (material) => {
      mesh.material = material;
      renderer.setSize(8, 8, false);
      renderer.render(scene, eye);
      const gl = renderer.getContext();
      const pixel = new Uint8Array(4);
      gl.readPixels(4, 4, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      return [...pixel];
    };
    const both = () => [shown(own), shown(theirs)];
    const plain = both();
    renderer.toneMapping = THREE.NeutralToneMapping;
    renderer.toneMappingExposure = 1.5;
    const toned = both();
    scene.fog = new THREE.Fog(0x336699, 1, 6);
    const foggy = both();
    scene.fog = new THREE.FogExp2(0x336699, 0.3);
    const denser = both();
    renderer.toneMapping = THREE.NoToneMapping;
    renderer.toneMappingExposure = 1;
    return { plain, toned, foggy, denser };
  });
  for (const [name, [own, theirs]] of Object.entries(at)) {
    own.forEach((x, i) => assert.ok(Math.abs(x - theirs[i]) <= 2, `${name}: ${own}, not ${theirs}`));
  }
  assert.notDeepEqual(at.plain[0], at.toned[0]);
  assert.notDeepEqual(at.toned[0], at.foggy[0]);
});

test('a rectangle lights what has the template for it, to its front', async () => {
  const at = await inPage(() => {
    const white = { pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1 } };
    const scene = new THREE.Scene();
    const mesh = quad();
    const panel = new THREE.RectAreaLight(0xffffff, 3, 400, 400);
    panel.position.z = 1;
    panel.lookAt(0, 0, 0);
    scene.add(mesh, panel);
    const middle = (options) => {
      mesh.material = lacquered.materialFrom(lacquer, white, mesh, { options });
      return colours(scene, camera(), 1)[0];
    };
    const all = middle({ template: 'forward_area' });
    const plain = middle({});
    panel.lookAt(0, 0, 9);
    return { all, plain, away: middle({ template: 'forward_area' }) };
  });
  // It covers all that a white surface sees.
  assert.ok(at.all > 2.7 && at.all < 3.05, `${at.all}`);
  assert.equal(at.plain, 0);
  assert.equal(at.away, 0);
});

test('through glass the scene is seen, and no other glass', async () => {
  const at = await inPage(() => {
    const scene = new THREE.Scene();
    const wall = quad();
    wall.position.z = -2;
    wall.scale.setScalar(4);
    wall.material = new THREE.MeshBasicMaterial();
    wall.material.color.setRGB(0.2, 0.8, 0.4);
    const glass = quad();
    const extensions = { KHR_materials_transmission: { transmissionFactor: 1 } };
    const clear = { pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 0 }, extensions };
    glass.material = lacquered.materialFrom(lacquer, clear, glass);
    const behind = glass.clone();
    behind.position.z = -1;
    scene.add(wall, glass, behind);
    renderer.setSize(64, 64, false);
    const eye = new THREE.PerspectiveCamera(20, 1, 0.1, 10);
    eye.position.z = 3;
    const middle = colours(scene, eye, 9).slice(4 * 40, 4 * 40 + 3);
    return { middle, visible: [glass.visible, behind.visible] };
  });
  // Fresnel takes four hundredths.
  [0.2, 0.8, 0.4].forEach((x, i) => assert.ok(Math.abs(at.middle[i] - 0.96 * x) < 0.02, `${at.middle}`));
  assert.deepEqual(at.visible, [true, true]);
});

/** What is left of a lamp's light over a wall behind a small square, by Lacquer's material and by three.js's own. */
async function dimmed({ kind, type, receives = true, others = 0 }) {
  const scene = new THREE.Scene();
  const wall = quad();
  const square = quad();
  square.scale.setScalar(0.2);
  square.position.set(0.05, 0.1, 0.5);
  square.material = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, colorWrite: false, depthWrite: false });
  square.castShadow = true;
  wall.receiveShadow = receives;
  const kinds = {
    directional: () => new THREE.DirectionalLight(0xffffff, 2), spot: () => new THREE.SpotLight(0xffffff, 20, 0, 0.6, 0.5),
    point: () => new THREE.PointLight(0xffffff, 20),
  };
  const light = kinds[kind]();
  light.position.set(0.4, 0.3, 2);
  light.castShadow = true;
  light.shadow.mapSize.set(128, 128);
  light.shadow.bias = -0.002;
  light.shadow.normalBias = 0.02;
  light.shadow.intensity = 0.9;
  for (const side of ['left', 'right', 'top', 'bottom']) if (kind === 'directional') light.shadow.camera[side] = side === 'left' || side === 'bottom' ? -1 : 1;
  Object.assign(light.shadow.camera, { near: 0.2, far: 5 });
  // Lights without a shadow before it: the number of a shadow is not that of its light.
  for (let i = 0; i < others; ++i) {
    const dim = kinds[['directional', 'spot', 'point'][i % 3]]();
    dim.intensity = 1e-6;
    dim.position.set(0, 0, 2);
    scene.add(dim);
  }
  scene.add(wall, square, light);
  renderer.shadowMap.type = type;
  const white = { pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1 } };
  const share = (make) => {
    const drawn = [false, true].map((enabled) => {
      renderer.shadowMap.enabled = enabled;
      wall.material = make();
      const all = colours(scene, camera(), 32).filter((_, i) => i % 4 === 0);
      wall.material.dispose();
      return all;
    });
    return drawn[1].map((x, i) => x / drawn[0][i]);
  };
  const own = share(() => lacquered.materialFrom(lacquer, white, wall));
  const theirs = share(() => new THREE.MeshStandardMaterial({ roughness: 1, metalness: 0 }));
  renderer.shadowMap.enabled = false;
  renderer.shadowMap.type = THREE.PCFShadowMap;
  light.dispose();
  return { own, theirs };
}

test("shadows fall on it as on three.js's own materials", async () => {
  const { PCFShadowMap: pcf, BasicShadowMap: basic, VSMShadowMap: vsm } = await inPage(() => {
    const { PCFShadowMap, BasicShadowMap, VSMShadowMap } = THREE;
    return { PCFShadowMap, BasicShadowMap, VSMShadowMap };
  });
  const cases = ['directional', 'spot', 'point'].flatMap((kind) => [
    { kind, type: pcf }, { kind, type: pcf, others: 4 }, { kind, type: basic }, ...(kind === 'point' ? [] : [{ kind, type: vsm }]),
  ]);
  for (const each of cases) {
    const what = JSON.stringify(each);
    const { own, theirs } = await inPage(dimmed, each);
    const dark = theirs.filter((x) => x < 0.2).length;
    assert.ok(dark > 20 && theirs.filter((x) => x > 0.95).length > 500, `${what}: three.js has ${dark} dark pixels`);
    const far = own.filter((x, i) => Math.abs(x - theirs[i]) > 0.03).length;
    assert.ok(far === 0, `${what}: ${far} pixels are not as three.js has them, which has ${dark} dark ones`);
  }
  const { own } = await inPage(dimmed, { kind: 'directional', type: pcf, receives: false });
  assert.ok(own.every((x) => Math.abs(x - 1) < 1e-3), 'receiveShadow is false');
});

test('instances have their colours, times those of their vertices', async () => {
  const at = await inPage(() => {
    const white = { pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1 } };
    const { geometry } = quad();
    const drawn = (mesh, json) => {
      mesh.material = lacquered.materialFrom(lacquer, json, mesh);
      const scene = new THREE.Scene();
      scene.add(mesh, lamp());
      return colours(scene, camera(), 1).slice(0, 3);
    };
    const tinted = () => {
      const mesh = new THREE.InstancedMesh(geometry, undefined, 1);
      mesh.setMatrixAt(0, new THREE.Matrix4());
      mesh.setColorAt(0, new THREE.Color().setRGB(0.2, 0.5, 1));
      return mesh;
    };
    const based = (...color) => drawn(quad(), { pbrMetallicRoughness: { ...white.pbrMetallicRoughness, baseColorFactor: [...color, 1] } });
    const own = drawn(tinted(), white);
    geometry.setAttribute('color', new THREE.Float32BufferAttribute(new Array(12).fill(0.5), 3));
    return { own, expected: based(0.2, 0.5, 1), both: drawn(tinted(), white), half: based(0.1, 0.25, 0.5) };
  });
  at.own.forEach((x, i) => assert.ok(Math.abs(x - at.expected[i]) < 1e-3, `${at.own}, not ${at.expected}`));
  at.both.forEach((x, i) => assert.ok(Math.abs(x - at.half[i]) < 1e-3, `${at.both}, not ${at.half}`));
  assert.ok(at.own[2] > 2 * at.own[0], `${at.own}`);
});

test("clipping planes cut it as they cut three.js's own materials", async () => {
  const at = await inPage(() => {
    const glowing = { emissiveFactor: [1, 1, 1], pbrMetallicRoughness: { baseColorFactor: [0, 0, 0, 1] } };
    const mesh = quad();
    mesh.position.set(0.1, 0.05, 0);
    const scene = new THREE.Scene();
    scene.add(mesh);
    const planes = [new THREE.Plane(new THREE.Vector3(1, 0.3, 0).normalize(), 0.1), new THREE.Plane(new THREE.Vector3(0, -1, 0), 0.3)];
    const seen = (material, clipIntersection) => {
      mesh.material = material;
      Object.assign(material, { clippingPlanes: planes, clipIntersection });
      renderer.localClippingEnabled = true;
      const drawn = colours(scene, camera(), 32).filter((_, i) => i % 4 === 0).map((x) => (x > 0.5 ? 1 : 0));
      renderer.localClippingEnabled = false;
      return drawn;
    };
    const both = (intersection) => [lacquered.materialFrom(lacquer, glowing, mesh), new THREE.MeshBasicMaterial()].map((material) => seen(material, intersection));
    const all = [both(false), both(true)];
    renderer.clippingPlanes = planes.slice(1);
    all.push([lacquered.materialFrom(lacquer, glowing, mesh), new THREE.MeshBasicMaterial()].map((material) => {
      mesh.material = material;
      return colours(scene, camera(), 32).filter((_, i) => i % 4 === 0).map((x) => (x > 0.5 ? 1 : 0));
    }));
    renderer.clippingPlanes = [];
    return all;
  });
  at.forEach(([own, theirs], i) => {
    const sum = theirs.reduce((all, x) => all + x, 0);
    assert.ok(sum > 100 && sum < 1000, `${i}: ${sum}`);
    assert.ok(own.filter((x, at) => x !== theirs[at]).length <= 2, `${i}: not as the ${sum} pixels that three.js draws`);
  });
});

test('a logarithmic depth buffer holds its depths and three.js\'s', async () => {
  const at = await inPage(() => {
    const own = new THREE.WebGLRenderer({ logarithmicDepthBuffer: true });
    const target = new THREE.WebGLRenderTarget(32, 32, { type: THREE.FloatType });
    const far = new THREE.PerspectiveCamera(28, 1, 0.01, 1e7);
    far.position.z = 3;
    const [mesh, other] = [quad(), quad()];
    other.rotation.y = 0.3;
    other.position.z = 0.1;
    other.material = new THREE.MeshBasicMaterial({ color: 0 });
    const scene = new THREE.Scene();
    scene.add(mesh, other);
    const both = [lacquered.materialFrom(lacquer, { extensions: { KHR_materials_unlit: {} } }, mesh), new THREE.MeshBasicMaterial()].map((material) => {
      mesh.material = material;
      own.setRenderTarget(target);
      own.render(scene, far);
      const rgba = new Float32Array(32 * 32 * 4);
      own.readRenderTargetPixels(target, 0, 0, 32, 32, rgba);
      return Array.from(rgba).filter((_, i) => i % 4 === 0).map((x) => (x > 0.5 ? 1 : 0));
    });
    target.dispose();
    own.dispose();
    return both;
  });
  const sum = at[1].reduce((all, x) => all + x, 0);
  assert.ok(sum > 100 && sum < 900, `${sum}`);
  assert.ok(at[0].filter((x, i) => x !== at[1][i]).length <= 2, `${at[0].reduce((all, x) => all + x, 0)}, not the ${sum} pixels that three.js draws`);
});

test('two renderers draw one scene, each as it is now', async () => {
  const [first, second, changed] = await inPage(() => {
    const other = new THREE.WebGLRenderer();
    const mesh = quad();
    mesh.material = lacquered.materialFrom(lacquer, { pbrMetallicRoughness: { metallicFactor: 0 } }, mesh);
    const scene = new THREE.Scene();
    const light = lamp();
    scene.add(mesh, light);
    const drawn = (by) => {
      const target = new THREE.WebGLRenderTarget(1, 1, { type: THREE.FloatType });
      by.info.render.frame = 1000; // what the two would share
      by.setRenderTarget(target);
      by.render(scene, camera());
      const rgba = new Float32Array(4);
      by.readRenderTargetPixels(target, 0, 0, 1, 1, rgba);
      by.setRenderTarget(null);
      return rgba[0];
    };
    const made = [drawn(renderer), drawn(other)];
    light.intensity *= 2;
    drawn(renderer);
    made.push(drawn(other));
    other.dispose();
    return made;
  });
  assert.equal(first, second);
  assert.ok(Math.abs(changed / first - 2) < 1e-3, `${first} ${changed}`);
});

test('glass leaves the faces of a cube, and what hangs below it, as they are', async () => {
  const at = await inPage(() => {
    const scene = new THREE.Scene();
    const glass = new THREE.Mesh(new THREE.SphereGeometry(0.3));
    const clear = { pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 0 }, extensions: { KHR_materials_transmission: { transmissionFactor: 1 } } };
    glass.material = lacquered.materialFrom(lacquer, clear, glass);
    const wall = new THREE.Mesh(new THREE.BoxGeometry(8, 8, 8), new THREE.MeshBasicMaterial({ color: 0xffffff, side: THREE.BackSide }));
    glass.position.set(0, 0, -2);
    wall.position.set(0, 0, 2);
    glass.add(wall); // behind it, and below it
    scene.add(glass);
    const target = new THREE.WebGLCubeRenderTarget(4, { type: THREE.FloatType });
    new THREE.CubeCamera(0.1, 100, target).update(renderer, scene);
    const faces = Array.from({ length: 6 }, (_, face) => {
      const rgba = new Float32Array(4 * 16);
      renderer.readRenderTargetPixels(target, 0, 0, 4, 4, rgba, face);
      return rgba[0];
    });
    const eye = new THREE.PerspectiveCamera(20, 1, 0.1, 20);
    return { faces, through: colours(scene, eye, 9)[4 * 40] };
  });
  at.faces.forEach((x, face) => assert.ok(x > 0.99, `face ${face}: ${at.faces}`));
  assert.ok(at.through > 0.9, `${at.through}`);
});

test('what is wrong is refused and changes nothing', async () => {
  const said = await inPage(() => {
    const mesh = quad();
    const scene = new THREE.Scene();
    scene.add(mesh, lamp());
    mesh.material = lacquered.materialFrom(lacquer, {}, mesh);
    const before = colours(scene, camera(), 1);
    const refused = (run) => {
      try {
        run();
        return 'taken';
      } catch (error) {
        return String(error);
      }
    };
    const wrong = { base_color_factor: [0.5, 1] };
    const texts = [
      refused(() => mesh.material.set(wrong)),
      refused(() => mesh.material.set({ roughness_factor: NaN })),
      refused(() => mesh.material.setTexture('coat_texture', null)),
      refused(() => lacquered.setEnvironment(scene, new THREE.Texture())),
      refused(() => lacquered.environmentOf(lacquer, undefined)),
      refused(() => lacquered.materialFrom(lacquer, {}, mesh, { options: { template: 'bsdf' } })),
      refused(() => lacquered.materialFrom(lacquer, {}, mesh, { options: { template: 'forward_clustered' } })),
      refused(() => lacquered.materialFrom(lacquer, {}, mesh, { options: { template: 'depth' } })),
    ];
    const after = colours(scene, camera(), 1);
    mesh.material.set({ base_color_factor: new Float32Array([0, 0, 0, 1]) });
    return { texts, same: String(before) === String(after), dark: colours(scene, camera(), 1)[0] < before[0] / 2 };
  });
  const expected = [/2 numbers/, /NaN is no number/, /reads no texture coat_texture/, /no environment/, /Radiance picture/, /not bsdf/, /not forward_clustered/, /not depth/];
  expected.forEach((text, i) => assert.match(said.texts[i], text));
  assert.ok(said.same && said.dark);
});

test('colours of vertices are drawn, also where three.js declares them', async () => {
  const at = await inPage(() => {
    const mesh = quad();
    mesh.geometry.setAttribute('color', new THREE.Float32BufferAttribute([1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0], 3));
    const scene = new THREE.Scene();
    scene.add(mesh, lamp());
    mesh.material = lacquered.materialFrom(lacquer, { pbrMetallicRoughness: { metallicFactor: 0 } }, mesh);
    const plain = colours(scene, camera(), 1);
    mesh.material = mesh.material.clone();
    mesh.material.vertexColors = true;
    return { plain, declared: colours(scene, camera(), 1) };
  });
  assert.ok(at.plain[0] > 2 * at.plain[1], `${at.plain}`);
  assert.deepEqual(at.declared, at.plain);
});

/** A file by GLTFLoader with the plugin, drawn: what has become of its materials. */
async function loaded(url) {
  const loader = new GLTFLoader();
  const told = [];
  let plugin;
  loader.register((parser) => (plugin = new lacquered.LacquerPlugin(parser, lacquer, { onMessage: (message) => told.push(message) })));
  const { scene: model } = await loader.loadAsync(url);
  const scene = new THREE.Scene();
  scene.add(model, lamp(), new THREE.AmbientLight());
  const box = new THREE.Box3().setFromObject(model, true);
  const radius = Math.max(box.getSize(new THREE.Vector3()).length() / 2, 1e-6);
  const eye = new THREE.PerspectiveCamera(39, 1, radius / 4, 10 * radius);
  eye.position.copy(box.getCenter(new THREE.Vector3())).z += 3 * radius;
  const drawn = colours(scene, eye, 32);
  const kinds = [];
  let first;
  model.traverse((object) => object.isMesh && kinds.push(object.material.isLacquerMaterial === true) && (first ??= object));
  // As a variant is chosen: the same material once made, another one of the file.
  const known = first && (await plugin.materialOf(plugin.parser.associations.get(first.material)?.materials ?? 0, first));
  kinds.push(!first || known === first.material || plugin.parser.associations.get(first.material) === undefined);
  if (first) kinds.push((await plugin.materialOf(Math.max((plugin.parser.json.materials ?? []).length - 1, 0), first))?.isLacquerMaterial ?? false);
  model.traverse((object) => object.material?.dispose?.());
  const errors = told.filter(({ level }) => level === 'error').map(({ text }) => text);
  return { kinds, errors, finite: drawn.every(Number.isFinite), lit: drawn.some((x, i) => i % 4 < 3 && x > 0.01) };
}

test('GLTFLoader with the plugin draws every example', async () => {
  for (const file of inputs().filter((name) => name.startsWith('examples/'))) {
    const { kinds, errors, finite } = await inPage(loaded, `${server.url}/${file}`, kLoaders);
    assert.deepEqual(errors, [], file);
    assert.ok(kinds.length > 0 && kinds.every(Boolean) && finite, `${file}: ${kinds} ${finite}`);
  }
  const { kinds, lit } = await inPage(loaded, `${server.url}/three/triangle.gltf`);
  assert.ok(kinds.every(Boolean) && lit);
});

test('GLTFLoader with the plugin draws real files', async (t) => {
  const files = drawnFiles();
  if (files.length === 0) return t.skip('there is no assets folder');
  for (const file of files) {
    const place = `${basename(dirname(file))}/${basename(file)}`;
    const { kinds, errors, finite, lit } = await inPage(loaded, `${server.url}/assets/${place}`, kLoaders);
    assert.deepEqual(errors, [], place);
    assert.ok(kinds.every(Boolean) && finite && (lit || kinds.length === 1), `${place}: ${kinds} ${finite} ${lit}`);
  }
});

test('its example draws', async () => {
  const own = await browser.newPage();
  try {
    const { said, unlessItFails } = listen(own, kSlow);
    await own.goto(`${server.url}/three/index.html`, { timeout: kPatience });
    await unlessItFails(own.waitForFunction(() => document.title === 'drawn', null, { timeout: kPatience }));
    assert.deepEqual(said, []);
    assert.ok((await own.locator('canvas').screenshot()).length > 3000);
  } finally {
    await own.close();
  }
});
