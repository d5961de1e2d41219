#version 300 es
// forward-base-90635bb95589462632851765a0f686df
// Lacquer 0.2.0, template forward

precision highp float;
precision highp int;

layout(std140) uniform Frame {
    mat4 view_projection;
    vec3 camera_position;
    float environment_intensity;
    float environment_max_lod;
    int light_count;
} frame;

layout(std140) uniform Object {
    mat4 model;
    mat4 normal_matrix;
} object;

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 7) in vec4 in_color_0;

out vec3 v_position;
out vec3 v_normal;
out vec4 v_COLOR_0;

invariant gl_Position;

void main() {
    // world
    vec4 world = object.model * vec4(in_position, 1.0);

    // normal
    vec4 normal_part = object.normal_matrix * vec4(in_normal, 0.0);
    float normal_part_2 = normal_part.y * normal_part.y + (normal_part.z * normal_part.z + 1e-32);
    vec3 N = normal_part.xyz * inversesqrt(normal_part.x * normal_part.x + normal_part_2);

    // output
    gl_Position = frame.view_projection * world;

    // position
    v_position = world.xyz;

    // normal
    v_normal = N;
    v_COLOR_0 = in_color_0;
}
