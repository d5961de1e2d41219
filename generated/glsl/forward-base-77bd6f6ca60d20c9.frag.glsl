#version 450
// forward-base-72bc2a6652d55887
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
    vec4 base_color_factor;
    float metallic_factor;
    float roughness_factor;
    float base_reflectance;
    float alpha2;
    float ratio;
    float base_specular;
} material;

layout(set = 0, binding = 2) uniform samplerCube environment_specular;
layout(set = 0, binding = 3) uniform samplerCube environment_irradiance;
layout(set = 0, binding = 4) uniform sampler2D environment_dfg;

layout(location = 0) in vec3 v_position;
layout(location = 1) in vec3 v_normal;
layout(location = 2) in vec4 v_COLOR_0;

layout(location = 0) out vec4 out_color;

void main() {
    // color0
    vec4 color0 = clamp(v_COLOR_0, 0.0, 1.0);

    // view: glTF 2.0, Appendix B, "Overview"
    vec3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float view_part_2 = inversesqrt(to_eye.x * to_eye.x + view_part);
    vec3 V = to_eye * view_part_2;

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    vec4 color = material.base_color_factor * color0;

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    vec3 N = v_normal * inversesqrt(v_normal.x * v_normal.x + unit_part);

    // base.reflectance: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
    vec3 F0 = mix(vec3(0.04), color.xyz, material.metallic_factor);
    vec3 diffuse = color.xyz * material.base_reflectance;

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float cosines_part = dot(N, to_eye);
    float NV = cosines_part * view_part_2;
    float NdotV = abs(NV);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.ratio + NdotV * NdotV);

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
        float NdotSum = NdotL + NV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        vec3 planar = sum - N * NdotSum;
        float planar2 = dot(planar, planar);
        float spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        float facing = 0.0 < NdotSum ? length2 * length2 : 0.0;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float masked_light = sqrt(material.ratio + NdotL * NdotL);
        float base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = material.base_specular * facing / (denominator * base_sum + 1e-30);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float c = 1.0 - VdotH;
        float c2 = c * c;
        float weight = c2 * c2 * c;
        float glancing = weight * NdotL;
        float direct_part = NdotL - glancing;
        vec3 direct = diffuse * (0.3055775 * direct_part) + F0 * (specular * direct_part) + glancing * specular;

        // output
        light_sum += direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    vec4 split = textureLod(environment_dfg, vec2(NdotV, material.roughness_factor), 0.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    vec3 single = F0 * split.x + split.y;
    float albedo = clamp(split.x + split.y, 0.25, 1.0);
    float indirect_part = 1.0 - albedo;
    vec3 base_all = single / (1.0 - (F0 * (0.95238096 * indirect_part) + 0.04761905 * indirect_part));
    vec3 base_spread = clamp(base_all * (1.0 - diffuse) + (diffuse - single), 0.0, 1.0);
    vec3 indirect = single * textureLod(environment_specular, cosines_part * 2.0 * N - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * textureLod(environment_irradiance, v_normal, 0.0).xyz;

    // output
    out_color = vec4(light_sum + indirect * frame.environment_intensity, color.w);
}
