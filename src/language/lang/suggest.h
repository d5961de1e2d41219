// "did you mean": the candidate that a misspelt name is nearest to.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace lacquer::lang {

/// The nearest candidate, the first of several; empty when none is near enough to be meant.
std::string_view nearest(std::string_view name, std::span<const std::string_view> candidates);

/// "did you mean 'x'?", or `otherwise`. Of a name with types, "add<vec4>", it has the forms among the
/// candidates.
std::string didYouMean(std::string_view name, std::span<const std::string_view> candidates,
                       std::string otherwise = {});

/// The name here of a type of MaterialX, OSL or HLSL: "vec3" for "color3". Empty for other words.
std::string_view typeElsewhere(std::string_view name);
/// The name here of a function of HLSL or OSL: "mix" for "lerp".
std::string_view functionElsewhere(std::string_view name);

}  // namespace lacquer::lang
