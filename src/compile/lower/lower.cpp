#include "lower/lower.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "ir/names.h"
#include "lang/composites.h"
#include "lower/at_vertices.h"
#include "lower/displaced.h"
#include "lower/inline.h"
#include "lower/light_fill.h"
#include "lower/pack_outputs.h"
#include "lower/shown.h"

namespace lacquer::lower {

namespace {

ir::BlockRole roleOf(lang::BlockRole role) {
  switch (role) {
    case lang::BlockRole::Frame: return ir::BlockRole::Frame;
    case lang::BlockRole::Lights: return ir::BlockRole::Lights;
    case lang::BlockRole::Object: return ir::BlockRole::Object;
    case lang::BlockRole::List: return ir::BlockRole::List;
  }
  return ir::BlockRole::Frame;
}

ir::Rate rateOf(lang::BlockRole role) {
  switch (role) {
    case lang::BlockRole::Frame: return ir::Rate::Frame;
    case lang::BlockRole::Lights: return ir::Rate::Light;
    case lang::BlockRole::Object: return ir::Rate::Object;
    case lang::BlockRole::List: return ir::Rate::Frame;
  }
  return ir::Rate::Frame;
}

std::string joined(std::string_view a, std::string_view b) {
  std::string text(a);
  text += '.';
  text += b;
  return text;
}

/// The input of that name; `next` is where it is looked for first, as most stand in the order in which they
/// are asked for.
const graph::Source* inputNamed(const graph::Inputs& inputs, std::string_view name, size_t& next) {
  for (size_t k = 0; k < inputs.size(); ++k) {
    const size_t place = next + k < inputs.size() ? next + k : next + k - inputs.size();
    if (inputs[place].first != name) continue;
    next = place + 1;
    return &inputs[place].second;
  }
  return nullptr;
}

LoopOptions loopOptions(const LowerOptions& options) {
  LoopOptions loops = options.loops;
  // Specialization constants are numbers that the shader computes with.
  loops.preshader = loops.preshader && options.parameters != ParameterMode::Spec;
  return loops;
}

class Lowering {
public:
  Lowering(const graph::Graph& graph, const lang::Library& library, const LowerOptions& options)
      : graph_(graph),
        library_(library),
        options_(options),
        inliner_(module_.dag, options.on_call, loopOptions(options)) {}

  Result<ir::Module> run() {
    const Result<const lang::TemplateDecl*> found = library_.template_(graph_.template_name);
    if (!found) return tl::make_unexpected(found.error());
    template_ = *found;
    module_.template_name = graph_.template_name;
    module_.material_textures = template_->material_textures;
    module_.sums_lights = template_->sums_lights;
    module_.spec_constants = options_.parameters == ParameterMode::Spec;
    slots_.assign(template_->slots, ir::kNoValue);
    order_ = graph::codeOrder(graph_, library_, options_.shown);
    for (const size_t index : order_) {
      const Result<const lang::NodeDecl*> decl = library_.node(graph_.nodes[index].type);
      if (!decl) return tl::make_unexpected(decl.error());
      decls_.push_back(*decl);
    }
    declareInterface();
    bindGivens();
    bindLightRange();
    nodes();
    ports();
    if (Diagnostics wrong = displace(); !wrong.empty()) return tl::make_unexpected(std::move(wrong));
    if (Diagnostics wrong = outputs(); !wrong.empty()) return tl::make_unexpected(std::move(wrong));
    placeOwnAttributes();
    if (Diagnostics wrong = rates(); !wrong.empty()) return tl::make_unexpected(std::move(wrong));
    assert(ir::verify(module_).empty());
    return std::move(module_);
  }

private:
  ir::Dag& dag() { return module_.dag; }

  void declareInterface() {
    module_.blocks.reserve(template_->blocks.size() + 1);  // and the material's
    for (const lang::BlockDecl& block : template_->blocks) declareBlock(block);
    if (template_->light_lists) listLights(*template_->light_lists);
    vertex_stage_ = std::any_of(template_->outputs.begin(), template_->outputs.end(),
                                [](const auto& o) { return o.role == lang::OutputRole::Position; });
    for (const lang::AttributeDecl& attribute : template_->attributes) {
      const std::string name(attribute.name);
      if (attribute.optional) {
        const bool there =
            std::find(graph_.attributes.begin(), graph_.attributes.end(), name) != graph_.attributes.end();
        slots_[attribute.has_slot] = dag().boolean(there);
      }
      if (!attribute.fact) slots_[attribute.slot] = declare(name, attribute.type, attribute.location);
    }
    of_template_ = std::max(module_.attributes.size(), module_.varyings.size());
    for (const lang::EnvironmentDecl& environment : template_->environments) {
      ir::TextureSlot slot;
      slot.name = environment.name;
      slot.type = environment.type;
      slot.environment = true;
      slot.optional = environment.optional;
      slot.texel = environment.texel;
      slot.binding = environment.binding;
      textures_[environment.name] = slots_[environment.slot] = addTexture(slot);
    }
    for (const ir::TextureSlot* texture : texturesInOrder()) textures_[texture->name] = addTexture(*texture);
    if (template_->front_facing) {
      slots_[*template_->front_facing] =
          dag().input({ir::InputKind::FrontFacing, "gl_FrontFacing", ir::Type::Bool, ir::Rate::Fragment, {}});
    }
  }

  ir::ValueId declare(const std::string& name, ir::Type type, uint32_t location) {
    if (vertex_stage_) {
      module_.attributes.push_back({name, type, location});
      return dag().input({ir::InputKind::Attribute,
                          name,
                          type,
                          ir::Rate::Vertex,
                          {},
                          0,
                          static_cast<uint32_t>(module_.attributes.size() - 1)});
    }
    // Without a vertex stage the fragment's inputs come from outside as they are.
    module_.varyings.push_back({name, type, location, ir::kNoValue});
    return dag().input({ir::InputKind::Varying,
                        name,
                        type,
                        ir::Rate::Fragment,
                        {},
                        0,
                        static_cast<uint32_t>(module_.varyings.size() - 1)});
  }

  /// An attribute that a graph or a node of the library names; kNoValue where it has another type. Vertices
  /// have no bools: one is a float that is not 0.
  ir::ValueId attribute(std::string_view name, ir::Type type) {
    if (ir::isMatrix(type)) {  // each column is one
      std::vector<ir::ValueId> columns;
      for (int i = 0; i < ir::componentCount(ir::partType(type)); ++i)
        columns.push_back(attribute(graph::columnName(name, i), ir::partType(type)));
      const bool all = std::find(columns.begin(), columns.end(), ir::kNoValue) == columns.end();
      return all ? lang::constructed(dag(), type, columns) : ir::kNoValue;
    }
    const auto found = std::find_if(own_.begin(), own_.end(),
                                    [&](const auto& own) { return graph::sameAttribute(own.first, name); });
    ir::ValueId value = found == own_.end() ? ir::kNoValue : found->second;
    for (const lang::AttributeDecl& known : template_->attributes) {
      if (known.fact || !graph::sameAttribute(known.name, name)) continue;
      value = slots_[known.slot];
      named_.push_back(known.location);
    }
    const ir::Type stored = type == ir::Type::Bool ? ir::Type::Float : type;
    if (value == ir::kNoValue) {
      value = declare(std::string(name), stored, 0);
      own_.emplace_back(name, value);
    }
    if (dag()[value].type != stored) return ir::kNoValue;
    if (type == ir::Type::Bool) {
      value = lang::converted(dag(), value, type);
      dag().name(value, fmt::format("is{}", name[0] == '_' ? std::string(name) : "_" + std::string(name)));
    }
    return dag()[value].rate == ir::Rate::Vertex ? lang::interpolated(dag(), value) : value;
  }

  /// Those that are read, in the order of their names, where no attribute of the template lies that the
  /// primitive has: devices take sixteen, and an optional one that this primitive lacks leaves its place.
  void placeOwnAttributes() {
    constexpr uint32_t kLocations = 16;
    std::vector<uint32_t> taken = named_;
    for (const lang::AttributeDecl& known : template_->attributes) {
      if (known.fact || known.location >= kLocations) continue;
      if (!known.optional || graph_.hasAttribute(known.name)) taken.push_back(known.location);
    }
    std::vector<size_t> own;
    const size_t count = vertex_stage_ ? module_.attributes.size() : module_.varyings.size();
    // A template that extends another has some behind all of that one's.
    for (size_t i = 0; i < count; ++i) {
      const uint32_t location = vertex_stage_ ? module_.attributes[i].location : module_.varyings[i].location;
      if (i >= of_template_ || location >= kLocations) own.push_back(i);
    }
    const auto nameOf = [&](size_t i) -> const std::string& {
      return vertex_stage_ ? module_.attributes[i].name : module_.varyings[i].name;
    };
    if (own.empty()) return;
    std::vector<bool> idle(count, true);
    std::vector<ir::ValueId> roots;
    for (const ir::Output& output : module_.outputs) roots.push_back(output.value);
    for (const ir::ValueId id : ir::reachable(module_.dag, roots)) {
      if (module_.dag[id].op != ir::Op::Input) continue;
      const ir::Input& input = module_.dag.inputOf(id);
      if (input.kind == ir::InputKind::Attribute || input.kind == ir::InputKind::Varying)
        idle[input.field] = false;
    }
    std::sort(own.begin(), own.end(), [&](size_t a, size_t b) {
      return std::pair(idle[a], nameOf(a)) < std::pair(idle[b], nameOf(b));
    });
    uint32_t location = 0;
    for (const size_t i : own) {
      while (std::find(taken.begin(), taken.end(), location) != taken.end()) ++location;
      (vertex_stage_ ? module_.attributes[i].location : module_.varyings[i].location) = location++;
    }
  }

  /// In the order in which the nodes ask for them: that of the graph's list is nobody's business.
  std::vector<const ir::TextureSlot*> texturesInOrder() const {
    std::vector<const ir::TextureSlot*> textures;
    for (const size_t index : order_) {
      for (const auto& [name, source] : graph_.nodes[index].inputs) {
        const auto* ref = std::get_if<graph::TextureRef>(&source.from);
        const std::optional<size_t> place = ref == nullptr ? std::nullopt : graph_.findTexture(ref->name);
        if (!place) continue;
        const ir::TextureSlot* slot = &graph_.textures[*place];
        if (std::find(textures.begin(), textures.end(), slot) == textures.end()) textures.push_back(slot);
      }
    }
    return textures;
  }

  ir::ValueId addTexture(const ir::TextureSlot& slot) {
    const auto index = static_cast<uint32_t>(module_.textures.size());
    module_.textures.push_back(slot);
    const ir::ValueId value =
        dag().input({ir::InputKind::Texture, slot.name, slot.type, ir::Rate::Frame, {0, 1}, 0, index});
    return value;
  }

  void declareBlock(const lang::BlockDecl& decl) {
    ir::Block block{
        roleOf(decl.role), std::string(decl.type_name), std::string(decl.instance), {}, decl.array, 0};
    block.binding = decl.binding;
    block.fields.reserve(decl.fields.size());
    for (const lang::BlockFieldDecl& field : decl.fields) {
      block.fields.push_back({std::string(field.name), field.type, 0, field.range, std::string(field.prose),
                              field.array, field.default_value.value_or(ir::Components{})});
    }
    block.list = decl.list;
    block.size = decl.list ? ir::listLayout(block.fields) : ir::layout(block.fields);
    if (decl.list) block.array = 0;
    const auto index = static_cast<uint32_t>(module_.blocks.size());
    for (uint32_t i = 0; i < decl.fields.size() && !decl.list; ++i) {
      const lang::BlockFieldDecl& field = decl.fields[i];
      for (uint32_t k = 0; k < field.elements(); ++k) {
        ir::Input input{ir::InputKind::BlockField,
                        joined(decl.instance, block.fields[i].elementName(k)),
                        field.type,
                        rateOf(decl.role),
                        field.range,
                        index,
                        i};
        input.index = k;
        slots_[field.slot + k] = dag().input(std::move(input));
      }
    }
    if (decl.role == lang::BlockRole::Lights) declareLights(decl);
    module_.blocks.push_back(std::move(block));
  }

  const lang::BlockDecl& blockOf(std::string_view instance, uint32_t& index) const {
    const auto found = std::find_if(template_->blocks.begin(), template_->blocks.end(),
                                    [&](const lang::BlockDecl& block) { return block.instance == instance; });
    assert(found != template_->blocks.end());
    index = static_cast<uint32_t>(found - template_->blocks.begin());
    return *found;
  }

  /// The light at hand is the one whose number stands at the loop's place in the list.
  void listLights(const lang::LightListsDecl& decl) {
    ir::LightLists lists;
    const lang::BlockDecl& ranges = blockOf(decl.ranges, lists.first.block);
    lists.count.block = lists.first.block;
    lists.first.field = fieldIndex(ranges, "first");
    lists.count.field = fieldIndex(ranges, "count");
    const lang::BlockDecl& numbers = blockOf(decl.numbers, lists.number.block);
    lists.number.field = fieldIndex(numbers, "light");
    module_.light_lists = lists;
    const ir::ValueId place =
        dag().input({ir::InputKind::LightIndex, ir::kLightIndexName, ir::Type::Int, ir::Rate::Light, {}});
    const ir::ValueId number = dag().element(place, ir::Type::Int, lists.number);
    dag().name(number, "light_number");
    for (uint32_t b = 0; b < template_->blocks.size(); ++b) {
      const lang::BlockDecl& block = template_->blocks[b];
      if (block.role != lang::BlockRole::Lights) continue;
      for (uint32_t f = 0; f < block.fields.size(); ++f)
        slots_[block.fields[f].slot] = dag().element(number, block.fields[f].type, {b, f});
    }
  }

  /// Which lights the sums run over: after the givens, before all that sums.
  void bindLightRange() {
    if (!template_->light_lists) return;
    dag().setTerm(dag().addTerm("lights", "", template_->origin.file, template_->origin.line));
    const ir::ValueId index = inliner_.evaluate(*template_->light_lists->index, slots_);
    const ir::ValueId range = dag().make(ir::Op::ToInt, {index});
    dag().name(range, "light_range");
    const ir::ValueId first = dag().element(range, ir::Type::Int, module_.light_lists->first);
    dag().name(first, "first_light");
    const ir::ValueId count = dag().element(range, ir::Type::Int, module_.light_lists->count);
    dag().name(count, "lights_here");
    inliner_.sumOver(first, count);
  }

  void declareLights(const lang::BlockDecl& decl) {
    module_.light_groups.push_back({0, decl.list ? ir::LightGroup::kListed : ir::LightGroup::kCounted});
    const ir::Input& count = dag().inputOf(slots_[decl.count_slot]);
    module_.light_count = {count.block, count.field};
    for (const lang::LightKindDecl& kind : template_->light_kinds) {
      ir::LightKind& known = module_.light_kinds.emplace_back();
      known.name = kind.name;
      if (options_.evaluable) known.fill = std::make_shared<const ir::Module>(fillOf(*template_, kind));
      for (const lang::LightFieldDecl& field : kind.fields) {
        if (field.constant) known.fixed.emplace_back(fieldIndex(decl, field.name), *field.constant);
      }
    }
  }

  static uint32_t fieldIndex(const lang::BlockDecl& block, std::string_view name) {
    const auto found = std::find_if(block.fields.begin(), block.fields.end(),
                                    [&](const lang::BlockFieldDecl& field) { return field.name == name; });
    assert(found != block.fields.end());
    return static_cast<uint32_t>(found - block.fields.begin());
  }

  /// The template's given of a name; looked for once.
  std::optional<lang::GivenResult> givenNamed(std::string_view name) {
    const auto known = givens_.find(name);
    if (known != givens_.end()) return known->second;
    return givens_.emplace(name, template_->find(name)).first->second;
  }

  /// Which of the template's givens its outputs, or the graph, take values from.
  std::vector<bool> readGivens() {
    const std::vector<lang::GivenDecl>& givens = template_->givens;
    std::vector<uint32_t> of_slot(template_->slots, ~uint32_t{0});
    for (uint32_t i = 0; i < givens.size(); ++i)
      std::fill_n(of_slot.begin() + givens[i].slot, givens[i].results.size(), i);
    std::vector<bool> read(givens.size());
    std::vector<const lang::Expr*> open;
    const auto add = [&](std::string_view name) {
      const auto found = name.empty() ? std::nullopt : givenNamed(name);
      const size_t place = found ? static_cast<size_t>(found->given - givens.data()) : givens.size();
      if (!found || read[place]) return;
      read[place] = true;
      open.push_back(found->given->value.get());
    };
    const auto source = [&](const graph::Source& from) {
      if (const auto* given = std::get_if<graph::GivenRef>(&from.from)) add(given->name);
    };
    for (const size_t index : order_) {
      for (const auto& [name, from] : graph_.nodes[index].inputs) source(from);
    }
    for (const lang::NodeDecl* decl : decls_) {
      for (const lang::Param& param : decl->params) add(param.given);
    }
    for (const auto& [name, from] : graph_.outputs) source(from);
    if (options_.shown != nullptr) source(*options_.shown);
    for (const lang::PortDecl& port : template_->ports) open.push_back(port.default_value.get());
    for (const lang::OutputDecl& output : template_->outputs) {
      open.push_back(output.value.get());
      if (output.role == lang::OutputRole::Displacement) add(output.name);
    }
    if (template_->light_lists) open.push_back(template_->light_lists->index.get());
    while (!open.empty()) {
      const lang::Expr* expr = open.back();
      open.pop_back();
      if (expr == nullptr) continue;
      const uint32_t given = expr->kind == lang::Expr::Kind::Slot ? of_slot[expr->slot] : ~uint32_t{0};
      if (given < givens.size() && !read[given]) {
        read[given] = true;
        open.push_back(givens[given].value.get());
      }
      for (const lang::ExprPtr& arg : expr->args) open.push_back(arg.get());
    }
    return read;
  }

  using Moved = std::vector<std::pair<const lang::GivenDecl*, ir::ValueId>>;
  void bindGivens(const Moved& moved = {}) {
    const std::vector<bool> read = readGivens();
    for (const lang::GivenDecl& decl : template_->givens) {
      if (!read[static_cast<size_t>(&decl - template_->givens.data())]) continue;
      const lang::NodeDecl* node = decl.value->kind == lang::Expr::Kind::Call ? decl.value->node : nullptr;
      const lang::Origin& origin = node == nullptr ? template_->origin : node->origin;
      dag().setTerm(dag().addTerm(decl.name, node == nullptr ? std::string_view() : node->source, origin.file,
                                  origin.line));
      inliner_.bind(decl, slots_);
      for (const auto& [given, value] : moved) {
        if (given == &decl) slots_[decl.slot] = value;
      }
    }
  }

  /// Before nodes ask for some by their own types: what the graph says counts.
  void nameAttributes() {
    std::vector<const graph::AttributeRef*> named;
    const auto name = [&](const graph::Source& source) {
      if (const auto* ref = std::get_if<graph::AttributeRef>(&source.from)) named.push_back(ref);
    };
    for (const size_t index : order_) {
      for (const auto& [input, source] : graph_.nodes[index].inputs) name(source);
    }
    for (const auto& [output, source] : graph_.outputs) name(source);
    std::sort(named.begin(), named.end(), [](const auto* a, const auto* b) { return a->name < b->name; });
    for (const graph::AttributeRef* ref : named) from(*ref);
  }

  void nodes() {
    nameAttributes();
    results_.reserve(order_.size());
    for (size_t i = 0; i < order_.size(); ++i) {
      const graph::Node& node = graph_.nodes[order_[i]];
      const lang::NodeDecl& decl = *decls_[i];
      std::pmr::vector<ir::ValueId> args(&arena_);
      args.reserve(decl.params.size());
      size_t next = 0;
      for (const lang::Param& param : decl.params) {
        const graph::Source* input = inputNamed(node.inputs, param.name, next);
        args.push_back(input == nullptr ? givenFor(param) : argument(*input, param));
      }
      // What the node is called in the graph is the tool's that made it.
      const std::string_view term = node.term.empty() ? decl.family : std::string_view(node.term);
      dag().setTerm(dag().addTerm(term, decl.source, decl.origin.file, decl.origin.line));
      Values results = inliner_.call(decl, node.variant, args);
      if (results.size() == 1) dag().name(results[0], term.substr(term.rfind('.') + 1));
      if (node.at_vertices) moveToVertices(decl, term, results);
      results_.emplace(node.id, Lowered{&decl, std::move(results)});
    }
  }

  ir::ValueId argument(const graph::Source& source, const lang::Param& param) {
    const auto* choice = std::get_if<graph::Choice>(&source.from);
    if (choice == nullptr) return this->source(source, param.type);
    const auto found = std::find(param.choices.begin(), param.choices.end(), choice->name);
    return dag().integer(static_cast<int32_t>(found - param.choices.begin()));
  }

  /// What the template gives for a parameter that nothing is connected to; kNoValue for its constant default.
  /// As a graph sees it: what the vertices know is interpolated, and of integers one vertex's. (At the
  /// vertices that is taken back.)
  ir::ValueId given(const lang::GivenResult& found) {
    const ir::ValueId value = slots_[found.given->slot + found.index];
    const ir::Value& of = dag()[value];
    const bool between = of.rate == ir::Rate::Vertex && !ir::isMatrix(of.type) && !ir::isTexture(of.type);
    return between ? lang::interpolated(dag(), value) : value;
  }

  ir::ValueId givenFor(const lang::Param& param) {
    if (graph::isAttributeName(param.given))
      return graph_.hasAttribute(param.given) ? attribute(param.given, param.type) : ir::kNoValue;
    const auto found = param.given.empty() ? std::nullopt : givenNamed(param.given);
    if (!found || found->given->results[found->index].type != param.type) return ir::kNoValue;
    return given(*found);
  }

  /// What a node gives comes from the vertices, in its range: interpolants reach past the ends of triangles.
  void moveToVertices(const lang::NodeDecl& decl, std::string_view term_name, Values& results) {
    AtVertices at_vertices(dag());
    std::vector<std::optional<ir::ValueId>> lifted;
    for (const ir::ValueId id_of : results) {
      lifted.push_back(ir::isFloating(dag()[id_of].type) ? at_vertices(id_of) : std::nullopt);
      if (!lifted.back()) return;
    }
    const ir::TermId term = dag().addTerm(fmt::format("{}.at_vertices", term_name), decl.source,
                                          decl.origin.file, decl.origin.line);
    std::vector<ir::ValueId> moved(results.begin(), results.end());
    for (size_t i = 0; i < moved.size(); ++i) {
      if (dag()[moved[i]].rate <= ir::Rate::Vertex) continue;
      const ir::Type type = dag()[moved[i]].type;
      const std::string name = std::string(results.size() == 1 ? term_name.substr(term_name.rfind('.') + 1)
                                                               : decl.results[i].name);
      dag().setTerm(term);
      moved[i] = dag().make(ir::Op::Interpolate, {*lifted[i]});
      dag().name(moved[i], name);
      const ir::Range& range = decl.results[i].range;
      const auto bound = [&](ir::Op op, double by) {
        if (!std::isfinite(by)) return;
        moved[i] = dag().make(op, {moved[i], dag().constant(type, {by, by, by, by})});
      };
      if (!decl.results[i].has_range) continue;
      bound(ir::Op::Max, range.lo);
      bound(ir::Op::Min, range.hi);
    }
    std::copy(moved.begin(), moved.end(), results.begin());
  }

  /// As what it goes to wants it: a float for a vector is each of its components, a whole number an int.
  ir::ValueId source(const graph::Source& source, ir::Type wanted) {
    if (const auto* literal = std::get_if<graph::Literal>(&source.from);
        literal != nullptr && source.swizzle.empty() && ir::isWhole(ir::partType(wanted)))
      return dag().constant(wanted, literal->value);
    const ir::ValueId value = swizzled(source);
    const bool wide = ir::isFloatVector(wanted) && dag()[value].type == ir::Type::Float;
    return wide ? dag().construct(wanted, {value}) : value;
  }

  ir::ValueId swizzled(const graph::Source& source) {
    const ir::ValueId value = std::visit([this](const auto& from) { return this->from(from); }, source.from);
    if (source.swizzle.empty()) return value;
    if (dag()[value].type == ir::Type::Float) {
      const int count = static_cast<int>(source.swizzle.size());
      return count == 1 ? value : dag().construct(ir::floatType(count), {value});
    }
    std::array<int, 4> components{};
    const size_t count = source.swizzle.size();
    assert(count <= components.size());
    for (size_t i = 0; i < count; ++i)
      components[i] = static_cast<int>(std::string_view("xyzwrgbastpq").find(source.swizzle[i])) % 4;
    const ir::Type type = dag()[value].type;
    if (ir::isFloatVector(type)) return dag().swizzle(value, {components.data(), count});
    std::array<ir::ValueId, 4> parts{};
    for (size_t i = 0; i < count; ++i) parts[i] = lang::componentOf(dag(), value, components[i]);
    const ir::Type picked = ir::vectorType(ir::partType(type), static_cast<int>(count));
    return count == 1 ? parts[0] : lang::constructed(dag(), picked, {parts.data(), count});
  }

  ir::ValueId from(const graph::Literal& literal) { return dag().constant(literal.type, literal.value); }

  ir::ValueId from(const graph::ParameterRef& reference) {
    const auto known = parameters_.find(reference.name);
    if (known != parameters_.end()) return known->second;
    for (size_t i = of_graph_.size(); i < graph_.parameters.size(); ++i)
      of_graph_.emplace(graph_.parameters[i].name, &graph_.parameters[i]);
    const ir::Parameter* it = of_graph_.at(reference.name);
    if (options_.parameters == ParameterMode::Baked && !it->animated)
      return dag().constant(it->type, it->value);
    const ir::ValueId value = dag().input({ir::InputKind::Parameter, it->name, it->type, ir::Rate::Material,
                                           it->range, 0, static_cast<uint32_t>(module_.parameters.size())});
    module_.parameters.push_back(*it);
    for (int i = 0; i < ir::componentCount(it->type); ++i) {
      double& x = module_.parameters.back().neutral[static_cast<size_t>(i)];
      x = std::clamp(x, it->range.lo, it->range.hi);
    }
    parameters_[it->name] = value;
    return value;
  }

  ir::ValueId from(const graph::TextureRef& reference) { return textures_.at(reference.name); }
  /// Only a group has inputs, and the graph is flat.
  static ir::ValueId from(const graph::InputRef& /*reference*/) {
    assert(false);
    return ir::kNoValue;
  }
  /// Its input knows what it stands for: choiceOf().
  static ir::ValueId from(const graph::Choice& /*choice*/) {
    assert(false);
    return ir::kNoValue;
  }
  ir::ValueId from(const graph::GivenRef& reference) {
    const auto found = givenNamed(reference.name);
    assert(found);
    return given(*found);
  }

  ir::ValueId from(const graph::AttributeRef& reference) {
    const ir::ValueId value = attribute(reference.name, reference.type);
    assert(value != ir::kNoValue);
    return value;
  }

  ir::ValueId from(const graph::NodeRef& reference) {
    const Lowered& lowered = results_.at(reference.node);
    const std::vector<lang::Param>& declared = lowered.decl->results;
    // A single result may be referred to by its name too.
    size_t index = 0;
    while (declared.size() > 1 && declared[index].name != reference.output) ++index;
    return lowered.results[index];
  }

  void ports() {
    for (const lang::PortDecl& port : template_->ports) {
      const auto it = std::find_if(graph_.outputs.begin(), graph_.outputs.end(),
                                   [&](const auto& output) { return output.first == port.param.name; });
      if (it != graph_.outputs.end())
        slots_[port.slot] = source(it->second, port.param.type);
      else
        slots_[port.slot] = inliner_.evaluate(*port.default_value, slots_);
    }
  }

  /// Whether the graph delivers a port that an expression of the template reads.
  bool delivers(const lang::Expr& expr) const {
    if (expr.kind == lang::Expr::Kind::Slot) {
      for (const lang::PortDecl& port : template_->ports) {
        if (port.slot != expr.slot) continue;
        return std::any_of(graph_.outputs.begin(), graph_.outputs.end(),
                           [&](const auto& output) { return output.first == port.param.name; });
      }
    }
    return std::any_of(expr.args.begin(), expr.args.end(),
                       [&](const lang::ExprPtr& arg) { return arg && delivers(*arg); });
  }

  /// The givens that the template displaces become what it says, for all that is put out: the rest is made of
  /// the moved ones. What the displacement itself is made of sees them where they were.
  Diagnostics displace() {
    Moved moved;
    for (const lang::OutputDecl& decl : template_->outputs) {
      if (decl.role != lang::OutputRole::Displacement) continue;
      if (decl.optional && !delivers(*decl.value)) continue;
      const lang::GivenDecl* given = template_->find(decl.name)->given;
      dag().setTerm(dag().addTerm("displacement", "", template_->origin.file, template_->origin.line));
      const ir::ValueId value = inliner_.evaluate(*decl.value, slots_);
      if (value == slots_[given->slot]) continue;
      const std::optional<ir::ValueId> there = AtVertices(dag(), true)(value);
      if (!there) {
        return {
            {"wrong-rate",
             Severity::Error,
             {std::string(template_->origin.file), template_->origin.line, 0, {}},
             fmt::format("the displacement of '{}' in the template '{}' is not known to the vertices{}",
                         decl.name, template_->name,
                         unknownAtVertices(*decl.value, *template_, graph_, slots_, dag())),
             "made at the vertices: what has no sum_over_lights(), dFdx(), dFdy() and gl_FrontFacing in it",
             {}}};
      }
      if (*there == slots_[given->slot]) continue;
      moved.emplace_back(given, *there);
      module_.displaces.emplace_back(decl.name);
    }
    if (moved.empty()) return {};
    bindGivens(moved);
    bindLightRange();
    results_.clear();
    nodes();
    ports();
    return {};
  }

  /// What the template's slots are where the graph delivers nothing that it may leave out.
  std::vector<ir::ValueId> slotsWithoutPorts() {
    std::vector<ir::ValueId> slots = slots_;
    for (const lang::PortDecl& port : template_->ports) {
      if (port.default_value) slots[port.slot] = inliner_.evaluate(*port.default_value, slots);
    }
    return slots;
  }

  void show(const graph::Source& source) {
    uint32_t location = 0;
    for (ir::ValueId shown : shownParts(dag(), swizzled(source), options_.shown_whole)) {
      if (dag()[shown].rate == ir::Rate::Light) shown = inliner_.summed(shown);
      if (dag()[shown].rate == ir::Rate::Vertex) shown = dag().make(ir::Op::Interpolate, {shown});
      const std::string name = location == 0 ? "shown" : "shown_rest";
      module_.outputs.push_back({ir::OutputKind::Color, ir::Stage::Fragment, name, location++, shown});
    }
  }

  Diagnostics outputs() {
    uint32_t color = 0;
    const bool packs = packsOutputs(*template_);
    OutputPacker packer(dag(), *template_);
    const std::vector<ir::ValueId> without = packs ? slotsWithoutPorts() : std::vector<ir::ValueId>();
    dag().setTerm(dag().addTerm("output", "", template_->origin.file, template_->origin.line));
    if (options_.shown != nullptr) show(*options_.shown);
    for (const lang::OutputDecl& decl : template_->outputs) {
      if (decl.role == lang::OutputRole::Displacement) continue;  // displace() has made it
      if (options_.shown != nullptr && decl.role != lang::OutputRole::Position) continue;
      if (decl.optional && !delivers(*decl.value)) {
        color += decl.role == lang::OutputRole::Color && !packs ? 1 : 0;
        continue;
      }
      if (packs && decl.optional && decl.role == lang::OutputRole::Color && ir::isFloating(decl.type)) {
        packer.add(decl, inliner_.evaluate(*decl.value, slots_), inliner_.evaluate(*decl.value, without));
        continue;
      }
      ir::Output output{ir::OutputKind::Color, ir::Stage::Fragment, std::string(decl.name), 0, ir::kNoValue};
      output.value = inliner_.evaluate(*decl.value, slots_);
      switch (decl.role) {
        case lang::OutputRole::Position:
          output.kind = ir::OutputKind::Position;
          output.stage = ir::Stage::Vertex;
          break;
        case lang::OutputRole::Color:
          output.location = color++;
          if (packs && output.value == inliner_.evaluate(*decl.value, without)) packer.idle(decl.name);
          // No format has three channels everywhere.
          if (decl.type == ir::Type::Vec3)
            output.value = dag().construct(ir::Type::Vec4, {{output.value, dag().constant(1)}});
          break;
        case lang::OutputRole::Discard:
          output.kind = ir::OutputKind::Discard;
          if (dag().isConstant(output.value, 0)) continue;
          break;
        case lang::OutputRole::Depth:
          output.kind = ir::OutputKind::Depth;
          output.value = dag().make(ir::Op::Clamp, {output.value, dag().constant(0), dag().constant(1)});
          break;
        case lang::OutputRole::Displacement: continue;
      }
      module_.outputs.push_back(output);
    }
    return options_.shown != nullptr ? Diagnostics() : packer.finish(color, module_.outputs);
  }

  /// What the checks of the template and of the graph do not find, for they do not look into nodes: a
  /// position, and what is interpolated, may only be made of what vertices know.
  Diagnostics rates() const {
    Diagnostics wrong;
    const auto report = [&](std::string_view file, uint32_t line, std::string message) {
      wrong.push_back(
          {"wrong-rate",
           Severity::Error,
           {std::string(file), line, 0, {}},
           std::move(message),
           "made at the vertices: what has no interpolate(), sum_over_lights(), dFdx(), dFdy() and "
           "gl_FrontFacing in it",
           {}});
    };
    std::vector<ir::ValueId> roots;
    for (const ir::Output& output : module_.outputs) {
      roots.push_back(output.value);
      const ir::Rate rate = module_.dag[output.value].rate;
      if (output.stage != ir::Stage::Vertex || rate <= ir::Rate::Vertex) continue;
      report(template_->origin.file, template_->origin.line,
             fmt::format("the output '{}' of the template '{}' is of the rate {}", output.name,
                         template_->name, ir::rateName(rate)));
    }
    for (const ir::ValueId id : ir::reachable(module_.dag, roots)) {
      const ir::Value& value = module_.dag[id];
      if (value.op != ir::Op::Interpolate) continue;
      const ir::Rate rate = module_.dag[value.args[0]].rate;
      if (rate <= ir::Rate::Vertex) continue;
      const ir::Term& term = module_.dag.terms()[module_.dag.termOf(id)];
      report(term.file, term.line,
             fmt::format("'{}' interpolates what is of the rate {}", term.name, ir::rateName(rate)));
    }
    return wrong;
  }

  const graph::Graph& graph_;
  const lang::Library& library_;
  const LowerOptions& options_;
  ir::Module module_;
  Inliner inliner_;
  const lang::TemplateDecl* template_ = nullptr;
  std::vector<ir::ValueId> slots_;
  std::vector<size_t> order_;                 ///< of the graph's nodes
  std::vector<const lang::NodeDecl*> decls_;  ///< of the nodes in that order
  bool vertex_stage_ = false;
  size_t of_template_ = 0;                                ///< of the attributes, or of the varyings
  std::vector<std::pair<std::string, ir::ValueId>> own_;  ///< of the graph's own attributes
  std::vector<uint32_t> named_;                           ///< locations of the template's that it names, too
  struct Lowered {
    const lang::NodeDecl* decl;
    Values results;
  };
  Arena arena_;
  NameMap<Lowered> results_{&arena_};  ///< of the graph's nodes
  NameMap<ir::ValueId> textures_{&arena_}, parameters_{&arena_};
  NameMap<const ir::Parameter*> of_graph_{&arena_};
  NameMap<std::optional<lang::GivenResult>> givens_{&arena_};
};

}  // namespace

Result<ir::Module> lower(const graph::Graph& graph, const lang::Library& library,
                         const LowerOptions& options) {
  return Lowering(graph, library, options).run();
}

}  // namespace lacquer::lower
