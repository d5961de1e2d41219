// Identifiers that every target accepts.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace lacquer::ir {

/// Hands out identifiers that are unique within one scope and mean nothing in GLSL, ESSL, HLSL or C++.
class Names {
public:
  /// A name like `wanted`: characters that no target allows become '_'. A taken or reserved name gets `layer`
  /// in front
  /// ("coat_alpha2"), or failing that a number.
  std::string pick(std::string_view wanted, std::string_view layer = {});
  /// Marks a name as taken without changing it.
  void take(std::string_view name);
  /// Whether the name is taken; a reserved one need not be.
  bool taken(std::string_view name) const;

private:
  /// Takes the name when it is free.
  bool grab(std::string_view name);
  /// By its hash; false where it is taken.
  bool take(uint64_t hash);

  /// Hashes of the taken names, open addressing, 0 for none; a power of two. Two names with one hash of 64
  /// bits would cost the second a number behind it, nothing else.
  std::vector<uint64_t> taken_ = std::vector<uint64_t>(256, 0);
  size_t count_ = 0;
  std::unordered_map<uint64_t, uint32_t> next_;  ///< by the hash of a taken name: the number to try behind it
};

/// The name of a light loop's index variable, the InputKind::LightIndex.
inline constexpr const char* kLightIndexName = "i";

/// The first part of a term's name: "coat" of "coat.distribution".
std::string_view layerOf(std::string_view term);

}  // namespace lacquer::ir
