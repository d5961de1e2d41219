// What is fuzzed: a function for every kind of input that may be hostile. The fuzzer (`./dev fuzz`) and the
// replay of the corpus in the test suite call the same functions.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lacquer::fuzz {

/// What is known of an input's form when it is changed.
enum class Form : uint8_t { Bytes, Json, Gltf, Glb, Graph };

struct Target {
  std::string_view name;  ///< "gltf-oracle"
  std::string_view
      corpus;  ///< the folder of its inputs, which several targets may share, and of its dictionary
  Form form;
  /// What is wrong with what the library made of the input; empty when all is well, refusals included.
  /// Deterministic: what it varies beside the input it takes from the input's hash.
  std::string (*feed)(std::string_view bytes);
};

std::span<const Target> targets();
/// Null when there is none of that name.
const Target* findTarget(std::string_view name);

}  // namespace lacquer::fuzz
