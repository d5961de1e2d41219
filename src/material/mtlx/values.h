// Values as a document writes them: numbers with units and colour spaces, as numbers of the graph.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ir/dag.h"
#include "ir/types.h"
#include "mtlx/element.h"

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

struct Unit {
  std::string type, name;
  double scale = 1;  ///< what brings a number of it to the one in which a scene is
};

/// MaterialX's own units of distances, angles and times, and those of the `unitdef`s of documents.
class Units {
public:
  /// Adds the units that a document defines. One whose scale is no number above 0 is none: a warning.
  void add(const Element& document, Diagnostics& said);
  /// The unit of a name, and of a type where that is not empty; null for none.
  const Unit* find(std::string_view type, std::string_view name) const;
  /// The error of an input in a unit that is not known.
  static Diagnostic unknown(const Element& said);

private:
  std::map<std::string, std::vector<Unit>, std::less<>> own_;
};

/// Reads the `value` of an input of a type of typeOf() but a matrix, in the graph's colours and in the unit
/// that the port says, or the scene's where it says none. A number without a unit is as it is. An error with
/// the input's place for what is none.
Result<ir::Components> valueOf(const Element& input, ir::Type type, const Units& units,
                               std::string_view port_unit = {});

}  // namespace lacquer::materialx
