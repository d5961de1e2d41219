// In place of src/lab/cost/: this build asks no driver what shaders cost; the model chooses.
#include "cost/cost.h"
#include "cost/choose.h"

namespace lacquer::cost {

std::string driverIdentity() { return {}; }
bool choosesByDriver(const Options&) { return false; }
passes::Choose chooserOf(const Options&) { return {}; }

}  // namespace lacquer::cost
