// forward-diffuse_transmission-7563b54a5d52d40579d5fd9747ecbbf6
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
    float3 diffuse_transmission_color_factor;
    float roughness_factor;
    float3 base_color_factor;
    float diffuse_transmission_factor;
    float3 body;
    float alpha2;
    float3 F0;
    float alpha2_ratio;
    float3 lobe;
    float weight_times_ggx_peak;
    float3 metal_repeated;
    float dielectric;
    float mixed_F90;
    float under_facing;
    float inverse_dielectric_times_0_0857;
    float first;
    float metal_first;
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
Texture2D diffuse_transmission_texture : register(t3);
SamplerState diffuse_transmission_texture_sampler : register(s3);

void main(
    float3 v_position : TEXCOORD0,
    float3 v_normal : TEXCOORD1,
    float2 v_uv0 : TEXCOORD2,
    bool in_front_facing : SV_IsFrontFace,
    out float4 out_color : SV_Target0) {
    // view: glTF 2.0, Appendix B, "Overview"
    float3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float view_part_2 = rsqrt(to_eye.x * to_eye.x + view_part);
    float3 V = to_eye * view_part_2;

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    float3 N = v_normal * rsqrt(v_normal.x * v_normal.x + unit_part);

    // normal.facing: glTF 2.0, "Double Sided"
    float3 facing = in_front_facing ? N : -N;

    // diffuse_transmission.texel: glTF 2.0, "Textures"
    float4 texel = diffuse_transmission_texture.Sample(diffuse_transmission_texture_sampler, v_uv0);

    // leaf.textured: KHR_materials_diffuse_transmission, "Diffuse Transmission"
    float textured = material.diffuse_transmission_factor * texel.w;

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float cosines_part = dot(facing, to_eye);
    float signed_NdotV = cosines_part * view_part_2;
    float NdotV = abs(cosines_part) * view_part_2;

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.alpha2_ratio + NdotV * NdotV);

    // leaf.front: KHR_materials_diffuse_transmission, "Material Structure Updates"
    float front_part = 1.0 - textured;

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
        float signed_NdotL = dot(facing, to_light) * inverse_distance;
        float NdotL = clamp(signed_NdotL, 0.0, 1.0);
        float NdotSum = NdotL + signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 planar = sum - facing * NdotSum;
        float planar2 = dot(planar, planar);
        float spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        float base_facing = 0.0 < NdotSum ? length2 * length2 : 0.0;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        float base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = material.weight_times_ggx_peak * base_facing / (denominator * base_sum + 3e-32);

        // behind.cosines: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        float behind_NdotL = clamp(-signed_NdotL, 0.0, 1.0);
        float behind_NdotSum = behind_NdotL + signed_NdotV;
        float straight = signed_NdotL + signed_NdotV;

        // behind.half: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        float3 behind_planar = sum - facing * straight;
        float behind_planar2 = dot(behind_planar, behind_planar);
        float behind_length2 = behind_planar2 + behind_NdotSum * behind_NdotSum;
        float behind_VdotH = clamp(0.5 * sqrt(behind_length2), 0.0, 1.0);

        // behind.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        float c = 1.0 - behind_VdotH;
        float c2 = c * c;
        float weight = c2 * c2 * c;
        float most = clamp(0.04 + 0.96 * weight, 0.0, 1.0);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        float base_c = 1.0 - VdotH;
        float base_c2 = base_c * base_c;
        float base_weight = base_c2 * base_c2 * base_c;
        float glancing = base_weight * NdotL;
        float base_facing_2 = NdotL - glancing;
        float refracted = material.under_facing * base_facing_2;
        float3 direct = material.F0 * (base_facing_2 * specular) + material.mixed_F90 * glancing * specular + material.body * (front_part * refracted);

        // base.through: KHR_materials_transmission, "Transmission BTDF"; KHR_materials_diffuse_transmission, "Material Structure Updates"
        float3 through = direct + material.lobe * (textured * (behind_NdotL * (material.dielectric * (1.0 - most))));

        // output
        light_sum += through * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(NdotV, material.roughness_factor), 0.0);

    // base.irradiance: glTF 2.0, Appendix B, "Diffuse BRDF"
    float3 mean = environment_irradiance.SampleLevel(environment_irradiance_sampler, facing, 0.0).xyz;

    // base.body_indirect: glTF 2.0, Appendix B, "Diffuse BRDF"
    float3 body_indirect = material.base_color_factor * mean;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; glTF 2.0,
    float lost = clamp(1.0 - split.y - split.x, 0.0, 1.0);
    float3 metal_bounces = material.metal_first - material.metal_repeated * lost;
    float indirect_part = 0.04 * split.x + split.y;
    float3 base_all = indirect_part / (material.first - material.inverse_dielectric_times_0_0857 * lost) + (material.base_color_factor * split.x + split.y) / metal_bounces;
    float3 once = material.F0 * split.x + material.mixed_F90 * split.y;
    float most_bounces = 1.000001 - 0.08571429 * lost;
    float under = material.dielectric * (1.0 - clamp(indirect_part / most_bounces, 0.0, 1.0));
    float3 base_indirect_part = once * environment_specular.SampleLevel(environment_specular_sampler, cosines_part * 2.0 * facing - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + clamp(base_all - once, 0.0, 1.0) * mean;
    float3 base_indirect_part_2 = body_indirect * (front_part * under) + material.diffuse_transmission_color_factor * environment_irradiance.SampleLevel(environment_irradiance_sampler, -facing, 0.0).xyz * (textured * under);
    float3 indirect = base_indirect_part + base_indirect_part_2;

    // output
    out_color = float4(light_sum + indirect * frame.environment_intensity, 1.0);
}
