// forward-coat-e340620611b392d53de6f9bd184a0a8c
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
    float3 emissive_factor;
    float metallic_factor;
    float3 base_color_factor;
    float roughness_factor;
    float3 base_color_complement;
    float coat_roughness_factor;
    float3 metal_repeated;
    float coat_normal_scale;
    float3 F0;
    float coat_factor_times_0_96;
    float coat_factor_times_0_04;
    float alpha2;
    float alpha2_ratio;
    float weight_times_ggx_peak;
    float coat_alpha2;
    float coat_alpha2_ratio;
    float coat_weight_times_ggx_peak;
    float lambert;
    float least_f0;
    float inverse_metallic;
    float inverse_clear;
    float dielectric_repeated;
    float white_F0;
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
Texture2D normal_texture : register(t3);
SamplerState normal_texture_sampler : register(s3);
Texture2D coat_normal_texture : register(t4);
SamplerState coat_normal_texture_sampler : register(s4);

void main(
    float3 v_position : TEXCOORD0,
    float3 v_normal : TEXCOORD1,
    float2 v_uv0 : TEXCOORD2,
    out float4 out_color : SV_Target0) {
    // view: glTF 2.0, Appendix B, "Overview"
    float3 to_eye = frame.camera_position - v_position;
    float view_part = to_eye.y * to_eye.y + (to_eye.z * to_eye.z + 1e-32);
    float view_part_2 = rsqrt(to_eye.x * to_eye.x + view_part);
    float3 V = to_eye * view_part_2;

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
    float3 T = value_in_plane_u * rsqrt(value_in_plane_u.x * value_in_plane_u.x + normal_frame_part_2);
    float normal_frame_part_3 = value_in_plane_v.y * value_in_plane_v.y + (value_in_plane_v.z * value_in_plane_v.z + 1e-32);
    float3 B = value_in_plane_v * rsqrt(value_in_plane_v.x * value_in_plane_v.x + normal_frame_part_3);

    // normal.texel: glTF 2.0, "Textures"
    float4 texel = normal_texture.Sample(normal_texture_sampler, v_uv0);

    // base.normal_map: glTF 2.0, "Additional Textures" (normal)
    float2 xy = texel.xy * 2.0 - 1.0;
    float z = max(texel.z * 2.0 - 1.0, 1e-14);
    float3 bent = T * xy.x + B * xy.y + N * z;
    float normal_map_part = bent.y * bent.y + (bent.z * bent.z + 1e-32);
    float3 unit = bent * rsqrt(bent.x * bent.x + normal_map_part);

    // coat_normal.texel: glTF 2.0, "Textures"
    float4 coat_normal_texel = coat_normal_texture.Sample(coat_normal_texture_sampler, v_uv0);

    // coat.normal_map: glTF 2.0, "Additional Textures" (normal)
    float2 coat_xy = coat_normal_texel.xy * 2.0 - 1.0;
    float coat_z = max(coat_normal_texel.z * 2.0 - 1.0, 1e-14);
    float3 coat_bent = T * (coat_xy.x * material.coat_normal_scale) + B * (coat_xy.y * material.coat_normal_scale) + N * coat_z;
    float coat_normal_map_part = coat_bent.y * coat_bent.y + (coat_bent.z * coat_bent.z + 1e-32);
    float3 coat_unit = coat_bent * rsqrt(coat_bent.x * coat_bent.x + coat_normal_map_part);

    // coat.view_cosine: KHR_materials_clearcoat, "Layering"
    float view_cosine_part = dot(coat_unit, to_eye);
    float signed_NdotV = view_cosine_part * view_part_2;
    float view_cosine = abs(view_cosine_part) * view_part_2;

    // coat.fresnel: glTF 2.0, Appendix B, "Fresnel"; Schlick 1994
    float c = 1.0 - view_cosine;
    float c2 = c * c;

    // emission.transmission: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
    float reflectance = material.coat_factor_times_0_04 + material.coat_factor_times_0_96 * (c2 * c2 * abs(c));
    float transmission_part = clamp(1.0 - reflectance, 0.0, 1.0);

    // base.cosines: glTF 2.0, Appendix B, "Specular BRDF"
    float cosines_part = dot(unit, to_eye);
    float base_signed_NdotV = cosines_part * view_part_2;
    float NdotV = abs(cosines_part) * view_part_2;

    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float masked_view = sqrt(material.alpha2_ratio + NdotV * NdotV);

    // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    float coat_masked_view = sqrt(material.coat_alpha2_ratio + view_cosine * view_cosine);

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
        float NdotL = clamp(dot(unit, L), 0.0, 1.0);
        float NdotSum = NdotL + base_signed_NdotV;

        // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 planar = sum - unit * NdotSum;
        float planar2 = dot(planar, planar);
        float spread = planar2 + material.alpha2 * (NdotSum * NdotSum);
        float length22 = length2 * length2;
        float facing = 0.0 < NdotSum ? length22 : 0.0;
        float denominator = spread * spread;

        // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float masked_light = sqrt(material.alpha2_ratio + NdotL * NdotL);
        float base_sum = NdotL * masked_view + NdotV * masked_light;

        // base.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float specular = material.weight_times_ggx_peak * facing / (denominator * base_sum + 3e-32);

        // coat.cosines: glTF 2.0, Appendix B, "Specular BRDF"
        float coat_NdotL = clamp(dot(coat_unit, L), 0.0, 1.0);
        float coat_NdotSum = coat_NdotL + signed_NdotV;

        // coat.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
        float3 coat_planar = sum - coat_unit * coat_NdotSum;
        float coat_planar2 = dot(coat_planar, coat_planar);
        float coat_spread = coat_planar2 + material.coat_alpha2 * (coat_NdotSum * coat_NdotSum);
        float coat_facing = 0.0 < coat_NdotSum ? length22 : 0.0;
        float coat_denominator = coat_spread * coat_spread;

        // coat.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
        float coat_masked_light = sqrt(material.coat_alpha2_ratio + coat_NdotL * coat_NdotL);
        float coat_sum = coat_NdotL * coat_masked_view + view_cosine * coat_masked_light;

        // coat.specular: glTF 2.0, Appendix B, "Specular BRDF" (V D)
        float coat_specular = material.coat_weight_times_ggx_peak * coat_facing / (coat_denominator * coat_sum + 3e-32);

        // coat.transmission_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        float reflected = coat_NdotL * reflectance;
        float transmitted = NdotL * transmission_part;

        // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
        float base_c = 1.0 - VdotH;
        float base_c2 = base_c * base_c;
        float weight = base_c2 * base_c2 * base_c;
        float glancing = weight * transmitted;
        float base_facing = transmitted - glancing;
        float tinted = base_facing * (material.lambert + material.metallic_factor * specular);
        float white = specular * (base_facing * material.least_f0 + glancing);

        // coat.layer_direct: KHR_materials_coat, "Layering"; KHR_materials_clearcoat, "Layering"
        float3 layer_direct = material.base_color_factor * tinted + (white + coat_specular * reflected);

        // output
        light_sum += layer_direct * radiance;
    }

    // emission.coated: KHR_materials_clearcoat, "Emission"; EXT_materials_clearcoat_color, "Implementation"
    float3 coated = material.emissive_factor * transmission_part;

    // base.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(NdotV, material.roughness_factor), 0.0);

    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    float base_facing_2 = 1.0 - split.y;
    float lost = clamp(base_facing_2 - split.x, 0.0, 1.0);
    float through = base_facing_2 - lost / 21.0;
    float3 bounces = material.inverse_metallic - material.metal_repeated * lost;
    float dielectric_bounces = material.inverse_clear - material.dielectric_repeated * lost;
    float3 base_specular = material.F0 * split.x + split.y;
    float grey = material.metallic_factor * split.x - through / dielectric_bounces;
    float3 base_spread = clamp(material.base_color_complement * (grey - through / bounces) + (base_facing_2 - material.white_F0 * split.x), 0.0, 1.0);
    float3 indirect = base_specular * environment_specular.SampleLevel(environment_specular_sampler, cosines_part * 2.0 * unit - to_eye, material.roughness_factor * frame.environment_max_lod).xyz + base_spread * environment_irradiance.SampleLevel(environment_irradiance_sampler, bent, 0.0).xyz;

    // coat.environment_brdf: Karis 2013, "Real Shading in Unreal Engine 4" (split sum); glTF 2.0, Appendix B, "Specular BRDF"
    float4 coat_split = environment_dfg.SampleLevel(environment_dfg_sampler, float2(view_cosine, material.coat_roughness_factor), 0.0);

    // output
    float3 output_part = environment_specular.SampleLevel(environment_specular_sampler, view_cosine_part * 2.0 * coat_unit - to_eye, material.coat_roughness_factor * frame.environment_max_lod).xyz * ((coat_split.x + coat_split.y) * reflectance * frame.environment_intensity);

    out_color = float4(light_sum + (indirect * (transmission_part * frame.environment_intensity) + output_part) + coated, 1.0);
}
