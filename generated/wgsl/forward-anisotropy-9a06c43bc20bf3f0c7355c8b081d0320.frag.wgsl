// forward-anisotropy-9a06c43bc20bf3f0c7355c8b081d0320
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
    base_color_factor: vec3f,
    metallic_factor: f32,
    lower_f0: vec3f,
    roughness_factor: f32,
    one_minus_lower_f0: vec3f,
    alpha: f32,
    turn: vec3f,
    anisotropy_strength: f32,
    body: vec3f,
    strength: f32,
    mean_fresnel: vec3f,
    inverse_ior2: f32,
    least_cos2_t: f32,
    longest: f32,
    r_squared: f32,
    F0_complement: f32,
    film_fresnel: f32,
    film_fresnel_2: f32,
    film_fresnel_3: f32,
    alpha_b2: f32,
    dielectric: f32,
    smoothness_times_anisotropy_strength: f32,
}

@group(1) @binding(0) var<uniform> material: Material;

@group(0) @binding(4) var environment_specular: texture_cube<f32>;
@group(0) @binding(5) var environment_specular_sampler: sampler;
@group(0) @binding(6) var environment_irradiance: texture_cube<f32>;
@group(0) @binding(7) var environment_irradiance_sampler: sampler;
@group(0) @binding(8) var environment_dfg: texture_2d<f32>;
@group(0) @binding(9) var environment_dfg_sampler: sampler;
@group(1) @binding(2) var anisotropy_texture: texture_2d<f32>;
@group(1) @binding(3) var anisotropy_texture_sampler: sampler;

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

    // anisotropy.texel: glTF 2.0, "Textures"
    let texel = textureSample(anisotropy_texture, anisotropy_texture_sampler, v_uv0);

    // anisotropy.decoded: KHR_materials_coat, "Anisotropy" (dequantization)
    let d = texel.xy * 2.0 - 1.0;
    let length2 = dot(d, d);
    let unit = d * inverseSqrt(length2 + 1e-32);
    let direction = select(vec2f(1.0, 0.0), unit, 1e-12 < length2);

    // anisotropy.textured: KHR_materials_coat, "Parameter Combinations"
    let textured = texel.z * material.anisotropy_strength;

    // anisotropy.across: KHR_materials_coat, "Anisotropy"
    let across_part = v_tangent.xyz * direction.x + cross(N, v_tangent.xyz) * (v_tangent.w * direction.y);
    let normal_to_both = cross(N, across_part);
    let anisotropy_across_part = normal_to_both.y * normal_to_both.y + (normal_to_both.z * normal_to_both.z + 1e-32);
    let across = normal_to_both * inverseSqrt(normal_to_both.x * normal_to_both.x + anisotropy_across_part);

    // anisotropy.alpha: KHR_materials_coat, "Anisotropy" (directionAlphaRoughness)
    let alpha_t = mix(material.alpha, 1.0, textured * textured);

    // base.view_cosine: KHR_materials_clearcoat, "Layering"
    let signed_NdotV = dot(N, V);
    let view_cosine = abs(signed_NdotV);

    // film.fresnel: KHR_materials_iridescence, "Iridescence Fresnel"; Belcour and Barla 2017
    let view_cosine2 = view_cosine * view_cosine;
    let cos_t = sqrt(material.least_cos2_t + material.inverse_ior2 * view_cosine2);
    let path = clamp(material.longest * cos_t, 0.0, 1.0);
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

    // anisotropy.cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
    let BdotV = dot(across, V);

    // anisotropy.distribution: KHR_materials_coat, "Anisotropy" (D); Burley 2012
    let narrowness = min(material.alpha / alpha_t, 1.0);
    let narrowness2 = narrowness * narrowness;
    let narrowness2_complement = 1.0 - narrowness2;
    let ggx_peak = material.alpha_b2 * narrowness / 3.1415927;

    // anisotropy.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
    let alpha_t2 = alpha_t * alpha_t;
    let alpha2_difference = max(alpha_t2 - material.alpha_b2, 0.0);
    let alpha_t2_complement = 1.0 - alpha_t2;
    let masked_view2 = alpha_t2 - alpha2_difference * (BdotV * BdotV) + alpha_t2_complement * view_cosine2;
    let masked_view = sqrt(clamp(masked_view2, 0.0, 1.0));

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
        let NdotL = clamp(dot(N, L), 0.0, 1.0);
        let NdotSum = NdotL + signed_NdotV;

        // dielectric.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        let dielectric_c = 1.0 - VdotH;
        let dielectric_c2 = dielectric_c * dielectric_c;
        let weight = dielectric_c2 * dielectric_c2 * dielectric_c;

        // metal.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        let F = mix(material.base_color_factor, vec3f(1.0), weight);

        // anisotropy.cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
        let BdotL = dot(across, L);

        // anisotropy.distribution: KHR_materials_coat, "Anisotropy" (D); Burley 2012
        let planar = sum - N * NdotSum;
        let planar2 = dot(planar, planar);
        let BdotSum = BdotV + BdotL;
        let spread = narrowness2_complement * (BdotSum * BdotSum) + narrowness2 * planar2 + material.alpha_b2 * (NdotSum * NdotSum);
        let facing = select(0.0, half_length2 * half_length2, 0.0 < NdotSum);
        let numerator = facing * ggx_peak;
        let denominator = spread * spread;

        // anisotropy.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
        let masked_light2 = alpha_t2 - alpha2_difference * (BdotL * BdotL) + alpha_t2_complement * (NdotL * NdotL);
        let masked_light = sqrt(clamp(masked_light2, 0.0, 1.0));
        let visibility = 2.0 * (NdotL * masked_view + view_cosine * masked_light);

        // anisotropy.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = numerator / (denominator * visibility + 3e-32);

        // film.dielectric: KHR_materials_iridescence, "Layering"
        let film_F = mix(vec3f(mix(0.04, 1.0, weight)), dielectric, material.strength);
        let most = max(max(film_F.x, film_F.y), film_F.z);

        // film.metal: KHR_materials_iridescence, "Layering"
        let film_F_2 = mix(F, metal, material.strength);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        let reflected = specular * NdotL;
        let refracted = NdotL * (material.dielectric * (1.0 - most));
        let direct = film_F * (material.dielectric * reflected) + film_F_2 * (material.metallic_factor * reflected) + material.body * refracted;

        // output
        light_sum += direct * radiance;
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

    // anisotropy.bent_normal: McAuley 2015, "Rendering the World of Far Cry 4"; as in the Khronos sample viewer's anisotropy
    let towards = V - across * BdotV;
    let bend = material.smoothness_times_anisotropy_strength * texel.z;
    let straight = 1.0 - bend;
    let straight2 = straight * straight;
    let bent_normal = mix(towards, N, straight2 * straight2);

    // anisotropy.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    let reflection = bent_normal * (2.0 * dot(bent_normal, V)) - V * dot(bent_normal, bent_normal);

    // base.irradiance: glTF 2.0, Appendix B, "Diffuse BRDF"
    let mean = textureSampleLevel(environment_irradiance, environment_irradiance_sampler, v_normal, 0.0).xyz;

    // base.body_indirect: glTF 2.0, Appendix B, "Diffuse BRDF"
    let body_indirect = material.base_color_factor * mean;

    // film.dielectric_environment: Karis 2013, "Real Shading in Unreal Engine 4" (split sum, with a Fresnel that does not depend on the light)
    let dielectric_environment_part = 1.0 - lost;
    let film_once = dielectric * dielectric_environment_part;
    let film_bounces = 1.000001 - dielectric * lost;
    let film_all = clamp(film_once / film_bounces, vec3f(0.0), vec3f(1.0));

    // film.dielectric_once: KHR_materials_iridescence, "Layering"
    let dielectric_once = mix(vec3f(environment_part), film_once, material.strength);

    // film.dielectric_all: KHR_materials_iridescence, "Layering"
    let film_F_3 = mix(vec3f(dielectric_most), film_all, material.strength);
    let film_most = max(max(film_F_3.x, film_F_3.y), film_F_3.z);

    // film.metal_environment: Karis 2013, "Real Shading in Unreal Engine 4" (split sum, with a Fresnel that does not depend on the light)
    let film_once_2 = metal * dielectric_environment_part;
    let film_bounces_2 = 1.000001 - metal * lost;
    let film_all_2 = clamp(film_once_2 / film_bounces_2, vec3f(0.0), vec3f(1.0));

    // film.metal_once: KHR_materials_iridescence, "Layering"
    let metal_once = mix(once, film_once_2, material.strength);

    // film.metal_all: KHR_materials_iridescence, "Layering"
    let film_F_4 = mix(metal_all, film_all_2, material.strength);

    // base.indirect: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
    let base_once = dielectric_once * material.dielectric + metal_once * material.metallic_factor;
    let base_all = film_F_3 * material.dielectric + film_F_4 * material.metallic_factor;
    let under = material.dielectric * (1.0 - film_most);
    let indirect_part = base_once * textureSampleLevel(environment_specular, environment_specular_sampler, reflection, material.roughness_factor * frame.environment_max_lod).xyz + max(base_all - base_once, vec3f(0.0)) * mean;
    let indirect = indirect_part + body_indirect * under;

    // output
    out_stage.out_color = vec4f(light_sum + indirect * frame.environment_intensity, 1.0);

    return out_stage;
}
