// The forms of a node: one text for several types, and several texts under one name.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ir/types.h"
#include "lang/reporter.h"

namespace lacquer::lang {

/// What the type variables of a text stand for in one of its forms.
using TypeBindings = std::vector<std::pair<std::string_view, ir::Type>>;

/// One of the nodes that `node NAME<T in float, vec2; float>(...)` declares.
struct Form {
  std::string key;  ///< "NAME<float, float>"
  TypeBindings bindings;
};

/// The forms that the list behind a node's name asks for, in its order; none where no list stands there.
/// `after_name`: where the name ends. Errors go to the reporter.
std::vector<Form> formsOf(Reporter& reporter, std::string_view name, uint32_t after_name, uint32_t end);

/// "convert<vec3, float>": a node's name with types, or the first of them, behind it.
std::string formName(std::string_view name, const std::vector<ir::Type>& types);
/// Whether the types of one name are the first of those of a form: "convert<vec3>" of "convert<vec3, float>".
bool beginsForm(std::string_view form, std::string_view beginning);

}  // namespace lacquer::lang
