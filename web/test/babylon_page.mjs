// What the tests of /babylon have in their page: the modules as globals, and what the tests share. It is bundled for it.
import '@babylonjs/core/Culling/ray.js';
import '@babylonjs/core/Engines/Extensions/engine.renderTarget.js';
import '@babylonjs/core/Engines/Extensions/engine.readTexture.js';
import '@babylonjs/core/Lights/Shadows/shadowGeneratorSceneComponent.js';
import '@babylonjs/core/Meshes/instancedMesh.js';
import '@babylonjs/core/Meshes/thinInstanceMesh.js';
import '@babylonjs/core/Materials/standardMaterial.js';
import '@babylonjs/loaders/glTF/2.0/index.js';
import {
  AppendSceneAsync, Bone, Camera, Color3, Color4, Constants, DirectionalLight, Engine, HDRCubeTexture, HemisphericLight,
  ImageProcessingConfiguration, LoadAssetContainerAsync, Matrix, Mesh, MeshBuilder, MorphTarget, MorphTargetManager, PBRMaterial, Plane, PointLight,
  Quaternion, RawTexture, RenderTargetTexture, Scene, ShadowGenerator, Skeleton, SpotLight, StandardMaterial, TargetCamera, TransformNode,
  Vector3, VertexBuffer, VertexData,
} from '@babylonjs/core';
import { registerGLTFExtension, unregisterGLTFExtension } from '@babylonjs/loaders/glTF/2.0/index.js';
import { load } from '@lacquer-shaders/lacquer';
import * as files from '@lacquer-shaders/lacquer/gltf';
import * as lacquered from '@lacquer-shaders/lacquer/babylon';

const BABYLON = {
  AppendSceneAsync, Bone, Camera, Color3, Color4, Constants, DirectionalLight, Engine, HDRCubeTexture, HemisphericLight,
  ImageProcessingConfiguration, LoadAssetContainerAsync, Matrix, Mesh, MeshBuilder, MorphTarget, MorphTargetManager, PBRMaterial, Plane, PointLight,
  Quaternion, RawTexture, RenderTargetTexture, Scene, ShadowGenerator, Skeleton, SpotLight, StandardMaterial, TargetCamera, TransformNode,
  Vector3, VertexBuffer, VertexData, registerGLTFExtension, unregisterGLTFExtension,
};
const engine = new Engine(document.querySelector('canvas'), false, { preserveDrawingBuffer: true });
Object.assign(window, { BABYLON, lacquered, files, engine, lacquer: await load('lacquer.wasm') });

/** A scene whose materials give linear colours. */
window.sceneOf = (rightHanded = true) => {
  const scene = new Scene(engine);
  scene.useRightHandedSystem = rightHanded;
  scene.clearColor = new Color4(0, 0, 0, 0);
  scene.imageProcessingConfiguration.applyByPostProcess = true;
  return scene;
};
/** Where a point of a file stands in a scene: a left-handed one has it mirrored, as the loader has. */
window.placed = (scene, x, y, z) => new Vector3(scene.useRightHandedSystem ? x : -x, y, z);
/** What hangs below it stands as the loader places a file. */
window.rootOf = (scene) => {
  const root = new TransformNode('root', scene);
  if (!scene.useRightHandedSystem) {
    root.rotationQuaternion = new Quaternion(0, 1, 0, 0);
    root.scaling.z = -1;
  }
  return root;
};
/** From z = 3 to the origin, through a field of 1.5 units there. */
window.cameraOf = (scene, orthographic = true) => {
  const camera = new TargetCamera('camera', placed(scene, 0, 0, 3), scene);
  camera.setTarget(Vector3.Zero());
  [camera.minZ, camera.maxZ] = [0.1, 10];
  if (!orthographic) return camera;
  camera.mode = Camera.ORTHOGRAPHIC_CAMERA;
  [camera.orthoLeft, camera.orthoRight, camera.orthoBottom, camera.orthoTop] = [-0.75, 0.75, -0.75, 0.75];
  return camera;
};
/** A quad of two units in the plane z = 0. */
window.quadOf = (scene, { tangents = true } = {}) => {
  const mesh = new Mesh('quad', scene);
  const data = new VertexData();
  data.positions = [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0];
  data.normals = [0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1];
  data.uvs = [0, 1, 1, 1, 1, 0, 0, 0];
  if (tangents) data.tangents = [1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1];
  data.indices = [0, 1, 2, 0, 2, 3];
  data.applyToMesh(mesh, true);
  mesh.sideOrientation = scene.useRightHandedSystem ? 1 : 0; // as the loader has it
  mesh.parent = rootOf(scene);
  return mesh;
};
window.lampOf = (scene) => {
  const lamp = new DirectionalLight('lamp', placed(scene, -0.3, -0.5, -0.9), scene);
  lamp.diffuse = new Color3(1, 0.9, 0.8);
  lamp.intensity = 2;
  return lamp;
};
/** A scene's linear colours, row by row from below. */
window.colours = async (scene, camera, size = 8) => {
  const target = new RenderTargetTexture('target', size, scene, { generateMipMaps: false, type: Constants.TEXTURETYPE_FLOAT });
  camera.outputRenderTarget = target;
  scene.activeCamera = camera;
  await scene.whenReadyAsync();
  scene.render();
  const rgba = Array.from(await target.readPixels());
  camera.outputRenderTarget = null;
  target.dispose();
  const error = engine._gl.getError();
  if (error !== 0) throw new Error(`WebGL says ${error}`);
  return rgba;
};
document.title = 'ready';
