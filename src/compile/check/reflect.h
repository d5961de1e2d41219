// The interface of a SPIR-V module, by the decorations in its words: descriptors, blocks, push constants,
// inputs and outputs.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "check/check.h"
#include "support/diagnostic.h"

namespace lacquer::check {

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

/// One location of an interface: a variable takes one, a matrix, an array or a block several.
struct Slot {
  uint32_t location = 0, component = 0;
  Scalar scalar = Scalar::Float;
  uint32_t count = 1;  ///< components
};

struct BlockMember {
  std::string name;  ///< empty when the module carries no names
  uint32_t offset = 0;
  uint32_t size = 0;  ///< a matrix or an array counts whole strides: 48 for a mat3 whose stride is 16
};

struct Block {
  std::string name;  ///< the block's type name
  uint32_t set = 0, binding = 0;
  uint32_t size = 0;  ///< the end of the last member, not rounded up
  std::vector<BlockMember> members;
};

struct Interface {
  std::string entry;                                          ///< the entry point's name
  std::map<std::pair<uint32_t, uint32_t>, Binding> bindings;  ///< by set and binding
  uint32_t push_constant_bytes = 0;
  std::vector<Slot> inputs,
      outputs;            ///< user variables of the entry point's module, by location and component
  std::string odd_input;  ///< an input that Slot cannot describe; empty when there is none
};

/// Reads the first entry point of a stage. Any words are safe to give, and what is returned is never much
/// larger than they are. Errors: "spirv-reflection", also for what no device has: sets from 32 on, bindings
/// from 65,536 on, more than 65,536 descriptors in a binding or 2^20 in all, more than 256 inputs or outputs,
/// more than 4,096 bytes of push constants.
Result<Interface> reflect(const Spirv& words, Stage stage);

/// Whether a module has an entry point of a stage; false for words that are no module.
bool hasEntryPoint(const Spirv& words, Stage stage);

/// The uniform blocks of a SPIR-V module with their members' offsets, by the decorations in the words
/// (not by layout rules), sorted by set and binding. Errors: "spirv-reflection", also for more than 65,536
/// members in all.
Result<std::vector<Block>> reflectBlocks(const Spirv& words);

/// What takes a place among the descriptors: a uniform block, a texture, a sampler.
struct Taken {
  std::string name;  ///< of the variable; empty when the module carries no names
  uint32_t set = 0, binding = 0;
  bool block = false;    ///< a uniform block
  bool storage = false;  ///< a storage buffer
};

/// In the order of the declarations, those with a binding. None for words that are no module.
std::vector<Taken> reflectPlaces(const Spirv& words);

/// Instructions inside functions, labels, line marks and the declarations of local variables not counted.
/// 0 for words that are no module.
size_t instructionCount(const Spirv& words);

}  // namespace lacquer::check
