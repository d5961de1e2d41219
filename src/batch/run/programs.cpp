#include "run/programs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "run/program_costs.h"
#include "structures/describe.h"
#include "support/file.h"
#include "support/jobs.h"
#include "support/text.h"

namespace lacquer {

using programs::Item;
using programs::Places;

namespace {

/// So many programs a driver compiles for a report, or to say how far the model is off.
constexpr size_t kMostMeasured = 160;

/// By shader. Everything is sorted by content, so that neither the order of the files nor that of the threads
/// shows; keys would bring in the versions of the tools.
std::vector<OwnProgram> ownPrograms(const std::vector<const Structure*>& structures, const Examples& examples,
                                    const Setting& setting) {
  std::map<std::string, std::vector<const Structure*>> by_shader;
  for (const Structure* structure : structures) {
    if (!structure->shader.empty()) by_shader[structure->shader].push_back(structure);
  }
  std::vector<OwnProgram> all;
  for (auto& [shader, list] : by_shader) {
    std::sort(list.begin(), list.end(),
              [](const Structure* a, const Structure* b) { return a->graph < b->graph; });
    OwnProgram one{shader, {}, {}, {}};
    for (const Structure* structure : list) {
      Result<graph::Graph> graph = graph::fromJson(structure->graph, shader, setting.limits);
      const Example* example = examples.of(structure->key);
      if (!graph || hasError(graph::check(*graph, setting.library, setting.limits.nodes)) ||
          example == nullptr)
        continue;
      one.examples.push_back(example);
      one.structures.push_back(structure);
      one.graphs.push_back(std::move(*graph));
    }
    if (!one.structures.empty()) all.push_back(std::move(one));
  }
  return all;
}

/// What a shader is specialised in that no material chooses: the known lights, and what a primitive has
/// beside its material, such as a skin.
using Domain = std::pair<std::map<std::string, int>, std::vector<std::string>>;

Domain domainOf(const OwnProgram& program) { return {lightsOf(program), program.graphs[0].attributes}; }

std::vector<Item> itemsOf(const std::vector<OwnProgram>& all, const std::vector<ProgramUse>& uses,
                          ProgramCosts& costs) {
  std::map<std::string, double> weights = weightsByShader(uses);
  std::map<Domain, uint32_t> domains;
  std::vector<Item> items;
  std::vector<Places> alone;
  for (uint32_t i = 0; i < all.size(); ++i) {
    Item item{all[i].shader, weights[all[i].shader], {}, 0};
    item.domain = domains.emplace(domainOf(all[i]), static_cast<uint32_t>(domains.size())).first->second;
    items.push_back(std::move(item));
    alone.push_back({i});
  }
  const std::vector<std::optional<programs::Program>> measured = costs.measure(alone);
  for (size_t i = 0; i < items.size(); ++i) {
    if (measured[i])
      items[i].program = *measured[i];
    else
      items[i].domain = static_cast<uint32_t>(domains.size() + i);  // it stays alone
  }
  return items;
}

/// Up to so many programs each point of the curve is made better by itself.
constexpr size_t kImproved = 64;

/// One for each step, the first without a merge.
std::vector<programs::Division> divisionsOf(const std::vector<Item>& items, const programs::Merging& merging,
                                            size_t wanted, bool all, const programs::Measure& measure) {
  std::vector<programs::Division> divisions;
  for (size_t step = 0; step <= merging.steps.size(); ++step) {
    const size_t programs = items.size() - step;
    if (!all && programs != wanted && step != merging.steps.size()) continue;
    programs::Division division = divisionOf(items, merging, programs);
    const bool better = programs == wanted || (!all && programs > wanted) || items.size() <= kImproved;
    divisions.push_back(better ? improved(items, division, measure) : std::move(division));
  }
  return divisions;
}

/// How far the model is off, over programs spread evenly.
programs::ModelError errorOf(const std::vector<Item>& items, const programs::Merging& merging,
                             ProgramCosts& measure) {
  const size_t count = items.size() + merging.steps.size();
  const size_t step = (count + kMostMeasured - 1) / kMostMeasured;
  std::vector<Places> groups;
  std::vector<double> model;
  for (size_t i = 0; i < count; i += step) {
    groups.push_back(merging.members(static_cast<uint32_t>(i), items.size()));
    model.push_back(i < items.size() ? items[i].program.cost : merging.steps[i - items.size()].cost);
  }
  const std::vector<std::optional<double>> said = measure.byDriver(groups);
  std::vector<programs::Compared> compared;
  for (size_t i = 0; i < said.size(); ++i) {
    if (said[i]) compared.push_back({model[i], *said[i], groups[i].size()});
  }
  return programs::fitModel(compared);
}

}  // namespace

Programs::Programs(const std::vector<const Structure*>& structures, const Examples& examples,
                   const std::vector<ProgramUse>& uses, size_t materials, const Setting& setting)
    : setting_(setting), shapes_(examples.shapes()) {
  std::optional<Divided> kept;
  if (setting.cache != nullptr) {
    key_ = dividedKey(structures, examples, uses, setting);
    const StageTimer timer(setting.times, StageOfRun::Cache);
    if (const std::optional<std::string> bytes = key_ ? setting.cache->get(*key_) : std::nullopt)
      kept = dividedFrom(*bytes, structures, setting);
  }
  if (kept)
    divided_ = std::move(*kept);
  else
    decide(structures, examples, uses);
  divided_.curve.materials = materials;
  std::map<Key, const Structure*> known;
  for (const Structure* structure : structures) known.emplace(structure->key, structure);
  for (const SharedProgram& shared : divided_.shared) {
    const auto group = std::make_shared<Group>();
    group->lift = shared.lift;
    groups_.push_back(group);
    for (const Key& one : shared.structures) {
      const Structure& structure = *known.at(one);
      members_[one] = {group, structure.looks_through};
      addReader(structure, group->readers);
    }
  }
}

void Programs::decide(const std::vector<const Structure*>& structures, const Examples& examples,
                      const std::vector<ProgramUse>& uses) {
  const Options& options = setting_.options;
  const std::vector<OwnProgram> all = ownPrograms(structures, examples, setting_);
  std::set<std::map<std::string, int>> lights;
  std::set<std::vector<std::string>> vertices;
  for (const OwnProgram& one : all) {
    lights.insert(lightsOf(one));
    vertices.insert(one.graphs[0].attributes);
  }
  divided_.light_sets = lights.size();
  divided_.vertex_sets = vertices.size();
  ProgramCosts costs(setting_, all, options.programs_model || options.fallback);
  if (options.fallback) {
    divided_.fallbacks = fallbacksOf(all, costs, setting_);
    share(all, divided_.fallbacks.groups, costs);
  } else {
    divide(all, uses, costs);
  }
  if (costs.failed()) key_.reset();
  if (!key_) return;
  const StageTimer timer(setting_.times, StageOfRun::Cache);
  setting_.cache->put(*key_, toBlob(divided_), true);
}

void Programs::share(const std::vector<OwnProgram>& all, const std::vector<Places>& groups,
                     const ProgramCosts& costs) {
  for (const Places& places : groups) {
    if (places.size() == 1) continue;
    SharedProgram shared{costs.liftOf(places), {}};
    for (const uint32_t item : places) {
      for (const Structure* structure : all[item].structures) shared.structures.push_back(structure->key);
    }
    divided_.shared.push_back(std::move(shared));
  }
}

void Programs::divide(const std::vector<OwnProgram>& all, const std::vector<ProgramUse>& uses,
                      ProgramCosts& costs) {
  const Options& options = setting_.options;
  const std::vector<Item> items = itemsOf(all, uses, costs);
  const bool report = !options.programs_report.empty();
  const size_t wanted = options.programs == 0 ? items.size() : options.programs;
  const programs::Measure measure = [&](const std::vector<Places>& groups) { return costs.measure(groups); };
  const programs::Merging merging = programs::merge(items, report ? 1 : wanted, measure);
  const std::vector<programs::Division> divisions = divisionsOf(items, merging, wanted, report, measure);
  const auto made = std::find_if(divisions.begin(), divisions.end(),
                                 [&](const programs::Division& one) { return one.groups.size() <= wanted; });
  const programs::Division& division = made == divisions.end() ? divisions.back() : *made;
  share(all, division.groups, costs);
  programs::Curve& curve = divided_.curve;
  curve.structures = items.size();
  curve.made = division.groups.size();
  curve.measured = merging.measured;
  if (!report) return;
  curve.points = programs::pointsOf(items, merging, divisions);
  if (costs.measured()) {
    curve.driver = costs.driver();
    return;
  }
  curve.error = errorOf(items, merging, costs);
  for (programs::Point& point : curve.points) point.cost *= curve.error.scale;
}

bool Programs::beside() const { return setting_.options.fallback; }

Sharing::Share Programs::bring(Traced& own, const material::Material* material,
                               const gltf::VertexAttributes& attributes, const passes::LightFacts& lights) {
  const auto found = members_.find(structureKey(own.graph, lights, setting_));
  if (found == members_.end()) return {};
  Group& group = *found->second.group;
  model::Origins origins;
  for (const auto& number : own.numbers) origins.parameters.push_back(*number);  // none of a graph
  for (const auto& texture : own.textures) origins.textures.push_back(*texture);
  const graph::Graph more = lifted(material, attributes, own.graph, group.lift, setting_, &origins);
  const Key key = structureKey(more, lights, setting_);
  if (!closed_) {
    const std::lock_guard lock(group.mutex);
    if (!group.graphs.contains(key)) group.graphs.emplace(key, withoutMaterial(more, setting_));
    return {};
  }
  const auto place = group.places.find(key);
  if (place == group.places.end()) return {};
  const programs::Fill& fill = group.united.fills[place->second];
  own.graph = programs::instance(group.united, place->second, more);
  // Numbers of a graph, and of a surface of MaterialX, come from no property.
  own.numbers.assign(own.graph.parameters.size(), std::nullopt);
  for (size_t i = 0; i < own.numbers.size(); ++i) {
    const auto at = fill.numbers[i].own ? more.findParameter(own.graph.parameters[i].name) : std::nullopt;
    if (at && *at < origins.parameters.size()) own.numbers[i] = origins.parameters[*at];
  }
  own.textures.assign(own.graph.textures.size(), std::nullopt);
  for (size_t i = 0; i < own.textures.size(); ++i) {
    for (size_t k = 0; fill.textures[i].own && k < origins.textures.size(); ++k) {
      if (more.textures[k].name == own.graph.textures[i].name) own.textures[i] = origins.textures[k];
    }
  }
  return {&fill, found->second.looks_through, beside() ? &group.readers : nullptr};
}

Diagnostics Programs::about(size_t made) const {
  if (setting_.options.fallback) return lacquer::about(divided_.fallbacks);
  const size_t wanted = setting_.options.programs;
  if (wanted == 0 || made <= wanted) return {};
  std::string help = fmt::format("the others cannot be made one: give --programs {}", made);
  if (divided_.light_sets > 1) {
    help = fmt::format(
        "materials of {} different sets of known lights share none: give --lights any, or the same counts "
        "for all, or --programs {}",
        divided_.light_sets, made);
  } else if (divided_.vertex_sets > 1) {
    help = fmt::format(
        "primitives of {} different vertex stages (skins, morph targets, instances, integers) share none: "
        "give --programs {}",
        divided_.vertex_sets, made);
  }
  return {{"programs",
           Severity::Warning,
           {},
           fmt::format("there are {} programs, not at most {}", made, wanted),
           std::move(help),
           {}}};
}

std::optional<Key> Programs::unitedKey() const {
  if (!key_ || shapes_ == nullptr) return std::nullopt;
  KeyBuilder key;
  key.text("united").key(*key_);
  for (const auto& [structure, shape] : *shapes_) key.key(structure).key(shape);
  return key.finish();
}

bool Programs::closeAsBefore() {
  const std::optional<Key> key = unitedKey();
  if (!key) return false;
  const StageTimer timer(setting_.times, StageOfRun::Cache);
  const std::optional<std::string> bytes = setting_.cache->get(*key);
  std::optional<UnitedPrograms> kept;
  if (bytes) kept = unitedFrom(*bytes, divided_, setting_);
  if (!kept) return false;
  for (size_t i = 0; i < groups_.size(); ++i) {
    groups_[i]->united = std::move(kept->programs[i].united);
    const std::vector<Key>& members = kept->programs[i].members;
    for (size_t k = 0; k < members.size(); ++k) groups_[i]->places.emplace(members[k], k);
  }
  digest_ = kept->digest;
  closed_ = true;
  return true;
}

void Programs::close() {
  const StageTimer timer(setting_.times, StageOfRun::Programs);
  KeyBuilder digest;
  if (setting_.options.fallback) digest.text("fallback");
  std::map<Group*, size_t> done;
  for (const auto& [structure, member] : members_) {
    const std::shared_ptr<Group>& group = member.group;
    const auto [at, fresh] = done.emplace(group.get(), done.size());
    digest.key(structure).number(static_cast<uint64_t>(at->second)).number(member.looks_through);
    if (!fresh) continue;
    // In the order of the texts: keys would bring in the versions of the tools.
    std::vector<std::pair<std::string, Key>> order;
    for (const auto& [key, graph] : group->graphs) order.emplace_back(graph::toJson(graph), key);
    std::sort(order.begin(), order.end());
    for (const uint16_t extension : group->lift.extensions) digest.number(extension);
    for (const std::string& term : group->lift.live) digest.text(term);
    std::vector<const graph::Graph*> members;
    for (const auto& [text, key] : order) {
      digest.text(text);
      members.push_back(&group->graphs.at(key));
    }
    if (members.empty()) continue;
    Result<programs::United> united = programs::unite(members, setting_.library);
    if (!united) continue;  // they keep their programs
    group->united = std::move(*united);
    for (size_t i = 0; i < order.size(); ++i) group->places.emplace(order[i].second, i);
    digest.text(graph::toJson(group->united.graph));
  }
  digest_ = digest.finish();
  closed_ = true;
  const std::optional<Key> key = unitedKey();
  if (!key) return;
  UnitedPrograms kept;
  kept.digest = digest_;
  for (const std::shared_ptr<Group>& group : groups_) {
    UnitedProgram& one = kept.programs.emplace_back();
    one.members.resize(group->places.size());
    for (const auto& [structure, place] : group->places) one.members[place] = structure;
    one.united = group->united;
  }
  const std::string blob = toBlob(kept, setting_);
  if (!unitedFrom(blob, divided_, setting_)) return;  // what does not come back as it was
  const StageTimer putting(setting_.times, StageOfRun::Cache);
  setting_.cache->put(*key, blob, true);
}

std::unique_ptr<Programs> sharePrograms(Setting& setting, Structures& structures,
                                        const std::function<void(Uses&)>& look) {
  Examples examples;
  Uses uses;
  setting.sharing = &examples;
  look(uses);
  setting.sharing = nullptr;
  std::vector<const Structure*> met;
  for (const Key& key : uses.structures()) {
    if (const Structure* structure = structures.known(key)) met.push_back(structure);
  }
  auto programs = std::make_unique<Programs>(met, examples, uses.uses(), uses.materials(), setting);
  setting.sharing = programs.get();
  structures.forgetShapes();
  if (!programs->closeAsBefore()) {
    Uses again;
    if (setting.options.programs > 0 || setting.options.fallback) look(again);
    programs->close();
  }
  programs->forgetExamples();
  structures.lookAgain();
  return programs;
}

Diagnostics wrongOfPrograms(const Options& options) {
  const bool asked = options.programs > 0 || !options.programs_report.empty();
  if (asked && options.parameters == Parameters::Baked) {
    return {{"programs-baked",
             Severity::Error,
             {},
             "materials whose numbers are constants in the code cannot share it",
             "leave `baked` out, or --programs and --programs-report",
             {}}};
  }
  if (asked && options.fallback) {
    return {{"fallback-programs",
             Severity::Error,
             {},
             "a fallback stands beside the programs of the materials, not beside those that they share",
             "leave --fallback out, or --programs and --programs-report",
             {}}};
  }
  if (options.fallback && options.parameters != Parameters::Uniform) {
    return {{"fallback-parameters",
             Severity::Error,
             {},
             "a fallback has the numbers of every material in its block, not in its code",
             "leave --fallback out, or `baked` and `spec`",
             {}}};
  }
  const std::string& report = options.programs_report;
  const auto ends = [&](const char* suffix) { return report.ends_with(suffix); };
  if (report.empty() || ends(".json") || ends(".md") || ends(".svg")) return {};
  return {{"report-format",
           Severity::Error,
           {printable(report), 0, 0, {}},
           "the report's name says no format",
           "let it end with .json, .md or .svg",
           {}}};
}

Result<programs::Weights> weightsOf(const Options& options, const Limits& limits) {
  if (options.weights.empty()) return programs::Weights();
  const Result<std::string> text = readFile(options.weights, limits.file);
  if (!text) return tl::make_unexpected(text.error());
  return programs::Weights::read(*text, options.weights, limits);
}

Result<std::unique_ptr<Sharing>> shareDocument(const material::Document& document,
                                               const std::vector<std::string>& only, Setting& setting,
                                               Structures& structures, Diagnostics& said) {
  if (Diagnostics wrong = wrongOfPrograms(setting.options); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  Result<programs::Weights> weights = weightsOf(setting.options, setting.limits);
  if (!weights) return tl::make_unexpected(weights.error());
  const passes::LightFacts lights = lightFacts(setting.options, lightsOf(document));
  const std::vector<Wanted> wanted = wantedOf(document, only, setting.options);
  std::unique_ptr<Sharing> sharing = sharePrograms(setting, structures, [&](Uses& uses) {
    std::vector<Described> described(wanted.size());
    inParallel(wanted.size(), [&](size_t i) {
      described[i] = describe(wanted[i], document.path, lights, setting, structures);
    });
    for (size_t i = 0; i < wanted.size(); ++i) {
      for (const Key& key : described[i].structures) uses.structure(key);
      const auto index = static_cast<size_t>(std::max(wanted[i].index, 0));
      uses.material(described[i].shaders, weights->of(document.path, wanted[i].name, index));
    }
  });
  said = weights->unused(setting.options.weights);
  return sharing;
}

}  // namespace lacquer
