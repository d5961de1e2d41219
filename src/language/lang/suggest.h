// "did you mean": the candidate that a misspelt name is nearest to.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace lacquer::lang {

/// The nearest candidate, the first of several; empty when none is near enough to be meant.
std::string_view nearest(std::string_view name, std::span<const std::string_view> candidates);

/// "did you mean 'x'?", or `otherwise`.
std::string didYouMean(std::string_view name, std::span<const std::string_view> candidates,
                       std::string otherwise = {});

}  // namespace lacquer::lang
