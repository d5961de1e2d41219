// What reading, checking and drawing a graph share about names and lists of diagnostics.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ir/types.h"
#include "support/diagnostic.h"

namespace lacquer::graph {

/// The type of a parameter or a texture from its name in the JSON form: what a graph can hold, not every
/// type.
std::optional<ir::Type> valueType(std::string_view name);
std::optional<ir::Type> textureType(std::string_view name);
/// Of any value, matrices among them, or of a texture.
std::optional<ir::Type> inputType(std::string_view name);
/// "a float", "an int".
std::string article(ir::Type type);

/// Shaders compute with 32-bit floats: in one a larger number would be infinite. False for what is no number,
/// too.
bool fitsFloat(double x);
inline constexpr std::string_view kFloatHelp = "it must fit a 32-bit float: at most about 3.4e38";

/// Letters, digits and underscores, a letter or an underscore first.
bool isName(std::string_view text);
inline constexpr std::string_view kNameHelp =
    "a name has letters, digits and underscores, and begins with no digit";

/// Names joined by dots: a node's id.
bool isDottedName(std::string_view text);

/// The swizzle's components (0 to 3), none when it is no swizzle: one to four letters of xyzw, rgba or stpq,
/// not mixed.
std::string swizzleComponents(std::string_view swizzle);

/// Nobody reads more than the first hundred: the rest, and so many that are not there, become one note.
void shorten(Diagnostics& diagnostics, size_t left_out = 0);

}  // namespace lacquer::graph
