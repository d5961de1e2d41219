// Printed by the tests.

@group(1) @binding(2) var map: texture_2d<f32>;
@group(1) @binding(3) var map_sampler: sampler;
@group(0) @binding(4) var around: texture_cube<f32>;
@group(0) @binding(5) var around_sampler: sampler;
@group(0) @binding(6) var depths: texture_depth_2d;
@group(0) @binding(7) var depths_sampler: sampler_comparison;
@group(0) @binding(8) var tiles: texture_2d_array<f32>;
@group(0) @binding(9) var tiles_sampler: sampler;
@group(0) @binding(10) var volume: texture_3d<f32>;
@group(0) @binding(11) var volume_sampler: sampler;

struct FragmentOutputs {
    @location(0) out_color: vec4f,
    @location(1) out_weight: f32,
    @location(2) out_place: vec2f,
    @location(3) out_texels: i32,
    @location(4) out_bits: u32,
    @builtin(frag_depth) out_nearness: f32,
}

@fragment
fn main(
    @location(0) v_uv: vec2f,
    @location(1) v_way: vec3f,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    let dFdx_2 = dpdx(v_uv);
    let dFdy_2 = dpdy(v_uv);
    let of_map = textureSampleGrad(map, map_sampler, v_uv, dFdx_2, dFdy_2);
    let to_int = i32(v_uv.x);
    let dFdx_3 = dpdx(v_way);
    let dFdy_3 = dpdy(v_way);
    let of_around = textureSampleGrad(around, around_sampler, v_way, dFdx_3, dFdy_3);
    let whole_add = i32(textureDimensions(map, to_int).x) + i32(textureDimensions(map, 0i).y) + i32(textureDimensions(around, to_int).x) + i32(textureDimensions(around, 0i).y) + i32(textureDimensions(depths, to_int).x);
    let of_tiles = textureSampleGrad(tiles, tiles_sampler, v_way.xy, i32(floor(v_way.z + 0.5)), dFdx_2, dFdy_2);
    let whole_add_2 = whole_add + i32(textureDimensions(depths, 0i).y) + i32(textureDimensions(tiles, to_int).x) + i32(textureDimensions(tiles, 0i).y) + i32(textureNumLayers(tiles));
    let of_volume = textureSampleGrad(volume, volume_sampler, v_way, dFdx_3, dFdy_3);
    let whole_add_3 = whole_add_2 + i32(textureDimensions(volume, to_int).x) + i32(textureDimensions(volume, 0i).y) + i32(textureDimensions(volume, 0i).z);

    out_stage.out_color = of_map + of_around + of_tiles + of_volume;
    out_stage.out_weight = v_uv.y;
    out_stage.out_place = v_uv;
    out_stage.out_texels = whole_add_3;
    out_stage.out_bits = u32(whole_add_3);
    out_stage.out_nearness = clamp(v_way.z, 0.0, 1.0);

    return out_stage;
}
