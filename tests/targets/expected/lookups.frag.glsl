#version 450
// Printed by the tests.

layout(set = 1, binding = 1) uniform sampler2D map;
layout(set = 0, binding = 2) uniform samplerCube around;
layout(set = 0, binding = 3) uniform sampler2DShadow depths;
layout(set = 0, binding = 4) uniform sampler2DArray tiles;
layout(set = 0, binding = 5) uniform sampler3D volume;

layout(location = 0) in vec2 v_uv;
layout(location = 1) in vec3 v_way;

layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_weight;
layout(location = 2) out vec2 out_place;
layout(location = 3) out int out_texels;
layout(location = 4) out uint out_bits;

void main() {
    vec2 dFdx_2 = dFdx(v_uv);
    vec2 dFdy_2 = dFdy(v_uv);
    vec4 of_map = textureGrad(map, v_uv, dFdx_2, dFdy_2);
    int to_int = int(v_uv.x);
    vec3 dFdx_3 = dFdx(v_way);
    vec3 dFdy_3 = dFdy(v_way);
    vec4 of_around = textureGrad(around, v_way, dFdx_3, dFdy_3);
    int whole_add = textureSize(map, to_int).x + textureSize(map, 0).y + textureSize(around, to_int).x + textureSize(around, 0).y + textureSize(depths, to_int).x;
    vec4 of_tiles = textureGrad(tiles, v_way, dFdx_2, dFdy_2);
    int whole_add_2 = whole_add + textureSize(depths, 0).y + textureSize(tiles, to_int).x + textureSize(tiles, 0).y + textureSize(tiles, 0).z;
    vec4 of_volume = textureGrad(volume, v_way, dFdx_3, dFdy_3);
    int whole_add_3 = whole_add_2 + textureSize(volume, to_int).x + textureSize(volume, 0).y + textureSize(volume, 0).z;

    out_color = of_map + of_around + of_tiles + of_volume;
    out_weight = v_uv.y;
    out_place = v_uv;
    out_texels = whole_add_3;
    out_bits = uint(whole_add_3);
    gl_FragDepth = clamp(v_way.z, 0.0, 1.0);
}
