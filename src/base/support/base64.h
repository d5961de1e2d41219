// Bytes as text in URIs and pages.
#pragma once

#include <string>
#include <string_view>

namespace lacquer {

/// RFC 4648, with padding.
std::string toBase64(std::string_view bytes);

}  // namespace lacquer
