// Printed by the tests.

struct Frame {
    view_projection: mat4x4f,
    camera_position: vec3f,
    light_count: i32,
    exposure: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

struct Light {
    direction: vec3f,
    range: f32,
    color: vec3f,
    lacquer_type: i32,
}

@group(0) @binding(2) var<uniform> lights: array<Light, 16>;

struct Material {
    base_color: vec3f,
    roughness: f32,
    uv_scale: vec2f,
}

@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(2) var base_color_texture: texture_2d<f32>;
@group(1) @binding(3) var base_color_texture_sampler: sampler;
@group(0) @binding(4) var environment_texture: texture_cube<f32>;
@group(0) @binding(5) var environment_texture_sampler: sampler;

struct FragmentOutputs {
    @location(0) out_color: vec4f,
}

@fragment
fn main(
    @location(0) v_position: vec3f,
    @location(1) v_normal: vec3f,
    @location(2) v_uv: vec2f,
    @builtin(front_facing) in_front_facing: bool,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    // surface.normal: glTF 2.0, "Double Sided"
    let unit_normal = normalize(v_normal);
    let normal = select(-unit_normal, unit_normal, in_front_facing);

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    let color_part = textureSample(base_color_texture, base_color_texture_sampler, v_uv * material.uv_scale);
    let base_color = color_part.xyz * material.base_color;

    // base.lambert: glTF 2.0, B.3.1
    var direct = vec3f(0.0);
    for (var i = 0; i < min(frame.light_count, 16); i++) {
        let n_dot_l = max(0.0, dot(normal, lights[i].direction));
        direct += base_color * lights[i].color * (n_dot_l * select(1.0, lights[i].range, lights[i].lacquer_type == 1i));
    }

    // environment.specular
    let specular_part = vec4f((direct + textureSampleLevel(environment_texture, environment_texture_sampler, normalize(frame.camera_position - v_position), material.roughness * 8.0).xyz) * frame.exposure, color_part.w);

    out_stage.out_color = specular_part;

    return out_stage;
}
