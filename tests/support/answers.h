// What the instruments found, as the JSON that the program prints.
#pragma once

#include <optional>
#include <string>

#include "answer/answer.h"

namespace lacquer::test {

/// Empty for nothing.
template <class Found>
std::string jsonOf(const std::optional<Found>& found) {
  return found ? answerJson(*found) : std::string();
}

}  // namespace lacquer::test
