#version 300 es
// forward-coat-cf47fb8f21d29376
// Lacquer 0.1.0, template forward

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
    vec3 F0;
    float roughness_factor;
    vec3 diffuse;
    float coat_roughness_factor;
    vec3 emissive_factor;
    float coat_normal_scale;
    vec3 lambert;
    float emission_transmission;
    vec3 base_indirect;
    float emission_emission_transmission;
    float alpha2;
    float peak;
    float rest;
    float coat_alpha2;
    float coat_peak;
    float coat_rest;
    float p0;
    float p1;
    float q0;
    float q1;
    float q2;
    float base_p0;
    float base_p1;
    float base_q0;
    float base_q1;
    float base_q2;
    float coat_p0;
    float coat_p1;
    float coat_q0;
    float coat_q1;
    float coat_q2;
} material;

uniform samplerCube environment_specular;
uniform samplerCube environment_irradiance;
uniform sampler2D normal_texture;
uniform sampler2D coat_normal_texture;

in vec3 v_position;
in vec3 v_normal;
in vec2 v_uv0;

layout(location = 0) out vec4 out_color;

void main() {
    // view: glTF 2.0, Appendix B, "Overview"
    vec3 to_eye = frame.camera_position - v_position;
    float view = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float view_view = inversesqrt(to_eye.x * to_eye.x + view);
    vec3 V = to_eye * view_view;

    // normal.unit: glTF 2.0, "Meshes"
    float unit = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    vec3 N = v_normal * inversesqrt(v_normal.x * v_normal.x + unit);

    // normal.frame: glTF 2.0, "Meshes" (tangents where none are given)
    vec3 px = dFdx(v_position);
    vec3 py = dFdy(v_position);
    vec2 uvx = dFdx(v_uv0);
    vec2 uvy = dFdy(v_uv0);
    float mirrored = uvx.x * uvy.y < uvy.x * uvx.y ? -1.0 : 1.0;
    vec3 normal_frame = px * uvy.y - py * uvx.y;
    vec3 along_u = normal_frame * mirrored;
    vec3 normal_frame_2 = px * uvy.x - py * uvx.x;
    vec3 along_v = normal_frame_2 * mirrored;
    vec3 value_in_plane_u = along_u - N * (dot(N, normal_frame) * mirrored);
    vec3 value_in_plane_v = along_v - N * (dot(N, normal_frame_2) * mirrored);
    float normal_frame_3 = value_in_plane_u.y * value_in_plane_u.y + (value_in_plane_u.z * value_in_plane_u.z + 1e-32);
    vec3 T = value_in_plane_u * inversesqrt(value_in_plane_u.x * value_in_plane_u.x + normal_frame_3);
    float normal_frame_4 = value_in_plane_v.y * value_in_plane_v.y + (value_in_plane_v.z * value_in_plane_v.z + 1e-32);
    vec3 B = value_in_plane_v * inversesqrt(value_in_plane_v.x * value_in_plane_v.x + normal_frame_4);

    // normal.texel: glTF 2.0, "Textures"
    vec4 texel = texture(normal_texture, v_uv0);

    // base.normal_map: glTF 2.0, "Additional Textures" (normal)
    vec3 t = texel.xyz * 2.0 - 1.0;
    float normal_map = abs(t.x) + abs(t.y) + abs(t.z);
    float z = normal_map < 1e-6 ? 1.0 : t.z;
    vec3 bent = T * t.x + B * t.y + N * z;
    float base_normal_map = bent.y * bent.y + (bent.z * bent.z + 1e-32);
    vec3 base_unit = bent * inversesqrt(bent.x * bent.x + base_normal_map);

    // coat_normal.texel: glTF 2.0, "Textures"
    vec4 coat_normal_texel = texture(coat_normal_texture, v_uv0);

    // coat.normal_map: glTF 2.0, "Additional Textures" (normal)
    vec3 coat_t = coat_normal_texel.xyz * 2.0 - 1.0;
    float coat_normal_map = abs(coat_t.x) + abs(coat_t.y) + abs(coat_t.z);
    float coat_z = coat_normal_map < 1e-6 ? 1.0 : coat_t.z;
    vec3 coat_bent = T * (coat_t.x * material.coat_normal_scale) + B * (coat_t.y * material.coat_normal_scale) + N * coat_z;
    float coat_normal_map_2 = coat_bent.y * coat_bent.y + (coat_bent.z * coat_bent.z + 1e-32);
    vec3 coat_unit = coat_bent * inversesqrt(coat_bent.x * coat_bent.x + coat_normal_map_2);

    // coat.view_cosine: KHR_materials_clearcoat, "Layering"
    float view_cosine = dot(coat_unit, to_eye);
    float NV = view_cosine * view_view;
    float coat_view_cosine = abs(NV);

    // coat.fresnel: glTF 2.0, Appendix B, "Fresnel"; Schlick 1994
    float c = 1.0 - coat_view_cosine;
    float c2 = c * c;

    // emission.transmission: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    float transmission = material.emission_emission_transmission + material.emission_transmission * (c2 * c2 * abs(c));
    float emission_transmission = clamp(1.0 - transmission, 0.0, 1.0);

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float cosines = dot(base_unit, to_eye);
    float base_NV = cosines * view_view;
    float NdotV = abs(base_NV);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.alpha2 + material.rest * (NdotV * NdotV));

    // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float coat_masked_view = sqrt(material.coat_alpha2 + material.coat_rest * (coat_view_cosine * coat_view_cosine));

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
        float length2 = dot(sum, sum);
        float VdotH = clamp(0.5 * sqrt(length2), 0.0, 1.0);

        // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        float NdotL = clamp(dot(base_unit, L), 0.0, 1.0);
        float NdotSum = NdotL + base_NV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        vec3 planar = sum - base_unit * NdotSum;
        float planar2 = dot(planar, planar);
        float spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        float distribution = length2 * length2;
        float facing = 0.0 < NdotSum ? distribution : 0.0;
        float numerator = facing * material.peak;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float masked_light = sqrt(material.alpha2 + material.rest * (NdotL * NdotL));
        float visibility = 2.0 * (NdotL * masked_view + NdotV * masked_light);

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = numerator / (denominator * visibility + 1e-30);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float base_c = 1.0 - VdotH;
        float base_c2 = base_c * base_c;
        float weight = base_c2 * base_c2 * base_c;
        float glancing = weight * NdotL;

        // coat.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        float coat_NdotL = clamp(dot(coat_unit, L), 0.0, 1.0);
        float coat_NdotSum = coat_NdotL + NV;

        // coat.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        vec3 coat_planar = sum - coat_unit * coat_NdotSum;
        float coat_planar2 = dot(coat_planar, coat_planar);
        float coat_spread = coat_planar2 + material.coat_alpha2 * (coat_NdotSum * coat_NdotSum);
        float coat_facing = 0.0 < coat_NdotSum ? distribution : 0.0;
        float coat_numerator = coat_facing * material.coat_peak;
        float coat_denominator = coat_spread * coat_spread;

        // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float coat_masked_light = sqrt(material.coat_alpha2 + material.coat_rest * (coat_NdotL * coat_NdotL));
        float coat_visibility = 2.0 * (coat_NdotL * coat_masked_view + coat_view_cosine * coat_masked_light);

        // coat.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float coat_specular = coat_numerator / (coat_denominator * coat_visibility + 1e-30);

        // coat.layer_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        vec3 layer_direct = (material.lambert + material.F0 * specular) * ((NdotL - glancing) * emission_transmission) + (glancing * specular * emission_transmission + coat_specular * coat_NdotL * transmission);

        // output
        light_sum += layer_direct * radiance;
    }

    // emission.coated: KHR_materials_clearcoat, "Emission"; EXT_materials_clearcoat_color, "Implementation"
    vec3 coated = material.emissive_factor * emission_transmission;

    // base.albedo: fitted to the quadrature of glTF 2.0, Appendix B, "Specular BRDF" (tests/physics integrates it anew)
    float q = material.q0 + NdotV * (material.q1 + NdotV * material.q2);
    float albedo = clamp(1.0 - (material.p0 + material.p1 * NdotV) / q, 0.0, 1.0);

    // base.fresnel: fitted to the quadrature of glTF 2.0, Appendix B, "Fresnel" (within 0.029, 0.066 below N.V = 0.1)
    float base_q = material.base_q0 + NdotV * (material.base_q1 + NdotV * material.base_q2);
    float fresnel = clamp((material.base_p0 + material.base_p1 * NdotV) / base_q, 0.0, 1.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    vec3 single = material.F0 * (albedo - fresnel) + fresnel;
    float indirect = 1.0 - albedo;
    vec3 base_all = single / (1.0 - (material.F0 * (0.95238096 * indirect) + 0.04761905 * indirect));
    vec3 base_spread = clamp(base_all * material.base_indirect + (material.diffuse - single), 0.0, 1.0);
    vec3 base_indirect = single * textureLod(environment_specular, cosines * 2.0 * base_unit - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * textureLod(environment_irradiance, bent, 0.0).xyz;

    // coat.albedo: fitted to the quadrature of glTF 2.0, Appendix B, "Specular BRDF" (tests/physics integrates it anew)
    float coat_q = material.coat_q0 + coat_view_cosine * (material.coat_q1 + coat_view_cosine * material.coat_q2);
    float coat_albedo = clamp(1.0 - (material.coat_p0 + material.coat_p1 * coat_view_cosine) / coat_q, 0.0, 1.0);

    // coat.layer_ibl: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    vec3 layer_ibl = textureLod(environment_specular, view_cosine * 2.0 * coat_unit - to_eye, material.coat_roughness_factor * frame.environment_max_lod).xyz * (coat_albedo * transmission);
    vec3 coat_layer_ibl = base_indirect * emission_transmission + layer_ibl;

    // output
    out_color = vec4(light_sum + coat_layer_ibl * frame.environment_intensity + coated, 1.0);
}
