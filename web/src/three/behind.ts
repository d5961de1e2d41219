// The scene without what is seen through, for materials that look through: drawn once for each picture that needs it.
import {
  HalfFloatType, LinearFilter, LinearMipmapLinearFilter, Matrix4, NoToneMapping, Vector2, WebGLRenderTarget, type Camera, type Material,
  type Mesh, type Object3D, type Scene, type Texture, type WebGLRenderer,
} from 'three';
import { behindValues } from '../renderers/shader.js';
import type { Values } from '../types.js';

const looksThrough = (object: Object3D): boolean => {
  const material = (object as Mesh).material as (Material & { looksThrough?: boolean }) | undefined;
  const all = Array.isArray(material) ? material : [material];
  return all.some((each) => each?.looksThrough || (each as { transmission?: number } | undefined)?.transmission);
};

interface Behind {
  target: WebGLRenderTarget;
  frame: number;
  camera: Camera | null;
}
const pictures = new WeakMap<WebGLRenderer, Behind>();

function draw(renderer: WebGLRenderer, scene: Scene, camera: Camera, target: WebGLRenderTarget): void {
  // What hangs below them stays: an object alone is in no layer.
  const hidden: { object: Object3D; mask: number }[] = [];
  scene.traverseVisible((object) => looksThrough(object) && hidden.push({ object, mask: object.layers.mask }));
  const { toneMapping, autoClear, xr, shadowMap } = renderer;
  const before = { target: renderer.getRenderTarget(), face: renderer.getActiveCubeFace(), level: renderer.getActiveMipmapLevel() };
  const [eyes, shadows] = [xr.enabled, shadowMap.autoUpdate];
  for (const { object } of hidden) object.layers.mask = 0;
  renderer.toneMapping = NoToneMapping;
  renderer.autoClear = true;
  xr.enabled = false; // the camera is one eye's already
  shadowMap.autoUpdate = false;
  renderer.setRenderTarget(target);
  try {
    renderer.render(scene, camera);
  } finally {
    renderer.setRenderTarget(before.target, before.face, before.level);
    Object.assign(renderer, { toneMapping, autoClear });
    xr.enabled = eyes;
    shadowMap.autoUpdate = shadows;
    for (const { object, mask } of hidden) object.layers.mask = mask;
  }
}

/** The texture scene_behind and the block SeeThrough. */
export function sceneBehind(renderer: WebGLRenderer, scene: Scene, camera: Camera): { texture: Texture; values: Values } {
  let behind = pictures.get(renderer);
  if (!behind) {
    const target = new WebGLRenderTarget(1, 1, {
      type: HalfFloatType, generateMipmaps: true, minFilter: LinearMipmapLinearFilter, magFilter: LinearFilter, samples: 4,
    });
    behind = { target, frame: -1, camera: null };
    pictures.set(renderer, behind);
  }
  const { target } = behind;
  const frame = renderer.info.render.frame;
  if (behind.frame !== frame || behind.camera !== camera) {
    const into = renderer.getRenderTarget();
    const size = into ? new Vector2(into.width, into.height) : renderer.getDrawingBufferSize(new Vector2());
    target.setSize(size.x, size.y);
    draw(renderer, scene, camera, target);
    // Drawing it was a frame, too.
    Object.assign(behind, { frame: renderer.info.render.frame, camera });
  }
  const m = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
  return { texture: target.texture, values: behindValues(m, target.width, target.height) };
}
