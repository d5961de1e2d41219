#version 450
// forward-anisotropy-9a06c43bc20bf3f0c7355c8b081d0320
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
    vec3 base_color_factor;
    float metallic_factor;
    vec3 lower_f0;
    float roughness_factor;
    vec3 one_minus_lower_f0;
    float alpha;
    vec3 turn;
    float anisotropy_strength;
    vec3 body;
    float strength;
    vec3 mean_fresnel;
    float inverse_ior2;
    float least_cos2_t;
    float longest;
    float r_squared;
    float F0_complement;
    float film_fresnel;
    float film_fresnel_2;
    float film_fresnel_3;
    float alpha_b2;
    float dielectric;
    float smoothness_times_anisotropy_strength;
} material;

layout(binding = 0) uniform samplerCube environment_specular;
layout(binding = 1) uniform samplerCube environment_irradiance;
layout(binding = 2) uniform sampler2D environment_dfg;
layout(binding = 3) uniform sampler2D anisotropy_texture;

layout(location = 0) in vec3 v_position;
layout(location = 1) in vec3 v_normal;
layout(location = 2) in vec4 v_tangent;
layout(location = 3) in vec2 v_uv0;

layout(location = 0) out vec4 out_color;

void main() {
    // view: glTF 2.0, Appendix B, "Overview"
    vec3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    vec3 V = to_eye * inversesqrt(to_eye.x * to_eye.x + view_part);

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    vec3 N = v_normal * inversesqrt(v_normal.x * v_normal.x + unit_part);

    // anisotropy.texel: glTF 2.0, "Textures"
    vec4 texel = texture(anisotropy_texture, v_uv0);

    // anisotropy.decoded: KHR_materials_coat, "Anisotropy" (dequantization)
    vec2 d = texel.xy * 2.0 - 1.0;
    float length2 = dot(d, d);
    vec2 unit = d * inversesqrt(length2 + 1e-32);
    vec2 direction = 1e-12 < length2 ? unit : vec2(1.0, 0.0);

    // anisotropy.textured: KHR_materials_coat, "Parameter Combinations"
    float textured = texel.z * material.anisotropy_strength;

    // anisotropy.across: KHR_materials_coat, "Anisotropy"
    vec3 across_part = v_tangent.xyz * direction.x + cross(N, v_tangent.xyz) * (v_tangent.w * direction.y);
    vec3 normal_to_both = cross(N, across_part);
    float anisotropy_across_part = normal_to_both.y * normal_to_both.y + (normal_to_both.z * normal_to_both.z + 1e-32);
    vec3 across = normal_to_both * inversesqrt(normal_to_both.x * normal_to_both.x + anisotropy_across_part);

    // anisotropy.alpha: KHR_materials_coat, "Anisotropy" (directionAlphaRoughness)
    float alpha_t = mix(material.alpha, 1.0, textured * textured);

    // base.view_cosine: KHR_materials_clearcoat, "Layering"
    float signed_NdotV = dot(N, V);
    float view_cosine = abs(signed_NdotV);

    // film.fresnel: KHR_materials_iridescence, "Iridescence Fresnel"; Belcour and Barla 2017
    float view_cosine2 = view_cosine * view_cosine;
    float cos_t = sqrt(material.least_cos2_t + material.inverse_ior2 * view_cosine2);
    float path = clamp(material.longest * cos_t, 0.0, 1.0);
    float c = 1.0 - view_cosine;
    float c2 = c * c;
    float upper = material.r_squared + material.F0_complement * (c2 * c2 * abs(c));
    float film_c = 1.0 - cos_t;
    float film_c2 = film_c * film_c;
    float lower_weight = film_c2 * film_c2 * abs(film_c);
    vec4 waves = cos(vec4(168.99255, 180.48325, 222.01259, 225.1793) * path);
    vec4 fades = exp2(vec4(63.101753, 135.66629, 96.40813, 66.0237) * -(path * path));
    vec4 first = waves * fades;
    vec4 fades2 = fades * fades;
    vec4 second = (2.0 * (waves * waves) - 1.0) * (fades2 * fades2);
    vec3 film_first = vec3(first.x + 0.18175068 * first.w, first.y, first.z);
    vec3 fresnel_part = vec3(5.4866724, -1.6411418, 0.09421429) * (second.x + 0.18175068 * second.w) + vec3(-3.0749593, 3.752854, -0.40814236) * second.y;
    vec3 film_second = fresnel_part + vec3(-0.998182, 0.08320529, 2.116824) * second.z;
    float film_fresnel_part = material.film_fresnel + material.film_fresnel_2 * lower_weight;
    vec3 turned = film_first * material.film_fresnel_3;
    vec3 first_rgb = vec3(5.4866724, -1.6411418, 0.09421429) * turned.x + vec3(-3.0749593, 3.752854, -0.40814236) * turned.y + vec3(-0.998182, 0.08320529, 2.116824) * turned.z;
    float through = 1.0 - upper;
    float film_fresnel_part_2 = clamp(upper * film_fresnel_part, 1e-5, 0.9999);
    float through2 = through * through;
    float film_fresnel_part_3 = through2 * film_fresnel_part / (1.0 - film_fresnel_part_2);
    float film_fresnel_part_4 = film_fresnel_part_3 - through;
    vec3 film_fresnel_part_5 = upper + film_fresnel_part_3 + (first_rgb * (sqrt(film_fresnel_part_2) * film_fresnel_part_4) + film_second * (film_fresnel_part_2 * film_fresnel_part_4));
    vec3 dielectric = clamp(film_fresnel_part_5, 0.0, 1.0);
    vec3 lower = material.lower_f0 + material.one_minus_lower_f0 * lower_weight;
    vec3 film_turned = film_first * material.turn;
    vec3 film_first_rgb = vec3(5.4866724, -1.6411418, 0.09421429) * film_turned.x + vec3(-3.0749593, 3.752854, -0.40814236) * film_turned.y + vec3(-0.998182, 0.08320529, 2.116824) * film_turned.z;
    vec3 both = clamp(upper * lower, 1e-5, 0.9999);
    vec3 repeated = through2 * lower / (1.0 - both);
    vec3 swing = repeated - through;
    vec3 metal = clamp(upper + repeated + swing * (sqrt(both) * film_first_rgb + both * film_second), 0.0, 1.0);

    // anisotropy.cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
    float BdotV = dot(across, V);

    // anisotropy.distribution: KHR_materials_coat, "Anisotropy" (D); Burley 2012
    float narrowness = min(material.alpha / alpha_t, 1.0);
    float narrowness2 = narrowness * narrowness;
    float narrowness2_complement = 1.0 - narrowness2;
    float ggx_peak = material.alpha_b2 * narrowness / 3.1415927;

    // anisotropy.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
    float alpha_t2 = alpha_t * alpha_t;
    float alpha2_difference = max(alpha_t2 - material.alpha_b2, 0.0);
    float alpha_t2_complement = 1.0 - alpha_t2;
    float masked_view2 = alpha_t2 - alpha2_difference * (BdotV * BdotV) + alpha_t2_complement * view_cosine2;
    float masked_view = sqrt(clamp(masked_view2, 0.0, 1.0));

    // output
    vec3 light_sum = vec3(0.0);
    for (int i = 0; i < frame.light_count; ++i) {
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
        float half_length2 = dot(sum, sum);
        float VdotH = clamp(0.5 * sqrt(half_length2), 0.0, 1.0);

        // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        float NdotL = clamp(dot(N, L), 0.0, 1.0);
        float NdotSum = NdotL + signed_NdotV;

        // dielectric.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        float dielectric_c = 1.0 - VdotH;
        float dielectric_c2 = dielectric_c * dielectric_c;
        float weight = dielectric_c2 * dielectric_c2 * dielectric_c;

        // metal.schlick: glTF 2.0, Appendix B, "Fresnel"; KHR_materials_specular, "Implementation"
        vec3 F = mix(material.base_color_factor, vec3(1.0), weight);

        // anisotropy.cosines: KHR_materials_coat, "Anisotropy" (D, in h.t and h.b)
        float BdotL = dot(across, L);

        // anisotropy.distribution: KHR_materials_coat, "Anisotropy" (D); Burley 2012
        vec3 planar = sum - N * NdotSum;
        float planar2 = dot(planar, planar);
        float BdotSum = BdotV + BdotL;
        float spread = narrowness2_complement * (BdotSum * BdotSum) + narrowness2 * planar2 + material.alpha_b2 * (NdotSum * NdotSum);
        float facing = 0.0 < NdotSum ? half_length2 * half_length2 : 0.0;
        float numerator = facing * ggx_peak;
        float denominator = spread * spread;

        // anisotropy.visibility: Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.4.1
        float masked_light2 = alpha_t2 - alpha2_difference * (BdotL * BdotL) + alpha_t2_complement * (NdotL * NdotL);
        float masked_light = sqrt(clamp(masked_light2, 0.0, 1.0));
        float visibility = 2.0 * (NdotL * masked_view + view_cosine * masked_light);

        // anisotropy.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = numerator / (denominator * visibility + 3e-32);

        // film.dielectric: KHR_materials_iridescence, "Layering"
        vec3 film_F = mix(vec3(mix(0.04, 1.0, weight)), dielectric, material.strength);
        float most = max(max(film_F.x, film_F.y), film_F.z);

        // film.metal: KHR_materials_iridescence, "Layering"
        vec3 film_F_2 = mix(F, metal, material.strength);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
        float reflected = specular * NdotL;
        float refracted = NdotL * (material.dielectric * (1.0 - most));
        vec3 direct = film_F * (material.dielectric * reflected) + film_F_2 * (material.metallic_factor * reflected) + material.body * refracted;

        // output
        light_sum += direct * radiance;
    }

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    vec4 split = textureLod(environment_dfg, vec2(view_cosine, material.roughness_factor), 0.0);

    // dielectric.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    float dielectric_facing = 1.0 - split.y;
    float lost = clamp(dielectric_facing - split.x, 0.0, 1.0);
    float environment_part = 0.04 * split.x + split.y;
    float dielectric_most = clamp(environment_part / (1.000001 - 0.08571429 * lost), 0.0, 1.0);

    // metal.environment: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; Karis 2013
    vec3 once = material.base_color_factor * split.x + split.y;
    vec3 bounces = 1.000001 - material.mean_fresnel * lost;
    vec3 metal_all = clamp(once / bounces, 0.0, 1.0);

    // anisotropy.bent_normal: McAuley 2015, "Rendering the World of Far Cry 4"; as in the Khronos sample viewer's anisotropy
    vec3 towards = V - across * BdotV;
    float bend = material.smoothness_times_anisotropy_strength * texel.z;
    float straight = 1.0 - bend;
    float straight2 = straight * straight;
    vec3 bent_normal = mix(towards, N, straight2 * straight2);

    // anisotropy.reflection: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    vec3 reflection = bent_normal * (2.0 * dot(bent_normal, V)) - V * dot(bent_normal, bent_normal);

    // base.irradiance: glTF 2.0, Appendix B, "Diffuse BRDF"
    vec3 mean = textureLod(environment_irradiance, v_normal, 0.0).xyz;

    // base.body_indirect: glTF 2.0, Appendix B, "Diffuse BRDF"
    vec3 body_indirect = material.base_color_factor * mean;

    // film.dielectric_environment: Karis 2013, "Real Shading in Unreal Engine 4" (split sum, with a Fresnel that does not depend on the light)
    float dielectric_environment_part = 1.0 - lost;
    vec3 film_once = dielectric * dielectric_environment_part;
    vec3 film_bounces = 1.000001 - dielectric * lost;
    vec3 film_all = clamp(film_once / film_bounces, 0.0, 1.0);

    // film.dielectric_once: KHR_materials_iridescence, "Layering"
    vec3 dielectric_once = mix(vec3(environment_part), film_once, material.strength);

    // film.dielectric_all: KHR_materials_iridescence, "Layering"
    vec3 film_F_3 = mix(vec3(dielectric_most), film_all, material.strength);
    float film_most = max(max(film_F_3.x, film_F_3.y), film_F_3.z);

    // film.metal_environment: Karis 2013, "Real Shading in Unreal Engine 4" (split sum, with a Fresnel that does not depend on the light)
    vec3 film_once_2 = metal * dielectric_environment_part;
    vec3 film_bounces_2 = 1.000001 - metal * lost;
    vec3 film_all_2 = clamp(film_once_2 / film_bounces_2, 0.0, 1.0);

    // film.metal_once: KHR_materials_iridescence, "Layering"
    vec3 metal_once = mix(once, film_once_2, material.strength);

    // film.metal_all: KHR_materials_iridescence, "Layering"
    vec3 film_F_4 = mix(metal_all, film_all_2, material.strength);

    // base.indirect: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"; KHR_materials_specular, "Implementation"
    vec3 base_once = dielectric_once * material.dielectric + metal_once * material.metallic_factor;
    vec3 base_all = film_F_3 * material.dielectric + film_F_4 * material.metallic_factor;
    float under = material.dielectric * (1.0 - film_most);
    vec3 indirect_part = base_once * textureLod(environment_specular, reflection, material.roughness_factor * frame.environment_max_lod).xyz + max(base_all - base_once, 0.0) * mean;
    vec3 indirect = indirect_part + body_indirect * under;

    // output
    out_color = vec4(light_sum + indirect * frame.environment_intensity, 1.0);
}
