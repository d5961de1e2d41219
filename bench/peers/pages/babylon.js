// Babylon.js as an application uses it that tone maps afterwards: linear colours, no tone mapping in the material.
import { Color4, Engine, HDRCubeTexture, LoadSceneAsync } from '@babylonjs/core/index.js';
import '@babylonjs/loaders/glTF/2.0/index.js';
import { canvasOf, capture } from './capture.js';

let engine, environment;

/** A cube of the environment, filtered for roughness when it is loaded. */
const load = () => new Promise((done, fail) => {
  const loaded = () => done(made), failed = (message) => fail(new Error(message));
  const made = new HDRCubeTexture('/environment.hdr', engine, 64, false, true, false, true, loaded, failed);
});

window.draw = async (request) => {
  engine ??= new Engine(canvasOf(request), false);
  const scene = await LoadSceneAsync(request.scene, engine, { pluginOptions: { gltf: { useOpenPBR: request.openpbr } } });
  scene.clearColor = new Color4(0, 0, 0, 1);
  scene.imageProcessingConfiguration.applyByPostProcess = true;
  scene.activeCamera = scene.cameras[0];
  if (request.environment) scene.environmentTexture = environment ??= await load();
  await scene.whenReadyAsync();
  try {
    return await capture(request, () => scene.render());
  } finally {
    scene.environmentTexture = null;
    scene.dispose();
  }
};
