// forward-coat-77a64032ee05bc73689c807d73296bf0
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
    base_color_complement: vec3f,
    roughness_factor: f32,
    metal_repeated: vec3f,
    coat_roughness_factor: f32,
    F0: vec3f,
    cos_coat_anisotropy_rotation: f32,
    sin_coat_anisotropy_rotation: f32,
    alpha2: f32,
    alpha2_ratio: f32,
    weight_times_ggx_peak: f32,
    narrowness2: f32,
    narrowness2_complement: f32,
    alpha_b2: f32,
    ggx_peak: f32,
    alpha_t2: f32,
    alpha2_difference: f32,
    alpha_t2_complement: f32,
    coat_factor_times_0_96: f32,
    coat_factor_times_0_04: f32,
    lambert: f32,
    least_f0: f32,
    inverse_metallic: f32,
    inverse_clear: f32,
    dielectric_repeated: f32,
    white_F0: f32,
    straight2_squared: f32,
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
    @location(2) v_tangent: vec4f,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    // view: glTF 2.0, Appendix B, "Overview"
    let to_eye = frame.camera_position - v_position;
    let view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    let V = to_eye * inverseSqrt(to_eye.x * to_eye.x + view_part);

    // normal.unit: glTF 2.0, "Meshes"
    let unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    let N = v_normal * inverseSqrt(v_normal.x * v_normal.x + unit_part);

    // coat.view_cosine: KHR_materials_clearcoat, "Layering"
    let signed_NdotV = dot(N, V);
    let view_cosine = abs(signed_NdotV);

    // coat.fresnel: glTF 2.0, Appendix B, "Fresnel"; Schlick 1994
    let c = 1.0 - view_cosine;
    let c2 = c * c;

    // coat.anisotropy: KHR_materials_coat, "Anisotropy"
    let anisotropy_part = v_tangent.xyz * material.cos_coat_anisotropy_rotation + cross(N, v_tangent.xyz) * (v_tangent.w * material.sin_coat_anisotropy_rotation);
    let normal_to_both = cross(N, anisotropy_part);
    let coat_anisotropy_part = normal_to_both.y * normal_to_both.y + (normal_to_both.z * normal_to_both.z + 1e-32);
    let across = normal_to_both * inverseSqrt(normal_to_both.x * normal_to_both.x + coat_anisotropy_part);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let view_cosine2 = view_cosine * view_cosine;
    let masked_view = sqrt(material.alpha2_ratio + view_cosine2);

    // coat.anisotropy_cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
    let BdotV = dot(across, V);

    // coat.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
    let masked_view2 = material.alpha_t2 - material.alpha2_difference * (BdotV * BdotV) + material.alpha_t2_complement * view_cosine2;
    let coat_masked_view = sqrt(clamp(masked_view2, 0.0, 1.0));

    // coat.transmission_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    let reflectance = material.coat_factor_times_0_04 + material.coat_factor_times_0_96 * (c2 * c2 * abs(c));

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
        let length2 = dot(sum, sum);
        let VdotH = clamp(0.5 * sqrt(length2), 0.0, 1.0);

        // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        let NdotL = clamp(dot(N, L), 0.0, 1.0);
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

        // coat.anisotropy_cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
        let BdotL = dot(across, L);

        // coat.distribution: KHR_materials_coat, "Anisotropy" (D); Burley 2012
        let BdotSum = BdotV + BdotL;
        let coat_spread = material.narrowness2_complement * (BdotSum * BdotSum) + material.narrowness2 * planar2 + material.alpha_b2 * NdotSum2;
        let numerator = facing * material.ggx_peak;
        let coat_denominator = coat_spread * coat_spread;

        // coat.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
        let masked_light2 = material.alpha_t2 - material.alpha2_difference * (BdotL * BdotL) + material.alpha_t2_complement * NdotL2;
        let coat_masked_light = sqrt(clamp(masked_light2, 0.0, 1.0));
        let visibility = 2.0 * (NdotL * coat_masked_view + view_cosine * coat_masked_light);

        // coat.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let coat_specular = numerator / (coat_denominator * visibility + 3e-32);

        // coat.transmission_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        let reflected = NdotL * reflectance;
        let transmitted = clamp(NdotL - reflected, 0.0, 1.0);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        let base_c = 1.0 - VdotH;
        let base_c2 = base_c * base_c;
        let weight = base_c2 * base_c2 * base_c;
        let glancing = weight * transmitted;
        let base_facing = transmitted - glancing;
        let tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        let white = specular * (base_facing * material.least_f0 + glancing);

        // coat.layer_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        let layer_direct = material.base_color_factor * tinted + (white + coat_specular * reflected);

        // output
        light_sum += layer_direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(view_cosine, material.roughness_factor), 0.0);

    // base.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    let R = 2.0 * signed_NdotV * N - V;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    let base_facing_2 = 1.0 - split.y;
    let lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    let through = base_facing_2 - lost / 21.0;
    let bounces = material.inverse_metallic - material.metal_repeated * lost;
    let dielectric_bounces = material.inverse_clear - material.dielectric_repeated * lost;
    let base_specular = material.F0 * split.x + split.y;
    let grey = material.metallic_factor * split.x - through / dielectric_bounces;
    let base_spread = clamp(material.base_color_complement * (grey - through / bounces) + (base_facing_2 - material.white_F0 * split.x), vec3f(0.0), vec3f(1.0));
    let indirect = base_specular * textureSampleLevel(environment_specular, environment_specular_sampler, R, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * textureSampleLevel(environment_irradiance, environment_irradiance_sampler, v_normal, 0.0).xyz;

    // coat.bent_normal: McAuley 2015, "Rendering the World of Far Cry 4"; as in the Khronos sample viewer's anisotropy
    let towards = V - across * BdotV;
    let bent_normal = mix(towards, N, material.straight2_squared);

    // coat.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    let reflection = bent_normal * (2.0 * dot(bent_normal, V)) - V * dot(bent_normal, bent_normal);

    // coat.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let coat_split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(view_cosine, material.coat_roughness_factor), 0.0);

    // output
    let output_part = textureSampleLevel(environment_specular, environment_specular_sampler, reflection, material.coat_roughness_factor * frame.environment_max_lod).xyz * ((coat_split.x + coat_split.y) * reflectance * frame.environment_intensity);

    out_stage.out_color = vec4f(light_sum + (indirect * (clamp(1.0 - reflectance, 0.0, 1.0) * frame.environment_intensity) + output_part), 1.0);

    return out_stage;
}
