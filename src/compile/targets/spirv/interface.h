// The variables through which a stage speaks with the outside: blocks, textures, inputs and outputs, named
// and decorated as the GLSL for Vulkan declares them.
#pragma once

#include <array>
#include <vector>

#include "schedule/schedule.h"
#include "targets/spirv/globals.h"

namespace lacquer::targets::spirv {

/// Ids of variables, by the module's tables; 0 for what the stage does not use.
struct Interface {
  std::vector<uint32_t> blocks;      ///< by index into Module::blocks
  std::vector<uint32_t> textures;    ///< … Module::textures
  std::vector<uint32_t> attributes;  ///< … Module::attributes
  std::vector<uint32_t> varyings;    ///< … Module::varyings
  std::vector<uint32_t> outputs;     ///< … Module::outputs: fragment outputs and the position
  /// … Module::parameters: specialization constants, whole and by component.
  std::vector<uint32_t> constants;
  std::vector<std::array<uint32_t, 4>> constant_components;
  uint32_t front_facing = 0;
  std::vector<uint32_t> entry_point;  ///< all inputs and outputs
};

/// `array_length`: SpirvOptions::array_length.
Interface declareInterface(const ir::Module& module, const schedule::Program& program, Globals& globals,
                           uint32_t array_length);

}  // namespace lacquer::targets::spirv
