// forward-base-50e111927bdf8a5cc68a9a9f00fd606f
// Lacquer 0.2.0, template forward

struct FrameBlock {
    column_major float4x4 view_projection;
    float3 camera_position;
    float environment_intensity;
    float environment_max_lod;
    int light_count;
};

cbuffer Frame : register(b0) {
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

cbuffer Lights : register(b1) {
    Light lights[16];
};

struct MaterialBlock {
    float3 base_color_factor;
    float metallic_factor;
    float3 body;
    float roughness_factor;
    float3 base_color_complement;
    float alpha2;
    float3 metal_repeated;
    float alpha2_ratio;
    float3 F0;
    float weight_times_ggx_peak;
    float dielectric;
    float lambert;
    float least_f0;
    float retroreflection_factor;
    float one_minus_retroreflection_factor;
    float inverse_metallic;
    float inverse_clear;
    float dielectric_repeated;
    float white_F0;
};

cbuffer Material : register(b2) {
    MaterialBlock material;
};

TextureCube environment_specular : register(t0);
SamplerState environment_specular_sampler : register(s0);
TextureCube environment_irradiance : register(t1);
SamplerState environment_irradiance_sampler : register(s1);
Texture2D environment_dfg : register(t2);
SamplerState environment_dfg_sampler : register(s2);

void main(
    float3 v_position : TEXCOORD0,
    float3 v_normal : TEXCOORD1,
    out float4 out_color : SV_Target0) {
    // view: glTF 2.0, Appendix B, "Overview"
    float3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float3 V = to_eye * rsqrt(to_eye.x * to_eye.x + view_part);

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    float3 N = v_normal * rsqrt(v_normal.x * v_normal.x + unit_part);

    // retro.view: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    float signed_NdotV = dot(N, V);
    float3 R = 2.0 * signed_NdotV * N - V;

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float NdotV = abs(signed_NdotV);

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
        float3 distribution_part = N * NdotSum;
        float3 planar = sum - distribution_part;
        float planar2 = dot(planar, planar);
        float base_distribution_part = material.alpha2 * (NdotSum * NdotSum);
        float spread = planar2 + base_distribution_part;
        bool base_distribution_part_2 = 0.0 < NdotSum;
        float facing = base_distribution_part_2 ? length2 * length2 : 0.0;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        float base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // retro.half: glTF 2.0, Appendix B, "Overview"
        float3 retro_sum = R + L;
        float retro_length2 = dot(retro_sum, retro_sum);
        float retro_VdotH = clamp(0.5 * sqrt(retro_length2), 0.0, 1.0);

        // retro.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 retro_planar = retro_sum - distribution_part;
        float retro_planar2 = dot(retro_planar, retro_planar);
        float retro_spread = retro_planar2 + base_distribution_part;
        float retro_facing = base_distribution_part_2 ? retro_length2 * retro_length2 : 0.0;
        float retro_denominator = retro_spread * retro_spread;

        // retro.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float retro_specular = material.weight_times_ggx_peak * retro_facing / (retro_denominator * base_sum + 3e-32);

        // retro.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        float c = 1.0 - retro_VdotH;
        float c2 = c * c;
        float weight = c2 * c2 * c;
        float most = clamp(0.04 + 0.96 * weight, 0.0, 1.0);

        // retro.metal_schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        float3 F = lerp(material.base_color_factor, float3(1.0, 1.0, 1.0), weight);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float base_c = 1.0 - VdotH;
        float base_c2 = base_c * base_c;
        float base_weight = base_c2 * base_c2 * base_c;
        float glancing = base_weight * NdotL;
        float base_facing = NdotL - glancing;
        float tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        float white = specular * (base_facing * material.least_f0 + glancing);

        // retro.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        float reflected = retro_specular * NdotL;
        float refracted = NdotL * (material.dielectric * (1.0 - most));
        float3 direct = lerp(0.04, 1.0, weight) * material.dielectric * reflected + F * (material.metallic_factor * reflected) + material.body * refracted;

        // retro.mixed: KHR_materials_retroreflection, "Retroreflection"
        float3 mixed = material.base_color_factor * (tinted * material.one_minus_retroreflection_factor) + white * material.one_minus_retroreflection_factor + direct * material.retroreflection_factor;

        // output
        light_sum += mixed * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(NdotV, material.roughness_factor), 0.0);

    // base.radiance: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    float radiance_part = material.roughness_factor * frame.environment_max_lod;

    // retro.both: KHR_materials_retroreflection, "Retroreflection"
    float3 both = environment_specular.SampleLevel(environment_specular_sampler, R, radiance_part).xyz * material.one_minus_retroreflection_factor + environment_specular.SampleLevel(environment_specular_sampler, to_eye, radiance_part).xyz * material.retroreflection_factor;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    float base_facing_2 = 1.0 - split.y;
    float lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    float through = base_facing_2 - lost / 21.0;
    float3 bounces = material.inverse_metallic - material.metal_repeated * lost;
    float dielectric_bounces = material.inverse_clear - material.dielectric_repeated * lost;
    float3 base_specular = material.F0 * split.x + split.y;
    float grey = material.metallic_factor * split.x - through / dielectric_bounces;
    float3 base_spread = clamp(material.base_color_complement * (grey - through / bounces) + (base_facing_2 - material.white_F0 * split.x), 0.0, 1.0);
    float3 indirect = base_specular * both + base_spread * environment_irradiance.SampleLevel(environment_irradiance_sampler, v_normal, 0.0).xyz;

    // output
    out_color = float4(light_sum + indirect * frame.environment_intensity, 1.0);
}
