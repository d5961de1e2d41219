// forward-coat-bdba8852b5a24866
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
    float3 F0;
    float roughness_factor;
    float3 diffuse;
    float coat_factor;
    float3 emissive_factor;
    float coat_roughness_factor;
    float3 coat_color_factor;
    float uu;
    float3 lambert;
    float uv;
    float3 mean_fresnel;
    float vu;
    float3 base_indirect;
    float vv;
    float coat_color_uv_offset;
    float coat_color_uv_offset_2;
    float emission_transmission;
    float emission_transmission_2;
    float alpha2;
    float ratio;
    float base_specular;
    float coat_alpha2;
    float coat_ratio;
    float coat_specular;
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
    float2 uv = float2(material.uu * in_texcoord_0.x + material.uv * in_texcoord_0.y + material.coat_color_uv_offset, material.vv * in_texcoord_0.y - material.vu * in_texcoord_0.x + material.coat_color_uv_offset_2);

    // output
    out_position = mul(frame.view_projection, world);

    // position
    v_position = world.xyz;

    // normal
    v_normal = N;

    // coat_color.uv: KHR_texture_transform, "Overview"
    v_uv = uv;
}
