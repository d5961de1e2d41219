#version 450
// forward-coat-dec7fe4855cd503b639d3ab1ca84508d
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

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_tangent;
layout(location = 3) in vec2 in_texcoord_0;

layout(location = 0) out vec3 v_position;
layout(location = 1) out vec3 v_normal;
layout(location = 2) out vec4 v_tangent;
layout(location = 3) out vec2 v_uv0;

invariant gl_Position;

void main() {
    // world
    vec4 world = object.model * vec4(in_position, 1.0);

    // normal
    vec4 normal_part = object.normal_matrix * vec4(in_normal, 0.0);
    float normal_part_2 = normal_part.y * normal_part.y + (normal_part.z * normal_part.z + 1e-32);
    vec3 N = normal_part.xyz * inversesqrt(normal_part.x * normal_part.x + normal_part_2);

    // tangent
    vec4 tangent_part = object.model * vec4(in_tangent.xyz, 0.0);
    float tangent_part_2 = tangent_part.y * tangent_part.y + (tangent_part.z * tangent_part.z + 1e-32);
    vec3 tangent_N = tangent_part.xyz * inversesqrt(tangent_part.x * tangent_part.x + tangent_part_2);

    // output
    gl_Position = frame.view_projection * world;

    // position
    v_position = world.xyz;

    // normal
    v_normal = N;

    // tangent
    v_tangent = vec4(tangent_N, in_tangent.w);
    v_uv0 = in_texcoord_0;
}
