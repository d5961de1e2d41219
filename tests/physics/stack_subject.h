// What Lacquer makes of a stack.
#pragma once

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

/// The table that the templates read, in double.
SplitSum splitSum(double cosine, double roughness);

/// At a normal along z and a tangent along x.
Sample sampleOf(const Vec3& v, const Vec3& l);

}  // namespace lacquer::physics
