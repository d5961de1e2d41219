// What of ESSL a renderer has otherwise: blocks and attributes.
import type { Interface } from '../types.js';

/** A uniform block: its name, its members, its instance's name. */
export const kBlock = /^layout\(std140\) uniform (\w+) \{\n((?: {4}.*\n)*)\}(?: (\w+))?;$/gm;
/** A vertex attribute: its location, its type, its variable. */
export const kInput = /^(?:layout\(location = (\d+)\) )in (\w+) (in_\w+);$/gm;

/** The attribute of glTF that a variable of the vertex stage stands for. */
export const semanticOf = (shader: Interface, location: string, variable: string): string =>
  shader.inputs?.find((input) => input.location === Number(location))?.name ?? variable;

/** A stage without its version, whose main() is a function that a renderer's own calls. */
export const asFunction = (essl: string): string => essl.replace(/^#version.*\n/, '').replace('void main() {', 'void surface() {');
