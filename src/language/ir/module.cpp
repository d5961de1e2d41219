#include "ir/module.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>

#include "ir/loops.h"

namespace lacquer::ir {

std::string BlockField::elementName(uint32_t index) const {
  return array == 0 ? name : fmt::format("{}[{}]", name, index);
}

uint32_t layout(std::vector<BlockField>& fields) {
  uint32_t offset = 0;
  for (BlockField& field : fields) {
    const uint32_t alignment = field.stride() >= 12 ? 16 : field.stride();
    offset = (offset + alignment - 1) / alignment * alignment;
    field.offset = offset;
    offset += field.stride() * field.elements();
    assert(field.offset / 16 == (offset - 1) / 16 || isMatrix(field.type) || field.array != 0);
  }
  return (offset + 15) / 16 * 16;
}

uint32_t listLayout(std::vector<BlockField>& fields) {
  const uint32_t size = layout(fields);
  const bool numbers = std::all_of(fields.begin(), fields.end(),
                                   [](const BlockField& field) { return componentCount(field.type) == 1; });
  return numbers ? static_cast<uint32_t>(4 * fields.size()) : size;
}

std::optional<uint32_t> blockOf(const Module& module, ValueId id) {
  const Value& value = module.dag[id];
  if (value.op == Op::Element) return ListField::of(value).block;
  if (value.op == Op::SumOverLights && module.light_groups[value.payload].count == LightGroup::kCounted)
    return module.light_count.block;
  if (value.op != Op::Input) return {};
  const Input& input = module.dag.inputOf(id);
  return input.kind == InputKind::BlockField ? std::optional(input.block) : std::nullopt;
}

std::vector<ValueId> reachable(const Module& module, Stage stage) {
  std::vector<ValueId> roots;
  for (const Output& output : module.outputs) {
    if (output.stage == stage) roots.push_back(output.value);
  }
  return reachable(module.dag, roots);
}

std::vector<bool> ofPositions(const Module& module, Stage stage) {
  std::vector<ValueId> roots;
  for (const Output& output : module.outputs) {
    if (output.stage == stage && output.kind == OutputKind::Position) roots.push_back(output.value);
  }
  std::vector<bool> made_of(module.dag.size(), false);
  for (const ValueId id : reachable(module.dag, roots)) made_of[id] = true;
  return made_of;
}

namespace {

template <class Module, class Visit>
void visitIds(Module& module, const Visit& visit) {
  for (auto& output : module.outputs) visit(output.value);
  for (auto& varying : module.varyings) {
    if (varying.source != kNoValue) visit(varying.source);
  }
  for (auto& field : module.preshader) visit(field.value);
}

}  // namespace

std::vector<ValueId> roots(const Module& module) {
  std::vector<ValueId> ids;
  ids.reserve(module.outputs.size() + module.varyings.size() + module.preshader.size());
  visitIds(module, [&](ValueId id) { ids.push_back(id); });
  return ids;
}

void remap(Module& module, std::span<const ValueId> to) {
  visitIds(module, [&](ValueId& id) { id = to[id]; });
}

void compact(Module& module) { remap(module, module.dag.compact(roots(module))); }

std::vector<uint32_t> usedParameters(const Module& module) {
  std::vector<ValueId> roots;
  for (const Output& output : module.outputs) roots.push_back(output.value);
  for (const PreshaderField& field : module.preshader) roots.push_back(field.value);
  std::map<std::string_view, uint32_t> used;
  for (const ValueId id : reachable(module.dag, roots)) {
    if (module.dag[id].op != Op::Input) continue;
    const Input& input = module.dag.inputOf(id);
    if (input.kind != InputKind::Parameter && input.kind != InputKind::SpecConstant) continue;
    used.emplace(module.parameters[input.field].name, input.field);
  }
  std::vector<uint32_t> indices;
  for (const auto& [name, index] : used) indices.push_back(index);
  return indices;
}

namespace {

class Verifier {
public:
  explicit Verifier(const Module& module) : module_(module), dag_(module.dag) {}

  std::vector<std::string> run() {
    // What a rewrite left behind is nobody's business.
    for (const Output& output : module_.outputs) {
      if (output.value >= dag_.size()) return {fmt::format("output {} has no value", output.name)};
    }
    const std::vector<ValueId> live = reachable(dag_, roots(module_));
    for (const ValueId id : live) checkValue(id);
    if (dag_.hasLoops() && wrong_.empty()) checkLoops(live);
    for (const Output& output : module_.outputs) checkOutput(output);
    for (const Varying& varying : module_.varyings) {
      // Without a vertex stage the varyings come from outside.
      if (varying.source == kNoValue) continue;
      if (varying.source >= dag_.size() || dag_[varying.source].rate > Rate::Vertex) {
        complain("varying {} is not computed at vertex rate", varying.name);
      }
    }
    for (const PreshaderField& field : module_.preshader) {
      if (field.value >= dag_.size() || dag_[field.value].rate > Rate::Material) {
        complain("preshader field {} is not of material rate", field.field);
      }
    }
    return std::move(wrong_);
  }

private:
  template <class... Args>
  void complain(fmt::format_string<Args...> text, Args&&... args) {
    wrong_.push_back(fmt::format(text, std::forward<Args>(args)...));
  }

  void checkValue(ValueId id) {
    const Value& value = dag_[id];
    for (const ValueId operand : value.operands()) {
      if (operand >= id) return complain("value {} uses {}, which is not made before it", id, operand);
    }
    if (value.op == Op::Input) return checkInput(id);
    if (value.op == Op::Constant) return;
    if (value.op == Op::Swizzle) {
      for (int i = 0; i < componentCount(value.type); ++i) {
        if (swizzleComponent(value.payload, i) >= componentCount(dag_[value.args[0]].type)) {
          complain("value {} picks a component that is not there", id);
        }
      }
      return;
    }
    if (value.op == Op::Construct) {
      int width = 0;
      for (const ValueId operand : value.operands()) width += componentCount(dag_[operand].type);
      const bool splat = value.count == 1 && width == 1;
      if (!splat && width != componentCount(value.type))
        complain("value {} is built from {} parts", id, width);
      return;
    }
    if (value.op == Op::Element) return checkElement(id);
    if (makesLoop(value.op) && !checkLink(id)) return;
    if (value.op == Op::Carried) return checkCarried(id);
    std::array<Type, 4> types{};
    for (size_t i = 0; i < value.count; ++i) types[i] = dag_[value.args[i]].type;
    if (resultType(value.op, {types.data(), value.count}) != value.type) {
      complain("value {} ({}) has operands that do not fit", id, info(value.op).name);
    }
    if (value.op == Op::SumOverLights && value.payload >= module_.light_groups.size()) {
      complain("value {} sums over light group {}, which is not there", id, value.payload);
    }
  }

  void checkElement(ValueId id) {
    const auto [block, field] = ListField::of(dag_[id]);
    const bool there = block < module_.blocks.size() && module_.blocks[block].list &&
                       field < module_.blocks[block].fields.size() &&
                       module_.blocks[block].fields[field].type == dag_[id].type;
    const bool array = there && module_.blocks[block].fields[field].array != 0;
    const bool indexed = dag_[id].count == 2 && dag_.isConstant(dag_[id].args[1]);
    if (!there || dag_[dag_[id].args[0]].type != Type::Int || (dag_[id].count != 1 && !indexed) ||
        array != indexed)
      complain("value {} reads a list's field that is not there", id);
  }

  bool inputOfLoop(ValueId id, InputKind kind) const {
    return dag_[id].op == Op::Input && dag_.inputOf(id).kind == kind;
  }

  /// A loop with an index, or one value more for it.
  bool checkLink(ValueId id) {
    const Value& value = dag_[id];
    const bool carry = value.op == Op::Carry;
    bool good = inputOfLoop(value.args[carry ? 3 : 1], carry ? InputKind::LoopValue : InputKind::LoopIndex);
    if (carry) good &= makesLoop(dag_[value.args[0]].op);
    if (!good) complain("value {} is no link of a loop", id);
    return good;
  }

  void checkCarried(ValueId id) {
    const Value& value = dag_[id];
    bool found = false;
    if (makesLoop(dag_[value.args[0]].op)) {
      for (const Carry& carry : loopOf(dag_, value.args[0]).carries) {
        found |= dag_.inputOf(carry.value).index == value.payload && dag_[carry.value].type == value.type;
      }
    }
    if (!found) complain("value {} is carried by no loop", id);
  }

  void checkLoops(std::span<const ValueId> live) {
    const Loops loops(dag_, live);
    if (loops.broken()) complain("loops overlap, or their inputs are used outside of them");
    for (const Loop& loop : loops.all()) {
      if (loop.last == kNoValue) continue;
      const Input& index = dag_.inputOf(loop.index);
      if (!(index.range.lo <= index.range.hi) || mostRounds(dag_, loop) > kMostRounds)
        complain("the loop over {} has {} rounds", index.name, mostRounds(dag_, loop));
      std::vector<bool> taken;
      for (const Carry& carry : loop.carries) {
        const Input& value = dag_.inputOf(carry.value);
        if (taken.size() <= value.index) taken.resize(value.index + 1, false);
        if (value.field != index.field || taken[value.index])
          complain("the loop over {} carries '{}' twice, or another's", index.name, value.name);
        taken[value.index] = true;
      }
    }
    for (const ValueId id : live) {
      const Value& value = dag_[id];
      if (loops.of(id) >= 0 && (value.op == Op::SumOverLights || value.op == Op::Interpolate))
        complain("value {} is a {} in a loop's body", id, info(value.op).name);
      if (value.op == Op::Carried && loops[loops.indexOf(id)].last != value.args[0])
        complain("value {} is what a part of a loop carries", id);
    }
    for (const ValueId root : roots(module_)) {
      if (loops.of(root) >= 0) complain("value {} of a loop's body leaves it", root);
    }
  }

  void checkInput(ValueId id) {
    const Input& input = dag_.inputOf(id);
    if (input.kind == InputKind::BlockField &&
        (input.block >= module_.blocks.size() || input.field >= module_.blocks[input.block].fields.size() ||
         module_.blocks[input.block].fields[input.field].type != input.type)) {
      complain("input {} names a block field that is not there", input.name);
    }
    if (input.kind == InputKind::Texture && input.field >= module_.textures.size()) {
      complain("input {} names a texture that is not there", input.name);
    }
    if (input.kind == InputKind::Varying && input.field >= module_.varyings.size()) {
      complain("input {} names a varying that is not there", input.name);
    }
    if (input.kind == InputKind::SpecConstant &&
        (input.field >= module_.parameters.size() || module_.parameters[input.field].type != input.type ||
         module_.parameters[input.field].constant_id < 0)) {
      complain("input {} names a specialization constant that is not there", input.name);
    }
  }

  void checkOutput(const Output& output) {
    const Value& value = dag_[output.value];
    if (output.kind == OutputKind::Position && value.type != Type::Vec4)
      complain("output {} is not a vec4", output.name);
    if (output.kind == OutputKind::Color && !isFloating(value.type) && !isWhole(value.type))
      complain("output {} is no number and no vector of floats", output.name);
    if (output.kind == OutputKind::Depth && value.type != Type::Float)
      complain("output {} is not a float", output.name);
    if (output.kind == OutputKind::Discard && value.type != Type::Bool) {
      complain("output {} is not a bool", output.name);
    }
    if (value.rate == Rate::Light)
      complain("output {} has light rate: a sum_over_lights is missing", output.name);
    if (output.stage == Stage::Vertex && value.rate > Rate::Vertex) {
      complain("output {} of the vertex stage has {} rate", output.name, rateName(value.rate));
    }
  }

  /// Of a loop: the limit of the node language (lang/check_body.cpp), so that a slip shows.
  static constexpr uint32_t kMostRounds = 1024;

  const Module& module_;
  const Dag& dag_;
  std::vector<std::string> wrong_;
};

/// Values are numbered densely, so that a dump does not depend on what else the DAG ever held.
using Numbers = std::vector<uint32_t>;

template <class... Parts>
void append(std::string& text, const Parts&... parts) {
  (text.append(std::string_view(parts)), ...);
}

void appendNumber(std::string& text, double x) { fmt::format_to(std::back_inserter(text), "{}", x); }
void appendNumber(std::string& text, uint32_t x) {
  append(text, std::string_view(fmt::format_int(x).c_str()));
}

void spell(const Module& module, const Numbers& numbers, ValueId id, std::string& text) {
  const Dag& dag = module.dag;
  const Value& value = dag[id];
  if (value.op == Op::Constant) {
    const Components& c = dag.constantOf(id);
    if (value.type == Type::Bool) return append(text, c[0] != 0 ? "true" : "false");
    const bool several = componentCount(value.type) > 1;
    if (several) text += '(';
    for (int i = 0; i < componentCount(value.type); ++i) {
      if (i > 0) append(text, ", ");
      const double x = c[static_cast<size_t>(i)];
      appendNumber(text, partType(value.type) == Type::UInt && x < 0 ? x + 0x1p32 : x);
    }
    if (several) text += ')';
    return;
  }
  if (value.op == Op::Input) {
    const Input& input = dag.inputOf(id);
    append(text, input.name);
    if (ofLoop(input.kind)) append(text, "#", fmt::format_int(numbers[id]).c_str());
    if (input.element >= 0) append(text, "[", fmt::format_int(input.element).c_str(), "]");
    return;
  }
  append(text, info(value.op).name);
  if (value.op == Op::Swizzle) {
    text += '.';
    for (int i = 0; i < componentCount(value.type); ++i) text += "xyzw"[swizzleComponent(value.payload, i)];
  }
  if (value.op == Op::Column || value.op == Op::Carried || value.op == Op::TextureSize)
    append(text, "[", fmt::format_int(value.payload).c_str(), "]");
  if (value.op == Op::SumOverLights) append(text, "[", fmt::format_int(value.payload).c_str(), "]");
  if (value.op == Op::Element) {
    const Block& block = module.blocks[ListField::of(value).block];
    append(text, " ", block.instance, ".", block.fields[ListField::of(value).field].name);
  }
  for (const ValueId operand : value.operands()) {
    const Value& o = dag[operand];
    text += ' ';
    if (o.op == Op::Constant || o.op == Op::Input) {
      spell(module, numbers, operand, text);
    } else {
      text += '%';
      appendNumber(text, numbers[operand]);
    }
  }
  if (value.op != Op::Loop) return;
  const Interval& rounds = dag.inputOf(value.args[1]).range;
  text += " in [";
  appendNumber(text, rounds.lo);
  append(text, ", ");
  appendNumber(text, rounds.hi);
  text += ']';
}

/// Fills a line that begins at `start` up to a column; names may have wide characters.
void pad(std::string& text, size_t start) {
  constexpr size_t kColumn = 44;
  const std::string_view line = std::string_view(text).substr(start);
  const bool ascii = std::all_of(line.begin(), line.end(), [](char c) { return (c & 0x80) == 0; });
  if (!ascii)
    text.replace(start, std::string::npos, fmt::format("{:<{}}", std::string(line), kColumn));
  else if (line.size() < kColumn)
    text.append(kColumn - line.size(), ' ');
}

}  // namespace

std::vector<std::string> verify(const Module& module) { return Verifier(module).run(); }

std::string dump(const Module& module) {
  const Dag& dag = module.dag;
  std::vector<ValueId> roots;
  for (const Output& output : module.outputs) roots.push_back(output.value);
  for (const PreshaderField& field : module.preshader) roots.push_back(field.value);
  std::string text;
  TermId term = ~TermId{0};
  Numbers numbers(dag.size(), 0);
  uint32_t next = 0;
  std::map<uint32_t, uint32_t> loops;  // by their numbers, those in the order in which they are met
  for (const ValueId id : reachable(dag, roots)) {
    const Value& value = dag[id];
    if (value.op == Op::Input && ofLoop(dag.inputOf(id).kind))
      numbers[id] =
          loops.try_emplace(dag.inputOf(id).field, static_cast<uint32_t>(loops.size())).first->second;
    if (value.op == Op::Constant || value.op == Op::Input) continue;
    numbers[id] = next++;
    if (dag.termOf(id) != term) {
      term = dag.termOf(id);
      const Term& t = dag.terms()[term];
      if (!t.name.empty()) append(text, "; ", t.name, t.source.empty() ? "" : ": ", t.source, "\n");
    }
    const std::string_view name = dag.nameOf(id);
    const size_t start = text.size();
    text += "  %";
    appendNumber(text, numbers[id]);
    append(text, " = ", typeName(value.type), " ");
    spell(module, numbers, id, text);
    pad(text, start);
    append(text, " ; ", rateName(value.rate), " ", name);
    if (dag.relaxed(id)) append(text, name.empty() ? "half" : " half");
    while (!text.empty() && text.back() == ' ') text.pop_back();
    text += '\n';
  }
  const auto refer = [&](ValueId id) {
    const bool leaf = dag[id].op == Op::Constant || dag[id].op == Op::Input;
    if (!leaf) return fmt::format("%{}", numbers[id]);
    std::string spelt;
    spell(module, numbers, id, spelt);
    return spelt;
  };
  for (const PreshaderField& field : module.preshader) {
    for (const Block& block : module.blocks) {
      if (block.role != BlockRole::Material) continue;
      const BlockField& f = block.fields[field.field];
      text +=
          fmt::format("preshader {} {} @{} = {}\n", typeName(f.type), f.name, f.offset, refer(field.value));
    }
  }
  for (const Output& output : module.outputs) {
    text += fmt::format("{} output {} = {}\n", output.stage == Stage::Vertex ? "vertex" : "fragment",
                        output.name, refer(output.value));
  }
  return text;
}

}  // namespace lacquer::ir
