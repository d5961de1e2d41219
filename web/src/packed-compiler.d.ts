/** lacquer-compiler.wasm after gzip, as base64: what `./dev web` makes. */
declare const packed: string;
export default packed;
