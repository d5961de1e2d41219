// forward-base-d9e8d6b8320377db90ea68980cde58e7
// Lacquer 0.2.0, template forward

struct Material {
    base_color_factor: vec4f,
}

@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(2) var base_color_texture: texture_2d<f32>;
@group(1) @binding(3) var base_color_texture_sampler: sampler;

struct FragmentOutputs {
    @location(0) out_color: vec4f,
}

@fragment
fn main(
    @location(0) v_uv0: vec2f,
    @location(1) v_COLOR_0: vec4f,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    // color0
    let color0 = clamp(v_COLOR_0, vec4f(0.0), vec4f(1.0));

    // base_color.texel: glTF 2.0, "Textures"
    let texel = textureSample(base_color_texture, base_color_texture_sampler, v_uv0);

    // base.color: glTF 2.0, "Metallic-Roughness Material"
    let color = material.base_color_factor * texel * color0;

    // output
    out_stage.out_color = vec4f(color.xyz, 1.0);

    return out_stage;
}
