#include "support/key.h"

namespace lacquer {

Key keyOf(std::string_view bytes) { return {digestOf(bytes)}; }

Key KeyBuilder::finish() const { return keyOf(bytes_); }

Digest shortened(Digest digest, size_t bits) {
  for (size_t i = bits; i < 8 * digest.size(); ++i)
    digest[i / 8] = static_cast<uint8_t>(digest[i / 8] & ~(0x80U >> i % 8));
  return digest;
}

Key Keys::of(const std::string& content) {
  Key key{shortened(digestOf(content), bits_)};
  const std::lock_guard lock(mutex_);
  for (;;) {
    const auto [it, fresh] = contents_.try_emplace(key, content);
    if (fresh || it->second == content) return key;
    // Another content was there before: the next key.
    for (size_t i = key.digest.size(); i > 0 && ++key.digest[i - 1] == 0; --i) {
    }
  }
}

bool Keys::take(const Key& key, const std::string& content) {
  const std::lock_guard lock(mutex_);
  return contents_.try_emplace(key, content).first->second == content;
}

std::string Keys::contentOf(const Key& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = contents_.find(key);
  return found == contents_.end() ? std::string() : found->second;
}

}  // namespace lacquer
