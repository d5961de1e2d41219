// A module evaluated in float32, value by value.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "intervals/sampling.h"
#include "ir/module.h"

namespace lacquer::test {

/// The values of `ids` (ascending, operands included), by id. Light-rate values are those of one light, which
/// every sum takes as many times as lights are on. `visit` sees each as it is computed, those of loops in
/// every round.
void evaluate(const ir::Module& module, std::span<const ir::ValueId> ids, const World& world,
              std::vector<Floats>& values, const std::function<void(ir::ValueId)>& visit = {});

/// Everything that the outputs, varyings and preshader reach.
std::vector<ir::ValueId> everything(const ir::Module& module);

}  // namespace lacquer::test
