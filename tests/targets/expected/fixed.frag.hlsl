// Printed by the tests.

// Shader Model 6: the register is the binding and the space the set; so with -D LACQUER_SPACES=1 for 5.1.
// Shader Model 5.0 has one row of registers for all sets.
#ifndef LACQUER_SPACES
#define LACQUER_SPACES (__SHADER_TARGET_MAJOR >= 6)
#endif
#if LACQUER_SPACES
#define LACQUER_AT(row, place, space) register(place, space)
#else
#define LACQUER_AT(row, place, space) register(row)
#endif

#define LACQUER_ROOT_SIGNATURE \
    "RootFlags(ALLOW_INPUT_ASSEMBLER_INPUT_LAYOUT), " \
    "RootConstants(num32BitConstants=1, b0, space=3), " \
    "DescriptorTable(SRV(t0, space=2, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "DescriptorTable(Sampler(s0, space=2, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "CBV(b0, space=1), " \
    "DescriptorTable(SRV(t0, space=1, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "DescriptorTable(Sampler(s0, space=1, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "CBV(b1, space=0), " \
    "DescriptorTable(SRV(t0, space=0, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "DescriptorTable(Sampler(s0, space=0, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE))"

struct Light {
    float3 direction;
    float range;
    float3 color;
    int type;
};

cbuffer Lights : LACQUER_AT(b1, b1, space0) {
    Light lights[16];
};

void main(
    float2 v_uv : TEXCOORD0,
    float v_weight : TEXCOORD1,
    out float4 out_first : SV_Target0,
    out float4 out_second : SV_Target1) {
    // alpha.mask: glTF 2.0, "Alpha Coverage"
    if (v_weight < 0.5) {
        discard;
    }

    // odd name/: a line that must not continue /
    out_first = float4(v_uv + v_weight, float2(1.0, 1.0));
    out_second = float4(lights[2].color * v_weight, 1e-7);
}
