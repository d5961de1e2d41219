// forward-coat-12c10870bbeaa4391d526f62685f5162
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
    metallic_factor: f32,
    base_color_factor: vec3f,
    roughness_factor: f32,
    base_color_complement: vec3f,
    coat_factor: f32,
    metal_repeated: vec3f,
    coat_roughness_factor: f32,
    F0: vec3f,
    inverse_ior2: f32,
    least_cos2_t: f32,
    alpha2: f32,
    alpha2_ratio: f32,
    weight_times_ggx_peak: f32,
    coat_alpha2: f32,
    coat_alpha2_ratio: f32,
    coat_weight_times_ggx_peak: f32,
    lambert: f32,
    least_f0: f32,
    coat_factor_times_F0_complement: f32,
    coat_factor_times_f0: f32,
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
@group(1) @binding(2) var coat_color_texture: texture_2d<f32>;
@group(1) @binding(3) var coat_color_texture_sampler: sampler;

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

    // coat.view_cosine: KHR_materials_clearcoat, "Layering"
    let view_cosine_part = dot(N, to_eye);
    let signed_NdotV = view_cosine_part * view_part_2;
    let view_cosine = abs(view_cosine_part) * view_part_2;

    // coat.fresnel: glTF 2.0, Appendix B, "Fresnel"; Schlick 1994
    let c = 1.0 - view_cosine;
    let c2 = c * c;

    // coat_color.texel: glTF 2.0, "Textures"
    let texel = textureSample(coat_color_texture, coat_color_texture_sampler, v_uv0);

    // coat.color: KHR_materials_coat, "Parameter Combinations"; EXT_materials_clearcoat_color; ADOBE_materials_clearcoat_tint
    let color = material.coat_color_factor * texel.xyz;

    // coat.absorption: KHR_materials_coat, "Colored Absorption"; EXT_materials_clearcoat_color, "View-Dependent Absorption"
    let view_cosine2 = view_cosine * view_cosine;
    let cos2_t = material.least_cos2_t + material.inverse_ior2 * view_cosine2;
    let path = inverseSqrt(max(cos2_t, 1e-6));
    let log2_tint = log2(max(color, vec3f(1e-30)));
    let absorption = exp2(log2_tint * path);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let masked_view = sqrt(material.alpha2_ratio + view_cosine2);

    // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let coat_masked_view = sqrt(material.coat_alpha2_ratio + view_cosine2);

    // coat.transmission_direct: EXT_materials_clearcoat_color, "Implementation" (the tint is weighted by the coverage)
    let reflectance = material.coat_factor_times_f0 + material.coat_factor_times_F0_complement * (c2 * c2 * abs(c));
    let refracted = clamp(1.0 - reflectance, 0.0, 1.0);
    let covered = material.coat_factor * refracted;
    let transmission_direct = absorption * covered + (refracted - covered);

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
        let NdotSum2 = NdotSum * NdotSum;
        let spread = planar2 + material.alpha2 * NdotSum2;
        let facing = select(0.0, length2 * length2, 0.0 < NdotSum);
        let denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let NdotL2 = NdotL * NdotL;
        let masked_light = sqrt(material.alpha2_ratio + NdotL2);
        let base_sum = NdotL * masked_view + view_cosine * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // coat.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        let coat_spread = planar2 + material.coat_alpha2 * NdotSum2;
        let coat_denominator = coat_spread * coat_spread;

        // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let coat_masked_light = sqrt(material.coat_alpha2_ratio + NdotL2);
        let coat_sum = NdotL * coat_masked_view + view_cosine * coat_masked_light;

        // coat.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let coat_specular = material.coat_weight_times_ggx_peak * facing / (coat_denominator * coat_sum + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        let base_c = 1.0 - VdotH;
        let base_c2 = base_c * base_c;
        let weight = base_c2 * base_c2 * base_c;
        let glancing = weight * NdotL;
        let base_facing = NdotL - glancing;
        let tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        let white = specular * (base_facing * material.least_f0 + glancing);
        let direct = material.base_color_factor * tinted + white;

        // coat.layer_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        let layer_direct = direct * transmission_direct + coat_specular * NdotL * reflectance;

        // output
        light_sum += layer_direct * radiance;
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

    // coat.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let coat_split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(view_cosine, material.coat_roughness_factor), 0.0);

    // coat.layer_ibl: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    let layer_ibl_part = textureSampleLevel(environment_specular, environment_specular_sampler, radiance_part, material.coat_roughness_factor * frame.environment_max_lod).xyz * ((coat_split.x + coat_split.y) * reflectance);
    let layer_ibl = indirect * transmission_direct + layer_ibl_part;

    // output
    out_stage.out_color = vec4f(light_sum + layer_ibl * frame.environment_intensity, 1.0);

    return out_stage;
}
