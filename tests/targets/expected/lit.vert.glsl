#version 450
// Printed by the tests.

layout(std140, set = 0, binding = 0) uniform Frame {
    mat4 view_projection;
    vec3 camera_position;
    int light_count;
    float exposure;
} frame;

layout(std140, set = 2, binding = 0) uniform Object {
    mat4 model;
} object;

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec2 in_texcoord_0;

layout(location = 0) out vec3 v_position;
layout(location = 1) out vec3 v_normal;
layout(location = 2) out vec2 v_uv;

invariant gl_Position;

void main() {
    // vertex.position
    vec4 world_position = object.model * vec4(in_position, 1.0);

    gl_Position = frame.view_projection * world_position;
    v_position = world_position.xyz;
    v_normal = in_normal;
    v_uv = in_texcoord_0;
}
