// MaterialX as its web viewer uses it: three.js draws, the shaders are the generator's.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
import { canvasOf, capture } from './capture.js';

let renderer;

function make(request) {
  renderer = new THREE.WebGLRenderer({ canvas: canvasOf(request), antialias: false });
  renderer.setPixelRatio(1);
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  renderer.toneMapping = THREE.NoToneMapping;
}

/** One radiance from all sides: a prefiltered environment's levels, and the irradiance over pi, are the picture itself. */
async function environmentUniforms() {
  const picture = await new HDRLoader().loadAsync('/environment.hdr');
  picture.generateMipmaps = true;
  picture.minFilter = THREE.LinearMipmapLinearFilter;
  return {
    u_envMatrix: { value: new THREE.Matrix4().makeRotationY(Math.PI / 2) },
    u_envRadiance: { value: picture }, u_envIrradiance: { value: picture },
    u_envLightIntensity: { value: 1 }, u_envRadianceMips: { value: Math.log2(picture.image.width) + 1 },
  };
}

function viewUniforms(camera) {
  const view = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  return {
    u_worldMatrix: { value: new THREE.Matrix4() }, u_worldInverseTransposeMatrix: { value: new THREE.Matrix4() },
    u_viewProjectionMatrix: { value: view }, u_viewPosition: { value: camera.getWorldPosition(new THREE.Vector3()) },
  };
}

/** A light of the file shines along its node's -Z. */
function lightUniforms(scene) {
  const light = scene.getObjectByProperty('isDirectionalLight', true);
  const direction = new THREE.Vector3(0, 0, -1).applyQuaternion(light.getWorldQuaternion(new THREE.Quaternion()));
  const { r, g, b } = light.color;
  return { u_lightData: { value: [{ type: 1, direction, color: new THREE.Vector3(r, g, b), intensity: light.intensity }] } };
}

async function textureUniforms(scene, textures) {
  const folder = scene.slice(0, scene.lastIndexOf('/') + 1), uniforms = {};
  for (const [name, { file, srgb }] of Object.entries(textures)) {
    const texture = await new THREE.TextureLoader().loadAsync(folder + file);
    texture.colorSpace = srgb ? THREE.SRGBColorSpace : THREE.NoColorSpace;
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    uniforms[name] = { value: texture };
  }
  return uniforms;
}

/** MaterialX counts v upwards, glTF downwards. */
function upwards(uv) {
  const turned = uv.clone();
  for (let i = 0; i < turned.count; ++i) turned.setY(i, 1 - turned.getY(i));
  return turned;
}

const kAttributes = { i_position: 'position', i_normal: 'normal', i_tangent: 'tangent', i_texcoord_0: 'uv' };
const withoutVersion = (text) => text.replace(/^#version 300 es\n/, '');

window.draw = async (request) => {
  if (!renderer) make(request);
  const file = await new GLTFLoader().loadAsync(request.scene);
  const ball = file.scene.getObjectByProperty('isMesh', true), [camera] = file.cameras;
  file.scene.updateMatrixWorld(true);
  for (const [name, attribute] of Object.entries(kAttributes)) ball.geometry.setAttribute(name, ball.geometry.getAttribute(attribute));
  ball.geometry.setAttribute('i_texcoord_0', upwards(ball.geometry.getAttribute('uv')));
  const uniforms = {
    ...viewUniforms(camera), ...lightUniforms(file.scene), ...(await textureUniforms(request.scene, request.shaders.textures)),
    ...(request.environment ? await environmentUniforms() : {}),
  };
  ball.material = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3, uniforms,
    vertexShader: withoutVersion(request.shaders.vertex), fragmentShader: withoutVersion(request.shaders.fragment),
  });
  return capture(request, () => renderer.render(file.scene, camera));
};
