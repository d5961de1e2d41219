// forward-base-90635bb95589462632851765a0f686df
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
    base_color_factor: vec4f,
    metallic_factor: f32,
    roughness_factor: f32,
    alpha2: f32,
    alpha2_ratio: f32,
    weight_times_ggx_peak: f32,
    lambert: f32,
    least_f0: f32,
    clear: f32,
    least_f0_plus_metallic_factor: f32,
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
    @location(2) v_COLOR_0: vec4f,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    // color0
    let color0 = clamp(v_COLOR_0, vec4f(0.0), vec4f(1.0));

    // view: glTF 2.0, Appendix B, "Overview"
    let to_eye = frame.camera_position - v_position;
    let view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    let view_part_2 = inverseSqrt(to_eye.x * to_eye.x + view_part);
    let V = to_eye * view_part_2;

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    let color = material.base_color_factor * color0;

    // normal.unit: glTF 2.0, "Meshes"
    let unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    let N = v_normal * inverseSqrt(v_normal.x * v_normal.x + unit_part);

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    let cosines_part = dot(N, to_eye);
    let signed_NdotV = cosines_part * view_part_2;
    let NdotV = abs(cosines_part) * view_part_2;

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
        let planar = sum - N * NdotSum;
        let planar2 = dot(planar, planar);
        let spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        let facing = select(0.0, length2 * length2, 0.0 < NdotSum);
        let denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        let base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        let c = 1.0 - VdotH;
        let c2 = c * c;
        let weight = c2 * c2 * c;
        let glancing = weight * NdotL;
        let base_facing = NdotL - glancing;
        let tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        let white = specular * (base_facing * material.least_f0 + glancing);
        let direct = color.xyz * tinted + white;

        // output
        light_sum += direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(NdotV, material.roughness_factor), 0.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; glTF 2.0,
    let base_facing_2 = 1.0 - split.y;
    let lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    let through = base_facing_2 - lost / 21.0;
    let base_color_complement = 1.0 - color.xyz;
    let bounces = 1.000001 - lost + base_color_complement * (0.95238096 * lost);
    let dielectric_bounces = 1.000001 - lost * 0.08571429;
    let base = material.clear * (through / dielectric_bounces);
    let grey = material.metallic_factor * split.x;
    let base_white = material.least_f0_plus_metallic_factor * split.x;
    let base_specular = color.xyz * grey + (material.least_f0 * split.x + split.y);
    let base_spread = clamp(base_color_complement * (grey - base - material.metallic_factor * through / bounces) + (base_facing_2 - base_white), vec3f(0.0), vec3f(1.0));
    let indirect = base_specular * textureSampleLevel(environment_specular, environment_specular_sampler, cosines_part * 2.0 * N - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * textureSampleLevel(environment_irradiance, environment_irradiance_sampler, v_normal, 0.0).xyz;

    // output
    out_stage.out_color = vec4f(light_sum + indirect * frame.environment_intensity, 1.0);

    return out_stage;
}
