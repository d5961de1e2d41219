// What the targets' platforms hold.
#pragma once

#include <span>

#include "ir/module.h"
#include "lacquer/options.h"
#include "support/diagnostic.h"

namespace lacquer {

/// What a placed module has more of than a target's platform guarantees, for the targets named: colour
/// outputs, bytes of a uniform block, textures of the fragment stage. Warnings, code "over-limit";
/// docs/bindings.md has the numbers and where they come from.
Diagnostics overLimits(const ir::Module& module, std::span<const Target> targets);

}  // namespace lacquer
