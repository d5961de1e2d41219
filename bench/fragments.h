// What a fragment takes on a processor.
#pragma once

#include <string>

namespace lacquer::bench {

/// Prints {"device": NAME, "nanoseconds": [...]}: for each of the `sweeps` of a JSON file the nanoseconds of
/// processor time of one invocation on the first Vulkan device, which must be a processor. A sweep has the
/// `file` of its SPIR-V, its `inputs` by location ({"components", "values": at three corners}), its `blocks`
/// ({"set", "binding", "bytes"}) and its `textures` ({"set", "binding", "shape"}), which have one colour. The
/// file's `rounds` are how often each has its turn. The modules must be valid.
int printFragmentTimes(const std::string& file);

}  // namespace lacquer::bench
