#include "bench/estimate.h"

#include <fmt/format.h>

#include "bench/fit.h"
#include "cost/cost.h"
#include "lod/estimate.h"
#include "optimize/cost.h"

namespace lacquer::bench {

namespace {

Counted lodCounts(const ir::Module& module) {
  const auto all = lod::countsOf(module, ir::Stage::Fragment).all();
  return {all.begin(), all.end()};
}

Counted planCounts(const ir::Module& module) {
  optimize::Constants constants;
  const optimize::Plan plan = optimize::planOf(module, constants);
  const optimize::Tally tally = optimize::Counter(module).count(plan, constants);
  return {tally.begin(), tally.end()};
}

}  // namespace

int runEstimate() {
  if (const std::string reason = cost::unavailable(); !reason.empty()) {
    fmt::print(stderr, "nothing can be fitted: {}\n", reason);
    return 1;
  }
  Options options;
  options.targets = {Target::Spirv};
  options.validate = false;
  options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
  std::string driver;
  const std::vector<Sample> samples = measuredSamples(options, driver);
  fmt::print("{}\n\nlacquer lod's estimate\n", driver);
  std::vector<Counted> counts, plans;
  std::vector<double> cycles;
  double instructions = 0;
  for (const Sample& sample : samples) {
    counts.push_back(lodCounts(sample.module));
    plans.push_back(planCounts(sample.module));
    cycles.push_back(sample.cycles);
    instructions += sample.instructions / sample.cycles;
  }
  fmt::print("instructions for each cycle: {:.3g}\n", instructions / static_cast<double>(samples.size()));
  printFit(counts, cycles);
  printError(
      "with the weights that the program has",
      errorOf(cycles, [&](size_t i) { return static_cast<double>(lod::estimate(samples[i].module).cycles); }),
      samples.size());
  fmt::print("\nthe model of --optimize\n");
  printFit(plans, cycles);
  printError("with the weights that the program has",
             errorOf(cycles,
                     [&](size_t i) {
                       optimize::Tally tally{};
                       std::copy(plans[i].begin(), plans[i].end(), tally.begin());
                       return cyclesOf(tally, optimize::families()[0]);
                     }),
             samples.size());
  return 0;
}

}  // namespace lacquer::bench
