// A picture of the surroundings from a file, and the description of the files that are made of it.
#pragma once

#include <string>

#include "environment/panorama.h"
#include "lacquer.h"

namespace lacquer {

/// Warnings are reported. Errors: those of readFile(), environment::readPanorama() and of the limits.
Result<environment::Panorama> panoramaOf(const std::string& path, const Options& options, Messages& messages);

/// The text of environment.json.
std::string environmentJson(const EnvironmentMaps& maps);

}  // namespace lacquer
