#version 300 es
// forward-sheen-bf979b296e6ecfeda54534ee7dd834e9
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
    vec3 sheen_color_factor;
    float metallic_factor;
    vec3 base_color_factor;
    float roughness_factor;
    vec3 base_color_complement;
    float cos_anisotropy_rotation;
    vec3 metal_repeated;
    float sin_anisotropy_rotation;
    vec3 F0;
    float sheen_roughness_factor;
    float narrowness2;
    float narrowness2_complement;
    float alpha_b2;
    float ggx_peak;
    float alpha_t2;
    float alpha2_difference;
    float alpha_t2_complement;
    float exponent;
    float inverse_a;
    float b;
    float c;
    float d;
    float middle;
    float e_minus_middle;
    float peak_times_0_25;
    float lambert;
    float least_f0;
    float most;
    float straight2_squared;
    float inverse_metallic;
    float inverse_clear;
    float dielectric_repeated;
    float white_F0;
} material;

uniform samplerCube environment_specular;
uniform samplerCube environment_irradiance;
uniform sampler2D environment_dfg;
uniform sampler2D environment_sheen;

in vec3 v_position;
in vec3 v_normal;
in vec4 v_tangent;

layout(location = 0) out vec4 out_color;

void main() {
    // view: glTF 2.0, Appendix B, "Overview"
    vec3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    vec3 V = to_eye * inversesqrt(to_eye.x * to_eye.x + view_part);

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    vec3 N = v_normal * inversesqrt(v_normal.x * v_normal.x + unit_part);

    // anisotropy.across: KHR_materials_coat, "Anisotropy"
    vec3 across_part = v_tangent.xyz * material.cos_anisotropy_rotation + cross(N, v_tangent.xyz) * (v_tangent.w * material.sin_anisotropy_rotation);
    vec3 normal_to_both = cross(N, across_part);
    float anisotropy_across_part = normal_to_both.y * normal_to_both.y + (normal_to_both.z * normal_to_both.z + 1e-32);
    vec3 across = normal_to_both * inversesqrt(normal_to_both.x * normal_to_both.x + anisotropy_across_part);

    // base.view_cosine: KHR_materials_clearcoat, "Layering"
    float signed_NdotV = dot(N, V);
    float view_cosine = abs(signed_NdotV);

    // sheen.view: KHR_materials_sheen, "Albedo-scaling technique" (E)
    vec4 reflected = textureLod(environment_sheen, vec2(view_cosine, material.sheen_roughness_factor), 0.0);

    // anisotropy.cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
    float BdotV = dot(across, V);

    // anisotropy.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
    float masked_view2 = material.alpha_t2 - material.alpha2_difference * (BdotV * BdotV) + material.alpha_t2_complement * (view_cosine * view_cosine);
    float masked_view = sqrt(clamp(masked_view2, 0.0, 1.0));

    // sheen.masked_view: KHR_materials_sheen, "Sheen visibility" (lambda_sheen)
    float x = clamp(min(view_cosine, 1.0 - view_cosine), 1e-30, 0.5);
    float above = 1.0 / (material.inverse_a + material.b * exp2(material.c * log2(x))) + (material.d * x + material.e_minus_middle);
    float sheen_masked_view = exp2(material.middle + (view_cosine < 0.5 ? above : -above));

    // sheen.lobe: KHR_materials_sheen, "Sheen visibility"
    float lobe_part = max(view_cosine, 0.0001);
    float sheen_lobe_part = 1.0 + sheen_masked_view;

    // output
    vec3 light_sum = vec3(0.0);
    for (int i = 0; i < min(frame.light_count, 16); ++i) {
        // light_sample: KHR_lights_punctual, "Range Property" and "Inner and Outer Cone Angles"
        vec3 to_light = lights[i].position - v_position * lights[i].positional;
        float distance2 = max(dot(to_light, to_light), 1e-12);
        float inverse_distance = mix(1.0, inversesqrt(distance2), lights[i].positional);
        vec3 L = to_light * inverse_distance;
        float window = clamp(1.0 - distance2 * (distance2 * lights[i].inverse_range_4), 0.0, 1.0);
        float cone = clamp(lights[i].spot_offset - dot(L, lights[i].direction) * lights[i].spot_scale, 0.0, 1.0);
        vec3 radiance = lights[i].radiance * (window * (cone * cone) * (inverse_distance * inverse_distance));

        // half: glTF 2.0, Appendix B, "Overview"
        vec3 sum = V + L;
        float length2 = dot(sum, sum);
        float VdotH = clamp(0.5 * sqrt(length2), 0.0, 1.0);

        // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        float signed_NdotL = dot(N, L);
        float NdotL = clamp(signed_NdotL, 0.0, 1.0);
        float NdotSum = NdotL + signed_NdotV;

        // anisotropy.cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
        float BdotL = dot(across, L);

        // anisotropy.distribution: KHR_materials_coat, "Anisotropy" (D); Burley 2012
        vec3 planar = sum - N * NdotSum;
        float planar2 = dot(planar, planar);
        float BdotSum = BdotV + BdotL;
        float NdotSum2 = NdotSum * NdotSum;
        float spread = material.narrowness2_complement * (BdotSum * BdotSum) + material.narrowness2 * planar2 + material.alpha_b2 * NdotSum2;
        float facing = 0.0 < NdotSum ? length2 * length2 : 0.0;
        float numerator = facing * material.ggx_peak;
        float denominator = spread * spread;

        // anisotropy.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
        float masked_light2 = material.alpha_t2 - material.alpha2_difference * (BdotL * BdotL) + material.alpha_t2_complement * (NdotL * NdotL);
        float masked_light = sqrt(clamp(masked_light2, 0.0, 1.0));
        float visibility = 2.0 * (NdotL * masked_view + view_cosine * masked_light);

        // anisotropy.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = numerator / (denominator * visibility + 3e-32);

        // sheen.distribution: KHR_materials_sheen, "Sheen distribution"; Conty and Kulla 2017
        float sine2 = planar2 / max(planar2 + NdotSum2, 1e-12);
        float share = exp2(log2(max(sine2, 1e-30)) * material.exponent);

        // sheen.light_cosine: KHR_materials_coat, "Darkening Control"
        float light_cosine = abs(signed_NdotL);

        // sheen.masked_light: KHR_materials_sheen, "Sheen visibility" (lambda_sheen)
        float sheen_x = clamp(min(light_cosine, 1.0 - light_cosine), 1e-30, 0.5);
        float sheen_above = 1.0 / (material.inverse_a + material.b * exp2(material.c * log2(sheen_x))) + (material.d * sheen_x + material.e_minus_middle);
        float sheen_masked_light = exp2(material.middle + (light_cosine < 0.5 ? sheen_above : -sheen_above));

        // sheen.light: KHR_materials_sheen, "Albedo-scaling technique" (E)
        vec4 sheen_reflected = textureLod(environment_sheen, vec2(light_cosine, material.sheen_roughness_factor), 0.0);

        // sheen.lobe: KHR_materials_sheen, "Sheen visibility"
        float cosines = lobe_part * max(light_cosine, 0.0001);
        float kept = reflected.y * sheen_reflected.y;
        float lobe = material.peak_times_0_25 * share * kept / (cosines * (sheen_lobe_part + sheen_masked_light));

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float c = 1.0 - VdotH;
        float c2 = c * c;
        float weight = c2 * c2 * c;
        float glancing = weight * NdotL;
        float base_facing = NdotL - glancing;
        float tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        float white = specular * (base_facing * material.least_f0 + glancing);

        // sheen.direct: KHR_materials_sheen, "Albedo-scaling technique"
        float direct_part = 1.0 - material.most * max(reflected.x, sheen_reflected.x);
        vec3 direct = material.base_color_factor * (tinted * direct_part) + white * direct_part + material.sheen_color_factor * (lobe * NdotL);

        // output
        light_sum += direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    vec4 split = textureLod(environment_dfg, vec2(view_cosine, material.roughness_factor), 0.0);

    // anisotropy.bent_normal: McAuley 2015, "Rendering the World of Far Cry 4"; as in the Khronos sample viewer's anisotropy
    vec3 towards = V - across * BdotV;
    vec3 bent_normal = mix(towards, N, material.straight2_squared);

    // anisotropy.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    vec3 reflection = bent_normal * (2.0 * dot(bent_normal, V)) - V * dot(bent_normal, bent_normal);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    float base_facing_2 = 1.0 - split.y;
    float lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    float through = base_facing_2 - lost / 21.0;
    vec3 bounces = material.inverse_metallic - material.metal_repeated * lost;
    float dielectric_bounces = material.inverse_clear - material.dielectric_repeated * lost;
    vec3 base_specular = material.F0 * split.x + split.y;
    float grey = material.metallic_factor * split.x - through / dielectric_bounces;
    vec3 base_spread = clamp(material.base_color_complement * (grey - through / bounces) + (base_facing_2 - material.white_F0 * split.x), 0.0, 1.0);
    vec3 indirect = base_specular * textureLod(environment_specular, reflection, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * textureLod(environment_irradiance, v_normal, 0.0).xyz;

    // sheen.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    vec3 R = 2.0 * signed_NdotV * N - V;

    // sheen.indirect: KHR_materials_sheen, "Albedo-scaling technique"
    vec3 sheen_indirect = indirect * (1.0 - material.most * reflected.x) + textureLod(environment_specular, R, material.sheen_roughness_factor * frame.environment_max_lod).xyz * (material.sheen_color_factor * reflected.x);

    // output
    out_color = vec4(light_sum + sheen_indirect * frame.environment_intensity, 1.0);
}
