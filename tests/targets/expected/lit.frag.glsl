#version 450
// Printed by the tests.

layout(std140, set = 0, binding = 0) uniform Frame {
    mat4 view_projection;
    vec3 camera_position;
    int light_count;
    float exposure;
} frame;

struct Light {
    vec3 direction;
    float range;
    vec3 color;
    int type;
};

layout(std140, set = 0, binding = 1) uniform Lights {
    Light lights[16];
};

layout(std140, set = 1, binding = 0) uniform Material {
    vec3 base_color;
    float roughness;
    vec2 uv_scale;
} material;

layout(set = 1, binding = 1) uniform sampler2D base_color_texture;
layout(set = 0, binding = 2) uniform samplerCube environment_texture;

layout(location = 0) in vec3 v_position;
layout(location = 1) in vec3 v_normal;
layout(location = 2) in vec2 v_uv;

layout(location = 0) out vec4 out_color;

void main() {
    // surface.normal: glTF 2.0, "Double Sided"
    vec3 unit_normal = normalize(v_normal);
    vec3 normal = gl_FrontFacing ? unit_normal : -unit_normal;

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    vec4 color_part = texture(base_color_texture, v_uv * material.uv_scale);
    vec3 base_color = color_part.xyz * material.base_color;

    // base.lambert: glTF 2.0, B.3.1
    vec3 direct = vec3(0.0);
    for (int i = 0; i < frame.light_count; ++i) {
        float n_dot_l = max(0.0, dot(normal, lights[i].direction));
        direct += base_color * lights[i].color * (n_dot_l * (lights[i].type == 1 ? lights[i].range : 1.0));
    }

    // environment.specular
    vec4 specular_part = vec4((direct + textureLod(environment_texture, normalize(frame.camera_position - v_position), material.roughness * 8.0).xyz) * frame.exposure, color_part.w);

    out_color = specular_part;
}
