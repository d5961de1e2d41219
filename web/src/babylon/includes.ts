// What the shaders include of Babylon.js.
import '@babylonjs/core/Shaders/ShadersInclude/bakedVertexAnimation.js';
import '@babylonjs/core/Shaders/ShadersInclude/bakedVertexAnimationDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/bonesDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/bonesVertex.js';
import '@babylonjs/core/Shaders/ShadersInclude/fogFragment.js';
import '@babylonjs/core/Shaders/ShadersInclude/fogFragmentDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/fogVertex.js';
import '@babylonjs/core/Shaders/ShadersInclude/fogVertexDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/helperFunctions.js';
import '@babylonjs/core/Shaders/ShadersInclude/imageProcessingDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/imageProcessingFunctions.js';
import '@babylonjs/core/Shaders/ShadersInclude/instancesDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/instancesVertex.js';
import '@babylonjs/core/Shaders/ShadersInclude/morphTargetsVertex.js';
import '@babylonjs/core/Shaders/ShadersInclude/morphTargetsVertexDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/morphTargetsVertexGlobal.js';
import '@babylonjs/core/Shaders/ShadersInclude/morphTargetsVertexGlobalDeclaration.js';
