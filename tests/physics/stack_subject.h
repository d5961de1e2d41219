// What Lacquer makes of a stack.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "physics/stack.h"
#include "physics/stack_random.h"
#include "physics/subject.h"

namespace lacquer::physics {

/// Whether this library knows the extension, "OUTER/INNER" for an inner one, and a material with it looks
/// other than without.
bool builtIn(const std::string& path);
/// The first of them that is not; empty when all are.
std::string missingOf(const std::vector<std::string>& paths);

/// Direct light on a material, in double.
Vec3 lacquerDirect(const StackMaterial& material, const Sample& sample);
/// White surroundings and no other light.
Vec3 lacquerWhiteRoom(const StackMaterial& material, double cosine, bool multiple_scattering = true);

/// What the template for path tracers says of the matter inside.
StackMedium lacquerMedium(const StackMaterial& material);
/// What comes through of a frame behind, without any other light: the level is over 16, the frame's texture
/// coordinates are x and y of where it is seen. The frame shows what `frame` makes of x, y and the level.
Vec3 lacquerThrough(const StackMaterial& material, const Sample& sample,
                    const std::function<Vec3(double x, double y, double lod)>& frame, double scale = 1);

/// The table that the templates read, in double.
SplitSum splitSum(double cosine, double roughness);

/// At a normal along z and a tangent along x.
Sample sampleOf(const Vec3& v, const Vec3& l);

}  // namespace lacquer::physics
