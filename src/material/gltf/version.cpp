#include "gltf/version.h"

namespace lacquer::gltf {

std::optional<std::pair<int, int>> versionOf(const std::string& text) {
  constexpr size_t kLongest = 9;  // digits of "1234.5678" at most: no overflow to care for
  const size_t dot = text.find('.');
  const auto digits = [](const std::string& s) {
    return !s.empty() && s.find_first_not_of("0123456789") == std::string::npos;
  };
  if (text.size() > kLongest || dot == std::string::npos) return std::nullopt;
  const std::string major = text.substr(0, dot);
  const std::string minor = text.substr(dot + 1);
  if (!digits(major) || !digits(minor)) return std::nullopt;
  return std::pair(std::stoi(major), std::stoi(minor));
}

bool isOfVersion(const Json& root, int minor) {
  const Json* asset = member(root, "asset");
  const Json* version = asset == nullptr ? nullptr : member(*asset, "version");
  if (version == nullptr || !version->is_string()) return false;
  const std::optional<std::pair<int, int>> number = versionOf(json::text(*version));
  return number && number->first == 2 && number->second >= minor;
}

}  // namespace lacquer::gltf
