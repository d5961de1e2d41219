#version 450
// forward-coat-bdba8852b5a24866
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
    vec3 F0;
    float roughness_factor;
    vec3 diffuse;
    float coat_factor;
    vec3 emissive_factor;
    float coat_roughness_factor;
    vec3 coat_color_factor;
    float uu;
    vec3 lambert;
    float uv;
    vec3 mean_fresnel;
    float vu;
    vec3 base_indirect;
    float vv;
    float coat_color_uv_offset;
    float coat_color_uv_offset_2;
    float emission_transmission;
    float emission_transmission_2;
    float alpha2;
    float ratio;
    float base_specular;
    float coat_alpha2;
    float coat_ratio;
    float coat_specular;
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
    vec2 uv = vec2(material.uu * in_texcoord_0.x + material.uv * in_texcoord_0.y + material.coat_color_uv_offset, material.vv * in_texcoord_0.y - material.vu * in_texcoord_0.x + material.coat_color_uv_offset_2);

    // output
    gl_Position = frame.view_projection * world;

    // position
    v_position = world.xyz;

    // normal
    v_normal = N;

    // coat_color.uv: KHR_texture_transform, "Overview"
    v_uv = uv;
}
