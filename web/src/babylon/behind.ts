// The scene without what is seen through, for materials that look through: drawn once before each camera's picture.
import '@babylonjs/core/Engines/Extensions/engine.renderTarget.js';
import { Constants } from '@babylonjs/core/Engines/constants.js';
import { RenderTargetTexture } from '@babylonjs/core/Materials/Textures/renderTargetTexture.js';
import type { AbstractMesh } from '@babylonjs/core/Meshes/abstractMesh.js';
import type { Scene } from '@babylonjs/core/scene.js';

/** Ours, or one of Babylon.js's own. */
interface Glass {
  looksThrough?: boolean;
  subSurface?: { isRefractionEnabled: boolean };
}
function looksThrough(mesh: AbstractMesh): boolean {
  const material = mesh.material as Glass | null;
  return Boolean(material?.looksThrough || material?.subSurface?.isRefractionEnabled);
}

const targets = new WeakMap<Scene, RenderTargetTexture>();
const kSamples = 4;

/** The texture scene_behind of a scene. */
export function behindOf(scene: Scene): RenderTargetTexture {
  let target = targets.get(scene);
  if (target) return target;
  const engine = scene.getEngine();
  const size = () => ({ width: Math.max(engine.getRenderWidth(true), 1), height: Math.max(engine.getRenderHeight(true), 1) });
  target = new RenderTargetTexture('lacquer: behind', size(), scene, {
    generateMipMaps: true, type: Constants.TEXTURETYPE_HALF_FLOAT, samplingMode: Constants.TEXTURE_TRILINEAR_SAMPLINGMODE,
  });
  target.samples = kSamples;
  target.gammaSpace = false;
  target.disableImageProcessing = true;
  target.ignoreCameraViewport = true;
  target.renderListPredicate = (mesh) => !looksThrough(mesh);
  target.renderList = null;
  target.wrapU = target.wrapV = Constants.TEXTURE_CLAMP_ADDRESSMODE;
  const made = target;
  target.onBeforeBindObservable.add(() => {
    const { width, height } = size();
    const now = made.getSize();
    if (now.width !== width || now.height !== height) made.resize({ width, height });
    made.clearColor = scene.clearColor.toLinearSpace();
  });
  scene.customRenderTargets.push(target);
  targets.set(scene, target);
  return target;
}
