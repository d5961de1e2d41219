#version 450
// forward-volume-3cbc4b942deea0550645914bd878b26a
// Lacquer 0.2.0, template forward

layout(std140, set = 0, binding = 0) uniform Frame {
    mat4 view_projection;
    vec3 camera_position;
    float environment_intensity;
    float environment_max_lod;
    int light_count;
} frame;

layout(std140, set = 2, binding = 0) uniform Object {
    mat4 model;
    mat4 normal_matrix;
} object;

layout(std140, set = 1, binding = 0) uniform Material {
    vec3 density;
    float roughness_factor;
    vec3 base_color_factor;
    float f0;
    vec3 tint;
    float roughness;
    vec3 front;
    float thickness_factor;
    vec3 F0;
    float alpha2;
    vec3 metal_repeated;
    float alpha2_ratio;
    float weight_times_ggx_peak;
    float one_minus_f0;
    float behind_alpha2;
    float ggx_peak;
    float behind_alpha2_ratio;
    float complement_root;
    float one_minus_transmission_factor;
    float dielectric;
    float mixed_F90;
    float under_facing;
    float most_mean;
    float inverse_ior;
    float inverse_ior2;
    float most_mean_times_inverse_dielectric;
    float first;
    float metal_first;
} material;

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;

layout(location = 0) out vec3 v_position;
layout(location = 1) out vec3 v_normal;
layout(location = 2) out float v_volume_length;

invariant gl_Position;

void main() {
    // world
    vec4 world = object.model * vec4(in_position, 1.0);

    // normal
    vec4 normal_part = object.normal_matrix * vec4(in_normal, 0.0);
    float normal_part_2 = normal_part.y * normal_part.y + (normal_part.z * normal_part.z + 1e-32);
    vec3 N = normal_part.xyz * inversesqrt(normal_part.x * normal_part.x + normal_part_2);

    // thickness_scale
    vec4 thickness_scale_part = object.model * vec4(1.0, 0.0, 0.0, 0.0);
    vec4 thickness_scale_part_2 = object.model * vec4(0.0, 1.0, 0.0, 0.0);
    vec4 thickness_scale_part_3 = object.model * vec4(0.0, 0.0, 1.0, 0.0);
    float thickness_scale_part_4 = length(thickness_scale_part.xyz) + length(thickness_scale_part_2.xyz) + length(thickness_scale_part_3.xyz);

    // output
    gl_Position = frame.view_projection * world;

    // position
    v_position = world.xyz;

    // normal
    v_normal = N;

    // volume.length: KHR_materials_volume, "Properties" (thickness is in the mesh's space)
    v_volume_length = material.thickness_factor * (thickness_scale_part_4 / 3.0);
}
