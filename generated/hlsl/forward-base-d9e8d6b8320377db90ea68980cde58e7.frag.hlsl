// forward-base-d9e8d6b8320377db90ea68980cde58e7
// Lacquer 0.2.0, template forward

struct MaterialBlock {
    float4 base_color_factor;
};

cbuffer Material : register(b2) {
    MaterialBlock material;
};

Texture2D base_color_texture : register(t3);
SamplerState base_color_texture_sampler : register(s3);

void main(
    float2 v_uv0 : TEXCOORD0,
    float4 v_COLOR_0 : TEXCOORD1,
    out float4 out_color : SV_Target0) {
    // color0
    float4 color0 = clamp(v_COLOR_0, 0.0, 1.0);

    // base_color.texel: glTF 2.0, "Textures"
    float4 texel = base_color_texture.Sample(base_color_texture_sampler, v_uv0);

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    float4 color = material.base_color_factor * texel * color0;

    // output
    out_color = float4(color.xyz, 1.0);
}
