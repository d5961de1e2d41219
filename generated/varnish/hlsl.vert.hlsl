// forward-coat-32e4429d0b815c45a7890e3413a16a00
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

void main(
    float3 in_position : POSITION,
    float3 in_normal : NORMAL,
    out float3 v_position : TEXCOORD0,
    out float3 v_normal : TEXCOORD1,
    out precise float4 out_position : SV_Position) {
    // world
    float4 world = mul(object.model, float4(in_position, 1.0));

    // normal
    float4 normal_part = mul(object.normal_matrix, float4(in_normal, 0.0));
    float normal_part_2 = normal_part.y * normal_part.y + (normal_part.z * normal_part.z + 1e-32);
    float3 N = normal_part.xyz * rsqrt(normal_part.x * normal_part.x + normal_part_2);

    // output
    out_position = mul(frame.view_projection, world);

    // position
    v_position = world.xyz;

    // normal
    v_normal = N;
}
