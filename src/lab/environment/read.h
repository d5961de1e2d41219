// A picture of the surroundings from a file, and the files that are made of it.
#pragma once

#include <string>

#include "environment/surroundings.h"
#include "lacquer.h"

namespace lacquer {

/// Of a file; `scene` is that of Environment. Warnings are reported. Errors: those of readFile(),
/// environment::readSurroundings() and of the limits.
Result<environment::Surroundings> surroundingsOf(const std::string& path, int scene, const Options& options,
                                                 Messages& messages);

/// Errors: "out-of-range".
Result<void> checkEnvironment(const Environment& of);
/// The names of the files, the description last.
Strings environmentFiles(const Environment& of);
/// What checkEnvironment() has accepted. Uses threads.
EnvironmentFiles filesOf(const Environment& of, const environment::Surroundings& surroundings,
                         const Progress& progress);

/// The text of environment.json.
std::string environmentJson(const EnvironmentMaps& maps);

}  // namespace lacquer
