// forward-coat-dec7fe4855cd503b639d3ab1ca84508d
// Lacquer 0.2.0, template forward

struct Frame {
    view_projection: mat4x4f,
    camera_position: vec3f,
    environment_intensity: f32,
    environment_max_lod: f32,
    light_count: i32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

struct Light {
    position: vec3f,
    positional: f32,
    radiance: vec3f,
    inverse_range_4: f32,
    direction: vec3f,
    spot_scale: f32,
    spot_offset: f32,
}

@group(0) @binding(2) var<uniform> lights: array<Light, 16>;

struct Material {
    coat_color_factor: vec3f,
    row_u_x: f32,
    base_color_factor: vec3f,
    row_v_y: f32,
    base_color_complement: vec3f,
    normal_scale: f32,
    metal_repeated: vec3f,
    metallic_factor: f32,
    F0: vec3f,
    roughness_factor: f32,
    coat_factor: f32,
    coat_roughness_factor: f32,
    coat_normal_scale: f32,
    f0: f32,
    F0_complement: f32,
    inverse_ior2: f32,
    least_cos2_t: f32,
    coat_darkening_factor: f32,
    cos_coat_anisotropy_rotation: f32,
    sin_coat_anisotropy_rotation: f32,
    coat_anisotropy_strength: f32,
    alpha2: f32,
    alpha2_ratio: f32,
    weight_times_ggx_peak: f32,
    lambert: f32,
    least_f0: f32,
    coat_roughness_factor_times_0_25: f32,
    undarkened: f32,
    inverse_metallic: f32,
    inverse_clear: f32,
    dielectric_repeated: f32,
    white_F0: f32,
    f0_plus_0_5: f32,
}

@group(1) @binding(0) var<uniform> material: Material;

@group(0) @binding(4) var environment_specular: texture_cube<f32>;
@group(0) @binding(5) var environment_specular_sampler: sampler;
@group(0) @binding(6) var environment_irradiance: texture_cube<f32>;
@group(0) @binding(7) var environment_irradiance_sampler: sampler;
@group(0) @binding(8) var environment_dfg: texture_2d<f32>;
@group(0) @binding(9) var environment_dfg_sampler: sampler;
@group(1) @binding(2) var normal_texture: texture_2d<f32>;
@group(1) @binding(3) var normal_texture_sampler: sampler;
@group(1) @binding(4) var coat_texture: texture_2d<f32>;
@group(1) @binding(5) var coat_texture_sampler: sampler;
@group(1) @binding(6) var coat_normal_texture: texture_2d<f32>;
@group(1) @binding(7) var coat_normal_texture_sampler: sampler;
@group(1) @binding(8) var coat_color_texture: texture_2d<f32>;
@group(1) @binding(9) var coat_color_texture_sampler: sampler;
@group(1) @binding(10) var coat_anisotropy_texture: texture_2d<f32>;
@group(1) @binding(11) var coat_anisotropy_texture_sampler: sampler;

struct FragmentOutputs {
    @location(0) out_color: vec4f,
}

@fragment
fn main(
    @location(0) v_position: vec3f,
    @location(1) v_normal: vec3f,
    @location(2) v_tangent: vec4f,
    @location(3) v_uv0: vec2f,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    // view: glTF 2.0, Appendix B, "Overview"
    let to_eye = frame.camera_position - v_position;
    let view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    let V = to_eye * inverseSqrt(to_eye.x * to_eye.x + view_part);

    // normal.unit: glTF 2.0, "Meshes"
    let unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    let N = v_normal * inverseSqrt(v_normal.x * v_normal.x + unit_part);

    // normal.frame: glTF 2.0, "Meshes" (bitangent = cross(normal, tangent.xyz) * tangent.w)
    let B = cross(v_normal, v_tangent.xyz) * v_tangent.w;

    // normal.uv: KHR_texture_transform, "Overview"
    let uv = vec2f(material.row_u_x * v_uv0.x, material.row_v_y * v_uv0.y);

    // normal.texel: glTF 2.0, "Textures"
    let texel = textureSample(normal_texture, normal_texture_sampler, uv);

    // base.normal_map: glTF 2.0, "Additional Textures" (normal)
    let xy = texel.xy * 2.0 - 1.0;
    let z = max(texel.z * 2.0 - 1.0, 1e-14);
    let normal_map_part = v_tangent.xyz * (xy.x * material.normal_scale) + B * (xy.y * material.normal_scale);
    let bent = normal_map_part + v_normal * z;
    let base_normal_map_part = bent.y * bent.y + (bent.z * bent.z + 1e-32);
    let unit = bent * inverseSqrt(bent.x * bent.x + base_normal_map_part);

    // coat.texel: glTF 2.0, "Textures"
    let coat_texel = textureSample(coat_texture, coat_texture_sampler, v_uv0);

    // coat.surface: KHR_materials_coat, "Parameter Combinations"; KHR_materials_clearcoat, "Clearcoat"
    let weight = material.coat_factor * coat_texel.x;
    let roughness = material.coat_roughness_factor * coat_texel.y;

    // coat_normal.texel: glTF 2.0, "Textures"
    let coat_normal_texel = textureSample(coat_normal_texture, coat_normal_texture_sampler, v_uv0);

    // coat.normal_map: glTF 2.0, "Additional Textures" (normal)
    let coat_xy = coat_normal_texel.xy * 2.0 - 1.0;
    let coat_z = max(coat_normal_texel.z * 2.0 - 1.0, 1e-14);
    let coat_normal_map_part = v_tangent.xyz * (coat_xy.x * material.coat_normal_scale) + B * (coat_xy.y * material.coat_normal_scale);
    let coat_bent = coat_normal_map_part + v_normal * coat_z;
    let coat_normal_map_part_2 = coat_bent.y * coat_bent.y + (coat_bent.z * coat_bent.z + 1e-32);
    let coat_unit = coat_bent * inverseSqrt(coat_bent.x * coat_bent.x + coat_normal_map_part_2);

    // coat.alpha: glTF 2.0, Appendix B, "Microfacet Surfaces" and "Specular BRDF" (note on alpha = 0)
    let alpha = max(roughness * roughness, 0.001);

    // coat.view_cosine: KHR_materials_clearcoat, "Layering"
    let signed_NdotV = dot(coat_unit, V);
    let view_cosine = abs(signed_NdotV);

    // coat.fresnel: glTF 2.0, Appendix B, "Fresnel"; Schlick 1994
    let c = 1.0 - view_cosine;
    let c2 = c * c;
    let fresnel = material.f0 + material.F0_complement * (c2 * c2 * abs(c));

    // coat_color.texel: glTF 2.0, "Textures"
    let coat_color_texel = textureSample(coat_color_texture, coat_color_texture_sampler, v_uv0);

    // coat.color: KHR_materials_coat, "Parameter Combinations"; EXT_materials_clearcoat_color; ADOBE_materials_clearcoat_tint
    let color = material.coat_color_factor * coat_color_texel.xyz;

    // coat.absorption: KHR_materials_coat, "Colored Absorption"; EXT_materials_clearcoat_color, "View-Dependent Absorption"
    let view_cosine2 = view_cosine * view_cosine;
    let cos2_t = material.least_cos2_t + material.inverse_ior2 * view_cosine2;
    let path = inverseSqrt(max(cos2_t, 1e-6));
    let log2_tint = log2(max(color, vec3f(1e-30)));
    let absorption = exp2(log2_tint * path);

    // coat_anisotropy.texel: glTF 2.0, "Textures"
    let coat_anisotropy_texel = textureSample(coat_anisotropy_texture, coat_anisotropy_texture_sampler, v_uv0);

    // coat.anisotropy_texel: KHR_materials_coat, "Anisotropy" (dequantization)
    let d = coat_anisotropy_texel.xy * 2.0 - 1.0;
    let length2 = dot(d, d);
    let coat_unit_2 = d * inverseSqrt(length2 + 1e-32);
    let direction = select(vec2f(1.0, 0.0), coat_unit_2, 1e-12 < length2);

    // coat.anisotropy_strength: KHR_materials_coat, "Parameter Combinations"
    let anisotropy_strength = coat_anisotropy_texel.z * material.coat_anisotropy_strength;

    // coat.anisotropy: KHR_materials_coat, "Anisotropy"
    let anisotropy_part = cross(N, v_tangent.xyz) * (v_tangent.w * (direction.x * material.sin_coat_anisotropy_rotation + direction.y * material.cos_coat_anisotropy_rotation));
    let coat_anisotropy_part = v_tangent.xyz * (direction.x * material.cos_coat_anisotropy_rotation - direction.y * material.sin_coat_anisotropy_rotation) + anisotropy_part;
    let normal_to_both = cross(coat_unit, coat_anisotropy_part);
    let coat_anisotropy_part_2 = normal_to_both.y * normal_to_both.y + (normal_to_both.z * normal_to_both.z + 1e-32);
    let across = normal_to_both * inverseSqrt(normal_to_both.x * normal_to_both.x + coat_anisotropy_part_2);

    // coat.anisotropic_alpha: KHR_materials_coat, "Anisotropy" (directionAlphaRoughness)
    let alpha_t = mix(alpha, 1.0, anisotropy_strength * anisotropy_strength);

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    let base_signed_NdotV = dot(unit, V);
    let NdotV = abs(base_signed_NdotV);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let masked_view = sqrt(material.alpha2_ratio + NdotV * NdotV);

    // coat.anisotropy_cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
    let BdotV = dot(across, V);

    // coat.distribution: KHR_materials_coat, "Anisotropy" (D); Burley 2012
    let narrowness = min(alpha / alpha_t, 1.0);
    let narrowness2 = narrowness * narrowness;
    let narrowness2_complement = 1.0 - narrowness2;
    let alpha_b2 = alpha * alpha;
    let ggx_peak = alpha_b2 * narrowness / 3.1415927;

    // coat.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
    let alpha_t2 = alpha_t * alpha_t;
    let alpha2_difference = max(alpha_t2 - alpha_b2, 0.0);
    let alpha_t2_complement = 1.0 - alpha_t2;
    let masked_view2 = alpha_t2 - alpha2_difference * (BdotV * BdotV) + alpha_t2_complement * view_cosine2;
    let coat_masked_view = sqrt(clamp(masked_view2, 0.0, 1.0));

    // coat.darkening_direct: KHR_materials_coat, "Darkening Control" (R direct); EXT_materials_clearcoat_darkening
    let half_fresnel = 0.5 - material.coat_roughness_factor_times_0_25 * coat_texel.y;
    let half_grazing = material.F0_complement * half_fresnel;
    let darkening_direct_part = 1.0 - (fresnel + material.f0) * half_fresnel;

    // coat.transmission_direct: EXT_materials_clearcoat_color, "Implementation" (the tint is weighted by the coverage)
    let reflectance = weight * fresnel;
    let refracted = clamp(1.0 - reflectance, 0.0, 1.0);
    let covered = weight * refracted;
    let transmission_direct_part = absorption * covered;
    let coat_transmission_direct_part = refracted - covered;

    // output
    var light_sum = vec3f(0.0);
    for (var i = 0; i < min(frame.light_count, 16); i++) {
        // light_sample: KHR_lights_punctual, "Range Property" and "Inner and Outer Cone Angles"
        let to_light = lights[i].position - v_position * lights[i].positional;
        let distance2 = max(dot(to_light, to_light), 1e-12);
        let inverse_distance = mix(1.0, inverseSqrt(distance2), lights[i].positional);
        let L = to_light * inverse_distance;
        let window = clamp(1.0 - distance2 * (distance2 * lights[i].inverse_range_4), 0.0, 1.0);
        let cone = clamp(lights[i].spot_offset - dot(L, lights[i].direction) * lights[i].spot_scale, 0.0, 1.0);
        let radiance = lights[i].radiance * (window * (cone * cone) * (inverse_distance * inverse_distance));

        // half: glTF 2.0, Appendix B, "Overview"
        let sum = V + L;
        let half_length2 = dot(sum, sum);
        let VdotH = clamp(0.5 * sqrt(half_length2), 0.0, 1.0);

        // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        let NdotL = clamp(dot(unit, L), 0.0, 1.0);
        let NdotSum = NdotL + base_signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        let planar = sum - unit * NdotSum;
        let planar2 = dot(planar, planar);
        let spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        let half_length22 = half_length2 * half_length2;
        let facing = select(0.0, half_length22, 0.0 < NdotSum);
        let denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        let base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // coat.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        let signed_NdotL = dot(coat_unit, L);
        let coat_NdotL = clamp(signed_NdotL, 0.0, 1.0);
        let coat_NdotSum = coat_NdotL + signed_NdotV;

        // coat.anisotropy_cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
        let BdotL = dot(across, L);

        // coat.distribution: KHR_materials_coat, "Anisotropy" (D); Burley 2012
        let coat_planar = sum - coat_unit * coat_NdotSum;
        let coat_planar2 = dot(coat_planar, coat_planar);
        let BdotSum = BdotV + BdotL;
        let coat_spread = narrowness2_complement * (BdotSum * BdotSum) + narrowness2 * coat_planar2 + alpha_b2 * (coat_NdotSum * coat_NdotSum);
        let coat_facing = select(0.0, half_length22, 0.0 < coat_NdotSum);
        let numerator = coat_facing * ggx_peak;
        let coat_denominator = coat_spread * coat_spread;

        // coat.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
        let masked_light2 = alpha_t2 - alpha2_difference * (BdotL * BdotL) + alpha_t2_complement * (coat_NdotL * coat_NdotL);
        let coat_masked_light = sqrt(clamp(masked_light2, 0.0, 1.0));
        let visibility = 2.0 * (coat_NdotL * coat_masked_view + view_cosine * coat_masked_light);

        // coat.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let coat_specular = numerator / (coat_denominator * visibility + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        let base_c = 1.0 - VdotH;
        let base_c2 = base_c * base_c;
        let base_weight = base_c2 * base_c2 * base_c;
        let glancing = base_weight * NdotL;
        let base_facing = NdotL - glancing;
        let tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        let white = specular * (base_facing * material.least_f0 + glancing);
        let direct = material.base_color_factor * tinted + white;

        // coat.light_cosine: KHR_materials_coat, "Darkening Control"
        let light_cosine = abs(signed_NdotL);

        // coat.darkening_direct: KHR_materials_coat, "Darkening Control" (R direct); EXT_materials_clearcoat_darkening
        let coat_c = 1.0 - light_cosine;
        let coat_c2 = coat_c * coat_c;
        let through = clamp(darkening_direct_part - coat_c2 * coat_c2 * abs(coat_c) * half_grazing, 0.0, 1.0);
        let darkening_direct = material.undarkened + material.coat_darkening_factor * (through * through);

        // coat.transmission_direct: EXT_materials_clearcoat_color, "Implementation" (the tint is weighted by the coverage)
        let transmission_direct = transmission_direct_part * darkening_direct + coat_transmission_direct_part;

        // coat.layer_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        let layer_direct = direct * transmission_direct + coat_specular * coat_NdotL * reflectance;

        // output
        light_sum += layer_direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(NdotV, material.roughness_factor), 0.0);

    // base.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    let R = 2.0 * base_signed_NdotV * unit - V;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    let base_facing_2 = 1.0 - split.y;
    let lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    let base_through = base_facing_2 - lost / 21.0;
    let bounces = material.inverse_metallic - material.metal_repeated * lost;
    let dielectric_bounces = material.inverse_clear - material.dielectric_repeated * lost;
    let base_specular = material.F0 * split.x + split.y;
    let grey = material.metallic_factor * split.x - base_through / dielectric_bounces;
    let base_spread = clamp(material.base_color_complement * (grey - base_through / bounces) + (base_facing_2 - material.white_F0 * split.x), vec3f(0.0), vec3f(1.0));
    let indirect = base_specular * textureSampleLevel(environment_specular, environment_specular_sampler, R, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * textureSampleLevel(environment_irradiance, environment_irradiance_sampler, bent, 0.0).xyz;

    // coat.bent_normal: McAuley 2015, "Rendering the World of Far Cry 4"; as in the Khronos sample viewer's anisotropy
    let towards = V - across * BdotV;
    let smoothness = 1.0 - roughness;
    let bend = anisotropy_strength * smoothness;
    let straight = 1.0 - bend;
    let straight2 = straight * straight;
    let bent_normal = mix(towards, coat_unit, straight2 * straight2);

    // coat.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    let reflection = bent_normal * (2.0 * dot(bent_normal, V)) - V * dot(bent_normal, bent_normal);

    // coat.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let coat_split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(view_cosine, roughness), 0.0);

    // coat.darkening_ibl: KHR_materials_coat, "Darkening Control" (R IBL); EXT_materials_clearcoat_darkening
    let half_around = material.f0_plus_0_5 * half_fresnel;
    let coat_through = clamp(1.0 - fresnel * half_fresnel - half_around, 0.0, 1.0);
    let darkening_ibl = material.undarkened + material.coat_darkening_factor * (coat_through * coat_through);

    // coat.transmission_ibl: EXT_materials_clearcoat_color, "Implementation" (the tint is weighted by the coverage)
    let transmission_ibl = transmission_direct_part * darkening_ibl + coat_transmission_direct_part;

    // coat.layer_ibl: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    let layer_ibl_part = textureSampleLevel(environment_specular, environment_specular_sampler, reflection, roughness * frame.environment_max_lod).xyz * ((coat_split.x + coat_split.y) * reflectance);
    let layer_ibl = indirect * transmission_ibl + layer_ibl_part;

    // output
    out_stage.out_color = vec4f(light_sum + layer_ibl * frame.environment_intensity, 1.0);

    return out_stage;
}
