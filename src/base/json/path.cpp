#include "json/path.h"

namespace lacquer::json {

namespace {

/// Untrusted names can be as long as the file, and repeat in a thousand messages.
constexpr size_t kLongest = 1000;
constexpr std::string_view kCut = "...";

}  // namespace

std::string Path::text() const {
  std::string out;
  append(out);
  if (out.size() > kLongest) {
    size_t end = kLongest;
    while (end > 0 && (static_cast<unsigned char>(out[end]) & 0xC0) == 0x80) --end;
    out.replace(end, std::string::npos, kCut);
  }
  return out;
}

void Path::append(std::string& out) const {
  if (parent_ == nullptr) return;
  parent_->append(out);
  if (out.size() > kLongest) return;
  out += '/';
  if (element_) {
    out += std::to_string(index_);
    return;
  }
  for (const char c : key_.substr(0, kLongest)) {
    if (c == '~') {
      out += "~0";
    } else if (c == '/') {
      out += "~1";
    } else {
      out += c;
    }
  }
  if (key_.size() > kLongest) out += kCut;
}

}  // namespace lacquer::json
