// The Khronos glTF Sample Renderer. Its material shader tone maps unless it draws what is seen through glass, and that is what
// is asked of it here: the same shader with linear colours.
import { GltfState, GltfView, ResourceLoader } from '@khronosgroup/gltf-viewer';
import { canvasOf, capture } from './capture.js';

/** Samples of its filter for environments that are enough here: the environment is the same from all sides, its tables are not. */
const kSamples = { 2048: 8, 1024: 8, 64: 8, 512: 128 };

async function withFewSamples(gl, load) {
  const { uniform1i } = gl;
  gl.uniform1i = (location, value) => uniform1i.call(gl, location, kSamples[value] ?? value);
  const environment = await load();
  delete gl.uniform1i;
  return environment;
}

function linear(renderer) {
  const draw = renderer.drawPrimitive;
  renderer.drawPrimitive = function (state, configuration, ...more) {
    return draw.call(this, state, { ...configuration, linearOutput: true }, ...more);
  };
}

let made;
async function make(request) {
  const gl = canvasOf(request).getContext('webgl2', { antialias: false });
  const view = new GltfView(gl);
  const loader = new ResourceLoader(view, '/khronos/');  // without decoders of Draco and KTX, which nothing here needs
  const tables = { lut_sheen_E_file: '/sheen.png' };
  const environment = await withFewSamples(gl, () => loader.loadEnvironment('/environment.hdr', tables));
  linear(view.renderer);
  return { view, loader, environment };
}

window.draw = async (request) => {
  made ??= await make(request);
  const { view, loader, environment } = made;
  const state = view.createState();
  state.gltf = await loader.loadGltf(request.scene);
  state.environment = environment;  // always there: what lets light through reads it anyway
  state.sceneIndex = 0;
  state.cameraIndex = 0;
  Object.assign(state.renderingParameters, {
    useIBL: request.environment, usePunctual: true, renderEnvironmentMap: false, toneMap: GltfState.ToneMaps.NONE,
    clearColor: [0, 0, 0, 255],
  });
  return capture(request, () => view.renderFrame(state, request.size, request.size));
};
