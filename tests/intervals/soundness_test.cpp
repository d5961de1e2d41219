// Every value that float32 evaluation gives lies in its interval: of random DAGs, of every node, and of the
// shaders of all examples.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "intervals/evaluator.h"
#include "ir/facts.h"
#include "ir/loops.h"
#include "ir/whole.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "prove/nodes.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test::soundness_test {
namespace {

using analysis::Intervals;
using ir::Op;
using ir::Type;
using ir::ValueId;

/// Values outside of their intervals; the first is described.
size_t violations(const ir::Module& module, const Intervals& intervals, int samples, double limit,
                  std::string& what) {
  const std::vector<ValueId> ids = everything(module);
  std::vector<Floats> values;
  size_t count = 0;
  for (int i = 0; i < samples; ++i) {
    evaluate(module, ids, World(static_cast<uint64_t>(i), limit), values, [&](ValueId id) {
      if (ir::isTexture(module.dag[id].type)) return;
      for (int c = 0; c < std::min(ir::componentCount(module.dag[id].type), 4); ++c) {
        const float held = values[id][static_cast<size_t>(c)];
        const bool whole = ir::isWhole(ir::partType(module.dag[id].type));
        const double x = whole ? ir::int_number<double>(ir::bits(held)) : held;
        const analysis::Range& r = intervals.at(id, c);
        if (std::isnan(x) ? r.nan : r.contains(x)) continue;
        if (++count > 1) continue;
        std::ostringstream text;
        text.precision(9);
        text << "%" << id << " " << ir::info(module.dag[id].op).name << " " << module.dag.nameOf(id) << " of "
             << module.dag.terms()[module.dag.termOf(id)].name << " is " << x << ", not in [" << r.lo << ", "
             << r.hi << "] (world " << i << ")";
        what = text.str();
      }
    });
  }
  return count;
}

void expectSound(const ir::Module& module, const analysis::IntervalOptions& options, int samples,
                 const std::string& name) {
  Intervals intervals(module, options);
  intervals.run();
  std::string what;
  EXPECT_EQ(violations(module, intervals, samples, options.unbounded, what), 0U) << name << ": " << what;
}

/// A random DAG over a few inputs; made through the constructor, so that its rules apply.
class RandomDag {
public:
  explicit RandomDag(uint32_t seed, bool loops = false) : random_(seed), loops_(loops) {
    const ir::Interval ranges[] = {{0, 1},  {-1, 1}, {0.25, 3},
                                   {-2, 0}, {},      {0, std::numeric_limits<double>::infinity()}};
    for (int i = 0; i < 6; ++i) {
      const Type type = i % 2 == 0 ? Type::Float : Type::Vec3;
      values_.push_back(
          module_.dag.input({ir::InputKind::Parameter, "p" + std::to_string(i), type, ir::Rate::Material,
                             ranges[pick(6)], 0, static_cast<uint32_t>(i)}));
    }
    for (const double x : {0.0, 1.0, 0.5, -0.3, 1e-30}) values_.push_back(module_.dag.constant(x));
    for (int i = 0; i < (loops ? 20 : 60); ++i) add();
    for (uint32_t i = 0; i < 4; ++i) {
      module_.outputs.push_back({ir::OutputKind::Color, ir::Stage::Fragment, "o" + std::to_string(i), i,
                                 values_[values_.size() - 1 - i]});
    }
  }
  const ir::Module& module() const { return module_; }

private:
  size_t pick(size_t n) { return random_() % n; }

  ValueId of(Type type) {
    for (;;) {
      const ValueId id = values_[pick(values_.size())];
      if (module_.dag[id].type == type) return id;
    }
  }

  /// A loop that carries two numbers, with some operations in a round; of few rounds, or of very many.
  void loop() {
    ir::Dag& dag = module_.dag;
    ++depth_;
    const uint32_t own = dag.openLoop();
    const double first = static_cast<double>(pick(4)) - 2;
    const double most = depth_ == 1 && pick(4) == 0 ? 65 + static_cast<double>(pick(300)) : 1 + pick(6);
    const ValueId past = dag.constant(Type::Int, {first + most});
    ValueId end = pick(2) == 0 ? past : integer(false);
    end = dag.make(Op::Select, {dag.make(Op::IntLess, {past, end}), past, end});
    const ValueId index = dag.input({ir::InputKind::LoopIndex,
                                     "round",
                                     Type::Int,
                                     ir::Rate::Material,
                                     {first, first + most - 1},
                                     0,
                                     own});
    const Type types[] = {Type::Float, pick(2) == 0 ? Type::Float : Type::Vec3};
    ValueId carried[2], begin[2];
    for (uint32_t k = 0; k < 2; ++k) {
      ir::Input input{
          ir::InputKind::LoopValue, "c" + std::to_string(k), types[k], ir::Rate::Material, {}, 0, own};
      input.index = k;
      begin[k] = of(types[k]);
      carried[k] = dag.input(input);
    }
    const size_t outside = values_.size();
    for (int i = 0; i < 3; ++i) values_.insert(values_.end(), {carried[0], carried[1], number(index)});
    for (size_t i = 2 + pick(6); i > 0; --i) add();
    ValueId chain = dag.make(Op::Loop, {end, index});
    for (size_t k = 0; k < 2; ++k) {
      ValueId next = of(types[k]);
      if (pick(3) == 0) next = dag.add(carried[k], dag.mul(next, dag.constant(0.5)));
      if (pick(3) == 0) next = dag.make(Op::Fract, {next});
      chain = dag.make(Op::Carry, {chain, begin[k], next, carried[k]});
    }
    values_.resize(outside);
    for (uint32_t k = 0; k < 2; ++k) values_.push_back(dag.carried(chain, k));
    --depth_;
  }

  void add() {
    if (loops_ && depth_ < 2 && pick(10) == 0) return loop();
    const Op op = static_cast<Op>(pick(ir::kOpCount));
    if (ir::facts(op).kind == ir::Kind::Surroundings) return add();
    ir::Dag& dag = module_.dag;
    const Type type = pick(2) == 0 ? Type::Float : Type::Vec3;
    const ValueId a = of(type);
    // The same operand often: that is where intervals know more.
    const ValueId b = pick(3) == 0 ? a : of(type);
    switch (ir::info(op).signature) {
      case ir::Signature::Map: {
        const ValueId lo = op == Op::Clamp ? dag.constant(type, {-1, -1, -1}) : of(type);
        const ValueId args[] = {a, op == Op::Clamp ? lo : b,
                                op == Op::Clamp ? dag.constant(type, {1, 1, 1}) : of(type)};
        values_.push_back(dag.make(op, std::span(args, static_cast<size_t>(ir::info(op).arity))));
        break;
      }
      case ir::Signature::Reduce2: values_.push_back(dag.make(op, {a, b})); break;
      case ir::Signature::Cross: values_.push_back(dag.make(op, {of(Type::Vec3), of(Type::Vec3)})); break;
      case ir::Signature::Length:
      case ir::Signature::Same: values_.push_back(dag.make(op, {a})); break;
      case ir::Signature::Compare:
      case ir::Signature::Select: values_.push_back(dag.make(Op::Select, {comparison(op), a, b})); break;
      case ir::Signature::Logic: values_.push_back(dag.make(Op::Select, {logic(op), a, b})); break;
      case ir::Signature::Special: special(op); break;
      case ir::Signature::Whole:
      case ir::Signature::Shift:
      case ir::Signature::WholeTest: wholes(op); break;
    }
    // x + (k - x) * t and its kin.
    if (pick(6) == 0) values_.push_back(dag.add(a, dag.mul(dag.sub(b, a), of(type))));
    if (pick(6) == 0) values_.push_back(dag.add(dag.mul(a, of(type)), dag.sub(b, a)));
    if (pick(6) == 0) values_.push_back(dag.sub(a, dag.mul(a, of(type))));
  }

  ValueId comparison(Op op) {
    return module_.dag.make(op == Op::Select ? Op::Less : op, {of(Type::Float), of(Type::Float)});
  }

  ValueId logic(Op op) {
    const ValueId args[] = {comparison(Op::Less), comparison(Op::LessEqual)};
    return module_.dag.make(op, std::span(args, static_cast<size_t>(ir::info(op).arity)));
  }

  void special(Op op) {
    ir::Dag& dag = module_.dag;
    if (op == Op::Construct) {
      values_.push_back(dag.construct(Type::Vec3, {of(Type::Float), of(Type::Float), of(Type::Float)}));
    } else if (op == Op::Swizzle) {
      const int chosen[] = {static_cast<int>(pick(3)), 0, static_cast<int>(pick(3))};
      values_.push_back(dag.swizzle(of(Type::Vec3), chosen));
    } else {
      values_.push_back(number(integer(op == Op::ToUInt || op == Op::FromUInt || op == Op::AsInt)));
    }
  }

  /// An integer that is made of a float, or of one of the other kind.
  ValueId integer(bool without_sign) {
    ir::Dag& dag = module_.dag;
    const double most = pick(2) == 0 ? 100 : 2e9;
    const ValueId low = dag.constant(without_sign ? 0 : -most);
    const ValueId x = dag.make(Op::Clamp, {of(Type::Float), low, dag.constant(most)});
    const ValueId made = dag.make(without_sign ? Op::ToUInt : Op::ToInt, {x});
    return pick(4) != 0   ? made
           : without_sign ? dag.make(Op::AsUInt, {integer(false)})
                          : dag.make(Op::AsInt, {integer(true)});
  }

  ValueId number(ValueId integer) {
    return module_.dag.make(module_.dag[integer].type == Type::Int ? Op::FromInt : Op::FromUInt, {integer});
  }

  /// Some of them in a row, so that intervals meet intervals of integers.
  void wholes(Op op) {
    ir::Dag& dag = module_.dag;
    const bool ints = op == Op::IntDiv || op == Op::IntLess || op == Op::IntShiftRight;
    const bool uints = op == Op::UIntDiv || op == Op::UIntLess || op == Op::UIntShiftRight;
    const bool without_sign = uints || (!ints && pick(2) == 0);
    const Type type = without_sign ? Type::UInt : Type::Int;
    constexpr Op kTwo[] = {Op::WholeAdd, Op::WholeSub, Op::WholeMul, Op::BitAnd, Op::BitOr, Op::BitXor};
    ValueId x = integer(without_sign);
    for (size_t i = pick(3); i > 0; --i) {
      const ValueId other =
          pick(2) == 0 ? dag.constant(type, {static_cast<double>(pick(1000)) - 500}) : integer(without_sign);
      x = dag.make(kTwo[pick(6)], {x, other});
    }
    ValueId y = integer(without_sign);
    if (ir::info(op).signature == ir::Signature::Shift)
      y = dag.make(Op::BitAnd, {integer(true), dag.uinteger(static_cast<uint32_t>(pick(32)))});
    if (op == Op::IntDiv || op == Op::UIntDiv) y = dag.make(Op::BitOr, {y, dag.constant(type, {1})});
    const ValueId args[] = {x, y};
    const ValueId made = dag.make(op, std::span(args, static_cast<size_t>(ir::info(op).arity)));
    if (ir::info(op).signature == ir::Signature::WholeTest)
      values_.push_back(dag.make(Op::Select, {made, of(Type::Float), of(Type::Float)}));
    else
      values_.push_back(number(made));
  }

  std::mt19937 random_;
  bool loops_;
  int depth_ = 0;
  ir::Module module_;
  std::vector<ValueId> values_;
};

TEST(IntervalSoundness, RandomDags) {
  for (uint32_t seed = 0; seed < 400; ++seed) {
    const RandomDag random(seed);
    expectSound(random.module(), {}, 100, "seed " + std::to_string(seed));
    expectSound(random.module(), {analysis::Arithmetic::Vulkan, 1e4}, 100, "seed " + std::to_string(seed));
  }
}

TEST(IntervalSoundness, RandomLoops) {
  size_t loops = 0;
  for (uint32_t seed = 0; seed < 300; ++seed) {
    const RandomDag random(seed, true);
    const std::string name = "seed " + std::to_string(seed);
    const ir::Loops found(random.module().dag, everything(random.module()));
    ASSERT_FALSE(found.broken()) << name;
    loops += found.all().size();
    expectSound(random.module(), {}, 40, name);
    expectSound(random.module(), {analysis::Arithmetic::Vulkan, 1e4}, 40, name);
  }
  EXPECT_GT(loops, 300U);
}

/// What is there of a loop's body alone is evaluated with the whole loop.
TEST(IntervalSoundness, PartsOfLoops) {
  for (uint32_t seed = 0; seed < 100; ++seed) {
    const ir::Module module = RandomDag(seed, true).module();
    Intervals whole(module);
    whole.run();
    const std::vector<ValueId> all = everything(module);
    for (const ValueId id : all) {
      Intervals part(module);
      part.run(ir::reachable(module.dag, {{id}}));
      for (int c = 0; c < std::min(ir::componentCount(module.dag[id].type), 4); ++c)
        ASSERT_EQ(part.at(id, c), whole.at(id, c)) << "seed " << seed << " %" << id;
    }
  }
}

TEST(IntervalSoundness, AWrongIntervalIsFound) {
  ir::Module module;
  ir::Dag& dag = module.dag;
  const ValueId x = dag.input({ir::InputKind::Parameter, "x", Type::Float, ir::Rate::Material, {0, 1}, 0, 0});
  const ValueId y = dag.sub(dag.constant(1), x);
  module.outputs.push_back({ir::OutputKind::Color, ir::Stage::Fragment, "o", 0, y});
  Intervals intervals(module);
  analysis::Ranges wrong;
  wrong.fill({0, 0.999, false});
  intervals.fix(y, wrong);
  intervals.run();
  std::string what;
  EXPECT_GT(violations(module, intervals, 100, 1, what), 0U);
}

TEST(IntervalSoundness, Nodes) {
  const lang::Library library = lang::Library::embedded();
  for (const std::string_view name : library.names(lang::DeclKind::Node)) {
    if (!drawable(**library.node(name))) continue;
    const NodeModule made = nodeModule(**library.node(name), {});
    // The geometry's cosines are rounded: inputs that were computed.
    expectSound(made.module, {analysis::Arithmetic::Vulkan, analysis::kSceneLimit, true}, 5000,
                std::string(name));
  }
}

/// The lowered modules of every material of the examples.
template <class F>
void eachExample(F f) {
  const lang::Library library = lang::Library::embedded();
  size_t count = 0;
  for (const auto& file : findFiles(sourceFolder() / "examples", ".gltf")) {
    const Result<material::Document> document = readMaterials(file.string());
    ASSERT_TRUE(document) << file;
    for (const material::Material& material : document->materials) {
      if (hasError(material.diagnostics)) continue;
      for (const char* name : {"forward", "surface", "bsdf"}) {
        gltf::VertexAttributes attributes;
        attributes.normal = attributes.tangent = true;
        attributes.texCoord = {true, true, false, false};
        BuildSetup options;
        options.template_name = name;
        Diagnostics warnings;
        graph::Graph graph = buildGraph(material, attributes, options, warnings);
        ASSERT_FALSE(hasError(graph::check(graph, library))) << file << " " << name;
        Result<ir::Module> module = lower::lower(graph, library, {});
        ASSERT_TRUE(module);
        f(*module, file.filename().string() + " " + material.name + " " + name);
        ++count;
      }
    }
  }
  EXPECT_GT(count, 10U);
}

TEST(IntervalSoundness, Examples) {
  eachExample([](const ir::Module& module, const std::string& name) {
    expectSound(module, {analysis::Arithmetic::Vulkan, analysis::kSceneLimit}, 1000, name);
  });
}

TEST(IntervalSoundness, PlacedModules) {
  eachExample([](ir::Module& module, const std::string& name) {
    passes::runPipeline(module, {});
    // What the preshader gives cannot be drawn at random beside the parameters, so only its own values are
    // looked at.
    module.outputs.clear();
    module.varyings.clear();
    expectSound(module, {analysis::Arithmetic::Vulkan, analysis::kSceneLimit}, 1000, name);
  });
}

/// Taking idle operations away changes no output, to the bit.
TEST(IntervalSoundness, SimplifiedModulesGiveTheSame) {
  eachExample([](const ir::Module& module, const std::string& name) {
    ir::Module simpler = module;
    passes::simplifyRanges(simpler);
    std::vector<Floats> before, after;
    for (int i = 0; i < 300; ++i) {
      const World world(static_cast<uint64_t>(i), analysis::kSceneLimit);
      evaluate(module, everything(module), world, before);
      evaluate(simpler, everything(simpler), world, after);
      for (size_t o = 0; o < module.outputs.size(); ++o) {
        const Floats& x = before[module.outputs[o].value];
        const Floats& y = after[simpler.outputs[o].value];
        for (size_t c = 0; c < 4; ++c)
          ASSERT_TRUE(x[c] == y[c] || (std::isnan(x[c]) && std::isnan(y[c])))
              << name << " " << module.outputs[o].name << ": " << x[c] << ", " << y[c];
      }
    }
  });
}

}  // namespace
}  // namespace lacquer::test::soundness_test
