// forward-base-50e111927bdf8a5cc68a9a9f00fd606f
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
    body: vec3f,
    roughness_factor: f32,
    base_color_complement: vec3f,
    alpha2: f32,
    metal_repeated: vec3f,
    alpha2_ratio: f32,
    F0: vec3f,
    weight_times_ggx_peak: f32,
    dielectric: f32,
    lambert: f32,
    least_f0: f32,
    retroreflection_factor: f32,
    one_minus_retroreflection_factor: f32,
    inverse_metallic: f32,
    inverse_clear: f32,
    dielectric_repeated: f32,
    white_F0: f32,
}

@group(1) @binding(0) var<uniform> material: Material;

@group(0) @binding(4) var environment_specular: texture_cube<f32>;
@group(0) @binding(5) var environment_specular_sampler: sampler;
@group(0) @binding(6) var environment_irradiance: texture_cube<f32>;
@group(0) @binding(7) var environment_irradiance_sampler: sampler;
@group(0) @binding(8) var environment_dfg: texture_2d<f32>;
@group(0) @binding(9) var environment_dfg_sampler: sampler;

struct FragmentOutputs {
    @location(0) out_color: vec4f,
}

@fragment
fn main(
    @location(0) v_position: vec3f,
    @location(1) v_normal: vec3f,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    // view: glTF 2.0, Appendix B, "Overview"
    let to_eye = frame.camera_position - v_position;
    let view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    let V = to_eye * inverseSqrt(to_eye.x * to_eye.x + view_part);

    // normal.unit: glTF 2.0, "Meshes"
    let unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    let N = v_normal * inverseSqrt(v_normal.x * v_normal.x + unit_part);

    // retro.view: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    let signed_NdotV = dot(N, V);
    let R = 2.0 * signed_NdotV * N - V;

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    let NdotV = abs(signed_NdotV);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let masked_view = sqrt(material.alpha2_ratio + NdotV * NdotV);

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
        let NdotL = clamp(dot(N, to_light) * inverse_distance, 0.0, 1.0);
        let NdotSum = NdotL + signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        let distribution_part = N * NdotSum;
        let planar = sum - distribution_part;
        let planar2 = dot(planar, planar);
        let base_distribution_part = material.alpha2 * (NdotSum * NdotSum);
        let spread = planar2 + base_distribution_part;
        let base_distribution_part_2 = 0.0 < NdotSum;
        let facing = select(0.0, length2 * length2, base_distribution_part_2);
        let denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        let base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // retro.half: glTF 2.0, Appendix B, "Overview"
        let retro_sum = R + L;
        let retro_length2 = dot(retro_sum, retro_sum);
        let retro_VdotH = clamp(0.5 * sqrt(retro_length2), 0.0, 1.0);

        // retro.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        let retro_planar = retro_sum - distribution_part;
        let retro_planar2 = dot(retro_planar, retro_planar);
        let retro_spread = retro_planar2 + base_distribution_part;
        let retro_facing = select(0.0, retro_length2 * retro_length2, base_distribution_part_2);
        let retro_denominator = retro_spread * retro_spread;

        // retro.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let retro_specular = material.weight_times_ggx_peak * retro_facing / (retro_denominator * base_sum + 3e-32);

        // retro.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        let c = 1.0 - retro_VdotH;
        let c2 = c * c;
        let weight = c2 * c2 * c;
        let most = clamp(0.04 + 0.96 * weight, 0.0, 1.0);

        // retro.metal_schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        let F = mix(material.base_color_factor, vec3f(1.0), weight);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        let base_c = 1.0 - VdotH;
        let base_c2 = base_c * base_c;
        let base_weight = base_c2 * base_c2 * base_c;
        let glancing = base_weight * NdotL;
        let base_facing = NdotL - glancing;
        let tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        let white = specular * (base_facing * material.least_f0 + glancing);

        // retro.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        let reflected = retro_specular * NdotL;
        let refracted = NdotL * (material.dielectric * (1.0 - most));
        let direct = mix(0.04, 1.0, weight) * material.dielectric * reflected + F * (material.metallic_factor * reflected) + material.body * refracted;

        // retro.mixed: KHR_materials_retroreflection, "Retroreflection"
        let mixed = material.base_color_factor * (tinted * material.one_minus_retroreflection_factor) + white * material.one_minus_retroreflection_factor + direct * material.retroreflection_factor;

        // output
        light_sum += mixed * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(NdotV, material.roughness_factor), 0.0);

    // base.radiance: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    let radiance_part = material.roughness_factor * frame.environment_max_lod;

    // retro.both: KHR_materials_retroreflection, "Retroreflection"
    let both = textureSampleLevel(environment_specular, environment_specular_sampler, R, radiance_part).xyz * material.one_minus_retroreflection_factor + textureSampleLevel(environment_specular, environment_specular_sampler, to_eye, radiance_part).xyz * material.retroreflection_factor;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    let base_facing_2 = 1.0 - split.y;
    let lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    let through = base_facing_2 - lost / 21.0;
    let bounces = material.inverse_metallic - material.metal_repeated * lost;
    let dielectric_bounces = material.inverse_clear - material.dielectric_repeated * lost;
    let base_specular = material.F0 * split.x + split.y;
    let grey = material.metallic_factor * split.x - through / dielectric_bounces;
    let base_spread = clamp(material.base_color_complement * (grey - through / bounces) + (base_facing_2 - material.white_F0 * split.x), vec3f(0.0), vec3f(1.0));
    let indirect = base_specular * both + base_spread * textureSampleLevel(environment_irradiance, environment_irradiance_sampler, v_normal, 0.0).xyz;

    // output
    out_stage.out_color = vec4f(light_sum + indirect * frame.environment_intensity, 1.0);

    return out_stage;
}
