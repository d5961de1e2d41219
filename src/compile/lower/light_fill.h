// The fields of a light's element, made of the properties of KHR_lights_punctual.
#pragma once

#include "ir/module.h"
#include "lang/ast.h"

namespace lacquer::lower {

/// ir::LightKind::fill of a kind of a template's lights: a colour for each of its fields.
ir::Module fillOf(const lang::TemplateDecl& decl, const lang::LightKindDecl& kind);

}  // namespace lacquer::lower
