// Changes that keep an input's form, so that it comes further than the parser.
#pragma once

#include <string>
#include <string_view>

#include "targets.h"

namespace lacquer::fuzz {

/// The input with one change or a few; empty where its form cannot be read. A function of `seed`.
std::string mutated(std::string_view bytes, Form form, uint64_t seed);
/// The input with some part of another one of its form in it; empty likewise.
std::string crossed(std::string_view bytes, std::string_view other, Form form, uint64_t seed);

}  // namespace lacquer::fuzz
