// A node of nodes/standard/ at many points.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lang/library.h"
#include "patterns/reference.h"

namespace lacquer::test {

/// The library with nodes/standard/.
const lang::Library& standardLibrary();

/// By parameter: the components of each point, or of all where there is one point's.
using Arguments = std::map<std::string, std::vector<double>, std::less<>>;

/// The results of a node, each the components of all points side by side. What has no argument has its
/// default, or that of what is given where there is no template. T is float or double.
template <class T>
std::vector<std::vector<T>> runNode(const std::string& form, const Arguments& arguments, size_t points,
                                    const std::string& variant = {});

/// Places of all sizes: within a few cells, on and beside corners, negative ones, and large ones, up to
/// `largest`.
std::vector<Place> somePlaces(size_t count, int dimensions, float largest, uint64_t seed);

/// Components for Arguments.
std::vector<double> componentsOf(const std::vector<Place>& places, int dimensions);

}  // namespace lacquer::test
