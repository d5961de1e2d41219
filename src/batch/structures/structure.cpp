#include "structures/structure.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>
#include <unordered_map>

#include "cost/choose.h"
#include "cost/cost.h"
#include "graph/check_parts.h"
#include "graph/program_key.h"
#include "interface/interface.h"
#include "lower/lower.h"
#include "manifest/values.h"
#include "setting/option_key.h"
#include "setting/options.h"
#include "setting/simplify.h"
#include "shader/limits.h"
#include "shader/module.h"
#include "structures/reflection_blob.h"

namespace lacquer {

namespace {

class StructureKey {
public:
  StructureKey(KeyBuilder& key, bool values) : key_(key), values_(values) {}

  void operator()(const graph::Literal& literal) {
    key_.number('l').number(literal.type);
    for (const double x : literal.value) key_.number(x);
    for (const double x : literal.matrix) key_.number(x);
  }
  void operator()(const graph::ParameterRef& ref) { key_.number('p').text(ref.name); }
  void operator()(const graph::TextureRef& ref) { key_.number('t').text(ref.name); }
  void operator()(const graph::GivenRef& ref) { key_.number('g').text(ref.name); }
  void operator()(const graph::AttributeRef& ref) { key_.number('a').text(ref.name).number(ref.type); }
  void operator()(const graph::NodeRef& ref) { key_.number('n').text(ref.node).text(ref.output); }
  void operator()(const graph::Choice& choice) { key_.number('c').text(choice.name); }
  void operator()(const graph::InputRef& ref) { key_.number('i').text(ref.name); }  // of no flat graph

  void source(const graph::Source& source) {
    std::visit(*this, source.from);
    key_.text(source.swizzle);
  }

  void sources(const std::vector<std::pair<std::string, graph::Source>>& named) {
    key_.number(named.size());
    for (const auto& [name, from] : named) {
      key_.text(name);
      source(from);
    }
  }

  void graph(const graph::Graph& graph) {
    key_.text(graph.template_name).number(graph.attributes.size());
    for (const std::string& name : graph.attributes) key_.text(name);
    key_.number(graph.parameters.size());
    for (const ir::Parameter& p : graph.parameters) {
      key_.text(p.name).number(p.type).number(p.range.lo).number(p.range.hi).number(p.range.gap);
      key_.number(p.animated);
      for (size_t i = 0; values_ && !p.animated && i < p.value.size(); ++i) key_.number(p.value[i]);
    }
    key_.number(graph.textures.size());
    for (const ir::TextureSlot& t : graph.textures) {
      key_.text(t.name).number(t.type).number(t.srgb).number(t.environment);
      if (!t.sampler) continue;
      key_.number('s').number(t.sampler->wrap_s).number(t.sampler->wrap_t);
      key_.number(t.sampler->mag).number(t.sampler->min);
    }
    key_.number(graph.nodes.size());
    for (const graph::Node& node : graph.nodes) {
      key_.text(node.id).text(node.type).text(node.variant).text(node.term).number(node.place);
      key_.number(node.at_vertices);
      sources(node.inputs);
    }
    sources(graph.outputs);
    key_.number(graph.skipped.size());
    for (const graph::Skipped& s : graph.skipped) key_.text(s.term).text(s.reason);
  }

private:
  KeyBuilder& key_;
  bool values_;
};

std::vector<Structure::Number> numbersOf(const graph::Graph& graph, const lang::Library& library) {
  const std::vector<ir::Range> limits = graph::parameterLimits(graph, library);
  std::vector<Structure::Number> numbers;
  for (size_t i = 0; i < limits.size(); ++i) {
    const ir::Parameter& p = graph.parameters[i];
    numbers.push_back({p.name, static_cast<uint32_t>(ir::componentCount(p.type)), limits[i]});
  }
  return numbers;
}

/// Takes away what belongs to one material.
graph::Graph withoutMaterial(graph::Graph graph, const std::vector<Structure::Number>& numbers, bool values) {
  graph = graph::bare(std::move(graph));
  for (size_t i = 0; i < graph.parameters.size(); ++i) {
    ir::Parameter& p = graph.parameters[i];
    if (values && !p.animated) continue;
    const double x = std::min(std::max(0.0, numbers[i].limits.lo), numbers[i].limits.hi);
    p.value.fill(0);
    std::fill_n(p.value.begin(), ir::componentCount(p.type), std::isfinite(x) ? x : 0);
  }
  return graph;
}

void describe(const graph::Graph& graph, Structure& structure) {
  auto terms = std::make_shared<MaterialTerms>();
  for (const graph::Node& node : graph.nodes) terms->terms.push_back(node.id);
  for (const graph::Skipped& s : graph.skipped) {
    // A term that is skipped several times is named once, with the last reason.
    const auto it = std::find_if(terms->skipped.begin(), terms->skipped.end(),
                                 [&](const auto& other) { return other.first == s.term; });
    if (it == terms->skipped.end())
      terms->skipped.emplace_back(s.term, s.reason);
    else
      it->second = s.reason;
  }
  structure.terms = terms;
}

StructureFacts factsOf(const graph::Graph& graph, const Setting& setting) {
  StructureFacts facts;
  std::set<std::string, std::less<>> skipped;
  for (const graph::Skipped& s : graph.skipped) skipped.insert(s.term);
  if (const Result<const model::Model*> model = setting.library.models.of(setting.options.profile)) {
    for (const auto& [name, terms] : (*model)->absent(skipped)) {
      if (!graph.findParameter(name)) facts.absent_parameters.emplace_back(name, terms);
    }
  }
  const Result<const lang::TemplateDecl*> decl = setting.library.template_(graph.template_name);
  for (size_t i = 0; decl && i < (*decl)->ports.size(); ++i) {
    const std::string_view name = (*decl)->ports[i].param.name;
    const bool filled = std::any_of(graph.outputs.begin(), graph.outputs.end(),
                                    [&](const auto& output) { return output.first == name; });
    if (!filled) facts.unfilled_ports.emplace_back(name);
  }
  return facts;
}

void describe(const ir::Module& module, const graph::Graph& graph, const Setting& setting,
              Structure& structure) {
  const Language& library = setting.library;
  structure.module = passes::contentDigest(module);
  structure.shader = shaderId(module, library, shortened(structure.module, setting.id_bits));
  structure.has_vertex = hasVertexStage(module);
  structure.looks_through = looksThrough(module);
  const Result<const material::Schema*> schema = library.models.schema();
  structure.reflection = reflect(module, structure.has_vertex, schema ? *schema : nullptr);
  structure.preshader = Preshader(module);
  const auto place = [](const auto& list, const std::string& name) {
    const auto it =
        std::find_if(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
    return it == list.end() ? ~uint32_t{0} : static_cast<uint32_t>(it - list.begin());
  };
  std::unordered_map<std::string_view, uint32_t> numbers;
  for (uint32_t i = 0; i < graph.parameters.size(); ++i) numbers.emplace(graph.parameters[i].name, i);
  for (const ir::Parameter& p : module.parameters) {
    const auto it = numbers.find(p.name);
    structure.parameters.push_back(it == numbers.end() ? ~uint32_t{0} : it->second);
  }
  // The shader may have another name for a texture; the DAG still has the graph's.
  std::vector<uint32_t> places(module.textures.size(), ~uint32_t{0});
  for (const ir::ValueId id : ir::reachable(module.dag, ir::roots(module))) {
    if (module.dag[id].op != ir::Op::Input) continue;
    const ir::Input& input = module.dag.inputOf(id);
    if (input.kind == ir::InputKind::Texture) places[input.field] = place(graph.textures, input.name);
  }
  for (size_t i = 0; i < places.size(); ++i) {
    if (places[i] != ~uint32_t{0}) structure.textures.emplace_back(module.textures[i].name, places[i]);
  }
}

Result<ir::Module> modulate(const graph::Graph& graph, const passes::LightFacts& lights,
                            const passes::OtherLayout& other, const Setting& setting,
                            passes::Searched* searched = nullptr) {
  Result<ir::Module> module;
  {
    const StageTimer timer(setting.times, StageOfRun::Lower);
    module = lower::lower(graph, setting.library, loweringOf(setting.options));
  }
  if (!module) return module;
  const StageTimer timer(setting.times, StageOfRun::Passes);
  return throughPasses(std::move(*module), {lights,
                                            {},
                                            setting.options.relaxed,
                                            optimization(setting.options),
                                            cost::chooserOf(setting.options),
                                            other,
                                            setting.options.binding == BindingModel::Bindless,
                                            setting.options.binding == BindingModel::Arrays,
                                            setting.options.static_samplers,
                                            setting.options.half,
                                            searched});
}

}  // namespace

/// Of everything that the code depends on beside the graph.
static void addSetting(const passes::LightFacts& lights, const Setting& setting, KeyBuilder& key) {
  key.key(setting.base);
  addOptions(setting.options, {Decides::Module}, key);
  key.number(lights.any).number(lights.counts.size());
  for (const auto& [kind, count] : lights.counts) key.text(kind).number(count);
  // Of the forms that a search finds a driver takes one.
  if (cost::choosesByDriver(setting.options)) key.text(cost::driverIdentity());
  // They decide what is said of the shader.
  for (const Target target : setting.options.targets) key.number(target);
}

Key structureKey(const graph::Graph& graph, const passes::LightFacts& lights, const Setting& setting,
                 const passes::OtherLayout& other) {
  KeyBuilder key;  // none that a thread keeps: the C library ends the process where it has no memory to note
                   // its destructor
  addSetting(lights, setting, key.text("structure"));
  StructureKey(key, setting.options.parameters == Parameters::Baked).graph(graph);
  if (!other.empty()) key.number('o').number(other.block).number(other.textures.size());
  for (const auto& [name, at] : other.textures)
    key.text(name).number(at.set).number(at.binding).number(at.flat);
  for (const auto& [name, location] : other.inputs) key.text(name).number(location);
  const passes::Readers& readers = other.readers;
  if (!readers.empty()) key.number('r').number(readers.blocks.size());
  for (const auto& [at, stages] : readers.blocks)
    key.number(at.first).number(at.second).number(stages.vertex).number(stages.fragment);
  for (const auto& [name, stages] : readers.textures)
    key.text(name).number(stages.vertex).number(stages.fragment);
  return setting.keys->of(key.take());
}

/// By the graph, or of an environment's by the template.
static const std::string& nameOfTexture(const ReflectedTexture& texture) {
  return texture.role == TextureRole::Material ? texture.slot : texture.name;
}

passes::OtherLayout layoutOf(const Structure& structure) {
  passes::OtherLayout layout;
  layout.block = structure.preshader.blockSize();
  for (const ReflectedTexture& texture : structure.reflection.textures)
    layout.textures[nameOfTexture(texture)] = {texture.at.set, texture.at.binding, texture.at.flat};
  for (const ShaderInput& input : structure.reflection.inputs) layout.inputs[input.name] = input.location;
  return layout;
}

void addReader(const Structure& structure, passes::Readers& readers) {
  const auto add = [](const BoundResource& bound, ir::Stages& to) {
    to.vertex |= bound.vertex;
    to.fragment |= bound.fragment;
  };
  for (const UniformBlock& block : structure.reflection.blocks)
    add(block, readers.blocks[{block.at.set, block.at.binding}]);
  for (const ReflectedTexture& texture : structure.reflection.textures)
    add(texture, readers.textures[nameOfTexture(texture)]);
}

Key programKey(const graph::Graph& graph, const passes::LightFacts& lights, const Setting& setting) {
  KeyBuilder key;
  addSetting(lights, setting, key.text("program"));
  const bool baked = setting.options.parameters == Parameters::Baked;
  const std::string program =
      baked ? graph::programKeyWithValues(graph, setting.library) : graph::programKey(graph, setting.library);
  return keyOf(key.text(program).take());
}

std::optional<ir::Module> makeStructure(const graph::Graph& graph, const passes::LightFacts& lights,
                                        const passes::OtherLayout& other, const Setting& setting,
                                        Structure& structure, passes::Searched* searched) {
  structure.numbers = numbersOf(graph, setting.library);
  structure.lights = lights;
  structure.other = other;
  const bool baked = setting.options.parameters == Parameters::Baked;
  graph::Graph plain = withoutMaterial(graph, structure.numbers, baked);
  {
    const StageTimer timer(setting.times, StageOfRun::Graph);
    structure.diagnostics = graph::check(plain, setting.library, setting.limits.nodes);
  }
  describe(plain, structure);
  structure.facts = std::make_shared<StructureFacts>(factsOf(plain, setting));
  if (hasError(structure.diagnostics)) return std::nullopt;
  structure.program = programKey(plain, lights, setting);
  Result<ir::Module> module = modulate(plain, lights, other, setting, searched);
  if (!module) {
    structure.diagnostics.insert(structure.diagnostics.end(), module.error().begin(), module.error().end());
    return std::nullopt;
  }
  const Diagnostics over = overLimits(*module, setting.options.targets);
  structure.diagnostics.insert(structure.diagnostics.end(), over.begin(), over.end());
  if (hasError(over)) return std::nullopt;
  const Diagnostics half = aboutHalf(*module, setting.options);
  structure.diagnostics.insert(structure.diagnostics.end(), half.begin(), half.end());
  structure.graph = graph::toJson(plain);
  // Places are those in the graph as it comes, which check() may have ordered, but not its parameters and
  // textures.
  describe(*module, graph, setting, structure);
  return std::move(*module);
}

graph::Graph withoutMaterial(const graph::Graph& graph, const Setting& setting) {
  return withoutMaterial(graph, numbersOf(graph, setting.library),
                         setting.options.parameters == Parameters::Baked);
}

Result<ir::Module> moduleOf(const Structure& structure, const Setting& setting) {
  Result<graph::Graph> graph = graph::fromJson(structure.graph, structure.shader, setting.limits);
  if (!graph) return tl::make_unexpected(graph.error());
  if (const Diagnostics found = graph::check(*graph, setting.library, setting.limits.nodes);
      hasError(found)) {
    return tl::make_unexpected(found);
  }
  return modulate(*graph, structure.lights, structure.other, setting);
}

Filling fillingOf(const graph::Graph& graph, const material::Material& material) {
  Filling filling;
  for (const ir::Parameter& p : graph.parameters) filling.numbers.push_back({p.value, p.pointer, p.animated});
  for (const graph::Texture& t : graph.textures) {
    const auto it = std::find_if(material.textures.begin(), material.textures.end(),
                                 [&](const auto& texture) { return texture.info.pointer == t.pointer; });
    filling.textures.push_back({t.texture, t.srgb, t.pointer,
                                it == material.textures.end() ? nullptr : &it->info,
                                t.file.empty() && !t.color && !t.own_sampler ? nullptr : &t});
  }
  return filling;
}

bool hasArrays(const Reflection& reflection) {
  return std::any_of(
      reflection.textures.begin(), reflection.textures.end(),
      [](const ReflectedTexture& texture) { return !texture.array.empty() && !texture.layered; });
}

bool withinLimits(const Structure& structure, const Filling& filling) {
  for (size_t i = 0; i < filling.numbers.size(); ++i) {
    for (uint32_t c = 0; c < structure.numbers[i].components; ++c) {
      const double x = filling.numbers[i].value[c];
      if (!std::isfinite(x) || !structure.numbers[i].limits.contains(x)) return false;
    }
  }
  return true;
}

static std::vector<double> firstOf(const ir::Components& of, size_t count) {
  return {of.begin(), of.begin() + static_cast<ptrdiff_t>(count)};
}

ContractUse useOf(const Structure& structure, const Filling& filling, const programs::Fill* fill) {
  ContractUse use;
  use.facts = structure.facts;
  use.structure = structure.program.text();
  use.shader_id = structure.shader;
  use.shares_program = fill != nullptr;
  use.parameters.reserve(structure.parameters.size());
  for (const uint32_t i : structure.parameters) {
    const Structure::Number& parameter = structure.numbers[i];
    const Filling::Number& number = filling.numbers[i];
    const bool own = fill == nullptr || fill->numbers[i].own;
    use.parameters.push_back({parameter.name, firstOf(number.value, parameter.components), number.pointer,
                              number.animated && own, !own});
  }
  const std::vector<Preshader::Field>& fields = structure.preshader.fields();
  const std::vector<ir::Components> packed = structure.preshader.evaluate(
      [&](uint32_t i) -> const ir::Components& { return filling.numbers[structure.parameters[i]].value; });
  use.uniforms.reserve(packed.size());
  for (size_t i = 0; i < packed.size(); ++i) {
    std::vector<double> value = firstOf(packed[i], static_cast<size_t>(ir::componentCount(fields[i].type)));
    // A UInt's bits are those of an Int in the preshader's numbers (ir/whole.h).
    for (double& x : value) x += ir::partType(fields[i].type) == ir::Type::UInt && x < 0 ? 0x1p32 : 0;
    use.uniforms.emplace_back(fields[i].name, std::move(value));
  }
  use.block.resize(structure.preshader.blockSize());
  structure.preshader.write(packed, use.block);
  use.textures.reserve(structure.textures.size());
  for (const auto& [name, i] : structure.textures) {
    const Filling::Texture& slot = filling.textures[i];
    UsedTexture& texture = use.textures.emplace_back();
    texture.slot = name;
    texture.texture = slot.texture;
    texture.pointer = slot.pointer;
    texture.srgb = slot.srgb;
    if (slot.image != nullptr) {
      texture.file = slot.image->file;
      texture.color = slot.image->color;
      texture.sampler = samplerOf(*slot.image);
    }
    if (fill != nullptr && !fill->textures[i].own)
      texture.stand_in = fill->textures[i].texel;
    else if (slot.info != nullptr)
      addTextureInfo(*slot.info, texture);
  }
  return use;
}

namespace ir {
template <class Archive>
static void fields(Archive& archive, Range& range) {
  archive(range.lo, range.hi, range.gap);
}
template <class Archive>
static void fields(Archive& archive, Binding& at) {
  archive(at.set, at.binding, at.flat);
}
template <class Archive>
static void fields(Archive& archive, Stages& of) {
  archive(of.vertex, of.fragment);
}
}  // namespace ir

namespace passes {
template <class Archive>
static void fields(Archive& archive, LightFacts& lights) {
  archive(lights.any, lights.counts);
}
template <class Archive>
static void fields(Archive& archive, OtherLayout& other) {
  archive(other.block, other.textures, other.inputs, other.readers.blocks, other.readers.textures);
}
}  // namespace passes

template <class Archive>
static void fields(Archive& archive, StructureFacts& f) {
  archive(f.absent_parameters, f.unfilled_ports);
}

template <class Archive>
static void fields(Archive& archive, Structure::Number& number) {
  archive(number.name, number.components, number.limits);
}

template <class Archive>
static void fields(Archive& archive, Structure& s) {
  archive(s.content, s.program, s.module, s.diagnostics, s.shader, s.has_vertex, s.looks_through, s.facts,
          s.reflection, s.terms, s.preshader, s.parameters, s.textures, s.numbers, s.graph, s.lights,
          s.other);
}

std::string toBlob(const Structure& structure) {
  BlobWriter blob;
  blob(structure);
  return blob.take();
}

bool fromBlob(std::string_view bytes, Structure& s) {
  BlobReader blob(bytes);
  blob(s);
  return blob.complete() && (s.shader.empty() || isShaderId(s.shader)) &&
         s.preshader.uses(s.parameters.size());
}

bool fits(const Structure& s, const graph::Graph& graph) {
  const auto below = [](size_t n) { return [n](uint32_t i) { return i < n; }; };
  const auto same = [](const Structure::Number& number, const ir::Parameter& parameter) {
    return number.name == parameter.name &&
           number.components == static_cast<uint32_t>(ir::componentCount(parameter.type));
  };
  return std::equal(s.numbers.begin(), s.numbers.end(), graph.parameters.begin(), graph.parameters.end(),
                    same) &&
         std::all_of(s.parameters.begin(), s.parameters.end(), below(graph.parameters.size())) &&
         std::all_of(s.textures.begin(), s.textures.end(),
                     [&](const auto& texture) { return texture.second < graph.textures.size(); });
}

}  // namespace lacquer
