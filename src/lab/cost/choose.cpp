#include "cost/choose.h"

#include <algorithm>

#include "cost/cost.h"
#include "shader/module.h"
#include "shader/print.h"

namespace lacquer::cost {

namespace {

std::string familyOf(const Options& options) {
  const Strings all = optimizeFamilies();
  return options.optimize_for.empty() ? all.at(0) : options.optimize_for;
}

/// A subject of a module that went through all passes; without words where it cannot be written.
Subject subjectOf(const ir::Module& module, const Options& options) {
  ShaderData data;
  data.id = "form";
  data.has_vertex = hasVertexStage(module);
  data.module = module;
  Options spirv = options;
  spirv.targets = {Target::Spirv};
  spirv.validate = false;
  spirv.debug = false;
  spirv.spirv_route = SpirvRoute::Direct;
  Wrong wrong;
  print(data, spirv, wrong);
  return {data.id, std::move(data.spirv[0]), std::move(data.spirv[1])};
}

}  // namespace

bool choosesByDriver(const Options& options) {
  if ((options.optimize == 0 && !options.half) || options.programs_model || !unavailable().empty())
    return false;
  // One that cannot be told from another would choose for it in a cache.
  if (driverIdentity().empty()) return false;
  return std::find(kFamilies.begin(), kFamilies.end(), familyOf(options)) != kFamilies.end();
}

passes::Choose chooserOf(const Options& options) {
  if (!choosesByDriver(options)) return {};
  return [options](std::span<const ir::Module> forms) -> std::optional<passes::Choice> {
    std::vector<Subject> subjects;
    for (const ir::Module& form : forms) subjects.push_back(subjectOf(form, options));
    const Measurement measured = measure(subjects, familyOf(options), false);
    const auto& all = measured.outcomes;
    if (all.empty() || !all[0].statistics) return std::nullopt;
    passes::Choice choice{0, measured.driver, 0, 0};
    const auto of = [&](size_t i) {
      return std::pair(all[i].statistics->inverse_throughput, all[i].statistics->instructions);
    };
    for (size_t i = 1; i < all.size(); ++i) {
      if (all[i].statistics && of(i) < of(choice.index)) choice.index = i;
    }
    choice.plain = static_cast<double>(of(0).first);
    choice.cycles = static_cast<double>(of(choice.index).first);
    return choice;
  };
}

}  // namespace lacquer::cost
