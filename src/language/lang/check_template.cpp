#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "ir/module.h"
#include "lang/builtins.h"
#include "lang/checker.h"
#include "lang/evaluate.h"
#include "lang/suggest.h"

namespace lacquer::lang {

using ir::Type;
using ir::typeName;

namespace {

/// Where it stands in a text that the reporter does not have.
template <class T>
void inherit(std::vector<T>& list) {
  for (T& part : list) part.inherited = true;
}

/// What the base declares goes before what the template itself does.
template <class T>
void prepend(std::vector<T>& list, std::vector<T>&& base) {
  list.insert(list.begin(), std::make_move_iterator(base.begin()), std::make_move_iterator(base.end()));
}

/// The blocks' fields that `extend block` adds go to the block, and what `replace output` declares to the
/// output's place. `decl` has the parts of its bases already.
void merge(TemplateDecl& decl) {
  for (size_t i = 0; i < decl.blocks.size(); ++i) {
    BlockDecl& extension = decl.blocks[i];
    const auto base = std::find_if(decl.blocks.begin(), decl.blocks.end(), [&](const BlockDecl& block) {
      return !block.extension && block.instance == extension.instance;
    });
    if (!extension.extension || base == decl.blocks.end()) continue;
    std::move(extension.fields.begin(), extension.fields.end(), std::back_inserter(base->fields));
  }
  std::erase_if(decl.blocks, [](const BlockDecl& block) { return block.extension; });
  for (size_t i = 0; i < decl.outputs.size();) {
    OutputDecl& output = decl.outputs[i];
    const auto end = decl.outputs.begin() + static_cast<std::ptrdiff_t>(i);
    const auto base = std::find_if(decl.outputs.begin(), end,
                                   [&](const OutputDecl& other) { return other.name == output.name; });
    if (output.replaces && base != end && base->role == output.role) {
      *base = std::move(output);
      base->replaces = false;
      decl.outputs.erase(end);
    } else {
      ++i;
    }
  }
}

/// The binding contract (docs/bindings.md): set 0 has what is filled once a frame, in the order of the text,
/// the blocks of each template before its textures; set 2 the objects' blocks. What a template adds comes
/// after what it extends, so that this stays where it was.
class Places {
public:
  void take(TemplateDecl& decl) {
    for (BlockDecl& block : decl.blocks) {
      if (!block.extension && !block.optional) number(block);
    }
    for (EnvironmentDecl& environment : decl.environments) {
      if (environment.optional) continue;
      environment.binding = {environment.object ? ir::kObjectSet : 0U,
                             environment.object ? object_++ : frame_++, unit_++};
    }
  }
  /// What is optional lies behind all else in its set, so that no number depends on it, in the order of the
  /// text; its unit is bind's to give. The objects' after all that is the frame's.
  void takeOptional(TemplateDecl& decl, bool object) {
    auto environment = decl.environments.begin();
    const auto texturesBefore = [&](uint32_t offset) {
      for (; environment != decl.environments.end() && environment->span.offset < offset; ++environment) {
        if (environment->optional && environment->object == object)
          environment->binding = {object ? ir::kObjectSet : 0U, object ? object_++ : frame_++, 0};
      }
    };
    for (BlockDecl& block : decl.blocks) {
      if (!block.optional || block.late || (block.role == BlockRole::Object) != object) continue;
      texturesBefore(block.span.offset);
      number(block);
    }
    texturesBefore(~uint32_t{0});
  }
  /// Behind all of that: a block that is added there moves no number of templates that extend this one.
  void takeLate(TemplateDecl& decl) {
    for (BlockDecl& block : decl.blocks) {
      if (block.late) number(block);
    }
  }
  /// Lists' units, behind the required environment's: they are textures where there are no storage buffers.
  void takeLists(TemplateDecl& decl) {
    for (BlockDecl& block : decl.blocks) {
      if (block.list) block.binding.flat = unit_++;
    }
  }
  /// Behind the environment's units, of which there are never fewer than the first contract had.
  uint32_t materialTextures() const { return std::max(unit_, ir::kLeastMaterialTexture); }

private:
  void number(BlockDecl& block) {
    const bool object = block.role == BlockRole::Object;
    // Lights that a template puts into a list leave the number of their buffer unused.
    const uint32_t buffer = block.role == BlockRole::List ? 0 : buffer_++;
    block.binding = {object ? ir::kObjectSet : 0U, object ? object_++ : frame_++, buffer};
    if (buffer_ == ir::kMaterialBinding.flat) ++buffer_;
  }

  uint32_t frame_ = 0, object_ = 0, buffer_ = 0, unit_ = 0;
};

/// Lists are known before anything is checked: their elements hold less than those of blocks.
void markLists(TemplateDecl& decl, bool listed) {
  for (BlockDecl& block : decl.blocks)
    block.list = block.role == BlockRole::List || (listed && block.role == BlockRole::Lights);
}

bool sumsLights(const Expr& expr) {
  const bool sum = expr.kind == Expr::Kind::Operation && expr.builtin != nullptr &&
                   expr.builtin->op == ir::Op::SumOverLights;
  return sum || std::any_of(expr.args.begin(), expr.args.end(),
                            [](const ExprPtr& arg) { return arg && sumsLights(*arg); });
}

/// Whether it reads nothing that is not known when the text is.
bool isConstant(const Expr& expr) {
  using Kind = Expr::Kind;
  constexpr Kind kKinds[] = {Kind::Literal,   Kind::Constant, Kind::Operation,
                             Kind::Construct, Kind::Swizzle,  Kind::Index};
  return std::find(std::begin(kKinds), std::end(kKinds), expr.kind) != std::end(kKinds) &&
         std::all_of(expr.args.begin(), expr.args.end(),
                     [](const ExprPtr& arg) { return arg && isConstant(*arg); });
}

}  // namespace

std::span<const LightProperty> lightProperties() {
  static constexpr std::array kProperties = {
      LightProperty{"color", Type::Vec3, "linear"},
      LightProperty{"intensity", Type::Float, "candela of a point or a spot, lux of a directional light"},
      LightProperty{"range", Type::Float, "metres; 0 without a range"},
      LightProperty{"innerConeAngle", Type::Float, "radians, of a spot"},
      LightProperty{"outerConeAngle", Type::Float, "radians, of a spot"},
      LightProperty{"position", Type::Vec3, "of the light's node, world space"},
      LightProperty{"direction", Type::Vec3, "unit, where the light's node looks: its -Z axis, world space"},
      LightProperty{"right", Type::Vec3, "unit, the X axis of the light's node, world space"},
      LightProperty{"up", Type::Vec3, "unit, the Y axis of the light's node, world space"},
      LightProperty{"size", Type::Float,
                    "metres: the height of a rect, the diameter of a disk, times its node's largest scale"},
      LightProperty{"aspect", Type::Float, "of a rect, its width by its height"},
  };
  return kProperties;
}

/// What extends a kind of light goes behind the fields that it has; the last value of a field counts.
static void mergeKinds(std::vector<LightKindDecl>& kinds) {
  for (LightKindDecl& more : kinds) {
    if (!more.extends) continue;
    const auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const LightKindDecl& k) { return k.name == more.name; });
    if (kind->extends) continue;
    for (LightFieldDecl& field : more.fields) kind->fields.push_back(std::move(field));
  }
  std::erase_if(kinds, [](const LightKindDecl& kind) { return kind.extends; });
}

void Checker::templateDecl(TemplateDecl& decl, std::vector<TemplateDecl> bases) {
  template_ = &decl;
  if (decl.doc.empty()) {
    reporter_.error("missing-doc", decl.span,
                    fmt::format("the template '{}' has no documentation", decl.name),
                    "say what it is in a line `/// ...` above it");
  }
  uint32_t slots = 0;
  names_.push_back({"gl_FrontFacing", Name::Kind::Builtin, Type::Bool, slots++, decl.span, true, false, {}});
  auto locations = uint32_t{0};
  const bool listed = decl.light_lists || std::any_of(bases.begin(), bases.end(), [](const auto& base) {
                        return base.light_lists.has_value();
                      });
  for (TemplateDecl& base : bases) markLists(base, listed);
  markLists(decl, listed);
  Places places;
  const auto locate = [&](TemplateDecl& of, bool optional) {
    for (AttributeDecl& attribute : of.attributes) {
      if (attribute.optional == optional && !attribute.fact) attribute.location = locations++;
    }
  };
  for (TemplateDecl& base : bases) {
    parts(base, slots);
    places.take(base);
    locate(base, false);
    // At once: the next one on the way extends these blocks.
    for (Name& name : names_) name.inherited = true;
  }
  parts(decl, slots);
  places.take(decl);
  for (TemplateDecl& base : bases) places.takeLists(base);
  places.takeLists(decl);
  for (const bool object : {false, true}) {
    for (TemplateDecl& base : bases) places.takeOptional(base, object);
    places.takeOptional(decl, object);
  }
  for (TemplateDecl& base : bases) places.takeLate(base);
  places.takeLate(decl);
  decl.material_textures = places.materialTextures();
  locate(decl, false);
  for (TemplateDecl& base : bases) locate(base, true);
  locate(decl, true);
  // Where the properties of a light stand in every template: behind its own slots.
  for (TemplateDecl& base : bases) {
    for (LightKindDecl& kind : base.light_kinds) lightKind(kind, slots);
  }
  for (LightKindDecl& kind : decl.light_kinds) lightKind(kind, slots);
  decl.slots = slots;
  leaveOut(decl, bases);
  for (auto base = bases.rbegin(); base != bases.rend(); ++base) {
    inherit(base->givens);
    inherit(base->ports);
    inherit(base->outputs);
    prepend(decl.blocks, std::move(base->blocks));
    prepend(decl.attributes, std::move(base->attributes));
    prepend(decl.environments, std::move(base->environments));
    prepend(decl.givens, std::move(base->givens));
    prepend(decl.ports, std::move(base->ports));
    prepend(decl.outputs, std::move(base->outputs));
    prepend(decl.light_kinds, std::move(base->light_kinds));
    if (!decl.light_lists && base->light_lists) {
      decl.light_lists = std::move(base->light_lists);
      decl.light_lists->inherited = true;
    }
  }
  merge(decl);
  mergeKinds(decl.light_kinds);
  outputRules(decl);
}

/// `of` comes behind these bases, which lose what it leaves out. True for each name that there was.
static std::vector<bool> erased(const TemplateDecl& of, std::span<TemplateDecl> bases) {
  std::vector<bool> found;
  for (const WithoutDecl& without : of.without) {
    size_t left = 0;
    for (TemplateDecl& base : bases)
      left += std::erase_if(base.outputs, [&](const OutputDecl& o) { return o.name == without.name; });
    found.push_back(left != 0);
  }
  return found;
}

void Checker::leaveOut(const TemplateDecl& decl, std::vector<TemplateDecl>& bases) {
  for (size_t i = 0; i < bases.size(); ++i) erased(bases[i], std::span(bases).first(i));
  const std::vector<bool> found = erased(decl, std::span(bases));
  for (size_t i = 0; i < found.size(); ++i) {
    if (found[i]) continue;
    reporter_.error("unknown-output", decl.without[i].span,
                    fmt::format("there is no output '{}' to leave out", decl.without[i].name),
                    "it must come from the template that this one extends");
  }
}

void Checker::outputRules(TemplateDecl& decl) {
  for (size_t i = 0; i < decl.outputs.size(); ++i) {
    const OutputDecl& output = decl.outputs[i];
    if (output.value && sumsLights(*output.value)) decl.sums_lights = true;
    if (output.name.starts_with(ir::kPackedPrefix)) {
      reporter_.error("reserved-name", output.span,
                      fmt::format("'{}' begins with '{}'", output.name, ir::kPackedPrefix),
                      "outputs that share one place have such names");
    }
    if (output.replaces) {
      reporter_.error("unknown-output", output.span,
                      fmt::format("there is no output '{}' of that kind to replace", output.name),
                      "it must come from the template that this one extends");
      continue;
    }
    for (size_t j = 0; j < i; ++j) {
      if (output.name != decl.outputs[j].name) continue;
      reporter_.error("duplicate-name", output.span, fmt::format("there are two outputs '{}'", output.name),
                      "to put another value in its place, write `replace output`");
    }
  }
  if (decl.outputs.empty()) {
    reporter_.error("no-output", decl.span, fmt::format("the template '{}' puts nothing out", decl.name),
                    "end it with an `output color vec4 NAME = ...;` or another output");
  }
  const bool vertex_stage = std::any_of(decl.outputs.begin(), decl.outputs.end(),
                                        [](const OutputDecl& o) { return o.role == OutputRole::Position; });
  for (const OutputDecl& output : decl.outputs) {
    if (output.role != OutputRole::Displacement || vertex_stage) continue;
    reporter_.error("wrong-rate", output.inherited ? decl.span : output.span,
                    fmt::format("'{}' is moved where there are no vertices", output.name),
                    "a displacement stands beside an `output position`");
  }
  const auto depths = std::count_if(decl.outputs.begin(), decl.outputs.end(),
                                    [](const OutputDecl& o) { return o.role == OutputRole::Depth; });
  if (depths > 1) {
    reporter_.error("duplicate-name", decl.span,
                    fmt::format("the template '{}' puts {} depths out", decl.name, depths),
                    "a fragment has one");
  }
  const bool lit = std::any_of(decl.blocks.begin(), decl.blocks.end(),
                               [](const BlockDecl& block) { return block.role == BlockRole::Lights; });
  for (const GivenDecl& given : decl.givens) {
    if (!decl.light_lists || !given.value || !sumsLights(*given.value)) continue;
    reporter_.error("wrong-lights", given.inherited ? decl.span : given.span,
                    fmt::format("'{}' sums over lights, which come from lists", given.name),
                    "sum in the outputs, where the range of the list is known");
  }
  if (decl.sums_lights && !lit) {
    reporter_.error("no-lights", decl.span,
                    fmt::format("the template '{}' sums over lights and has none", decl.name),
                    "declare them: `block lights Light light[16] count frame.light_count { ... }`");
  }
}

void Checker::parts(TemplateDecl& decl, uint32_t& slots) {
  // In the order of the text, so that each part sees what stands before it.
  size_t b = 0, a = 0, e = 0, g = 0, p = 0, o = 0;
  bool lists_left = decl.light_lists.has_value();
  const auto offset = [](const auto& list, size_t i) {
    return i < list.size() ? list[i].span.offset : ~uint32_t{0};
  };
  while (true) {
    const uint32_t next =
        std::min({offset(decl.blocks, b), offset(decl.attributes, a), offset(decl.environments, e),
                  offset(decl.givens, g), offset(decl.outputs, o),
                  p < decl.ports.size() ? decl.ports[p].param.span.offset : ~uint32_t{0},
                  lists_left ? decl.light_lists->span.offset : ~uint32_t{0}});
    if (next == ~uint32_t{0}) break;
    if (next == offset(decl.blocks, b)) {
      BlockDecl& item = decl.blocks[b++];
      item.extension ? extendedBlock(item, slots) : block(item, slots);
    } else if (next == offset(decl.attributes, a)) {
      attribute(decl.attributes[a++], slots);
    } else if (next == offset(decl.environments, e)) {
      environment(decl.environments[e++], slots);
    } else if (next == offset(decl.givens, g)) {
      given(decl.givens[g++], slots);
    } else if (p < decl.ports.size() && next == decl.ports[p].param.span.offset) {
      port(decl.ports[p++], slots);
    } else if (lists_left && next == decl.light_lists->span.offset) {
      lightLists(*decl.light_lists);
      lists_left = false;
    } else {
      output(decl.outputs[o++]);
    }
  }
}

void Checker::attribute(AttributeDecl& decl, uint32_t& slots) {
  if (!decl.fact) {
    if (!ir::isFloating(decl.type) && !ir::isWhole(ir::partType(decl.type))) {
      reporter_.error("wrong-type", decl.span, fmt::format("an attribute cannot be {}", aType(decl.type)),
                      "attributes are numbers and their vectors");
    }
    if (find(decl.name) == nullptr) templateNames(decl);
    decl.slot = slots++;
    declare({decl.name, Name::Kind::Attribute, decl.type, decl.slot, decl.span, true, false, {}});
  }
  if (!decl.optional) {
    if (!decl.by.empty()) {
      reporter_.error("wrong-attribute", decl.span, "a switch decides of an optional attribute alone",
                      fmt::format("write `optional attribute ... {} by {};`", decl.name, decl.by.front()));
    }
    return;
  }
  for (const std::string_view name : decl.by) {
    const std::vector<std::string_view> known = around_.names(DeclKind::Switch);
    if (std::find(known.begin(), known.end(), name) == known.end()) unknown(name, "switch", known, {});
  }
  decl.has_slot = slots++;
  const std::string& has = made_names_.emplace_back(fmt::format("has_{}", withoutUnderscore(decl.name)));
  declare({has, Name::Kind::Attribute, Type::Bool, decl.has_slot, decl.span, true, false, {}});
}

void Checker::environment(EnvironmentDecl& decl, uint32_t& slots) {
  if (!ir::isTexture(decl.type)) {
    reporter_.error("wrong-type", decl.span, fmt::format("an environment cannot be {}", aType(decl.type)),
                    "it is a sampler2D, a samplerCube or another sampler");
  }
  if (decl.texel_syntax) {
    if (const Constant texel = constantValue(decl.texel_syntax, Type::Vec4, "the texel")) decl.texel = *texel;
  }
  if (find(decl.name) == nullptr) templateNames(decl);
  decl.slot = slots++;
  declare({decl.name, Name::Kind::Environment, decl.type, decl.slot, decl.span, true, false, {}});
}

/// `light[16]` of the lights.
void Checker::blockArray(BlockDecl& decl) {
  if (decl.array_syntax) {
    const std::optional<int> count = constantInt(decl.array_syntax, "the number of elements");
    if (count && (*count < 1 || *count > 4096)) {
      reporter_.error("wrong-count", decl.array_syntax->span,
                      fmt::format("a block cannot have {} elements", *count), "1 to 4096 are possible");
    }
    decl.array = count ? static_cast<uint32_t>(std::max(*count, 1)) : 1;
  }
  const bool lights = decl.role == BlockRole::Lights;
  if (decl.endless != (decl.role == BlockRole::List)) {
    reporter_.error("wrong-block", decl.span,
                    decl.endless ? "only a list has elements without end" : "a list has elements without end",
                    fmt::format("a list is `block list Type {}[] {{ ... }}`", decl.instance));
    return;
  }
  if (decl.array_syntax && !lights) {
    reporter_.error("wrong-block", decl.span, "only the lights can be an array",
                    "fields can be arrays: `mat4 cascade[4];`");
  }
  if (!decl.array_syntax && lights) {
    reporter_.error("wrong-block", decl.span, "the lights must be an array",
                    fmt::format("write how many there can be: `{}[16]`", decl.instance));
  }
  if (lights) return lightCount(decl);
  if (decl.count_syntax) {
    reporter_.error("wrong-block", decl.count_syntax->span, "only the lights are counted");
  }
}

/// `count frame.light_count`
void Checker::lightCount(BlockDecl& decl) {
  constexpr std::string_view kHelp =
      "name an int field of a frame block declared before: `count frame.light_count`";
  if (!decl.count_syntax) {
    reporter_.error("wrong-block", decl.span, "nothing says how many of the lights are in use",
                    std::string(kHelp));
    return;
  }
  if (!typed(decl.count_syntax, Type::Int, "the number of lights")) return;
  const Expr& count = *decl.count_syntax;
  decl.count_slot = count.slot;
  const auto& counts = frame_ints_;
  if (count.kind == Expr::Kind::Slot && std::find(counts.begin(), counts.end(), count.slot) != counts.end())
    return;
  reporter_.error("wrong-block", decl.count_syntax->span, "the number of lights is no field of a frame block",
                  std::string(kHelp));
}

/// A block is known by its type and its own name; in the texts an array of it has an `s` behind both.
void Checker::blockName(const BlockDecl& decl) {
  if (decl.type_name == "Material" || decl.instance == "material") {
    reporter_.error("duplicate-name", decl.span, "the block of the material's numbers is called so",
                    "give this one another name");
  }
  for (const BlockDecl* other : blocks_) {
    if (other->role == BlockRole::Lights && decl.role == BlockRole::Lights) {
      reporter_.error("wrong-block", decl.span, "the template has lights already",
                      fmt::format("add fields to them: `extend block {} {{ ... }}`", other->instance));
    }
    const auto plural = [](const BlockDecl& block, std::string_view name) {
      const bool many = block.role == BlockRole::Lights || block.role == BlockRole::List;
      return std::string(name) + (many ? "s" : "");
    };
    if (other->type_name != decl.type_name &&
        plural(*other, other->type_name) != plural(decl, decl.type_name))
      continue;
    reporter_.error("duplicate-name", decl.span, fmt::format("there are two blocks '{}'", decl.type_name));
  }
}

void Checker::block(BlockDecl& decl, uint32_t& slots) {
  blockArray(decl);
  const size_t errors = reporter_.count();
  blockName(decl);
  if (reporter_.count() == errors && find(decl.instance) == nullptr) templateNames(decl);
  blocks_.push_back(&decl);
  Name instance{decl.instance, Name::Kind::Instance, Type::Float, slots, decl.span, true, true, {}};
  fields(decl, instance, slots);
  // What a list holds, the lights' loop alone reads.
  if (decl.role == BlockRole::List) instance.members.clear();
  declare(std::move(instance));
}

/// `lights from cluster[EXPR] through cluster_light;`
void Checker::lightLists(LightListsDecl& decl) {
  const auto list = [&](std::string_view name) -> const BlockDecl* {
    std::vector<std::string_view> known;
    for (const BlockDecl* block : blocks_) {
      if (block->role != BlockRole::List) continue;
      if (block->instance == name) return block;
      known.push_back(block->instance);
    }
    unknown(name, "list", std::move(known));
    return nullptr;
  };
  const auto has = [](const BlockDecl& block, std::string_view name) {
    return std::any_of(block.fields.begin(), block.fields.end(), [&](const BlockFieldDecl& field) {
      return field.name == name && field.type == Type::Int && field.array == 0;
    });
  };
  const BlockDecl* ranges = list(decl.ranges);
  if (ranges != nullptr && (!has(*ranges, "first") || !has(*ranges, "count"))) {
    reporter_.error("wrong-block", decl.ranges_span,
                    fmt::format("'{}' has no ints `first` and `count`", decl.ranges),
                    "they say where the lights' numbers begin, and how many there are");
  }
  const BlockDecl* numbers = list(decl.numbers);
  if (numbers != nullptr && !has(*numbers, "light")) {
    reporter_.error("wrong-block", decl.numbers_span, fmt::format("'{}' has no int `light`", decl.numbers),
                    "it is the number of a light");
  }
  typed(decl.index, Type::Float, "the number of the range");
  if (std::none_of(blocks_.begin(), blocks_.end(),
                   [](const BlockDecl* block) { return block->role == BlockRole::Lights; })) {
    reporter_.error("no-lights", decl.span, "the template has no lights",
                    "declare them before: `block lights Light light[16] count frame.light_count { ... }`");
  }
}

void Checker::extendedBlock(BlockDecl& decl, uint32_t& slots) {
  Name* base = find(decl.instance);
  const bool block = base != nullptr && base->kind == Name::Kind::Instance;
  if (!block || !base->inherited) {
    std::vector<std::string_view> candidates;
    for (const BlockDecl* other : blocks_) candidates.push_back(other->instance);
    if (block) {
      reporter_.error("wrong-block", decl.span,
                      fmt::format("'{}' is this template's own block", decl.instance),
                      "write its fields where it is declared");
    } else {
      unknown(decl.instance, "block", std::move(candidates));
    }
    return;
  }
  const auto extended = std::find_if(blocks_.begin(), blocks_.end(), [&](const BlockDecl* other) {
    return other->instance == decl.instance;
  });
  decl.role = (*extended)->role;
  decl.list = (*extended)->list;
  templateNames(decl);
  fields(decl, *base, slots);
  if (decl.role == BlockRole::List) base->members.clear();
}

void Checker::fields(BlockDecl& decl, Name& instance, uint32_t& slots) {
  for (BlockFieldDecl& field : decl.fields) {
    const bool whole = ir::isWhole(ir::partType(field.type));
    const bool good = ir::isFloating(field.type) || whole || field.type == Type::Mat4;
    if (!good) {
      reporter_.error("wrong-type", field.span, fmt::format("a field cannot be {}", aType(field.type)),
                      "fields are numbers, their vectors and mat4");
    }
    for (const Member& member : instance.members) {
      if (member.name != field.name) continue;
      reporter_.error("duplicate-name", field.span, fmt::format("there are two fields '{}'", field.name));
    }
    fieldArray(field);
    const bool listed = decl.list || decl.role == BlockRole::List;
    const bool held = ir::isFloating(field.type) || field.type == Type::Int;
    if (listed && good && (field.array != 0 || !held)) {
      reporter_.error("wrong-type", field.span,
                      "a list's elements hold floats, vectors of them and ints alone",
                      "write a matrix as its rows");
    }
    rangeOf(field);
    if (ir::isMatrix(field.type) && field.default_syntax)
      reporter_.error("wrong-type", field.span, fmt::format("{} has no default", aType(field.type)));
    else
      defaultOf(field);
    field.slot = slots;
    slots += field.elements();
    if (decl.role == BlockRole::Frame && field.type == Type::Int) frame_ints_.push_back(field.slot);
    instance.members.push_back({field.name, field.type, field.slot, field.array, &field});
  }
}

void Checker::fieldArray(BlockFieldDecl& field) {
  if (!field.array_syntax) return;
  const std::optional<int> count = constantInt(field.array_syntax, "the number of elements");
  if (count && (*count < 1 || *count > 256)) {
    reporter_.error("wrong-count", field.array_syntax->span,
                    fmt::format("a field cannot have {} elements", *count), "1 to 256 are possible");
  }
  field.array = count ? static_cast<uint32_t>(std::clamp(*count, 1, 256)) : 1;
  field.miscounted = !count || static_cast<uint32_t>(std::max(*count, 0)) != field.array;
  if (field.type == Type::Vec4 || field.type == Type::Mat4) return;
  reporter_.error("wrong-type", field.span, fmt::format("an array cannot be of {}", typeName(field.type)),
                  "GLSL and HLSL lay out arrays of vec4 and mat4 alone in one way");
}

void Checker::lightKind(LightKindDecl& decl, uint32_t first_property) {
  const auto lights = std::find_if(blocks_.begin(), blocks_.end(),
                                   [](const BlockDecl* block) { return block->role == BlockRole::Lights; });
  if (lights == blocks_.end()) {
    reporter_.error("no-lights", decl.span, "the template has no lights",
                    "declare them: `block lights Light light[16] count frame.light_count { ... }`");
    return;
  }
  const auto same = std::find_if(light_kinds_.begin(), light_kinds_.end(),
                                 [&](const LightKindDecl* other) { return other->name == decl.name; });
  if (decl.extends && same == light_kinds_.end()) {
    std::vector<std::string_view> candidates;
    for (const LightKindDecl* other : light_kinds_) candidates.push_back(other->name);
    unknown(decl.name, "kind", std::move(candidates));
  } else if (!decl.extends && same != light_kinds_.end()) {
    reporter_.error("duplicate-name", decl.span, fmt::format("there are two kinds of light '{}'", decl.name),
                    "to fill more fields of it, write `extend light kind`");
  }
  light_kinds_.push_back(&decl);
  const std::vector<Member> members = find((*lights)->instance)->members;
  // Only the properties of the light are in scope.
  std::vector<Name> outer = std::exchange(names_, {});
  for (const LightProperty& property : lightProperties()) {
    names_.push_back(
        {property.name, Name::Kind::Given, property.type, first_property++, decl.span, true, false, {}});
  }
  for (size_t i = 0; i < decl.fields.size(); ++i) {
    LightFieldDecl& field = decl.fields[i];
    const auto member =
        std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.name == field.name; });
    const auto named = [&](const LightFieldDecl& other) { return other.name == field.name; };
    const bool twice =
        std::any_of(decl.fields.begin(), decl.fields.begin() + static_cast<std::ptrdiff_t>(i), named) ||
        std::any_of(light_kinds_.begin(), light_kinds_.end(), [&](const LightKindDecl* other) {
          return decl.extends && other != &decl && other->name == decl.name &&
                 std::any_of(other->fields.begin(), other->fields.end(), named);
        });
    if (twice) {
      reporter_.error("duplicate-name", field.span, fmt::format("'{}' is given twice", field.name));
    } else if (member == members.end() || member->array != 0) {
      std::vector<std::string_view> candidates;
      for (const Member& m : members) candidates.push_back(m.name);
      unknown(field.name, "field", std::move(candidates));
    } else if (typed(field.value, member->type, fmt::format("'{}'", field.name))) {
      if (!scratch_) scratch_.emplace();
      field.constant = evaluateConstant(*scratch_, *field.value);
      if (field.constant && member->field != nullptr)
        inRange(*member->field, *field.constant, field.value->span, "value-out-of-range",
                fmt::format("'{}'", field.name));
    }
  }
  names_ = std::move(outer);
}

/// Whether a value is of another type than the one it is to have; reports it.
bool Checker::unlike(const Param& param, const Expr& value, std::string_view what) {
  if (!ir::isTexture(param.type)) return false;
  reporter_.error("wrong-type", value.span, fmt::format("{} cannot be {}", what, aType(param.type)),
                  "everything but textures is possible");
  return true;
}

void Checker::given(GivenDecl& decl, uint32_t& slots) {
  Name name{decl.name, Name::Kind::Given, Type::Float, slots, decl.span, true, false, {}};
  Param& first = decl.results[0];
  decl.slot = slots;
  bool good = false;
  if (decl.has_type) {
    rangeOf(first);
    good = typed(decl.value, first.type, fmt::format("'{}'", decl.name));
    good = good && !unlike(first, *decl.value, "a given");
  } else if (expression(decl.value)) {
    makeFloat(*decl.value);
    const Expr& value = *decl.value;
    decl.multiple = value.kind == Expr::Kind::Call && value.node->results.size() > 1;
    first.type = value.type;
    good = decl.multiple || !unlike(first, value, "a given");
    if (value.kind == Expr::Kind::Call) {
      decl.results.clear();
      for (const Param& result : value.node->results) {
        Param& copy = decl.results.emplace_back();
        copy.type = result.type;
        copy.name = decl.multiple ? result.name : std::string_view{};
        copy.has_range = result.has_range;
        copy.range = result.range;
        copy.prose = result.prose;
        copy.span = decl.span;
        if (decl.multiple)
          name.members.push_back(
              {result.name, result.type, slots + static_cast<uint32_t>(name.members.size())});
      }
    }
  }
  slots += static_cast<uint32_t>(decl.results.size());
  name.multiple = decl.multiple;
  name.type = decl.results[0].type;
  name.broken = !good && !decl.has_type;
  declare(std::move(name));
}

void Checker::port(PortDecl& decl, uint32_t& slots) {
  Param& param = decl.param;
  rangeOf(param);
  if (ir::isTexture(param.type)) {
    reporter_.error("wrong-type", param.span, fmt::format("a port cannot be {}", aType(param.type)),
                    "ports are everything but textures");
  }
  const bool good = decl.default_value &&
                    typed(decl.default_value, param.type, fmt::format("the default of '{}'", param.name));
  if (good && param.has_range && isConstant(*decl.default_value)) {
    if (!scratch_) scratch_.emplace();
    if (const Constant value = evaluateConstant(*scratch_, *decl.default_value))
      inRange(param, *value, decl.default_value->span, "default-out-of-range", "the default");
  }
  decl.slot = slots++;
  declare({param.name, Name::Kind::Port, param.type, decl.slot, param.span, true, false, {}});
}

void Checker::output(OutputDecl& decl) {
  templateNames(decl);
  const Type type = decl.type;
  const auto must = [&](std::string_view be) {
    reporter_.error("wrong-type", decl.span,
                    fmt::format("'{}' is {} and must be {}", decl.name, aType(type), be));
  };
  switch (decl.role) {
    case OutputRole::Position:
      if (type != Type::Vec4) return must(aType(Type::Vec4));
      break;
    case OutputRole::Color:
      if (!ir::isFloating(type) && !ir::isWhole(type))
        return must("a float, a vec2, a vec3, a vec4, an int or a uint");
      break;
    case OutputRole::Discard:
      if (type != Type::Bool) return must(aType(Type::Bool));
      break;
    case OutputRole::Depth:
      if (type != Type::Float) return must(aType(Type::Float));
      break;
    case OutputRole::Displacement: {
      const Name* of = find(decl.name);
      if (of == nullptr || of->kind != Name::Kind::Given || of->multiple) {
        reporter_.error("unknown-value", decl.span, fmt::format("there is no given '{}' to move", decl.name),
                        "a displacement has the name of the given that it is of, such as object_position");
        return;
      }
      if (type != of->type) return must(fmt::format("{}, as the given is", aType(of->type)));
      break;
    }
  }
  ports_allowed_ = true;
  typed(decl.value, decl.type, fmt::format("'{}'", decl.name));
  ports_allowed_ = false;
}

}  // namespace lacquer::lang
