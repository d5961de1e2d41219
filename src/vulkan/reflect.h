// What a pipeline must be told about a SPIR-V module: descriptors, push constants, inputs and outputs.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "support/diagnostic.h"

namespace lacquer::vulkan {

enum class Stage : uint8_t { Vertex, Fragment };

enum class Resource : uint8_t {
  UniformBuffer,
  StorageBuffer,
  Sampler,
  SampledImage,
  CombinedImageSampler,
  StorageImage,
  UniformTexelBuffer,
  StorageTexelBuffer,
};

struct Binding {
  Resource resource = Resource::UniformBuffer;
  uint32_t count = 1;  ///< 1 for an array whose length is not known
  bool operator==(const Binding&) const = default;
};

enum class Scalar : uint8_t { Float, Int, Uint };

/// One location of an interface: a variable takes one, a matrix or an array several.
struct Slot {
  uint32_t location = 0, component = 0;
  Scalar scalar = Scalar::Float;
  uint32_t count = 1;  ///< components
};

struct Interface {
  std::string entry;                                          ///< the entry point's name
  std::map<std::pair<uint32_t, uint32_t>, Binding> bindings;  ///< by set and binding
  uint32_t push_constant_bytes = 0;
  std::vector<Slot> inputs,
      outputs;            ///< user variables of the entry point's module, by location and component
  std::string odd_input;  ///< an input that Slot cannot describe; empty when there is none
};

/// Reads the first entry point of a stage. Any words are safe to give. Errors: "spirv-reflection".
Result<Interface> reflect(const std::vector<uint32_t>& words, Stage stage);

/// Instructions inside functions, labels, line marks and the declarations of local variables not counted.
/// 0 for words that are no module.
size_t instructionCount(const std::vector<uint32_t>& words);

}  // namespace lacquer::vulkan
