/** Materials for Babylon.js whose shaders are Lacquer's: a class, an extension of its glTF loader, and the light around. */
export { LacquerMaterial, materialFrom, attributesOf, type GraphSource, type MaterialOptions } from './material.js';
export { LacquerExtension, type PluginOptions } from './loader.js';
export { environmentOf, setEnvironment, type Environment } from './environment.js';
export type { EnvironmentMaps } from '../renderers/environment.js';
