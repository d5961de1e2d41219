// forward-base-3af5dabd320269c3a8c2194cf058616d
// Lacquer 0.2.0, template forward

#include <metal_stdlib>
#include <simd/simd.h>

using namespace metal;

struct Frame
{
    float4x4 view_projection;
    packed_float3 camera_position;
    float environment_intensity;
    float environment_max_lod;
    int light_count;
};

struct Object
{
    float4x4 model;
    float4x4 normal_matrix;
};

struct main0_out
{
    float4 gl_Position [[position, invariant]];
};

struct main0_in
{
    float3 in_position [[attribute(0)]];
};

vertex main0_out main0(main0_in in [[stage_in]], constant Frame& frame [[buffer(0)]], constant Object& object [[buffer(3)]])
{
    main0_out out = {};
    float4 _26 = float4(in.in_position, 1.0);
    float4 _27 = object.model * _26;
    float4 _30 = frame.view_projection * _27;
    out.gl_Position = _30;
    return out;
}

