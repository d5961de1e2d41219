// forward-coat-12c10870bbeaa4391d526f62685f5162
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

struct VertexOutputs {
    @builtin(position) @invariant position: vec4f,
    @location(0) v_position: vec3f,
    @location(1) v_normal: vec3f,
    @location(2) v_uv0: vec2f,
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

    // output
    out_stage.position = frame.view_projection * world;

    // position
    out_stage.v_position = world.xyz;

    // normal
    out_stage.v_normal = N;
    out_stage.v_uv0 = in_texcoord_0;

    return out_stage;
}
