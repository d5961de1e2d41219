// Identifiers that every target accepts.
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>

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
  struct Hash {
    using is_transparent = void;
    size_t operator()(std::string_view name) const { return std::hash<std::string_view>()(name); }
  };
  bool free(std::string_view name) const;

  std::unordered_set<std::string, Hash, std::equal_to<>> taken_;  ///< only asked, never listed
};

/// The first part of a term's name: "coat" of "coat.distribution".
std::string_view layerOf(std::string_view term);

}  // namespace lacquer::passes
