// forward-coat-6cbc942419c8f4bb
// Lacquer 0.1.0, template forward

struct FrameBlock {
    column_major float4x4 view_projection;
    float3 camera_position;
    float environment_intensity;
    float environment_max_lod;
    int light_count;
};

cbuffer Frame : register(b0) {
    FrameBlock frame;
};

struct Light {
    float3 position;
    float positional;
    float3 radiance;
    float inverse_range_4;
    float3 direction;
    float spot_scale;
    float spot_offset;
};

cbuffer Lights : register(b1) {
    Light lights[16];
};

struct MaterialBlock {
    float3 F0;
    float roughness_factor;
    float3 diffuse;
    float coat_roughness_factor;
    float3 lambert;
    float coat_normal_scale;
    float3 base_indirect;
    float alpha2;
    float peak;
    float rest;
    float coat_alpha2;
    float coat_peak;
    float coat_rest;
    float coat_transmission_direct;
    float coat_coat_transmission_direct;
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
};

cbuffer Material : register(b2) {
    MaterialBlock material;
};

TextureCube environment_specular : register(t0);
SamplerState environment_specular_sampler : register(s0);
TextureCube environment_irradiance : register(t1);
SamplerState environment_irradiance_sampler : register(s1);
Texture2D coat_normal_texture : register(t2);
SamplerState coat_normal_texture_sampler : register(s2);

void main(
    float3 v_position : TEXCOORD0,
    float3 v_normal : TEXCOORD1,
    float4 v_tangent : TEXCOORD2,
    float2 v_uv0 : TEXCOORD3,
    bool in_front_facing : SV_IsFrontFace,
    out float4 out_color : SV_Target0) {
    // view: glTF 2.0, Appendix B, "Overview"
    float3 to_eye = frame.camera_position - v_position;
    float view = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float view_view = rsqrt(to_eye.x * to_eye.x + view);
    float3 V = to_eye * view_view;

    // normal.unit: glTF 2.0, "Meshes"
    float unit = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    float3 N = v_normal * rsqrt(v_normal.x * v_normal.x + unit);

    // normal.facing: glTF 2.0, "Double Sided"
    float3 facing = in_front_facing ? N : -N;

    // coat_normal.texel: glTF 2.0, "Textures"
    float4 texel = coat_normal_texture.Sample(coat_normal_texture_sampler, v_uv0);

    // coat.normal_map: glTF 2.0, "Additional Textures" (normal)
    float3 t = texel.xyz * 2.0 - 1.0;
    float normal_map = abs(t.x) + abs(t.y) + abs(t.z);
    float z = normal_map < 1e-6 ? 1.0 : t.z;
    float3 coat_normal_map = v_tangent.xyz * (t.x * material.coat_normal_scale) + cross(N, v_tangent.xyz) * (v_tangent.w * (t.y * material.coat_normal_scale));
    float3 bent = coat_normal_map + N * z;
    float coat_normal_map_2 = bent.y * bent.y + (bent.z * bent.z + 1e-32);
    float3 coat_unit = bent * rsqrt(bent.x * bent.x + coat_normal_map_2);

    // coat.facing: glTF 2.0, "Double Sided"
    float3 coat_facing = in_front_facing ? coat_unit : -coat_unit;

    // coat.view_cosine: KHR_materials_clearcoat, "Layering"
    float view_cosine = dot(coat_facing, to_eye);
    float NV = view_cosine * view_view;
    float coat_view_cosine = abs(NV);

    // coat.fresnel: glTF 2.0, Appendix B, "Fresnel"; Schlick 1994
    float c = 1.0 - coat_view_cosine;
    float c2 = c * c;

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float cosines = dot(facing, to_eye);
    float base_NV = cosines * view_view;
    float NdotV = abs(base_NV);

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.alpha2 + material.rest * (NdotV * NdotV));

    // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float coat_masked_view = sqrt(material.coat_alpha2 + material.coat_rest * (coat_view_cosine * coat_view_cosine));

    // coat.transmission_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    float transmission_direct = material.coat_coat_transmission_direct + material.coat_transmission_direct * (c2 * c2 * abs(c));
    float coat_transmission_direct = clamp(1.0 - transmission_direct, 0.0, 1.0);

    // output
    float3 light_sum = float3(0.0, 0.0, 0.0);
    for (int i = 0; i < frame.light_count; ++i) {
        // light_sample: KHR_lights_punctual, "Range Property" and "Inner and Outer Cone Angles"
        float3 to_light = lights[i].position - v_position * lights[i].positional;
        float distance2 = max(dot(to_light, to_light), 1e-12);
        float inverse_distance = lerp(1.0, rsqrt(distance2), lights[i].positional);
        float3 L = to_light * inverse_distance;
        float window = clamp(1.0 - distance2 * (distance2 * lights[i].inverse_range_4), 0.0, 1.0);
        float cone = clamp(lights[i].spot_offset - dot(L, lights[i].direction) * lights[i].spot_scale, 0.0, 1.0);
        float3 radiance = lights[i].radiance * (window * (cone * cone) * (inverse_distance * inverse_distance));

        // half: glTF 2.0, Appendix B, "Overview"
        float3 sum = V + L;
        float length2 = dot(sum, sum);
        float VdotH = clamp(0.5 * sqrt(length2), 0.0, 1.0);

        // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        float NdotL = clamp(dot(facing, L), 0.0, 1.0);
        float NdotSum = NdotL + base_NV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 planar = sum - facing * NdotSum;
        float planar2 = dot(planar, planar);
        float spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        float distribution = length2 * length2;
        float base_facing = 0.0 < NdotSum ? distribution : 0.0;
        float numerator = base_facing * material.peak;
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
        float coat_NdotL = clamp(dot(coat_facing, L), 0.0, 1.0);
        float coat_NdotSum = coat_NdotL + NV;

        // coat.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 coat_planar = sum - coat_facing * coat_NdotSum;
        float coat_planar2 = dot(coat_planar, coat_planar);
        float coat_spread = coat_planar2 + material.coat_alpha2 * (coat_NdotSum * coat_NdotSum);
        float coat_facing_2 = 0.0 < coat_NdotSum ? distribution : 0.0;
        float coat_numerator = coat_facing_2 * material.coat_peak;
        float coat_denominator = coat_spread * coat_spread;

        // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float coat_masked_light = sqrt(material.coat_alpha2 + material.coat_rest * (coat_NdotL * coat_NdotL));
        float coat_visibility = 2.0 * (coat_NdotL * coat_masked_view + coat_view_cosine * coat_masked_light);

        // coat.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float coat_specular = coat_numerator / (coat_denominator * coat_visibility + 1e-30);

        // coat.layer_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        float3 layer_direct = (material.lambert + material.F0 * specular) * ((NdotL - glancing) * coat_transmission_direct) + (glancing * specular * coat_transmission_direct + coat_specular * coat_NdotL * transmission_direct);

        // output
        light_sum += layer_direct * radiance;
    }

    // base.albedo: fitted to the quadrature of glTF 2.0, Appendix B, "Specular BRDF" (tests/physics integrates it anew)
    float q = material.q0 + NdotV * (material.q1 + NdotV * material.q2);
    float albedo = clamp(1.0 - (material.p0 + material.p1 * NdotV) / q, 0.0, 1.0);

    // base.fresnel: fitted to the quadrature of glTF 2.0, Appendix B, "Fresnel" (within 0.029, 0.066 below N.V = 0.1)
    float base_q = material.base_q0 + NdotV * (material.base_q1 + NdotV * material.base_q2);
    float fresnel = clamp((material.base_p0 + material.base_p1 * NdotV) / base_q, 0.0, 1.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    float3 single = material.F0 * (albedo - fresnel) + fresnel;
    float indirect = 1.0 - albedo;
    float3 base_all = single / (1.0 - (material.F0 * (0.95238096 * indirect) + 0.04761905 * indirect));
    float3 base_spread = clamp(base_all * material.base_indirect + (material.diffuse - single), 0.0, 1.0);
    float3 base_indirect = single * environment_specular.SampleLevel(environment_specular_sampler, cosines * 2.0 * facing - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * environment_irradiance.SampleLevel(environment_irradiance_sampler, facing, 0.0).xyz;

    // coat.albedo: fitted to the quadrature of glTF 2.0, Appendix B, "Specular BRDF" (tests/physics integrates it anew)
    float coat_q = material.coat_q0 + coat_view_cosine * (material.coat_q1 + coat_view_cosine * material.coat_q2);
    float coat_albedo = clamp(1.0 - (material.coat_p0 + material.coat_p1 * coat_view_cosine) / coat_q, 0.0, 1.0);

    // coat.layer_ibl: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    float3 layer_ibl = environment_specular.SampleLevel(environment_specular_sampler, view_cosine * 2.0 * coat_facing - to_eye, material.coat_roughness_factor * frame.environment_max_lod).xyz * (coat_albedo * transmission_direct);
    float3 coat_layer_ibl = base_indirect * coat_transmission_direct + layer_ibl;

    // output
    out_color = float4(light_sum + coat_layer_ibl * frame.environment_intensity, 1.0);
}
