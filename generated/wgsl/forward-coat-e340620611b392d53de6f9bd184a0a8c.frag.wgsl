// forward-coat-e340620611b392d53de6f9bd184a0a8c
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
    emissive_factor: vec3f,
    metallic_factor: f32,
    base_color_factor: vec3f,
    roughness_factor: f32,
    base_color_complement: vec3f,
    coat_roughness_factor: f32,
    metal_repeated: vec3f,
    coat_normal_scale: f32,
    F0: vec3f,
    coat_factor_times_0_96: f32,
    coat_factor_times_0_04: f32,
    alpha2: f32,
    alpha2_ratio: f32,
    weight_times_ggx_peak: f32,
    coat_alpha2: f32,
    coat_alpha2_ratio: f32,
    coat_weight_times_ggx_peak: f32,
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
@group(1) @binding(2) var normal_texture: texture_2d<f32>;
@group(1) @binding(3) var normal_texture_sampler: sampler;
@group(1) @binding(4) var coat_normal_texture: texture_2d<f32>;
@group(1) @binding(5) var coat_normal_texture_sampler: sampler;

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
    let T = value_in_plane_u * inverseSqrt(value_in_plane_u.x * value_in_plane_u.x + normal_frame_part_2);
    let normal_frame_part_3 = value_in_plane_v.y * value_in_plane_v.y + (value_in_plane_v.z * value_in_plane_v.z + 1e-32);
    let B = value_in_plane_v * inverseSqrt(value_in_plane_v.x * value_in_plane_v.x + normal_frame_part_3);

    // normal.texel: glTF 2.0, "Textures"
    let texel = textureSample(normal_texture, normal_texture_sampler, v_uv0);

    // base.normal_map: glTF 2.0, "Additional Textures" (normal)
    let xy = texel.xy * 2.0 - 1.0;
    let z = max(texel.z * 2.0 - 1.0, 1e-14);
    let bent = T * xy.x + B * xy.y + N * z;
    let normal_map_part = bent.y * bent.y + (bent.z * bent.z + 1e-32);
    let unit = bent * inverseSqrt(bent.x * bent.x + normal_map_part);

    // coat_normal.texel: glTF 2.0, "Textures"
    let coat_normal_texel = textureSample(coat_normal_texture, coat_normal_texture_sampler, v_uv0);

    // coat.normal_map: glTF 2.0, "Additional Textures" (normal)
    let coat_xy = coat_normal_texel.xy * 2.0 - 1.0;
    let coat_z = max(coat_normal_texel.z * 2.0 - 1.0, 1e-14);
    let coat_bent = T * (coat_xy.x * material.coat_normal_scale) + B * (coat_xy.y * material.coat_normal_scale) + N * coat_z;
    let coat_normal_map_part = coat_bent.y * coat_bent.y + (coat_bent.z * coat_bent.z + 1e-32);
    let coat_unit = coat_bent * inverseSqrt(coat_bent.x * coat_bent.x + coat_normal_map_part);

    // coat.view_cosine: KHR_materials_clearcoat, "Layering"
    let view_cosine_part = dot(coat_unit, to_eye);
    let signed_NdotV = view_cosine_part * view_part_2;
    let view_cosine = abs(view_cosine_part) * view_part_2;

    // coat.fresnel: glTF 2.0, Appendix B, "Fresnel"; Schlick 1994
    let c = 1.0 - view_cosine;
    let c2 = c * c;

    // emission.transmission: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    let reflectance = material.coat_factor_times_0_04 + material.coat_factor_times_0_96 * (c2 * c2 * abs(c));
    let transmission_part = clamp(1.0 - reflectance, 0.0, 1.0);

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    let cosines_part = dot(unit, to_eye);
    let base_signed_NdotV = cosines_part * view_part_2;
    let NdotV = abs(cosines_part) * view_part_2;

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let masked_view = sqrt(material.alpha2_ratio + NdotV * NdotV);

    // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    let coat_masked_view = sqrt(material.coat_alpha2_ratio + view_cosine * view_cosine);

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
        let NdotL = clamp(dot(unit, L), 0.0, 1.0);
        let NdotSum = NdotL + base_signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        let planar = sum - unit * NdotSum;
        let planar2 = dot(planar, planar);
        let spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        let length22 = length2 * length2;
        let facing = select(0.0, length22, 0.0 < NdotSum);
        let denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        let base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // coat.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        let coat_NdotL = clamp(dot(coat_unit, L), 0.0, 1.0);
        let coat_NdotSum = coat_NdotL + signed_NdotV;

        // coat.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        let coat_planar = sum - coat_unit * coat_NdotSum;
        let coat_planar2 = dot(coat_planar, coat_planar);
        let coat_spread = coat_planar2 + material.coat_alpha2 * (coat_NdotSum * coat_NdotSum);
        let coat_facing = select(0.0, length22, 0.0 < coat_NdotSum);
        let coat_denominator = coat_spread * coat_spread;

        // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        let coat_masked_light = sqrt(material.coat_alpha2_ratio + coat_NdotL * coat_NdotL);
        let coat_sum = coat_NdotL * coat_masked_view + view_cosine * coat_masked_light;

        // coat.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        let coat_specular = material.coat_weight_times_ggx_peak * coat_facing / (coat_denominator * coat_sum + 3e-32);

        // coat.transmission_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        let reflected = coat_NdotL * reflectance;
        let transmitted = NdotL * transmission_part;

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

    // emission.coated: KHR_materials_clearcoat, "Emission"; EXT_materials_clearcoat_color, "Implementation"
    let coated = material.emissive_factor * transmission_part;

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(NdotV, material.roughness_factor), 0.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    let base_facing_2 = 1.0 - split.y;
    let lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    let through = base_facing_2 - lost / 21.0;
    let bounces = material.inverse_metallic - material.metal_repeated * lost;
    let dielectric_bounces = material.inverse_clear - material.dielectric_repeated * lost;
    let base_specular = material.F0 * split.x + split.y;
    let grey = material.metallic_factor * split.x - through / dielectric_bounces;
    let base_spread = clamp(material.base_color_complement * (grey - through / bounces) + (base_facing_2 - material.white_F0 * split.x), vec3f(0.0), vec3f(1.0));
    let indirect = base_specular * textureSampleLevel(environment_specular, environment_specular_sampler, cosines_part * 2.0 * unit - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * textureSampleLevel(environment_irradiance, environment_irradiance_sampler, bent, 0.0).xyz;

    // coat.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    let coat_split = textureSampleLevel(environment_dfg, environment_dfg_sampler, vec2f(view_cosine, material.coat_roughness_factor), 0.0);

    // output
    let output_part = textureSampleLevel(environment_specular, environment_specular_sampler, view_cosine_part * 2.0 * coat_unit - to_eye, material.coat_roughness_factor * frame.environment_max_lod).xyz * ((coat_split.x + coat_split.y) * reflectance * frame.environment_intensity);

    out_stage.out_color = vec4f(light_sum + (indirect * (transmission_part * frame.environment_intensity) + output_part) + coated, 1.0);

    return out_stage;
}
