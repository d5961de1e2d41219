// The passes in their order.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "optimize/optimize.h"
#include "passes/passes.h"
#include "support/digest.h"

namespace lacquer::passes {

/// Which of some forms of a module is taken.
struct Choice {
  size_t index = 0;
  std::string by;                ///< who chose it
  double plain = 0, cycles = 0;  ///< of the first, and of the one that is taken
};
/// Given forms of a module that went through all passes, the plain one first. Nothing where it has no
/// opinion.
using Choose = std::function<std::optional<Choice>(std::span<const ir::Module> forms)>;

/// Which form the pass `half` takes, where `optimize` has decided that as well.
struct HalfForm {
  size_t index = 0;  ///< in halves()
  ir::Half said;
};

/// The form that a choice among halves() gives, the first of which is at 32 bits: types of 16 bits only where
/// they take fewer cycles.
HalfForm halfOf(const Choice& choice);

/// The result of the pass `optimize`.
struct Searched {
  std::optional<ir::Module> module;
  std::optional<HalfForm> half;
};

struct PipelineOptions {
  LightFacts lights;
  /// Called with each pass's name and what it left.
  std::function<void(std::string_view pass, const ir::Module&)> after;
  double relaxed = 0;  ///< Options::relaxed
  optimize::Settings optimize{};
  Choose choose{};  ///< of what `optimize` finds; the model where there is none
  OtherLayout other{};
  bool bindless = false;         ///< Options::binding
  bool arrays = false;           ///< the same
  bool static_samplers = false;  ///< Options::static_samplers
  bool half = false;             ///< Options::half
  /// Where it holds something, `optimize` takes that instead of a search: it must be of the same module with
  /// the same options but for `other`. Else what comes of the search is put there. May be null.
  Searched* searched = nullptr;
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
