#include "json/path.h"

namespace lacquer::json {

std::string Path::text() const {
  if (parent_ == nullptr) return {};
  std::string out = parent_->text() + '/';
  if (element_) return out + std::to_string(index_);
  for (const char c : key_) {
    if (c == '~') {
      out += "~0";
    } else if (c == '/') {
      out += "~1";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace lacquer::json
