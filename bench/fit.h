// Weights fitted by least squares to what a driver says of this tree's shaders.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ir/module.h"
#include "lacquer/options.h"

namespace lacquer::bench {

/// A distinct shader of this tree, and what RADV says of it for navi21.
struct Sample {
  std::string name;
  ir::Module module;  ///< through all passes
  double cycles = 0, instructions = 0;
};

/// The works and examples, each material as it is and without or with each word of the library.
/// Throws std::runtime_error where a file cannot be read.
std::vector<Sample> measuredSamples(const Options& options, std::string& driver);

/// What is counted of a shader.
using Counted = std::vector<double>;
/// Weights for the counts that make the relative errors least in the square; none is below 0.
Counted fitted(const std::vector<Counted>& counts, const std::vector<double>& cycles);
double weighed(const Counted& counts, const Counted& weights);

struct FitError {
  double mean = 0, most = 0;  ///< relative
};
template <class Of>
FitError errorOf(const std::vector<double>& cycles, Of of) {
  FitError error;
  for (size_t i = 0; i < cycles.size(); ++i) {
    const double off = std::abs(of(i) / cycles[i] - 1);
    error.mean += off / static_cast<double>(cycles.size());
    error.most = std::max(error.most, off);
  }
  return error;
}

/// Prints the weights by all samples, and errors: of half of them on that half and on the others, of all.
void printFit(const std::vector<Counted>& counts, const std::vector<double>& cycles);
void printError(const char* what, const FitError& error, size_t shaders);

}  // namespace lacquer::bench
