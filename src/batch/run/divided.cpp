#include "run/divided.h"

#include <algorithm>
#include <set>

#include "cost/cost.h"
#include "setting/language.h"
#include "setting/option_key.h"
#include "setting/options.h"
#include "support/blob.h"

namespace lacquer {

template <class Archive>
static void fields(Archive& archive, Lift& lift) {
  archive(lift.extensions, lift.live);
}

template <class Archive>
static void fields(Archive& archive, SharedProgram& shared) {
  archive(shared.lift, shared.structures);
}

template <class Archive>
static void fields(Archive& archive, Fallbacks& fallbacks) {
  archive(fallbacks.groups, fallbacks.domains, fallbacks.apart);
}

namespace programs {

template <class Archive>
static void fields(Archive& archive, ModelError& error) {
  archive(error.compared, error.scale, error.mean, error.largest, error.largest_structures);
}

template <class Archive>
static void fields(Archive& archive, Point& point) {
  archive(point.programs, point.cost, point.largest_rise, point.worst, point.made, point.first, point.second);
}

template <class Archive>
static void fields(Archive& archive, Curve& curve) {
  archive(curve.structures, curve.made, curve.measured, curve.driver, curve.error, curve.points);
}

template <class Archive>
static void fields(Archive& archive, NumberFill& fill) {
  archive(fill.own, fill.value);
}

template <class Archive>
static void fields(Archive& archive, TextureFill& fill) {
  archive(fill.own, fill.texel);
}

template <class Archive>
static void fields(Archive& archive, Fill& fill) {
  archive(fill.numbers, fill.textures);
}

}  // namespace programs

template <class Archive>
static void fields(Archive& archive, Divided& divided) {
  archive(divided.shared, divided.curve, divided.light_sets, divided.vertex_sets, divided.fallbacks);
}

namespace {

/// Of all of a graph that a shader is made of.
Key graphKey(const graph::Graph& graph, const Setting& setting) { return structureKey(graph, {}, setting); }

}  // namespace

std::map<std::string, double> weightsByShader(const std::vector<ProgramUse>& uses) {
  std::map<std::string, std::vector<double>> shares;
  for (const ProgramUse& use : uses) shares[use.shader].push_back(use.weight);
  std::map<std::string, double> weights;
  for (auto& [shader, all] : shares) {
    std::sort(all.begin(), all.end());
    double& weight = weights[shader];
    for (const double share : all) weight += share;
  }
  return weights;
}

std::optional<Key> dividedKey(const std::vector<const Structure*>& structures, const Examples& examples,
                              const std::vector<ProgramUse>& uses, const Setting& setting) {
  const Options& options = setting.options;
  KeyBuilder key;
  key.text("divided").key(setting.base);
  addOptions(options, {Decides::Graph, Decides::Module, Decides::Code, Decides::SpirvCode}, key);
  key.number(static_cast<uint64_t>(options.programs)).number(options.fallback);
  key.number(options.programs_report.empty());
  if (const bool by_model = options.programs_model || options.fallback; !by_model) {
    const std::string why_not = cost::unavailable();
    const std::string driver = cost::driverIdentity();
    if (why_not.empty() && driver.empty()) return std::nullopt;
    key.text(why_not).text(driver);
  }
  // Sorted: the key rests on no order of the files.
  std::set<Key> sorted;
  for (const Structure* structure : structures) sorted.insert(structure->key);
  key.number(static_cast<uint64_t>(sorted.size()));
  for (const Key& own : sorted) {
    const Example* example = examples.of(own);
    key.key(own).number(example != nullptr);
    if (example == nullptr) continue;
    key.key(example->shape.value_or(example->content)).number(example->shape ? -1 : example->material.index);
  }
  for (const auto& [shader, weight] : weightsByShader(uses)) key.text(shader).number(weight);
  return key.finish();
}

std::string toBlob(const Divided& divided) {
  BlobWriter blob;
  blob(divided);
  return blob.take();
}

std::optional<Divided> dividedFrom(std::string_view bytes, const std::vector<const Structure*>& structures,
                                   const Setting& setting) {
  Divided divided;
  BlobReader blob(bytes);
  blob(divided);
  const Result<const material::Schema*> schema = setting.library.models.schema();
  const Result<const model::Model*> model = setting.library.models.of(setting.options.profile);
  if (!blob.complete() || !schema || !model) return std::nullopt;
  std::set<Key> known;
  for (const Structure* structure : structures) known.insert(structure->key);
  const std::vector<std::string_view> terms = (*model)->liveTerms();
  for (const SharedProgram& shared : divided.shared) {
    const Lift& lift = shared.lift;
    const bool good = std::all_of(shared.structures.begin(), shared.structures.end(),
                                  [&](const Key& key) { return known.contains(key); }) &&
                      std::all_of(lift.extensions.begin(), lift.extensions.end(),
                                  [&](uint16_t one) { return one < (*schema)->extensions.size(); }) &&
                      std::all_of(lift.live.begin(), lift.live.end(), [&](const std::string& term) {
                        return std::find(terms.begin(), terms.end(), term) != terms.end();
                      });
    if (!good) return std::nullopt;
  }
  return divided;
}

std::string toBlob(const UnitedPrograms& united, const Setting& setting) {
  BlobWriter blob;
  blob(united.digest, static_cast<uint64_t>(united.programs.size()));
  for (const UnitedProgram& one : united.programs) {
    const std::string text = one.members.empty() ? std::string() : graph::toJson(one.united.graph);
    // By which one sees whether the text says all.
    const Key key = graphKey(one.united.graph, setting);
    blob(one.members, text, key, one.united.fills, one.united.choices);
  }
  return blob.take();
}

std::optional<UnitedPrograms> unitedFrom(std::string_view bytes, const Divided& divided,
                                         const Setting& setting) {
  UnitedPrograms united;
  BlobReader blob(bytes);
  uint64_t count = 0;
  blob(united.digest, count);
  if (!blob.good() || count != divided.shared.size()) return std::nullopt;
  for (uint64_t i = 0; i < count; ++i) {
    UnitedProgram& one = united.programs.emplace_back();
    std::string text;
    Key key;
    blob(one.members, text, key, one.united.fills, one.united.choices);
    if (!blob.good() || one.members.size() != one.united.fills.size()) return std::nullopt;
    if (one.members.empty()) continue;
    Result<graph::Graph> graph = graph::fromJson(text, "program", setting.limits);
    if (!graph || hasError(graph::check(*graph, setting.library, setting.limits.nodes))) return std::nullopt;
    if (graphKey(*graph, setting) != key) return std::nullopt;
    const bool whole = std::all_of(one.united.fills.begin(), one.united.fills.end(), [&](const auto& fill) {
      return fill.numbers.size() == graph->parameters.size() &&
             fill.textures.size() == graph->textures.size();
    });
    if (!whole) return std::nullopt;
    one.united.graph = std::move(*graph);
  }
  if (!blob.complete()) return std::nullopt;
  return united;
}

}  // namespace lacquer
