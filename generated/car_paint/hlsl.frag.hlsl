// forward-coat-dec7fe4855cd503b639d3ab1ca84508d
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
    float row_u_x;
    float3 base_color_factor;
    float row_v_y;
    float3 base_color_complement;
    float normal_scale;
    float3 metal_repeated;
    float metallic_factor;
    float3 F0;
    float roughness_factor;
    float coat_factor;
    float coat_roughness_factor;
    float coat_normal_scale;
    float f0;
    float F0_complement;
    float inverse_ior2;
    float least_cos2_t;
    float coat_darkening_factor;
    float cos_coat_anisotropy_rotation;
    float sin_coat_anisotropy_rotation;
    float coat_anisotropy_strength;
    float alpha2;
    float alpha2_ratio;
    float weight_times_ggx_peak;
    float lambert;
    float least_f0;
    float coat_roughness_factor_times_0_25;
    float undarkened;
    float inverse_metallic;
    float inverse_clear;
    float dielectric_repeated;
    float white_F0;
    float f0_plus_0_5;
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
Texture2D normal_texture : LACQUER_AT(t3, t1, space1);
#ifndef normal_texture_sampler
SamplerState normal_texture_sampler : LACQUER_AT(s3, s1, space1);
#endif
Texture2D coat_texture : LACQUER_AT(t4, t2, space1);
#ifndef coat_texture_sampler
SamplerState coat_texture_sampler : LACQUER_AT(s4, s2, space1);
#endif
Texture2D coat_normal_texture : LACQUER_AT(t5, t3, space1);
#ifndef coat_normal_texture_sampler
SamplerState coat_normal_texture_sampler : LACQUER_AT(s5, s3, space1);
#endif
Texture2D coat_color_texture : LACQUER_AT(t6, t4, space1);
#ifndef coat_color_texture_sampler
SamplerState coat_color_texture_sampler : LACQUER_AT(s6, s4, space1);
#endif
Texture2D coat_anisotropy_texture : LACQUER_AT(t7, t5, space1);
#ifndef coat_anisotropy_texture_sampler
SamplerState coat_anisotropy_texture_sampler : LACQUER_AT(s7, s5, space1);
#endif

void main(
    float3 v_position : TEXCOORD0,
    float3 v_normal : TEXCOORD1,
    float4 v_tangent : TEXCOORD2,
    float2 v_uv0 : TEXCOORD3,
    out float4 out_color : SV_Target0) {
    // view: glTF 2.0, Appendix B, "Overview"
    float3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float3 V = to_eye * rsqrt(to_eye.x * to_eye.x + view_part);

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    float3 N = v_normal * rsqrt(v_normal.x * v_normal.x + unit_part);

    // normal.frame: glTF 2.0, "Meshes" (bitangent = cross(normal, tangent.xyz) * tangent.w)
    float3 B = cross(v_normal, v_tangent.xyz) * v_tangent.w;

    // normal.uv: KHR_texture_transform, "Overview"
    float2 uv = float2(material.row_u_x * v_uv0.x, material.row_v_y * v_uv0.y);

    // normal.texel: glTF 2.0, "Textures"
    float4 texel = normal_texture.Sample(normal_texture_sampler, uv);

    // base.normal_map: glTF 2.0, "Additional Textures" (normal)
    float2 xy = texel.xy * 2.0 - 1.0;
    float z = max(texel.z * 2.0 - 1.0, 1e-14);
    float3 normal_map_part = v_tangent.xyz * (xy.x * material.normal_scale) + B * (xy.y * material.normal_scale);
    float3 bent = normal_map_part + v_normal * z;
    float base_normal_map_part = bent.y * bent.y + (bent.z * bent.z + 1e-32);
    float3 unit = bent * rsqrt(bent.x * bent.x + base_normal_map_part);

    // coat.texel: glTF 2.0, "Textures"
    float4 coat_texel = coat_texture.Sample(coat_texture_sampler, v_uv0);

    // coat.surface: KHR_materials_coat, "Parameter Combinations"; KHR_materials_clearcoat, "Clearcoat"
    float weight = material.coat_factor * coat_texel.x;
    float roughness = material.coat_roughness_factor * coat_texel.y;

    // coat_normal.texel: glTF 2.0, "Textures"
    float4 coat_normal_texel = coat_normal_texture.Sample(coat_normal_texture_sampler, v_uv0);

    // coat.normal_map: glTF 2.0, "Additional Textures" (normal)
    float2 coat_xy = coat_normal_texel.xy * 2.0 - 1.0;
    float coat_z = max(coat_normal_texel.z * 2.0 - 1.0, 1e-14);
    float3 coat_normal_map_part = v_tangent.xyz * (coat_xy.x * material.coat_normal_scale) + B * (coat_xy.y * material.coat_normal_scale);
    float3 coat_bent = coat_normal_map_part + v_normal * coat_z;
    float coat_normal_map_part_2 = coat_bent.y * coat_bent.y + (coat_bent.z * coat_bent.z + 1e-32);
    float3 coat_unit = coat_bent * rsqrt(coat_bent.x * coat_bent.x + coat_normal_map_part_2);

    // coat.alpha: glTF 2.0, Appendix B, "Microfacet Surfaces" and "Specular BRDF" (note on alpha = 0)
    float alpha = max(roughness * roughness, 0.001);

    // coat.view_cosine: KHR_materials_clearcoat, "Layering"
    float signed_NdotV = dot(coat_unit, V);
    float view_cosine = abs(signed_NdotV);

    // coat.fresnel: glTF 2.0, Appendix B, "Fresnel"; Schlick 1994
    float c = 1.0 - view_cosine;
    float c2 = c * c;
    float fresnel = material.f0 + material.F0_complement * (c2 * c2 * abs(c));

    // coat_color.texel: glTF 2.0, "Textures"
    float4 coat_color_texel = coat_color_texture.Sample(coat_color_texture_sampler, v_uv0);

    // coat.color: KHR_materials_coat, "Parameter Combinations"; EXT_materials_clearcoat_color; ADOBE_materials_clearcoat_tint
    float3 color = material.coat_color_factor * coat_color_texel.xyz;

    // coat.absorption: KHR_materials_coat, "Colored Absorption"; EXT_materials_clearcoat_color, "View-Dependent Absorption"
    float view_cosine2 = view_cosine * view_cosine;
    float cos2_t = material.least_cos2_t + material.inverse_ior2 * view_cosine2;
    float path = rsqrt(max(cos2_t, 1e-6));
    float3 log2_tint = log2(max(color, 1e-30));
    float3 absorption = exp2(log2_tint * path);

    // coat_anisotropy.texel: glTF 2.0, "Textures"
    float4 coat_anisotropy_texel = coat_anisotropy_texture.Sample(coat_anisotropy_texture_sampler, v_uv0);

    // coat.anisotropy_texel: KHR_materials_coat, "Anisotropy" (dequantization)
    float2 d = coat_anisotropy_texel.xy * 2.0 - 1.0;
    float length2 = dot(d, d);
    float2 coat_unit_2 = d * rsqrt(length2 + 1e-32);
    float2 direction = 1e-12 < length2 ? coat_unit_2 : float2(1.0, 0.0);

    // coat.anisotropy_strength: KHR_materials_coat, "Parameter Combinations"
    float anisotropy_strength = coat_anisotropy_texel.z * material.coat_anisotropy_strength;

    // coat.anisotropy: KHR_materials_coat, "Anisotropy"
    float3 anisotropy_part = cross(N, v_tangent.xyz) * (v_tangent.w * (direction.x * material.sin_coat_anisotropy_rotation + direction.y * material.cos_coat_anisotropy_rotation));
    float3 coat_anisotropy_part = v_tangent.xyz * (direction.x * material.cos_coat_anisotropy_rotation - direction.y * material.sin_coat_anisotropy_rotation) + anisotropy_part;
    float3 normal_to_both = cross(coat_unit, coat_anisotropy_part);
    float coat_anisotropy_part_2 = normal_to_both.y * normal_to_both.y + (normal_to_both.z * normal_to_both.z + 1e-32);
    float3 across = normal_to_both * rsqrt(normal_to_both.x * normal_to_both.x + coat_anisotropy_part_2);

    // coat.anisotropic_alpha: KHR_materials_coat, "Anisotropy" (directionAlphaRoughness)
    float alpha_t = lerp(alpha, 1.0, anisotropy_strength * anisotropy_strength);

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float base_signed_NdotV = dot(unit, V);
    float NdotV = abs(base_signed_NdotV);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.alpha2_ratio + NdotV * NdotV);

    // coat.anisotropy_cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
    float BdotV = dot(across, V);

    // coat.distribution: KHR_materials_coat, "Anisotropy" (D); Burley 2012
    float narrowness = min(alpha / alpha_t, 1.0);
    float narrowness2 = narrowness * narrowness;
    float narrowness2_complement = 1.0 - narrowness2;
    float alpha_b2 = alpha * alpha;
    float ggx_peak = alpha_b2 * narrowness / 3.1415927;

    // coat.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
    float alpha_t2 = alpha_t * alpha_t;
    float alpha2_difference = max(alpha_t2 - alpha_b2, 0.0);
    float alpha_t2_complement = 1.0 - alpha_t2;
    float masked_view2 = alpha_t2 - alpha2_difference * (BdotV * BdotV) + alpha_t2_complement * view_cosine2;
    float coat_masked_view = sqrt(clamp(masked_view2, 0.0, 1.0));

    // coat.darkening_direct: KHR_materials_coat, "Darkening Control" (R direct); EXT_materials_clearcoat_darkening
    float half_fresnel = 0.5 - material.coat_roughness_factor_times_0_25 * coat_texel.y;
    float half_grazing = material.F0_complement * half_fresnel;
    float darkening_direct_part = 1.0 - (fresnel + material.f0) * half_fresnel;

    // coat.transmission_direct: EXT_materials_clearcoat_color, "Implementation" (the tint is weighted by the coverage)
    float reflectance = weight * fresnel;
    float refracted = clamp(1.0 - reflectance, 0.0, 1.0);
    float covered = weight * refracted;
    float3 transmission_direct_part = absorption * covered;
    float coat_transmission_direct_part = refracted - covered;

    // output
    float3 light_sum = float3(0.0, 0.0, 0.0);
    for (int i = 0; i < frame.light_count; ++i) {
        // light_sample: KHR_lights_punctual, "Range Property" and "Inner and Outer Cone Angles"
        float3 to_light = lights[i].position - v_position * lights[i].positional;
        float distance2 = max(dot(to_light, to_light), 1e-12);
        float inverse_distance = lerp(1.0, rsqrt(distance2), lights[i].positional);
        float3 L = to_light * inverse_distance;
        float window = clamp(1.0 - distance2 * (distance2 * lights[i].inverse_range_4), 0.0, 1.0);
        float cone = clamp(lights[i].spot_offset - dot(L, lights[i].direction) * lights[i].spot_scale, 0.0, 1.0);
        float3 radiance = lights[i].radiance * (window * (cone * cone) * (inverse_distance * inverse_distance));

        // half: glTF 2.0, Appendix B, "Overview"
        float3 sum = V + L;
        float half_length2 = dot(sum, sum);
        float VdotH = clamp(0.5 * sqrt(half_length2), 0.0, 1.0);

        // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        float NdotL = clamp(dot(unit, L), 0.0, 1.0);
        float NdotSum = NdotL + base_signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 planar = sum - unit * NdotSum;
        float planar2 = dot(planar, planar);
        float spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        float half_length22 = half_length2 * half_length2;
        float facing = 0.0 < NdotSum ? half_length22 : 0.0;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        float base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // coat.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        float signed_NdotL = dot(coat_unit, L);
        float coat_NdotL = clamp(signed_NdotL, 0.0, 1.0);
        float coat_NdotSum = coat_NdotL + signed_NdotV;

        // coat.anisotropy_cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
        float BdotL = dot(across, L);

        // coat.distribution: KHR_materials_coat, "Anisotropy" (D); Burley 2012
        float3 coat_planar = sum - coat_unit * coat_NdotSum;
        float coat_planar2 = dot(coat_planar, coat_planar);
        float BdotSum = BdotV + BdotL;
        float coat_spread = narrowness2_complement * (BdotSum * BdotSum) + narrowness2 * coat_planar2 + alpha_b2 * (coat_NdotSum * coat_NdotSum);
        float coat_facing = 0.0 < coat_NdotSum ? half_length22 : 0.0;
        float numerator = coat_facing * ggx_peak;
        float coat_denominator = coat_spread * coat_spread;

        // coat.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
        float masked_light2 = alpha_t2 - alpha2_difference * (BdotL * BdotL) + alpha_t2_complement * (coat_NdotL * coat_NdotL);
        float coat_masked_light = sqrt(clamp(masked_light2, 0.0, 1.0));
        float visibility = 2.0 * (coat_NdotL * coat_masked_view + view_cosine * coat_masked_light);

        // coat.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float coat_specular = numerator / (coat_denominator * visibility + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float base_c = 1.0 - VdotH;
        float base_c2 = base_c * base_c;
        float base_weight = base_c2 * base_c2 * base_c;
        float glancing = base_weight * NdotL;
        float base_facing = NdotL - glancing;
        float tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        float white = specular * (base_facing * material.least_f0 + glancing);
        float3 direct = material.base_color_factor * tinted + white;

        // coat.light_cosine: KHR_materials_coat, "Darkening Control"
        float light_cosine = abs(signed_NdotL);

        // coat.darkening_direct: KHR_materials_coat, "Darkening Control" (R direct); EXT_materials_clearcoat_darkening
        float coat_c = 1.0 - light_cosine;
        float coat_c2 = coat_c * coat_c;
        float through = clamp(darkening_direct_part - coat_c2 * coat_c2 * abs(coat_c) * half_grazing, 0.0, 1.0);
        float darkening_direct = material.undarkened + material.coat_darkening_factor * (through * through);

        // coat.transmission_direct: EXT_materials_clearcoat_color, "Implementation" (the tint is weighted by the coverage)
        float3 transmission_direct = transmission_direct_part * darkening_direct + coat_transmission_direct_part;

        // coat.layer_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        float3 layer_direct = direct * transmission_direct + coat_specular * coat_NdotL * reflectance;

        // output
        light_sum += layer_direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(NdotV, material.roughness_factor), 0.0);

    // base.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    float3 R = 2.0 * base_signed_NdotV * unit - V;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    float base_facing_2 = 1.0 - split.y;
    float lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    float base_through = base_facing_2 - lost / 21.0;
    float3 bounces = material.inverse_metallic - material.metal_repeated * lost;
    float dielectric_bounces = material.inverse_clear - material.dielectric_repeated * lost;
    float3 base_specular = material.F0 * split.x + split.y;
    float grey = material.metallic_factor * split.x - base_through / dielectric_bounces;
    float3 base_spread = clamp(material.base_color_complement * (grey - base_through / bounces) + (base_facing_2 - material.white_F0 * split.x), 0.0, 1.0);
    float3 indirect = base_specular * environment_specular.SampleLevel(environment_specular_sampler, R, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * environment_irradiance.SampleLevel(environment_irradiance_sampler, bent, 0.0).xyz;

    // coat.bent_normal: McAuley 2015, "Rendering the World of Far Cry 4"; as in the Khronos sample viewer's anisotropy
    float3 towards = V - across * BdotV;
    float smoothness = 1.0 - roughness;
    float bend = anisotropy_strength * smoothness;
    float straight = 1.0 - bend;
    float straight2 = straight * straight;
    float3 bent_normal = lerp(towards, coat_unit, straight2 * straight2);

    // coat.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    float3 reflection = bent_normal * (2.0 * dot(bent_normal, V)) - V * dot(bent_normal, bent_normal);

    // coat.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 coat_split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(view_cosine, roughness), 0.0);

    // coat.darkening_ibl: KHR_materials_coat, "Darkening Control" (R IBL); EXT_materials_clearcoat_darkening
    float half_around = material.f0_plus_0_5 * half_fresnel;
    float coat_through = clamp(1.0 - fresnel * half_fresnel - half_around, 0.0, 1.0);
    float darkening_ibl = material.undarkened + material.coat_darkening_factor * (coat_through * coat_through);

    // coat.transmission_ibl: EXT_materials_clearcoat_color, "Implementation" (the tint is weighted by the coverage)
    float3 transmission_ibl = transmission_direct_part * darkening_ibl + coat_transmission_direct_part;

    // coat.layer_ibl: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    float3 layer_ibl_part = environment_specular.SampleLevel(environment_specular_sampler, reflection, roughness * frame.environment_max_lod).xyz * ((coat_split.x + coat_split.y) * reflectance);
    float3 layer_ibl = indirect * transmission_ibl + layer_ibl_part;

    // output
    out_color = float4(light_sum + layer_ibl * frame.environment_intensity, 1.0);
}
