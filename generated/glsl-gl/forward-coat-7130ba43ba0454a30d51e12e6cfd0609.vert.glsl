#version 450
// forward-coat-7130ba43ba0454a30d51e12e6cfd0609
// Lacquer 0.2.0, template forward

layout(std140, binding = 0) uniform Frame {
    mat4 view_projection;
    vec3 camera_position;
    float environment_intensity;
    float environment_max_lod;
    int light_count;
} frame;

layout(std140, binding = 3) uniform Object {
    mat4 model;
    mat4 normal_matrix;
} object;

layout(std140, binding = 2) uniform Material {
    vec3 emissive_factor;
    float metallic_factor;
    vec3 coat_color_factor;
    float roughness_factor;
    vec3 base_color_factor;
    float coat_factor;
    vec3 base_color_complement;
    float coat_roughness_factor;
    vec3 metal_repeated;
    float row_u_x;
    vec3 F0;
    float row_u_y;
    float row_v_x;
    float row_v_y;
    float coat_color_uv_offset_x;
    float coat_color_uv_offset_y;
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
} material;

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 3) in vec2 in_texcoord_0;

layout(location = 0) out vec3 v_position;
layout(location = 1) out vec3 v_normal;
layout(location = 2) out vec2 v_uv;

void main() {
    // world
    vec4 world = object.model * vec4(in_position, 1.0);

    // normal
    vec4 normal_part = object.normal_matrix * vec4(in_normal, 0.0);
    float normal_part_2 = normal_part.y * normal_part.y + (normal_part.z * normal_part.z + 1e-32);
    vec3 N = normal_part.xyz * inversesqrt(normal_part.x * normal_part.x + normal_part_2);

    // coat_color.uv: KHR_texture_transform, "Overview"
    vec2 uv = vec2(material.row_u_x * in_texcoord_0.x + material.row_u_y * in_texcoord_0.y + material.coat_color_uv_offset_x, material.row_v_y * in_texcoord_0.y - material.row_v_x * in_texcoord_0.x + material.coat_color_uv_offset_y);

    // output
    gl_Position = frame.view_projection * world;

    // position
    v_position = world.xyz;

    // normal
    v_normal = N;

    // coat_color.uv: KHR_texture_transform, "Overview"
    v_uv = uv;
}
