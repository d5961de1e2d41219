// forward-volume-3cbc4b942deea0550645914bd878b26a
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
    density: vec3f,
    roughness_factor: f32,
    base_color_factor: vec3f,
    f0: f32,
    tint: vec3f,
    roughness: f32,
    front: vec3f,
    thickness_factor: f32,
    F0: vec3f,
    alpha2: f32,
    metal_repeated: vec3f,
    alpha2_ratio: f32,
    weight_times_ggx_peak: f32,
    one_minus_f0: f32,
    behind_alpha2: f32,
    ggx_peak: f32,
    behind_alpha2_ratio: f32,
    complement_root: f32,
    one_minus_transmission_factor: f32,
    dielectric: f32,
    mixed_F90: f32,
    under_facing: f32,
    most_mean: f32,
    inverse_ior: f32,
    inverse_ior2: f32,
    most_mean_times_inverse_dielectric: f32,
    first: f32,
    metal_first: f32,
}

@group(1) @binding(0) var<uniform> material: Material;

struct VertexOutputs {
    @builtin(position) @invariant position: vec4f,
    @location(0) v_position: vec3f,
    @location(1) v_normal: vec3f,
    @location(2) v_volume_length: f32,
}

@vertex
fn main(
    @location(0) in_position: vec3f,
    @location(1) in_normal: vec3f,
) -> VertexOutputs {
    var out_stage: VertexOutputs;

    // world
    let world = object.model * vec4f(in_position, 1.0);

    // normal
    let normal_part = object.normal_matrix * vec4f(in_normal, 0.0);
    let normal_part_2 = normal_part.y * normal_part.y + (normal_part.z * normal_part.z + 1e-32);
    let N = normal_part.xyz * inverseSqrt(normal_part.x * normal_part.x + normal_part_2);

    // thickness_scale
    let thickness_scale_part = object.model * vec4f(1.0, 0.0, 0.0, 0.0);
    let thickness_scale_part_2 = object.model * vec4f(0.0, 1.0, 0.0, 0.0);
    let thickness_scale_part_3 = object.model * vec4f(0.0, 0.0, 1.0, 0.0);
    let thickness_scale_part_4 = length(thickness_scale_part.xyz) + length(thickness_scale_part_2.xyz) + length(thickness_scale_part_3.xyz);

    // output
    out_stage.position = frame.view_projection * world;

    // position
    out_stage.v_position = world.xyz;

    // normal
    out_stage.v_normal = N;

    // volume.length: KHR_materials_volume, "Properties" (thickness is in the mesh's space)
    out_stage.v_volume_length = material.thickness_factor * (thickness_scale_part_4 / 3.0);

    return out_stage;
}
