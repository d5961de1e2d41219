// forward-base-3af5dabd320269c3a8c2194cf058616d
// Lacquer 0.2.0, template forward

#include <metal_stdlib>
#include <simd/simd.h>

using namespace metal;

struct Material
{
    float4 output_output;
};

struct main0_out
{
    float4 out_color [[color(0)]];
};

fragment main0_out main0(constant Material& material [[buffer(2)]])
{
    main0_out out = {};
    out.out_color = material.output_output;
    return out;
}

