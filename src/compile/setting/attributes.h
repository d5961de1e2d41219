// The vertex attributes of a primitive, as the public interface and as the files' reader have them.
#pragma once

#include "gltf/facts.h"
#include "lacquer/generate.h"

namespace lacquer {

Attributes toPublic(const gltf::VertexAttributes& attributes);
gltf::VertexAttributes fromPublic(const Attributes& attributes);
/// Of the names that gltf::VertexAttributes::names() gives.
Attributes attributesOf(const Strings& names);

}  // namespace lacquer
