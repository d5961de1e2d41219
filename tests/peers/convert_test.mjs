// `node --test tests/peers/convert_test.mjs`: the way from a peer's shader to SPIR-V, on a text with what the peers' texts hold.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { vulkanGlsl } from '../../bench/peers/convert.mjs';

const kSource = `#version 300 es
#extension GL_OES_standard_derivatives : enable
#define varying in
precision mediump sampler2D; precision lowp int;
precision mediump float; // float of what?
layout(location = 0) out mediump vec4 out_color;
struct Light { vec3 direction; float intensity; };
uniform Light lights[2];
uniform float roughness, metallic;
uniform sampler2D color_map;
uniform samplerCube surroundings;
layout(std140) uniform Scene { mat4 view; vec3 eye; };
varying vec3 normal;
flat in int which;
/* precision of
   two lines */
vec3 average(vec3 color) { return vec3((color.x + color.y + color.z) / 3.0); }
vec3 lookup(sampler2D sampler, vec2 shared) { return texture(sampler, shared).rgb; }
void main() {
  lowp vec3 n = normalize(normal + dFdx(eye));
  vec3 light = max(dot(n, lights[0].direction), 0.0) * lights[which].intensity * lookup(color_map, n.xy);
  out_color = vec4(average(light) * roughness + textureLod(surroundings, mat3(view) * n, metallic).rgb, 1.0);
}
`;

test('precision, extensions and comments go, all else stays', () => {
  const text = vulkanGlsl(kSource);
  assert.match(text, /^#version 450\nprecision highp float;\nprecision highp int;\n/);
  assert.doesNotMatch(text, /mediump|lowp|#extension|\/\/|\/\*|300 es/);
  assert.equal(text.match(/precision /g).length, 2);
  assert.match(text, /layout\(location = 0\) out highp vec4 out_color;/);
  assert.match(text, /#define varying in\n/);
  assert.match(text, /lookup\(sampler2D sampler_, vec2 shared_\) \{ return texture\(sampler_, shared_\)/);
});

test('another version is refused', () => {
  assert.throws(() => vulkanGlsl('#version 100\nvoid main() {}'), /not of "#version 300 es" but of "#version 100"/);
  assert.throws(() => vulkanGlsl('void main() {}'), /no version/);
});

const glslang = spawnSync('glslangValidator', ['--version']);
test('glslang takes it', { skip: glslang.error && 'glslangValidator is not installed' }, () => {
  const folder = mkdtempSync(join(tmpdir(), 'lacquer-peers-'));
  try {
    writeFileSync(join(folder, 'x.frag'), vulkanGlsl(kSource));
    const options = ['-V', '-R', '--auto-map-bindings', '--auto-map-locations', '-o', join(folder, 'x.spv'), '-H'];
    const listing = execFileSync('glslangValidator', [...options, join(folder, 'x.frag')], { encoding: 'utf8' });
    assert.match(listing, /gl_DefaultUniformBlock/);
    assert.doesNotMatch(listing, /RelaxedPrecision/);
    // A binding of its own for each: the block of lone uniforms, the named one and two textures.
    const bindings = [...listing.matchAll(/Decorate .* Binding (\d+)/g)].map((match) => match[1]);
    assert.equal(new Set(bindings).size, 4);
    assert.equal(bindings.length, 4);
  } finally {
    rmSync(folder, { recursive: true });
  }
});
