// MaterialX's surfaces as definitions by closures: the documents of nodes/materialx/.
#pragma once

#include <string_view>

#include "mtlx/element.h"

namespace lacquer::materialx {

/// Of an input of such a definition: numbers with which a surface is another shader, as a
/// weight of 0 is one without that layer. An input all of whose components are one of them is no parameter.
inline constexpr std::string_view kRemoves = "removes";

/// A document whose definitions are the surfaces that there is a model for.
const Element& surfaceModels();

/// The unit that numbers of a node's input have, which its definition says: one of the document, or else of
/// surfaceModels(). Empty where none says one.
std::string_view portUnit(const Element& document, std::string_view category, std::string_view input);

}  // namespace lacquer::materialx
