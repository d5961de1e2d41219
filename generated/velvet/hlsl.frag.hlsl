// forward-sheen-5ae0e6ac6e8a3336fe9c837195f30ead
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
    float3 sheen_color_factor;
    float metallic_factor;
    float3 base_color_factor;
    float roughness_factor;
    float3 base_color_complement;
    float sheen_roughness_factor;
    float3 metal_repeated;
    float alpha2;
    float3 F0;
    float alpha2_ratio;
    float weight_times_ggx_peak;
    float exponent;
    float inverse_a;
    float b;
    float c;
    float d;
    float middle;
    float e_minus_middle;
    float peak_times_0_25;
    float lambert;
    float least_f0;
    float inverse_metallic;
    float inverse_clear;
    float dielectric_repeated;
    float white_F0;
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
Texture2D environment_sheen : LACQUER_AT(t4, t5, space0);
#ifndef environment_sheen_sampler
SamplerState environment_sheen_sampler : LACQUER_AT(s4, s5, space0);
#endif
Texture2D sheen_color_texture : LACQUER_AT(t3, t1, space1);
#ifndef sheen_color_texture_sampler
SamplerState sheen_color_texture_sampler : LACQUER_AT(s3, s1, space1);
#endif

void main(
    float3 v_position : TEXCOORD0,
    float3 v_normal : TEXCOORD1,
    float2 v_uv0 : TEXCOORD2,
    out float4 out_color : SV_Target0) {
    // view: glTF 2.0, Appendix B, "Overview"
    float3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float view_part_2 = rsqrt(to_eye.x * to_eye.x + view_part);
    float3 V = to_eye * view_part_2;

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    float3 N = v_normal * rsqrt(v_normal.x * v_normal.x + unit_part);

    // sheen_color.texel: glTF 2.0, "Textures"
    float4 texel = sheen_color_texture.Sample(sheen_color_texture_sampler, v_uv0);

    // sheen.surface: KHR_materials_sheen, "Sheen"
    float3 color = material.sheen_color_factor * texel.xyz;

    // base.view_cosine: KHR_materials_clearcoat, "Layering"
    float view_cosine_part = dot(N, to_eye);
    float signed_NdotV = view_cosine_part * view_part_2;
    float view_cosine = abs(view_cosine_part) * view_part_2;

    // sheen.view: KHR_materials_sheen, "Albedo-scaling technique" (E)
    float4 reflected = environment_sheen.SampleLevel(environment_sheen_sampler, float2(view_cosine, material.sheen_roughness_factor), 0.0);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.alpha2_ratio + view_cosine * view_cosine);

    // sheen.masked_view: KHR_materials_sheen, "Sheen visibility" (lambda_sheen)
    float x = clamp(min(view_cosine, 1.0 - view_cosine), 1e-30, 0.5);
    float above = 1.0 / (material.inverse_a + material.b * exp2(material.c * log2(x))) + (material.d * x + material.e_minus_middle);
    float sheen_masked_view = exp2(material.middle + (view_cosine < 0.5 ? above : -above));

    // sheen.lobe: KHR_materials_sheen, "Sheen visibility"
    float lobe_part = max(view_cosine, 0.0001);
    float sheen_lobe_part = 1.0 + sheen_masked_view;

    // sheen.direct: KHR_materials_sheen, "Albedo-scaling technique"
    float most = max(max(color.x, color.y), color.z);

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
        float signed_NdotL = dot(N, to_light) * inverse_distance;
        float NdotL = clamp(signed_NdotL, 0.0, 1.0);
        float NdotSum = NdotL + signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 planar = sum - N * NdotSum;
        float planar2 = dot(planar, planar);
        float NdotSum2 = NdotSum * NdotSum;
        float spread = planar2 + material.alpha2 * NdotSum2;
        float facing = 0.0 < NdotSum ? length2 * length2 : 0.0;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        float base_sum = NdotL * masked_view + view_cosine * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // sheen.distribution: KHR_materials_sheen, "Sheen distribution"; Conty and Kulla 2017
        float sine2 = planar2 / max(planar2 + NdotSum2, 1e-12);
        float share = exp2(log2(max(sine2, 1e-30)) * material.exponent);

        // sheen.light_cosine: KHR_materials_coat, "Darkening Control"
        float light_cosine = abs(signed_NdotL);

        // sheen.masked_light: KHR_materials_sheen, "Sheen visibility" (lambda_sheen)
        float sheen_x = clamp(min(light_cosine, 1.0 - light_cosine), 1e-30, 0.5);
        float sheen_above = 1.0 / (material.inverse_a + material.b * exp2(material.c * log2(sheen_x))) + (material.d * sheen_x + material.e_minus_middle);
        float sheen_masked_light = exp2(material.middle + (light_cosine < 0.5 ? sheen_above : -sheen_above));

        // sheen.light: KHR_materials_sheen, "Albedo-scaling technique" (E)
        float4 sheen_reflected = environment_sheen.SampleLevel(environment_sheen_sampler, float2(light_cosine, material.sheen_roughness_factor), 0.0);

        // sheen.lobe: KHR_materials_sheen, "Sheen visibility"
        float cosines = lobe_part * max(light_cosine, 0.0001);
        float kept = reflected.y * sheen_reflected.y;
        float lobe = material.peak_times_0_25 * share * kept / (cosines * (sheen_lobe_part + sheen_masked_light));

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float c = 1.0 - VdotH;
        float c2 = c * c;
        float weight = c2 * c2 * c;
        float glancing = weight * NdotL;
        float base_facing = NdotL - glancing;
        float tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        float white = specular * (base_facing * material.least_f0 + glancing);

        // sheen.direct: KHR_materials_sheen, "Albedo-scaling technique"
        float direct_part = 1.0 - most * max(reflected.x, sheen_reflected.x);
        float3 direct = material.base_color_factor * (tinted * direct_part) + white * direct_part + color * (lobe * NdotL);

        // output
        light_sum += direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(view_cosine, material.roughness_factor), 0.0);

    // base.radiance: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    float3 radiance_part = view_cosine_part * 2.0 * N - to_eye;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    float base_facing_2 = 1.0 - split.y;
    float lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    float through = base_facing_2 - lost / 21.0;
    float3 bounces = material.inverse_metallic - material.metal_repeated * lost;
    float dielectric_bounces = material.inverse_clear - material.dielectric_repeated * lost;
    float3 base_specular = material.F0 * split.x + split.y;
    float grey = material.metallic_factor * split.x - through / dielectric_bounces;
    float3 base_spread = clamp(material.base_color_complement * (grey - through / bounces) + (base_facing_2 - material.white_F0 * split.x), 0.0, 1.0);
    float3 indirect = base_specular * environment_specular.SampleLevel(environment_specular_sampler, radiance_part, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * environment_irradiance.SampleLevel(environment_irradiance_sampler, v_normal, 0.0).xyz;

    // sheen.indirect: KHR_materials_sheen, "Albedo-scaling technique"
    float3 sheen_indirect = indirect * (1.0 - most * reflected.x) + environment_specular.SampleLevel(environment_specular_sampler, radiance_part, material.sheen_roughness_factor * frame.environment_max_lod).xyz * (color * reflected.x);

    // output
    out_color = float4(light_sum + sheen_indirect * frame.environment_intensity, 1.0);
}
