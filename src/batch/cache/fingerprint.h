// What this build is, for addresses of what it makes.
#pragma once

#include <string_view>

namespace lacquer {

/// Differs between builds from different sources, node libraries or versions of the compilers and validators
/// that check the code; equal for equal ones, on every machine.
std::string_view fingerprint();

}  // namespace lacquer
