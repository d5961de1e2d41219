// Identifiers that every target accepts.
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace lacquer::passes {

/// Hands out identifiers that are unique within one scope and mean nothing in GLSL, ESSL, HLSL or C++.
class Names {
public:
  /// A name like `wanted`: characters that no target allows become '_'. A taken or reserved name gets `layer`
  /// in front
  /// ("coat_alpha2"), or failing that a number.
  std::string pick(std::string_view wanted, std::string_view layer = {});
  /// Marks a name as taken without changing it.
  void take(std::string_view name) { taken_.emplace(name); }

private:
  std::set<std::string, std::less<>> taken_;
};

/// The first part of a term's name: "coat" of "coat.distribution".
std::string_view layerOf(std::string_view term);

}  // namespace lacquer::passes
