#include "run/program_costs.h"

#include <algorithm>
#include <future>
#include <set>

#include "cache/cache.h"
#include "cost/choose.h"
#include "cost/cost.h"
#include "lod/estimate.h"
#include "shader/module.h"
#include "shader/print.h"
#include "shader/times.h"
#include "support/blob.h"
#include "support/jobs.h"

namespace lacquer {

using programs::Places;
using programs::Program;

namespace {

/// Up to so many programs a driver compiles every candidate, which takes some hundredths of a second each.
constexpr size_t kDriverPrograms = 64;
/// A graph of more structures takes too long to be made for a search.
constexpr size_t kMostUnited = 24;

Result<cost::Subject> subjectOf(const ir::Module& module, const Options& options) {
  ShaderData data;
  data.id = "program";
  data.has_vertex = hasVertexStage(module);
  data.module = module;
  Options spirv = options;
  spirv.targets = {Target::Spirv};
  spirv.validate = false;
  spirv.debug = false;
  Wrong wrong;
  print(data, spirv, wrong);
  for (Diagnostics& of_target : wrong) {
    if (hasError(of_target)) return tl::make_unexpected(std::move(of_target));
  }
  return cost::Subject{"program", std::move(data.spirv[0]), std::move(data.spirv[1])};
}

/// What the driver said of a subject.
struct Told {
  uint64_t cycles = 0;
  std::string driver;
};

template <class Archive>
void fields(Archive& archive, Told& of) {
  archive(of.cycles, of.driver);
}

/// Of this driver alone. Without a name of it there is no key.
std::optional<Key> costKey(const cost::Subject& subject, const std::string& driver) {
  if (driver.empty()) return std::nullopt;
  KeyBuilder key;
  key.text("driver").text(driver).text(cost::kFamilies[0]);
  for (const cost::Spirv* words : {&subject.vertex, &subject.fragment})
    key.text({reinterpret_cast<const char*>(words->data()), words->size() * sizeof(uint32_t)});
  return key.finish();
}

/// Two processes at a time: the subjects in two halves.
std::vector<cost::Outcome> measureSubjects(const std::vector<cost::Subject>& subjects, std::string& driver) {
  const auto middle = subjects.begin() + static_cast<ptrdiff_t>(subjects.size() / 2);
  const std::vector<cost::Subject> first(subjects.begin(), middle);
  const std::vector<cost::Subject> second(middle, subjects.end());
  const auto measure = [](const std::vector<cost::Subject>& some) {
    return some.empty() ? cost::Measurement() : cost::measure(some, cost::kFamilies[0], false);
  };
  std::future<cost::Measurement> running = std::async(std::launch::async, measure, std::cref(first));
  cost::Measurement rest = measure(second);
  cost::Measurement begun = running.get();
  driver = rest.driver.empty() ? begun.driver : rest.driver;
  std::vector<cost::Outcome> all = std::move(begun.outcomes);
  std::move(rest.outcomes.begin(), rest.outcomes.end(), std::back_inserter(all));
  return all;
}

}  // namespace

static Options withoutSearch(Options options) {
  options.optimize = 0;
  options.optimize_error = 0;
  options.half = false;
  return options;
}

static Setting withOptions(const Setting& s, const Options& options) {
  return {options,  s.library, s.base, s.cache,   s.times,  s.limits,
          s.folder, s.sharing, s.keys, s.several, s.id_bits};
}

ProgramCosts::ProgramCosts(const Setting& setting, const std::vector<OwnProgram>& all, bool by_model)
    : plain_(withoutSearch(setting.options)),
      setting_(withOptions(setting, plain_)),
      all_(all),
      no_driver_(by_model || !cost::unavailable().empty()) {
  by_driver_ = !no_driver_ && all.size() <= kDriverPrograms;
}

Lift ProgramCosts::liftOf(const Places& group) const {
  Lift lift;
  for (const uint32_t item : group) {
    for (size_t i = 0; i < all_[item].graphs.size(); ++i)
      addTo(lift, *all_[item].examples[i], all_[item].graphs[i], setting_);
  }
  return lift;
}

Result<ir::Module> ProgramCosts::moduleOfGroup(const Places& group) const {
  const Structure& first = *all_[group[0]].structures[0];
  if (group.size() == 1) return moduleOf(first, setting_);
  const Lift lift = liftOf(group);
  std::vector<graph::Graph> graphs;
  std::set<Key> seen;
  for (const uint32_t item : group) {
    const OwnProgram& program = all_[item];
    for (size_t i = 0; i < program.graphs.size(); ++i) {
      const Example& example = *program.examples[i];
      const Result<graph::Graph> own = graphOf(example, setting_);
      if (!own) return tl::make_unexpected(own.error());
      const material::Material* material = example.graph ? nullptr : &example.material;
      graph::Graph more = lifted(material, example.attributes, *own, lift, setting_);
      if (seen.insert(structureKey(more, first.lights, setting_)).second) graphs.push_back(std::move(more));
    }
  }
  std::vector<const graph::Graph*> members;
  for (const graph::Graph& graph : graphs) members.push_back(&graph);
  const Result<programs::United> united = programs::unite(members, setting_.library);
  if (!united) return tl::make_unexpected(united.error());
  return toModule(united->graph, setting_.library, setting_.options, first.lights, {},
                  cost::chooserOf(setting_.options));
}

Program ProgramCosts::byModel(const ir::Module& module) {
  Program program;
  program.cost = static_cast<double>(lod::estimate(module).cycles);
  const std::vector<double> cycles = lod::cyclesByTerm(module);
  std::map<uint32_t, double> features;
  for (size_t term = 0; term < cycles.size(); ++term) {
    if (cycles[term] == 0) continue;
    const std::string& name = module.dag.terms()[term].name;
    const auto id = features_.emplace(name, static_cast<uint32_t>(features_.size())).first->second;
    features[id] += cycles[term];
  }
  for (const auto& [id, cost] : features) program.features.push_back({id, cost});
  return program;
}

size_t ProgramCosts::structuresOf(const Places& group) const {
  size_t count = 0;
  for (const uint32_t item : group) count += all_[item].graphs.size();
  return count;
}

/// Without a shader: the dearest of each term, and what choices took in the groups of which there were
/// shaders.
Program ProgramCosts::byTerms(const Places& group) const {
  std::map<uint32_t, double> features;
  double always = 0;  // what is in no term
  for (const uint32_t item : group) {
    const Program& program = alone_.at(item);
    double rest = program.cost;
    for (const programs::Feature& feature : program.features) {
      features[feature.id] = std::max(features[feature.id], feature.cost);
      rest -= feature.cost;
    }
    always = std::max(always, rest);
  }
  Program program;
  program.cost = always;
  for (const auto& [id, cost] : features) {
    program.features.push_back({id, cost});
    program.cost += cost;
  }
  program.cost += choicesOf(structuresOf(group));
  return program;
}

/// There are only so many places to choose at: many structures take no more than the most that was seen.
double ProgramCosts::choicesOf(size_t structures) const {
  return chosen_ > 0 ? std::min(choices_ / chosen_ * static_cast<double>(structures), most_choices_) : 0;
}

std::optional<double> ProgramCosts::told(const std::optional<Key>& key) {
  if (!key || setting_.cache == nullptr) return std::nullopt;
  const StageTimer timer(setting_.times, StageOfRun::Cache);
  const std::optional<std::string> bytes = setting_.cache->get(*key);
  if (!bytes) return std::nullopt;
  BlobReader blob(*bytes);
  Told told;
  blob(told);
  if (!blob.complete()) return std::nullopt;
  driver_ = told.driver;
  return static_cast<double>(told.cycles);
}

std::vector<std::optional<Program>> ProgramCosts::measure(const std::vector<Places>& groups) {
  const auto made = [&](const Places& group) {
    return group.size() == 1 || structuresOf(group) <= kMostUnited;
  };
  std::vector<Result<ir::Module>> modules(groups.size());
  inParallel(groups.size(), [&](size_t i) {
    const StageTimer timer(setting_.times, StageOfRun::Programs);
    if (by_driver_ || made(groups[i])) modules[i] = moduleOfGroup(groups[i]);
  });
  std::vector<std::optional<Program>> all(groups.size());
  for (size_t i = 0; i < groups.size(); ++i) {
    const Places& group = groups[i];
    if (!by_driver_ && !made(group)) {
      all[i] = byTerms(group);
      continue;
    }
    if (!modules[i]) continue;
    all[i] = byModel(*modules[i]);
    if (group.size() == 1) {
      alone_[group[0]] = *all[i];
    } else {
      const double terms = byTerms(group).cost - choicesOf(structuresOf(group));
      const double beyond = std::max(0.0, all[i]->cost - terms);
      choices_ += beyond;
      chosen_ += static_cast<double>(structuresOf(group));
      most_choices_ = std::max(most_choices_, beyond);
    }
  }
  if (!by_driver_) return all;
  const std::vector<std::optional<double>> costs = cyclesOf(modules);
  for (size_t i = 0; i < groups.size(); ++i) {
    if (!all[i]) continue;
    if (!costs[i]) {
      all[i].reset();  // what the driver does not compile is no program
      continue;
    }
    for (programs::Feature& feature : all[i]->features) feature.cost *= *costs[i] / all[i]->cost;
    all[i]->cost = *costs[i];
  }
  return all;
}

std::vector<std::optional<double>> ProgramCosts::byDriver(const std::vector<Places>& groups) {
  if (no_driver_) return std::vector<std::optional<double>>(groups.size());
  std::vector<Result<ir::Module>> modules(groups.size());
  inParallel(groups.size(), [&](size_t i) {
    const StageTimer timer(setting_.times, StageOfRun::Programs);
    modules[i] = moduleOfGroup(groups[i]);
  });
  return cyclesOf(modules);
}

/// What is in the cache is not measured again.
std::vector<std::optional<double>> ProgramCosts::cyclesOf(const std::vector<Result<ir::Module>>& modules) {
  std::vector<std::optional<double>> all(modules.size());
  std::vector<Result<cost::Subject>> made(modules.size());
  inParallel(modules.size(), [&](size_t i) {
    const StageTimer timer(setting_.times, StageOfRun::Programs);
    made[i] = modules[i] ? subjectOf(*modules[i], setting_.options) : tl::make_unexpected(modules[i].error());
  });
  const std::string identity = cost::driverIdentity();
  std::vector<cost::Subject> subjects;
  std::vector<std::pair<size_t, std::optional<Key>>> places;
  for (size_t i = 0; i < modules.size(); ++i) {
    if (!made[i]) continue;
    const std::optional<Key> key = costKey(*made[i], identity);
    all[i] = told(key);
    if (all[i]) continue;
    subjects.push_back(std::move(*made[i]));
    places.emplace_back(i, key);
  }
  if (subjects.empty()) return all;
  const StageTimer timer(setting_.times, StageOfRun::Driver);
  const std::vector<cost::Outcome> outcomes = measureSubjects(subjects, driver_);
  for (size_t i = 0; i < outcomes.size(); ++i) {
    failed_ |= !outcomes[i].statistics.has_value();
    if (!outcomes[i].statistics) continue;
    Told said{outcomes[i].statistics->inverse_throughput, driver_};
    all[places[i].first] = static_cast<double>(said.cycles);
    if (setting_.cache == nullptr || !places[i].second) continue;
    BlobWriter blob;
    blob(said);
    setting_.cache->put(*places[i].second, blob.take(), true);
  }
  return all;
}

}  // namespace lacquer
