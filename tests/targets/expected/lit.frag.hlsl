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
    "CBV(b0, space=2), " \
    "DescriptorTable(SRV(t0, space=2, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "DescriptorTable(Sampler(s0, space=2, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "CBV(b0, space=1), " \
    "DescriptorTable(SRV(t0, space=1, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "DescriptorTable(Sampler(s0, space=1, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "CBV(b0, space=0), " \
    "CBV(b1, space=0), " \
    "DescriptorTable(SRV(t0, space=0, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE)), " \
    "DescriptorTable(Sampler(s0, space=0, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE))"

struct FrameBlock {
    column_major float4x4 view_projection;
    float3 camera_position;
    int light_count;
    float exposure;
};

cbuffer Frame : LACQUER_AT(b0, b0, space0) {
    FrameBlock frame;
};

struct Light {
    float3 direction;
    float range;
    float3 color;
    int type;
};

cbuffer Lights : LACQUER_AT(b1, b1, space0) {
    Light lights[16];
};

struct MaterialBlock {
    float3 base_color;
    float roughness;
    float2 uv_scale;
};

cbuffer Material : LACQUER_AT(b2, b0, space1) {
    MaterialBlock material;
};

Texture2D base_color_texture : LACQUER_AT(t3, t1, space1);
#ifndef base_color_texture_sampler
SamplerState base_color_texture_sampler : LACQUER_AT(s3, s1, space1);
#endif
TextureCube environment_texture : LACQUER_AT(t0, t2, space0);
#ifndef environment_texture_sampler
SamplerState environment_texture_sampler : LACQUER_AT(s0, s2, space0);
#endif

void main(
    float3 v_position : TEXCOORD0,
    float3 v_normal : TEXCOORD1,
    float2 v_uv : TEXCOORD2,
    bool in_front_facing : SV_IsFrontFace,
    out float4 out_color : SV_Target0) {
    // surface.normal: glTF 2.0, "Double Sided"
    float3 unit_normal = normalize(v_normal);
    float3 normal = in_front_facing ? unit_normal : -unit_normal;

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    float4 color_part = base_color_texture.Sample(base_color_texture_sampler, v_uv * material.uv_scale);
    float3 base_color = color_part.xyz * material.base_color;

    // base.lambert: glTF 2.0, B.3.1
    float3 direct = float3(0.0, 0.0, 0.0);
    for (int i = 0; i < frame.light_count; ++i) {
        float n_dot_l = max(0.0, dot(normal, lights[i].direction));
        direct += base_color * lights[i].color * (n_dot_l * (lights[i].type == 1 ? lights[i].range : 1.0));
    }

    // environment.specular
    float4 specular_part = float4((direct + environment_texture.SampleLevel(environment_texture_sampler, normalize(frame.camera_position - v_position), material.roughness * 8.0).xyz) * frame.exposure, color_part.w);

    out_color = specular_part;
}
