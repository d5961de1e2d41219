// One graphics pipeline, compiled and asked what became of its fragment shader.
#pragma once

#include "cost/cost.h"
#include "cost/loader.h"

namespace lacquer::cost {

/// The subject has both stages. Never fails otherwise than by Outcome::problem, unless the driver crashes.
Outcome compilePipeline(const Device& device, const Subject& subject, bool disassembly);

}  // namespace lacquer::cost
