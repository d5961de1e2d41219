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

}  // namespace programs

template <class Archive>
static void fields(Archive& archive, Divided& divided) {
  archive(divided.shared, divided.curve, divided.light_sets, divided.vertex_sets, divided.fallbacks);
}

namespace {

/// What a material's graphs depend on, with whatever lift; of a graph that is the input, the graph.
void addExample(const Example& example, const Structure& structure, const KnownShapes* shapes,
                const Setting& setting, KeyBuilder& key) {
  const material::Material& material = example.material;
  const Strings& live = setting.options.live;
  const bool watched = std::any_of(live.begin(), live.end(), [&](const std::string& name) {
    return watchedPath(name, material.index).has_value();
  });
  if (shapes != nullptr && !example.graph && !material.patterns && !watched)
    key.text(shapes->keyOf(material, example.attributes, structure.lights));
  else
    key.key(example.content).number(watched ? material.index : -1);
}

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
                              const KnownShapes* shapes, const std::vector<ProgramUse>& uses,
                              const Setting& setting) {
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
  // Whatever the order in which they were met.
  std::map<Key, const Structure*> sorted;
  for (const Structure* structure : structures) sorted.emplace(structure->key, structure);
  key.number(static_cast<uint64_t>(sorted.size()));
  for (const auto& [own, structure] : sorted) {
    const Example* example = examples.of(own);
    key.key(own).number(example != nullptr);
    if (example != nullptr) addExample(*example, *structure, shapes, setting, key);
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

}  // namespace lacquer
