// forward-base-d9e8d6b8320377db90ea68980cde58e7
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
    float2 in_texcoord_0 : TEXCOORD0,
    float4 in_color_0 : COLOR0,
    out float2 v_uv0 : TEXCOORD0,
    out float4 v_COLOR_0 : TEXCOORD1,
    out float4 out_position : SV_Position) {
    // world
    float4 world = mul(object.model, float4(in_position, 1.0));

    // output
    out_position = mul(frame.view_projection, world);
    v_uv0 = in_texcoord_0;
    v_COLOR_0 = in_color_0;
}
