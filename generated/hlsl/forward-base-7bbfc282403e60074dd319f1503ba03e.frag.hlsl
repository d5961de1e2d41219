// forward-base-7bbfc282403e60074dd319f1503ba03e
// Lacquer 0.2.0, template forward

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
    float4 base_color_factor;
    float3 emissive_factor_times_emissive_strength;
    float metallic_factor;
    float roughness_factor;
    float f0;
    float occlusion_strength;
    float refracted;
    float refracted_over_3_14;
    float mean_fresnel;
};

cbuffer Material : register(b2) {
    MaterialBlock material;
};

TextureCube environment_specular : register(t0);
SamplerState environment_specular_sampler : register(s0);
TextureCube environment_irradiance : register(t1);
SamplerState environment_irradiance_sampler : register(s1);
Texture2D environment_dfg : register(t2);
SamplerState environment_dfg_sampler : register(s2);
Texture2D base_color_texture : register(t3);
SamplerState base_color_texture_sampler : register(s3);
Texture2D normal_texture : register(t4);
SamplerState normal_texture_sampler : register(s4);
Texture2D metallic_roughness_texture : register(t5);
SamplerState metallic_roughness_texture_sampler : register(s5);
Texture2D emissive_texture : register(t6);
SamplerState emissive_texture_sampler : register(s6);

void main(
    float3 v_position : TEXCOORD0,
    float3 v_normal : TEXCOORD1,
    float2 v_uv0 : TEXCOORD2,
    float2 v_uv1 : TEXCOORD3,
    float4 v_COLOR_0 : TEXCOORD4,
    out float4 out_color : SV_Target0) {
    // color0
    float4 color0 = clamp(v_COLOR_0, 0.0, 1.0);

    // view: glTF 2.0, Appendix B, "Overview"
    float3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float view_part_2 = rsqrt(to_eye.x * to_eye.x + view_part);
    float3 V = to_eye * view_part_2;

    // base_color.texel: glTF 2.0, "Textures"
    float4 texel = base_color_texture.Sample(base_color_texture_sampler, v_uv0);

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    float4 color = material.base_color_factor * texel * color0;

    // normal.unit: glTF 2.0, "Meshes"
    float unit_part = v_normal.y * v_normal.y + (v_normal.z * v_normal.z + 1e-32);
    float3 N = v_normal * rsqrt(v_normal.x * v_normal.x + unit_part);

    // normal.frame: glTF 2.0, "Meshes" (tangents where none are given)
    float3 px = ddx(v_position);
    float3 py = ddy(v_position);
    float2 uvx = ddx(v_uv0);
    float2 uvy = ddy(v_uv0);
    float mirrored = uvx.x * uvy.y < uvy.x * uvx.y ? -1.0 : 1.0;
    float3 frame_part = px * uvy.y - py * uvx.y;
    float3 along_u = frame_part * mirrored;
    float3 normal_frame_part = px * uvy.x - py * uvx.x;
    float3 along_v = normal_frame_part * mirrored;
    float3 value_in_plane_u = along_u - N * (dot(N, frame_part) * mirrored);
    float3 value_in_plane_v = along_v - N * (dot(N, normal_frame_part) * mirrored);
    float normal_frame_part_2 = value_in_plane_u.y * value_in_plane_u.y + (value_in_plane_u.z * value_in_plane_u.z + 1e-32);
    float normal_frame_part_3 = value_in_plane_v.y * value_in_plane_v.y + (value_in_plane_v.z * value_in_plane_v.z + 1e-32);

    // normal.texel: glTF 2.0, "Textures"
    float4 normal_texel = normal_texture.Sample(normal_texture_sampler, v_uv0);

    // base.normal_map: glTF 2.0, "Additional Textures" (normal)
    float2 xy = normal_texel.xy * 2.0 - 1.0;
    float z = max(normal_texel.z * 2.0 - 1.0, 1e-14);
    float3 normal_map_part = value_in_plane_u * (rsqrt(value_in_plane_u.x * value_in_plane_u.x + normal_frame_part_2) * xy.x);
    float3 base_normal_map_part = value_in_plane_v * (rsqrt(value_in_plane_v.x * value_in_plane_v.x + normal_frame_part_3) * xy.y);
    float3 bent = normal_map_part + base_normal_map_part + N * z;
    float base_normal_map_part_2 = bent.y * bent.y + (bent.z * bent.z + 1e-32);
    float3 unit = bent * rsqrt(bent.x * bent.x + base_normal_map_part_2);

    // metallic_roughness.texel: glTF 2.0, "Textures"
    float4 metallic_roughness_texel = metallic_roughness_texture.Sample(metallic_roughness_texture_sampler, v_uv0);

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
        float NdotL = clamp(dot(unit, to_light) * inverse_distance, 0.0, 1.0);
        float NdotSum = NdotL + signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 planar = sum - unit * NdotSum;
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
        float3 direct = color.xyz * tinted + white;

        // output
        light_sum += direct * radiance;
    }

    // occlusion: glTF 2.0, "Additional Textures" (occlusion)
    float occlusion = 1.0 + material.occlusion_strength * (metallic_roughness_texel.x - 1.0);

    // emissive.texel: glTF 2.0, "Textures"
    float4 emissive_texel = emissive_texture.Sample(emissive_texture_sampler, v_uv1);

    // emission: glTF 2.0, "Additional Textures" (emissive); KHR_materials_emissive_strength
    float3 emission = material.emissive_factor_times_emissive_strength * emissive_texel.xyz;

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(NdotV, roughness), 0.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"; glTF 2.0,
    float base_facing_2 = 1.0 - split.y;
    float lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    float through = base_facing_2 - lost / 21.0;
    float3 base_color_complement = 1.0 - color.xyz;
    float3 bounces = 1.000001 - lost + base_color_complement * (0.95238096 * lost);
    float clear = dielectric * material.refracted;
    float dielectric_bounces = 1.000001 - lost * material.mean_fresnel;
    float base = clear * (through / dielectric_bounces);
    float grey = metallic * split.x;
    float base_white = (least_f0 + metallic) * split.x;
    float3 base_specular = color.xyz * grey + (least_f0 * split.x + split.y);
    float3 base_spread = clamp(base_color_complement * (grey - base - metallic * through / bounces) + (base_facing_2 - base_white), 0.0, 1.0);
    float3 indirect = base_specular * environment_specular.SampleLevel(environment_specular_sampler, cosines_part * 2.0 * unit - to_eye, roughness * frame.environment_max_lod).xyz + base_spread * environment_irradiance.SampleLevel(environment_irradiance_sampler, bent, 0.0).xyz;

    // output
    out_color = float4(light_sum + indirect * (occlusion * frame.environment_intensity) + emission, 1.0);
}
