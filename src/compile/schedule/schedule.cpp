#include "schedule/schedule.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>

#include "ir/loops.h"
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
    all.reserve(has_.size());
    for (uint32_t i = 0; i < has_.size(); ++i) {
      if (has_[i]) all.push_back(i);
    }
    return all;
  }

private:
  std::vector<uint8_t> has_;
};

class Scheduler {
public:
  Scheduler(const ir::Module& module, ir::Stage stage)
      : module_(module), dag_(module.dag), live_(ir::reachable(module, stage)), loops_(dag_, live_) {
    program_.stage = stage;
    program_.statements.reserve(live_.size());
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
    program_.live = std::move(live_);
    return std::move(program_);
  }

  Program run() {
    collectInterface();
    countUses();
    chooseVariables();
    order();
    program_.live = std::move(live_);
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
        case ir::InputKind::LightIndex:
        case ir::InputKind::LoopIndex:
        case ir::InputKind::LoopValue: break;
        case ir::InputKind::SpecConstant: parameters.insert(input.field); break;
        case ir::InputKind::Parameter: assert(false && "place() runs before schedule()"); break;
      }
    }
    for (const uint32_t o : outputs_) {
      if (module_.outputs[o].kind == ir::OutputKind::Varying) varyings.insert(module_.outputs[o].location);
      const ir::OutputKind kind = module_.outputs[o].kind;
      if (kind == ir::OutputKind::Color || kind == ir::OutputKind::Depth) program_.outputs.push_back(o);
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
    used_deeper_.assign(dag_.size(), false);
    is_carried_.assign(dag_.size(), false);
    for (const ir::ValueId id : live_) {
      const ir::Value& value = dag_[id];
      const bool light = inLoop(id) || value.op == ir::Op::SumOverLights;
      for (size_t k = 0; k < value.count; ++k) {
        const ir::ValueId operand = value.args[k];
        ++uses_[operand];
        // The next value is asked for in every round.
        const bool carry = value.op == ir::Op::Carry;
        const bool next = carry && k == 2;
        const int32_t loop = next ? loops_.indexOf(id) : loops_.of(id);
        if ((light && !inLoop(operand)) || (loop != loops_.of(operand) && !ir::makesLoop(dag_[operand].op)))
          used_deeper_[operand] = true;
        if (next || (carry && k == 1)) is_carried_[operand] = true;
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
      if (ir::makesLoop(dag_[id].op)) {
        const ir::ValueId end = dag_[id].args[0];
        if (dag_[id].op == ir::Op::Loop && !leaf(end)) makeVariable(end);
        continue;
      }
      if (dag_[id].op == ir::Op::Carried) {
        makeVariable(id);
        continue;
      }
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
      // Texts compute these operands only where they are needed, and derivatives need the neighbours, too.
      if (ir::leavesOut(dag_[id].op)) {
        for (size_t k = 1; k < dag_[id].count; ++k) takeOutDerivatives(dag_[id].args[k]);
      }
      if (wantsVariable(id)) makeVariable(id);
    }
  }

  /// Of an expression that would be written out; it is small.
  void takeOutDerivatives(ir::ValueId id) {
    if (leaf(id) || variable_[id]) return;
    if (needsDerivatives(id)) return makeVariable(id);
    for (const ir::ValueId operand : dag_[id].operands()) takeOutDerivatives(operand);
  }

  void makeVariable(ir::ValueId id) {
    variable_[id] = true;
    size_[id] = 0;
  }

  bool wantsVariable(ir::ValueId id) const {
    const ir::Value& value = dag_[id];
    // Languages have no variables of textures, HLSL none of its blocks' matrices.
    if (value.op == ir::Op::TextureAt || (value.op == ir::Op::Element && ir::isMatrix(value.type)))
      return false;
    if (value.op == ir::Op::SumOverLights) return true;
    if (discards_ && needsDerivatives(id)) return true;
    if (trivial(id)) return false;
    if (uses_[id] > 1) return true;
    if (used_deeper_[id]) return true;
    // What a loop's variable gets needs none of its own.
    if (is_carried_[id]) return false;
    if (!dag_.nameOf(id).empty() && value.op != ir::Op::Swizzle) return true;
    return size_[id] > kLargestInline;
  }

  // -- order --

  void order() {
    names_.take(ir::kLightIndexName);
    std::string longer;
    const auto take = [&](std::string_view name, std::initializer_list<std::string_view> endings) {
      for (const std::string_view ending : endings) names_.take(longer.assign(name).append(ending));
    };
    for (const ir::Block& block : module_.blocks) {
      take(block.name, {"", "s", "Block"});
      take(block.instance, {"", "s", "Block"});
    }
    for (const ir::TextureSlot& slot : module_.textures) {
      take(slot.array.empty() ? slot.boundName() : slot.array, {"", "_sampler"});
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
    std::vector<uint8_t> whole(loops_.all().size(), false);
    for (const ir::ValueId id : live_) {
      if (!needsDerivatives(id) || inLoop(id)) continue;
      // Of a loop all, with those around it.
      int32_t loop = loops_.of(id);
      if (loop < 0) roots.push_back(id);
      for (; loop >= 0; loop = loops_[loop].around) whole[static_cast<size_t>(loop)] = true;
    }
    for (const ir::ValueId id : live_) {
      if (dag_[id].op != ir::Op::Carried || loops_.of(id) >= 0) continue;
      if (whole[static_cast<size_t>(loops_.indexOf(id))]) roots.push_back(id);
    }
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
    emitIn(needed, false, -1);
    for (const ir::ValueId sum : sums) {
      section(dag_.termOf(sum));
      program_.names[sum] = nameVariable(sum);
      emitted_[sum] = true;
    }
    program_.statements.push_back({StatementKind::LoopBegin, ir::kNoValue, 0, group, 0, sums});
    // The loop's first section is always printed: it stands in a block of its own.
    const ir::TermId outer = section_;
    section_ = dag_.termOf(sums[0]);
    emitIn(needed, true, -1);
    for (const ir::ValueId sum : sums) {
      section(dag_.termOf(sum));
      program_.statements.push_back({StatementKind::Accumulate, sum, 0, group, 0, {}});
    }
    program_.statements.push_back({StatementKind::LoopEnd, ir::kNoValue, 0, group, 0, {}});
    section_ = outer;
    // Another loop over lights that needs the same computes it again.
    for (const ir::ValueId id : live_) {
      if (inLoop(id)) emitted_[id] = false;
    }
  }

  /// A loop: its variables, what a round computes, and what it leaves to the next one.
  void rounds(int32_t loop) {
    const ir::Loop& of = loops_[loop];
    for (const ir::Carry& carry : of.carries) nameInput(carry.value, of.last);
    nameInput(of.index, of.last);
    for (const ir::ValueId id : live_) {
      if (dag_[id].op != ir::Op::Carried || loops_.indexOf(id) != loop) continue;
      const auto carry = std::find_if(of.carries.begin(), of.carries.end(), [&](const ir::Carry& c) {
        return dag_.inputOf(c.value).index == dag_[id].payload;
      });
      program_.names[id] = program_.names[carry->value];
      emitted_[id] = true;
    }
    section(dag_.termOf(of.last));
    const std::vector<Statement> nexts = nextsOf(of, loop);
    program_.statements.push_back({StatementKind::RoundsBegin, of.last, 0, 0, 0, {}});
    const ir::TermId outer = section_;
    emitIn(loops_.bodyOf(loop), inLoop(of.last), loop);
    section(dag_.termOf(of.last));
    program_.statements.insert(program_.statements.end(), nexts.begin(), nexts.end());
    program_.statements.push_back({StatementKind::RoundsEnd, of.last, 0, 0, 0, {}});
    section_ = outer;
  }

  void nameInput(ir::ValueId id, ir::ValueId chain) {
    if (!program_.names[id].empty()) return;
    const std::string_view layer = ir::layerOf(dag_.terms()[dag_.termOf(chain)].name);
    program_.names[id] = names_.pick(dag_.inputOf(id).name, layer);
  }

  /// Which carried values of a loop an expression reads where it stands.
  void reads(ir::ValueId id, int32_t loop, std::vector<ir::ValueId>& found) const {
    if (dag_[id].op == ir::Op::Input) {
      if (loops_.of(id) == loop && dag_.inputOf(id).kind == ir::InputKind::LoopValue) found.push_back(id);
      return;
    }
    if (variable_[id]) return;
    for (const ir::ValueId operand : dag_[id].operands()) reads(operand, loop, found);
  }

  /// All next values are made of what the round began with: a variable changes when no other next value reads
  /// it any more. Where each waits for another, some are computed, or held, before.
  std::vector<Statement> nextsOf(const ir::Loop& loop, int32_t number) {
    struct Waiting {
      const ir::Carry* carry;
      std::vector<ir::ValueId> reads;
    };
    std::vector<Waiting> waiting;
    std::vector<Statement> holds, nexts;
    for (const ir::Carry& carry : loop.carries) {
      waiting.push_back({&carry, {}});
      reads(carry.next, number, waiting.back().reads);
    }
    const auto readBy = [](const Waiting& other, ir::ValueId value) {
      return other.carry->value != value &&
             std::find(other.reads.begin(), other.reads.end(), value) != other.reads.end();
    };
    std::map<ir::ValueId, std::string> held;
    while (!waiting.empty()) {
      const auto free = std::find_if(waiting.begin(), waiting.end(), [&](const Waiting& one) {
        return std::none_of(waiting.begin(), waiting.end(),
                            [&](const Waiting& other) { return readBy(other, one.carry->value); });
      });
      if (free != waiting.end()) {
        const ir::Carry& carry = *free->carry;
        const auto name = held.find(carry.next);
        const bool from_held = name != held.end() && carry.next != carry.value;
        nexts.push_back({StatementKind::Next,
                         carry.value,
                         0,
                         0,
                         0,
                         {},
                         carry.next,
                         from_held ? name->second : std::string()});
        waiting.erase(free);
        continue;
      }
      const ir::ValueId first = waiting.front().carry->value;
      for (Waiting& other : waiting) {
        if (!readBy(other, first)) continue;
        other.reads.clear();
        if (other.carry->next != first) {
          makeVariable(other.carry->next);
        } else if (const auto [it, fresh] = held.try_emplace(first); fresh) {
          it->second = names_.pick(program_.names[first] + "_before");
          holds.push_back({StatementKind::Hold, first, 0, 0, 0, {}, ir::kNoValue, it->second});
        }
      }
    }
    holds.insert(holds.end(), nexts.begin(), nexts.end());
    return holds;
  }

  /// Of these values, those of one place: inside of the loop over lights or not, and of a loop or none.
  void emitIn(const std::vector<ir::ValueId>& ids, bool light, int32_t loop) {
    for (const ir::ValueId id : ids) {
      if (inLoop(id) == light && loops_.of(id) == loop) emit(id);
    }
  }

  void emitValues(const std::vector<ir::ValueId>& roots) { emitIn(ir::reachable(dag_, roots), false, -1); }

  void emit(ir::ValueId id) {
    if (emitted_[id] || !variable_[id]) return;
    if (dag_[id].op == ir::Op::Carried) return rounds(loops_.indexOf(id));
    emitted_[id] = true;
    section(dag_.termOf(id));
    if (program_.names[id].empty()) program_.names[id] = nameVariable(id);
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
  ir::Loops loops_;                  ///< of a stage
  std::vector<ir::ValueId> fields_;  ///< of the preshader
  std::vector<uint32_t> outputs_, outputs_left_;
  std::vector<int> uses_, size_;
  std::vector<uint8_t> used_deeper_;  ///< in a loop in which it is not computed
  std::vector<uint8_t> is_carried_;   ///< into the first round of a loop, or the next one
  std::vector<uint8_t> variable_, emitted_;
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
