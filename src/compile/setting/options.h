// What options say, and what callers can get wrong without any file: options, enumerators, numbers, names.
#pragma once

#include <string>
#include <string_view>

#include "lacquer/options.h"
#include "lower/lower.h"
#include "optimize/optimize.h"
#include "passes/passes.h"
#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer {

/// Of the targets, those that are registered among them.
inline constexpr size_t kMostTargets = 32;

/// What inputs may be at most, with the options' changes. Errors: those of setLimit().
Result<Limits> limitsOf(const Options& options);

/// What is wrong with the options that a graph and its module depend on; empty when all is well.
Diagnostics checkReading(const Options& options);
/// The same, and what is wrong with the targets.
Diagnostics checkOptions(const Options& options);

/// "out-of-range" where a number of an argument is.
Result<void> inRange(std::string_view what, uint64_t value, uint64_t least, uint64_t most,
                     std::string_view unit);
/// "no-path" where a file or folder has no name: it would be the root of the file system, or nothing.
Result<void> hasPath(std::string_view what, const std::string& path);

/// `scene`: what is known of the lights where the options ask for the file's.
passes::LightFacts lightFacts(const Options& options, const passes::LightFacts& scene);
/// What the options ask of the search; the family null where none is named.
optimize::Settings optimization(const Options& options);
lower::ParameterMode parameterMode(const Options& options);
/// Whether the samplers that a file says are a part of the material's graph.
bool knowsSamplers(const Options& options);

}  // namespace lacquer
