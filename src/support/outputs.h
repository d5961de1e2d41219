// What is written must be none of what is read.
#pragma once

#include <string>
#include <vector>

#include "support/diagnostic.h"

namespace lacquer {

/// An error for every output that is one of the inputs, which must not be written then, or another output.
Diagnostics clashes(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

}  // namespace lacquer
