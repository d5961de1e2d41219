// Samples of a subject on a device: its own faults, and what differs from the CPU by more than rounding
// explains.
#pragma once

#include <functional>

#include "stress/attack.h"

namespace lacquer::stress {

/// What a device gives for samples.
struct Shown {
  Values values;              ///< by root; empty for all but results
  std::vector<bool> dropped;  ///< by sample: the fragment was discarded, and has no values
};
using Shower = std::function<Result<Shown>(std::span<const double> samples, size_t count)>;

/// The same report for every driver that computes the same. A jump, reciprocity and energy are the CPU's to
/// find. Errors: the device's.
Result<Report> attackOnDevice(const Subject& subject, const Plan& plan, const Shower& device);

/// Everything that is wrong on the device at these samples, as replay() says it of the CPU.
Result<Report> replayOnDevice(const Subject& subject, std::span<const double> input, const Shower& device);

}  // namespace lacquer::stress
