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

struct spvDescriptorSetBuffer0
{
    constant Frame* frame [[id(0)]];
};

struct spvDescriptorSetBuffer2
{
    constant Object* object [[id(0)]];
};

struct main0_out
{
    float4 gl_Position [[position, invariant]];
};

struct main0_in
{
    float3 in_position [[attribute(0)]];
};

vertex main0_out main0(main0_in in [[stage_in]], constant spvDescriptorSetBuffer0& spvDescriptorSet0 [[buffer(0)]], constant spvDescriptorSetBuffer2& spvDescriptorSet2 [[buffer(2)]])
{
    main0_out out = {};
    float4 _26 = float4(in.in_position, 1.0);
    float4 _27 = (*spvDescriptorSet2.object).model * _26;
    float4 _30 = (*spvDescriptorSet0.frame).view_projection * _27;
    out.gl_Position = _30;
    return out;
}

