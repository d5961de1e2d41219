// In place of src/compile/optimize/: this build does not search for cheaper forms, and knows no family of
// GPUs. Options that ask for it are refused before anything here is called.
#include "optimize/optimize.h"

namespace lacquer::optimize {

std::span<const Family> families() { return {}; }
const Family* findFamily(std::string_view) { return nullptr; }
std::vector<Candidate> search(const ir::Module&, const Settings&) { return {}; }
std::vector<Candidate> front(const ir::Module&, const Settings&, std::span<const double>) { return {}; }

}  // namespace lacquer::optimize
