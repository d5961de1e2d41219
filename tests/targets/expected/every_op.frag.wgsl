// Printed by the tests.

struct FragmentOutputs {
    @location(0) out_color: vec4f,
}

@fragment
fn main(
    @location(0) v_x: vec4f,
    @location(1) v_v3: vec3f,
) -> FragmentOutputs {
    var out_stage: FragmentOutputs;

    let abs_0_value = abs(v_x.w);
    let abs_1_value = abs(v_v3);
    let sign_0_value = sign(v_x.w);
    let add = vec3f(0.25, 0.5, 1.0) - v_x.w - v_v3 - v_v3 + abs_0_value + abs_1_value + abs_1_value + sign_0_value;
    let sign_1_value = sign(v_v3);
    let floor_0_value = floor(v_x.w);
    let floor_1_value = floor(v_v3);
    let fract_0_value = fract(v_x.w);
    let fract_1_value = fract(v_v3);
    let add_2 = add + sign_1_value + sign_1_value + floor_0_value + floor_1_value + floor_1_value + fract_0_value + fract_1_value + fract_1_value;
    let sqrt_0_value = sqrt(v_x.w);
    let sqrt_1_value = sqrt(v_v3);
    let inversesqrt_0_value = inverseSqrt(v_x.w);
    let inversesqrt_1_value = inverseSqrt(v_v3);
    let exp2_0_value = exp2(v_x.w);
    let exp2_1_value = exp2(v_v3);
    let add_3 = add_2 + sqrt_0_value + sqrt_1_value + sqrt_1_value + inversesqrt_0_value + inversesqrt_1_value + inversesqrt_1_value + exp2_0_value + exp2_1_value;
    let log2_0_value = log2(v_x.w);
    let log2_1_value = log2(v_v3);
    let exp_0_value = exp(v_x.w);
    let exp_1_value = exp(v_v3);
    let log_0_value = log(v_x.w);
    let add_4 = add_3 + exp2_1_value + log2_0_value + log2_1_value + log2_1_value + exp_0_value + exp_1_value + exp_1_value + log_0_value;
    let log_1_value = log(v_v3);
    let sin_0_value = sin(v_x.w);
    let sin_1_value = sin(v_v3);
    let cos_0_value = cos(v_x.w);
    let cos_1_value = cos(v_v3);
    let add_5 = add_4 + log_1_value + log_1_value + sin_0_value + sin_1_value + sin_1_value + cos_0_value + cos_1_value + cos_1_value;
    let acos_0_value = acos(v_x.w);
    let acos_1_value = acos(v_v3);
    let add_0_value = v_x.w + v_x.z;
    let add_1_value = v_v3 + v_x.z;
    let add_1_literal = v_v3 + 0.4;
    let add_2_value = v_x.w + v_v3.yzx;
    let add_2_literal = 0.3 + v_v3.yzx;
    let add_6 = add_5 + acos_0_value + acos_1_value + acos_1_value + add_0_value + add_1_value + add_1_literal + add_2_value + add_2_literal;
    let add_3_value = v_v3 + v_v3.yzx;
    let sub_0_value = v_x.w - v_x.z;
    let sub_1_value = v_v3 - v_x.z;
    let sub_1_literal = v_v3 - 0.4;
    let sub_2_value = v_x.w - v_v3.yzx;
    let sub_2_literal = 0.3 - v_v3.yzx;
    let sub_3_value = v_v3 - v_v3.yzx;
    let add_7 = add_6 + add_3_value + add_3_value + sub_0_value + sub_1_value + sub_1_literal + sub_2_value + sub_2_literal + sub_3_value;
    let mul_0_value = v_x.w * v_x.z;
    let mul_1_value = v_v3 * v_x.z;
    let mul_1_literal = v_v3 * 0.4;
    let mul_2_value = v_x.w * v_v3.yzx;
    let mul_2_literal = 0.3 * v_v3.yzx;
    let mul_3_value = v_v3 * v_v3.yzx;
    let add_8 = add_7 + sub_3_value + mul_0_value + mul_1_value + mul_1_literal + mul_2_value + mul_2_literal + mul_3_value + mul_3_value;
    let div_0_value = v_x.w / v_x.z;
    let div_1_value = v_v3 / v_x.z;
    let div_1_literal = v_v3 / 0.4;
    let div_2_value = v_x.w / v_v3.yzx;
    let div_2_literal = 0.3 / v_v3.yzx;
    let div_3_value = v_v3 / v_v3.yzx;
    let min_0_value = min(v_x.w, v_x.z);
    let add_9 = add_8 + div_0_value + div_1_value + div_1_literal + div_2_value + div_2_literal + div_3_value + div_3_value + min_0_value;
    let min_1_value = min(v_v3, vec3f(v_x.z));
    let min_1_literal = min(v_v3, vec3f(0.4));
    let min_2_value = min(v_v3.yzx, vec3f(v_x.w));
    let min_2_literal = min(v_v3.yzx, vec3f(0.3));
    let min_3_value = min(v_v3, v_v3.yzx);
    let max_0_value = max(v_x.w, v_x.z);
    let max_1_value = max(v_v3, vec3f(v_x.z));
    let add_10 = add_9 + min_1_value + min_1_literal + min_2_value + min_2_literal + min_3_value + min_3_value + max_0_value + max_1_value;
    let max_1_literal = max(v_v3, vec3f(0.4));
    let max_2_value = max(v_v3.yzx, vec3f(v_x.w));
    let max_2_literal = max(v_v3.yzx, vec3f(0.3));
    let max_3_value = max(v_v3, v_v3.yzx);
    let pow_0_value = pow(v_x.w, v_x.z);
    let pow_1_value = pow(v_v3, vec3f(v_x.z));
    let pow_1_literal = pow(v_v3, vec3f(0.4));
    let add_11 = add_10 + max_1_literal + max_2_value + max_2_literal + max_3_value + max_3_value + pow_0_value + pow_1_value + pow_1_literal;
    let pow_2_value = pow(vec3f(v_x.w), v_v3.yzx);
    let pow_2_literal = pow(vec3f(0.3), v_v3.yzx);
    let pow_3_value = pow(v_v3, v_v3.yzx);
    let atan2_0_value = atan2(v_x.w, v_x.z);
    let atan2_1_value = atan2(v_v3, vec3f(v_x.z));
    let atan2_1_literal = atan2(v_v3, vec3f(0.4));
    let atan2_2_value = atan2(vec3f(v_x.w), v_v3.yzx);
    let add_12 = add_11 + pow_2_value + pow_2_literal + pow_3_value + pow_3_value + atan2_0_value + atan2_1_value + atan2_1_literal + atan2_2_value;
    let atan2_2_literal = atan2(vec3f(0.3), v_v3.yzx);
    let atan2_3_value = atan2(v_v3, v_v3.yzx);
    let mix_0_value = mix(v_x.w, v_x.z, v_x.y);
    let mix_1_value = mix(v_v3, vec3f(v_x.z), v_x.y);
    let mix_1_literal = mix(v_v3, vec3f(0.4), 0.5);
    let mix_2_value = mix(vec3f(v_x.w), v_v3.yzx, v_x.y);
    let mix_2_literal = mix(vec3f(0.3), v_v3.yzx, 0.5);
    let add_13 = add_12 + atan2_2_literal + atan2_3_value + atan2_3_value + mix_0_value + mix_1_value + mix_1_literal + mix_2_value + mix_2_literal;
    let mix_3_value = mix(v_v3, v_v3.yzx, v_x.y);
    let mix_3_literal = mix(v_v3, v_v3.yzx, 0.5);
    let mix_4_value = mix(vec3f(v_x.w), vec3f(v_x.z), v_x.xyz);
    let mix_4_literal = mix(vec3f(0.3), vec3f(0.4), v_x.xyz);
    let mix_5_value = mix(v_v3, vec3f(v_x.z), v_x.xyz);
    let mix_5_literal = mix(v_v3, vec3f(0.4), v_x.xyz);
    let mix_6_value = mix(vec3f(v_x.w), v_v3.yzx, v_x.xyz);
    let mix_6_literal = mix(vec3f(0.3), v_v3.yzx, v_x.xyz);
    let add_14 = add_13 + mix_3_value + mix_3_literal + mix_4_value + mix_4_literal + mix_5_value + mix_5_literal + mix_6_value + mix_6_literal;
    let mix_7_value = mix(v_v3, v_v3.yzx, v_x.xyz);
    let clamp_0_value = clamp(v_x.w, v_x.z, v_x.y);
    let clamp_1_value = clamp(v_v3, vec3f(v_x.z), vec3f(v_x.y));
    let clamp_1_literal = clamp(v_v3, vec3f(0.4), vec3f(0.5));
    let clamp_2_value = clamp(vec3f(v_x.w), v_v3.yzx, vec3f(v_x.y));
    let clamp_2_literal = clamp(vec3f(0.3), v_v3.yzx, vec3f(0.5));
    let clamp_3_value = clamp(v_v3, v_v3.yzx, vec3f(v_x.y));
    let add_15 = add_14 + mix_7_value + mix_7_value + clamp_0_value + clamp_1_value + clamp_1_literal + clamp_2_value + clamp_2_literal + clamp_3_value;
    let clamp_3_literal = clamp(v_v3, v_v3.yzx, vec3f(0.5));
    let clamp_4_value = clamp(vec3f(v_x.w), vec3f(v_x.z), v_x.xyz);
    let clamp_4_literal = clamp(vec3f(0.3), vec3f(0.4), v_x.xyz);
    let clamp_5_value = clamp(v_v3, vec3f(v_x.z), v_x.xyz);
    let clamp_5_literal = clamp(v_v3, vec3f(0.4), v_x.xyz);
    let clamp_6_value = clamp(vec3f(v_x.w), v_v3.yzx, v_x.xyz);
    let clamp_6_literal = clamp(vec3f(0.3), v_v3.yzx, v_x.xyz);
    let clamp_7_value = clamp(v_v3, v_v3.yzx, v_x.xyz);
    let add_16 = add_15 + clamp_3_literal + clamp_4_value + clamp_4_literal + clamp_5_value + clamp_5_literal + clamp_6_value + clamp_6_literal + clamp_7_value;
    let cross_product = cross(v_v3, v_x.xyz);
    let length_of_value = length(v_v3);
    let dot_product = dot(v_v3, v_x.xyz);
    let unit = normalize(v_v3);
    let along_x = dpdx(v_v3);
    let along_y = dpdy(v_v3);
    let equal_2 = v_x.w == v_x.y;
    let and_2 = v_x.w < v_x.z && !(v_x.z <= v_x.y);
    let choice = select(v_v3.yzx, v_v3, and_2 || equal_2);
    let add_17 = add_16 + clamp_7_value + cross_product + (length_of_value + dot_product) + unit + along_x + along_y + choice;
    let where_they_differ = select(v_v3, vec3f(0.0), equal_2);

    out_stage.out_color = vec4f(add_17 + add_0_value + where_they_differ, 1.0);

    return out_stage;
}
