// A document as text that stays the same as long as what was read stays the same.
#pragma once

#include <string>

#include "material/material.h"

namespace lacquer::test {

/// All diagnostics in full, first the file's, then each material's.
std::string formatAll(const material::Document& document);

/// What differs from the defaults, one fact per line: materials with their uses and ignored extensions,
/// default uses, lights, images.
std::string dump(const material::Document& document);

}  // namespace lacquer::test
