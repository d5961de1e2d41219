// Names of what included files define in a namespace of their own.
#pragma once

#include <string_view>

#include "mtlx/element.h"

namespace lacquer::materialx {

/// Calls each element beside the nodegraphs that is of another namespace than the document ("namespace",
/// which stays on definitions, nodegraphs and nodes) "space:name", and what names it within that namespace
/// so, too. Names that begin with the document's own namespace are said without it.
void qualifyNames(Element& root);

}  // namespace lacquer::materialx
