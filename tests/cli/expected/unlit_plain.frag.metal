// forward-base-57950a6da550adc5f49c0bb8dcf93f38
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

