// A driver's word on forms of one shader.
#pragma once

#include "lacquer/options.h"
#include "passes/pipeline.h"

namespace lacquer::cost {

/// Takes the form that needs the fewest cycles by the driver of the family that the options name, of equal
/// ones the one with the fewest instructions, then the first. Empty where the options want none, or the model
/// alone, and where there is no driver for the family: then the model chooses.
passes::Choose chooserOf(const Options& options);

/// True where a chooser is asked: what comes of it is the driver's (driverIdentity()).
bool choosesByDriver(const Options& options);

}  // namespace lacquer::cost
