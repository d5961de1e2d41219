// forward-base-90635bb95589462632851765a0f686df
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

struct Light {
    float3 position;
    float positional;
    float3 radiance;
    float inverse_range_4;
    float3 direction;
    float spot_scale;
    float spot_offset;
};

cbuffer Lights : LACQUER_AT(b1, b1, space0) {
    Light lights[16];
};

struct MaterialBlock {
    float4 base_color_factor;
    float metallic_factor;
    float roughness_factor;
    float alpha2;
    float alpha2_ratio;
    float weight_times_ggx_peak;
    float lambert;
    float least_f0;
    float clear;
    float least_f0_plus_metallic_factor;
};

cbuffer Material : LACQUER_AT(b2, b0, space1) {
    MaterialBlock material;
};

TextureCube environment_specular : LACQUER_AT(t0, t2, space0);
#ifndef environment_specular_sampler
SamplerState environment_specular_sampler : LACQUER_AT(s0, s2, space0);
#endif
TextureCube environment_irradiance : LACQUER_AT(t1, t3, space0);
#ifndef environment_irradiance_sampler
SamplerState environment_irradiance_sampler : LACQUER_AT(s1, s3, space0);
#endif
Texture2D environment_dfg : LACQUER_AT(t2, t4, space0);
#ifndef environment_dfg_sampler
SamplerState environment_dfg_sampler : LACQUER_AT(s2, s4, space0);
#endif

void main(
    float3 v_position : TEXCOORD0,
    float3 v_normal : TEXCOORD1,
    float4 v_COLOR_0 : TEXCOORD2,
    out float4 out_color : SV_Target0) {
    // color0
    float4 color0 = clamp(v_COLOR_0, 0.0, 1.0);

    // view: glTF 2.0, Appendix B, "Overview"
    float3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float view_part_2 = rsqrt(to_eye.x * to_eye.x + view_part);
    float3 V = to_eye * view_part_2;

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    float4 color = material.base_color_factor * color0;

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    float3 N = v_normal * rsqrt(v_normal.x * v_normal.x + unit_part);

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float cosines_part = dot(N, to_eye);
    float signed_NdotV = cosines_part * view_part_2;
    float NdotV = abs(cosines_part) * view_part_2;

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.alpha2_ratio + NdotV * NdotV);

    // output
    float3 light_sum = float3(0.0, 0.0, 0.0);
    for (int i = 0; i < frame.light_count; ++i) {
        // light_sample: KHR_lights_punctual, "Range Property" and "Inner and Outer Cone Angles"
        float3 to_light = lights[i].position - v_position * lights[i].positional;
        float distance2 = max(dot(to_light, to_light), 1e-12);
        float inverse_distance = lerp(1.0, rsqrt(distance2), lights[i].positional);
        float3 L = to_light * inverse_distance;
        float window = clamp(1.0 - distance2 * (distance2 * lights[i].inverse_range_4), 0.0, 1.0);
        float cone = clamp(lights[i].spot_offset - dot(to_light, lights[i].direction) * inverse_distance * lights[i].spot_scale, 0.0, 1.0);
        float3 radiance = lights[i].radiance * (window * (cone * cone) * (inverse_distance * inverse_distance));

        // half: glTF 2.0, Appendix B, "Overview"
        float3 sum = V + L;
        float length2 = dot(sum, sum);
        float VdotH = clamp(0.5 * sqrt(length2), 0.0, 1.0);

        // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        float NdotL = clamp(dot(N, to_light) * inverse_distance, 0.0, 1.0);
        float NdotSum = NdotL + signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 planar = sum - N * NdotSum;
        float planar2 = dot(planar, planar);
        float spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        float facing = 0.0 < NdotSum ? length2 * length2 : 0.0;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        float base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float c = 1.0 - VdotH;
        float c2 = c * c;
        float weight = c2 * c2 * c;
        float glancing = weight * NdotL;
        float base_facing = NdotL - glancing;
        float tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        float white = specular * (base_facing * material.least_f0 + glancing);
        float3 direct = color.xyz * tinted + white;

        // output
        light_sum += direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(NdotV, material.roughness_factor), 0.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; glTF 2.0,
    float base_facing_2 = 1.0 - split.y;
    float lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    float through = base_facing_2 - lost / 21.0;
    float3 base_color_complement = 1.0 - color.xyz;
    float3 bounces = 1.000001 - lost + base_color_complement * (0.95238096 * lost);
    float dielectric_bounces = 1.000001 - lost * 0.08571429;
    float base = material.clear * (through / dielectric_bounces);
    float grey = material.metallic_factor * split.x;
    float base_white = material.least_f0_plus_metallic_factor * split.x;
    float3 base_specular = color.xyz * grey + (material.least_f0 * split.x + split.y);
    float3 base_spread = clamp(base_color_complement * (grey - base - material.metallic_factor * through / bounces) + (base_facing_2 - base_white), 0.0, 1.0);
    float3 indirect = base_specular * environment_specular.SampleLevel(environment_specular_sampler, cosines_part * 2.0 * N - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * environment_irradiance.SampleLevel(environment_irradiance_sampler, v_normal, 0.0).xyz;

    // output
    out_color = float4(light_sum + indirect * frame.environment_intensity, 1.0);
}
