// What values/ cannot say: templates, and where assumptions are not stated.
#include "lower/inline.h"

#include <gtest/gtest.h>

#include <tuple>

#include "lang/dump.h"
#include "lang/library.h"

namespace lacquer::test {
namespace {

using ir::Dag;
using ir::Type;
using ir::ValueId;

lang::Library libraryOf(const std::string& text) {
  auto library = lang::Library::fromFiles({{"t.node", text}});
  EXPECT_TRUE(library);
  for (const Diagnostic& diagnostic : library->checkAll()) ADD_FAILURE() << format(diagnostic);
  return std::move(*library);
}

ValueId input(Dag& dag, std::string_view name, Type type) {
  return dag.input({ir::InputKind::Parameter, std::string(name), type, ir::Rate::Fragment, {}});
}

constexpr const char* kAssuming = R"(
/// D.
/// source: S
node halved(float x in [0, 1]) -> float {
    float y = sin(x);
    assume(y in [0, 0.9], "of an angle of at most 1");
    return y;
}
/// D.
/// source: S
node sure(float x in [0, 1]) -> float { return halved(x); }
/// D.
/// source: S
node under_if(float x) -> float {
    let y = 0.0;
    if (x > 0) { y = halved(x); }
    return y;
}
/// D.
/// source: S
node under_choice(float x) -> float { return x > 0 ? halved(x) : 0.0; }
/// D.
/// source: S
node behind_return(float x) -> float {
    if (x > 1) { return 1; }
    return halved(x);
}
/// D.
/// source: S
node known(float x) -> float {
    if (PI > 3) { return halved(x); }
    return 0;
}
)";

TEST(LowerInline, AssumptionsUnderAConditionAreNotStated) {
  const lang::Library library = libraryOf(kAssuming);
  for (const auto& [name, stated] : {std::pair{"sure", true},
                                     {"known", true},
                                     {"under_if", false},
                                     {"under_choice", false},
                                     {"behind_return", false}}) {
    Dag dag;
    const ValueId x = input(dag, "x", Type::Float);
    lower::Inliner(dag).call(**library.node(name), {}, {{x}});
    const auto fact = dag.assumed(dag.make(ir::Op::Sin, {x}));
    EXPECT_EQ(fact.has_value(), stated) << name;
    EXPECT_EQ(fact.value_or(ir::Interval{0, 0.9}), (ir::Interval{0, 0.9})) << name;
  }
}

TEST(LowerInline, TemplateParts) {
  const lang::Library library = libraryOf(R"(
/// D.
/// source: S
node split(vec2 v) -> (float first, float second) { return (v.x, v.y); }
/// D.
template small {
    block frame Frame frame { vec3 eye; float gain; }
    attribute vec2 UV;
    given vec2 scaled = UV * frame.gain;
    given parts = split(scaled);
    given bool front = gl_FrontFacing;
    port float level = parts.second * 2;
    output color vec4 shown = front ? vec4(frame.eye, level) : vec4(0);
}
)");
  const lang::TemplateDecl& decl = **library.template_("small");
  Dag dag;
  lower::Inliner inliner(dag);
  std::vector<ValueId> slots(decl.slots, ir::kNoValue);
  for (const lang::BlockFieldDecl& field : decl.blocks[0].fields)
    slots[field.slot] = input(dag, field.name, field.type);
  slots[decl.attributes[0].slot] = input(dag, "UV", Type::Vec2);
  ASSERT_TRUE(decl.front_facing);
  slots[*decl.front_facing] = input(dag, "facing", Type::Bool);
  for (const lang::GivenDecl& given : decl.givens) inliner.bind(given, slots);
  slots[decl.ports[0].slot] = inliner.evaluate(*decl.ports[0].default_value, slots);
  EXPECT_EQ(dumpValue(dag, slots[decl.givens[0].slot]), "scaled:mul(UV, gain)");
  EXPECT_EQ(dumpValue(dag, slots[decl.givens[1].slot + 1]), "scaled:mul(UV, gain).y");
  const std::string shown = dumpValue(dag, inliner.evaluate(*decl.outputs[0].value, slots));
  EXPECT_EQ(shown, "select(facing, construct(eye, mul(scaled:mul(UV, gain).y, 2)), vec4(0, 0, 0, 0))");
}

TEST(LowerInline, UniformIsKnownByTheRate) {
  const lang::Library library = libraryOf(R"(
/// D.
/// source: S
node choice(vec3 x) -> vec3 { return uniform(x) ? x + 1 : x * 2; }
/// D.
/// source: S
node arms(vec3 x, float y) -> float {
    if (!uniform(x) && uniform(y)) { return y; }
    return uniform(x * y) ? 1.0 : 2.0;
}
)");
  using ir::Rate;
  for (const auto& [rate, choice, arms] : {std::tuple{Rate::Material, "add(x, 1)", "1"},
                                           {Rate::Frame, "add(x, 1)", "1"},
                                           {Rate::Vertex, "mul(x, 2)", "y"},
                                           {Rate::Fragment, "mul(x, 2)", "y"},
                                           {Rate::Light, "mul(x, 2)", "y"}}) {
    Dag dag;
    lower::Inliner inliner(dag);
    const ValueId x = dag.input({ir::InputKind::Parameter, "x", Type::Vec3, rate, {}});
    const ValueId y = dag.input({ir::InputKind::Parameter, "y", Type::Float, Rate::Material, {}});
    EXPECT_EQ(dumpValue(dag, inliner.call(**library.node("choice"), {}, {{x}})[0]), choice);
    EXPECT_EQ(dumpValue(dag, inliner.call(**library.node("arms"), {}, {{x, y}})[0]), arms);
  }
  Dag dag;
  const ValueId known =
      lower::Inliner(dag).call(**library.node("choice"), {}, {{dag.constant(Type::Vec3, {1, 2, 3})}})[0];
  EXPECT_EQ(dumpValue(dag, known), "vec3(2, 3, 4)");
}

TEST(LowerInline, MissingArgumentsAreDefaults) {
  const lang::Library library = libraryOf(R"(
/// D.
/// source: S
node f(float a = 1, float b, float c = 3) -> vec3 { return vec3(a, b, c); }
)");
  Dag dag;
  lower::Inliner inliner(dag);
  const ValueId two = dag.constant(2);
  const lang::NodeDecl& f = **library.node("f");
  EXPECT_EQ(dumpValue(dag, inliner.call(f, {}, {{ir::kNoValue, two}})[0]), "vec3(1, 2, 3)");
  EXPECT_EQ(dumpValue(dag, inliner.call(f, {}, {{two, two, two}})[0]), "vec3(2, 2, 2)");
}

}  // namespace
}  // namespace lacquer::test
