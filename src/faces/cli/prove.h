// The verb `prove`.
#pragma once

#include <string>
#include <vector>

#include "lacquer.h"

namespace lacquer::cli {

struct ProveFlags {
  bool json = false;  ///< everything, for programs
  Precision precision = Precision::Vulkan;
};

/// Prints what is proved of the materials of files (all, or those named), or of the node library when there
/// are none. Everything as JSON, or for people: counts, and what is not proved. False when something could
/// not be looked at, or when a node does not keep its contract.
bool prove(const std::vector<std::string>& files, const std::vector<std::string>& materials,
           const ProveFlags& flags, const Options& options, Messages& messages);

}  // namespace lacquer::cli
