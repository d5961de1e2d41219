#version 450
// forward-base-4434d14f4aa0951513c2a5de2d73e946
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

layout(std140, set = 1, binding = 0) uniform Material {
    vec3 base_color_factor;
    float roughness_factor;
    vec3 color;
    float alpha2;
    vec3 F0;
    float alpha2_ratio;
    vec3 metal_repeated;
    float weight_times_ggx_peak;
    float diffuse_roughness_factor;
    float rough_body;
    float rough_body_2;
    float rough_body_3;
    float dielectric;
    float mixed_F90;
    float under_facing;
    float inverse_dielectric_times_0_0857;
    float first;
    float metal_first;
} material;

layout(set = 0, binding = 2) uniform samplerCube environment_specular;
layout(set = 0, binding = 3) uniform samplerCube environment_irradiance;
layout(set = 0, binding = 4) uniform sampler2D environment_dfg;

layout(location = 0) in vec3 v_position;
layout(location = 1) in vec3 v_normal;

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

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float cosines_part = dot(N, to_eye);
    float signed_NdotV = cosines_part * view_part_2;
    float NdotV = abs(cosines_part) * view_part_2;

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.alpha2_ratio + NdotV * NdotV);

    // rough.body: Portsmouth, Kutz and Hill 2024, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", section 3
    float c = max(1.0 - NdotV, 0.0);
    float grazing = c * (0.05710853 + c * (0.49188188 + c * (0.071443 * c - 0.33218145)));
    float once = clamp(material.rough_body + material.rough_body_2 * grazing, 0.6, 1.0);
    float value_out_lost = 1.0 - once;

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
        float NdotL = clamp(dot(N, to_light) * inverse_distance, 0.0, 1.0);
        float NdotSum = NdotL + signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        vec3 planar = sum - N * NdotSum;
        float planar2 = dot(planar, planar);
        float spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        float facing = 0.0 < NdotSum ? length2 * length2 : 0.0;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        float base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // rough.body: Portsmouth, Kutz and Hill 2024, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", section 3
        float LdotV = 0.5 * length2 - 1.0;
        float s = LdotV - NdotL * NdotV;
        float stretched = 0.0 < s ? s / max(max(NdotL, NdotV), 1e-7) : s;
        float first = max(1.0 + material.diffuse_roughness_factor * stretched, 0.0) * material.rough_body;
        float rough_c = 1.0 - NdotL;
        float rough_grazing = rough_c * (0.05710853 + rough_c * (0.49188188 + rough_c * (0.071443 * rough_c - 0.33218145)));
        float value_in_lost = 1.0 - clamp(material.rough_body + material.rough_body_2 * rough_grazing, 0.6, 1.0);
        float exchanged = value_out_lost * value_in_lost * material.rough_body_3;
        vec3 body = (material.base_color_factor * first + material.color * exchanged) / 3.1415927;

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        float base_c = 1.0 - VdotH;
        float c2 = base_c * base_c;
        float weight = c2 * c2 * base_c;
        float glancing = weight * NdotL;
        float base_facing = NdotL - glancing;
        float refracted = material.under_facing * base_facing;
        vec3 direct = material.F0 * (base_facing * specular) + material.mixed_F90 * glancing * specular + body * refracted;

        // output
        light_sum += direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    vec4 split = textureLod(environment_dfg, vec2(NdotV, material.roughness_factor), 0.0);

    // base.irradiance: glTF 2.0, Appendix B, "Diffuse BRDF"
    vec3 mean = textureLod(environment_irradiance, v_normal, 0.0).xyz;

    // rough.albedo: Portsmouth, Kutz and Hill 2024, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", section 3
    vec3 albedo = clamp(material.base_color_factor * once + material.color * value_out_lost, 0.0, 1.0);

    // rough.indirect: glTF 2.0, Appendix B, "Diffuse BRDF"
    vec3 indirect = albedo * mean;

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; glTF 2.0,
    float lost = clamp(1.0 - split.y - split.x, 0.0, 1.0);
    vec3 metal_bounces = material.metal_first - material.metal_repeated * lost;
    float indirect_part = 0.04 * split.x + split.y;
    vec3 base_all = indirect_part / (material.first - material.inverse_dielectric_times_0_0857 * lost) + (material.base_color_factor * split.x + split.y) / metal_bounces;
    vec3 base_once = material.F0 * split.x + material.mixed_F90 * split.y;
    float most_bounces = 1.000001 - 0.08571429 * lost;
    float under = material.dielectric * (1.0 - clamp(indirect_part / most_bounces, 0.0, 1.0));
    vec3 base_indirect_part = base_once * textureLod(environment_specular, cosines_part * 2.0 * N - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + clamp(base_all - base_once, 0.0, 1.0) * mean;
    vec3 base_indirect = base_indirect_part + indirect * under;

    // output
    out_color = vec4(light_sum + base_indirect * frame.environment_intensity, 1.0);
}
