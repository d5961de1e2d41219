// forward-base-f217b135f6c9b4210455f224951dcd52
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

struct SeeThrough {
    scene_u: vec4f,
    scene_v: vec4f,
    scene_w: vec4f,
    scene_max_lod: f32,
}

@group(0) @binding(14) var<uniform> see_through: SeeThrough;

struct Material {
    base_color_factor: vec3f,
    metallic_factor: f32,
    lower_f0: vec3f,
    roughness_factor: f32,
    one_minus_lower_f0: vec3f,
    film_thickness: f32,
    turn: vec3f,
    film_thickness_2: f32,
    front: vec3f,
    iridescence_factor: f32,
    tint: vec3f,
    inverse_ior2: f32,
    mean_fresnel: vec3f,
    least_cos2_t: f32,
    iridescence_ior_times_0_000125: f32,
    r_squared: f32,
    F0_complement: f32,
    film_fresnel: f32,
    film_fresnel_2: f32,
    film_fresnel_3: f32,
    alpha2: f32,
    ggx_peak: f32,
    alpha2_ratio: f32,
    weight_times_ggx_peak: f32,
    complement_root: f32,
    one_minus_transmission_factor: f32,
    dielectric: f32,
}

@group(1) @binding(0) var<uniform> material: Material;

@group(0) @binding(4) var environment_specular: texture_cube<f32>;
@group(0) @binding(5) var environment_specular_sampler: sampler;
@group(0) @binding(6) var environment_irradiance: texture_cube<f32>;
@group(0) @binding(7) var environment_irradiance_sampler: sampler;
@group(0) @binding(8) var environment_dfg: texture_2d<f32>;
@group(0) @binding(9) var environment_dfg_sampler: sampler;
@group(0) @binding(16) var scene_behind: texture_2d<f32>;
@group(0) @binding(17) var scene_behind_sampler: sampler;
@group(1) @binding(2) var iridescence_thickness_texture: texture_2d<f32>;
@group(1) @binding(3) var iridescence_thickness_texture_sampler: sampler;

struct FragmentOutputs {
    @location(0) out_color: vec4f,
}

@fragment
fn main(
    @location(0) v_position: vec3f,
    @location(1) v_normal: vec3f,
    @location(2) v_uv0: vec2f,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    // view: glTF 2.0, Appendix B, "Overview"
    let to_eye = frame.camera_position - v_position;
    let view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    let view_part_2 = inverseSqrt(to_eye.x * to_eye.x + view_part);
    let V = to_eye * view_part_2;

    // normal.unit: glTF 2.0, "Meshes"
    let unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    let N = v_normal * inverseSqrt(v_normal.x * v_normal.x + unit_part);

    // iridescence_thickness.texel: glTF 2.0, "Textures"
    let texel = textureSample(iridescence_thickness_texture, iridescence_thickness_texture_sampler, v_uv0);

    // film.thickness: KHR_materials_iridescence, "Properties"
    let thickness = mix(material.film_thickness, material.film_thickness_2, texel.y);

    // film.strength: KHR_materials_iridescence, "Properties"
    let there = clamp(thickness * 10.0, 0.0, 1.0);
    let strength = material.iridescence_factor * there;

    // base.view_cosine: KHR_materials_clearcoat, "Layering"
    let view_cosine_part = dot(N, to_eye);
    let signed_NdotV = view_cosine_part * view_part_2;
    let view_cosine = abs(view_cosine_part) * view_part_2;

    // film.fresnel: KHR_materials_iridescence, "Iridescence Fresnel"; Belcour and Barla 2017
    let view_cosine2 = view_cosine * view_cosine;
    let cos_t = sqrt(material.least_cos2_t + material.inverse_ior2 * view_cosine2);
    let longest = material.iridescence_ior_times_0_000125 * thickness;
    let path = clamp(longest * cos_t, 0.0, 1.0);
    let c = 1.0 - view_cosine;
    let c2 = c * c;
    let upper = material.r_squared + material.F0_complement * (c2 * c2 * abs(c));
    let film_c = 1.0 - cos_t;
    let film_c2 = film_c * film_c;
    let lower_weight = film_c2 * film_c2 * abs(film_c);
    let waves = cos(vec4f(168.99255, 180.48325, 222.01259, 225.1793) * path);
    let fades = exp2(vec4f(63.101753, 135.66629, 96.40813, 66.0237) * -(path * path));
    let first = waves * fades;
    let fades2 = fades * fades;
    let second = (2.0 * (waves * waves) - 1.0) * (fades2 * fades2);
    let film_first = vec3f(first.x + 0.18175068 * first.w, first.y, first.z);
    let fresnel_part = vec3f(5.4866724, -1.6411418, 0.09421429) * (second.x + 0.18175068 * second.w) + vec3f(-3.0749593, 3.752854, -0.40814236) * second.y;
    let film_second = fresnel_part + vec3f(-0.998182, 0.08320529, 2.116824) * second.z;
    let film_fresnel_part = material.film_fresnel + material.film_fresnel_2 * lower_weight;
    let turned = film_first * material.film_fresnel_3;
    let first_rgb = vec3f(5.4866724, -1.6411418, 0.09421429) * turned.x + vec3f(-3.0749593, 3.752854, -0.40814236) * turned.y + vec3f(-0.998182, 0.08320529, 2.116824) * turned.z;
    let through = 1.0 - upper;
    let film_fresnel_part_2 = clamp(upper * film_fresnel_part, 1e-5, 0.9999);
    let through2 = through * through;
    let film_fresnel_part_3 = through2 * film_fresnel_part / (1.0 - film_fresnel_part_2);
    let film_fresnel_part_4 = film_fresnel_part_3 - through;
    let film_fresnel_part_5 = upper + film_fresnel_part_3 + (first_rgb * (sqrt(film_fresnel_part_2) * film_fresnel_part_4) + film_second * (film_fresnel_part_2 * film_fresnel_part_4));
    let dielectric = clamp(film_fresnel_part_5, vec3f(0.0), vec3f(1.0));
    let lower = material.lower_f0 + material.one_minus_lower_f0 * lower_weight;
    let film_turned = film_first * material.turn;
    let film_first_rgb = vec3f(5.4866724, -1.6411418, 0.09421429) * film_turned.x + vec3f(-3.0749593, 3.752854, -0.40814236) * film_turned.y + vec3f(-0.998182, 0.08320529, 2.116824) * film_turned.z;
    let both = clamp(upper * lower, vec3f(1e-5), vec3f(0.9999));
    let repeated = through2 * lower / (1.0 - both);
    let swing = repeated - through;
    let metal = clamp(upper + repeated + swing * (sqrt(both) * film_first_rgb + both * film_second), vec3f(0.0), vec3f(1.0));

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let masked_view = sqrt(material.alpha2_ratio + view_cosine2);

    // behind.visibility: KHR_materials_transmission, "Implementation Notes" (V_T)
    let behind_masked_view = view_cosine + material.complement_root * masked_view;

    // output
    var light_sum = vec3f(0.0);
    for (var i = 0; i < min(frame.light_count, 16); i++) {
        // light_sample: KHR_lights_punctual, "Range Property" and "Inner and Outer Cone Angles"
        let to_light = lights[i].position - v_position * lights[i].positional;
        let distance2 = max(dot(to_light, to_light), 1e-12);
        let inverse_distance = mix(1.0, inverseSqrt(distance2), lights[i].positional);
        let L = to_light * inverse_distance;
        let window = clamp(1.0 - distance2 * (distance2 * lights[i].inverse_range_4), 0.0, 1.0);
        let cone = clamp(lights[i].spot_offset - dot(to_light, lights[i].direction) * inverse_distance * lights[i].spot_scale, 0.0, 1.0);
        let radiance = lights[i].radiance * (window * (cone * cone) * (inverse_distance * inverse_distance));

        // half: glTF 2.0, Appendix B, "Overview"
        let sum = V + L;
        let length2 = dot(sum, sum);
        let VdotH = clamp(0.5 * sqrt(length2), 0.0, 1.0);

        // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        let signed_NdotL = dot(N, to_light) * inverse_distance;
        let NdotL = clamp(signed_NdotL, 0.0, 1.0);

        // behind.cosines: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        let behind_NdotL = clamp(-signed_NdotL, 0.0, 1.0);
        let NdotSum = behind_NdotL + signed_NdotV;
        let straight = signed_NdotL + signed_NdotV;
        let either = min(abs(signed_NdotL), 1.0);

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        let planar = sum - N * straight;
        let planar2 = dot(planar, planar);
        let spread = planar2 + material.alpha2 * (straight * straight);
        let facing = select(0.0, length2 * length2, 0.0 < straight);
        let denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let masked_light = sqrt(material.alpha2_ratio + either * either);
        let base_sum = either * masked_view + view_cosine * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // dielectric.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        let dielectric_c = 1.0 - VdotH;
        let dielectric_c2 = dielectric_c * dielectric_c;
        let weight = dielectric_c2 * dielectric_c2 * dielectric_c;

        // metal.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        let F = mix(material.base_color_factor, vec3f(1.0), weight);

        // behind.half: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        let NdotSum2 = NdotSum * NdotSum;
        let behind_length2 = planar2 + NdotSum2;
        let behind_VdotH = clamp(0.5 * sqrt(behind_length2), 0.0, 1.0);

        // behind.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        let behind_c = 1.0 - behind_VdotH;
        let behind_c2 = behind_c * behind_c;
        let behind_weight = behind_c2 * behind_c2 * behind_c;

        // film.dielectric: KHR_materials_iridescence, "Layering"
        let film_F = mix(vec3f(mix(0.04, 1.0, weight)), dielectric, strength);
        let most = max(max(film_F.x, film_F.y), film_F.z);

        // film.metal: KHR_materials_iridescence, "Layering"
        let film_F_2 = mix(F, metal, strength);

        // film.behind: KHR_materials_iridescence, "Layering"
        let film_F_3 = mix(vec3f(mix(0.04, 1.0, behind_weight)), dielectric, strength);
        let film_most = max(max(film_F_3.x, film_F_3.y), film_F_3.z);

        // behind.distribution: KHR_materials_transmission, "Implementation Notes" (D_T)
        let behind_spread = planar2 + material.alpha2 * NdotSum2;
        let behind_facing = select(0.0, behind_length2 * behind_length2, 0.0 < NdotSum);
        let numerator = behind_facing * material.ggx_peak;
        let behind_denominator = behind_spread * behind_spread;

        // behind.visibility: KHR_materials_transmission, "Implementation Notes" (V_T)
        let behind_masked_light = either + material.complement_root * masked_light;
        let visibility = behind_masked_view * behind_masked_light;

        // behind.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let behind_specular = numerator / (behind_denominator * visibility + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        let reflected = specular * NdotL;
        let refracted = NdotL * (material.dielectric * (1.0 - most));
        let direct = film_F * (material.dielectric * reflected) + film_F_2 * (material.metallic_factor * reflected) + material.front * refracted;

        // base.through: KHR_materials_transmission, "Transmission BTDF"; KHR_materials_diffuse_transmission, "Material Structure Updates"
        let base_through = direct + material.tint * (behind_specular * (behind_NdotL * (material.dielectric * (1.0 - film_most))));

        // output
        light_sum += base_through * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(view_cosine, material.roughness_factor), 0.0);

    // dielectric.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    let dielectric_facing = 1.0 - split.y;
    let lost = clamp(dielectric_facing - split.x, 0.0, 1.0);
    let environment_part = 0.04 * split.x + split.y;
    let dielectric_most = clamp(environment_part / (1.000001 - 0.08571429 * lost), 0.0, 1.0);

    // metal.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    let once = material.base_color_factor * split.x + split.y;
    let bounces = 1.000001 - material.mean_fresnel * lost;
    let metal_all = clamp(once / bounces, vec3f(0.0), vec3f(1.0));

    // clear.lod: KHR_materials_transmission, "Implementation Notes"; Khronos glTF sample viewer (applyIorToRoughness, log2 of the
    let lod = material.roughness_factor * see_through.scene_max_lod;

    // clear.scene: KHR_materials_transmission, "Implementation Notes"
    let clear_point = vec4f(v_position, 1.0);
    let uv = vec2f(dot(see_through.scene_u, clear_point), dot(see_through.scene_v, clear_point)) / max(dot(see_through.scene_w, clear_point), 1e-6);

    // clear.seen: KHR_materials_transmission, "Tinting"
    let seen = material.tint * textureSampleLevel(scene_behind, scene_behind_sampler, uv, lod).xyz;

    // film.dielectric_environment: Karis 2013, "Real Shading in Unreal Engine 4" (split sum, with a Fresnel that does not depend on the light)
    let dielectric_environment_part = 1.0 - lost;
    let film_once = dielectric * dielectric_environment_part;
    let film_bounces = 1.000001 - dielectric * lost;
    let film_all = clamp(film_once / film_bounces, vec3f(0.0), vec3f(1.0));

    // film.dielectric_all: KHR_materials_iridescence, "Layering"
    let film_F_4 = mix(vec3f(dielectric_most), film_all, strength);
    let film_most_2 = max(max(film_F_4.x, film_F_4.y), film_F_4.z);

    // base.transmitted: KHR_materials_transmission, "Transmission BTDF"
    let under = material.dielectric * (1.0 - film_most_2);
    let transmitted = seen * under;

    // base.irradiance: glTF 2.0, Appendix B, "Diffuse BRDF"
    let mean = textureSampleLevel(environment_irradiance, environment_irradiance_sampler, v_normal, 0.0).xyz;

    // base.body_indirect: glTF 2.0, Appendix B, "Diffuse BRDF"
    let body_indirect = material.base_color_factor * mean;

    // film.dielectric_once: KHR_materials_iridescence, "Layering"
    let dielectric_once = mix(vec3f(environment_part), film_once, strength);

    // film.metal_environment: Karis 2013, "Real Shading in Unreal Engine 4" (split sum, with a Fresnel that does not depend on the light)
    let film_once_2 = metal * dielectric_environment_part;
    let film_bounces_2 = 1.000001 - metal * lost;
    let film_all_2 = clamp(film_once_2 / film_bounces_2, vec3f(0.0), vec3f(1.0));

    // film.metal_once: KHR_materials_iridescence, "Layering"
    let metal_once = mix(once, film_once_2, strength);

    // film.metal_all: KHR_materials_iridescence, "Layering"
    let film_F_5 = mix(metal_all, film_all_2, strength);

    // base.indirect: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
    let base_once = dielectric_once * material.dielectric + metal_once * material.metallic_factor;
    let base_all = film_F_4 * material.dielectric + film_F_5 * material.metallic_factor;
    let indirect_part = base_once * textureSampleLevel(environment_specular, environment_specular_sampler, view_cosine_part * 2.0 * N - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + max(base_all - base_once, vec3f(0.0)) * mean;
    let indirect = indirect_part + body_indirect * (material.one_minus_transmission_factor * under);

    // output
    out_stage.out_color = vec4f(light_sum + indirect * frame.environment_intensity + transmitted, 1.0);

    return out_stage;
}
