// A glTF file in Babylon.js, its materials by Lacquer: `npm install`, then any static server, then index.html?file.glb, and behind
// an & a Radiance picture of the surroundings: index.html?file.glb&sky.hdr.
import { TargetCamera } from '@babylonjs/core/Cameras/targetCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { DirectionalLight } from '@babylonjs/core/Lights/directionalLight.js';
import '@babylonjs/core/Loading/loadingScreen.js';
import { AppendSceneAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import { ImageProcessingConfiguration } from '@babylonjs/core/Materials/imageProcessingConfiguration.js';
import { Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Scene } from '@babylonjs/core/scene.js';
import { registerGLTFExtension } from '@babylonjs/loaders/glTF/2.0/index.js';
import { load } from '@lacquer-shaders/lacquer';
import { environmentOf, LacquerExtension, setEnvironment } from '@lacquer-shaders/lacquer/babylon';

async function main() {
  const [file, sky] = location.search.slice(1).split('&');
  const lacquer = await load();
  registerGLTFExtension('LACQUER', false, (loader) => new LacquerExtension(loader, lacquer)); // the one line more

  const engine = new Engine(document.querySelector('canvas'), true);
  const scene = new Scene(engine);
  scene.useRightHandedSystem = true; // a left-handed one does as well
  scene.clearColor = new Color4(0.1, 0.1, 0.12, 1);
  scene.imageProcessingConfiguration.toneMappingEnabled = true;
  scene.imageProcessingConfiguration.toneMappingType = ImageProcessingConfiguration.TONEMAPPING_KHR_PBR_NEUTRAL;
  await AppendSceneAsync(file || 'triangle.gltf', scene);
  new DirectionalLight('lamp', new Vector3(-0.4, -0.5, -0.77), scene).intensity = 3;
  if (sky) setEnvironment(scene, environmentOf(lacquer, scene, new Uint8Array(await (await fetch(sky)).arrayBuffer())));

  const { min, max } = scene.getWorldExtends((mesh) => mesh.getTotalVertices() > 0);
  const middle = min.add(max).scale(0.5);
  const radius = max.subtract(min).length() / 2;
  const camera = new TargetCamera('camera', middle.add(new Vector3(0, 0, 3 * radius)), scene);
  camera.setTarget(middle);
  [camera.fov, camera.minZ, camera.maxZ] = [0.68, radius, 5 * radius];
  await scene.whenReadyAsync();
  engine.runRenderLoop(() => scene.render());
  document.title = 'drawn';
}
main();
