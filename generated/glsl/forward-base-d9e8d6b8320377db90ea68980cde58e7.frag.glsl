#version 450
// forward-base-d9e8d6b8320377db90ea68980cde58e7
// Lacquer 0.2.0, template forward

layout(std140, set = 1, binding = 0) uniform Material {
    vec4 base_color_factor;
} material;

layout(set = 1, binding = 1) uniform sampler2D base_color_texture;

layout(location = 0) in vec2 v_uv0;
layout(location = 1) in vec4 v_COLOR_0;

layout(location = 0) out vec4 out_color;

void main() {
    // color0
    vec4 color0 = clamp(v_COLOR_0, 0.0, 1.0);

    // base_color.texel: glTF 2.0, "Textures"
    vec4 texel = texture(base_color_texture, v_uv0);

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    vec4 color = material.base_color_factor * texel * color0;

    // output
    out_color = vec4(color.xyz, 1.0);
}
