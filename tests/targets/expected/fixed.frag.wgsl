// Printed by the tests.

struct Light {
    direction: vec3f,
    range: f32,
    color: vec3f,
    lacquer_type: i32,
}

@group(0) @binding(2) var<uniform> lights: array<Light, 16>;

struct FragmentOutputs {
    @location(0) out_first: vec4f,
    @location(1) out_second: vec4f,
}

@fragment
fn main(
    @location(0) v_uv: vec2f,
    @location(1) v_weight: f32,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    // alpha.mask: glTF 2.0, "Alpha Coverage"
    if (v_weight < 0.5) {
        discard;
    }

    // odd name/: a line that must not continue /
    out_stage.out_first = vec4f(v_uv + v_weight, vec2f(1.0));
    out_stage.out_second = vec4f(lights[2].color * v_weight, 1e-7);

    return out_stage;
}
