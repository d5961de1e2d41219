// What inputs may be at most: limits.def is the table of them, which docs/security.md shows.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "support/diagnostic.h"

namespace lacquer {

struct Limits {
#define LACQUER_LIMIT(member, name, value, most, unit, meaning) uint64_t member = value;
#include "support/limits.def"
#undef LACQUER_LIMIT
};

struct LimitRow {
  std::string_view name;
  uint64_t Limits::*member;
  uint64_t value, most;  ///< without an option; that an option may say
  std::string_view unit, meaning;
};

std::span<const LimitRow> limitTable();

/// "64M" is 64 * 2^20; K, M, G and T, with or without a B or iB behind. Nothing for what is no whole number
/// or too large for 64 bits.
bool parseSize(std::string_view text, uint64_t& size);

/// Sets the limit that a text such as "images=1G" names. Errors: "unknown-limit", "bad-limit".
Result<void> setLimit(std::string_view text, Limits& limits);

/// "help" of a message about a limit: how to raise it.
std::string raising(std::string_view name);

}  // namespace lacquer
