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
    "DescriptorTable(SRV(t0, space=0, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "DescriptorTable(Sampler(s0, space=0, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE))"

Texture2D map : LACQUER_AT(t3, t1, space1);
#ifndef map_sampler
SamplerState map_sampler : LACQUER_AT(s3, s1, space1);
#endif
TextureCube around : LACQUER_AT(t0, t2, space0);
#ifndef around_sampler
SamplerState around_sampler : LACQUER_AT(s0, s2, space0);
#endif
Texture2D depths : LACQUER_AT(t1, t3, space0);
#ifndef depths_sampler
SamplerComparisonState depths_sampler : LACQUER_AT(s1, s3, space0);
#endif
Texture2DArray tiles : LACQUER_AT(t2, t4, space0);
#ifndef tiles_sampler
SamplerState tiles_sampler : LACQUER_AT(s2, s4, space0);
#endif
Texture3D volume : LACQUER_AT(t3, t5, space0);
#ifndef volume_sampler
SamplerState volume_sampler : LACQUER_AT(s3, s5, space0);
#endif

int2 lacquer_size(Texture2D map, int level) {
    uint width, height, levels;
    map.GetDimensions(uint(level), width, height, levels);
    return int2(width, height);
}

int2 lacquer_size(TextureCube map, int level) {
    uint width, height, levels;
    map.GetDimensions(uint(level), width, height, levels);
    return int2(width, height);
}

int3 lacquer_size(Texture2DArray map, int level) {
    uint width, height, depth, levels;
    map.GetDimensions(uint(level), width, height, depth, levels);
    return int3(width, height, depth);
}

int3 lacquer_size(Texture3D map, int level) {
    uint width, height, depth, levels;
    map.GetDimensions(uint(level), width, height, depth, levels);
    return int3(width, height, depth);
}

void main(
    float2 v_uv : TEXCOORD0,
    float3 v_way : TEXCOORD1,
    out float4 out_color : SV_Target0,
    out float out_weight : SV_Target1,
    out float2 out_place : SV_Target2,
    out int out_texels : SV_Target3,
    out uint out_bits : SV_Target4,
    out float out_nearness : SV_Depth) {
    float2 dFdx_2 = ddx(v_uv);
    float2 dFdy_2 = ddy(v_uv);
    float4 of_map = map.SampleGrad(map_sampler, v_uv, dFdx_2, dFdy_2);
    int to_int = int(v_uv.x);
    float3 dFdx_3 = ddx(v_way);
    float3 dFdy_3 = ddy(v_way);
    float4 of_around = around.SampleGrad(around_sampler, v_way, dFdx_3, dFdy_3);
    int whole_add = lacquer_size(map, to_int).x + lacquer_size(map, 0).y + lacquer_size(around, to_int).x + lacquer_size(around, 0).y + lacquer_size(depths, to_int).x;
    float4 of_tiles = tiles.SampleGrad(tiles_sampler, v_way, dFdx_2, dFdy_2);
    int whole_add_2 = whole_add + lacquer_size(depths, 0).y + lacquer_size(tiles, to_int).x + lacquer_size(tiles, 0).y + lacquer_size(tiles, 0).z;
    float4 of_volume = volume.SampleGrad(volume_sampler, v_way, dFdx_3, dFdy_3);
    int whole_add_3 = whole_add_2 + lacquer_size(volume, to_int).x + lacquer_size(volume, 0).y + lacquer_size(volume, 0).z;

    out_color = of_map + of_around + of_tiles + of_volume;
    out_weight = v_uv.y;
    out_place = v_uv;
    out_texels = whole_add_3;
    out_bits = uint(whole_add_3);
    out_nearness = clamp(v_way.z, 0.0, 1.0);
}
