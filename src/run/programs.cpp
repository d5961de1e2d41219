#include "run/programs.h"

#include <algorithm>
#include <map>

#include "run/program_costs.h"

namespace lacquer {

using programs::Item;
using programs::Places;

namespace {

/// So many programs a driver compiles for a report, or to say how far the model is off.
constexpr size_t kMostMeasured = 160;

/// By shader. Everything is sorted by content, so that neither the order of the files nor that of the threads
/// shows; keys would bring in the versions of the tools.
std::vector<OwnProgram> ownPrograms(const std::vector<const Structure*>& structures, const Setting& setting) {
  std::map<std::string, std::vector<const Structure*>> by_shader;
  for (const Structure* structure : structures) {
    if (!structure->shader.empty()) by_shader[structure->shader].push_back(structure);
  }
  std::vector<OwnProgram> all;
  for (auto& [shader, list] : by_shader) {
    std::sort(list.begin(), list.end(),
              [](const Structure* a, const Structure* b) { return a->graph < b->graph; });
    OwnProgram one{shader, {}, {}};
    for (const Structure* structure : list) {
      Result<graph::Graph> graph = graph::fromJson(structure->graph, shader, setting.limits);
      if (!graph || hasError(graph::check(*graph, setting.library))) continue;
      one.structures.push_back(structure);
      one.graphs.push_back(std::move(*graph));
    }
    if (!one.structures.empty()) all.push_back(std::move(one));
  }
  return all;
}

std::vector<Item> itemsOf(const std::vector<OwnProgram>& all, const std::vector<ProgramUse>& uses,
                          ProgramCosts& costs) {
  std::map<std::string_view, std::vector<double>> weights;
  for (const ProgramUse& use : uses) weights[use.shader].push_back(use.weight);
  std::map<std::map<std::string, int>, uint32_t> domains;
  std::vector<Item> items;
  std::vector<Places> alone;
  for (uint32_t i = 0; i < all.size(); ++i) {
    Item item{all[i].shader, 0, {}, 0};
    std::vector<double>& shares = weights[all[i].shader];
    std::sort(shares.begin(), shares.end());  // a sum in the order of the files would be rounded by it
    for (const double share : shares) item.weight += share;
    const passes::LightFacts& lights = all[i].structures[0]->lights;
    std::map<std::string, int> domain(lights.counts.begin(), lights.counts.end());
    domain[""] = lights.any ? 1 : 0;
    item.domain = domains.emplace(std::move(domain), static_cast<uint32_t>(domains.size())).first->second;
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

/// The costs of the numbered groups, as the search had them.
std::vector<double> costsOf(const std::vector<Item>& items, const programs::Merging& merging) {
  std::vector<double> costs;
  for (const Item& item : items) costs.push_back(item.program.cost);
  for (const programs::Step& step : merging.steps) costs.push_back(step.cost);
  return costs;
}

/// How far the model is off, over groups spread evenly.
programs::ModelError errorOf(const std::vector<Item>& items, const programs::Merging& merging,
                             const std::vector<double>& costs, ProgramCosts& measure) {
  const size_t step = (costs.size() + kMostMeasured - 1) / kMostMeasured;
  std::vector<Places> groups;
  std::vector<double> model;
  for (size_t i = 0; i < costs.size(); i += step) {
    groups.push_back(merging.members(static_cast<uint32_t>(i), items.size()));
    model.push_back(costs[i]);
  }
  const std::vector<std::optional<double>> said = measure.byDriver(groups);
  std::vector<double> compared;
  std::vector<double> driver;
  for (size_t i = 0; i < said.size(); ++i) {
    if (!said[i]) continue;
    compared.push_back(model[i]);
    driver.push_back(*said[i]);
  }
  return programs::fitModel(compared, driver);
}

}  // namespace

Programs::Programs(const std::vector<const Structure*>& structures, const std::vector<ProgramUse>& uses,
                   size_t materials, const Setting& setting) {
  const Options& options = setting.options;
  const std::vector<OwnProgram> all = ownPrograms(structures, setting);
  ProgramCosts costs(setting, all, options.programs_model);
  const std::vector<Item> items = itemsOf(all, uses, costs);
  const bool report = !options.programs_report.empty();
  const size_t wanted = options.programs == 0 ? items.size() : options.programs;
  const programs::Merging merging = programs::merge(
      items, report ? 1 : wanted, [&](const std::vector<Places>& groups) { return costs.measure(groups); });
  KeyBuilder digest;
  const std::vector<uint32_t> left = merging.left(wanted, items.size());
  for (const uint32_t group : left) {
    const Places places = merging.members(group, items.size());
    if (places.size() == 1) continue;
    Result<programs::United> united = costs.unite(places);
    if (!united) continue;  // it was made before
    const auto shared = std::make_shared<const programs::United>(std::move(*united));
    size_t place = 0;
    for (const uint32_t item : places) {
      for (const Structure* structure : all[item].structures) {
        members_[structure->key] = {shared, place++};
        digest.key(structure->key);
      }
    }
    digest.text(graph::toJson(shared->graph));
  }
  digest_ = digest.finish();
  curve_.materials = materials;
  curve_.structures = items.size();
  curve_.made = left.size();
  curve_.measured = merging.measured;
  if (!report) return;
  std::vector<double> by_group = costsOf(items, merging);
  if (costs.measured()) {
    curve_.driver = costs.driver();
  } else {
    curve_.error = errorOf(items, merging, by_group, costs);
    for (double& cost : by_group) cost *= curve_.error.scale;
  }
  curve_.points = programs::pointsOf(items, merging, by_group);
}

const Programs::Member* Programs::of(const Key& structure) const {
  const auto it = members_.find(structure);
  return it == members_.end() ? nullptr : &it->second;
}

void writeStandIn(const programs::TextureFill& fill, bool srgb, JsonText& json) {
  json.key("stand_in").beginObject().key("texel").numbers({fill.texel.data(), fill.texel.size()});
  json.key("color_space").string(srgb ? "srgb" : "linear").endObject();
}

}  // namespace lacquer
