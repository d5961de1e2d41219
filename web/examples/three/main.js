// A glTF file in three.js, its materials by Lacquer: `npm install`, then any static server, then index.html?file.glb, and behind
// an & a Radiance picture of the surroundings: index.html?file.glb&sky.hdr.
import { load } from '@lacquer-shaders/lacquer';
import { environmentOf, LacquerPlugin, setEnvironment } from '@lacquer-shaders/lacquer/three';
import { Box3, Color, DirectionalLight, NeutralToneMapping, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

const renderer = new WebGLRenderer({ canvas: document.querySelector('canvas'), antialias: true });
renderer.toneMapping = NeutralToneMapping;

async function main() {
  const [file, sky] = location.search.slice(1).split('&');
  const lacquer = await load();
  const loader = new GLTFLoader();
  loader.register((parser) => new LacquerPlugin(parser, lacquer)); // the one line more
  const { scene: model } = await loader.loadAsync(file || 'triangle.gltf');

  const scene = new Scene();
  scene.background = new Color(0.1, 0.1, 0.12);
  scene.add(model);
  const lamp = new DirectionalLight(0xffffff, 3);
  lamp.position.set(0.4, 0.5, 0.77);
  scene.add(lamp);
  if (sky) setEnvironment(scene, environmentOf(lacquer, new Uint8Array(await (await fetch(sky)).arrayBuffer())));

  const box = new Box3().setFromObject(model);
  const middle = box.getCenter(new Vector3());
  const radius = box.getSize(new Vector3()).length() / 2;
  const camera = new PerspectiveCamera(39, 1, radius, 5 * radius);
  camera.position.copy(middle).z += 3 * radius;
  renderer.render(scene, camera);
  document.title = 'drawn';
}
main();
