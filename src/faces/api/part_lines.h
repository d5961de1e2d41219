// Mistakes in a part's lines: channels of a texture that its extension does not declare, numbers out of a
// property's range.
#pragma once

#include <string>

#include "lang/ast.h"
#include "model/model.h"

namespace lacquer {

/// The letters, in the order rgba, that a node's text takes of the texels of its parameter `slot`, as far as
/// it says so: of a swizzle those, of a texel that is returned whole all four.
std::string channelsRead(const lang::NodeDecl& node, size_t slot);

/// Of a line's value that hands a texture to a node: the channels that the node reads and the extension does
/// not declare, with the texture's name: "'reliefTexture' has the channels rg, and 'relief_grad' reads ba of
/// it". Empty where there is nothing to say.
std::string undeclaredChannels(const model::Model& model, const model::Value& value);

/// Of a condition, or one within it, that compares a property with a number out of its range: what is
/// compared. Empty where there is none.
std::string neverEqual(const model::Model& model, const model::Condition& condition);

}  // namespace lacquer
