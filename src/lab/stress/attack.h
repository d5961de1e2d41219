// Many samples of a subject: what goes wrong, how often, and the smallest input that still does it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lacquer/results.h"
#include "stress/subject.h"

namespace lacquer::stress {

struct Finding {
  Fault fault = Fault::NaN;
  std::string what;    ///< the root's name
  uint64_t count = 0;  ///< samples that do it
  double value = 0;    ///< at `input`: the wrong value, or the height of the jump
  /// The smallest samples found that do it: a group of the subject, or, for a jump, the two sides of it.
  std::vector<double> input;
  std::string known;  ///< why it is no mistake of ours; empty when it is
};

struct Report {
  std::string name;
  bool is_node = true;
  uint64_t samples = 0;
  std::vector<Finding> findings;       ///< sorted: by fault, then by root
  std::optional<StressEnergy> energy;  ///< materials only
};

struct Plan {
  uint64_t samples = 100000;
  uint64_t seed = 1;
  bool half = false;  ///< every operation rounded to half precision; only values are looked at
};

/// The same report for every number of threads.
Report attack(const Subject& subject, const Plan& plan);

/// True when these samples (Finding::input) do it.
bool shows(const Subject& subject, Fault fault, const std::string& what, std::span<const double> input,
           double& value);

/// Everything that is wrong at these samples: a group, or the two sides of a jump.
Report replay(const Subject& subject, std::span<const double> input);

/// Samples `first`, `first` + 1, … of an attack with that seed, side by side.
void drawSamples(const Subject& subject, uint64_t seed, uint64_t first, size_t count,
                 std::vector<double>& samples);
/// The worst of what a root's value, one of `values`, is at a sample: false where nothing is wrong.
bool faultAt(const Root& root, const std::vector<double>& values, size_t sample, Fault& fault, double& value);
/// Values to try for a component in the place of `x`, the plainest first.
std::vector<double> plainer(const Variable& variable, double x);

/// Reciprocity and energy of a material; adds to the report. docs/stress.md says how.
void measureLight(const Subject& subject, const Plan& plan, Report& report);

/// Why a jump there is none of ours; empty when nothing is known of it.
std::string_view knownJump(const Subject& subject, std::string_view condition);

/// What a material gives back beyond its base because of the texts' own formulas.
struct KnownSurplus {
  std::string_view parameter;  ///< that the material has
  double most = 0;             ///< of a white sky's light
  std::string_view why;
};
std::span<const KnownSurplus> knownSurpluses();
/// Why light and eye may not be exchanged in a subject; empty where that is a fault.
std::string_view knownAsymmetry(const Subject& subject);

}  // namespace lacquer::stress
