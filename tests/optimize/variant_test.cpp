// A form of the front written as a variant of its node: off by no more than the front says, in exact
// arithmetic.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "lang/body_text.h"
#include "lang/library.h"
#include "lower/inline.h"
#include "optimize/approximate.h"
#include "optimize/exact.h"
#include "optimize/optimize.h"

namespace lacquer::test::variant_test {
namespace {

using ir::Op;

struct Subject {
  const char* name;
  const char* text;  ///< to which variants are added
};

const Subject kNodes[] = {
    {"glow", R"(
/// A term of one number.
/// source: a test
node glow(float x in [0, 1]) -> float in [0, 2] {
    return exp2(0.3 * log2(1 + x)) / (1 + sqrt(x + 1));
}
)"},
    {"tinted", R"(
/// A vector of one number, and another result.
/// source: a test
node tinted(vec3 tint in [0, 1], float cosine in [0, 1], bool on) -> (vec3 color in [0, 1], float rest) {
    float path = inversesqrt(0.6 + 0.4 * cosine * cosine);
    float lost = exp2(-0.4 * path * log2(2 + path)) * 0.5;
    return (on ? mix(tint, vec3(1), lost) : vec3(0), -(lost - path) * 0.25);
}
)"},
};

const Subject kSteep = {"steep", R"(
/// A term that falls like a quotient, and has none.
/// source: a test
node steep(float x in [0, 1]) -> float in [0, 2] {
    return exp2(-1.7 * log2(1 + 9 * x)) * sqrt(1 + 0.5 * sqrt(x + 0.1));
}
)"};

lang::Library libraryOfText(const std::string& text) {
  auto library = lang::Library::fromFiles({{"t.node", text}});
  EXPECT_TRUE(library);
  for (const Diagnostic& diagnostic : library->checkAll()) ADD_FAILURE() << format(diagnostic);
  return std::move(*library);
}

ir::Module moduleOfNode(const lang::NodeDecl& node, std::string_view variant) {
  ir::Module module;
  std::vector<ir::ValueId> arguments;
  for (const lang::Param& param : node.params) {
    ir::Range range = param.range;
    if (param.type == ir::Type::Bool) range = {{0, 1}, 0};
    const auto index = static_cast<uint32_t>(module.parameters.size());
    module.parameters.push_back({std::string(param.name), param.type, {}, range, {}});
    arguments.push_back(module.dag.input({ir::InputKind::Parameter, std::string(param.name), param.type,
                                          ir::Rate::Fragment, range, 0, index}));
  }
  lower::Inliner inliner(module.dag);
  for (const ir::ValueId result : inliner.call(node, variant, arguments))
    module.outputs.push_back({ir::OutputKind::Color, ir::Stage::Fragment, "", 0, result});
  return module;
}

/// The outputs of a module where its inputs, by name, are these.
std::vector<ExactVector> outputsOf(const ir::Module& module,
                                   const std::map<std::string, ExactVector>& inputs) {
  optimize::Constants constants;
  const optimize::Plan plan = optimize::planOf(module, constants);
  std::vector<ExactVector> values(plan.nodes.size());
  for (size_t at = 0; at < plan.nodes.size(); ++at) {
    const optimize::Node& node = plan.nodes[at];
    if (node.op == Op::Input) {
      values[at] = inputs.at(module.dag.inputOf(node.source).name);
      continue;
    }
    std::vector<const ExactVector*> operands;
    std::vector<ir::Type> types;
    for (const optimize::Ref operand : node.operands()) {
      operands.push_back(&values[operand]);
      types.push_back(plan.nodes[operand].type);
    }
    values[at] = evaluate(node, operands, types, constants);
  }
  std::vector<ExactVector> outputs;
  for (const optimize::Ref root : plan.roots) outputs.push_back(values[root]);
  return outputs;
}

/// How far two modules of one node are apart at random points, as the front counts it.
double apart(const lang::NodeDecl& node, const ir::Module& a, const ir::Module& b) {
  std::mt19937_64 random(11);
  double most = 0;
  for (int point = 0; point < 400; ++point) {
    std::map<std::string, ExactVector> inputs;
    for (const lang::Param& param : node.params) {
      ExactVector& value = inputs[std::string(param.name)];
      for (Exact& x : value) {
        const double u = static_cast<double>(random() % 65537) / 65536;
        x = Exact(param.type == ir::Type::Bool ? static_cast<double>(random() % 2) : u);
      }
    }
    const std::vector<ExactVector> x = outputsOf(a, inputs);
    const std::vector<ExactVector> y = outputsOf(b, inputs);
    for (size_t i = 0; i < x.size(); ++i) {
      const auto width = static_cast<size_t>(ir::componentCount(node.results[i].type));
      for (size_t c = 0; c < width; ++c) {
        const double of = x[i][c].rounded();
        most = std::max(most, std::abs(of - y[i][c].rounded()) / std::max(1.0, std::abs(of)));
      }
    }
  }
  return most;
}

TEST(Variants, AreOffByNoMoreThanTheySay) {
  for (const Subject& subject : kNodes) {
    const lang::Library plain = libraryOfText(subject.text);
    const lang::NodeDecl& node = **plain.node(subject.name);
    const ir::Module reference = moduleOfNode(node, "");
    constexpr double kErrors[] = {1e-4, 1e-3, 1e-2, 0.1};
    const std::vector<optimize::Candidate> front = optimize::front(reference, {1, 0, nullptr}, kErrors);
    EXPECT_GT(front.size(), 1U) << subject.name;
    std::string text = subject.text;
    for (size_t i = 0; i < front.size(); ++i) {
      const auto body = lang::bodyText(front[i].module, node, "proved");
      ASSERT_TRUE(body) << subject.name;
      text += fmt::format("/// A form.\nvariant form{} {{\n{}}}\n", i, *body);
    }
    const lang::Library with = libraryOfText(text);
    const lang::NodeDecl& tuned = **with.node(subject.name);
    ASSERT_EQ(tuned.variants.size(), front.size());
    for (size_t i = 0; i < front.size(); ++i) {
      const double off = apart(tuned, reference, moduleOfNode(tuned, fmt::format("form{}", i)));
      EXPECT_LE(off, front[i].outcome.error + 1e-14) << text;
      // An error that is far from it says little.
      EXPECT_GE(off, front[i].outcome.error / 50) << text;
    }
  }
}

/// What polynomials take many products for a quotient does at a lower cost, and keeps to its error.
TEST(Variants, DivideWhereThatIsCheaper) {
  const lang::Library plain = libraryOfText(kSteep.text);
  const lang::NodeDecl& node = **plain.node(kSteep.name);
  const ir::Module reference = moduleOfNode(node, "");
  std::string text = kSteep.text;
  std::vector<double> errors;
  for (const double most : {1e-2, 3e-2}) {
    const auto form = optimize::approximate(reference, optimize::families()[0], most);
    ASSERT_TRUE(form) << most;
    const auto body = lang::bodyText(form->module, node, "proved");
    ASSERT_TRUE(body) << most;
    EXPECT_NE(body->find(" / "), std::string::npos) << *body;
    EXPECT_LE(form->error, most);
    text += fmt::format("/// A form.\nvariant form{} {{\n{}}}\n", errors.size(), *body);
    errors.push_back(form->error);
  }
  const lang::Library with = libraryOfText(text);
  const lang::NodeDecl& tuned = **with.node(kSteep.name);
  for (size_t i = 0; i < errors.size(); ++i) {
    const double off = apart(tuned, reference, moduleOfNode(tuned, fmt::format("form{}", i)));
    EXPECT_LE(off, errors[i]) << text;
    EXPECT_GE(off, errors[i] / 10) << text;
  }
}

}  // namespace
}  // namespace lacquer::test::variant_test
