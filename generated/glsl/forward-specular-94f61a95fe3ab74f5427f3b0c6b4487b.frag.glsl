#version 450
// forward-specular-94f61a95fe3ab74f5427f3b0c6b4487b
// Lacquer 0.2.0, template forward

layout(std140, set = 0, binding = 0) uniform Frame {
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

layout(std140, set = 0, binding = 1) uniform Lights {
    Light lights[16];
};

layout(std140, set = 0, binding = 7) uniform SeeThrough {
    vec4 scene_u;
    vec4 scene_v;
    vec4 scene_w;
    float scene_max_lod;
} see_through;

layout(std140, set = 1, binding = 0) uniform Material {
    vec3 F0;
    float metallic_factor;
    vec3 base_color_factor;
    float roughness_factor;
    vec3 body;
    float specular_factor;
    vec3 mean_fresnel;
    float transmission_factor;
    vec3 metal_mean_fresnel;
    float most_F0;
    float specular_factor_minus_most_F0;
    float one_minus_most_F0;
    float one_minus_specular_factor;
} material;

layout(set = 0, binding = 2) uniform samplerCube environment_specular;
layout(set = 0, binding = 3) uniform samplerCube environment_irradiance;
layout(set = 0, binding = 4) uniform sampler2D environment_dfg;
layout(set = 0, binding = 8) uniform sampler2D scene_behind;
layout(set = 1, binding = 1) uniform sampler2D metallic_roughness_texture;

layout(location = 0) in vec3 v_position;
layout(location = 1) in vec3 v_normal;
layout(location = 2) in vec2 v_uv0;

layout(location = 0) out vec4 out_color;

void main() {
    // view: glTF 2.0, Appendix B, "Overview"
    vec3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float view_part_2 = inversesqrt(to_eye.x * to_eye.x + view_part);
    vec3 V = to_eye * view_part_2;

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    vec3 N = v_normal * inversesqrt(v_normal.x * v_normal.x + unit_part);

    // metallic_roughness.texel: glTF 2.0, "Textures"
    vec4 texel = texture(metallic_roughness_texture, v_uv0);

    // base.metallic_roughness: glTF 2.0, "Metallic-Roughness Material"
    float metallic = material.metallic_factor * texel.z;
    float roughness = material.roughness_factor * texel.y;

    // base.alpha: glTF 2.0, Appendix B, "Microfacet Surfaces" and "Specular BRDF" (note on alpha = 0)
    float alpha = max(roughness * roughness, 0.001);

    // clear.textured: KHR_materials_transmission, "Properties"
    float textured = material.transmission_factor * texel.x;

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float cosines_part = dot(N, to_eye);
    float signed_NdotV = cosines_part * view_part_2;
    float NdotV = abs(cosines_part) * view_part_2;

    // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
    float alpha2 = alpha * alpha;
    float ggx_peak = alpha2 / 3.1415927;

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float alpha2_complement = 1.0 - alpha2;
    float masked_view = sqrt(alpha2 + alpha2_complement * (NdotV * NdotV));

    // behind.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float behind_masked_view = NdotV + masked_view;

    // clear.front: KHR_materials_transmission, "Transmission BTDF"; KHR_materials_scatter, "Thin-Walled Mode"
    float front_part = 1.0 - textured;

    // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
    float dielectric = 1.0 - metallic;
    float mixed_F90 = material.specular_factor * dielectric + metallic;
    float under_facing = dielectric * material.one_minus_most_F0;
    float under_glancing = dielectric * material.one_minus_specular_factor;

    // clear.tint: KHR_materials_transmission, "Tinting"; KHR_materials_scatter, "Thin-Walled Mode"
    vec3 tint = material.base_color_factor * textured;

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
        float signed_NdotL = dot(N, to_light) * inverse_distance;
        float NdotL = clamp(signed_NdotL, 0.0, 1.0);

        // behind.cosines: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        float behind_NdotL = clamp(-signed_NdotL, 0.0, 1.0);
        float NdotSum = behind_NdotL + signed_NdotV;
        float straight = signed_NdotL + signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        vec3 planar = sum - N * straight;
        float planar2 = dot(planar, planar);
        float spread = planar2 + alpha2 * (straight * straight);
        float facing = 0.0 < straight ? length2 * length2 : 0.0;
        float numerator = facing * ggx_peak;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float masked_light = sqrt(alpha2 + alpha2_complement * (NdotL * NdotL));
        float visibility = 2.0 * (NdotL * masked_view + NdotV * masked_light);

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = numerator / (denominator * visibility + 3e-32);

        // behind.half: KHR_materials_transmission, "Implementation Notes" (the half vector of transmission)
        float NdotSum2 = NdotSum * NdotSum;
        float behind_length2 = planar2 + NdotSum2;
        float behind_VdotH = clamp(0.5 * sqrt(behind_length2), 0.0, 1.0);

        // behind.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        float c = 1.0 - behind_VdotH;
        float c2 = c * c;
        float weight = c2 * c2 * c;
        float most = clamp(material.most_F0 + material.specular_factor_minus_most_F0 * weight, 0.0, 1.0);

        // behind.distribution: KHR_materials_transmission, "Implementation Notes" (D_T)
        float behind_spread = planar2 + alpha2 * NdotSum2;
        float behind_facing = 0.0 < NdotSum ? behind_length2 * behind_length2 : 0.0;
        float behind_numerator = behind_facing * ggx_peak;
        float behind_denominator = behind_spread * behind_spread;

        // behind.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float behind_masked_light = behind_NdotL + sqrt(alpha2 + alpha2_complement * (behind_NdotL * behind_NdotL));
        float behind_visibility = behind_masked_view * behind_masked_light;

        // behind.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float behind_specular = behind_numerator / (behind_denominator * behind_visibility + 3e-32);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        float base_c = 1.0 - VdotH;
        float base_c2 = base_c * base_c;
        float base_weight = base_c2 * base_c2 * base_c;
        float glancing = base_weight * NdotL;
        float base_facing = NdotL - glancing;
        float refracted = under_facing * base_facing + under_glancing * glancing;
        vec3 direct_part = material.F0 * (dielectric * base_facing * specular) + material.base_color_factor * (metallic * base_facing * specular) + mixed_F90 * glancing * specular;
        vec3 direct = direct_part + material.body * (front_part * refracted);

        // base.through: KHR_materials_transmission, "Transmission BTDF"; KHR_materials_diffuse_transmission, "Material Structure Updates"
        vec3 through = direct + tint * (behind_specular * (behind_NdotL * (dielectric * (1.0 - most))));

        // output
        light_sum += through * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    vec4 split = textureLod(environment_dfg, vec2(NdotV, roughness), 0.0);

    // dielectric.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    float dielectric_facing = 1.0 - split.y;
    float lost = clamp(dielectric_facing - split.x, 0.0, 1.0);
    float grazing = material.specular_factor * split.y;
    vec3 once = material.F0 * split.x + grazing;
    vec3 bounces = 1.000001 - material.mean_fresnel * lost;
    vec3 dielectric_all = clamp(once / bounces, 0.0, 1.0);
    float dielectric_most = max(max(dielectric_all.x, dielectric_all.y), dielectric_all.z);

    // metal.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    vec3 metal_once = material.base_color_factor * split.x + split.y;
    vec3 metal_bounces = 1.000001 - material.metal_mean_fresnel * lost;
    vec3 metal_all = clamp(metal_once / metal_bounces, 0.0, 1.0);

    // clear.lod: KHR_materials_transmission, "Implementation Notes"; Khronos glTF sample viewer (applyIorToRoughness, log2 of the
    float lod = roughness * see_through.scene_max_lod;

    // clear.scene: KHR_materials_transmission, "Implementation Notes"
    vec4 clear_point = vec4(v_position, 1.0);
    vec2 uv = vec2(dot(see_through.scene_u, clear_point), dot(see_through.scene_v, clear_point)) / max(dot(see_through.scene_w, clear_point), 1e-6);

    // clear.seen: KHR_materials_transmission, "Tinting"
    vec3 seen = tint * textureLod(scene_behind, uv, lod).xyz;

    // base.transmitted: KHR_materials_transmission, "Transmission BTDF"
    float under = dielectric * (1.0 - dielectric_most);
    vec3 transmitted = seen * under;

    // base.irradiance: glTF 2.0, Appendix B, "Diffuse BRDF"
    vec3 mean = textureLod(environment_irradiance, v_normal, 0.0).xyz;

    // base.body_indirect: glTF 2.0, Appendix B, "Diffuse BRDF"
    vec3 body_indirect = material.base_color_factor * mean;

    // base.indirect: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
    vec3 base_once = once * dielectric + metal_once * metallic;
    vec3 base_all = dielectric_all * dielectric + metal_all * metallic;
    vec3 indirect_part = base_once * textureLod(environment_specular, cosines_part * 2.0 * N - to_eye, roughness * frame.environment_max_lod).xyz + max(base_all - base_once, 0.0) * mean;
    vec3 indirect = indirect_part + body_indirect * (front_part * under);

    // output
    out_color = vec4(light_sum + indirect * frame.environment_intensity + transmitted, 1.0);
}
