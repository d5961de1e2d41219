// The passes in their order.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "passes/passes.h"
#include "support/digest.h"

namespace lacquer::passes {

struct PipelineOptions {
  LightFacts lights;
  /// Called with each pass's name and what it left.
  std::function<void(std::string_view pass, const ir::Module&)> after;
  double relaxed = 0;  ///< Options::relaxed
};

/// Runs every pass on a lowered module; afterwards it is ready for a target's legalize pass and schedule().
/// The module is verified after each pass in debug builds.
void runPipeline(ir::Module& module, const PipelineOptions& options);

struct PassInfo {
  std::string_view name;
  std::string_view does;  ///< for the documentation
};
/// The passes, in order.
std::span<const PassInfo> passes();

/// BLAKE2b of ir::canonical() of a module that went through the pipeline.
Digest contentDigest(const ir::Module& module);
/// Its first 128 bits as 32 hexadecimal digits.
std::string contentAddress(const Digest& digest);

}  // namespace lacquer::passes
