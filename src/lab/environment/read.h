// A picture of the surroundings from a file, and the files that are made of it.
#pragma once

#include <string>

#include "environment/panorama.h"
#include "lacquer.h"

namespace lacquer {

/// Warnings are reported. Errors: those of readFile(), environment::readPanorama() and of the limits.
Result<environment::Panorama> panoramaOf(const std::string& path, const Options& options, Messages& messages);

/// Errors: "out-of-range".
Result<void> checkEnvironment(const Environment& of);
/// The names of the files, the description last.
Strings environmentFiles(const Environment& of);
/// What checkEnvironment() has accepted. Uses threads.
EnvironmentFiles filesOf(const Environment& of, const environment::Panorama& panorama,
                         const Progress& progress);

/// The text of environment.json.
std::string environmentJson(const EnvironmentMaps& maps);

}  // namespace lacquer
