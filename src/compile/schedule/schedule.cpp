#include "schedule/schedule.h"

#include <algorithm>
#include <cassert>
#include <map>

#include "ir/names.h"

namespace lacquer::schedule {

namespace {

/// An expression written in place has at most this many operations; beyond, a reader wants a name.
constexpr int kLargestInline = 7;

/// A set of small numbers.
class Indices {
public:
  void insert(uint32_t index) {
    if (has_.size() <= index) has_.resize(index + 1, false);
    has_[index] = true;
  }
  std::vector<uint32_t> ascending() const {
    std::vector<uint32_t> all;
    for (uint32_t i = 0; i < has_.size(); ++i) {
      if (has_[i]) all.push_back(i);
    }
    return all;
  }

private:
  std::vector<bool> has_;
};

class Scheduler {
public:
  Scheduler(const ir::Module& module, ir::Stage stage)
      : module_(module), dag_(module.dag), live_(ir::reachable(module, stage)) {
    program_.stage = stage;
    program_.names.resize(dag_.size());
    for (uint32_t i = 0; i < module_.outputs.size(); ++i) {
      if (module_.outputs[i].stage == stage) outputs_.push_back(i);
    }
  }

  /// Of the preshader.
  explicit Scheduler(const ir::Module& module) : module_(module), dag_(module.dag) {
    for (const ir::PreshaderField& field : module.preshader) fields_.push_back(field.value);
    live_ = ir::reachable(dag_, fields_);
    program_.stage = ir::Stage::Fragment;
    program_.names.resize(dag_.size());
  }

  /// `taken`: names that mean something already.
  Program runPreshader(std::span<const std::string> taken) {
    for (const std::string& name : taken) names_.take(name);
    countUses();
    for (const ir::ValueId field : fields_) ++uses_[field];
    chooseVariables();
    emitted_.assign(dag_.size(), false);
    emitValues(fields_);
    return std::move(program_);
  }

  Program run() {
    collectInterface();
    countUses();
    chooseVariables();
    order();
    return std::move(program_);
  }

private:
  bool leaf(ir::ValueId id) const { return dag_[id].op == ir::Op::Constant || dag_[id].op == ir::Op::Input; }
  bool inLoop(ir::ValueId id) const { return dag_[id].rate == ir::Rate::Light; }

  void collectInterface() {
    Indices blocks, textures, varyings, attributes, parameters;
    for (const ir::ValueId id : live_) {
      if (const std::optional<uint32_t> block = ir::blockOf(module_, id)) blocks.insert(*block);
      if (dag_[id].op != ir::Op::Input) continue;
      const ir::Input& input = dag_.inputOf(id);
      switch (input.kind) {
        case ir::InputKind::BlockField: break;
        case ir::InputKind::Texture: textures.insert(input.field); break;
        case ir::InputKind::Varying: varyings.insert(input.field); break;
        case ir::InputKind::Attribute: attributes.insert(input.field); break;
        case ir::InputKind::FrontFacing: program_.front_facing = true; break;
        case ir::InputKind::LightIndex: break;
        case ir::InputKind::SpecConstant: parameters.insert(input.field); break;
        case ir::InputKind::Parameter: assert(false && "place() runs before schedule()"); break;
      }
    }
    for (const uint32_t o : outputs_) {
      if (module_.outputs[o].kind == ir::OutputKind::Varying) varyings.insert(module_.outputs[o].location);
      if (module_.outputs[o].kind == ir::OutputKind::Color) program_.outputs.push_back(o);
    }
    program_.blocks = blocks.ascending();
    program_.textures = textures.ascending();
    program_.varyings = varyings.ascending();
    program_.attributes = attributes.ascending();
    program_.parameters = parameters.ascending();
    std::sort(program_.parameters.begin(), program_.parameters.end(), [&](uint32_t a, uint32_t b) {
      return module_.parameters[a].constant_id < module_.parameters[b].constant_id;
    });
  }

  void countUses() {
    uses_.assign(dag_.size(), 0);
    used_in_loop_.assign(dag_.size(), false);
    for (const ir::ValueId id : live_) {
      for (const ir::ValueId operand : dag_[id].operands()) {
        ++uses_[operand];
        if (inLoop(id)) used_in_loop_[operand] = true;
        if (dag_[id].op == ir::Op::SumOverLights) used_in_loop_[operand] = true;
      }
    }
    for (const uint32_t o : outputs_) {
      ++uses_[module_.outputs[o].value];
      discards_ |= module_.outputs[o].kind == ir::OutputKind::Discard;
    }
  }

  bool needsDerivatives(ir::ValueId id) const { return ir::takesDerivatives(dag_[id].op); }

  /// Reads as well written out every time: components of a leaf or of a variable, and negated leaves.
  bool trivial(ir::ValueId id) const {
    const ir::Value& value = dag_[id];
    if (leaf(id)) return true;
    if (value.op == ir::Op::Construct && value.count == 1)
      return trivial(value.args[0]) || variable_[value.args[0]];
    if (value.op != ir::Op::Swizzle && value.op != ir::Op::Neg) return false;
    const ir::ValueId operand = value.args[0];
    return leaf(operand) || (value.op == ir::Op::Swizzle && variable_[operand]);
  }

  void chooseVariables() {
    variable_.assign(dag_.size(), false);
    size_.assign(dag_.size(), 0);
    for (const ir::ValueId id : live_) {
      if (leaf(id)) continue;
      // What is compared and where, and a layer, are taken apart by some targets.
      const bool apart =
          ir::readsTexture(dag_[id].op) && (dag_[dag_[id].args[0]].type == ir::Type::Texture2DShadow ||
                                            dag_[dag_[id].args[0]].type == ir::Type::Texture2DArray);
      if (apart && !leaf(dag_[id].args[1])) makeVariable(dag_[id].args[1]);
      int size = 1;
      for (const ir::ValueId operand : dag_[id].operands()) size += variable_[operand] ? 0 : size_[operand];
      size_[id] = size;
      // A component of something large is taken from a variable, so that `(a + b * c).x` is never written.
      if (dag_[id].op == ir::Op::Swizzle && !leaf(dag_[id].args[0]) && !variable_[dag_[id].args[0]] &&
          !ir::readsTexture(dag_[dag_[id].args[0]].op)) {
        makeVariable(dag_[id].args[0]);
        size_[id] = 1;
      }
      if (wantsVariable(id)) makeVariable(id);
    }
  }

  void makeVariable(ir::ValueId id) {
    variable_[id] = true;
    size_[id] = 0;
  }

  bool wantsVariable(ir::ValueId id) const {
    const ir::Value& value = dag_[id];
    if (value.op == ir::Op::SumOverLights) return true;
    if (discards_ && needsDerivatives(id)) return true;
    if (trivial(id)) return false;
    if (uses_[id] > 1) return true;
    if (used_in_loop_[id] && !inLoop(id)) return true;
    if (!dag_.nameOf(id).empty() && value.op != ir::Op::Swizzle) return true;
    return size_[id] > kLargestInline;
  }

  // -- order --

  void order() {
    names_.take(ir::kLightIndexName);
    for (const ir::Block& block : module_.blocks) {
      for (const std::string& name : {block.name, block.instance}) {
        names_.take(name);
        names_.take(name + "s");
        names_.take(name + "Block");
      }
    }
    for (const ir::TextureSlot& slot : module_.textures) {
      names_.take(slot.name);
      names_.take(slot.name + "_sampler");
    }
    for (const uint32_t p : program_.parameters) names_.take(module_.parameters[p].constant_name);
    emitted_.assign(dag_.size(), false);
    const std::vector<ir::ValueId> early = discardRoots();
    const std::vector<ir::ValueId> needed = ir::reachable(dag_, early);
    const bool after_loops = std::any_of(
        needed.begin(), needed.end(), [&](ir::ValueId id) { return dag_[id].op == ir::Op::SumOverLights; });
    if (!after_loops) discard(early);
    for (const std::vector<ir::ValueId>& level : sumLevels()) {
      std::map<uint32_t, std::vector<ir::ValueId>> by_group;
      for (const ir::ValueId sum : level) by_group[dag_[sum].payload].push_back(sum);
      for (const auto& [group, sums] : by_group) loop(group, sums);
    }
    if (after_loops) discard(early);
    for (const uint32_t o : outputs_) {
      if (module_.outputs[o].kind != ir::OutputKind::Discard) outputs_left_.push_back(o);
    }
    std::vector<ir::ValueId> roots;
    for (const uint32_t o : outputs_left_) roots.push_back(module_.outputs[o].value);
    emitValues(roots);
    for (const uint32_t o : outputs_left_) {
      section(dag_.termOf(module_.outputs[o].value));
      program_.statements.push_back({StatementKind::Output, module_.outputs[o].value, 0, 0, o, {}});
    }
  }

  /// What must stand before the discards: their conditions, and all that needs derivatives, which are
  /// undefined after a discard.
  std::vector<ir::ValueId> discardRoots() const {
    std::vector<ir::ValueId> roots;
    for (const uint32_t o : outputs_) {
      if (module_.outputs[o].kind == ir::OutputKind::Discard) roots.push_back(module_.outputs[o].value);
    }
    if (roots.empty()) return roots;
    std::copy_if(live_.begin(), live_.end(), std::back_inserter(roots),
                 [&](ir::ValueId id) { return needsDerivatives(id) && !inLoop(id); });
    return roots;
  }

  /// A dropped fragment does no further work: the discards stand as early as they can.
  void discard(const std::vector<ir::ValueId>& roots) {
    emitValues(roots);
    for (const uint32_t o : outputs_) {
      const ir::Output& output = module_.outputs[o];
      if (output.kind != ir::OutputKind::Discard) continue;
      section(dag_.termOf(output.value));
      program_.statements.push_back({StatementKind::Discard, output.value, 0, 0, o, {}});
    }
  }

  /// Sums over lights, those first that need no other sum.
  std::vector<std::vector<ir::ValueId>> sumLevels() const {
    std::vector<size_t> level(dag_.size(), 0);
    std::vector<std::vector<ir::ValueId>> levels;
    for (const ir::ValueId id : live_) {
      for (const ir::ValueId operand : dag_[id].operands()) level[id] = std::max(level[id], level[operand]);
      if (dag_[id].op != ir::Op::SumOverLights) continue;
      if (levels.size() <= level[id]) levels.resize(level[id] + 1);
      levels[level[id]].push_back(id);
      ++level[id];
    }
    return levels;
  }

  void loop(uint32_t group, const std::vector<ir::ValueId>& sums) {
    std::vector<ir::ValueId> bodies;
    for (const ir::ValueId sum : sums) {
      const std::span<const ir::ValueId> operands = dag_[sum].operands();  // of listed lights the range, too
      bodies.insert(bodies.end(), operands.begin(), operands.end());
    }
    const std::vector<ir::ValueId> needed = ir::reachable(dag_, bodies);
    for (const ir::ValueId id : needed) {
      if (!inLoop(id)) emit(id);
    }
    for (const ir::ValueId sum : sums) {
      section(dag_.termOf(sum));
      program_.names[sum] = nameVariable(sum);
      emitted_[sum] = true;
    }
    program_.statements.push_back({StatementKind::LoopBegin, ir::kNoValue, 0, group, 0, sums});
    // The loop's first section is always printed: it stands in a block of its own.
    const ir::TermId outer = section_;
    section_ = dag_.termOf(sums[0]);
    for (const ir::ValueId id : needed) {
      if (inLoop(id)) emit(id);
    }
    for (const ir::ValueId sum : sums) {
      section(dag_.termOf(sum));
      program_.statements.push_back({StatementKind::Accumulate, sum, 0, group, 0, {}});
    }
    program_.statements.push_back({StatementKind::LoopEnd, ir::kNoValue, 0, group, 0, {}});
    section_ = outer;
  }

  void emitValues(const std::vector<ir::ValueId>& roots) {
    for (const ir::ValueId id : ir::reachable(dag_, roots)) {
      if (!inLoop(id)) emit(id);
    }
  }

  void emit(ir::ValueId id) {
    if (emitted_[id] || !variable_[id]) return;
    emitted_[id] = true;
    section(dag_.termOf(id));
    program_.names[id] = nameVariable(id);
    program_.statements.push_back({StatementKind::Let, id, 0, 0, 0, {}});
  }

  void section(ir::TermId term) {
    if (term == section_) return;
    section_ = term;
    if (dag_.terms()[term].name.empty()) return;
    program_.statements.push_back({StatementKind::Section, ir::kNoValue, term, 0, 0, {}});
  }

  std::string nameVariable(ir::ValueId id) {
    const std::string& term = dag_.terms()[dag_.termOf(id)].name;
    const std::string_view layer = ir::layerOf(term);
    if (const std::string_view name = dag_.nameOf(id); !name.empty()) return names_.pick(name, layer);
    const ir::Value& value = dag_[id];
    if (value.op == ir::Op::SumOverLights) return names_.pick("light_sum");
    if (value.op == ir::Op::Element) {
      const auto [block, field] = ir::ListField::of(value);
      return names_.pick(module_.blocks[block].fields[field].name, layer);
    }
    if (value.op == ir::Op::Mul && value.args[0] == value.args[1]) {
      std::string_view root = program_.names[value.args[0]];
      if (root.empty()) root = dag_.nameOf(value.args[0]);
      if (!root.empty()) return names_.pick(std::string(root) + "2", layer);
    }
    // A term's results have names: what has none is on the way to one.
    const size_t dot = term.rfind('.');
    if (dot != std::string::npos) return names_.pick(term.substr(dot + 1) + "_part", layer);
    if (!term.empty()) return names_.pick(term + "_part");
    return names_.pick(ir::info(value.op).name);
  }

  const ir::Module& module_;
  const ir::Dag& dag_;
  std::vector<ir::ValueId> live_;
  std::vector<ir::ValueId> fields_;  ///< of the preshader
  std::vector<uint32_t> outputs_, outputs_left_;
  std::vector<int> uses_, size_;
  std::vector<bool> used_in_loop_, variable_, emitted_;
  ir::Names names_;
  bool discards_ = false;
  ir::TermId section_ = 0;
  Program program_;
};

}  // namespace

Program schedule(const ir::Module& module, ir::Stage stage) { return Scheduler(module, stage).run(); }

Program schedulePreshader(const ir::Module& module, std::span<const std::string> taken) {
  return Scheduler(module).runPreshader(taken);
}

}  // namespace lacquer::schedule
