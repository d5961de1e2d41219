// Documents of older versions as MaterialX 1.39 says them, by the rules of MaterialX's own library.
#pragma once

#include "mtlx/element.h"
#include "support/diagnostic.h"

namespace lacquer::materialx {

/// The oldest version 1.x that is brought to 1.39.
inline constexpr int kLeastMinor = 36;
inline constexpr int kPresentMinor = 39;

/// Brings the children of a document from the one of that number on, which were written in version 1.`minor`,
/// to 1.39. What is brought already stays. `said`: "not-upgraded".
void upgrade(Element& root, size_t first, int minor, Diagnostics& said);

/// The same from 1.36 and 1.37 to 1.38: parameters, materials that refer to shaders, renamed nodes.
void upgradeTo38(Element& root, size_t first, int minor, Diagnostics& said);

/// The input of that name; null for none.
Element* inputOf(Element& node, std::string_view name);
/// An input of a node, with a value, or without one for an empty text.
Element& addInput(Element& node, std::string_view name, std::string_view type, std::string_view value);
/// The same, connected to a node beside it, or to that output of it.
Element& connectInput(Element& node, std::string_view name, std::string_view type, std::string_view to,
                      std::string_view output = {});
/// An element of that category, name and type at a place.
Element nodeAt(const Place& place, std::string_view category, std::string_view name, std::string_view type);

}  // namespace lacquer::materialx
