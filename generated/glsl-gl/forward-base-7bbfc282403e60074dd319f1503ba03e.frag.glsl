#version 450
// forward-base-7bbfc282403e60074dd319f1503ba03e
// Lacquer 0.2.0, template forward

layout(std140, binding = 0) uniform Frame {
    mat4 view_projection;
    vec3 camera_position;
    float environment_intensity;
    float environment_max_lod;
    int light_count;
} frame;

struct Light {
    vec3 position;
    float positional;
    vec3 radiance;
    float inverse_range_4;
    vec3 direction;
    float spot_scale;
    float spot_offset;
};

layout(std140, binding = 1) uniform Lights {
    Light lights[16];
};

layout(std140, binding = 2) uniform Material {
    vec4 base_color_factor;
    vec3 emissive_factor_times_emissive_strength;
    float metallic_factor;
    float roughness_factor;
    float f0;
    float occlusion_strength;
    float refracted;
    float refracted_over_3_14;
    float mean_fresnel;
} material;

layout(binding = 0) uniform samplerCube environment_specular;
layout(binding = 1) uniform samplerCube environment_irradiance;
layout(binding = 2) uniform sampler2D environment_dfg;
layout(binding = 3) uniform sampler2D base_color_texture;
layout(binding = 4) uniform sampler2D normal_texture;
layout(binding = 5) uniform sampler2D metallic_roughness_texture;
layout(binding = 6) uniform sampler2D emissive_texture;

layout(location = 0) in vec3 v_position;
layout(location = 1) in vec3 v_normal;
layout(location = 2) in vec2 v_uv0;
layout(location = 3) in vec2 v_uv1;
layout(location = 4) in vec4 v_COLOR_0;

layout(location = 0) out vec4 out_color;

void main() {
    // color0
    vec4 color0 = clamp(v_COLOR_0, 0.0, 1.0);

    // view: glTF 2.0, Appendix B, "Overview"
    vec3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float view_part_2 = inversesqrt(to_eye.x * to_eye.x + view_part);
    vec3 V = to_eye * view_part_2;

    // base_color.texel: glTF 2.0, "Textures"
    vec4 texel = texture(base_color_texture, v_uv0);

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    vec4 color = material.base_color_factor * texel * color0;

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    vec3 N = v_normal * inversesqrt(v_normal.x * v_normal.x + unit_part);

    // normal.frame: glTF 2.0, "Meshes" (tangents where none are given)
    vec3 px = dFdx(v_position);
    vec3 py = dFdy(v_position);
    vec2 uvx = dFdx(v_uv0);
    vec2 uvy = dFdy(v_uv0);
    float mirrored = uvx.x * uvy.y < uvy.x * uvx.y ? -1.0 : 1.0;
    vec3 frame_part = px * uvy.y - py * uvx.y;
    vec3 along_u = frame_part * mirrored;
    vec3 normal_frame_part = px * uvy.x - py * uvx.x;
    vec3 along_v = normal_frame_part * mirrored;
    vec3 value_in_plane_u = along_u - N * (dot(N, frame_part) * mirrored);
    vec3 value_in_plane_v = along_v - N * (dot(N, normal_frame_part) * mirrored);
    float normal_frame_part_2 = value_in_plane_u.y * value_in_plane_u.y + (value_in_plane_u.z * value_in_plane_u.z + 1e-32);
    float normal_frame_part_3 = value_in_plane_v.y * value_in_plane_v.y + (value_in_plane_v.z * value_in_plane_v.z + 1e-32);

    // normal.texel: glTF 2.0, "Textures"
    vec4 normal_texel = texture(normal_texture, v_uv0);

    // base.normal_map: glTF 2.0, "Additional Textures" (normal)
    vec2 xy = normal_texel.xy * 2.0 - 1.0;
    float z = max(normal_texel.z * 2.0 - 1.0, 1e-14);
    vec3 normal_map_part = value_in_plane_u * (inversesqrt(value_in_plane_u.x * value_in_plane_u.x + normal_frame_part_2) * xy.x);
    vec3 base_normal_map_part = value_in_plane_v * (inversesqrt(value_in_plane_v.x * value_in_plane_v.x + normal_frame_part_3) * xy.y);
    vec3 bent = normal_map_part + base_normal_map_part + N * z;
    float base_normal_map_part_2 = bent.y * bent.y + (bent.z * bent.z + 1e-32);
    vec3 unit = bent * inversesqrt(bent.x * bent.x + base_normal_map_part_2);

    // metallic_roughness.texel: glTF 2.0, "Textures"
    vec4 metallic_roughness_texel = texture(metallic_roughness_texture, v_uv0);

    // base.metallic_roughness: glTF 2.0, "Metallic-Roughness Material"
    float metallic = material.metallic_factor * metallic_roughness_texel.z;
    float roughness = material.roughness_factor * metallic_roughness_texel.y;

    // base.alpha: glTF 2.0, Appendix B, "Microfacet Surfaces" and "Specular BRDF" (note on alpha = 0)
    float alpha = max(roughness * roughness, 0.001);

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float cosines_part = dot(unit, to_eye);
    float signed_NdotV = cosines_part * view_part_2;
    float NdotV = abs(cosines_part) * view_part_2;

    // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
    float alpha2 = alpha * alpha;
    float ggx_peak = alpha2 / 3.1415927;

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float alpha2_complement = 1.0 - alpha2;
    float masked_view = sqrt(alpha2 + alpha2_complement * (NdotV * NdotV));

    // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
    float dielectric = 1.0 - metallic;
    float lambert = dielectric * material.refracted_over_3_14;
    float least_f0 = material.f0 * dielectric;

    // output
    vec3 light_sum = vec3(0.0);
    for (int i = 0; i < frame.light_count; ++i) {
        // light_sample: KHR_lights_punctual, "Range Property" and "Inner and Outer Cone Angles"
        vec3 to_light = lights[i].position - v_position * lights[i].positional;
        float distance2 = max(dot(to_light, to_light), 1e-12);
        float inverse_distance = mix(1.0, inversesqrt(distance2), lights[i].positional);
        vec3 L = to_light * inverse_distance;
        float window = clamp(1.0 - distance2 * (distance2 * lights[i].inverse_range_4), 0.0, 1.0);
        float cone = clamp(lights[i].spot_offset - dot(to_light, lights[i].direction) * inverse_distance * lights[i].spot_scale, 0.0, 1.0);
        vec3 radiance = lights[i].radiance * (window * (cone * cone) * (inverse_distance * inverse_distance));

        // half: glTF 2.0, Appendix B, "Overview"
        vec3 sum = V + L;
        float length2 = dot(sum, sum);
        float VdotH = clamp(0.5 * sqrt(length2), 0.0, 1.0);

        // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        float NdotL = clamp(dot(unit, to_light) * inverse_distance, 0.0, 1.0);
        float NdotSum = NdotL + signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        vec3 planar = sum - unit * NdotSum;
        float planar2 = dot(planar, planar);
        float spread = planar2 + alpha2 * (NdotSum * NdotSum);
        float facing = 0.0 < NdotSum ? length2 * length2 : 0.0;
        float numerator = facing * ggx_peak;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float masked_light = sqrt(alpha2 + alpha2_complement * (NdotL * NdotL));
        float visibility = 2.0 * (NdotL * masked_view + NdotV * masked_light);

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = numerator / (denominator * visibility + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float c = 1.0 - VdotH;
        float c2 = c * c;
        float weight = c2 * c2 * c;
        float glancing = weight * NdotL;
        float base_facing = NdotL - glancing;
        float tinted = base_facing * (lambert + metallic * specular);
        float white = specular * (base_facing * least_f0 + glancing);
        vec3 direct = color.xyz * tinted + white;

        // output
        light_sum += direct * radiance;
    }

    // occlusion: glTF 2.0, "Additional Textures" (occlusion)
    float occlusion = 1.0 + material.occlusion_strength * (metallic_roughness_texel.x - 1.0);

    // emissive.texel: glTF 2.0, "Textures"
    vec4 emissive_texel = texture(emissive_texture, v_uv1);

    // emission: glTF 2.0, "Additional Textures" (emissive); KHR_materials_emissive_strength
    vec3 emission = material.emissive_factor_times_emissive_strength * emissive_texel.xyz;

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    vec4 split = textureLod(environment_dfg, vec2(NdotV, roughness), 0.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; glTF 2.0,
    float base_facing_2 = 1.0 - split.y;
    float lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    float through = base_facing_2 - lost / 21.0;
    vec3 base_color_complement = 1.0 - color.xyz;
    vec3 bounces = 1.000001 - lost + base_color_complement * (0.95238096 * lost);
    float clear = dielectric * material.refracted;
    float dielectric_bounces = 1.000001 - lost * material.mean_fresnel;
    float base = clear * (through / dielectric_bounces);
    float grey = metallic * split.x;
    float base_white = (least_f0 + metallic) * split.x;
    vec3 base_specular = color.xyz * grey + (least_f0 * split.x + split.y);
    vec3 base_spread = clamp(base_color_complement * (grey - base - metallic * through / bounces) + (base_facing_2 - base_white), 0.0, 1.0);
    vec3 indirect = base_specular * textureLod(environment_specular, cosines_part * 2.0 * unit - to_eye, roughness * frame.environment_max_lod).xyz + base_spread * textureLod(environment_irradiance, bent, 0.0).xyz;

    // output
    out_color = vec4(light_sum + indirect * (occlusion * frame.environment_intensity) + emission, 1.0);
}
