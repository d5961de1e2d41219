// BLAKE2b (RFC 7693): what content is addressed by. Two inputs of one digest cannot be found on purpose, as
// they can with hashes that are made for speed.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace lacquer {

/// 256 bits, in the order of their bytes.
using Digest = std::array<uint8_t, 32>;

/// BLAKE2b-256 without a key. The same on every machine.
Digest digestOf(std::string_view bytes);

/// Lower-case hexadecimal digits of the first `bytes`.
std::string hexOf(const Digest& digest, size_t bytes = sizeof(Digest));

}  // namespace lacquer
