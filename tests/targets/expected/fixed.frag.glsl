#version 450
// Printed by the tests.

struct Light {
    vec3 direction;
    float range;
    vec3 color;
    int type;
};

layout(std140, set = 0, binding = 1) uniform Lights {
    Light lights[16];
};

layout(location = 0) in vec2 v_uv;
layout(location = 1) in float v_weight;

layout(location = 0) out vec4 out_first;
layout(location = 1) out vec4 out_second;

void main() {
    // alpha.mask: glTF 2.0, "Alpha Coverage"
    if (v_weight < 0.5) {
        discard;
    }

    // odd name/: a line that must not continue /
    out_first = vec4(v_uv + v_weight, vec2(1.0));
    out_second = vec4(lights[2].color * v_weight, 1e-7);
}
