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
    const std::string text = print(fixedSample(), Stage::Fragment, target);
    for (const char* word :
         {"frame", "Frame", "sampler", "Sampler", "facing", "gl_FrontFacing", "SV_Position"}) {
      EXPECT_EQ(text.find(word), std::string::npos) << word << " in\n" << text;
    }
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
