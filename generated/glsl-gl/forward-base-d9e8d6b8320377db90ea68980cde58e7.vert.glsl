#version 450
// forward-base-d9e8d6b8320377db90ea68980cde58e7
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

layout(location = 0) in vec3 in_position;
layout(location = 3) in vec2 in_texcoord_0;
layout(location = 7) in vec4 in_color_0;

layout(location = 0) out vec2 v_uv0;
layout(location = 1) out vec4 v_COLOR_0;

void main() {
    // world
    vec4 world = object.model * vec4(in_position, 1.0);

    // output
    gl_Position = frame.view_projection * world;
    v_uv0 = in_texcoord_0;
    v_COLOR_0 = in_color_0;
}
