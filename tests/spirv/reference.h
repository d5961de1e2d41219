// The meaning of a module, value by value: what the SPIR-V must compute.
#pragma once

#include <string>
#include <vector>

#include "ir/module.h"
#include "spirv/interpreter.h"

namespace lacquer::spirv_test {

/// Made-up inputs for a module, by a seed: every field of every block, every attribute and varying, the
/// textures.
World makeWorld(const ir::Module& module, uint32_t seed, int32_t light_count);

/// What a stage delivers in that world, outputs under the names of the interface.
Outcome evaluate(const ir::Module& module, ir::Stage stage, const World& world);

/// Fails the test when the outcomes differ by more than the rounding of doubles.
void expectSame(const Outcome& expected, const Outcome& actual);

}  // namespace lacquer::spirv_test
