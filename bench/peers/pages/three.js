// three.js as an application uses it that tone maps afterwards: linear colours, no tone mapping in the material.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
import { canvasOf, capture } from './capture.js';

let renderer, environment;

function make(request) {
  renderer = new THREE.WebGLRenderer({ canvas: canvasOf(request), antialias: false });
  renderer.setPixelRatio(1);
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  renderer.toneMapping = THREE.NoToneMapping;
}

async function load() {
  const picture = await new HDRLoader().loadAsync('/environment.hdr');
  picture.mapping = THREE.EquirectangularReflectionMapping;
  return new THREE.PMREMGenerator(renderer).fromEquirectangular(picture).texture;
}

window.draw = async (request) => {
  if (!renderer) make(request);
  const file = await new GLTFLoader().loadAsync(request.scene);
  const scene = new THREE.Scene().add(file.scene);
  if (request.environment) scene.environment = environment ??= await load();
  return capture(request, () => renderer.render(scene, file.cameras[0]));
};
