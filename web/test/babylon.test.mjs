// Lacquer's materials in Babylon.js, as web/package-lock.json has it: their colours beside the library's own, and what a scene
// brings along.
import assert from 'node:assert/strict';
import { copyFileSync, cpSync, mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join } from 'node:path';
import { after, before, test } from 'node:test';
import { build } from 'esbuild';
import { kPatience, kSlow, launch, listen, serve } from './browser.mjs';
import { glb, inputs, output, read, realFiles, root } from './native.mjs';
import { assertAlike, drawnFiles } from './renderers.mjs';

const kPage = `<!doctype html><meta charset="utf-8"><title>babylon</title><link rel="icon" href="data:,">
<canvas width="64" height="64"></canvas><script type="module" src="page.js"></script>`;
/** What it says of itself when it starts. */
const kStarts = /^(BJS - \[.*\]: )?Babylon.js v|GPU stall/;
/** What the browser says of pictures that are not there. */
const kLoads = /Failed to load resource|GPU stall|^BJS - /;

let browser;
let server;
let folder;
let page;
let watched;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), 'lacquer-babylon-'));
  writeFileSync(join(folder, 'index.html'), kPage);
  const made = join(output, 'package');
  await build({
    entryPoints: [join(root, 'web/test/babylon_page.mjs')], outdir: folder, entryNames: 'page', bundle: true, format: 'esm', splitting: true,
    target: 'es2022', logLevel: 'error', external: ['./packed.js'], nodePaths: [join(root, 'web/node_modules')],
    alias: {
      '@lacquer-shaders/lacquer/babylon': join(made, 'babylon.js'), '@lacquer-shaders/lacquer/gltf': join(made, 'gltf.js'),
      '@lacquer-shaders/lacquer': join(made, 'index.js'),
    },
  });
  copyFileSync(join(made, 'lacquer.wasm'), join(folder, 'lacquer.wasm'));
  cpSync(join(root, 'web/examples/webgl2'), join(folder, 'webgl2'), { recursive: true });
  // Its lamp's direction is a unit but for a thousandth.
  const unit = (text) => JSON.stringify(JSON.parse(text).map((x, _, all) => x / Math.hypot(...all)));
  const example = read('web/examples/webgl2/main.js').toString().replace(/\[-?0\.4, -?0\.5, -?0\.77\]/g, unit);
  writeFileSync(join(folder, 'webgl2/main.js'), example);
  mkdirSync(join(folder, 'webgl2/node_modules/@lacquer-shaders'), { recursive: true });
  symlinkSync(made, join(folder, 'webgl2/node_modules/@lacquer-shaders/lacquer'));
  const [real] = realFiles();
  if (real) symlinkSync(dirname(dirname(real)), join(folder, 'assets'));
  cpSync(join(root, 'examples'), join(folder, 'examples'), { recursive: true, filter: (name) => !/\.(cpp|h|txt)$/.test(name) });
  server = await serve(folder);
  page = await browser.newPage();
  watched = listen(page, kStarts);
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
async function besideTheLibrary({ text, material, texel, rightHanded, tangents = true }) {
  const file = JSON.parse(text);
  const size = 8;
  const scene = sceneOf(rightHanded);
  const mesh = quadOf(scene, { tangents });
  const look = file.materials[material];
  const pictures = (file.textures ?? []).map(() => (srgb) => {
    const raw = new BABYLON.RawTexture(new Uint8Array(texel), 1, 1, 5, scene, false, false, 2, 0, 0, srgb);
    raw.gammaSpace = false;
    return raw;
  });
  const images = (file.textures ?? []).map((_, i) => ({ uri: `${i}.png` }));
  const alone = { asset: file.asset, materials: [look], images, textures: images.map((_, source) => ({ source })) };
  const graph = lacquer.scene(JSON.stringify(alone), 'a.gltf').graph(0, {}, lacquered.attributesOf(mesh));
  mesh.material = lacquered.materialFrom(lacquer, look, scene, { textures: pictures.map((make) => make(false)) });
  for (const { name, srgb, texture } of graph.textures()) if (srgb) mesh.material.setTexture(name, pictures[texture](true));
  mesh.material.alphaMode = BABYLON.Constants.ALPHA_DISABLE;
  const light = lampOf(scene);
  const drawn = await colours(scene, cameraOf(scene), size);
  const l = [0.3, 0.5, 0.9].map((x) => x / Math.hypot(0.3, 0.5, 0.9));
  const radiance = light.diffuse.asArray().map((x) => x * light.intensity);
  const points = Array.from({ length: size * size }, (_, i) => {
    const [x, y] = [i % size, Math.floor(i / size)].map((at) => ((at + 0.5) / size - 0.5) * 1.5);
    const eye = [-x, -y, 3].map((each) => each / Math.hypot(x, y, 3));
    return { n: [0, 0, 1], t: [1, 0, 0, 1], v: eye, l, light: radiance, uv0: [x / 2 + 0.5, 0.5 - y / 2], position: [x, y, 0] };
  });
  const decoded = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
  const linear = (srgb) => texel.map((x, i) => (srgb && i < 3 ? decoded(x / 255) : x / 255));
  const texels = graph.textures().map(({ name, srgb }) => `${name}=${linear(srgb).join()}`);
  const { rgba } = graph.evaluate(points, { texels, ibl: false });
  const lod = mesh.material.looksThrough;
  scene.dispose();
  return { drawn, expected: rgba.flat(), names: graph.textures().map(({ name }) => name), lod };
}

test('materials have the colours of the library under a lamp, in a scene of either hand', async () => {
  let compared = 0;
  for (const file of inputs().filter((name) => name.startsWith('examples/') || name.startsWith('bench/'))) {
    const text = read(file).toString();
    const { materials } = JSON.parse(text);
    for (let material = 0; material < materials.length; ++material) {
      const rightHanded = compared % 2 === 0;
      const { drawn, expected, lod } = await inPage(besideTheLibrary, { text, material, rightHanded, texel: [255, 255, 255, 255] });
      if (lod) continue; // what is behind is the scene's
      assertAlike(drawn, expected, `${file} ${materials[material].name} ${rightHanded}`);
      ++compared;
    }
  }
  assert.ok(compared > 20, `${compared}`);
});

test('pictures reach their slots, in their colour spaces, and normals bend alike in a scene of either hand', async () => {
  const text = read('examples/core.gltf').toString();
  const { materials } = JSON.parse(text);
  const material = materials.findIndex((each) => JSON.stringify(each).includes('normalTexture'));
  assert.ok(material >= 0);
  let right;
  for (const rightHanded of [true, false]) {
    for (const tangents of [true, false]) {
      const { drawn, expected, names } = await inPage(besideTheLibrary, { text, material, rightHanded, tangents, texel: [200, 120, 180, 255] });
      assert.ok(names.length > 0);
      right ??= expected; // u runs to the right, v down: the tangents that the quad may have are those that its shader finds
      assertAlike(drawn, right, `${materials[material].name} ${rightHanded} ${tangents}`);
    }
  }
});

test('surroundings light a scene, and turn and dim as Babylon.js has it', async () => {
  const at = await inPage(async () => {
    const [width, height] = [64, 32];
    const head = new TextEncoder().encode(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`);
    const picture = new Uint8Array(head.length + 4 * width * height);
    picture.set(head);
    // One where +x is, nothing elsewhere.
    for (let i = 0; i < width * height; ++i)
      if (i % width > width / 4 && i % width < (3 * width) / 4) picture.set([128, 64, 32, 130], head.length + 4 * i);
    const results = {};
    for (const rightHanded of [true, false]) {
      const scene = sceneOf(rightHanded);
      const environment = lacquered.environmentOf(lacquer, scene, picture, { size: 32, samples: 64 });
      const mesh = quadOf(scene);
      const white = { pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1 } };
      mesh.material = lacquered.materialFrom(lacquer, white, scene);
      const camera = cameraOf(scene);
      const middle = async () => (await colours(scene, camera, 1)).slice(0, 3);
      const dark = await middle();
      lacquered.setEnvironment(scene, environment);
      const half = await middle();
      scene.environmentIntensity = 0.5;
      const dimmed = await middle();
      scene.environmentIntensity = 1;
      // The quad's front is brought to where it is bright, and away; it is seen from there.
      const turned = async (angle) => {
        mesh.parent.rotationQuaternion = null;
        mesh.parent.scaling.z = rightHanded ? 1 : -1;
        mesh.parent.rotation.y = angle + (rightHanded ? 0 : Math.PI);
        camera.position = new BABYLON.Vector3(Math.sign(angle) * 3, 0, 0);
        camera.setTarget(BABYLON.Vector3.Zero());
        return middle();
      };
      const side = rightHanded ? 1 : -1; // +x of the file
      const bright = await turned((side * Math.PI) / 2);
      const away = await turned((-side * Math.PI) / 2);
      mesh.parent.rotation.y = rightHanded ? 0 : Math.PI;
      camera.position = placed(scene, 0, 0, 3);
      camera.setTarget(BABYLON.Vector3.Zero());
      const maps = lacquer.environment(picture, 'environment.hdr', { size: 32, samples: 64 });
      lacquered.setEnvironment(scene, lacquered.environmentOf(lacquer, scene, maps));
      const filtered = await middle();
      lacquered.setEnvironment(scene, null);
      results[rightHanded] = { dark, half, dimmed, bright, away, filtered, none: await middle() };
      environment.dispose();
      scene.dispose();
    }
    return results;
  });
  for (const of of Object.values(at)) {
    assert.deepEqual(of.dark, [0, 0, 0]);
    assert.deepEqual(of.none, [0, 0, 0]);
    assert.ok(of.half[0] > 0.8 && of.half[0] < 1.2, `${of.half}`);
    assert.deepEqual(of.filtered, of.half);
    of.dimmed.forEach((x, i) => assert.ok(Math.abs(x - of.half[i] / 2) < 1e-3));
    assert.ok(of.bright[0] > 1.6, `${of.bright}`);
    assert.ok(of.away[0] < 0.3, `${of.away}`);
  }
});

test('the scene\'s own cube lights what setEnvironment() does not, as it lights Babylon.js\'s materials', async () => {
  const at = await inPage(async () => {
    // Each direction has its own colour, and red has stripes.
    const [width, height] = [64, 32];
    const head = new TextEncoder().encode(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`);
    const rows = Array.from({ length: height }, (_, y) => [2, 2, 0, width, ...[0, 1, 2, 3].flatMap((channel) => [...Array(width).keys()].flatMap((x) => {
      const turn = (2 * Math.PI * (x + 0.5)) / width;
      return [1, [120 + 60 * Math.cos(turn) + 60 * ((x >> 2) % 2), 240 - 7 * y, 120 + 110 * Math.sin(turn), 129][channel]];
    }))]);
    const url = URL.createObjectURL(new Blob([head, Uint8Array.from(rows.flat())]));
    const results = [];
    for (const rightHanded of [true, false]) {
      const scene = sceneOf(rightHanded);
      await new Promise((done, failed) => {
        scene.environmentTexture = new BABYLON.HDRCubeTexture(url, scene, 32, false, true, false, true, done, failed);
      });
      scene.environmentTexture.rotationY = 0.7;
      scene.environmentIntensity = 0.8;
      const mesh = quadOf(scene);
      mesh.parent.rotationQuaternion = BABYLON.Quaternion.FromEulerAngles(0.3, 0.4, 0).multiply(mesh.parent.rotationQuaternion ?? BABYLON.Quaternion.Identity());
      const camera = cameraOf(scene);
      for (const [metallic, roughness] of [[1, 0.05], [1, 0.5], [0, 1]]) {
        mesh.material = lacquered.materialFrom(lacquer, { pbrMetallicRoughness: { metallicFactor: metallic, roughnessFactor: roughness } }, scene);
        const own = await colours(scene, camera, 3);
        mesh.material = new BABYLON.PBRMaterial('theirs', scene);
        Object.assign(mesh.material, { metallic, roughness, environmentBRDFTexture: mesh.material.environmentBRDFTexture });
        const theirs = await colours(scene, camera, 3);
        results.push({ rightHanded, metallic, roughness, own: own.slice(16, 19), theirs: theirs.slice(16, 19) });
      }
      scene.dispose();
    }
    return results;
  });
  for (const { own, theirs, ...of } of at) {
    assert.ok(own[0] > 0.1, `${JSON.stringify(of)}: ${own}`);
    // What bounces more than once has another form in each.
    own.forEach((x, i) => assert.ok(Math.abs(x - theirs[i]) < 0.03, `${JSON.stringify(of)}: ${own}, not ${theirs}`));
  }
});

/** Counts of what WebGL holds. */
const kHeld = () => {
  const gl = engine._gl;
  if (window.held) return;
  window.held = { program: 0, buffer: 0, texture: 0 };
  for (const [kind, name] of [['program', 'Program'], ['buffer', 'Buffer'], ['texture', 'Texture']]) {
    const [make, drop] = [gl[`create${name}`], gl[`delete${name}`]];
    gl[`create${name}`] = (...of) => (++held[kind], make.apply(gl, of));
    gl[`delete${name}`] = (...of) => (--held[kind], drop.apply(gl, of));
  }
};

test('numbers change without a program, and what was made is given back', async () => {
  await inPage(kHeld);
  const at = await inPage(async () => {
    const scene = sceneOf();
    const camera = cameraOf(scene);
    lampOf(scene);
    const mesh = quadOf(scene);
    // Programs of other tests are kept: no other one has this material's.
    const extensions = { KHR_materials_clearcoat: { clearcoatFactor: 0.5 }, KHR_materials_sheen: { sheenColorFactor: [0.05, 0, 0] } };
    const look = { pbrMetallicRoughness: { metallicFactor: 0 }, emissiveFactor: [0.01, 0, 0], extensions };
    mesh.material = new BABYLON.StandardMaterial('theirs', scene); // what Babylon.js makes for a mesh of any material
    await colours(scene, camera);
    mesh.material = lacquered.materialFrom(lacquer, look, scene);
    const standing = { ...held };
    const first = await colours(scene, camera);
    const one = { ...held };
    mesh.material.set({ base_color_factor: [0.1, 0.2, 0.3, 1] });
    const second = await colours(scene, camera);
    const other = mesh.material.clone('other');
    const before = mesh.material;
    mesh.material = other;
    const kept = await colours(scene, camera);
    other.set({ base_color_factor: [1, 1, 1, 1] });
    const third = await colours(scene, camera);
    const still = held.program;
    let refused = '';
    try {
      other.set({ base_colour: 1 });
    } catch (error) {
      refused = String(error);
    }
    const names = other.parameters().map(({ name }) => name);
    before.dispose(true);
    other.dispose(true);
    const left = { ...held };
    scene.dispose();
    return { first, second, kept, third, one, still, standing, left, refused, names, scene: { ...held } };
  });
  assert.equal(at.one.program, at.standing.program + 1);
  assert.equal(at.still, at.one.program);
  assert.equal(at.left.program, at.one.program - 1);
  assert.ok(at.left.buffer <= at.standing.buffer, `${at.left.buffer} ${at.standing.buffer}`);
  assert.ok(at.second[0] < at.first[0] / 2);
  assert.deepEqual(at.kept, at.second);
  assert.deepEqual(at.third, at.first);
  assert.match(at.refused, /no parameter base_colour; it has .*base_color_factor/);
  assert.ok(at.names.includes('base_color_factor'));
});

/** Which colours a mesh shows where, by its own material and by one of Babylon.js: an array of both. */
async function covered({ kind, rightHanded }) {
  const scene = sceneOf(rightHanded);
  const camera = cameraOf(scene, kind !== 'logarithmic depth');
  const mesh = quadOf(scene);
  const { Bone, Matrix, MorphTarget, MorphTargetManager, Plane, Quaternion, Skeleton, Vector3, VertexBuffer } = BABYLON;
  const theirMaterial = (brightness) => {
    const material = new BABYLON.StandardMaterial('theirs', scene);
    material.emissiveColor = new BABYLON.Color3(brightness, brightness, brightness);
    material.disableLighting = true;
    material.useLogarithmicDepth = kind === 'logarithmic depth';
    return material;
  };
  if (kind.endsWith('own colours')) {
    mesh.setVerticesData(VertexBuffer.ColorKind, [1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 1]);
    if (kind.startsWith('instances')) mesh.useVertexColors = false;
  }
  if (kind === 'skin') {
    const skeleton = new Skeleton('skeleton', 'skeleton', scene);
    const first = new Bone('first', skeleton, null, Matrix.Identity());
    const second = new Bone('second', skeleton, first, Matrix.Identity());
    mesh.setVerticesData(VertexBuffer.MatricesIndicesKind, [0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]);
    mesh.setVerticesData(VertexBuffer.MatricesWeightsKind, [1, 0, 0, 0, 0.5, 0.5, 0, 0, 1, 0, 0, 0, 0.25, 0.75, 0, 0]);
    mesh.skeleton = skeleton;
    first.rotate(new Vector3(0, 0, 1), 0.4);
    second.setPosition(new Vector3(0.3, -0.2, 0));
    second.scale(0.7, 0.7, 0.7);
  } else if (kind === 'morph') {
    mesh.morphTargetManager = new MorphTargetManager(scene);
    const positions = Array.from(mesh.getVerticesData(VertexBuffer.PositionKind));
    for (const [weight, moved] of [[1, Array(12).fill(0)], [0.8, [0.9, 0.9, 0, 0, 0, 0, -0.3, -0.7, 0, 0, -0.9, 0]]]) {
      const target = new MorphTarget('target', weight, scene);
      target.setPositions(positions.map((x, i) => x + moved[i]));
      mesh.morphTargetManager.addTarget(target);
    }
  } else if (kind === 'clipping planes') {
    scene.clipPlane = new Plane(1, 0.5, 0, -0.2);
    scene.clipPlane3 = new Plane(-1, 0.3, 0, -0.4);
  } else if (kind === 'logarithmic depth') {
    [camera.minZ, camera.maxZ] = [0.01, 1e7];
    const other = quadOf(scene);
    other.rotation.y = 0.3;
    other.position.z = 0.1;
    other.material = theirMaterial(0);
  } else if (/^(instances|thin)/.test(kind)) {
    for (let i = 0; i < 3; ++i) {
      const turn = Quaternion.RotationAxis(new Vector3(0, 0, 1), i);
      const [size, at] = [new Vector3(0.1 + 0.1 * i, 0.2, 1), new Vector3(0.5 * i - 0.5, 0.2 * i, -i)];
      if (kind.startsWith('thin')) mesh.thinInstanceAdd(Matrix.Compose(size, turn, at));
      else Object.assign(mesh.createInstance(`${i}`), { parent: mesh.parent, scaling: size, rotationQuaternion: turn, position: at });
    }
    const colored = [[1, 0, 0, 1], [0, 1, 0, 1], [1, 0, 1, 1]];
    if (/^thin.*colours/.test(kind)) mesh.thinInstanceSetBuffer('color', new Float32Array(colored.flat()), 4);
    if (/^instances.*colours/.test(kind)) {
      mesh.registerInstancedBuffer(VertexBuffer.ColorInstanceKind, 4);
      mesh.instancedBuffers[VertexBuffer.ColorInstanceKind] = new BABYLON.Color4(1, 1, 1, 1);
      mesh.instances.forEach((each, i) => { each.instancedBuffers[VertexBuffer.ColorInstanceKind] = new BABYLON.Color4(...colored[i]); });
    }
    if (kind.startsWith('instances')) mesh.position.x = 9;
  }
  mesh.rotation.z = kind.startsWith('instances') ? 0 : 0.2;
  const seen = async (material) => {
    mesh.material = material;
    return (await colours(scene, camera, 32)).filter((_, i) => i % 4 < 3).map((x) => (x > 0.5 ? 1 : 0));
  };
  const own = lacquered.materialFrom(lacquer, { extensions: { KHR_materials_unlit: {} } }, scene);
  own.useLogarithmicDepth = kind === 'logarithmic depth';
  const both = [await seen(own), await seen(theirMaterial(1))];
  scene.dispose();
  return both;
}

test('skins, morph targets, instances, clipping planes and depth are those of Babylon.js\'s own materials', async () => {
  for (const rightHanded of [true, false]) {
    for (const kind of [
      'plain', 'skin', 'morph', 'instances', 'thin', 'instances with colours', 'thin with colours', 'thin with colours over own colours',
      'instances with colours without own colours', 'clipping planes', 'logarithmic depth',
    ]) {
      const [own, theirs] = await inPage(covered, { kind, rightHanded });
      const sum = theirs.reduce((all, x) => all + x, 0);
      assert.ok(sum > 100 && (kind === 'plain' || sum < 3000), `${kind} ${rightHanded}: ${sum}`);
      const off = own.filter((x, i) => x !== theirs[i]).length;
      assert.ok(off <= 6, `${kind} ${rightHanded}: ${off} of ${sum} values`);
    }
  }
});

test('fog and image processing are the scene\'s', async () => {
  const at = await inPage(async () => {
    const { Color3, ImageProcessingConfiguration, PBRMaterial, Scene } = BABYLON;
    const scene = new Scene(engine);
    scene.useRightHandedSystem = true;
    const camera = cameraOf(scene, false);
    camera.fov = 0.5;
    const mesh = quadOf(scene);
    const glowing = { emissiveFactor: [0.5, 0.25, 1], pbrMetallicRoughness: { baseColorFactor: [0, 0, 0, 1] } };
    const own = lacquered.materialFrom(lacquer, glowing, scene);
    const theirs = new PBRMaterial('theirs', scene);
    theirs.unlit = true;
    theirs.albedoColor = new Color3(0.5, 0.25, 1);
    const shown = async (material) => {
      mesh.material = material;
      await scene.whenReadyAsync();
      scene.render();
      const gl = engine._gl;
      const pixel = new Uint8Array(4);
      gl.readPixels(32, 32, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      return [...pixel];
    };
    const both = async () => [await shown(own), await shown(theirs)];
    const plain = await both();
    const { imageProcessingConfiguration: processing } = scene;
    processing.toneMappingEnabled = true;
    processing.toneMappingType = ImageProcessingConfiguration.TONEMAPPING_KHR_PBR_NEUTRAL;
    processing.exposure = 1.5;
    processing.contrast = 1.2;
    const toned = await both();
    scene.fogMode = Scene.FOGMODE_LINEAR;
    [scene.fogStart, scene.fogEnd] = [1, 6];
    scene.fogColor = new Color3(0.2, 0.4, 0.6);
    const foggy = await both();
    scene.fogMode = Scene.FOGMODE_EXP2;
    scene.fogDensity = 0.3;
    const denser = await both();
    scene.dispose();
    return { plain, toned, foggy, denser };
  });
  for (const [name, [own, theirs]] of Object.entries(at)) {
    own.forEach((x, i) => assert.ok(Math.abs(x - theirs[i]) <= 2, `${name}: ${own}, not ${theirs}`));
  }
  assert.notDeepEqual(at.plain[0], at.toned[0]);
  assert.notDeepEqual(at.toned[0], at.foggy[0]);
});

test('through glass the scene is seen, and no other glass', async () => {
  const at = await inPage(async () => {
    const results = [];
    for (const rightHanded of [true, false]) {
      const scene = sceneOf(rightHanded);
      const wall = quadOf(scene);
      wall.position.z = -2;
      wall.scaling.setAll(4);
      wall.material = new BABYLON.StandardMaterial('wall', scene);
      Object.assign(wall.material, { emissiveColor: new BABYLON.Color3(0.2, 0.8, 0.4), disableLighting: true });
      const glass = quadOf(scene);
      const extensions = { KHR_materials_transmission: { transmissionFactor: 1 } };
      const clear = { pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 0 }, extensions };
      glass.material = lacquered.materialFrom(lacquer, clear, scene);
      const behind = quadOf(scene);
      behind.material = glass.material;
      behind.position.z = -1;
      const camera = cameraOf(scene, false);
      camera.fov = 0.3;
      await colours(scene, camera, 9);
      results.push((await colours(scene, camera, 9)).slice(4 * 40, 4 * 40 + 3));
      scene.dispose();
    }
    return results;
  });
  // The wall's numbers are sRGB. Fresnel takes four hundredths.
  for (const seen of at) [0.2, 0.8, 0.4].forEach((x, i) => assert.ok(Math.abs(seen[i] - 0.96 * x ** 2.2) < 0.01, `${seen}`));
});

test('shadows fall from it on what Babylon.js draws', async () => {
  const [lit, shaded] = await inPage(async () => {
    const scene = sceneOf();
    const camera = cameraOf(scene);
    const lamp = lampOf(scene);
    lamp.direction.set(1, 0, -1);
    lamp.position.set(-4, 0, 4);
    const wall = quadOf(scene);
    wall.material = new BABYLON.StandardMaterial('wall', scene);
    wall.receiveShadows = true;
    const caster = quadOf(scene);
    caster.scaling.setAll(0.3);
    caster.position.set(-1.2, 0, 1.2);
    caster.material = lacquered.materialFrom(lacquer, { doubleSided: true }, scene);
    const middle = async () => (await colours(scene, camera, 9))[4 * 40];
    const before = await middle();
    const shadows = new BABYLON.ShadowGenerator(256, lamp);
    shadows.addShadowCaster(caster);
    await middle();
    const after = await middle();
    scene.dispose();
    return [before, after];
  });
  assert.ok(lit > 0.3 && shaded < 0.1 * lit, `${lit} ${shaded}`);
});

/** What is left of a lamp's light over a wall behind a small square, by Lacquer's material and by Babylon.js's own. */
async function shares({ kind, filter, others = 0, receives = true, rightHanded = true }) {
  const scene = sceneOf(rightHanded);
  const camera = cameraOf(scene);
  const { DirectionalLight, PBRMaterial, PointLight, ShadowGenerator, SpotLight } = BABYLON;
  const [near, to] = [placed(scene, 0.4, 0.3, 2), placed(scene, -0.4, -0.3, -2)];
  const kinds = {
    directional: () => new DirectionalLight('lamp', to, scene), point: () => new PointLight('lamp', near, scene),
    spot: () => new SpotLight('lamp', near, to, 1.2, 1, scene),
  };
  // Lights without a shadow before it: the number of a shadow is not that of a caster.
  for (let i = 0; i < others; ++i) kinds[['point', 'directional', 'spot'][i]]().intensity = 1e-6;
  const lamp = kinds[kind]();
  lamp.position = near;
  [lamp.shadowMinZ, lamp.shadowMaxZ, lamp.intensity] = [0.2, 5, 10];
  const wall = quadOf(scene);
  wall.receiveShadows = receives;
  const square = quadOf(scene);
  square.scaling.setAll(0.2);
  square.position = placed(scene, 0.05, 0.1, 0.5);
  square.material = new PBRMaterial('square', scene);
  // Seen by the lamp alone.
  Object.assign(square.material, { backFaceCulling: false, disableColorWrite: true, disableDepthWrite: true });
  const drawn = async (material, casts) => {
    wall.material = material;
    scene.shadowsEnabled = casts;
    await colours(scene, camera, 32);
    return (await colours(scene, camera, 32)).filter((_, i) => i % 4 === 0);
  };
  const shadows = new ShadowGenerator(128, lamp);
  shadows.filter = ShadowGenerator[filter];
  shadows.bias = 0.005;
  shadows.darkness = 0.1;
  shadows.addShadowCaster(square);
  const share = async (make) => {
    const [without, all] = [await drawn(make(), false), await drawn(make(), true)];
    return all.map((x, i) => x / without[i]);
  };
  const own = await share(() => lacquered.materialFrom(lacquer, { doubleSided: true, pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1 } }, scene));
  const theirs = await share(() => {
    const plain = new PBRMaterial('plain', scene);
    return Object.assign(plain, { metallic: 0, roughness: 1, backFaceCulling: false });
  });
  scene.dispose();
  return { own, theirs };
}

test("shadows fall on it as on Babylon.js's own materials", async () => {
  const filters = { directional: ['FILTER_NONE', 'FILTER_PCF', 'FILTER_BLUREXPONENTIALSHADOWMAP', 'FILTER_PCSS'], spot: ['FILTER_PCF'], point: ['FILTER_NONE', 'FILTER_POISSONSAMPLING'] };
  const cases = Object.entries(filters).flatMap(([kind, all]) => all.map((filter) => ({ kind, filter })));
  cases.push({ kind: 'directional', filter: 'FILTER_PCF', others: 3 }, { kind: 'spot', filter: 'FILTER_PCF', rightHanded: false });
  for (const each of cases) {
    const what = JSON.stringify(each);
    const { own, theirs } = await inPage(shares, each);
    const dark = theirs.filter((x) => x < 0.3).length;
    assert.ok(dark > 15 && theirs.filter((x) => x > 0.95).length > 400, `${what}: Babylon.js has ${dark} dark pixels`);
    const far = own.filter((x, i) => !(Math.abs(x - theirs[i]) < 0.03)).length;
    assert.ok(far === 0, `${what}: ${far} pixels are not as Babylon.js has them, which has ${dark} dark ones`);
  }
  const { own } = await inPage(shares, { kind: 'directional', filter: 'FILTER_PCF', receives: false });
  assert.ok(own.every((x) => Math.abs(x - 1) < 1e-3), 'receiveShadows is false');
});

test('points and spots light as they do in the library, those that do not reach a mesh not', async () => {
  const at = await inPage(async () => {
    const results = [];
    for (const rightHanded of [true, false]) {
      const { Color3, PointLight, SpotLight } = BABYLON;
      const scene = sceneOf(rightHanded);
      const mesh = quadOf(scene);
      mesh.material = lacquered.materialFrom(lacquer, { pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1 } }, scene);
      const camera = cameraOf(scene);
      const near = placed(scene, 0.5, 0, 1);
      const middle = async () => (await colours(scene, camera, 1))[0];
      const point = new PointLight('point', near, scene);
      [point.intensity, point.range, point.diffuse] = [3, 4, new Color3(1, 1, 1)];
      const lit = await middle();
      point.excludedMeshes.push(mesh);
      const excluded = await middle();
      point.setEnabled(false);
      const spot = new SpotLight('spot', near, near.scale(-1), 1, 1, scene);
      [spot.intensity, spot.range, spot.angle, spot.innerAngle] = [3, 4, 0.5, 0.3];
      const aimed = await middle();
      spot.direction = placed(scene, 1, 0, -1);
      results.push({ lit, excluded, aimed, past: await middle() });
      scene.dispose();
    }
    return results;
  });
  for (const { lit, excluded, aimed, past } of at) {
    // Of 3 candela at a distance of the root of 1.25, under a cosine of that, to the window of a range of 4; the rest is the lobe's.
    const distance2 = 1.25;
    const irradiance = (3 / distance2) * (1 / Math.sqrt(distance2)) * (1 - (distance2 / 16) ** 2);
    assert.ok(lit > (0.9 * irradiance) / Math.PI && lit < (1.1 * irradiance) / Math.PI, `${lit} ${irradiance / Math.PI}`);
    assert.ok(Math.abs(aimed - lit) < 1e-3, `${aimed} ${lit}`);
    assert.deepEqual([excluded, past], [0, 0]);
  }
});

test('what is wrong is refused and changes nothing', async () => {
  const said = await inPage(async () => {
    const scene = sceneOf();
    const camera = cameraOf(scene);
    lampOf(scene);
    const mesh = quadOf(scene);
    mesh.material = lacquered.materialFrom(lacquer, {}, scene);
    const before = await colours(scene, camera, 1);
    const refused = (run) => {
      try {
        run();
        return 'taken';
      } catch (error) {
        return String(error);
      }
    };
    const make = (template) => lacquered.materialFrom(lacquer, {}, scene, { options: { template } }).prepare([]);
    const texts = [
      refused(() => mesh.material.set({ base_color_factor: [0.5, 1] })),
      refused(() => mesh.material.set({ roughness_factor: NaN })),
      refused(() => mesh.material.setTexture('coat_texture', null)),
      refused(() => lacquered.setEnvironment(scene, {})),
      refused(() => lacquered.environmentOf(lacquer, scene, undefined)),
      refused(() => make('bsdf')),
      refused(() => make('forward_clustered')),
    ];
    const after = await colours(scene, camera, 1);
    mesh.material.set({ base_color_factor: new Float32Array([0, 0, 0, 1]) });
    const dark = (await colours(scene, camera, 1))[0] < before[0] / 2;
    scene.dispose();
    return { texts, same: String(before) === String(after), dark };
  });
  const expected = [/2 numbers/, /NaN is no number/, /reads no texture coat_texture/, /no environment/, /Radiance picture/, /not bsdf/, /not forward_clustered/];
  expected.forEach((text, i) => assert.match(said.texts[i], text));
  assert.ok(said.same && said.dark);
});

test('colours of vertices are drawn, and not where the mesh does not use them', async () => {
  const at = await inPage(async () => {
    const scene = sceneOf();
    const camera = cameraOf(scene);
    lampOf(scene);
    const mesh = quadOf(scene);
    mesh.setVerticesData(BABYLON.VertexBuffer.ColorKind, [1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1]);
    mesh.material = lacquered.materialFrom(lacquer, { pbrMetallicRoughness: { metallicFactor: 0 } }, scene);
    const red = await colours(scene, camera, 1);
    mesh.useVertexColors = false;
    const white = await colours(scene, camera, 1);
    scene.dispose();
    return { red, white };
  });
  assert.ok(at.red[0] > 2 * at.red[1], `${at.red}`);
  assert.ok(at.white[1] > 2 * at.red[1], `${at.white}`);
});

/** A file by Babylon.js's loader with the extension, drawn: what has become of its materials. */
async function loaded({ url, container = false, rightHanded = true }) {
  const told = [];
  BABYLON.registerGLTFExtension('LACQUER', false, (loader) => new lacquered.LacquerExtension(loader, lacquer, { onMessage: (message) => told.push(message) }));
  const scene = sceneOf(rightHanded);
  try {
    if (container) {
      const held = await BABYLON.LoadAssetContainerAsync(url, scene);
      if (scene.materials.length !== 0 || !held.materials.some((each) => each.isLacquerMaterial)) throw new Error('the container has them not');
      held.addAllToScene();
    } else {
      await BABYLON.AppendSceneAsync(url, scene);
    }
    lampOf(scene);
    const { min, max } = scene.getWorldExtends((mesh) => mesh.getTotalVertices() > 0);
    const radius = Math.max(max.subtract(min).length() / 2, 1e-6);
    const camera = new BABYLON.TargetCamera('camera', min.add(max).scale(0.5).add(new BABYLON.Vector3(0, 0, 3 * radius)), scene);
    camera.setTarget(min.add(max).scale(0.5));
    [camera.fov, camera.minZ, camera.maxZ] = [0.68, radius / 4, 10 * radius];
    const drawn = await colours(scene, camera, 32);
    const meshes = scene.meshes.filter((mesh) => mesh.getTotalVertices() > 0);
    return {
      kinds: meshes.map(({ material }) => material?.isLacquerMaterial === true),
      materials: scene.materials.filter((each, i, all) => all.indexOf(each) !== i).length,
      errors: told.filter(({ level }) => level === 'error').map(({ text }) => text),
      finite: drawn.every(Number.isFinite), lit: drawn.some((x, i) => i % 4 < 3 && x > 0.01),
    };
  } finally {
    scene.dispose();
    BABYLON.unregisterGLTFExtension('LACQUER');
  }
}

test('the loader with the extension draws every example', async () => {
  for (const file of inputs().filter((name) => name.startsWith('examples/'))) {
    const { kinds, errors, finite, materials } = await inPage(loaded, { url: `${server.url}/${file}` }, kLoads);
    assert.deepEqual(errors, [], file);
    assert.ok(kinds.length > 0 && kinds.every(Boolean) && finite && materials === 0, `${file}: ${kinds} ${finite} ${materials}`);
  }
  for (const container of [false, true]) {
    for (const rightHanded of [false, true]) {
      const { kinds, lit, materials } = await inPage(loaded, { url: `${server.url}/webgl2/triangle.gltf`, container, rightHanded }, kLoads);
      assert.ok(kinds.every(Boolean) && lit && materials === 0, `${container} ${rightHanded}`);
    }
  }
});

/** Materials of several extensions each, from bench/peers/gallery.gltf. */
const kSeveral = [
  'Clearcoat over rough metal', 'Iridescence under clearcoat', 'Anisotropy, turned', 'Anisotropy under clearcoat', 'Coat, all of it',
  'Coloured coat over metal', 'Clearcoat colour', 'Diffuse roughness', 'Retroreflection', 'Specular-glossiness', 'Texture transform', 'Bump',
];

/** Balls of them, with tangents, in rows of four; one is a mirrored and stretched one. */
function balls() {
  const gallery = JSON.parse(read('bench/peers/gallery.gltf'));
  const materials = kSeveral.map((name) => gallery.materials.find((each) => each.name === name));
  const [columns, rows] = [48, 24];
  const data = { POSITION: [], NORMAL: [], TANGENT: [], TEXCOORD_0: [] };
  for (let i = 0; i < (columns + 1) * (rows + 1); ++i) {
    const [u, v] = [(i % (columns + 1)) / columns, Math.floor(i / (columns + 1)) / rows];
    const [turn, polar] = [2 * Math.PI * u, Math.PI * v];
    const n = [Math.sin(polar) * Math.sin(turn), Math.cos(polar), Math.sin(polar) * Math.cos(turn)];
    data.POSITION.push(...n);
    data.NORMAL.push(...n);
    data.TANGENT.push(Math.cos(turn), 0, -Math.sin(turn), 1);
    data.TEXCOORD_0.push(u, v);
  }
  const indices = [];
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const [a, b] = [row, row + 1].map((each) => each * (columns + 1) + column);
      indices.push(a, b, a + 1, a + 1, b, b + 1);
    }
  }
  const parts = [...Object.values(data).map((numbers) => Buffer.from(Float32Array.from(numbers).buffer)), Buffer.from(Uint16Array.from(indices).buffer)];
  let byteOffset = 0;
  const bufferViews = parts.map(({ length: byteLength }) => ({ buffer: 0, byteLength, byteOffset: (byteOffset += byteLength) - byteLength }));
  const count = (columns + 1) * (rows + 1);
  const types = ['VEC3', 'VEC3', 'VEC4', 'VEC2'];
  const accessors = [
    ...types.map((type, bufferView) => ({ bufferView, componentType: 5126, count, type, ...(bufferView ? {} : { min: [-1, -1, -1], max: [1, 1, 1] }) })),
    { bufferView: 4, componentType: 5123, count: indices.length, type: 'SCALAR' },
  ];
  const { images, textures, extensionsUsed } = gallery;
  const attributes = { POSITION: 0, NORMAL: 1, TANGENT: 2, TEXCOORD_0: 3 };
  const nodes = materials.map((_, i) => ({ mesh: i, translation: [2.2 * (i % 4), -2.2 * Math.floor(i / 4), 0] }));
  Object.assign(nodes[3], { scale: [-0.7, 1, 1.2], rotation: [0, Math.sin(0.3), 0, Math.cos(0.3)] });
  return glb({
    asset: { version: '2.0' }, extensionsUsed, materials, images, textures, nodes, accessors, bufferViews, buffers: [{ byteLength: byteOffset }],
    meshes: materials.map((_each, material) => ({ primitives: [{ attributes, indices: 4, material }] })),
    scene: 0, scenes: [{ nodes: nodes.map((_, i) => i) }],
  }, Buffer.concat(parts));
}

/** The pixels of web/examples/webgl2, which has the camera and the lamp of ballsLikeIt(). */
async function byTheExample(file) {
  const own = await browser.newPage();
  try {
    await own.addInitScript(() => {
      const { getContext } = HTMLCanvasElement.prototype;
      HTMLCanvasElement.prototype.getContext = function (kind) {
        this.width = this.height = 256;
        return (window.gl = getContext.call(this, kind, { antialias: false, preserveDrawingBuffer: true }));
      };
      const { generateMipmap } = WebGL2RenderingContext.prototype;
      WebGL2RenderingContext.prototype.generateMipmap = function (target) {
        generateMipmap.call(this, target);
        this.texParameteri(target, this.TEXTURE_MIN_FILTER, this.LINEAR_MIPMAP_LINEAR);
      };
    });
    const { unlessItFails } = listen(own, kSlow);
    await own.goto(`${server.url}/webgl2/index.html?${file}`, { timeout: kPatience });
    await unlessItFails(own.waitForFunction(() => document.title === 'drawn', null, { timeout: kPatience }));
    return await own.evaluate(() => {
      const pixels = new Uint8Array(4 * 256 * 256);
      gl.readPixels(0, 0, 256, 256, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      return Array.from(pixels);
    });
  } finally {
    await own.close();
  }
}

async function ballsLikeIt({ url, rightHanded }) {
  const options = { ibl: false };
  BABYLON.registerGLTFExtension('LACQUER', false, (loader) => new lacquered.LacquerExtension(loader, lacquer, { options }));
  const scene = sceneOf(rightHanded);
  try {
    await BABYLON.AppendSceneAsync(url, scene);
    scene.textures.forEach((texture) => (texture.anisotropicFilteringLevel = 1));
    scene.clearColor = new BABYLON.Color4(0.1, 0.1, 0.12, 1);
    const lamp = lampOf(scene);
    [lamp.direction, lamp.diffuse, lamp.intensity] = [placed(scene, -0.4, -0.5, -0.77), new BABYLON.Color3(1, 1, 1), 3];
    const { bounds, fetchGltf, geometry } = files;
    const { middle: [x, y, z], radius } = bounds(geometry(await fetchGltf(url)));
    const camera = new BABYLON.TargetCamera('camera', placed(scene, x, y, z + 3 * radius), scene);
    camera.setTarget(placed(scene, x, y, z));
    [camera.fov, camera.minZ, camera.maxZ] = [2 * Math.atan(1 / 2.8), radius, 5 * radius];
    return await colours(scene, camera, 256);
  } finally {
    scene.dispose();
    BABYLON.unregisterGLTFExtension('LACQUER');
  }
}

test('a file of several extensions looks as in a page of our own, in a scene of either hand', async () => {
  writeFileSync(join(folder, 'webgl2/balls.glb'), balls());
  const expected = await byTheExample('balls.glb');
  const lit = expected.filter((x, i) => i % 4 === 0 && x > 60).length;
  assert.ok(lit > 5_000, `${lit}`);
  for (const rightHanded of [true, false]) {
    const drawn = await inPage(ballsLikeIt, { url: `${server.url}/webgl2/balls.glb`, rightHanded }, kLoads);
    let off = 0;
    expected.forEach((x, i) => {
      if (i % 4 < 3 && Math.abs(Math.min(Math.max(drawn[i], 0), 1) * 255 - x) > 2) ++off;
    });
    // Of 196,608: what lies on the edges of triangles.
    assert.ok(off < 10, `${rightHanded}: ${off} numbers are off by more than 2 / 255`);
  }
});

test('the loader with the extension draws real files', async (t) => {
  const files = drawnFiles();
  if (files.length === 0) return t.skip('there is no assets folder');
  for (const file of files) {
    const place = `${basename(dirname(file))}/${basename(file)}`;
    const { kinds, errors, finite, lit } = await inPage(loaded, { url: `${server.url}/assets/${place}` }, kLoads);
    assert.deepEqual(errors, [], place);
    assert.ok(kinds.every(Boolean) && finite && (lit || kinds.length === 0), `${place}: ${kinds} ${finite} ${lit}`);
  }
});

test('its example draws, without a bundler', async () => {
  const place = join(folder, 'example');
  cpSync(join(root, 'web/examples/babylon'), place, { recursive: true });
  mkdirSync(join(place, 'node_modules/@lacquer-shaders'), { recursive: true });
  symlinkSync(join(root, 'web/node_modules/@babylonjs'), join(place, 'node_modules/@babylonjs'));
  symlinkSync(join(output, 'package'), join(place, 'node_modules/@lacquer-shaders/lacquer'));
  const own = await browser.newPage();
  try {
    const { said, unlessItFails } = listen(own, kStarts);
    await own.goto(`${server.url}/example/index.html`, { timeout: kPatience });
    await unlessItFails(own.waitForFunction(() => document.title === 'drawn', null, { timeout: kPatience }));
    assert.deepEqual(said, []);
    assert.ok((await own.locator('canvas').screenshot()).length > 3000);
  } finally {
    await own.close();
  }
});
