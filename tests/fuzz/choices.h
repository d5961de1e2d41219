// Decisions that an input's bytes make.
#pragma once

#include <cstdint>
#include <string_view>

namespace lacquer::fuzz {

/// One byte for each; 0 where there are no more.
class Choices {
public:
  explicit Choices(std::string_view bytes) : bytes_(bytes) {}

  bool done() const { return bytes_.empty(); }
  uint8_t next() {
    if (bytes_.empty()) return 0;
    const auto byte = static_cast<uint8_t>(bytes_[0]);
    bytes_.remove_prefix(1);
    return byte;
  }
  /// True for one in so many.
  bool one(uint8_t in) { return next() % in == 1; }

private:
  std::string_view bytes_;
};

}  // namespace lacquer::fuzz
