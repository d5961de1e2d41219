// What the parser and the inliner gave, as text.
#pragma once

#include <string>

#include "ir/dag.h"
#include "lang/library.h"

namespace lacquer::test {

/// Every declaration of the library, which must be free of errors, with its whole contract.
std::string dumpContracts(const lang::Library& library);

/// A value as a nested expression.
std::string dumpValue(const ir::Dag& dag, ir::ValueId id);

}  // namespace lacquer::test
