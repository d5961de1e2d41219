// The attributes that primitives have, and what of a template reads them.
#pragma once

#include <string_view>

#include "gltf/facts.h"
#include "lang/library.h"

namespace lacquer::model {

/// Whether a primitive has what a template's attribute of that name stands for. One of the application's may
/// be spelled as in glTF, `_WETNESS`, or without the underscore.
bool hasAttribute(const gltf::VertexAttributes& attributes, std::string_view name);

/// Whether a given of the template needs an attribute that the primitive lacks.
bool needsAbsent(const lang::TemplateDecl& decl, const lang::GivenDecl& given,
                 const gltf::VertexAttributes& attributes);

}  // namespace lacquer::model
