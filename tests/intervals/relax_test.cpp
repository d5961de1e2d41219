// What may be at half precision: the rules for errors, the bounds of small modules, and whole materials whose
// relaxed operations are rounded at random, which must keep to the bound that is proved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "analysis/error_math.h"
#include "analysis/relax.h"
#include "eval/evaluate.h"
#include "lacquer/generate.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "stress/attack.h"
#include "stress/subject.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test::relax_test {
namespace {

using analysis::Error;
using analysis::Range;
using ir::Op;
using ir::Type;
using ir::ValueId;

// -- the rules --

/// Random ranges, numbers in them, and numbers as far off as errors allow.
class Numbers {
public:
  explicit Numbers(uint64_t seed) : engine_(seed) {}

  double in(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine_); }
  Range range(bool positive) {
    const double a = in(positive ? 0.01 : -3, 3);
    const double b = in(0, 1) < 0.3 && !positive ? 0 : in(positive ? 0.01 : -3, 3);
    return {std::min(a, b), std::max(a, b), false};
  }
  Error error(double scale) { return {in(0, 1) < 0.3 ? 0 : in(0, scale), in(0, 1) < 0.3 ? 0 : in(0, scale)}; }
  double of(const Range& r) {
    const double u = in(0, 1);
    return u < 0.2 ? r.lo : u < 0.4 ? r.hi : in(r.lo, r.hi);
  }
  double off(double x, const Error& e) {
    const double u = in(0, 1);
    const double by = e.part * std::abs(x) + e.amount;
    return x + by * (u < 0.4 ? -1 : u < 0.8 ? 1 : in(-1, 1));
  }

private:
  std::mt19937_64 engine_;
};

struct Rule {
  const char* name;
  bool positive;  ///< operands are not near zero
  double (*f)(double, double);
  Error (*error)(const Range&, const Error&, const Range&, const Error&);
};

const Rule kRules[] = {
    {"sum", false, [](double x, double y) { return x + y; }, analysis::errorOfSum},
    {"product", false, [](double x, double y) { return x * y; }, analysis::errorOfProduct},
    {"quotient", true, [](double x, double y) { return x / y; },
     [](const Range&, const Error& ex, const Range& y, const Error& ey) {
       return analysis::errorOfQuotient(ex, y, ey);
     }},
    {"minimum", false, [](double x, double y) { return std::min(x, y); },
     [](const Range&, const Error& ex, const Range&, const Error& ey) {
       return analysis::errorOfEither(ex, ey);
     }},
    {"root", true, [](double x, double) { return std::sqrt(x); },
     [](const Range& x, const Error& ex, const Range&, const Error&) {
       return analysis::errorOfRoot(x, ex);
     }},
    {"inverse root", true, [](double x, double) { return 1 / std::sqrt(x); },
     [](const Range& x, const Error& ex, const Range&, const Error&) {
       return analysis::errorOfInverseRoot(x, ex);
     }},
    {"power", false, [](double x, double) { return std::exp2(x); },
     [](const Range& x, const Error& ex, const Range&, const Error&) {
       return analysis::errorOfPower(x, ex);
     }},
};

TEST(Errors, HoldWhatOperationsMakeOfThem) {
  for (const Rule& rule : kRules) {
    Numbers numbers(7);
    size_t finite = 0;
    double closest = 0;
    for (int i = 0; i < 20000; ++i) {
      const Range x = numbers.range(rule.positive);
      const Range y = numbers.range(rule.positive);
      const Error ex = numbers.error(0.05);
      const Error ey = numbers.error(0.05);
      const Error e = rule.error(x, ex, y, ey);
      if (!e.finite()) continue;
      ++finite;
      for (int k = 0; k < 20; ++k) {
        const double a = numbers.of(x);
        const double b = numbers.of(y);
        const double exact = rule.f(a, b);
        const double by = std::abs(rule.f(numbers.off(a, ex), numbers.off(b, ey)) - exact);
        const double allowed = e.part * std::abs(exact) + e.amount;
        ASSERT_LE(by, allowed * (1 + 1e-12) + 1e-14)
            << rule.name << " of " << a << " in [" << x.lo << ", " << x.hi << "] and " << b << " in [" << y.lo
            << ", " << y.hi << "]";
        if (allowed > 1e-6) closest = std::max(closest, by / allowed);
      }
    }
    EXPECT_GT(finite, 5000U) << rule.name;
    EXPECT_GT(closest, 0.9) << rule.name;  // a bound that nothing comes near is of little use
  }
}

TEST(Errors, RoundingHoldsWithinTheRangeOfMediump) {
  const Error once = analysis::roundedError({0.5, 1, false}, {});
  EXPECT_EQ(once.part, 0x1p-10);
  EXPECT_EQ(once.amount, 0);
  EXPECT_EQ(analysis::roundedError({0, 1, false}, {}).amount, 0x1p-14);  // what is small may become 0
  EXPECT_EQ(analysis::roundedError({0, 0, false}, {}).amount, 0);
  EXPECT_GT(analysis::roundedError({0.00007, 1, false}, {0.2, 0}).amount, 0);  // small with its error
  EXPECT_FALSE(analysis::roundedError({0, 16384, false}, {}).finite());
  EXPECT_FALSE(analysis::roundedError({0, 1, true}, {}).finite());
  EXPECT_TRUE(analysis::roundedError({0, 16000, false}, {}).finite());
}

// -- small modules --

class Relaxed : public testing::Test {
protected:
  ValueId input(const char* name, ir::Interval range, Type type = Type::Float) {
    return dag().input({ir::InputKind::FrontFacing, name, type, ir::Rate::Fragment, range, 0, next_++});
  }
  /// A field of a block: what is open is light where colours are linear in it.
  ValueId field(const char* name, ir::Interval range, Type type = Type::Float) {
    if (module_.blocks.empty()) module_.blocks.push_back({ir::BlockRole::Frame, "Frame", "frame", {}});
    module_.blocks[0].fields.push_back({name, type, 0, range, ""});
    const auto at = static_cast<uint32_t>(module_.blocks[0].fields.size() - 1);
    return dag().input({ir::InputKind::BlockField, name, type, ir::Rate::Fragment, range, 0, at});
  }
  ir::Dag& dag() { return module_.dag; }
  ValueId number(double x) { return dag().constant(x); }
  void color(ValueId id) { module_.outputs = {{ir::OutputKind::Color, ir::Stage::Fragment, "o", 0, id}}; }
  double bound(std::initializer_list<ValueId> ids) { return analysis::relaxedBound(module_, ids); }
  std::vector<ValueId> chosen(double error) { return analysis::relax(module_, error).values; }

  ir::Module module_;
  uint32_t next_ = 0;
};

constexpr double kUnit = 0x1p-10;

TEST_F(Relaxed, AProductIsRoundedAndItsOperandsAre) {
  const ValueId product = dag().mul(field("a", {0.5, 1}), field("b", {0.5, 1}));
  color(product);
  EXPECT_NEAR(bound({product}), 3 * kUnit, 4 * kUnit * kUnit);
  EXPECT_EQ(bound({}), 0);
}

TEST_F(Relaxed, WhatIsAtHalfPrecisionIsNotRoundedAgain) {
  const ValueId first = dag().mul(field("a", {0.5, 1}), field("b", {0.5, 1}));
  const ValueId second = dag().mul(first, field("c", {0.5, 1}));
  color(second);
  EXPECT_NEAR(bound({first, second}), 5 * kUnit, 20 * kUnit * kUnit);
  const std::vector<ValueId> both{first, second};
  EXPECT_EQ(chosen(0.01), both);
  EXPECT_TRUE(chosen(0.001).empty());
}

TEST_F(Relaxed, NoOperationByItself) {
  const ValueId product = dag().mul(field("a", {0.5, 1}), field("b", {0.5, 1}));
  color(product);
  EXPECT_TRUE(chosen(0.1).empty());
}

TEST_F(Relaxed, ADifferenceKeepsTheAmountAndNotThePart) {
  const ValueId product = dag().mul(field("a", {0.5, 1}), field("b", {0.5, 1}));
  color(dag().make(Op::InverseSqrt, {dag().sub(number(1.001), product)}));
  EXPECT_FALSE(std::isfinite(bound({product})));  // what is left of 1 may be all error
  color(dag().make(Op::InverseSqrt, {dag().sub(number(2), product)}));
  EXPECT_LT(bound({product}), 3.1 * kUnit);
}

TEST_F(Relaxed, ConditionsDoNotFlip) {
  const ValueId product = dag().mul(field("a", {0.5, 1}), field("b", {0.5, 1}));
  const ValueId condition = dag().make(Op::Less, {product, number(0.7)});
  color(dag().make(Op::Select, {condition, product, number(0)}));
  EXPECT_FALSE(std::isfinite(bound({product})));
  const ValueId other = dag().mul(product, field("c", {0.5, 1}));
  color(other);
  module_.outputs.push_back({ir::OutputKind::Discard, ir::Stage::Fragment, "d", 0, condition});
  EXPECT_FALSE(std::isfinite(bound({product})));
  EXPECT_TRUE(std::isfinite(bound({other})));
}

TEST_F(Relaxed, LightIsTheMeasure) {
  const ValueId share = dag().mul(field("a", {0.5, 1}), field("b", {0.5, 1}));
  const ValueId light = field("radiance", {0, std::numeric_limits<double>::infinity()});
  const ValueId lit = dag().mul(share, light);
  color(lit);
  EXPECT_EQ(analysis::lightsOf(module_), std::vector<ValueId>{light});
  EXPECT_LT(bound({share}), 3.1 * kUnit);
  EXPECT_FALSE(std::isfinite(bound({lit})));  // nothing says that half precision holds it
  // What colours are not linear in is no light.
  color(dag().mul(share, dag().mul(light, light)));
  EXPECT_TRUE(analysis::lightsOf(module_).empty());
  color(dag().mul(share, dag().make(Op::Sqrt, {light})));
  EXPECT_TRUE(analysis::lightsOf(module_).empty());
}

TEST_F(Relaxed, AFactorWithoutBoundMagnifiesWhatMayBecomeZero) {
  const ValueId peak = field("peak", {0, 1e6});
  const ValueId small = dag().mul(field("a", {0, 1}), field("b", {0, 1}));
  const ValueId large = dag().mul(field("c", {0.5, 1}), field("d", {0.5, 1}));
  color(dag().make(Op::Sqrt, {dag().add(number(1), dag().mul(peak, small))}));
  EXPECT_FALSE(bound({small}) < 0.1);
  color(dag().make(Op::Sqrt, {dag().add(number(1), dag().mul(peak, large))}));
  EXPECT_LT(bound({large}), 3.1 * kUnit);
}

// -- whole materials --

struct Made {
  std::string name;
  ir::Module module;
};

/// The examples and the works that are measured, placed, with one directional light.
void eachMaterial(lower::ParameterMode mode, double error, const std::function<void(Made&)>& f) {
  const lang::Library library = lang::Library::embedded();
  std::vector<std::filesystem::path> files = findFiles(sourceFolder() / "examples", ".gltf");
  for (const auto& file : findFiles(sourceFolder() / "bench/works", ".gltf")) files.push_back(file);
  for (const auto& file : files) {
    const Result<material::Document> document = readMaterials(file.string());
    ASSERT_TRUE(document) << file;
    for (const material::Material& material : document->materials) {
      if (hasError(material.diagnostics)) continue;
      gltf::VertexAttributes attributes;
      attributes.normal = attributes.tangent = true;
      attributes.texCoord = {true, true, false, false};
      Diagnostics warnings;
      const graph::Graph graph = buildGraph(material, attributes, {}, warnings);
      lower::LowerOptions options;
      options.parameters = mode;
      options.evaluable = true;
      Result<ir::Module> module = lower::lower(graph, library, options);
      ASSERT_TRUE(module);
      passes::PipelineOptions pipeline;
      pipeline.lights = {false, {{"directional", 1}}};
      pipeline.relaxed = error;
      passes::runPipeline(*module, pipeline);
      Made made{file.filename().string() + " " + material.name, std::move(*module)};
      f(made);
    }
  }
}

/// Light of at most 1, which is the bound's measure.
void dim(const ir::Module& module, eval::Bindings& bindings) {
  const auto atMostOne = [](eval::Columns& columns, const std::string& name) {
    const auto found = columns.find(name);
    if (found == columns.end()) return;
    for (double& x : found->second.values) x = std::min(x, 1.0);
  };
  for (const ValueId id : analysis::lightsOf(module)) {
    const bool texel = ir::readsTexture(module.dag[id].op);
    const ir::Input& input = module.dag.inputOf(texel ? module.dag[id].args[0] : id);
    if (texel) {
      eval::Sampler& sampler = bindings.textures[module.textures[input.field].name];
      sampler = [bright = sampler](size_t point, const std::array<double, 3>& at, double lod) {
        std::array<double, 4> texel = bright(point, at, lod);
        for (double& x : texel) x = std::clamp(x, -1.0, 1.0);
        return texel;
      };
    } else {
      atMostOne(bindings.columns, input.name);
      for (eval::Columns& light : bindings.lights) atMostOne(light, input.name);
    }
  }
}

/// The largest change of a colour's component, as a part of it or of 1, over random points; what is no number
/// without rounding counts nothing.
double largestChange(const Made& made, int points) {
  auto subject = stress::materialSubject(made.name, made.module, {});
  EXPECT_TRUE(subject) << made.name;
  if (!subject) return 0;
  std::vector<double> samples;
  stress::drawSamples(**subject, 5, 0, static_cast<size_t>(points), samples);
  eval::Bindings bindings = (*subject)->inputs(samples, static_cast<size_t>(points));
  dim(made.module, bindings);
  std::vector<ValueId> roots;
  for (const ir::Output& output : made.module.outputs) {
    if (output.kind == ir::OutputKind::Color) roots.push_back(output.value);
  }
  const size_t count = static_cast<size_t>(points) * (*subject)->lanes;
  const Result<eval::Program> program = eval::compile(made.module, roots, bindings, count);
  EXPECT_TRUE(program) << made.name;
  if (!program) return 0;
  const auto exact = eval::run<double>(*program, bindings, count);
  double largest = 0;
  for (const uint64_t seed : {1U, 2U, 3U, 4U}) {
    const auto rounded = eval::runRelaxed(*program, bindings, count, seed * 0x9E3779B97F4A7C15U);
    for (size_t r = 0; r < roots.size(); ++r) {
      for (size_t i = 0; i < exact[r].size(); ++i) {
        if (!std::isfinite(exact[r][i])) continue;
        const double by = std::abs(rounded[r][i] - exact[r][i]) / std::max(std::abs(exact[r][i]), 1.0);
        largest = std::isnan(by) ? by : std::max(largest, by);
        if (std::isnan(largest)) return std::numeric_limits<double>::infinity();
      }
    }
  }
  return largest;
}

TEST(RelaxedMaterials, KeepToTheBound) {
  for (const auto mode : {lower::ParameterMode::Uniform, lower::ParameterMode::Baked}) {
    size_t relaxed = 0, close = 0;
    eachMaterial(mode, 0.05, [&](Made& made) {
      if (!made.module.dag.anyRelaxed()) return;
      ++relaxed;
      EXPECT_LE(made.module.relaxed_bound, 0.05) << made.name;
      const double change = largestChange(made, 1000);
      EXPECT_LE(change, made.module.relaxed_bound * (1 + 1e-9)) << made.name;
      close += change > made.module.relaxed_bound / 20 ? 1 : 0;
    });
    EXPECT_GT(relaxed, 10U);
    EXPECT_GT(close, relaxed / 2);  // else the points or the rounding would show nothing
  }
}

}  // namespace
}  // namespace lacquer::test::relax_test
