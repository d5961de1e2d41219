// Small shaders, one per language, that use what the printers use: a uniform block, a texture, an input, an
// output.
#pragma once

#include <string>

namespace lacquer::check {

inline const std::string kVulkanFragment = R"(#version 450
layout(set = 0, binding = 0, std140) uniform Material {
  vec4 color;
  vec3 tint;
  float ior;
  mat3 turn;
  mat4 world;
  vec4 lights[3];
  float weights[2];
} material;
layout(set = 0, binding = 1) uniform sampler2D color_texture;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;
void main() {
  vec3 tint = material.turn * material.tint * material.ior * material.weights[1];
  result = material.world * texture(color_texture, uv) * material.color * vec4(tint, 1.0) + material.lights[2];
}
)";

inline const std::string kVulkanVertex = R"(#version 450
layout(set = 1, binding = 2, std140) uniform Frame { mat4 view; } frame;
layout(location = 0) in vec3 position;
layout(location = 0) out vec2 uv;
void main() {
  uv = position.xy;
  gl_Position = frame.view * vec4(position, 1.0);
}
)";

inline const std::string kOpenGlFragment = R"(#version 450
layout(binding = 0, std140) uniform Material { vec4 color; } material;
layout(binding = 1) uniform sampler2D color_texture;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;
void main() { result = texture(color_texture, uv) * material.color; }
)";

inline const std::string kEsslFragment = R"(#version 300 es
precision highp float;
layout(std140) uniform Material { vec4 color; };
uniform sampler2D color_texture;
in vec2 uv;
layout(location = 0) out vec4 result;
void main() { result = texture(color_texture, uv) * color; }
)";

inline const std::string kEsslVertex = R"(#version 300 es
layout(std140) uniform Frame { mat4 view; };
layout(location = 0) in vec3 position;
out vec2 uv;
void main() {
  uv = position.xy;
  gl_Position = view * vec4(position, 1.0);
}
)";

inline const std::string kHlslFragment = R"(cbuffer Material : register(b0) {
  float4 color;
  float3 tint;
  float ior;
  float3x3 turn;
};
cbuffer Frame : register(b1) { float4x4 view; };
Texture2D color_texture : register(t0);
Texture2D tint_texture : register(t1);
SamplerState color_sampler : register(s0);
SamplerState tint_sampler : register(s1);

float4 lookUp(Texture2D map, SamplerState state, float2 uv) { return map.Sample(state, uv); }

float4 main(float2 uv : TEXCOORD0) : SV_Target0 {
  float3 t = mul(turn, tint) * ior * lookUp(tint_texture, tint_sampler, uv).rgb;
  return mul(view, lookUp(color_texture, color_sampler, uv) * color * float4(t, 1));
}
)";

inline const std::string kHlslVertex = R"(cbuffer Frame : register(b0) { float4x4 view; };
struct Output {
  float4 position : SV_Position;
  float2 uv : TEXCOORD0;
};
Output main(float3 position : POSITION) {
  Output o;
  o.position = mul(view, float4(position, 1));
  o.uv = position.xy;
  return o;
}
)";

}  // namespace lacquer::check
