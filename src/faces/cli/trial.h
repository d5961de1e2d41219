// Flags for what is tried of a material that stays as it is.
#pragma once

#include <CLI/CLI.hpp>

#include "lacquer.h"

namespace lacquer::cli {

/// "--set NAME=0.5", "--set NAME=1,0.5,0", as often as there are parameters.
void addParameters(CLI::App& verb, NamedNumbers& parameters);

/// "--time" and "--frame", when it is looked at.
void addClock(CLI::App& verb, double& time, double& frame);

/// "--values" and "--scale", how a value is drawn.
void addValueLook(CLI::App& verb, ValueLook& look);

}  // namespace lacquer::cli
