// One graphics pipeline, compiled and asked what became of its fragment shader.
#pragma once

#include "cost/cost.h"
#include "cost/loader.h"
#include "cost/worker.h"

namespace lacquer::cost {

/// The subject has both stages, and what is foreign has been validated. Never fails otherwise than by
/// Outcome::problem, unless the driver crashes.
Outcome compilePipeline(const Device& device, const Stages& subject, bool disassembly);

}  // namespace lacquer::cost
