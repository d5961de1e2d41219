// Printed by the tests.

struct Frame {
    view_projection: mat4x4f,
    camera_position: vec3f,
    light_count: i32,
    exposure: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

struct Object {
    model: mat4x4f,
}

@group(2) @binding(0) var<uniform> object: Object;

struct VertexOutputs {
    @builtin(position) @invariant position: vec4f,
    @location(0) v_position: vec3f,
    @location(1) v_normal: vec3f,
    @location(2) v_uv: vec2f,
}

@vertex
fn main(
    @location(0) in_position: vec3f,
    @location(1) in_normal: vec3f,
    @location(2) in_texcoord_0: vec2f,
) -> VertexOutputs {
    var out_stage: VertexOutputs;

    // vertex.position
    let world_position = object.model * vec4f(in_position, 1.0);

    out_stage.position = frame.view_projection * world_position;
    out_stage.v_position = world_position.xyz;
    out_stage.v_normal = in_normal;
    out_stage.v_uv = in_texcoord_0;

    return out_stage;
}
