// Numbers that look random and are the same everywhere.
#pragma once

#include <cstdint>
#include <string_view>

namespace lacquer {

/// splitmix64 (Steele, Lea and Flood 2014).
class Random {
public:
  explicit Random(uint64_t seed) : state_(seed) {}
  uint64_t next();
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(next() % n); }
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }

private:
  uint64_t state_;
};

/// A seed that depends on both and on nothing else.
uint64_t mixed(uint64_t seed, uint64_t with);
uint64_t mixed(uint64_t seed, std::string_view with);

}  // namespace lacquer
