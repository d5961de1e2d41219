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
    float3 base_color_factor;
    float metallic_factor;
    float3 lower_f0;
    float roughness_factor;
    float3 one_minus_lower_f0;
    float film_thickness;
    float3 turn;
    float film_thickness_2;
    float3 front;
    float iridescence_factor;
    float3 tint;
    float inverse_ior2;
    float3 mean_fresnel;
    float least_cos2_t;
    float iridescence_ior_times_0_000125;
    float r_squared;
    float F0_complement;
    float film_fresnel;
    float film_fresnel_2;
    float film_fresnel_3;
    float alpha2;
    float ggx_peak;
    float alpha2_ratio;
    float weight_times_ggx_peak;
    float complement_root;
    float one_minus_transmission_factor;
    float dielectric;
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
Texture2D scene_behind : LACQUER_AT(t4, t8, space0);
#ifndef scene_behind_sampler
SamplerState scene_behind_sampler : LACQUER_AT(s4, s8, space0);
#endif
Texture2D iridescence_thickness_texture : LACQUER_AT(t3, t1, space1);
#ifndef iridescence_thickness_texture_sampler
SamplerState iridescence_thickness_texture_sampler : LACQUER_AT(s3, s1, space1);
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

    // iridescence_thickness.texel: glTF 2.0, "Textures"
    float4 texel = iridescence_thickness_texture.Sample(iridescence_thickness_texture_sampler, v_uv0);

    // film.thickness: KHR_materials_iridescence, "Properties"
    float thickness = lerp(material.film_thickness, material.film_thickness_2, texel.y);

    // film.strength: KHR_materials_iridescence, "Properties"
    float there = clamp(thickness * 10.0, 0.0, 1.0);
    float strength = material.iridescence_factor * there;

    // base.view_cosine: KHR_materials_clearcoat, "Layering"
    float view_cosine_part = dot(N, to_eye);
    float signed_NdotV = view_cosine_part * view_part_2;
    float view_cosine = abs(view_cosine_part) * view_part_2;

    // film.fresnel: KHR_materials_iridescence, "Iridescence Fresnel"; Belcour and Barla 2017
    float view_cosine2 = view_cosine * view_cosine;
    float cos_t = sqrt(material.least_cos2_t + material.inverse_ior2 * view_cosine2);
    float longest = material.iridescence_ior_times_0_000125 * thickness;
    float path = clamp(longest * cos_t, 0.0, 1.0);
    float c = 1.0 - view_cosine;
    float c2 = c * c;
    float upper = material.r_squared + material.F0_complement * (c2 * c2 * abs(c));
    float film_c = 1.0 - cos_t;
    float film_c2 = film_c * film_c;
    float lower_weight = film_c2 * film_c2 * abs(film_c);
    float4 waves = cos(float4(168.99255, 180.48325, 222.01259, 225.1793) * path);
    float4 fades = exp2(float4(63.101753, 135.66629, 96.40813, 66.0237) * -(path * path));
    float4 first = waves * fades;
    float4 fades2 = fades * fades;
    float4 second = (2.0 * (waves * waves) - 1.0) * (fades2 * fades2);
    float3 film_first = float3(first.x + 0.18175068 * first.w, first.y, first.z);
    float3 fresnel_part = float3(5.4866724, -1.6411418, 0.09421429) * (second.x + 0.18175068 * second.w) + float3(-3.0749593, 3.752854, -0.40814236) * second.y;
    float3 film_second = fresnel_part + float3(-0.998182, 0.08320529, 2.116824) * second.z;
    float film_fresnel_part = material.film_fresnel + material.film_fresnel_2 * lower_weight;
    float3 turned = film_first * material.film_fresnel_3;
    float3 first_rgb = float3(5.4866724, -1.6411418, 0.09421429) * turned.x + float3(-3.0749593, 3.752854, -0.40814236) * turned.y + float3(-0.998182, 0.08320529, 2.116824) * turned.z;
    float through = 1.0 - upper;
    float film_fresnel_part_2 = clamp(upper * film_fresnel_part, 1e-5, 0.9999);
    float through2 = through * through;
    float film_fresnel_part_3 = through2 * film_fresnel_part / (1.0 - film_fresnel_part_2);
    float film_fresnel_part_4 = film_fresnel_part_3 - through;
    float3 film_fresnel_part_5 = upper + film_fresnel_part_3 + (first_rgb * (sqrt(film_fresnel_part_2) * film_fresnel_part_4) + film_second * (film_fresnel_part_2 * film_fresnel_part_4));
    float3 dielectric = clamp(film_fresnel_part_5, 0.0, 1.0);
    float3 lower = material.lower_f0 + material.one_minus_lower_f0 * lower_weight;
    float3 film_turned = film_first * material.turn;
    float3 film_first_rgb = float3(5.4866724, -1.6411418, 0.09421429) * film_turned.x + float3(-3.0749593, 3.752854, -0.40814236) * film_turned.y + float3(-0.998182, 0.08320529, 2.116824) * film_turned.z;
    float3 both = clamp(upper * lower, 1e-5, 0.9999);
    float3 repeated = through2 * lower / (1.0 - both);
    float3 swing = repeated - through;
    float3 metal = clamp(upper + repeated + swing * (sqrt(both) * film_first_rgb + both * film_second), 0.0, 1.0);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.alpha2_ratio + view_cosine2);

    // behind.visibility: KHR_materials_transmission, "Implementation Notes" (V_T)
    float behind_masked_view = view_cosine + material.complement_root * masked_view;

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
        float masked_light = sqrt(material.alpha2_ratio + either * either);
        float base_sum = either * masked_view + view_cosine * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // dielectric.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        float dielectric_c = 1.0 - VdotH;
        float dielectric_c2 = dielectric_c * dielectric_c;
        float weight = dielectric_c2 * dielectric_c2 * dielectric_c;

        // metal.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        float3 F = lerp(material.base_color_factor, float3(1.0, 1.0, 1.0), weight);

        // behind.half: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        float NdotSum2 = NdotSum * NdotSum;
        float behind_length2 = planar2 + NdotSum2;
        float behind_VdotH = clamp(0.5 * sqrt(behind_length2), 0.0, 1.0);

        // behind.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        float behind_c = 1.0 - behind_VdotH;
        float behind_c2 = behind_c * behind_c;
        float behind_weight = behind_c2 * behind_c2 * behind_c;

        // film.dielectric: KHR_materials_iridescence, "Layering"
        float3 film_F = lerp(lerp(0.04, 1.0, weight).xxx, dielectric, strength);
        float most = max(max(film_F.x, film_F.y), film_F.z);

        // film.metal: KHR_materials_iridescence, "Layering"
        float3 film_F_2 = lerp(F, metal, strength);

        // film.behind: KHR_materials_iridescence, "Layering"
        float3 film_F_3 = lerp(lerp(0.04, 1.0, behind_weight).xxx, dielectric, strength);
        float film_most = max(max(film_F_3.x, film_F_3.y), film_F_3.z);

        // behind.distribution: KHR_materials_transmission, "Implementation Notes" (D_T)
        float behind_spread = planar2 + material.alpha2 * NdotSum2;
        float behind_facing = 0.0 < NdotSum ? behind_length2 * behind_length2 : 0.0;
        float numerator = behind_facing * material.ggx_peak;
        float behind_denominator = behind_spread * behind_spread;

        // behind.visibility: KHR_materials_transmission, "Implementation Notes" (V_T)
        float behind_masked_light = either + material.complement_root * masked_light;
        float visibility = behind_masked_view * behind_masked_light;

        // behind.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float behind_specular = numerator / (behind_denominator * visibility + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        float reflected = specular * NdotL;
        float refracted = NdotL * (material.dielectric * (1.0 - most));
        float3 direct = film_F * (material.dielectric * reflected) + film_F_2 * (material.metallic_factor * reflected) + material.front * refracted;

        // base.through: KHR_materials_transmission, "Transmission BTDF"; KHR_materials_diffuse_transmission, "Material Structure Updates"
        float3 base_through = direct + material.tint * (behind_specular * (behind_NdotL * (material.dielectric * (1.0 - film_most))));

        // output
        light_sum += base_through * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(view_cosine, material.roughness_factor), 0.0);

    // dielectric.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    float dielectric_facing = 1.0 - split.y;
    float lost = clamp(dielectric_facing - split.x, 0.0, 1.0);
    float environment_part = 0.04 * split.x + split.y;
    float dielectric_most = clamp(environment_part / (1.000001 - 0.08571429 * lost), 0.0, 1.0);

    // metal.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    float3 once = material.base_color_factor * split.x + split.y;
    float3 bounces = 1.000001 - material.mean_fresnel * lost;
    float3 metal_all = clamp(once / bounces, 0.0, 1.0);

    // clear.lod: KHR_materials_transmission, "Implementation Notes"; Khronos glTF sample viewer (applyIorToRoughness, log2 of the
    float lod = material.roughness_factor * see_through.scene_max_lod;

    // clear.scene: KHR_materials_transmission, "Implementation Notes"
    float4 clear_point = float4(v_position, 1.0);
    float2 uv = float2(dot(see_through.scene_u, clear_point), dot(see_through.scene_v, clear_point)) / max(dot(see_through.scene_w, clear_point), 1e-6);

    // clear.seen: KHR_materials_transmission, "Tinting"
    float3 seen = material.tint * scene_behind.SampleLevel(scene_behind_sampler, uv, lod).xyz;

    // film.dielectric_environment: Karis 2013, "Real Shading in Unreal Engine 4" (split sum, with a Fresnel that does not depend on the light)
    float dielectric_environment_part = 1.0 - lost;
    float3 film_once = dielectric * dielectric_environment_part;
    float3 film_bounces = 1.000001 - dielectric * lost;
    float3 film_all = clamp(film_once / film_bounces, 0.0, 1.0);

    // film.dielectric_all: KHR_materials_iridescence, "Layering"
    float3 film_F_4 = lerp(dielectric_most.xxx, film_all, strength);
    float film_most_2 = max(max(film_F_4.x, film_F_4.y), film_F_4.z);

    // base.transmitted: KHR_materials_transmission, "Transmission BTDF"
    float under = material.dielectric * (1.0 - film_most_2);
    float3 transmitted = seen * under;

    // base.irradiance: glTF 2.0, Appendix B, "Diffuse BRDF"
    float3 mean = environment_irradiance.SampleLevel(environment_irradiance_sampler, v_normal, 0.0).xyz;

    // base.body_indirect: glTF 2.0, Appendix B, "Diffuse BRDF"
    float3 body_indirect = material.base_color_factor * mean;

    // film.dielectric_once: KHR_materials_iridescence, "Layering"
    float3 dielectric_once = lerp(environment_part.xxx, film_once, strength);

    // film.metal_environment: Karis 2013, "Real Shading in Unreal Engine 4" (split sum, with a Fresnel that does not depend on the light)
    float3 film_once_2 = metal * dielectric_environment_part;
    float3 film_bounces_2 = 1.000001 - metal * lost;
    float3 film_all_2 = clamp(film_once_2 / film_bounces_2, 0.0, 1.0);

    // film.metal_once: KHR_materials_iridescence, "Layering"
    float3 metal_once = lerp(once, film_once_2, strength);

    // film.metal_all: KHR_materials_iridescence, "Layering"
    float3 film_F_5 = lerp(metal_all, film_all_2, strength);

    // base.indirect: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
    float3 base_once = dielectric_once * material.dielectric + metal_once * material.metallic_factor;
    float3 base_all = film_F_4 * material.dielectric + film_F_5 * material.metallic_factor;
    float3 indirect_part = base_once * environment_specular.SampleLevel(environment_specular_sampler, view_cosine_part * 2.0 * N - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + max(base_all - base_once, 0.0) * mean;
    float3 indirect = indirect_part + body_indirect * (material.one_minus_transmission_factor * under);

    // output
    out_color = float4(light_sum + indirect * frame.environment_intensity + transmitted, 1.0);
}
