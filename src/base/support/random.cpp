#include "support/random.h"

namespace lacquer {

uint64_t Random::next() {
  state_ += 0x9e3779b97f4a7c15U;
  uint64_t z = state_;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
  z = (z ^ z >> 27) * 0x94d049bb133111ebU;
  return z ^ z >> 31;
}

uint64_t mixed(uint64_t seed, uint64_t with) { return Random(seed ^ Random(with).next()).next(); }

uint64_t mixed(uint64_t seed, std::string_view with) {
  for (const char c : with) seed = mixed(seed, static_cast<unsigned char>(c));
  return seed;
}

}  // namespace lacquer
