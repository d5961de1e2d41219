// What the targets' platforms hold.
#pragma once

#include <span>

#include "ir/module.h"
#include "lacquer/options.h"
#include "support/diagnostic.h"

namespace lacquer {

/// What a placed module has more of than the platforms of these targets take (targets::DeviceLimits): code
/// "over-limit", an error where no device takes it, a warning where some may.
Diagnostics overLimits(const ir::Module& module, std::span<const Target> targets);

}  // namespace lacquer
