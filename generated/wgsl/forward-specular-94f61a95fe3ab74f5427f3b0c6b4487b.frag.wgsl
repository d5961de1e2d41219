// forward-specular-94f61a95fe3ab74f5427f3b0c6b4487b
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
    F0: vec3f,
    metallic_factor: f32,
    base_color_factor: vec3f,
    roughness_factor: f32,
    body: vec3f,
    specular_factor: f32,
    mean_fresnel: vec3f,
    transmission_factor: f32,
    metal_mean_fresnel: vec3f,
    most_F0: f32,
    specular_factor_minus_most_F0: f32,
    one_minus_most_F0: f32,
    one_minus_specular_factor: f32,
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
@group(1) @binding(2) var metallic_roughness_texture: texture_2d<f32>;
@group(1) @binding(3) var metallic_roughness_texture_sampler: sampler;

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

    // metallic_roughness.texel: glTF 2.0, "Textures"
    let texel = textureSample(metallic_roughness_texture, metallic_roughness_texture_sampler, v_uv0);

    // base.metallic_roughness: glTF 2.0, "Metallic-Roughness Material"
    let metallic = material.metallic_factor * texel.z;
    let roughness = material.roughness_factor * texel.y;

    // base.alpha: glTF 2.0, Appendix B, "Microfacet Surfaces" and "Specular BRDF" (note on alpha = 0)
    let alpha = max(roughness * roughness, 0.001);

    // clear.textured: KHR_materials_transmission, "Properties"
    let textured = material.transmission_factor * texel.x;

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    let cosines_part = dot(N, to_eye);
    let signed_NdotV = cosines_part * view_part_2;
    let NdotV = abs(cosines_part) * view_part_2;

    // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
    let alpha2 = alpha * alpha;
    let ggx_peak = alpha2 / 3.1415927;

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let alpha2_complement = 1.0 - alpha2;
    let masked_view = sqrt(alpha2 + alpha2_complement * (NdotV * NdotV));

    // behind.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let behind_masked_view = NdotV + masked_view;

    // clear.front: KHR_materials_transmission, "Transmission BTDF"; KHR_materials_scatter, "Thin-Walled Mode"
    let front_part = 1.0 - textured;

    // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
    let dielectric = 1.0 - metallic;
    let mixed_F90 = material.specular_factor * dielectric + metallic;
    let under_facing = dielectric * material.one_minus_most_F0;
    let under_glancing = dielectric * material.one_minus_specular_factor;

    // clear.tint: KHR_materials_transmission, "Tinting"; KHR_materials_scatter, "Thin-Walled Mode"
    let tint = material.base_color_factor * textured;

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

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        let planar = sum - N * straight;
        let planar2 = dot(planar, planar);
        let spread = planar2 + alpha2 * (straight * straight);
        let facing = select(0.0, length2 * length2, 0.0 < straight);
        let numerator = facing * ggx_peak;
        let denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let masked_light = sqrt(alpha2 + alpha2_complement * (NdotL * NdotL));
        let visibility = 2.0 * (NdotL * masked_view + NdotV * masked_light);

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = numerator / (denominator * visibility + 3e-32);

        // behind.half: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        let NdotSum2 = NdotSum * NdotSum;
        let behind_length2 = planar2 + NdotSum2;
        let behind_VdotH = clamp(0.5 * sqrt(behind_length2), 0.0, 1.0);

        // behind.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        let c = 1.0 - behind_VdotH;
        let c2 = c * c;
        let weight = c2 * c2 * c;
        let most = clamp(material.most_F0 + material.specular_factor_minus_most_F0 * weight, 0.0, 1.0);

        // behind.distribution: KHR_materials_transmission, "Implementation Notes" (D_T)
        let behind_spread = planar2 + alpha2 * NdotSum2;
        let behind_facing = select(0.0, behind_length2 * behind_length2, 0.0 < NdotSum);
        let behind_numerator = behind_facing * ggx_peak;
        let behind_denominator = behind_spread * behind_spread;

        // behind.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let behind_masked_light = behind_NdotL + sqrt(alpha2 + alpha2_complement * (behind_NdotL * behind_NdotL));
        let behind_visibility = behind_masked_view * behind_masked_light;

        // behind.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let behind_specular = behind_numerator / (behind_denominator * behind_visibility + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        let base_c = 1.0 - VdotH;
        let base_c2 = base_c * base_c;
        let base_weight = base_c2 * base_c2 * base_c;
        let glancing = base_weight * NdotL;
        let base_facing = NdotL - glancing;
        let refracted = under_facing * base_facing + under_glancing * glancing;
        let direct_part = material.F0 * (dielectric * base_facing * specular) + material.base_color_factor * (metallic * base_facing * specular) + mixed_F90 * glancing * specular;
        let direct = direct_part + material.body * (front_part * refracted);

        // base.through: KHR_materials_transmission, "Transmission BTDF"; KHR_materials_diffuse_transmission, "Material Structure Updates"
        let through = direct + tint * (behind_specular * (behind_NdotL * (dielectric * (1.0 - most))));

        // output
        light_sum += through * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(NdotV, roughness), 0.0);

    // dielectric.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    let dielectric_facing = 1.0 - split.y;
    let lost = clamp(dielectric_facing - split.x, 0.0, 1.0);
    let grazing = material.specular_factor * split.y;
    let once = material.F0 * split.x + grazing;
    let bounces = 1.000001 - material.mean_fresnel * lost;
    let dielectric_all = clamp(once / bounces, vec3f(0.0), vec3f(1.0));
    let dielectric_most = max(max(dielectric_all.x, dielectric_all.y), dielectric_all.z);

    // metal.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    let metal_once = material.base_color_factor * split.x + split.y;
    let metal_bounces = 1.000001 - material.metal_mean_fresnel * lost;
    let metal_all = clamp(metal_once / metal_bounces, vec3f(0.0), vec3f(1.0));

    // clear.lod: KHR_materials_transmission, "Implementation Notes"; Khronos glTF sample viewer (applyIorToRoughness, log2 of the
    let lod = roughness * see_through.scene_max_lod;

    // clear.scene: KHR_materials_transmission, "Implementation Notes"
    let clear_point = vec4f(v_position, 1.0);
    let uv = vec2f(dot(see_through.scene_u, clear_point), dot(see_through.scene_v, clear_point)) / max(dot(see_through.scene_w, clear_point), 1e-6);

    // clear.seen: KHR_materials_transmission, "Tinting"
    let seen = tint * textureSampleLevel(scene_behind, scene_behind_sampler, uv, lod).xyz;

    // base.transmitted: KHR_materials_transmission, "Transmission BTDF"
    let under = dielectric * (1.0 - dielectric_most);
    let transmitted = seen * under;

    // base.irradiance: glTF 2.0, Appendix B, "Diffuse BRDF"
    let mean = textureSampleLevel(environment_irradiance, environment_irradiance_sampler, v_normal, 0.0).xyz;

    // base.body_indirect: glTF 2.0, Appendix B, "Diffuse BRDF"
    let body_indirect = material.base_color_factor * mean;

    // base.indirect: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
    let base_once = once * dielectric + metal_once * metallic;
    let base_all = dielectric_all * dielectric + metal_all * metallic;
    let indirect_part = base_once * textureSampleLevel(environment_specular, environment_specular_sampler, cosines_part * 2.0 * N - to_eye, roughness * frame.environment_max_lod).xyz + max(base_all - base_once, vec3f(0.0)) * mean;
    let indirect = indirect_part + body_indirect * (front_part * under);

    // output
    out_stage.out_color = vec4f(light_sum + indirect * frame.environment_intensity + transmitted, 1.0);

    return out_stage;
}
