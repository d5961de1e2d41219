// The facts of a file's scene that shaders depend on: attribute sets, lights, images.
#pragma once

#include "gltf/facts.h"
#include "gltf/json.h"

namespace lacquer::gltf {

/// Fills all but `path` of a scene from the root of its JSON. What is wrong is left out.
void readScene(const Json& root, Scene& scene);

/// Checks the scene's JSON, fills what of a scene needs no more than that, and returns the rest: only
/// what shaders depend on, of the right types, with every index in range.
Json checkScene(const Json& root, Scene& scene);

}  // namespace lacquer::gltf
