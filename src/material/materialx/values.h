// Values as a document writes them: numbers with units and colour spaces, as numbers of the graph.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "ir/dag.h"
#include "ir/types.h"
#include "materialx/element.h"

namespace lacquer::materialx {

/// "color3" and "vector3" are a Vec3; nothing for "string", "surfaceshader" and other types without numbers.
std::optional<ir::Type> typeOf(std::string_view type);

/// What a type of the graph is called in MaterialX, for messages: "vector3", of colours, too.
std::string_view nameOf(ir::Type type);

/// One of the values that a closure is here: the node texts of nodes/materialx/ take and give them by these
/// names.
struct ClosurePart {
  std::string_view name;
  ir::Type type;
  double neutral;  ///< of each component, where nothing is connected
};

/// Of "BSDF", "EDF", "VDF" and "surfaceshader"; empty for what is no closure.
std::span<const ClosurePart> closureParts(std::string_view type);

/// Whether colours of that space can be brought to linear Rec. 709: the spaces of `cmlib`, and none.
bool isColorSpace(std::string_view space);
/// Colours of these spaces are as they are: linear Rec. 709 and what says that it is no colour.
bool isLinear(std::string_view space);
/// A node converts an image of it: it is neither linear nor decoded by the texture's format.
bool isConverted(std::string_view space);
/// Brings the first three components from a space of isColorSpace() to linear Rec. 709, by the formulas of
/// MaterialX's `cmlib`.
ir::Components toLinear(std::string_view space, ir::Components color);

/// What brings a number of a unit to the one in which a scene is; nothing for a unit that is not known.
std::optional<double> unitScale(std::string_view unittype, std::string_view unit);

/// Reads the `value` of an input of a type of typeOf() but a matrix, in the graph's colours and in the unit
/// that the port says, or the scene's where it says none. A number without a unit is as it is. An error with
/// the input's place for what is none.
Result<ir::Components> valueOf(const Element& input, ir::Type type, std::string_view port_unit = {});

}  // namespace lacquer::materialx
