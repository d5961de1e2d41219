// forward-coat-7130ba43ba0454a30d51e12e6cfd0609
// Lacquer 0.2.0, template forward

struct FrameBlock {
    column_major float4x4 view_projection;
    float3 camera_position;
    float environment_intensity;
    float environment_max_lod;
    int light_count;
};

cbuffer Frame : register(b0) {
    FrameBlock frame;
};

struct ObjectBlock {
    column_major float4x4 model;
    column_major float4x4 normal_matrix;
};

cbuffer Object : register(b3) {
    ObjectBlock object;
};

struct MaterialBlock {
    float3 emissive_factor;
    float metallic_factor;
    float3 coat_color_factor;
    float roughness_factor;
    float3 base_color_factor;
    float coat_factor;
    float3 base_color_complement;
    float coat_roughness_factor;
    float3 metal_repeated;
    float row_u_x;
    float3 F0;
    float row_u_y;
    float row_v_x;
    float row_v_y;
    float coat_color_uv_offset_x;
    float coat_color_uv_offset_y;
    float coat_factor_times_0_96;
    float coat_factor_times_0_04;
    float alpha2;
    float alpha2_ratio;
    float weight_times_ggx_peak;
    float coat_alpha2;
    float coat_alpha2_ratio;
    float coat_weight_times_ggx_peak;
    float lambert;
    float least_f0;
    float inverse_metallic;
    float inverse_clear;
    float dielectric_repeated;
    float white_F0;
};

cbuffer Material : register(b2) {
    MaterialBlock material;
};

void main(
    float3 in_position : POSITION,
    float3 in_normal : NORMAL,
    float2 in_texcoord_0 : TEXCOORD0,
    out float3 v_position : TEXCOORD0,
    out float3 v_normal : TEXCOORD1,
    out float2 v_uv : TEXCOORD2,
    out float4 out_position : SV_Position) {
    // world
    float4 world = mul(object.model, float4(in_position, 1.0));

    // normal
    float4 normal_part = mul(object.normal_matrix, float4(in_normal, 0.0));
    float normal_part_2 = normal_part.y * normal_part.y + (normal_part.z * normal_part.z + 1e-32);
    float3 N = normal_part.xyz * rsqrt(normal_part.x * normal_part.x + normal_part_2);

    // coat_color.uv: KHR_texture_transform, "Overview"
    float2 uv = float2(material.row_u_x * in_texcoord_0.x + material.row_u_y * in_texcoord_0.y + material.coat_color_uv_offset_x, material.row_v_y * in_texcoord_0.y - material.row_v_x * in_texcoord_0.x + material.coat_color_uv_offset_y);

    // output
    out_position = mul(frame.view_projection, world);

    // position
    v_position = world.xyz;

    // normal
    v_normal = N;

    // coat_color.uv: KHR_texture_transform, "Overview"
    v_uv = uv;
}
