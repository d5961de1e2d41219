// forward-diffuse_transmission-7563b54a5d52d40579d5fd9747ecbbf6
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
    diffuse_transmission_color_factor: vec3f,
    roughness_factor: f32,
    base_color_factor: vec3f,
    diffuse_transmission_factor: f32,
    body: vec3f,
    alpha2: f32,
    F0: vec3f,
    alpha2_ratio: f32,
    lobe: vec3f,
    weight_times_ggx_peak: f32,
    metal_repeated: vec3f,
    dielectric: f32,
    mixed_F90: f32,
    under_facing: f32,
    inverse_dielectric_times_0_0857: f32,
    first: f32,
    metal_first: f32,
}

@group(1) @binding(0) var<uniform> material: Material;

@group(0) @binding(4) var environment_specular: texture_cube<f32>;
@group(0) @binding(5) var environment_specular_sampler: sampler;
@group(0) @binding(6) var environment_irradiance: texture_cube<f32>;
@group(0) @binding(7) var environment_irradiance_sampler: sampler;
@group(0) @binding(8) var environment_dfg: texture_2d<f32>;
@group(0) @binding(9) var environment_dfg_sampler: sampler;
@group(1) @binding(2) var diffuse_transmission_texture: texture_2d<f32>;
@group(1) @binding(3) var diffuse_transmission_texture_sampler: sampler;

struct FragmentOutputs {
    @location(0) out_color: vec4f,
}

@fragment
fn main(
    @location(0) v_position: vec3f,
    @location(1) v_normal: vec3f,
    @location(2) v_uv0: vec2f,
    @builtin(front_facing) in_front_facing: bool,
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

    // normal.facing: glTF 2.0, "Double Sided"
    let facing = select(-N, N, in_front_facing);

    // diffuse_transmission.texel: glTF 2.0, "Textures"
    let texel = textureSample(diffuse_transmission_texture, diffuse_transmission_texture_sampler, v_uv0);

    // leaf.textured: KHR_materials_diffuse_transmission, "Diffuse Transmission"
    let textured = material.diffuse_transmission_factor * texel.w;

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    let cosines_part = dot(facing, to_eye);
    let signed_NdotV = cosines_part * view_part_2;
    let NdotV = abs(cosines_part) * view_part_2;

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let masked_view = sqrt(material.alpha2_ratio + NdotV * NdotV);

    // leaf.front: KHR_materials_diffuse_transmission, "Material Structure Updates"
    let front_part = 1.0 - textured;

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
        let signed_NdotL = dot(facing, to_light) * inverse_distance;
        let NdotL = clamp(signed_NdotL, 0.0, 1.0);
        let NdotSum = NdotL + signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        let planar = sum - facing * NdotSum;
        let planar2 = dot(planar, planar);
        let spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        let base_facing = select(0.0, length2 * length2, 0.0 < NdotSum);
        let denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        let base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = material.weight_times_ggx_peak * base_facing / (denominator * base_sum + 3e-32);

        // behind.cosines: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        let behind_NdotL = clamp(-signed_NdotL, 0.0, 1.0);
        let behind_NdotSum = behind_NdotL + signed_NdotV;
        let straight = signed_NdotL + signed_NdotV;

        // behind.half: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        let behind_planar = sum - facing * straight;
        let behind_planar2 = dot(behind_planar, behind_planar);
        let behind_length2 = behind_planar2 + behind_NdotSum * behind_NdotSum;
        let behind_VdotH = clamp(0.5 * sqrt(behind_length2), 0.0, 1.0);

        // behind.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        let c = 1.0 - behind_VdotH;
        let c2 = c * c;
        let weight = c2 * c2 * c;
        let most = clamp(0.04 + 0.96 * weight, 0.0, 1.0);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        let base_c = 1.0 - VdotH;
        let base_c2 = base_c * base_c;
        let base_weight = base_c2 * base_c2 * base_c;
        let glancing = base_weight * NdotL;
        let base_facing_2 = NdotL - glancing;
        let refracted = material.under_facing * base_facing_2;
        let direct = material.F0 * (base_facing_2 * specular) + material.mixed_F90 * glancing * specular + material.body * (front_part * refracted);

        // base.through: KHR_materials_transmission, "Transmission BTDF"; KHR_materials_diffuse_transmission, "Material Structure Updates"
        let through = direct + material.lobe * (textured * (behind_NdotL * (material.dielectric * (1.0 - most))));

        // output
        light_sum += through * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(NdotV, material.roughness_factor), 0.0);

    // base.irradiance: glTF 2.0, Appendix B, "Diffuse BRDF"
    let mean = textureSampleLevel(environment_irradiance, environment_irradiance_sampler, facing, 0.0).xyz;

    // base.body_indirect: glTF 2.0, Appendix B, "Diffuse BRDF"
    let body_indirect = material.base_color_factor * mean;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; glTF 2.0,
    let lost = clamp(1.0 - split.y - split.x, 0.0, 1.0);
    let metal_bounces = material.metal_first - material.metal_repeated * lost;
    let indirect_part = 0.04 * split.x + split.y;
    let base_all = indirect_part / (material.first - material.inverse_dielectric_times_0_0857 * lost) + (material.base_color_factor * split.x + split.y) / metal_bounces;
    let once = material.F0 * split.x + material.mixed_F90 * split.y;
    let most_bounces = 1.000001 - 0.08571429 * lost;
    let under = material.dielectric * (1.0 - clamp(indirect_part / most_bounces, 0.0, 1.0));
    let base_indirect_part = once * textureSampleLevel(environment_specular, environment_specular_sampler, cosines_part * 2.0 * facing - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + clamp(base_all - once, vec3f(0.0), vec3f(1.0)) * mean;
    let base_indirect_part_2 = body_indirect * (front_part * under) + material.diffuse_transmission_color_factor * textureSampleLevel(environment_irradiance, environment_irradiance_sampler, -facing, 0.0).xyz * (textured * under);
    let indirect = base_indirect_part + base_indirect_part_2;

    // output
    out_stage.out_color = vec4f(light_sum + indirect * frame.environment_intensity, 1.0);

    return out_stage;
}
