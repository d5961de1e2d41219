// forward-coat-7130ba43ba0454a30d51e12e6cfd0609
// Lacquer 0.2.0, template forward

struct Frame {
    view_projection: mat4x4f,
    camera_position: vec3f,
    environment_intensity: f32,
    environment_max_lod: f32,
    light_count: i32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

struct Object {
    model: mat4x4f,
    normal_matrix: mat4x4f,
}

@group(2) @binding(0) var<uniform> object: Object;

struct Material {
    emissive_factor: vec3f,
    metallic_factor: f32,
    coat_color_factor: vec3f,
    roughness_factor: f32,
    base_color_factor: vec3f,
    coat_factor: f32,
    base_color_complement: vec3f,
    coat_roughness_factor: f32,
    metal_repeated: vec3f,
    row_u_x: f32,
    F0: vec3f,
    row_u_y: f32,
    row_v_x: f32,
    row_v_y: f32,
    coat_color_uv_offset_x: f32,
    coat_color_uv_offset_y: f32,
    coat_factor_times_0_96: f32,
    coat_factor_times_0_04: f32,
    alpha2: f32,
    alpha2_ratio: f32,
    weight_times_ggx_peak: f32,
    coat_alpha2: f32,
    coat_alpha2_ratio: f32,
    coat_weight_times_ggx_peak: f32,
    lambert: f32,
    least_f0: f32,
    inverse_metallic: f32,
    inverse_clear: f32,
    dielectric_repeated: f32,
    white_F0: f32,
}

@group(1) @binding(0) var<uniform> material: Material;

struct VertexOutputs {
    @builtin(position) position: vec4f,
    @location(0) v_position: vec3f,
    @location(1) v_normal: vec3f,
    @location(2) v_uv: vec2f,
}

@vertex
fn main(
    @location(0) in_position: vec3f,
    @location(1) in_normal: vec3f,
    @location(3) in_texcoord_0: vec2f,
) -> VertexOutputs {
    var out_stage: VertexOutputs;

    // world
    let world = object.model * vec4f(in_position, 1.0);

    // normal
    let normal_part = object.normal_matrix * vec4f(in_normal, 0.0);
    let normal_part_2 = normal_part.y * normal_part.y + (normal_part.z * normal_part.z + 1e-32);
    let N = normal_part.xyz * inverseSqrt(normal_part.x * normal_part.x + normal_part_2);

    // coat_color.uv: KHR_texture_transform, "Overview"
    let uv = vec2f(material.row_u_x * in_texcoord_0.x + material.row_u_y * in_texcoord_0.y + material.coat_color_uv_offset_x, material.row_v_y * in_texcoord_0.y - material.row_v_x * in_texcoord_0.x + material.coat_color_uv_offset_y);

    // output
    out_stage.position = frame.view_projection * world;

    // position
    out_stage.v_position = world.xyz;

    // normal
    out_stage.v_normal = N;

    // coat_color.uv: KHR_texture_transform, "Overview"
    out_stage.v_uv = uv;

    return out_stage;
}
