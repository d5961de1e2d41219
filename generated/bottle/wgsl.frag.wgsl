// forward-volume-3cbc4b942deea0550645914bd878b26a
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
    density: vec3f,
    roughness_factor: f32,
    base_color_factor: vec3f,
    f0: f32,
    tint: vec3f,
    roughness: f32,
    front: vec3f,
    thickness_factor: f32,
    F0: vec3f,
    alpha2: f32,
    metal_repeated: vec3f,
    alpha2_ratio: f32,
    weight_times_ggx_peak: f32,
    one_minus_f0: f32,
    behind_alpha2: f32,
    ggx_peak: f32,
    behind_alpha2_ratio: f32,
    complement_root: f32,
    one_minus_transmission_factor: f32,
    dielectric: f32,
    mixed_F90: f32,
    under_facing: f32,
    most_mean: f32,
    inverse_ior: f32,
    inverse_ior2: f32,
    most_mean_times_inverse_dielectric: f32,
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
@group(0) @binding(16) var scene_behind: texture_2d<f32>;
@group(0) @binding(17) var scene_behind_sampler: sampler;

struct FragmentOutputs {
    @location(0) out_color: vec4f,
}

@fragment
fn main(
    @location(0) v_position: vec3f,
    @location(1) v_normal: vec3f,
    @location(2) v_volume_length: f32,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    // view: glTF 2.0, Appendix B, "Overview"
    let to_eye = frame.camera_position - v_position;
    let view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    let V = to_eye * inverseSqrt(to_eye.x * to_eye.x + view_part);

    // normal.unit: glTF 2.0, "Meshes"
    let unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    let N = v_normal * inverseSqrt(v_normal.x * v_normal.x + unit_part);

    // volume.length: KHR_materials_volume, "Properties" (thickness is in the mesh's space)
    let volume_length = min(v_volume_length, 1e30);

    // volume.transmittance: KHR_materials_volume, "Attenuation" (transmittance)
    let transmittance = exp2(material.density * volume_length);

    // volume.tint: KHR_materials_volume, "Attenuation"
    let tint = material.tint * transmittance;

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    let signed_NdotV = dot(N, V);
    let NdotV = abs(signed_NdotV);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let NdotV2 = NdotV * NdotV;
    let masked_view = sqrt(material.alpha2_ratio + NdotV2);

    // behind.visibility: KHR_materials_transmission, "Implementation Notes" (V_T)
    let behind_masked_view = NdotV + material.complement_root * sqrt(material.behind_alpha2_ratio + NdotV2);

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
        let either2 = either * either;
        let masked_light = sqrt(material.alpha2_ratio + either2);
        let base_sum = either * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // behind.half: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        let NdotSum2 = NdotSum * NdotSum;
        let behind_length2 = planar2 + NdotSum2;
        let behind_VdotH = clamp(0.5 * sqrt(behind_length2), 0.0, 1.0);

        // behind.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        let c = 1.0 - behind_VdotH;
        let c2 = c * c;
        let weight = c2 * c2 * c;
        let most = clamp(material.f0 + material.one_minus_f0 * weight, 0.0, 1.0);

        // behind.distribution: KHR_materials_transmission, "Implementation Notes" (D_T)
        let behind_spread = planar2 + material.behind_alpha2 * NdotSum2;
        let behind_facing = select(0.0, behind_length2 * behind_length2, 0.0 < NdotSum);
        let numerator = behind_facing * material.ggx_peak;
        let behind_denominator = behind_spread * behind_spread;

        // behind.visibility: KHR_materials_transmission, "Implementation Notes" (V_T)
        let behind_masked_light = either + material.complement_root * sqrt(material.behind_alpha2_ratio + either2);
        let visibility = behind_masked_view * behind_masked_light;

        // behind.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let behind_specular = numerator / (behind_denominator * visibility + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        let base_c = 1.0 - VdotH;
        let base_c2 = base_c * base_c;
        let base_weight = base_c2 * base_c2 * base_c;
        let glancing = base_weight * NdotL;
        let base_facing = NdotL - glancing;
        let refracted = material.under_facing * base_facing;
        let direct = material.F0 * (base_facing * specular) + material.mixed_F90 * glancing * specular + material.front * refracted;

        // base.through: KHR_materials_transmission, "Transmission BTDF"; KHR_materials_diffuse_transmission, "Material Structure Updates"
        let through = direct + tint * (behind_specular * (behind_NdotL * (material.dielectric * (1.0 - most))));

        // output
        light_sum += through * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(NdotV, material.roughness_factor), 0.0);

    // dielectric.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    let dielectric_facing = 1.0 - split.y;
    let lost = clamp(dielectric_facing - split.x, 0.0, 1.0);
    let environment_part = material.f0 * split.x + split.y;
    let most_bounces = 1.000001 - material.most_mean * lost;
    let dielectric_most = clamp(environment_part / most_bounces, 0.0, 1.0);

    // volume.exit: KHR_materials_volume, "Refraction" (Snell's law)
    let sine2 = clamp(1.0 - signed_NdotV * signed_NdotV, 0.0, 1.0);
    let refracted_cosine = sqrt(clamp(1.0 - material.inverse_ior2 * sine2, 0.0, 1.0));
    let along_normal = material.inverse_ior * signed_NdotV - refracted_cosine;
    let exit = v_position + N * (along_normal * volume_length) - V * (material.inverse_ior * volume_length);

    // clear.lod: KHR_materials_transmission, "Implementation Notes"; Khronos glTF sample viewer (applyIorToRoughness, log2 of the
    let lod = material.roughness * see_through.scene_max_lod;

    // clear.scene: KHR_materials_transmission, "Implementation Notes"
    let clear_point = vec4f(exit, 1.0);
    let uv = vec2f(dot(see_through.scene_u, clear_point), dot(see_through.scene_v, clear_point)) / max(dot(see_through.scene_w, clear_point), 1e-6);

    // clear.seen: KHR_materials_transmission, "Tinting"
    let seen = tint * textureSampleLevel(scene_behind, scene_behind_sampler, uv, lod).xyz;

    // base.transmitted: KHR_materials_transmission, "Transmission BTDF"
    let under = material.dielectric * (1.0 - dielectric_most);
    let transmitted = seen * under;

    // base.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    let R = 2.0 * signed_NdotV * N - V;

    // base.irradiance: glTF 2.0, Appendix B, "Diffuse BRDF"
    let mean = textureSampleLevel(environment_irradiance, environment_irradiance_sampler, v_normal, 0.0).xyz;

    // base.body_indirect: glTF 2.0, Appendix B, "Diffuse BRDF"
    let body_indirect = material.base_color_factor * mean;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; glTF 2.0,
    let metal_bounces = material.metal_first - material.metal_repeated * lost;
    let base_all = environment_part / (material.first - material.most_mean_times_inverse_dielectric * lost) + (material.base_color_factor * split.x + split.y) / metal_bounces;
    let once = material.F0 * split.x + material.mixed_F90 * split.y;
    let indirect_part = once * textureSampleLevel(environment_specular, environment_specular_sampler, R, material.roughness_factor * frame.environment_max_lod).xyz + clamp(base_all - once, vec3f(0.0), vec3f(1.0)) * mean;
    let indirect = indirect_part + body_indirect * (material.one_minus_transmission_factor * under);

    // output
    out_stage.out_color = vec4f(light_sum + indirect * frame.environment_intensity + transmitted, 1.0);

    return out_stage;
}
