// forward-sheen-5ae0e6ac6e8a3336fe9c837195f30ead
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
    sheen_color_factor: vec3f,
    metallic_factor: f32,
    base_color_factor: vec3f,
    roughness_factor: f32,
    base_color_complement: vec3f,
    sheen_roughness_factor: f32,
    metal_repeated: vec3f,
    alpha2: f32,
    F0: vec3f,
    alpha2_ratio: f32,
    weight_times_ggx_peak: f32,
    exponent: f32,
    inverse_a: f32,
    b: f32,
    c: f32,
    d: f32,
    middle: f32,
    e_minus_middle: f32,
    peak_times_0_25: f32,
    lambert: f32,
    least_f0: f32,
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
@group(0) @binding(10) var environment_sheen: texture_2d<f32>;
@group(0) @binding(11) var environment_sheen_sampler: sampler;
@group(1) @binding(2) var sheen_color_texture: texture_2d<f32>;
@group(1) @binding(3) var sheen_color_texture_sampler: sampler;

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

    // sheen_color.texel: glTF 2.0, "Textures"
    let texel = textureSample(sheen_color_texture, sheen_color_texture_sampler, v_uv0);

    // sheen.surface: KHR_materials_sheen, "Sheen"
    let color = material.sheen_color_factor * texel.xyz;

    // base.view_cosine: KHR_materials_clearcoat, "Layering"
    let view_cosine_part = dot(N, to_eye);
    let signed_NdotV = view_cosine_part * view_part_2;
    let view_cosine = abs(view_cosine_part) * view_part_2;

    // sheen.view: KHR_materials_sheen, "Albedo-scaling technique" (E)
    let reflected = textureSampleLevel(environment_sheen, environment_sheen_sampler, vec2f(view_cosine, material.sheen_roughness_factor), 0.0);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let masked_view = sqrt(material.alpha2_ratio + view_cosine * view_cosine);

    // sheen.masked_view: KHR_materials_sheen, "Sheen visibility" (lambda_sheen)
    let x = clamp(min(view_cosine, 1.0 - view_cosine), 1e-30, 0.5);
    let above = 1.0 / (material.inverse_a + material.b * exp2(material.c * log2(x))) + (material.d * x + material.e_minus_middle);
    let sheen_masked_view = exp2(material.middle + select(-above, above, view_cosine < 0.5));

    // sheen.lobe: KHR_materials_sheen, "Sheen visibility"
    let lobe_part = max(view_cosine, 0.0001);
    let sheen_lobe_part = 1.0 + sheen_masked_view;

    // sheen.direct: KHR_materials_sheen, "Albedo-scaling technique"
    let most = max(max(color.x, color.y), color.z);

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
        let NdotSum = NdotL + signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        let planar = sum - N * NdotSum;
        let planar2 = dot(planar, planar);
        let NdotSum2 = NdotSum * NdotSum;
        let spread = planar2 + material.alpha2 * NdotSum2;
        let facing = select(0.0, length2 * length2, 0.0 < NdotSum);
        let denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        let base_sum = NdotL * masked_view + view_cosine * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // sheen.distribution: KHR_materials_sheen, "Sheen distribution"; Conty and Kulla 2017
        let sine2 = planar2 / max(planar2 + NdotSum2, 1e-12);
        let share = exp2(log2(max(sine2, 1e-30)) * material.exponent);

        // sheen.light_cosine: KHR_materials_coat, "Darkening Control"
        let light_cosine = abs(signed_NdotL);

        // sheen.masked_light: KHR_materials_sheen, "Sheen visibility" (lambda_sheen)
        let sheen_x = clamp(min(light_cosine, 1.0 - light_cosine), 1e-30, 0.5);
        let sheen_above = 1.0 / (material.inverse_a + material.b * exp2(material.c * log2(sheen_x))) + (material.d * sheen_x + material.e_minus_middle);
        let sheen_masked_light = exp2(material.middle + select(-sheen_above, sheen_above, light_cosine < 0.5));

        // sheen.light: KHR_materials_sheen, "Albedo-scaling technique" (E)
        let sheen_reflected = textureSampleLevel(environment_sheen, environment_sheen_sampler, vec2f(light_cosine, material.sheen_roughness_factor), 0.0);

        // sheen.lobe: KHR_materials_sheen, "Sheen visibility"
        let cosines = lobe_part * max(light_cosine, 0.0001);
        let kept = reflected.y * sheen_reflected.y;
        let lobe = material.peak_times_0_25 * share * kept / (cosines * (sheen_lobe_part + sheen_masked_light));

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        let c = 1.0 - VdotH;
        let c2 = c * c;
        let weight = c2 * c2 * c;
        let glancing = weight * NdotL;
        let base_facing = NdotL - glancing;
        let tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        let white = specular * (base_facing * material.least_f0 + glancing);

        // sheen.direct: KHR_materials_sheen, "Albedo-scaling technique"
        let direct_part = 1.0 - most * max(reflected.x, sheen_reflected.x);
        let direct = material.base_color_factor * (tinted * direct_part) + white * direct_part + color * (lobe * NdotL);

        // output
        light_sum += direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(view_cosine, material.roughness_factor), 0.0);

    // base.radiance: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    let radiance_part = view_cosine_part * 2.0 * N - to_eye;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    let base_facing_2 = 1.0 - split.y;
    let lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    let through = base_facing_2 - lost / 21.0;
    let bounces = material.inverse_metallic - material.metal_repeated * lost;
    let dielectric_bounces = material.inverse_clear - material.dielectric_repeated * lost;
    let base_specular = material.F0 * split.x + split.y;
    let grey = material.metallic_factor * split.x - through / dielectric_bounces;
    let base_spread = clamp(material.base_color_complement * (grey - through / bounces) + (base_facing_2 - material.white_F0 * split.x), vec3f(0.0), vec3f(1.0));
    let indirect = base_specular * textureSampleLevel(environment_specular, environment_specular_sampler, radiance_part, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * textureSampleLevel(environment_irradiance, environment_irradiance_sampler, v_normal, 0.0).xyz;

    // sheen.indirect: KHR_materials_sheen, "Albedo-scaling technique"
    let sheen_indirect = indirect * (1.0 - most * reflected.x) + textureSampleLevel(environment_specular, environment_specular_sampler, radiance_part, material.sheen_roughness_factor * frame.environment_max_lod).xyz * (color * reflected.x);

    // output
    out_stage.out_color = vec4f(light_sum + sheen_indirect * frame.environment_intensity, 1.0);

    return out_stage;
}
