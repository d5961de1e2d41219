// What is behind: what surrounds the scene, drawn where nothing else is, and the picture so far with its mip levels, for what looks
// through (docs/bindings.md, "The frame behind").

/** What is seen beside the meshes. Where that is the page's colour, a chequered board is seen through glass. */
export type Background = 'plain' | 'environment' | 'blurred';

/** The level of an environment's map that the background shows, of so many below the first. */
export const backgroundLevel = (background: Background, last: number) => (background === 'blurred' ? 0.5 * last : 0);
/** The number of the last mip level. */
export const lastLod = (width: number, height: number) => Math.floor(Math.log2(Math.max(width, height, 1)));
/** Squares of the board along a side of the picture, and their radiance. */
export const kBoard = { squares: 8, dark: 90 / 255, light: 150 / 255 };

/** A texture with mip levels, and a framebuffer of its first. */
export interface Copy {
  texture: WebGLTexture;
  frame: WebGLFramebuffer;
}

export const kTriangleVertex = `#version 300 es
uniform float depth;
out vec2 at;
void main() {
  at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(at, depth, 1.0);
}`;

const kCopy = `#version 300 es
precision highp float;
uniform sampler2D picture;
in vec2 at;
out vec4 copied;
void main() {
  vec4 c = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
  ivec2 square = ivec2(floor((0.5 + 0.5 * at) * ${kBoard.squares.toFixed(1)}));
  float board = ((square.x + square.y) & 1) == 1 ? ${kBoard.light} : ${kBoard.dark};
  copied = vec4(c.rgb + (1.0 - clamp(c.a, 0.0, 1.0)) * board, 1.0);
}`;

const kSurround = `#version 300 es
precision highp float;
uniform samplerCube around;
uniform vec3 right, up, ahead;
uniform float level, brightness;
in vec2 at;
out vec4 seen;
void main() {
  seen = vec4(brightness * textureLod(around, at.x * right + at.y * up + ahead, level).rgb, 1.0);
}`;

export class Behind {
  private readonly copying: WebGLProgram;
  private readonly surrounding: WebGLProgram;
  private readonly places = new Map<string, WebGLUniformLocation | null>();

  constructor(private readonly gl: WebGL2RenderingContext, link: (vertex: string, fragment: string) => WebGLProgram) {
    this.copying = link(kTriangleVertex, kCopy);
    this.surrounding = link(kTriangleVertex, kSurround);
    for (const name of ['right', 'up', 'ahead', 'level', 'brightness', 'depth']) this.places.set(name, gl.getUniformLocation(this.surrounding, name));
  }

  make(width: number, height: number): Copy {
    const { gl } = this;
    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, lastLod(width, height) + 1, gl.RGBA16F, width, height);
    for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    const frame = gl.createFramebuffer()!;
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    return { texture, frame };
  }
  drop({ texture, frame }: Copy): void {
    this.gl.deleteFramebuffer(frame);
    this.gl.deleteTexture(texture);
  }

  /** Takes a picture over, with the board where it has nothing. */
  take(picture: WebGLTexture, { texture, frame }: Copy): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.disable(gl.DEPTH_TEST);
    this.triangle(this.copying, gl.TEXTURE_2D, picture);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.generateMipmap(gl.TEXTURE_2D);
  }

  /** Draws what is around where nothing has been drawn, along rays of the camera. */
  surround(map: WebGLTexture, rays: Float32Array, level: number, brightness: number): void {
    const { gl, places } = this;
    gl.useProgram(this.surrounding);
    ['right', 'up', 'ahead'].forEach((name, i) => gl.uniform3fv(places.get(name)!, rays, 3 * i, 3));
    gl.uniform1f(places.get('level')!, level);
    gl.uniform1f(places.get('brightness')!, brightness);
    gl.uniform1f(places.get('depth')!, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(false);
    this.triangle(this.surrounding, gl.TEXTURE_CUBE_MAP, map);
    gl.depthMask(true);
    gl.depthFunc(gl.LESS);
  }

  private triangle(program: WebGLProgram, kind: number, texture: WebGLTexture): void {
    const { gl } = this;
    gl.disable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
    gl.useProgram(program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(kind, texture);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}
