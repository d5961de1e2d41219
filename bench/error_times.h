// How long bodies of nodes run on this machine's processor, through Vulkan.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/error_subjects.h"

namespace lacquer::bench {

struct Times {
  std::string device;   ///< "llvmpipe (LLVM 15.0.6, 256 bits)"; empty when nothing was measured
  std::string problem;  ///< why not
  /// By body, in the order of the subjects and their bodies: processor time of an invocation less that of the
  /// same shader around no body. A body that is hidden behind what is around it has 0.
  std::vector<std::optional<double>> nanoseconds;
};

Times lavapipeTimes(const lang::Library& library, const std::vector<Subject>& subjects);

}  // namespace lacquer::bench
