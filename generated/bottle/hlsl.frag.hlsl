// forward-volume-3cbc4b942deea0550645914bd878b26a
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

struct SeeThroughBlock {
    float4 scene_u;
    float4 scene_v;
    float4 scene_w;
    float scene_max_lod;
};

cbuffer SeeThrough : LACQUER_AT(b4, b7, space0) {
    SeeThroughBlock see_through;
};

struct MaterialBlock {
    float3 density;
    float roughness_factor;
    float3 base_color_factor;
    float f0;
    float3 tint;
    float roughness;
    float3 front;
    float thickness_factor;
    float3 F0;
    float alpha2;
    float3 metal_repeated;
    float alpha2_ratio;
    float weight_times_ggx_peak;
    float one_minus_f0;
    float behind_alpha2;
    float ggx_peak;
    float behind_alpha2_ratio;
    float complement_root;
    float one_minus_transmission_factor;
    float dielectric;
    float mixed_F90;
    float under_facing;
    float most_mean;
    float inverse_ior;
    float inverse_ior2;
    float most_mean_times_inverse_dielectric;
    float first;
    float metal_first;
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
Texture2D scene_behind : LACQUER_AT(t3, t8, space0);
#ifndef scene_behind_sampler
SamplerState scene_behind_sampler : LACQUER_AT(s3, s8, space0);
#endif

void main(
    float3 v_position : TEXCOORD0,
    float3 v_normal : TEXCOORD1,
    float v_volume_length : TEXCOORD2,
    out float4 out_color : SV_Target0) {
    // view: glTF 2.0, Appendix B, "Overview"
    float3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float3 V = to_eye * rsqrt(to_eye.x * to_eye.x + view_part);

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    float3 N = v_normal * rsqrt(v_normal.x * v_normal.x + unit_part);

    // volume.length: KHR_materials_volume, "Properties" (thickness is in the mesh's space)
    float volume_length = min(v_volume_length, 1e30);

    // volume.transmittance: KHR_materials_volume, "Attenuation" (transmittance)
    float3 transmittance = exp2(material.density * volume_length);

    // volume.tint: KHR_materials_volume, "Attenuation"
    float3 tint = material.tint * transmittance;

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float signed_NdotV = dot(N, V);
    float NdotV = abs(signed_NdotV);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float NdotV2 = NdotV * NdotV;
    float masked_view = sqrt(material.alpha2_ratio + NdotV2);

    // behind.visibility: KHR_materials_transmission, "Implementation Notes" (V_T)
    float behind_masked_view = NdotV + material.complement_root * sqrt(material.behind_alpha2_ratio + NdotV2);

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

        // behind.cosines: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        float behind_NdotL = clamp(-signed_NdotL, 0.0, 1.0);
        float NdotSum = behind_NdotL + signed_NdotV;
        float straight = signed_NdotL + signed_NdotV;
        float either = min(abs(signed_NdotL), 1.0);

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 planar = sum - N * straight;
        float planar2 = dot(planar, planar);
        float spread = planar2 + material.alpha2 * (straight * straight);
        float facing = 0.0 < straight ? length2 * length2 : 0.0;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float either2 = either * either;
        float masked_light = sqrt(material.alpha2_ratio + either2);
        float base_sum = either * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // behind.half: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        float NdotSum2 = NdotSum * NdotSum;
        float behind_length2 = planar2 + NdotSum2;
        float behind_VdotH = clamp(0.5 * sqrt(behind_length2), 0.0, 1.0);

        // behind.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        float c = 1.0 - behind_VdotH;
        float c2 = c * c;
        float weight = c2 * c2 * c;
        float most = clamp(material.f0 + material.one_minus_f0 * weight, 0.0, 1.0);

        // behind.distribution: KHR_materials_transmission, "Implementation Notes" (D_T)
        float behind_spread = planar2 + material.behind_alpha2 * NdotSum2;
        float behind_facing = 0.0 < NdotSum ? behind_length2 * behind_length2 : 0.0;
        float numerator = behind_facing * material.ggx_peak;
        float behind_denominator = behind_spread * behind_spread;

        // behind.visibility: KHR_materials_transmission, "Implementation Notes" (V_T)
        float behind_masked_light = either + material.complement_root * sqrt(material.behind_alpha2_ratio + either2);
        float visibility = behind_masked_view * behind_masked_light;

        // behind.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float behind_specular = numerator / (behind_denominator * visibility + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        float base_c = 1.0 - VdotH;
        float base_c2 = base_c * base_c;
        float base_weight = base_c2 * base_c2 * base_c;
        float glancing = base_weight * NdotL;
        float base_facing = NdotL - glancing;
        float refracted = material.under_facing * base_facing;
        float3 direct = material.F0 * (base_facing * specular) + material.mixed_F90 * glancing * specular + material.front * refracted;

        // base.through: KHR_materials_transmission, "Transmission BTDF"; KHR_materials_diffuse_transmission, "Material Structure Updates"
        float3 through = direct + tint * (behind_specular * (behind_NdotL * (material.dielectric * (1.0 - most))));

        // output
        light_sum += through * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(NdotV, material.roughness_factor), 0.0);

    // dielectric.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    float dielectric_facing = 1.0 - split.y;
    float lost = clamp(dielectric_facing - split.x, 0.0, 1.0);
    float environment_part = material.f0 * split.x + split.y;
    float most_bounces = 1.000001 - material.most_mean * lost;
    float dielectric_most = clamp(environment_part / most_bounces, 0.0, 1.0);

    // volume.exit: KHR_materials_volume, "Refraction" (Snell's law)
    float sine2 = clamp(1.0 - signed_NdotV * signed_NdotV, 0.0, 1.0);
    float refracted_cosine = sqrt(clamp(1.0 - material.inverse_ior2 * sine2, 0.0, 1.0));
    float along_normal = material.inverse_ior * signed_NdotV - refracted_cosine;
    float3 exit = v_position + N * (along_normal * volume_length) - V * (material.inverse_ior * volume_length);

    // clear.lod: KHR_materials_transmission, "Implementation Notes"; Khronos glTF sample viewer (applyIorToRoughness, log2 of the
    float lod = material.roughness * see_through.scene_max_lod;

    // clear.scene: KHR_materials_transmission, "Implementation Notes"
    float4 clear_point = float4(exit, 1.0);
    float2 uv = float2(dot(see_through.scene_u, clear_point), dot(see_through.scene_v, clear_point)) / max(dot(see_through.scene_w, clear_point), 1e-6);

    // clear.seen: KHR_materials_transmission, "Tinting"
    float3 seen = tint * scene_behind.SampleLevel(scene_behind_sampler, uv, lod).xyz;

    // base.transmitted: KHR_materials_transmission, "Transmission BTDF"
    float under = material.dielectric * (1.0 - dielectric_most);
    float3 transmitted = seen * under;

    // base.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    float3 R = 2.0 * signed_NdotV * N - V;

    // base.irradiance: glTF 2.0, Appendix B, "Diffuse BRDF"
    float3 mean = environment_irradiance.SampleLevel(environment_irradiance_sampler, v_normal, 0.0).xyz;

    // base.body_indirect: glTF 2.0, Appendix B, "Diffuse BRDF"
    float3 body_indirect = material.base_color_factor * mean;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; glTF 2.0,
    float3 metal_bounces = material.metal_first - material.metal_repeated * lost;
    float3 base_all = environment_part / (material.first - material.most_mean_times_inverse_dielectric * lost) + (material.base_color_factor * split.x + split.y) / metal_bounces;
    float3 once = material.F0 * split.x + material.mixed_F90 * split.y;
    float3 indirect_part = once * environment_specular.SampleLevel(environment_specular_sampler, R, material.roughness_factor * frame.environment_max_lod).xyz + clamp(base_all - once, 0.0, 1.0) * mean;
    float3 indirect = indirect_part + body_indirect * (material.one_minus_transmission_factor * under);

    // output
    out_color = float4(light_sum + indirect * frame.environment_intensity + transmitted, 1.0);
}
