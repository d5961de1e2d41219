// Random DAGs: whatever their shape, the words are valid and compute what the DAG means.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "check/check.h"
#include "spirv/reference.h"
#include "targets/legalize.h"
#include "targets/samples.h"

namespace lacquer::spirv_test {

using ir::InputKind;
using ir::Op;
using ir::Rate;
using ir::Stage;
using ir::Type;
using ir::ValueId;

namespace {

constexpr std::array kFloating = {Type::Float, Type::Vec2, Type::Vec3, Type::Vec4};

/// Values to take operands from, by type.
using Pool = std::map<Type, std::vector<ValueId>>;

class Generator {
public:
  Generator(uint32_t seed, Stage stage, bool loops)
      : random_(seed),
        stage_(stage),
        loops_(loops),
        rate_(stage == Stage::Vertex ? Rate::Vertex : Rate::Fragment) {}

  ir::Module make(int operations) {
    declare();
    Pool pool = leaves();
    grow(pool, operations);
    const ValueId condition = pool.at(Type::Bool).back();
    const bool drops = stage_ == Stage::Fragment && below(2) == 0;
    // A fragment is dropped before the loops, but after all that needs derivatives.
    derivatives_ = !drops;
    if (stage_ == Stage::Fragment) {
      for (uint32_t group = 0; group < b_.module.light_groups.size(); ++group)
        sums(pool, group, operations / 2);
      // Sums that need sums: a second loop over the same lights, which shares values with the first.
      sums(pool, 0, operations / 2);
      grow(pool, operations / 2);
    }
    deliver(pool);
    if (drops) b_.discard(condition);
    return b_.module;
  }

private:
  uint32_t below(uint32_t n) { return random_() % n; }
  template <class Range>
  auto any(const Range& range) {
    return range[below(static_cast<uint32_t>(range.size()))];
  }
  ir::Dag& dag() { return b_.dag(); }

  void declare() {
    using ir::BlockRole;
    b_.block(BlockRole::Frame, "Frame", "frame",
             {{"m", Type::Mat4},
              {"v", Type::Vec3},
              {"light_count", Type::Int},
              {"f", Type::Float},
              {"g", Type::Float},
              {"lone", Type::Vec3}});
    b_.block(BlockRole::Lights, "Light", "light",
             {{"direction", Type::Vec3},
              {"kind", Type::Int},
              {"color", Type::Vec4},
              {"two", Type::Vec2},
              {"power", Type::Float},
              {"lone", Type::Vec4}},
             4);
    b_.block(BlockRole::Material, "Material", "material",
             {{"f", Type::Float},
              {"two", Type::Vec2},
              {"v", Type::Vec3},
              {"w", Type::Vec4},
              {"lone", Type::Vec4}});
    b_.module.light_groups = {{0, -1}, {1, 2}, {0, 0}};
  }

  Pool leaves() {
    Pool pool;
    const auto take = [&](ValueId id) { pool[dag()[id].type].push_back(id); };
    for (const char* field : {"frame.m", "frame.v", "frame.light_count", "frame.f", "frame.g", "material.f",
                              "material.two", "material.v", "material.w"}) {
      take(b_.field(field));
    }
    // Fields of which nothing else is read.
    take(dag().component(b_.field("frame.lone"), 2));
    take(dag().component(b_.field("material.lone"), 3));
    take(b_.field("light.color", 3));
    take(b_.texture("picture", Type::Texture2D));
    take(b_.texture("sky", Type::TextureCube, true));
    for (const Type type : kFloating) {
      const ValueId in = b_.attribute(fmt::format("A_{}", ir::componentCount(type)), type);
      take(stage_ == Stage::Vertex ? in : b_.varying(fmt::format("a{}", ir::componentCount(type)), in));
      for (int i = 0; i < 2; ++i) take(dag().constant(type, {small(), small(), small(), small()}));
    }
    for (const int32_t i : {2, -7, 123456789}) take(dag().integer(i));
    for (const uint32_t i : {3U, 2654435769U}) take(dag().uinteger(i));
    take(dag().boolean(true));
    if (stage_ == Stage::Fragment) {
      take(dag().input({InputKind::FrontFacing, "front", Type::Bool, Rate::Fragment, {}}));
    }
    return pool;
  }

  double small() { return (static_cast<double>(below(33)) - 16) / 8; }

  void grow(Pool& pool, int operations) {
    for (int i = 0; i < operations; ++i) {
      if (loops_ && depth_ < 3 && below(8) == 0) loop(pool);
      const ValueId made = operation(pool);
      pool[dag()[made].type].push_back(made);
      if (below(4) == 0) b_.named(made, fmt::format("n{}", i));
      if (below(8) == 0) b_.term(fmt::format("term.{}", i), "");
    }
  }

  /// A loop that carries values of some types, with loops in it. What it carries stays small.
  void loop(Pool& pool) {
    ++depth_;
    const uint32_t number = dag().openLoop();
    const int first = static_cast<int>(below(5)) - 2;
    const int most = 1 + static_cast<int>(below(4));
    const ValueId past = dag().integer(first + most);
    ValueId end = below(2) == 0 ? past : pick(pool, Type::Int);
    end = dag().make(Op::Select, {dag().make(Op::IntLess, {past, end}), past, end});
    const double from = first;
    Pool inside = pool;
    const auto take = [&](ValueId id) {
      for (int i = 0; i < 6; ++i) inside[dag()[id].type].push_back(id);
    };
    const ValueId index =
        dag().input({InputKind::LoopIndex, "round", Type::Int, rate_, {from, from + most - 1}, 0, number});
    take(index);
    constexpr std::array kCarried = {Type::Float, Type::Vec2, Type::Vec3, Type::Vec4,
                                     Type::Int,   Type::UInt, Type::Bool};
    std::vector<std::pair<ValueId, ValueId>> carried;  // the first, and that of a round
    for (uint32_t k = 0; k <= below(4); ++k) {
      const Type type = any(kCarried);
      ir::Input input{InputKind::LoopValue, fmt::format("carried_{}", k), type, rate_, {}, 0, number};
      input.index = k;
      carried.emplace_back(pick(pool, type), dag().input(input));
      take(carried.back().second);
    }
    grow(inside, 2 + static_cast<int>(below(12)));
    ValueId chain = dag().make(Op::Loop, {end, index});
    for (const auto& [begin, value] : carried) {
      ValueId next = pick(inside, dag()[value].type);
      if (below(4) == 0) next = inside.at(dag()[value].type).at(pool[dag()[value].type].size());
      const bool number_like = ir::isFloating(dag()[value].type);
      if (number_like && dag()[next].op != Op::Input) next = dag().make(Op::Sin, {next});
      chain = dag().make(Op::Carry, {chain, begin, next, value});
    }
    for (uint32_t k = 0; k < carried.size(); ++k) {
      const ValueId left = dag().carried(chain, k);
      for (int i = 0; i < 3; ++i) pool[dag()[left].type].push_back(left);
    }
    --depth_;
  }

  /// Some sums over a group; its light-rate values go to a pool of their own.
  void sums(Pool& pool, uint32_t group, int operations) {
    Pool inside = pool;
    const auto light = [&](std::string name, Type type, InputKind kind, uint32_t field) {
      return dag().input(
          {kind, std::move(name), type, Rate::Light, {}, 1, field, -1, static_cast<int32_t>(group)});
    };
    const auto field = [&](const char* name, Type type, uint32_t index) {
      return light(name, type, InputKind::BlockField, index);
    };
    const auto take = [&](ValueId id) { inside[dag()[id].type].push_back(id); };
    for (int i = 0; i < 8; ++i) {  // often, so that they are chosen
      take(field("light.direction", Type::Vec3, 0));
      take(field("light.kind", Type::Int, 1));
      take(field("light.color", Type::Vec4, 2));
      take(field("light.two", Type::Vec2, 3));
      take(field("light.power", Type::Float, 4));
      take(dag().component(field("light.lone", Type::Vec4, 5), 3));
      take(light("i", Type::Int, InputKind::LightIndex, 0));
    }
    const Rate outer = std::exchange(rate_, Rate::Light);
    grow(inside, operations);
    rate_ = outer;
    for (const Type type : kFloating) {
      ValueId total = any(pool[type]);
      for (const ValueId id : inside[type]) {
        if (dag()[id].rate == Rate::Light) total = dag().add(total, id);
      }
      pool[type].push_back(dag().make(Op::SumOverLights, {below(8) == 0 ? any(pool[type]) : total}, group));
    }
  }

  ValueId operation(const Pool& pool) {
    for (;;) {
      const Op op = static_cast<Op>(below(ir::kOpCount));
      if (const auto made = tryMake(pool, op)) return *made;
    }
  }

  ValueId pick(const Pool& pool, Type type) {
    const std::vector<ValueId>& all = pool.at(type);
    // Late values more often, so that the DAG grows deep.
    const uint32_t n = static_cast<uint32_t>(all.size());
    return all[below(2) == 0 ? below(n) : n - 1 - below(std::min(n, 4U))];
  }

  /// An operand for which the op has a finite result: one value that is not a number would hide all others.
  ValueId harmless(Op op, int index, ValueId operand) {
    const auto bounded = [&](double lo, double hi) {
      return dag().make(Op::Clamp, {operand, dag().constant(lo), dag().constant(hi)});
    };
    const auto positive = [&] { return dag().add(dag().make(Op::Abs, {operand}), dag().constant(0.25)); };
    if (op == Op::Acos || op == Op::Asin) return bounded(-1, 1);
    if (op == Op::Exp || op == Op::Exp2 || (op == Op::Pow && index == 1)) return bounded(-4, 3);
    if (op == Op::Mul) return dag().make(Op::Sin, {operand});
    const bool root = op == Op::Sqrt || op == Op::InverseSqrt || op == Op::Log || op == Op::Log2;
    const bool divisor = op == Op::Div && index == 1;
    const bool base = op == Op::Pow && index == 0;
    return root || divisor || base || op == Op::Normalize ? positive() : operand;
  }

  std::optional<ValueId> tryMake(const Pool& pool, Op op) {
    const Type type = any(kFloating);
    const Type vector = kFloating[1 + below(3)];
    if (op == Op::Interpolate || op == Op::SumOverLights || op == Op::Constant || op == Op::Input) return {};
    if ((op == Op::DFdx || op == Op::DFdy) && stage_ == Stage::Vertex) return {};
    if ((op == Op::DFdx || op == Op::DFdy || op == Op::Texture) && !derivatives_) return {};
    switch (ir::info(op).signature) {
      case ir::Signature::Map: {
        std::vector<ValueId> operands;
        for (int k = 0; k < ir::info(op).arity; ++k) {
          operands.push_back(harmless(op, k, pick(pool, below(3) == 0 ? Type::Float : type)));
        }
        return dag().make(op, operands);
      }
      case ir::Signature::Reduce2: return dag().make(op, {pick(pool, type), pick(pool, type)});
      case ir::Signature::Cross: return dag().make(op, {pick(pool, Type::Vec3), pick(pool, Type::Vec3)});
      case ir::Signature::Length: return dag().make(op, {pick(pool, type)});
      case ir::Signature::Same: {
        const ValueId operand = pick(pool, type);
        // Derivatives are of the fragment's values.
        if (op != Op::Normalize && dag()[operand].rate == Rate::Light) return {};
        return dag().make(op, {harmless(op, 0, operand)});
      }
      case ir::Signature::Compare: return dag().make(op, {pick(pool, Type::Float), pick(pool, Type::Float)});
      case ir::Signature::Whole:
      case ir::Signature::WholeTest:
      case ir::Signature::Shift: return wholes(pool, op);
      case ir::Signature::Logic:
        if (op == Op::Not) return dag().make(op, {pick(pool, Type::Bool)});
        return dag().make(op, {pick(pool, Type::Bool), pick(pool, Type::Bool)});
      case ir::Signature::Select: {
        constexpr std::array kOthers = {Type::Bool, Type::Int, Type::UInt};
        const Type chosen = below(4) == 0 ? any(kOthers) : type;
        return dag().make(op, {pick(pool, Type::Bool), pick(pool, chosen), pick(pool, chosen)});
      }
      case ir::Signature::Special: break;
    }
    if (op == Op::ToInt || op == Op::ToUInt || op == Op::AsInt || op == Op::AsUInt || op == Op::FromInt ||
        op == Op::FromUInt)
      return conversion(pool, op);
    if (op == Op::Column) return dag().column(pick(pool, Type::Mat4), below(4));
    if (op == Op::MatMul) return dag().make(op, {pick(pool, Type::Mat4), pick(pool, Type::Vec4)});
    if (op == Op::Texture && below(2) == 0) {
      return dag().make(op, {pick(pool, Type::Texture2D), pick(pool, Type::Vec2)});
    }
    if (op == Op::Texture) return dag().make(op, {pick(pool, Type::TextureCube), pick(pool, Type::Vec3)});
    if (op == Op::TextureLod) {
      return dag().make(op, {pick(pool, Type::TextureCube), pick(pool, Type::Vec3), pick(pool, Type::Float)});
    }
    if (op == Op::TextureGrad) {
      return dag().make(op, {pick(pool, Type::TextureCube), pick(pool, Type::Vec3), pick(pool, Type::Vec3),
                             pick(pool, Type::Vec3)});
    }
    if (op == Op::TextureSize)
      return dag().make(op, {pick(pool, Type::Texture2D), pick(pool, Type::Int)}, below(2));
    if (op == Op::Swizzle) {
      std::vector<int> components(1 + below(4));
      for (int& c : components)
        c = static_cast<int>(below(static_cast<uint32_t>(ir::componentCount(vector))));
      return dag().swizzle(pick(pool, vector), components);
    }
    return construct(pool, vector);
  }

  /// Integers of the type that the op takes; divisors that are not 0, and counts below 32.
  ValueId wholes(const Pool& pool, Op op) {
    const bool ints = op == Op::IntDiv || op == Op::IntLess || op == Op::IntShiftRight;
    const bool uints = op == Op::UIntDiv || op == Op::UIntLess || op == Op::UIntShiftRight;
    const Type type = ints || (!uints && below(2) == 0) ? Type::Int : Type::UInt;
    const ValueId a = pick(pool, type);
    if (ir::info(op).arity == 1) return dag().make(op, {a});
    if (ir::info(op).signature == ir::Signature::Shift) {
      const ValueId count = dag().make(Op::BitAnd, {pick(pool, Type::UInt), dag().uinteger(31)});
      return dag().make(op, {a, count});
    }
    ValueId b = pick(pool, type);
    if (op == Op::IntDiv) {
      const ValueId small = dag().make(Op::BitAnd, {b, dag().integer(0xffff)});
      b = dag().make(Op::BitOr, {small, dag().integer(1)});
    }
    if (op == Op::UIntDiv) b = dag().make(Op::BitOr, {b, dag().uinteger(1)});
    return dag().make(op, {a, b});
  }

  /// Between floats and integers; what comes of these is small, so that it hides nothing.
  ValueId conversion(const Pool& pool, Op op) {
    if (op == Op::ToInt || op == Op::ToUInt) {
      const ValueId low = dag().constant(op == Op::ToInt ? -2e9 : 0);
      const ValueId within = dag().make(Op::Clamp, {pick(pool, Type::Float), low, dag().constant(2e9)});
      return dag().make(op, {within});
    }
    if (op == Op::AsInt) return dag().make(op, {pick(pool, Type::UInt)});
    if (op == Op::AsUInt) return dag().make(op, {pick(pool, Type::Int)});
    const ValueId number = dag().make(op, {pick(pool, op == Op::FromInt ? Type::Int : Type::UInt)});
    return dag().mul(number, dag().constant(0x1p-30));
  }

  ValueId construct(const Pool& pool, Type type) {
    if (below(4) == 0) return dag().construct(type, {pick(pool, Type::Float)});
    std::vector<ValueId> parts;
    for (int left = ir::componentCount(type); left > 0;) {
      const int width = 1 + static_cast<int>(below(static_cast<uint32_t>(std::min(left, 3))));
      parts.push_back(pick(pool, ir::floatType(width)));
      left -= width;
    }
    return dag().construct(type, parts);
  }

  /// Every value counts: the outputs are sums over the pool.
  void deliver(const Pool& pool) {
    std::array<ValueId, 2> totals{dag().constant(Type::Vec4, {}), dag().constant(Type::Vec4, {})};
    uint32_t turn = 0;
    for (const Type type : kFloating) {
      for (const ValueId id : pool.at(type)) {
        const int n = ir::componentCount(type);
        const ValueId wide = dag().swizzle(id, {{0, n > 1 ? 1 : 0, n > 2 ? 2 : 0, n > 3 ? 3 : 0}});
        ValueId& total = totals[turn++ % 2];
        total = dag().add(total, wide);
      }
    }
    if (stage_ == Stage::Vertex) {
      b_.position(totals[0]);
      b_.varying("out", totals[1]);
      return;
    }
    b_.color("first", totals[0], 0);
    b_.color("second", totals[1], 1);
  }

  std::mt19937 random_;
  Stage stage_;
  bool loops_;
  Rate rate_;      ///< of what is made where the generator is
  int depth_ = 0;  ///< of loops
  bool derivatives_ = true;
  targets::Builder b_;
};

std::string text(const Diagnostics& diagnostics) {
  std::string all;
  for (const Diagnostic& d : diagnostics) all += format(d) + '\n';
  return all;
}

void expectRight(const ir::Module& module, const schedule::Program& program, uint32_t seed) {
  for (const bool debug : {false, true}) {
    const std::vector<uint32_t> words = targets::writeSpirv(module, program, {debug});
    const Diagnostics wrong = check::validate(words, false, "random");
    ASSERT_TRUE(wrong.empty()) << text(wrong);
    ASSERT_EQ(words, targets::writeSpirv(module, program, {debug}));
    for (const int32_t lights : {0, 3}) {
      const World world = makeWorld(module, seed, lights);
      const Outcome expected = evaluate(module, program.stage, world);
      for (const auto& [name, cell] : expected.outputs) {
        for (const double x : cell) EXPECT_TRUE(std::isfinite(x)) << name << " hides mistakes";
      }
      expectSame(expected, interpret(words, world));
    }
  }
}

/// The texts compile, and that of GLSL computes what the DAG means.
void expectTexts(const ir::Module& module, Stage stage, uint32_t seed) {
  for (const Target target : targets::kTextTargets) {
    const std::string text = targets::print(module, stage, target);
    const check::Spirv words = targets::expectCompiles(text, stage, target);
    if (target != Target::Glsl || words.empty()) continue;
    const World world = makeWorld(module, seed, 3);
    SCOPED_TRACE(text);
    expectSame(evaluate(module, stage, world), interpret(words, world));
  }
}

/// The same program with none of its variables: every value is placed by the writer alone.
schedule::Program withoutVariables(schedule::Program program) {
  std::erase_if(program.statements,
                [](const schedule::Statement& s) { return s.kind == schedule::StatementKind::Let; });
  for (std::string& name : program.names) name.clear();
  return program;
}

void run(uint32_t seed, Stage stage, int operations, bool loops = false) {
  SCOPED_TRACE(fmt::format("seed {}", seed));
  ir::Module module = Generator(seed, stage, loops).make(operations);
  const std::vector<std::string> wrong = ir::verify(module);
  ASSERT_TRUE(wrong.empty()) << wrong[0];
  const schedule::Program program = schedule::schedule(module, stage);
  expectRight(module, program, seed);
  expectRight(module, withoutVariables(program), seed);
  if (seed % 4 == 0) expectTexts(module, stage, seed);
}

}  // namespace

TEST(Random, Fragments) {
  for (uint32_t seed = 0; seed < 60 && !testing::Test::HasFailure(); ++seed) {
    run(seed, Stage::Fragment, 20 + static_cast<int>(seed) * 4);
  }
}

TEST(Random, Vertices) {
  for (uint32_t seed = 0; seed < 40 && !testing::Test::HasFailure(); ++seed) {
    run(seed, Stage::Vertex, 20 + static_cast<int>(seed) * 6);
  }
}

TEST(Random, Loops) {
  for (uint32_t seed = 0; seed < 60 && !testing::Test::HasFailure(); ++seed) {
    run(seed, Stage::Fragment, 20 + static_cast<int>(seed) * 2, true);
    run(seed, Stage::Vertex, 20 + static_cast<int>(seed) * 2, true);
  }
}

}  // namespace lacquer::spirv_test
