// The attributes that primitives have, and what of a template reads them.
#pragma once

#include <string_view>
#include <vector>

#include "gltf/facts.h"
#include "lang/library.h"

namespace lacquer::model {

/// Whether a primitive has what a template's attribute of that name stands for. One of the application's may
/// be spelled as in glTF, `_WETNESS`, or without the underscore.
bool hasAttribute(const gltf::VertexAttributes& attributes, std::string_view name);

/// Whether an expression of the template reads an attribute that the primitive lacks. `known` has a place for
/// each given of the template: -1 as long as nobody asked.
bool readsAbsent(const lang::TemplateDecl& decl, const lang::Expr& expr,
                 const gltf::VertexAttributes& attributes, std::vector<signed char>& known);

}  // namespace lacquer::model
