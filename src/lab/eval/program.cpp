#include "eval/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <numeric>
#include <string>
#include <unordered_map>
#include <vector>

#include "ir/fold.h"
#include "ir/loops.h"

namespace lacquer::eval {

namespace {

using ir::Op;
using ir::Rate;
using ir::ValueId;

/// A cube map's direction is no shorter, where a level follows from it.
constexpr double kLeastDirection = 1e-30;

/// What is known of a register while compiling: it is written once, or it is a sum's.
struct Virtual {
  bool uniform = false;
};

/// Names in the order in which they were first asked for.
class Numbered {
public:
  explicit Numbered(std::vector<std::string>& names) : names_(names) {}
  uint32_t of(const std::string& name) {
    const auto [it, fresh] = numbers_.try_emplace(name, static_cast<uint32_t>(names_.size()));
    if (fresh) names_.push_back(name);
    return it->second;
  }

private:
  std::vector<std::string>& names_;
  std::unordered_map<std::string, uint32_t> numbers_;  // looked up, never walked
};

class Compiler {
public:
  Compiler(const ir::Module& module, const Bindings& bindings, size_t points)
      : module_(module),
        dag_(module.dag),
        bindings_(bindings),
        points_(points),
        registers_of_(module.dag.size()) {}

  Result<Program> run(std::span<const ValueId> roots) {
    program_.light_groups = module_.light_groups;
    const std::vector<ValueId> live = ir::reachable(dag_, roots);
    loops_ = ir::Loops(dag_, live);
    values(live, false, -1);
    if (!wrong_.empty()) return tl::make_unexpected(std::move(wrong_));
    for (const ValueId root : roots) {
      program_.results.push_back(registers_of_[root]);
      program_.types.push_back(ir::partType(dag_[root].type));
    }
    return std::move(program_);
  }

  const std::vector<Virtual>& virtuals() const { return virtuals_; }

private:
  Register fresh(bool uniform) {
    virtuals_.push_back({uniform});
    return static_cast<Register>(virtuals_.size() - 1);
  }

  /// Appends an instruction with one result; it belongs to the uniform part when nothing in it varies.
  Register emit(Instruction instruction, bool uniform) {
    const Register out = fresh(uniform);
    instruction.outs[0] = out;
    (uniform ? program_.uniform : program_.body).push_back(instruction);
    return out;
  }

  Register map(Op op, std::span<const Register> args) {
    const bool uniform =
        std::all_of(args.begin(), args.end(), [&](Register r) { return virtuals_[r].uniform; });
    Instruction instruction{Step::Map, op};
    std::copy(args.begin(), args.end(), instruction.args.begin());
    instruction.half = half_;
    instruction.whole = whole_;
    instruction.fuses = fuses_ && (op == Op::Add || op == Op::Sub);
    return emit(instruction, uniform);
  }
  Register map(Op op, Register a, Register b) { return map(op, std::array{a, b}); }

  Register literal(double x) {
    program_.literals.push_back(x);
    Instruction instruction{Step::Literal, Op::Constant, 0, -1,
                            static_cast<uint32_t>(program_.literals.size() - 1)};
    instruction.whole = whole_;
    return emit(instruction, true);
  }

  /// Of these values, those of one place: inside of the loop over lights or not, and of a loop or none.
  void values(std::span<const ValueId> ids, bool light, int32_t loop) {
    for (const ValueId id : ids) {
      if ((dag_[id].rate == Rate::Light) == light && loops_.of(id) == loop) value(id);
    }
  }

  void fail(std::string code, std::string message, std::string help) {
    wrong_.push_back({std::move(code), Severity::Error, {}, std::move(message), std::move(help), {}});
  }

  bool fits(const Column& column, const ir::Input& input) {
    const size_t rows = column.per_point ? points_ : 1;
    const int components = ir::componentCount(input.type);
    if (column.components == components && column.values.size() == rows * static_cast<size_t>(components))
      return true;
    fail("wrong-binding",
         fmt::format("the input '{}' is given {} numbers of {} components for {} points", input.name,
                     column.values.size(), column.components, points_),
         fmt::format("a {} has {}", ir::typeName(input.type), components));
    return false;
  }

  std::vector<Register> load(const ir::Input& input) {
    const auto components = static_cast<size_t>(ir::componentCount(input.type));
    std::vector<Register> result(components, kNoRegister);
    const auto bound = bindings_.columns.find(input.name);
    bool per_point = false;
    if (bound != bindings_.columns.end()) {
      if (!fits(bound->second, input)) return result;
      per_point = bound->second.per_point;
    } else if (input.kind == ir::InputKind::Parameter || input.kind == ir::InputKind::SpecConstant) {
      const ir::Components& value = module_.parameters[input.field].value;
      const std::vector<double> values(value.begin(), value.begin() + static_cast<ptrdiff_t>(components));
      program_.defaults.emplace_back(input.name, Column::constant(values));
    } else {
      fail("unbound-input", fmt::format("the input '{}' has no value", input.name),
           "bind a column of that name");
      return result;
    }
    const auto index = columns_.of(input.name);
    for (size_t i = 0; i < components; ++i) {
      Instruction instruction{Step::Load, Op::Input, static_cast<uint8_t>(i), -1, index};
      instruction.whole = ir::isWhole(ir::partType(input.type));
      result[i] = emit(instruction, !per_point);
    }
    return result;
  }

  std::vector<Register> loadLight(const ir::Input& input) {
    const auto components = static_cast<size_t>(ir::componentCount(input.type));
    std::vector<Register> result(components, kNoRegister);
    for (size_t i = 0; i < bindings_.lights.size(); ++i) {
      if (input.element >= 0 && i != static_cast<size_t>(input.element)) continue;
      const auto bound = bindings_.lights[i].find(input.name);
      if (bound == bindings_.lights[i].end()) {
        fail("unbound-input", fmt::format("light {} has no '{}'", i, input.name),
             "bind a column of that name");
        return result;
      }
      if (!fits(bound->second, input)) return result;
    }
    if (input.element >= 0 && static_cast<size_t>(input.element) >= bindings_.lights.size()) {
      fail("unbound-input", fmt::format("there is no light {}", input.element),
           "bind as many lights as the module sums");
      return result;
    }
    const auto index = light_fields_.of(input.name);
    for (size_t i = 0; i < components; ++i) {
      result[i] = emit({Step::Light, Op::Input, static_cast<uint8_t>(i), input.element, index}, false);
    }
    return result;
  }

  std::vector<Register> input(const ir::Input& input) {
    switch (input.kind) {
      case ir::InputKind::BlockField:
        if (module_.blocks[input.block].role == ir::BlockRole::Lights) return loadLight(input);
        return load(input);
      case ir::InputKind::Parameter:
      case ir::InputKind::SpecConstant:
      case ir::InputKind::Attribute:
      case ir::InputKind::FrontFacing:
      case ir::InputKind::Varying: return load(input);
      case ir::InputKind::LightIndex: return {emit({Step::LightIndex}, false)};
      case ir::InputKind::LoopIndex:
      case ir::InputKind::LoopValue: break;  // of the loop that is open: known
      case ir::InputKind::Texture:
        if (!bindings_.textures.contains(module_.textures[input.field].name)) {
          fail("unbound-input", fmt::format("the texture '{}' has no texels", input.name),
               "bind a sampler of that name");
        }
        return {};
    }
    return {};
  }

  const std::vector<Register>& of(ValueId id) const { return registers_of_[id]; }
  /// A component of an operand; a Float stands for all of them.
  Register at(ValueId id, size_t component) const { return of(id)[of(id).size() == 1 ? 0 : component]; }

  std::vector<Register> matrixTimesVector(ValueId m, ValueId v) {
    std::vector<Register> result;
    const size_t width = of(v).size();
    for (size_t row = 0; row < width; ++row) {
      Register sum = map(Op::Mul, of(m)[row], of(v)[0]);
      for (size_t c = 1; c < width; ++c) {
        const Register product = map(Op::Mul, of(m)[c * width + row], of(v)[c]);
        sum = map(Op::Add, sum, product);
      }
      result.push_back(sum);
    }
    return result;
  }

  std::vector<Register> texture(const ir::Value& value) {
    const ir::Input& slot = dag_.inputOf(value.args[0]);
    Instruction instruction{Step::Texture, value.op, 0, -1, textures_.of(module_.textures[slot.field].name)};
    const std::vector<Register>& coordinate = of(value.args[1]);
    std::copy(coordinate.begin(), coordinate.end(), instruction.args.begin());
    if (value.op == Op::TextureLod) instruction.args[3] = of(value.args[2])[0];
    if (value.op == Op::TextureGrad) instruction.args[3] = footprintLod(value, instruction.payload);
    for (Register& out : instruction.outs) out = fresh(false);
    program_.body.push_back(instruction);
    if (value.op == Op::TextureCompare || value.op == Op::TextureCompareLod) {
      // One texel, or a constant: what passes the comparison is all or nothing.
      const Register passes = map(Op::LessEqual, coordinate[2], instruction.outs[0]);
      return {map(Op::Select, std::array{passes, literal(1), literal(0)})};
    }
    return {instruction.outs.begin(), instruction.outs.end()};
  }

  std::vector<Register> textureSize(const ir::Value& value) {
    const ir::Input& slot = dag_.inputOf(value.args[0]);
    const auto texture = textures_.of(module_.textures[slot.field].name);
    return {sizeAlong(value.payload, texture, of(value.args[1])[0])};
  }

  Register sizeAlong(uint32_t axis, uint32_t texture, Register level) {
    Instruction size{Step::TextureSize, Op::TextureSize, static_cast<uint8_t>(axis), -1, texture};
    size.args[0] = level;
    size.whole = true;
    return emit(size, virtuals_[level].uniform);
  }

  /// The level at which the longer of two derivatives is one texel long, 0 where it is shorter (Vulkan 1.3,
  /// "Scale Factor Operation"). Of a cube map: as seen where the direction's largest component is 1, half a
  /// face.
  Register footprintLod(const ir::Value& value, uint32_t texture) {
    const ir::Type type = dag_[value.args[0]].type;
    const bool cube = type == ir::Type::TextureCube;
    const size_t axes = of(value.args[2]).size();
    const Register first = literal(0);
    std::vector<Register> scales;
    for (uint32_t axis = 0; axis < axes; ++axis)
      scales.push_back(map(Op::FromInt, std::array{sizeAlong(cube ? 0 : axis, texture, first)}));
    if (cube) {
      Register largest = map(Op::Abs, std::array{of(value.args[1])[0]});
      for (size_t c = 1; c < 3; ++c)
        largest = map(Op::Max, largest, map(Op::Abs, std::array{of(value.args[1])[c]}));
      const Register half = map(Op::Mul, scales[0], literal(0.5));
      scales.assign(3, map(Op::Div, half, map(Op::Max, largest, literal(kLeastDirection))));
    }
    std::array<Register, 2> squares{};
    for (size_t k = 0; k < 2; ++k) {
      for (size_t c = 0; c < axes; ++c) {
        const Register texels = map(Op::Mul, of(value.args[2 + k])[c], scales[c]);
        const Register square = map(Op::Mul, texels, texels);
        squares[k] = c == 0 ? square : map(Op::Add, squares[k], square);
      }
    }
    const Register longest = map(Op::Max, map(Op::Max, squares[0], squares[1]), literal(1));
    return map(Op::Mul, map(Op::Log2, std::array{longest}), literal(0.5));
  }

  std::vector<Register> derivative(const ir::Value& value, Step step) {
    std::vector<Register> result;
    for (const Register r : of(value.args[0])) {
      if (!bindings_.quads || virtuals_[r].uniform)
        result.push_back(literal(0));
      else
        result.push_back(
            emit({step, value.op, 0, -1, 0, {}, {r, kNoRegister, kNoRegister, kNoRegister}}, false));
    }
    return result;
  }

  std::vector<Register> sumOverLights(const ir::Value& value) {
    const ValueId operand = value.args[0];
    std::vector<Register> sums;
    for (int i = 0; i < ir::componentCount(value.type); ++i) {
      program_.literals.push_back(0);
      sums.push_back(emit(
          {Step::Literal, Op::Constant, 0, -1, static_cast<uint32_t>(program_.literals.size() - 1)}, false));
    }
    const bool listed = value.count == 3;
    Instruction begin{Step::LoopBegin, value.op, 0, -1, value.payload};
    if (listed) {
      begin.args[0] = of(value.args[1])[0];
      begin.args[1] = of(value.args[2])[0];
    }
    program_.body.push_back(begin);
    // Another sum computes again what it shares with one before it, loops as well.
    for (const ir::Loop& loop : loops_.all()) {
      if (dag_[loop.last].rate != Rate::Light) continue;
      registers_of_[loop.index].clear();
      for (const ir::Carry& carry : loop.carries) registers_of_[carry.value].clear();
    }
    values(ir::reachable(dag_, {{operand}}), true, -1);
    for (size_t i = 0; i < sums.size(); ++i) {
      program_.body.push_back({listed ? Step::AddListed : Step::Map,
                               Op::Add,
                               0,
                               -1,
                               0,
                               {sums[i], kNoRegister, kNoRegister, kNoRegister},
                               {sums[i], at(operand, i), kNoRegister, kNoRegister}});
    }
    program_.body.push_back({Step::LoopEnd, value.op, 0, -1, value.payload});
    return sums;
  }

  void copy(Register to, Register from, bool whole) {
    Instruction instruction{Step::Copy, Op::Carry};
    instruction.outs[0] = to;
    instruction.args[0] = from;
    instruction.whole = whole;
    program_.body.push_back(instruction);
  }

  /// All rounds of a loop, when the first of what it carries is asked for. Points may have different numbers
  /// of rounds.
  void rounds(int32_t number) {
    const ir::Loop& loop = loops_[number];
    const Register end = of(loop.end)[0];
    std::vector<Register> nexts;
    for (const ir::Carry& carry : loop.carries) {
      const bool whole = ir::isWhole(dag_[carry.value].type);
      for (const Register first : of(carry.first)) {
        const Register variable = fresh(false);
        registers_of_[carry.value].push_back(variable);
        copy(variable, first, whole);
      }
    }
    Instruction begin{Step::RoundsBegin, Op::Loop, 0, ir::firstRound(dag_, loop), ir::mostRounds(dag_, loop)};
    begin.outs[0] = fresh(false);
    begin.args[0] = end;
    registers_of_[loop.index] = {begin.outs[0]};
    program_.body.push_back(begin);
    const std::vector<ValueId> body = loops_.bodyOf(number);
    values(body, dag_[loop.last].rate == Rate::Light, number);
    // All at once: what the next round begins with is made of what this one began with.
    for (const ir::Carry& carry : loop.carries) {
      const bool whole = ir::isWhole(dag_[carry.value].type);
      for (const Register next : of(carry.next)) {
        nexts.push_back(fresh(false));
        copy(nexts.back(), next, whole);
      }
    }
    size_t at = 0;
    for (const ir::Carry& carry : loop.carries) {
      for (const Register variable : of(carry.value)) {
        Instruction keep{Step::Keep, Op::Carry};
        keep.outs[0] = variable;
        keep.args = {nexts[at++], begin.outs[0], end, kNoRegister};
        program_.body.push_back(keep);
      }
    }
    Instruction last{Step::RoundsEnd, Op::Loop, 0, begin.element, begin.payload};
    last.args[0] = begin.outs[0];
    last.args[1] = end;
    program_.body.push_back(last);
  }

  std::vector<Register> carried(ValueId id) {
    const int32_t number = loops_.indexOf(id);
    const ir::Loop& loop = loops_[number];
    const auto carry = std::find_if(loop.carries.begin(), loop.carries.end(), [&](const ir::Carry& c) {
      return dag_.inputOf(c.value).index == dag_[id].payload;
    });
    if (registers_of_[loop.index].empty()) rounds(number);
    return of(carry->value);
  }

  /// Of a list of ints one register, of the lights those of the field.
  std::vector<Register> element(const ir::Value& value) {
    const ir::ListField from = ir::ListField::of(value);
    const ir::Block& block = module_.blocks[from.block];
    const ir::BlockField& field = block.fields[from.field];
    const std::string name = block.instance + "." + field.name;
    const std::array<Register, 4> number = {of(value.args[0])[0], kNoRegister, kNoRegister, kNoRegister};
    if (block.role != ir::BlockRole::Lights) {
      program_.lists.push_back(listValues(module_, bindings_, from));
      const auto index = static_cast<uint32_t>(program_.lists.size() - 1);
      return {emit({Step::Listed,
                    Op::Element,
                    0,
                    -1,
                    index,
                    {kNoRegister, kNoRegister, kNoRegister, kNoRegister},
                    number},
                   false)};
    }
    const ir::Input input{ir::InputKind::BlockField, name, field.type, ir::Rate::Light, field.range};
    std::vector<Register> result = loadLight(input);  // checks what is bound
    if (!wrong_.empty()) return result;
    program_.body.resize(program_.body.size() - result.size());
    const auto index = light_fields_.of(name);
    for (size_t i = 0; i < result.size(); ++i) {
      result[i] = emit({Step::ListedLight,
                        Op::Element,
                        static_cast<uint8_t>(i),
                        -1,
                        index,
                        {kNoRegister, kNoRegister, kNoRegister, kNoRegister},
                        number},
                       false);
    }
    return result;
  }

  std::vector<Register> folded(const ir::Value& value) {
    std::array<std::span<const Register>, 4> operands;
    for (size_t k = 0; k < value.count; ++k) operands[k] = of(value.args[k]);
    const std::array<Register, 4> result =
        ir::fold<Register>(value.op, value.type, value.payload, {operands.data(), value.count},
                           [this](Op op, std::span<const Register> args) { return map(op, args); });
    return {result.begin(), result.begin() + ir::componentCount(value.type)};
  }

  void value(ValueId id) {
    // After an error registers are missing; what is left to find is more unbound inputs.
    half_ = dag_.relaxed(id);
    whole_ = ir::isWhole(ir::partType(dag_[id].type));
    fuses_ = fuses(id);
    const bool known = dag_[id].op == Op::Input && ir::ofLoop(dag_.inputOf(id).kind);
    if (known || ir::makesLoop(dag_[id].op)) return;
    if (wrong_.empty() || dag_[id].op == Op::Input) registers_of_[id] = made(id);
  }

  bool fuses(ValueId id) const {
    const ir::Value& value = dag_[id];
    if (value.op == Op::MatMul) return true;
    if (value.op != Op::Add && value.op != Op::Sub) return false;
    // A constant may be a guard, which no regrouping explains.
    if (dag_.isConstant(value.args[0]) || dag_.isConstant(value.args[1])) return false;
    const auto of_more = [&](ValueId operand) {
      const Op op = dag_[operand].op;
      return op == Op::Mul || op == Op::Add || op == Op::Sub;
    };
    return of_more(value.args[0]) || of_more(value.args[1]);
  }

  std::vector<Register> made(ValueId id) {
    const ir::Value& value = dag_[id];
    if (ir::facts(value.op).kind != ir::Kind::Surroundings) return folded(value);
    if (ir::readsTexture(value.op)) return texture(value);
    if (value.op == Op::TextureSize) return textureSize(value);
    if (value.op == Op::Input) return input(dag_.inputOf(id));
    if (value.op == Op::Interpolate) return of(value.args[0]);
    if (value.op == Op::MatMul) return matrixTimesVector(value.args[0], value.args[1]);
    if (value.op == Op::Column) {
      const auto width = static_cast<ptrdiff_t>(ir::componentCount(value.type));
      const auto first = of(value.args[0]).begin() + width * value.payload;
      return {first, first + width};
    }
    if (value.op == Op::DFdx) return derivative(value, Step::DerivativeX);
    if (value.op == Op::DFdy) return derivative(value, Step::DerivativeY);
    if (value.op == Op::SumOverLights) return sumOverLights(value);
    if (value.op == Op::Element) return element(value);
    if (value.op == Op::Carried) return carried(id);
    std::vector<Register> result;  // of a literal
    for (size_t i = 0; i < static_cast<size_t>(ir::componentCount(value.type)); ++i)
      result.push_back(literal(dag_.constantOf(id)[i]));
    return result;
  }

  const ir::Module& module_;
  const ir::Dag& dag_;
  const Bindings& bindings_;
  size_t points_;
  Program program_;
  Numbered columns_{program_.columns}, light_fields_{program_.light_fields}, textures_{program_.textures};
  Diagnostics wrong_;
  bool half_ = false;   ///< what is being compiled is relaxed
  bool whole_ = false;  ///< it is an integer
  bool fuses_ = false;  ///< it is a sum of sums or products
  ir::Loops loops_;
  std::vector<Virtual> virtuals_;
  std::vector<std::vector<Register>> registers_of_;
};

/// Gives the registers of the body new numbers, so that one whose last use is past serves again: the working
/// set then fits a cache.
class Allocator {
public:
  Allocator(Program& program, const std::vector<Virtual>& virtuals)
      : program_(program), virtuals_(virtuals), first_(virtuals.size(), kNever), last_(virtuals.size(), 0) {}

  void run() {
    lifetimes();
    number_.assign(virtuals_.size(), kNoRegister);
    for (Register r = 0; r < virtuals_.size(); ++r) {
      if (virtuals_[r].uniform) number_[r] = program_.registers++;
    }
    for (Instruction& instruction : program_.uniform) renumber(instruction);
    for (size_t i = 0; i < program_.body.size(); ++i) {
      Instruction& instruction = program_.body[i];
      for (const Register out : instruction.outs) {
        if (out != kNoRegister && number_[out] == kNoRegister) take(out);
      }
      renumber(instruction);
      for (const Register r : ending_[i]) free_.push_back(number_[r]);
    }
    for (std::vector<Register>& result : program_.results) {
      for (Register& r : result) r = number_[r];
    }
  }

private:
  static constexpr size_t kNever = ~size_t{0};

  void lifetimes() {
    const size_t length = program_.body.size();
    // Of each loop, where it begins and ends; of each instruction, the innermost that it is in.
    struct Span {
      size_t begin, end, around;
    };
    std::vector<Span> loops;
    std::vector<size_t> loop_of(length, kNever);
    size_t open = kNever;
    for (size_t i = 0; i < length; ++i) {
      const Step step = program_.body[i].step;
      if (step == Step::LoopBegin || step == Step::RoundsBegin) {
        loops.push_back({i, i, open});
        open = loops.size() - 1;
      }
      loop_of[i] = open;
      if (step != Step::LoopEnd && step != Step::RoundsEnd) continue;
      loops[open].end = i;
      open = loops[open].around;
    }
    for (size_t i = 0; i < length; ++i) {
      const auto touch = [&](Register r) {
        if (r == kNoRegister || virtuals_[r].uniform) return;
        if (first_[r] == kNever) first_[r] = i;
        // What comes from before a loop is needed in its every turn.
        size_t last = i;
        for (size_t l = loop_of[i]; l != kNever && first_[r] < loops[l].begin; l = loops[l].around)
          last = loops[l].end;
        last_[r] = std::max(last_[r], last);
      };
      for (const Register r : program_.body[i].outs) touch(r);
      for (const Register r : program_.body[i].args) touch(r);
    }
    for (const std::vector<Register>& result : program_.results) {
      for (const Register r : result) last_[r] = kNever;
    }
    ending_.resize(length);
    for (Register r = 0; r < virtuals_.size(); ++r) {
      if (first_[r] != kNever && last_[r] != kNever) ending_[last_[r]].push_back(r);
    }
  }

  void take(Register r) {
    if (free_.empty()) {
      number_[r] = program_.registers++;
    } else {
      number_[r] = free_.back();
      free_.pop_back();
    }
  }

  void renumber(Instruction& instruction) {
    for (Register& r : instruction.outs) r = r == kNoRegister ? r : number_[r];
    for (Register& r : instruction.args) r = r == kNoRegister ? r : number_[r];
  }

  Program& program_;
  const std::vector<Virtual>& virtuals_;
  std::vector<size_t> first_, last_;
  std::vector<std::vector<Register>> ending_;
  std::vector<Register> number_, free_;
};

}  // namespace

std::vector<double> listValues(const ir::Module& module, const Bindings& bindings,
                               const ir::ListField& field) {
  const ir::Block& block = module.blocks[field.block];
  const auto bound = bindings.lists.find(block.instance + "." + block.fields[field.field].name);
  if (bound != bindings.lists.end()) return bound->second;
  const size_t lights = bindings.lights.size();
  const auto is = [&](const ir::ListField& other) {
    return other.block == field.block && other.field == field.field;
  };
  if (module.light_lists && is(module.light_lists->count)) return {static_cast<double>(lights)};
  std::vector<double> values(module.light_lists && is(module.light_lists->number) ? lights : 1, 0);
  std::iota(values.begin(), values.end(), 0);
  return values;
}

Result<Program> compile(const ir::Module& module, std::span<const ir::ValueId> roots,
                        const Bindings& bindings, size_t points) {
  Compiler compiler(module, bindings, points);
  Result<Program> program = compiler.run(roots);
  if (program) Allocator(*program, compiler.virtuals()).run();
  return program;
}

}  // namespace lacquer::eval
