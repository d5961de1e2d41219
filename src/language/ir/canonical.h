// A module as bytes that are equal for two modules just when every target makes the same of them.
#pragma once

#include <string>

#include "ir/module.h"

namespace lacquer::ir {

/// Of a placed and bound module. It covers everything that reaches a target's text or interface, and nothing
/// else: no material's name, no index into a file, no pointer, no number that is not baked, nothing of what
/// else the DAG ever held. Every text has its length before it, so that no two sequences look alike.
std::string canonical(const Module& module);

}  // namespace lacquer::ir
