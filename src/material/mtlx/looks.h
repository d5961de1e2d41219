// What a document says of geometry: looks, collections, variants, properties.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lacquer/looks.h"
#include "mtlx/element.h"
#include "support/diagnostic.h"

namespace lacquer::materialx {

/// Marks an input that a variant has given a surface: the surface may have none of that name.
inline constexpr std::string_view kOfVariant = "of_variant";

/// A material that was made of the document's own with a variant's values.
struct VariantOf {
  std::string material;  ///< the element's name
  std::string of;        ///< that of the document's own
  Strings variants;      ///< "wetness/wet"
};

struct VariantMaterials {
  std::vector<VariantOf> made;
  /// By a look's name and the place of a materialassign among those that it has, inherited ones first: the
  /// material that stands there for the one that it names.
  std::map<std::pair<std::string, size_t>, std::string> assigned;
};

/// Materials with the values of variants, as elements behind the document's own: one for each choice that a
/// look assigns, and one for each variant, of a set that no look assigns, and each material that has
/// something of its names. What is wrong is said.
VariantMaterials addVariants(Element& document, Diagnostics& said);

/// Looks, with materials by their numbers: `materials` are names of elements, in the file's order.
Looks readLooks(const Element& document, const std::vector<std::string>& materials,
                const VariantMaterials& variants, Diagnostics& said);

/// The parts of a list of geometry, which commas separate: not those within braces.
std::vector<std::string> geometryNames(std::string_view list);

}  // namespace lacquer::materialx
