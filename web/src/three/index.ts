/** Materials for three.js whose shaders are Lacquer's: a class, a plugin of GLTFLoader, and the light around. */
export { LacquerMaterial, materialFrom, attributesOf, type MaterialOptions } from './material.js';
export { LacquerPlugin, type PluginOptions } from './loader.js';
export { environmentOf, setEnvironment, type Environment } from './environment.js';
export type { EnvironmentMaps } from '../renderers/environment.js';
