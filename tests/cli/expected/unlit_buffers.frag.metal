// forward-base-3af5dabd320269c3a8c2194cf058616d
// Lacquer 0.2.0, template forward

#include <metal_stdlib>
#include <simd/simd.h>

using namespace metal;

struct Material
{
    float4 output_output;
};

struct spvDescriptorSetBuffer1
{
    constant Material* material [[id(0)]];
};

struct main0_out
{
    float4 out_color [[color(0)]];
};

fragment main0_out main0(constant spvDescriptorSetBuffer1& spvDescriptorSet1 [[buffer(1)]])
{
    main0_out out = {};
    out.out_color = (*spvDescriptorSet1.material).output_output;
    return out;
}

