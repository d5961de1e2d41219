#version 300 es
// forward-base-90635bb95589462632851765a0f686df
// Lacquer 0.2.0, template forward

precision highp float;
precision highp int;
precision highp sampler2D;
precision highp samplerCube;

layout(std140) uniform Frame {
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

layout(std140) uniform Lights {
    Light lights[16];
};

layout(std140) uniform Material {
    vec4 base_color_factor;
    float metallic_factor;
    float roughness_factor;
    float alpha2;
    float alpha2_ratio;
    float weight_times_ggx_peak;
    float lambert;
    float least_f0;
    float clear;
    float least_f0_plus_metallic_factor;
} material;

uniform samplerCube environment_specular;
uniform samplerCube environment_irradiance;
uniform sampler2D environment_dfg;

in vec3 v_position;
in vec3 v_normal;
in vec4 v_COLOR_0;

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

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float cosines_part = dot(N, to_eye);
    float signed_NdotV = cosines_part * view_part_2;
    float NdotV = abs(cosines_part) * view_part_2;

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.alpha2_ratio + NdotV * NdotV);

    // output
    vec3 light_sum = vec3(0.0);
    for (int i = 0; i < min(frame.light_count, 16); ++i) {
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

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float c = 1.0 - VdotH;
        float c2 = c * c;
        float weight = c2 * c2 * c;
        float glancing = weight * NdotL;
        float base_facing = NdotL - glancing;
        float tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        float white = specular * (base_facing * material.least_f0 + glancing);
        vec3 direct = color.xyz * tinted + white;

        // output
        light_sum += direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    vec4 split = textureLod(environment_dfg, vec2(NdotV, material.roughness_factor), 0.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; glTF 2.0,
    float base_facing_2 = 1.0 - split.y;
    float lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    float through = base_facing_2 - lost / 21.0;
    vec3 base_color_complement = 1.0 - color.xyz;
    vec3 bounces = 1.000001 - lost + base_color_complement * (0.95238096 * lost);
    float dielectric_bounces = 1.000001 - lost * 0.08571429;
    float base = material.clear * (through / dielectric_bounces);
    float grey = material.metallic_factor * split.x;
    float base_white = material.least_f0_plus_metallic_factor * split.x;
    vec3 base_specular = color.xyz * grey + (material.least_f0 * split.x + split.y);
    vec3 base_spread = clamp(base_color_complement * (grey - base - material.metallic_factor * through / bounces) + (base_facing_2 - base_white), 0.0, 1.0);
    vec3 indirect = base_specular * textureLod(environment_specular, cosines_part * 2.0 * N - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * textureLod(environment_irradiance, v_normal, 0.0).xyz;

    // output
    out_color = vec4(light_sum + indirect * frame.environment_intensity, 1.0);
}
