#include "structures/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "manifest/values.h"
#include "setting/attributes.h"
#include "setting/simplify.h"
#include "shader/module.h"

namespace lacquer {

namespace {

/// The values of one material: use() for each use, then finish().
class Describer {
public:
  Describer(const Wanted& wanted, const std::string& file, const passes::LightFacts& lights,
            const Setting& setting, Structures& structures)
      : wanted_(wanted),
        material_(wanted.material == nullptr ? noMaterial() : *wanted.material),
        file_(file),
        lights_(lights),
        setting_(setting),
        structures_(structures) {}

  void use(const gltf::VertexAttributes& attributes);
  /// A graph that is the input.
  void use(graph::Graph& graph, const gltf::VertexAttributes& attributes);
  /// No graph could be made.
  void fail(const Diagnostics& why) { add(why); }
  Described finish();

private:
  static const material::Material& noMaterial() {
    static const material::Material kNone;
    return kNone;
  }
  void add(const Diagnostics& found) {
    for (const Diagnostic& d : found) {
      // Several uses of one material usually say the same things.
      if (std::find(diagnostics_.begin(), diagnostics_.end(), d) == diagnostics_.end())
        diagnostics_.push_back(d);
    }
  }
  bool known(const std::string& key, const gltf::VertexAttributes& attributes);
  void use(Traced graph, const gltf::VertexAttributes& attributes, const Diagnostics& said,
           const std::string& key);
  std::shared_ptr<const KnownShape> fallbackOf(Traced common, const graph::Graph& own,
                                               const gltf::VertexAttributes& attributes);
  void addFallback(const KnownShape* fallback, const Filling* filling,
                   const gltf::VertexAttributes& attributes, ContractUse& use);
  bool check(const Structure& structure, const Filling& filling, graph::Graph& graph);
  /// `fallback`: with its own filling, and null where there is none.
  bool accept(const KnownShape& shape, const Filling& filling, const Filling* fallback,
              const gltf::VertexAttributes& attributes);
  std::shared_ptr<const MaterialTerms> terms() const;

  const Wanted& wanted_;
  const material::Material& material_;
  const std::string& file_;
  const passes::LightFacts& lights_;
  const Setting& setting_;
  Structures& structures_;
  Described made_;
  Diagnostics diagnostics_;
  std::vector<const Structure*> met_;  ///< failed ones among them
  bool looks_through_ = false;
};

/// What is no constant though constants are asked for.
Diagnostics animated(const Structure& structure, const Filling& filling) {
  Diagnostics notes;
  for (const uint32_t i : structure.parameters) {
    const Filling::Number& number = filling.numbers[i];
    if (!number.animated) continue;
    notes.push_back({"animated-parameter",
                     Severity::Note,
                     {{}, 0, 0, number.pointer},
                     fmt::format("{} is animated: it stays in the Material block", structure.numbers[i].name),
                     "what changes at run time is no constant",
                     {}});
  }
  return notes;
}

/// Of a shader that materials share: what it reads of the vertices and this primitive does not have.
Strings standIns(const Structure& structure, const gltf::VertexAttributes& attributes) {
  const Strings own = attributes.names();
  Strings missing;
  for (const ShaderInput& input : structure.reflection.inputs) {
    if (input.name != "POSITION" && std::find(own.begin(), own.end(), input.name) == own.end())
      missing.push_back(input.name);
  }
  return missing;
}

void Describer::use(const gltf::VertexAttributes& attributes) {
  std::string key;
  // Patterns are a graph of the material's own: its properties do not say what becomes of it. What is watched
  // is this material's. A shape has no samplers.
  const Strings& live = setting_.options.live;
  const bool own = material_.patterns || knowsSamplers(setting_.options) ||
                   std::any_of(live.begin(), live.end(), [&](const std::string& name) {
                     return watchedPath(name, material_.index).has_value();
                   });
  if (KnownShapes* shapes = own ? nullptr : structures_.shapes()) {
    key = shapes->keyOf(material_, attributes, lights_);
    if (known(key, attributes)) return;
  }
  Diagnostics said;
  model::Origins origins;
  Result<graph::Graph> graph;
  {
    const StageTimer timer(setting_.times, StageOfRun::Graph);
    graph = buildGraph(material_, attributes, setting_.library, setting_.options, said, &origins);
  }
  if (!graph) return fail(graph.error());
  use({*graph,
       {origins.parameters.begin(), origins.parameters.end()},
       {origins.textures.begin(), origins.textures.end()}},
      attributes, said, key);
}

void Describer::use(graph::Graph& graph, const gltf::VertexAttributes& attributes) {
  if (knowsSamplers(setting_.options)) addSamplers(graph, nullptr);
  use({graph, {}, {}}, attributes, {}, {});
}

/// Whether a material of its shape was there before; not where the numbers are others than the check has
/// accepted: it says why.
bool Describer::known(const std::string& key, const gltf::VertexAttributes& attributes) {
  const KnownShape* shape = structures_.shapes()->find(key);
  if (shape == nullptr) return false;
  const Filling filling = structures_.shapes()->fill(*shape, material_);
  if (!withinLimits(*shape->structure, filling)) return false;
  std::optional<Filling> fallback;
  if (shape->fallback) fallback = structures_.shapes()->fill(*shape->fallback, material_);
  if (fallback && !withinLimits(*shape->fallback->structure, *fallback)) return false;
  if (setting_.sharing != nullptr) setting_.sharing->note(shape->structure->key, material_, attributes, key);
  met_.push_back(shape->structure);
  accept(*shape, filling, fallback ? &*fallback : nullptr, attributes);
  return true;
}

/// What the options want beside a material's own program: `common` is its graph, which becomes that of the
/// fallback. Null where it has no part in one.
std::shared_ptr<const KnownShape> Describer::fallbackOf(Traced common, const graph::Graph& own,
                                                        const gltf::VertexAttributes& attributes) {
  const Sharing::Share share = setting_.sharing->bring(common, wanted_.material, attributes, lights_);
  if (share.fill == nullptr) return nullptr;
  // One texture for both: what another layer has made of a name would not do.
  for (const graph::Texture& texture : own.textures) {
    const std::optional<size_t> at = common.graph.findTexture(texture.name);
    const graph::Texture* const other = at ? &common.graph.textures[*at] : nullptr;
    if (other != nullptr && (other->pointer != texture.pointer || other->texture != texture.texture ||
                             other->srgb != texture.srgb || other->file != texture.file))
      return nullptr;
  }
  passes::OtherLayout beside;
  if (share.readers != nullptr) beside.readers = *share.readers;
  const Structure& structure = structures_.of(common.graph, lights_, beside);
  Filling filling = fillingOf(common.graph, material_);
  if (structure.shader.empty() || !withinLimits(structure, filling)) return nullptr;
  return std::make_shared<KnownShape>(KnownShape{&structure, share, std::move(filling),
                                                 std::move(common.numbers), std::move(common.textures)});
}

/// `said`: what building the graph has reported. `key`: of the material's shape; empty where shapes are not
/// kept.
void Describer::use(Traced own, const gltf::VertexAttributes& attributes, const Diagnostics& said,
                    const std::string& key) {
  KnownShape shape;
  graph::Graph common;  // what the fallback's filling points into
  Key alone;            // of the structure without a share in anything
  if (setting_.sharing != nullptr) {
    alone = structureKey(own.graph, lights_, setting_);
    if (setting_.sharing->beside()) {
      common = own.graph;
      shape.fallback = fallbackOf({common, own.numbers, own.textures}, own.graph, attributes);
    } else {
      shape.share = setting_.sharing->bring(own, wanted_.material, attributes, lights_);
    }
  }
  const Structure& structure = structures_.of(
      own.graph, lights_, shape.fallback ? layoutOf(*shape.fallback->structure) : passes::OtherLayout());
  Filling filling = fillingOf(own.graph, material_);
  if (setting_.sharing != nullptr && wanted_.material == nullptr) {
    setting_.sharing->note(alone, own.graph);
  } else if (setting_.sharing != nullptr) {
    // Numbers that the check complains of decide of more than values.
    const bool usual = !structure.shader.empty() && withinLimits(structure, filling);
    setting_.sharing->note(alone, material_, attributes, usual ? key : std::string());
  }
  met_.push_back(&structure);
  add(said);
  shape.structure = &structure;
  const bool good = check(structure, filling, own.graph) &&
                    accept(shape, filling, shape.fallback ? &shape.fallback->filling : nullptr, attributes);
  if (!good || !said.empty() || key.empty() || !withinLimits(structure, filling)) return;
  shape.filling = std::move(filling);
  shape.numbers = std::move(own.numbers);
  shape.textures = std::move(own.textures);
  structures_.shapes()->keep(key, std::move(shape));
}

/// False, with errors, for a graph that is wrong.
bool Describer::check(const Structure& structure, const Filling& filling, graph::Graph& graph) {
  if (!structure.shader.empty() && withinLimits(structure, filling)) return true;
  const Diagnostics found = graph::check(graph, setting_.library, setting_.limits.nodes);
  add(found);
  return !hasError(found);
}

void Describer::addFallback(const KnownShape* fallback, const Filling* filling,
                            const gltf::VertexAttributes& attributes, ContractUse& use) {
  made_.fallbacks.push_back(fallback == nullptr ? nullptr : fallback->structure);
  if (setting_.sharing == nullptr || !setting_.sharing->beside()) return;
  if (fallback == nullptr) {
    use.fallback = std::make_shared<ContractUse>(use);
    return;
  }
  auto made = std::make_shared<ContractUse>(useOf(*fallback->structure, *filling, fallback->share.fill));
  made->attributes = use.attributes;
  made->stand_in_attributes = standIns(*fallback->structure, attributes);
  if (use.block.size() < made->block.size()) use.block.resize(made->block.size());
  std::copy(made->block.begin(), made->block.end(), use.block.begin());
  use.fallback = std::move(made);
}

bool Describer::accept(const KnownShape& shape, const Filling& filling, const Filling* fallback,
                       const gltf::VertexAttributes& attributes) {
  const Structure& structure = *shape.structure;
  const Sharing::Share& share = shape.share;
  add(structure.diagnostics);
  if (structure.shader.empty()) return false;
  if (setting_.options.parameters != Parameters::Uniform) add(animated(structure, filling));
  looks_through_ |= share.fill != nullptr ? share.looks_through : structure.looks_through;
  ContractUse use = useOf(structure, filling, share.fill);
  use.attributes = toPublic(attributes);
  if (use.shares_program) use.stand_in_attributes = standIns(structure, attributes);
  if (setting_.options.properties && wanted_.index >= 0 && wanted_.material != nullptr) {
    if (const Result<const material::Schema*> schema = setting_.library.models.schema(); schema)
      use.properties = propertiesOf(use, material_, **schema);
  }
  addFallback(shape.fallback.get(), fallback, attributes, use);
  made_.values.uses.push_back(std::move(use));
  made_.shaders.push_back(structure.shader);
  made_.met.push_back(&structure);
  made_.uses.push_back(attributes);
  return true;
}

/// Of all uses, each once.
std::shared_ptr<const MaterialTerms> Describer::terms() const {
  if (met_.empty()) return std::make_shared<MaterialTerms>();
  if (std::all_of(met_.begin(), met_.end(), [&](const Structure* s) { return s->terms == met_[0]->terms; })) {
    return met_[0]->terms;
  }
  auto all = std::make_shared<MaterialTerms>();
  for (const Structure* structure : met_) {
    for (const std::string& term : structure->terms->terms) {
      if (std::find(all->terms.begin(), all->terms.end(), term) == all->terms.end())
        all->terms.push_back(term);
    }
    for (const auto& skipped : structure->terms->skipped) {
      const auto it = std::find_if(all->skipped.begin(), all->skipped.end(),
                                   [&](const auto& other) { return other.first == skipped.first; });
      if (it == all->skipped.end())
        all->skipped.push_back(skipped);
      else
        it->second = skipped.second;
    }
  }
  return all;
}

Described Describer::finish() {
  const Diagnostics of_uses = std::exchange(diagnostics_, material_.diagnostics);
  if (!wanted_.note.empty()) {
    diagnostics_.push_back({"unused-material",
                            Severity::Note,
                            {file_, 0, 0, fmt::format("/materials/{}", wanted_.index)},
                            wanted_.note,
                            "--unused generates it all the same",
                            {}});
  }
  add(of_uses);
  made_.diagnostics = std::move(diagnostics_);
  made_.ok = !hasError(made_.diagnostics);
  for (const auto* all : {&met_, &made_.fallbacks}) {
    for (const Structure* structure : *all) {
      const auto known = std::find_if(made_.structures.begin(), made_.structures.end(),
                                      [&](const Key& key) { return structure && structure->key == key; });
      if (structure != nullptr && known == made_.structures.end()) made_.structures.push_back(structure->key);
    }
  }
  ContractMaterial& values = made_.values;
  values.index = wanted_.index;
  values.name = wanted_.name;
  values.terms = terms();
  values.ignored = material_.ignored;
  if (wanted_.material != nullptr) {
    values.profile = profileOf(material_, setting_.options);
    values.surface = material_.surface;
    values.translation_error = material_.translation_error;
    if (const Result<const material::Schema*> schema = setting_.library.models.schema()) {
      values.state = stateOf(material_, **schema, looks_through_);
      values.extensions = extensionsOf(material_, **schema);
    }
  }
  return std::move(made_);
}

}  // namespace

gltf::VertexAttributes everything() {
  gltf::VertexAttributes a;
  a.normal = true;
  a.tangent = true;
  a.texCoord = {true, true, false, false};
  return a;
}

std::vector<Wanted> wantedOf(const material::Document& document, const std::vector<std::string>& only,
                             const Options& options) {
  // A file of materials alone, without a primitive: every material is wanted.
  const bool no_primitives =
      document.defaultUses.empty() &&
      std::all_of(document.uses.begin(), document.uses.end(), [](const auto& uses) { return uses.empty(); });
  std::vector<Wanted> all;
  for (size_t i = 0; i < document.materials.size(); ++i) {
    const material::Material& material = document.materials[i];
    const bool named = std::find(only.begin(), only.end(), material.name) != only.end();
    if (!only.empty() && !named) continue;
    Wanted one{&material, material.name, static_cast<int>(i), document.uses[i], {}};
    if (one.uses.empty() && (no_primitives || named || options.unused)) one.uses.push_back(everything());
    if (one.uses.empty()) one.note = "no primitive uses this material";
    all.push_back(std::move(one));
  }
  if (!document.defaultUses.empty() && only.empty()) {
    static const material::Material kDefault;
    all.push_back({&kDefault, {}, -1, document.defaultUses, {}});
  }
  return all;
}

Described describe(const Wanted& wanted, const std::string& file, const passes::LightFacts& lights,
                   const Setting& setting, Structures& structures) {
  Describer describer(wanted, file, lights, setting, structures);
  if (!hasError(wanted.material->diagnostics)) {
    for (const gltf::VertexAttributes& attributes : wanted.uses) describer.use(attributes);
  }
  return describer.finish();
}

Described describeGraph(const graph::Graph& graph, const std::string& file, const Setting& setting,
                        Structures& structures) {
  const Wanted wanted{nullptr, graph.name, 0, {}, {}};
  const passes::LightFacts lights = lightFacts(setting.options, {});
  Describer describer(wanted, file, lights, setting, structures);
  // Groups and forms are gone when a structure is made: only of a good graph is it known what stands for
  // them.
  graph::Graph checked = graph;
  const Diagnostics wrong = graph::check(checked, setting.library, setting.limits.nodes);
  if (hasError(wrong)) {
    describer.fail(wrong);
    return describer.finish();
  }
  graph::Graph flat = graph::flattened(checked, setting.library);
  if (const Result<void> simpler = simplifyBuilt(flat, setting.library, setting.options.simplify); simpler)
    describer.use(flat, everything());
  else
    describer.fail(simpler.error());
  return describer.finish();
}

}  // namespace lacquer
