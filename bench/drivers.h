// What making pipelines of fragment shaders takes.
#pragma once

#include <string>
#include <vector>

namespace lacquer::bench {

/// Prints a JSON array: for each file of SPIR-V the milliseconds of processor time in which Mesa's RADV makes
/// a pipeline of it for navi21, the least of several. The modules must be valid.
int printDriverTimes(const std::vector<std::string>& files);

}  // namespace lacquer::bench
