// Whole texts in each dialect, compared with files (LACQUER_BLESS=1 renews them) and compiled.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/cases.h"
#include "targets/samples.h"

namespace lacquer::targets {

using ir::Stage;

namespace {

/// Prints a stage for every target, compares with expected/<name>.<stage>.<target> and compiles.
void expectTexts(const std::string& name, const ir::Module& module, Stage stage) {
  for (const Target target : kTextTargets) {
    SCOPED_TRACE(row(target).name);
    const std::string text = print(module, stage, target, "Printed by the tests.");
    const std::string file = fmt::format("tests/targets/expected/{}.{}.{}", name,
                                         stage == Stage::Vertex ? "vert" : "frag", row(target).name);
    test::expectFile(test::sourceFolder() / file, text);
    expectCompiles(text, stage, target);
    EXPECT_EQ(text, print(module, stage, target, "Printed by the tests.")) << "the same twice";
  }
}

}  // namespace

TEST(Dialect, LitVertex) { expectTexts("lit", litSample({}), Stage::Vertex); }
TEST(Dialect, LitFragment) { expectTexts("lit", litSample({}), Stage::Fragment); }
TEST(Dialect, FixedFragment) { expectTexts("fixed", fixedSample(), Stage::Fragment); }
TEST(Dialect, Lookups) { expectTexts("lookups", lookupsSample(), Stage::Fragment); }
TEST(Dialect, EveryOp) { expectTexts("every_op", everyOpSample(), Stage::Fragment); }

TEST(Dialect, ALightGroupRunsFromItsFirstLight) {
  for (const Target target : kTextTargets) {
    const std::string text = print(litSample({3, 2}), Stage::Fragment, target);
    const bool wgsl = target == Target::Wgsl;
    const char* loop = wgsl ? "for (var i = 3; i < 5; i++) {" : "for (int i = 3; i < 5; ++i) {";
    EXPECT_NE(text.find(loop), std::string::npos) << text;
    EXPECT_EQ(text.find("frame.light_count"), std::string::npos) << text;
    expectCompiles(text, Stage::Fragment, target);
  }
}

/// Prints one fragment output of a module that is not legalized: a text must be right all the same.
TEST(Dialect, FloatsBesideVectorsNeedNoPass) {
  for (const Target target : kTextTargets) {
    const ir::Module module = everyOpSample();
    expectCompiles(printText(module, schedule::schedule(module, Stage::Fragment), target, {}),
                   Stage::Fragment, target);
  }
}

TEST(Dialect, TheVersionIsTheFirstLine) {
  // WebGL 2 allows nothing before it, comments included.
  const std::string text = print(fixedSample(), Stage::Fragment, Target::Essl, "one\ntwo");
  EXPECT_TRUE(text.starts_with("#version 300 es\n// one\n// two\n\nprecision highp float;\n")) << text;
}

TEST(Dialect, CommentsStayComments) {
  const std::string text = print(fixedSample(), Stage::Fragment, Target::Glsl, "a\\\nb\rc\tvoid");
  EXPECT_TRUE(text.starts_with("#version 450\n// a/\n// b c void\n")) << text;
  EXPECT_NE(text.find("// odd name/: a line that must not continue /\n"), std::string::npos) << text;
}

TEST(Dialect, NothingUnusedIsDeclared) {
  for (const Target target : kTextTargets) {
    const std::string whole = print(fixedSample(), Stage::Fragment, target);
    // A root signature is the template's.
    const std::string text = whole.substr(target == Target::Hlsl ? whole.rfind("DESCRIPTORS_VOLATILE") : 0);
    for (const char* word :
         {"frame", "Frame", "sampler", "Sampler", "facing", "gl_FrontFacing", "SV_Position"}) {
      EXPECT_EQ(text.find(word), std::string::npos) << word << " in\n" << text;
    }
  }
}

/// A language may compute one operand alone where a language of nodes computes both, and derivatives are of
/// the neighbours, too: none stands behind a choice.
TEST(Dialect, DerivativesStandBeforeChoices) {
  Builder b;
  ir::Dag& dag = b.dag();
  const ir::ValueId position = b.attribute("POSITION", ir::Type::Vec4);
  b.position(position);
  const ir::ValueId uv = b.varying("uv", b.attribute("TEXCOORD_0", ir::Type::Vec2));
  const ir::ValueId image = b.texture("image", ir::Type::Texture2D);
  constexpr std::array kFirst = {0};
  const auto x = [&](double scale) {
    return dag.swizzle(dag.make(ir::Op::Mul, {uv, dag.constant(scale)}), kFirst);
  };
  const auto texel = [&](double scale) {
    return dag.make(ir::Op::Texture, {image, dag.make(ir::Op::Mul, {uv, dag.constant(scale)})});
  };
  const auto above = [&](ir::ValueId value) { return dag.make(ir::Op::Less, {dag.constant(0.5), value}); };
  const ir::ValueId both = dag.make(ir::Op::And, {above(x(3)), above(dag.swizzle(texel(2), kFirst))});
  const ir::ValueId either = dag.make(ir::Op::Or, {both, above(dag.make(ir::Op::DFdx, {x(5)}))});
  const ir::ValueId color = dag.make(ir::Op::Mul, {dag.constant(0.25), texel(7)});
  b.color("color", dag.make(ir::Op::Select, {either, color, texel(11)}));
  for (const Target target : kTextTargets) {
    const std::string text = print(b.module, Stage::Fragment, target);
    size_t lookups = 0;
    for (size_t from = 0; from < text.size();) {
      const size_t end = std::min(text.find('\n', from), text.size());
      const std::string line = text.substr(from, end - from);
      from = end + 1;
      bool derives = false;
      for (const char* word : {"texture(", "image.Sample(", "textureSample(", "dFdx(", "ddx(", "dpdx("})
        derives |= line.find(word) != std::string::npos;
      lookups += derives ? 1 : 0;
      for (const char* choice : {" ? ", "&&", "||", "select("})
        EXPECT_FALSE(derives && line.find(choice) != std::string::npos) << line;
    }
    EXPECT_EQ(lookups, 4u) << text;
    expectCompiles(text, Stage::Fragment, target);
  }
}

/// Direct3D has no Sample in a vertex shader; glslang takes it all the same.
TEST(Dialect, AVertexSamplesTheFirstLevel) {
  Builder b;
  const ir::ValueId at = b.attribute("POSITION", ir::Type::Vec4);
  const ir::ValueId uv = b.dag().swizzle(at, std::array{0, 1});
  const ir::ValueId uvz = b.dag().swizzle(at, std::array{0, 1, 2});
  const ir::ValueId texel = b.dag().make(ir::Op::Texture, {{b.texture("heights", ir::Type::Texture2D), uv}});
  const ir::ValueId shown =
      b.dag().make(ir::Op::TextureCompare, {{b.texture("depths", ir::Type::Texture2DShadow), uvz}});
  b.position(b.dag().mul(texel, shown));
  constexpr std::array kWanted = {
      std::pair{Target::Glsl, "textureLod(heights, in_position.xy, 0.0) * textureLod(depths, swizzle, 0.0)"},
      std::pair{Target::Hlsl,
                "heights.SampleLevel(heights_sampler, in_position.xy, 0.0) * depths.SampleCmpLevelZero("}};
  for (const auto& [target, wanted] : kWanted) {
    const std::string text = print(b.module, Stage::Vertex, target);
    EXPECT_NE(text.find(wanted), std::string::npos) << text;
  }
  for (const Target target : kTextTargets)
    expectCompiles(print(b.module, Stage::Vertex, target), Stage::Vertex, target);
}

TEST(Targets, RowsLieInTheOrderOfTheEnumeration) {
  ASSERT_EQ(rows().size(), 9U);
  for (const Row& of : rows()) EXPECT_EQ(row(of.id).name, of.name);
}

}  // namespace lacquer::targets
