#include "support/digest.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace lacquer {

namespace {

constexpr size_t kDigestBlock = 128;
using Words = std::array<uint64_t, 16>;

/// RFC 7693, 2.6.
constexpr std::array<uint64_t, 8> kStart = {0x6a09e667f3bcc908, 0xbb67ae8584caa73b, 0x3c6ef372fe94f82b,
                                            0xa54ff53a5f1d36f1, 0x510e527fade682d1, 0x9b05688c2b3e6c1f,
                                            0x1f83d9abfb41bd6b, 0x5be0cd19137e2179};

/// RFC 7693, 2.7; the rounds after the tenth begin anew.
constexpr uint8_t kOrder[10][16] = {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
                                    {14, 10, 4, 8, 9, 15, 13, 6, 1, 12, 0, 2, 11, 7, 5, 3},
                                    {11, 8, 12, 0, 5, 2, 15, 13, 10, 14, 3, 6, 7, 1, 9, 4},
                                    {7, 9, 3, 1, 13, 12, 11, 14, 2, 6, 5, 10, 4, 0, 15, 8},
                                    {9, 0, 5, 7, 2, 4, 10, 15, 14, 1, 11, 12, 6, 8, 3, 13},
                                    {2, 12, 6, 10, 0, 11, 8, 3, 4, 13, 7, 5, 15, 14, 1, 9},
                                    {12, 5, 1, 15, 14, 13, 4, 10, 0, 7, 6, 3, 9, 2, 8, 11},
                                    {13, 11, 7, 14, 12, 1, 3, 9, 5, 0, 15, 4, 8, 6, 2, 10},
                                    {6, 15, 14, 9, 11, 3, 0, 8, 12, 2, 13, 7, 1, 4, 10, 5},
                                    {10, 2, 8, 4, 7, 6, 1, 5, 15, 11, 9, 14, 3, 12, 13, 0}};

inline void mix(uint64_t& a, uint64_t& b, uint64_t& c, uint64_t& d, uint64_t x, uint64_t y) {
  a += b + x;
  d = std::rotr(d ^ a, 32);
  c += d;
  b = std::rotr(b ^ c, 24);
  a += b + y;
  d = std::rotr(d ^ a, 16);
  c += d;
  b = std::rotr(b ^ c, 63);
}

Words wordsOf(const char* block) {
  Words words;
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(words.data(), block, kDigestBlock);
  } else {
    for (size_t i = 0; i < words.size(); ++i) {
      words[i] = 0;
      for (size_t k = 8; k-- > 0;) words[i] = words[i] << 8 | static_cast<unsigned char>(block[8 * i + k]);
    }
  }
  return words;
}

void compress(std::array<uint64_t, 8>& state, const char* block, uint64_t count, bool last) {
  const Words m = wordsOf(block);
  Words v;
  std::copy(state.begin(), state.end(), v.begin());
  std::copy(kStart.begin(), kStart.end(), v.begin() + 8);
  v[12] ^= count;
  if (last) v[14] = ~v[14];
  for (size_t round = 0; round < 12; ++round) {
    const auto& s = kOrder[round % 10];
    mix(v[0], v[4], v[8], v[12], m[s[0]], m[s[1]]);
    mix(v[1], v[5], v[9], v[13], m[s[2]], m[s[3]]);
    mix(v[2], v[6], v[10], v[14], m[s[4]], m[s[5]]);
    mix(v[3], v[7], v[11], v[15], m[s[6]], m[s[7]]);
    mix(v[0], v[5], v[10], v[15], m[s[8]], m[s[9]]);
    mix(v[1], v[6], v[11], v[12], m[s[10]], m[s[11]]);
    mix(v[2], v[7], v[8], v[13], m[s[12]], m[s[13]]);
    mix(v[3], v[4], v[9], v[14], m[s[14]], m[s[15]]);
  }
  for (size_t i = 0; i < state.size(); ++i) state[i] ^= v[i] ^ v[i + 8];
}

}  // namespace

Digest digestOf(std::string_view bytes) {
  std::array<uint64_t, 8> state = kStart;
  state[0] ^= 0x01010000U ^ sizeof(Digest);  // no key, one leaf
  size_t at = 0;
  for (; bytes.size() - at > kDigestBlock; at += kDigestBlock)
    compress(state, bytes.data() + at, at + kDigestBlock, false);
  std::array<char, kDigestBlock> rest{};
  std::copy(bytes.begin() + static_cast<ptrdiff_t>(at), bytes.end(), rest.begin());
  compress(state, rest.data(), bytes.size(), true);
  Digest digest;
  for (size_t i = 0; i < digest.size(); ++i) digest[i] = static_cast<uint8_t>(state[i / 8] >> 8 * (i % 8));
  return digest;
}

std::string hexOf(const Digest& digest, size_t bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (size_t i = 0; i < std::min(bytes, digest.size()); ++i) {
    text += kDigits[digest[i] >> 4];
    text += kDigits[digest[i] & 15];
  }
  return text;
}

}  // namespace lacquer
