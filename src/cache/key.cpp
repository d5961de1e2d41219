#include "cache/key.h"

namespace lacquer {

Key keyOf(std::string_view bytes) { return {digestOf(bytes)}; }

Key KeyBuilder::finish() const { return keyOf(bytes_); }

}  // namespace lacquer
