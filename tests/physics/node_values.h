// A node of the library by itself, evaluated.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "eval/bindings.h"

namespace lacquer::physics {

/// The results of a node, one after the other; of each the components of each point side by side. Columns are
/// named as the parameters; each parameter has one, textures a sampler. A test failure where the evaluation
/// fails.
template <class T>
std::vector<std::vector<T>> nodeValues(
    std::string_view node, std::string_view variant, const eval::Columns& columns, size_t points,
    const std::map<std::string, eval::Sampler, std::less<>>& textures = {});

}  // namespace lacquer::physics
