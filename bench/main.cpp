// `./dev bench VERB`: one row per benchmark.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>

#include "bench/cost.h"
#include "bench/drivers.h"
#include "bench/error.h"
#include "bench/estimate.h"
#include "bench/fragments.h"
#include "bench/fronts.h"
#include "bench/loops.h"
#include "bench/optimize.h"
#include "bench/pipeline_bench.h"

namespace {

struct Verb {
  std::string_view name, what;
  int (*run)();
};

constexpr Verb kVerbs[] = {
    {"cost", "what the works cost on AMD GPUs; renews bench/cost.json and docs/cost.md",
     lacquer::bench::runCost},
    {"error", "what variants of nodes are wrong by and save; renews bench/error.json and docs/error.md",
     lacquer::bench::runError},
    {"estimate",
     "fits the weights of the costs that `lacquer lod` estimates without Mesa, and prints their error",
     lacquer::bench::runEstimate},
    {"fronts",
     "run time against error of every node, as `lacquer tune` finds it, in minutes; renews a table of "
     "docs/error.md",
     lacquer::bench::runFronts},
    {"loops", "loops written out and kept: instructions and cycles on an AMD GPU", lacquer::bench::runLoops},
    {"optimize",
     "what the search for cheaper forms saves and takes, in minutes; renews bench/optimize.json and "
     "docs/optimize.md",
     lacquer::bench::runOptimize},
    {"pipeline", "what making shaders takes, against glslang and spirv-opt; renews bench/pipeline.json",
     lacquer::bench::runPipeline},
};

int run(int argc, char** argv) {
  if (argc == 4 && std::string_view(argv[1]) == "repeat")
    return lacquer::bench::repeat(argv[2], std::strtoul(argv[3], nullptr, 10));
  if (argc > 2 && std::string_view(argv[1]) == "drivers")
    return lacquer::bench::printDriverTimes({argv + 2, argv + argc});
  if (argc == 3 && std::string_view(argv[1]) == "fragments")
    return lacquer::bench::printFragmentTimes(argv[2]);
  for (const Verb& verb : kVerbs) {
    if (argc == 2 && verb.name == argv[1]) return verb.run();
  }
  fmt::print(stderr, "usage: bench VERB\n\n");
  for (const Verb& verb : kVerbs) fmt::print(stderr, "  {:8} {}\n", verb.name, verb.what);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench: {}\n", error.what());
    return 1;
  }
}
