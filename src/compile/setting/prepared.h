// The models of the library's own texts as they were made when Lacquer was built (material/prepare/).
#pragma once

#include <span>

#include "model/model.h"

namespace lacquer {

/// One for each profile of the library's own, in WebAssembly for the default one. Where there is none, models
/// are compiled, as those of other texts are.
std::span<const model::Prepared> preparedModels();

}  // namespace lacquer
