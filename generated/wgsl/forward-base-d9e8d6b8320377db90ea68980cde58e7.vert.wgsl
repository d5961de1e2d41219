// forward-base-d9e8d6b8320377db90ea68980cde58e7
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
    @builtin(position) position: vec4f,
    @location(0) v_uv0: vec2f,
    @location(1) v_COLOR_0: vec4f,
}

@vertex
fn main(
    @location(0) in_position: vec3f,
    @location(3) in_texcoord_0: vec2f,
    @location(7) in_color_0: vec4f,
) -> VertexOutputs {
    var out_stage: VertexOutputs;

    // world
    let world = object.model * vec4f(in_position, 1.0);

    // output
    out_stage.position = frame.view_projection * world;
    out_stage.v_uv0 = in_texcoord_0;
    out_stage.v_COLOR_0 = in_color_0;

    return out_stage;
}
