// Printed by the tests.

struct FrameBlock {
    column_major float4x4 view_projection;
    float3 camera_position;
    int light_count;
    float exposure;
};

cbuffer Frame : register(b0) {
    FrameBlock frame;
};

struct ObjectBlock {
    column_major float4x4 model;
};

cbuffer Object : register(b3) {
    ObjectBlock object;
};

void main(
    float3 in_position : POSITION,
    float3 in_normal : NORMAL,
    float2 in_texcoord_0 : TEXCOORD0,
    out float3 v_position : TEXCOORD0,
    out float3 v_normal : TEXCOORD1,
    out float2 v_uv : TEXCOORD2,
    out precise float4 out_position : SV_Position) {
    // vertex.position
    float4 world_position = mul(object.model, float4(in_position, 1.0));

    out_position = mul(frame.view_projection, world_position);
    v_position = world_position.xyz;
    v_normal = in_normal;
    v_uv = in_texcoord_0;
}
