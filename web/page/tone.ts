// What the screen shows of linear colours.

/** Exposure, the Khronos PBR neutral tone mapper, and sRGB, before the page's colour. */
export const kShowFragment = `#version 300 es
precision highp float;
uniform sampler2D picture, second;
uniform bool difference;
uniform float exposure, cut;
uniform vec3 back;
out vec4 shown;
vec3 neutral(vec3 c) {
  const float start = 0.8 - 0.04, desaturation = 0.15;
  float least = min(c.r, min(c.g, c.b));
  c -= least < 0.08 ? least - 6.25 * least * least : 0.04;
  float peak = max(c.r, max(c.g, c.b));
  if (peak < start) return c;
  float d = 1.0 - start;
  float new_peak = 1.0 - d * d / (peak + d - start);
  c *= new_peak / peak;
  return mix(c, vec3(new_peak), 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0));
}
vec3 encode(vec3 c) {
  return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 c = texelFetch(picture, at, 0);
  if (difference) {
    vec3 by = abs(c.rgb - texelFetch(second, at, 0).rgb) * exposure * 8.0;
    shown = vec4(mix(back, encode(clamp(by, 0.0, 1.0)), step(1e-4, c.a)), 1.0);
    return;
  }
  float a = clamp(c.a, 0.0, 1.0);
  vec3 lit = encode(clamp(neutral(max(c.rgb / max(a, 1e-4), 0.0) * exposure), 0.0, 1.0));
  shown = vec4(mix(back, lit, a), 1.0);
  if (abs(gl_FragCoord.x - cut) < 1.0) shown.rgb = vec3(0.85);
}`;
