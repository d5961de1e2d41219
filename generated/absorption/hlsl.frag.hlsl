// forward-coat-12c10870bbeaa4391d526f62685f5162
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
    float3 coat_color_factor;
    float metallic_factor;
    float3 base_color_factor;
    float roughness_factor;
    float3 base_color_complement;
    float coat_factor;
    float3 metal_repeated;
    float coat_roughness_factor;
    float3 F0;
    float inverse_ior2;
    float least_cos2_t;
    float alpha2;
    float alpha2_ratio;
    float weight_times_ggx_peak;
    float coat_alpha2;
    float coat_alpha2_ratio;
    float coat_weight_times_ggx_peak;
    float lambert;
    float least_f0;
    float coat_factor_times_F0_complement;
    float coat_factor_times_f0;
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
Texture2D coat_color_texture : LACQUER_AT(t3, t1, space1);
#ifndef coat_color_texture_sampler
SamplerState coat_color_texture_sampler : LACQUER_AT(s3, s1, space1);
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

    // coat.view_cosine: KHR_materials_clearcoat, "Layering"
    float view_cosine_part = dot(N, to_eye);
    float signed_NdotV = view_cosine_part * view_part_2;
    float view_cosine = abs(view_cosine_part) * view_part_2;

    // coat.fresnel: glTF 2.0, Appendix B, "Fresnel"; Schlick 1994
    float c = 1.0 - view_cosine;
    float c2 = c * c;

    // coat_color.texel: glTF 2.0, "Textures"
    float4 texel = coat_color_texture.Sample(coat_color_texture_sampler, v_uv0);

    // coat.color: KHR_materials_coat, "Parameter Combinations"; EXT_materials_clearcoat_color; ADOBE_materials_clearcoat_tint
    float3 color = material.coat_color_factor * texel.xyz;

    // coat.absorption: KHR_materials_coat, "Colored Absorption"; EXT_materials_clearcoat_color, "View-Dependent Absorption"
    float view_cosine2 = view_cosine * view_cosine;
    float cos2_t = material.least_cos2_t + material.inverse_ior2 * view_cosine2;
    float path = rsqrt(max(cos2_t, 1e-6));
    float3 log2_tint = log2(max(color, 1e-30));
    float3 absorption = exp2(log2_tint * path);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.alpha2_ratio + view_cosine2);

    // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float coat_masked_view = sqrt(material.coat_alpha2_ratio + view_cosine2);

    // coat.transmission_direct: EXT_materials_clearcoat_color, "Implementation" (the tint is weighted by the coverage)
    float reflectance = material.coat_factor_times_f0 + material.coat_factor_times_F0_complement * (c2 * c2 * abs(c));
    float refracted = clamp(1.0 - reflectance, 0.0, 1.0);
    float covered = material.coat_factor * refracted;
    float3 transmission_direct = absorption * covered + (refracted - covered);

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
        float NdotSum2 = NdotSum * NdotSum;
        float spread = planar2 + material.alpha2 * NdotSum2;
        float facing = 0.0 < NdotSum ? length2 * length2 : 0.0;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float NdotL2 = NdotL * NdotL;
        float masked_light = sqrt(material.alpha2_ratio + NdotL2);
        float base_sum = NdotL * masked_view + view_cosine * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // coat.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float coat_spread = planar2 + material.coat_alpha2 * NdotSum2;
        float coat_denominator = coat_spread * coat_spread;

        // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float coat_masked_light = sqrt(material.coat_alpha2_ratio + NdotL2);
        float coat_sum = NdotL * coat_masked_view + view_cosine * coat_masked_light;

        // coat.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float coat_specular = material.coat_weight_times_ggx_peak * facing / (coat_denominator * coat_sum + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float base_c = 1.0 - VdotH;
        float base_c2 = base_c * base_c;
        float weight = base_c2 * base_c2 * base_c;
        float glancing = weight * NdotL;
        float base_facing = NdotL - glancing;
        float tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        float white = specular * (base_facing * material.least_f0 + glancing);
        float3 direct = material.base_color_factor * tinted + white;

        // coat.layer_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        float3 layer_direct = direct * transmission_direct + coat_specular * NdotL * reflectance;

        // output
        light_sum += layer_direct * radiance;
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

    // coat.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 coat_split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(view_cosine, material.coat_roughness_factor), 0.0);

    // coat.layer_ibl: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    float3 layer_ibl_part = environment_specular.SampleLevel(environment_specular_sampler, radiance_part, material.coat_roughness_factor * frame.environment_max_lod).xyz * ((coat_split.x + coat_split.y) * reflectance);
    float3 layer_ibl = indirect * transmission_direct + layer_ibl_part;

    // output
    out_color = float4(light_sum + layer_ibl * frame.environment_intensity, 1.0);
}
