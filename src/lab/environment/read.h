// A picture of the surroundings from a file.
#pragma once

#include <string>

#include "environment/panorama.h"
#include "lacquer.h"

namespace lacquer {

/// Warnings are reported. Errors: those of readFile(), environment::readPanorama() and of the limits.
Result<environment::Panorama> panoramaOf(const std::string& path, const Options& options, Messages& messages);

}  // namespace lacquer
