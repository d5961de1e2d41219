// Executes what writeSpirv writes, and what glslang makes of the same in GLSL: enough of SPIR-V for these,
// and nothing more. It knows the words alone, neither the DAG nor ops.def, so that it disagrees when an
// opcode, an operand's place, an offset or a loop is wrong.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lacquer::spirv_test {

/// The components of a value; a Bool is 0 or 1, a matrix is its columns.
using Cell = std::vector<double>;

/// What a shader is given.
struct World {
  std::map<std::string, Cell> inputs;                                    ///< by the variable's name
  std::map<std::pair<uint32_t, uint32_t>, std::vector<uint8_t>> blocks;  ///< by set and binding
  /// A texel, by the texture's set and binding; `lod` is -1 for implicit derivatives.
  std::function<Cell(uint32_t set, uint32_t binding, const Cell& at, double lod)> texel;
  /// The size of a texture's level.
  std::function<Cell(uint32_t set, uint32_t binding, double level)> size;
};

struct Outcome {
  bool dropped = false;
  std::map<std::string, Cell> outputs;  ///< by the variable's name
};

/// Runs the entry point. Throws std::runtime_error at what it does not know.
Outcome interpret(const std::vector<uint32_t>& words, const World& world);

}  // namespace lacquer::spirv_test
