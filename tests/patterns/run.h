// A node of nodes/standard/ at many points.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "eval/bindings.h"
#include "lang/library.h"
#include "patterns/reference.h"

namespace lacquer::test {

/// Of Lacquer, nodes/standard/ with it.
const lang::Library& standardLibrary();

/// By parameter: the components of each point, or of all where there is one point's.
using Arguments = std::map<std::string, std::vector<double>, std::less<>>;

/// A texel of every image.
std::array<double, 4> texelAt(double u, double v);

/// The results of a node, each the components of all points side by side. What has no argument has its
/// default, or that of what is given where there is no template. `quads`: points stand in fours, as pixels
/// do. T is float or double. `image` stands behind every texture in place of texelAt().
template <class T>
std::vector<std::vector<T>> runNode(const std::string& form, const Arguments& arguments, size_t points,
                                    const std::string& variant = {}, bool quads = false,
                                    const eval::Sampler& image = {});

/// Places of all sizes: within a few cells, on and beside corners, negative ones, and large ones, up to
/// `largest`.
std::vector<Place> somePlaces(size_t count, int dimensions, float largest, uint64_t seed);

/// Components for Arguments.
std::vector<double> componentsOf(const std::vector<Place>& places, int dimensions);

}  // namespace lacquer::test
