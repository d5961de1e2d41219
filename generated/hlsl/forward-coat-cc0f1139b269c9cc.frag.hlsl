// forward-coat-cc0f1139b269c9cc
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
    float coat_factor;
    float3 lambert;
    float coat_roughness_factor;
    float3 base_indirect;
    float alpha2;
    float peak;
    float rest;
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
};

cbuffer Material : register(b2) {
    MaterialBlock material;
};

TextureCube environment_specular : register(t0);
SamplerState environment_specular_sampler : register(s0);
TextureCube environment_irradiance : register(t1);
SamplerState environment_irradiance_sampler : register(s1);
Texture2D coat_texture : register(t2);
SamplerState coat_texture_sampler : register(s2);

void main(
    float3 v_position : TEXCOORD0,
    float3 v_normal : TEXCOORD1,
    float2 v_uv0 : TEXCOORD2,
    out float4 out_color : SV_Target0) {
    // view: glTF 2.0, Appendix B, "Overview"
    float3 to_eye = frame.camera_position - v_position;
    float view = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float view_view = rsqrt(to_eye.x * to_eye.x + view);
    float3 V = to_eye * view_view;

    // normal.unit: glTF 2.0, "Meshes"
    float unit = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    float3 N = v_normal * rsqrt(v_normal.x * v_normal.x + unit);

    // coat.texel: glTF 2.0, "Textures"
    float4 texel = coat_texture.Sample(coat_texture_sampler, v_uv0);

    // coat.surface: KHR_materials_coat, "Parameter Combinations"; KHR_materials_clearcoat, "Clearcoat"
    float weight = material.coat_factor * texel.x;
    float roughness = material.coat_roughness_factor * texel.y;

    // coat.alpha: glTF 2.0, Appendix B, "Microfacet Surfaces" and "Specular BRDF" (note on alpha = 0)
    float r2 = roughness * roughness;
    float alpha = max(r2, 0.001);

    // coat.view_cosine: KHR_materials_clearcoat, "Layering"
    float view_cosine = dot(N, to_eye);
    float NV = view_cosine * view_view;
    float coat_view_cosine = abs(NV);

    // coat.fresnel: glTF 2.0, Appendix B, "Fresnel"; Schlick 1994
    float c = 1.0 - coat_view_cosine;
    float c2 = c * c;
    float fresnel = 0.04 + 0.96 * (c2 * c2 * abs(c));

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float visibility = coat_view_cosine * coat_view_cosine;
    float masked_view = sqrt(material.alpha2 + material.rest * visibility);

    // coat.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
    float alpha2 = alpha * alpha;
    float peak = alpha2 / 3.1415927;

    // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float rest = 1.0 - alpha2;
    float coat_masked_view = sqrt(alpha2 + rest * visibility);

    // coat.transmission_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    float transmission_direct = weight * fresnel;
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
        float cone = clamp(lights[i].spot_offset - dot(to_light, lights[i].direction) * inverse_distance * lights[i].spot_scale, 0.0, 1.0);
        float3 radiance = lights[i].radiance * (window * (cone * cone) * (inverse_distance * inverse_distance));

        // half: glTF 2.0, Appendix B, "Overview"
        float3 sum = V + L;
        float length2 = dot(sum, sum);
        float VdotH = clamp(0.5 * sqrt(length2), 0.0, 1.0);

        // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        float NdotL = clamp(dot(N, to_light) * inverse_distance, 0.0, 1.0);
        float NdotSum = NdotL + NV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 planar = sum - N * NdotSum;
        float planar2 = dot(planar, planar);
        float distribution = NdotSum * NdotSum;
        float spread = planar2 + material.alpha2 * distribution;
        float facing = 0.0 < NdotSum ? length2 * length2 : 0.0;
        float numerator = facing * material.peak;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float base_visibility = NdotL * NdotL;
        float masked_light = sqrt(material.alpha2 + material.rest * base_visibility);
        float base_visibility_2 = 2.0 * (NdotL * masked_view + coat_view_cosine * masked_light);

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = numerator / (denominator * base_visibility_2 + 1e-30);

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float base_c = 1.0 - VdotH;
        float base_c2 = base_c * base_c;
        float base_weight = base_c2 * base_c2 * base_c;
        float glancing = base_weight * NdotL;

        // coat.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float coat_spread = planar2 + alpha2 * distribution;
        float coat_numerator = facing * peak;
        float coat_denominator = coat_spread * coat_spread;

        // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float coat_masked_light = sqrt(alpha2 + rest * base_visibility);
        float coat_visibility = 2.0 * (NdotL * coat_masked_view + coat_view_cosine * coat_masked_light);

        // coat.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float coat_specular = coat_numerator / (coat_denominator * coat_visibility + 1e-30);

        // coat.layer_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        float3 layer_direct = (material.lambert + material.F0 * specular) * ((NdotL - glancing) * coat_transmission_direct) + (glancing * specular * coat_transmission_direct + coat_specular * NdotL * transmission_direct);

        // output
        light_sum += layer_direct * radiance;
    }

    // base.radiance: Karis 2013, "Real Shading in Unreal Engine 4" (split sum)
    float3 base_radiance = view_cosine * 2.0 * N - to_eye;

    // base.albedo: fitted to the quadrature of glTF 2.0, Appendix B, "Specular BRDF" (tests/physics integrates it anew)
    float q = material.q0 + coat_view_cosine * (material.q1 + coat_view_cosine * material.q2);
    float albedo = clamp(1.0 - (material.p0 + material.p1 * coat_view_cosine) / q, 0.0, 1.0);

    // base.fresnel: fitted to the quadrature of glTF 2.0, Appendix B, "Fresnel" (within 0.029, 0.066 below N.V = 0.1)
    float base_q = material.base_q0 + coat_view_cosine * (material.base_q1 + coat_view_cosine * material.base_q2);
    float base_fresnel = clamp((material.base_p0 + material.base_p1 * coat_view_cosine) / base_q, 0.0, 1.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    float3 single = material.F0 * (albedo - base_fresnel) + base_fresnel;
    float indirect = 1.0 - albedo;
    float3 base_all = single / (1.0 - (material.F0 * (0.95238096 * indirect) + 0.04761905 * indirect));
    float3 base_spread = clamp(base_all * material.base_indirect + (material.diffuse - single), 0.0, 1.0);
    float3 base_indirect = single * environment_specular.SampleLevel(environment_specular_sampler, base_radiance, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * environment_irradiance.SampleLevel(environment_irradiance_sampler, v_normal, 0.0).xyz;

    // coat.albedo: fitted to the quadrature of glTF 2.0, Appendix B, "Specular BRDF" (tests/physics integrates it anew)
    float p0 = (7.457 + 6.966 * roughness - 12.0 * r2) * r2;
    float p1 = (165.3 - 698.4 * roughness + 1314.0 * r2) * r2;
    float q0 = 1.0 - 31.65 * roughness + 269.4 * r2;
    float q1 = 179.0 - 1757.0 * roughness + 2613.0 * r2;
    float q2 = 1331.0 - 2000.0 * roughness + 512.1 * r2;
    float coat_q = q0 + coat_view_cosine * (q1 + coat_view_cosine * q2);
    float coat_albedo = clamp(1.0 - (p0 + p1 * coat_view_cosine) / coat_q, 0.0, 1.0);

    // coat.layer_ibl: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    float3 layer_ibl = base_indirect * coat_transmission_direct + environment_specular.SampleLevel(environment_specular_sampler, base_radiance, roughness * frame.environment_max_lod).xyz * (coat_albedo * transmission_direct);

    // output
    out_color = float4(light_sum + layer_ibl * frame.environment_intensity, 1.0);
}
