// forward-base-f217b135f6c9b4210455f224951dcd52
// Lacquer 0.2.0, template forward

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
    "CBV(b0, space=2), " \
    "CBV(b1, space=2), " \
    "CBV(b2, space=2), " \
    "CBV(b3, space=2), " \
    "DescriptorTable(SRV(t0, space=2, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "DescriptorTable(Sampler(s0, space=2, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "CBV(b0, space=1), " \
    "DescriptorTable(SRV(t0, space=1, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "DescriptorTable(Sampler(s0, space=1, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "CBV(b0, space=0), " \
    "CBV(b1, space=0), " \
    "CBV(b7, space=0), " \
    "CBV(b9, space=0), " \
    "CBV(b10, space=0), " \
    "CBV(b11, space=0), " \
    "DescriptorTable(SRV(t0, space=0, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "DescriptorTable(Sampler(s0, space=0, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE))"

// With -D LACQUER_OBJECTS the blocks of all objects are elements of buffers.
#ifdef LACQUER_OBJECTS
cbuffer LacquerDraw : register(b0, space3) {
    uint lacquer_object;
};
#endif

struct FrameBlock {
    column_major float4x4 view_projection;
    float3 camera_position;
    float environment_intensity;
    float environment_max_lod;
    int light_count;
};

cbuffer Frame : LACQUER_AT(b0, b0, space0) {
    FrameBlock frame;
};

struct ObjectBlock {
    column_major float4x4 model;
    column_major float4x4 normal_matrix;
};

#ifdef LACQUER_OBJECTS
StructuredBuffer<ObjectBlock> lacquer_object_list : register(t0, space2);
#else
cbuffer Object : LACQUER_AT(b3, b0, space2) {
    ObjectBlock object;
};
#endif

void main(
    float3 in_position : POSITION,
    float3 in_normal : NORMAL,
    float2 in_texcoord_0 : TEXCOORD0,
    out float3 v_position : TEXCOORD0,
    out float3 v_normal : TEXCOORD1,
    out float2 v_uv0 : TEXCOORD2,
    out precise float4 out_position : SV_Position) {
#ifdef LACQUER_OBJECTS
    ObjectBlock object = lacquer_object_list[lacquer_object];
#endif
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
    v_uv0 = in_texcoord_0;
}
