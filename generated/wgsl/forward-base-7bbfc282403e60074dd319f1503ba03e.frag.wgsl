// forward-base-7bbfc282403e60074dd319f1503ba03e
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
    emissive_factor_times_emissive_strength: vec3f,
    metallic_factor: f32,
    roughness_factor: f32,
    f0: f32,
    occlusion_strength: f32,
    refracted: f32,
    refracted_over_3_14: f32,
    mean_fresnel: f32,
}

@group(1) @binding(0) var<uniform> material: Material;

@group(0) @binding(4) var environment_specular: texture_cube<f32>;
@group(0) @binding(5) var environment_specular_sampler: sampler;
@group(0) @binding(6) var environment_irradiance: texture_cube<f32>;
@group(0) @binding(7) var environment_irradiance_sampler: sampler;
@group(0) @binding(8) var environment_dfg: texture_2d<f32>;
@group(0) @binding(9) var environment_dfg_sampler: sampler;
@group(1) @binding(2) var base_color_texture: texture_2d<f32>;
@group(1) @binding(3) var base_color_texture_sampler: sampler;
@group(1) @binding(4) var normal_texture: texture_2d<f32>;
@group(1) @binding(5) var normal_texture_sampler: sampler;
@group(1) @binding(6) var metallic_roughness_texture: texture_2d<f32>;
@group(1) @binding(7) var metallic_roughness_texture_sampler: sampler;
@group(1) @binding(8) var emissive_texture: texture_2d<f32>;
@group(1) @binding(9) var emissive_texture_sampler: sampler;

struct FragmentOutputs {
    @location(0) out_color: vec4f,
}

@fragment
fn main(
    @location(0) v_position: vec3f,
    @location(1) v_normal: vec3f,
    @location(2) v_uv0: vec2f,
    @location(3) v_uv1: vec2f,
    @location(4) v_COLOR_0: vec4f,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    // color0
    let color0 = clamp(v_COLOR_0, vec4f(0.0), vec4f(1.0));

    // view: glTF 2.0, Appendix B, "Overview"
    let to_eye = frame.camera_position - v_position;
    let view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    let view_part_2 = inverseSqrt(to_eye.x * to_eye.x + view_part);
    let V = to_eye * view_part_2;

    // base_color.texel: glTF 2.0, "Textures"
    let texel = textureSample(base_color_texture, base_color_texture_sampler, v_uv0);

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    let color = material.base_color_factor * texel * color0;

    // normal.unit: glTF 2.0, "Meshes"
    let unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    let N = v_normal * inverseSqrt(v_normal.x * v_normal.x + unit_part);

    // normal.frame: glTF 2.0, "Meshes" (tangents where none are given)
    let px = dpdx(v_position);
    let py = dpdy(v_position);
    let uvx = dpdx(v_uv0);
    let uvy = dpdy(v_uv0);
    let mirrored = select(1.0, -1.0, uvx.x * uvy.y < uvy.x * uvx.y);
    let frame_part = px * uvy.y - py * uvx.y;
    let along_u = frame_part * mirrored;
    let normal_frame_part = px * uvy.x - py * uvx.x;
    let along_v = normal_frame_part * mirrored;
    let value_in_plane_u = along_u - N * (dot(N, frame_part) * mirrored);
    let value_in_plane_v = along_v - N * (dot(N, normal_frame_part) * mirrored);
    let normal_frame_part_2 = value_in_plane_u.y * value_in_plane_u.y + (value_in_plane_u.z * value_in_plane_u.z + 1e-32);
    let normal_frame_part_3 = value_in_plane_v.y * value_in_plane_v.y + (value_in_plane_v.z * value_in_plane_v.z + 1e-32);

    // normal.texel: glTF 2.0, "Textures"
    let normal_texel = textureSample(normal_texture, normal_texture_sampler, v_uv0);

    // base.normal_map: glTF 2.0, "Additional Textures" (normal)
    let xy = normal_texel.xy * 2.0 - 1.0;
    let z = max(normal_texel.z * 2.0 - 1.0, 1e-14);
    let normal_map_part = value_in_plane_u * (inverseSqrt(value_in_plane_u.x * value_in_plane_u.x + normal_frame_part_2) * xy.x);
    let base_normal_map_part = value_in_plane_v * (inverseSqrt(value_in_plane_v.x * value_in_plane_v.x + normal_frame_part_3) * xy.y);
    let bent = normal_map_part + base_normal_map_part + N * z;
    let base_normal_map_part_2 = bent.y * bent.y + (bent.z * bent.z + 1e-32);
    let unit = bent * inverseSqrt(bent.x * bent.x + base_normal_map_part_2);

    // metallic_roughness.texel: glTF 2.0, "Textures"
    let metallic_roughness_texel = textureSample(metallic_roughness_texture, metallic_roughness_texture_sampler, v_uv0);

    // base.metallic_roughness: glTF 2.0, "Metallic-Roughness Material"
    let metallic = material.metallic_factor * metallic_roughness_texel.z;
    let roughness = material.roughness_factor * metallic_roughness_texel.y;

    // base.alpha: glTF 2.0, Appendix B, "Microfacet Surfaces" and "Specular BRDF" (note on alpha = 0)
    let alpha = max(roughness * roughness, 0.001);

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    let cosines_part = dot(unit, to_eye);
    let signed_NdotV = cosines_part * view_part_2;
    let NdotV = abs(cosines_part) * view_part_2;

    // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
    let alpha2 = alpha * alpha;
    let ggx_peak = alpha2 / 3.1415927;

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let alpha2_complement = 1.0 - alpha2;
    let masked_view = sqrt(alpha2 + alpha2_complement * (NdotV * NdotV));

    // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
    let dielectric = 1.0 - metallic;
    let lambert = dielectric * material.refracted_over_3_14;
    let least_f0 = material.f0 * dielectric;

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
        let NdotL = clamp(dot(unit, to_light) * inverse_distance, 0.0, 1.0);
        let NdotSum = NdotL + signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        let planar = sum - unit * NdotSum;
        let planar2 = dot(planar, planar);
        let spread = planar2 + alpha2 * (NdotSum * NdotSum);
        let facing = select(0.0, length2 * length2, 0.0 < NdotSum);
        let numerator = facing * ggx_peak;
        let denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let masked_light = sqrt(alpha2 + alpha2_complement * (NdotL * NdotL));
        let visibility = 2.0 * (NdotL * masked_view + NdotV * masked_light);

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = numerator / (denominator * visibility + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        let c = 1.0 - VdotH;
        let c2 = c * c;
        let weight = c2 * c2 * c;
        let glancing = weight * NdotL;
        let base_facing = NdotL - glancing;
        let tinted = base_facing * (lambert + metallic * specular);
        let white = specular * (base_facing * least_f0 + glancing);
        let direct = color.xyz * tinted + white;

        // output
        light_sum += direct * radiance;
    }

    // occlusion: glTF 2.0, "Additional Textures" (occlusion)
    let occlusion = 1.0 + material.occlusion_strength * (metallic_roughness_texel.x - 1.0);

    // emissive.texel: glTF 2.0, "Textures"
    let emissive_texel = textureSample(emissive_texture, emissive_texture_sampler, v_uv1);

    // emission: glTF 2.0, "Additional Textures" (emissive); KHR_materials_emissive_strength
    let emission = material.emissive_factor_times_emissive_strength * emissive_texel.xyz;

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(NdotV, roughness), 0.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; glTF 2.0,
    let base_facing_2 = 1.0 - split.y;
    let lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    let through = base_facing_2 - lost / 21.0;
    let base_color_complement = 1.0 - color.xyz;
    let bounces = 1.000001 - lost + base_color_complement * (0.95238096 * lost);
    let clear = dielectric * material.refracted;
    let dielectric_bounces = 1.000001 - lost * material.mean_fresnel;
    let base = clear * (through / dielectric_bounces);
    let grey = metallic * split.x;
    let base_white = (least_f0 + metallic) * split.x;
    let base_specular = color.xyz * grey + (least_f0 * split.x + split.y);
    let base_spread = clamp(base_color_complement * (grey - base - metallic * through / bounces) + (base_facing_2 - base_white), vec3f(0.0), vec3f(1.0));
    let indirect = base_specular * textureSampleLevel(environment_specular, environment_specular_sampler, cosines_part * 2.0 * unit - to_eye, roughness * frame.environment_max_lod).xyz + base_spread * textureSampleLevel(environment_irradiance, environment_irradiance_sampler, bent, 0.0).xyz;

    // output
    out_stage.out_color = vec4f(light_sum + indirect * (occlusion * frame.environment_intensity) + emission, 1.0);

    return out_stage;
}
