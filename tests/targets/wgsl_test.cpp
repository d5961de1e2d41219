// What WGSL wants otherwise than the C-like languages.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "targets/clike.h"
#include "targets/samples.h"

namespace lacquer::targets {

using ir::Op;
using ir::Stage;
using ir::Type;
using ir::ValueId;

namespace {

/// Keywords and reserved words as WGSL's specification lists them, and functions and types that the texts
/// need.
constexpr const char* kWords =
    "alias break case const const_assert continue continuing default diagnostic discard else enable false fn "
    "for "
    "if let loop override requires return struct switch true var while "
    "NULL Self abstract active alignas alignof as asm asm_fragment async attribute auto await become cast "
    "catch "
    "class co_await co_return co_yield coherent column_major common compile compile_fragment concept "
    "const_cast "
    "consteval constexpr constinit crate debugger decltype delete demote demote_to_helper do dynamic_cast "
    "enum "
    "explicit export extends extern external fallthrough filter final finally friend from fxgroup get goto "
    "groupshared highp impl implements import inline instanceof interface layout lowp macro macro_rules "
    "match "
    "mediump meta mod module move mut mutable namespace new nil noexcept noinline nointerpolation "
    "non_coherent "
    "noncoherent noperspective null nullptr of operator package packoffset partition pass patch "
    "pixelfragment "
    "precise precision premerge priv protected pub public readonly ref regardless register reinterpret_cast "
    "require resource restrict self set shared sizeof smooth snorm static static_assert static_cast std "
    "subroutine super target template this thread_local throw trait try type typedef typeid typename typeof "
    "union "
    "unless unorm unsafe unsized use using varying virtual volatile wgsl where with writeonly yield "
    "array bool f32 i32 vec2f vec3f vec4f mat4x4f sampler sampler_comparison texture_2d texture_cube main "
    "select "
    "inverseSqrt textureSample textureSampleLevel dpdx mix clamp dot FragmentOutputs VertexOutputs";

std::vector<std::string> words() {
  std::vector<std::string> list;
  std::istringstream text(kWords);
  for (std::string word; text >> word;) list.push_back(word);
  return list;
}

std::string wgslOf(const ir::Module& module, Stage stage = Stage::Fragment) {
  return print(module, stage, Target::Wgsl);
}

void expectText(const std::string& text, std::string_view wanted) {
  EXPECT_NE(text.find(wanted), std::string::npos) << wanted << " is not in\n" << text;
}

ValueId functionsOf(Builder& b, ValueId x) {
  ir::Dag& dag = b.dag();
  ValueId total = dag.construct(Type::Vec3, {dag.make(Op::InverseSqrt, {x}), dag.make(Op::DFdx, {x}), x});
  total = dag.make(Op::Mix, {total, dag.construct(Type::Vec3, {x}), x});
  total =
      dag.make(Op::Select, {dag.make(Op::Less, {x, dag.constant(2)}), total, dag.constant(Type::Vec3, {})});
  return dag.make(Op::Clamp, {total, dag.constant(0), x});
}

}  // namespace

/// Fields, blocks, textures and variables of every name that WGSL keeps, beside all that the printer itself
/// uses.
TEST(Wgsl, NamesThatItKeepsAreOthers) {
  Builder b;
  ir::Dag& dag = b.dag();
  std::vector<std::pair<std::string, Type>> fields;
  for (const std::string& word : words()) fields.emplace_back(word, Type::Float);
  b.block(ir::BlockRole::Frame, "Frame", "frame", fields);
  const ValueId uv = b.varying("uv", b.attribute("TEXCOORD_0", Type::Vec2));
  ValueId total = dag.construct(Type::Vec3, {dag.component(uv, 0)});
  for (const std::string& word : words()) {
    const ValueId field = b.field("frame." + word);
    const ValueId map = b.texture(word, Type::Texture2D);
    const ValueId texel = dag.swizzle(dag.make(Op::Texture, {map, uv}), {{0, 1, 2}});
    const ValueId local = b.named(dag.make(Op::Mul, {texel, field}), word);
    total = b.named(dag.add(total, local), "v_" + word);
  }
  total = dag.add(total, functionsOf(b, dag.component(uv, 1)));
  b.color("color", dag.construct(Type::Vec4, {total, dag.constant(1)}));
  const std::string text = wgslOf(b.module);
  for (const std::string& word : words()) {
    expectText(text, fmt::format("    lacquer_{}: f32,\n", word));
    expectText(text, fmt::format(" var lacquer_{}: texture_2d<f32>;\n", word));
    EXPECT_EQ(text.find(fmt::format("let {} =", word)), std::string::npos) << word;
  }
  expectCompiles(text, Stage::Fragment, Target::Wgsl);
  // A name of which one is a part stays.
  EXPECT_EQ(wgsl().name("types"), "types");
  EXPECT_EQ(wgsl().name("texture_scale"), "texture_scale");
  EXPECT_EQ(wgsl().name("textureScale"), "lacquer_textureScale");
}

/// The other languages do not know of it: their names stay as they were.
TEST(Wgsl, ItsWordsAreFreeElsewhere) {
  Builder b;
  b.block(ir::BlockRole::Frame, "Frame", "frame", {{"self", Type::Vec4}});
  const ValueId square = b.named(b.dag().mul(b.field("frame.self"), b.field("frame.self")), "target");
  b.color("color", b.dag().mul(square, square));
  for (const Target target : {Target::Glsl, Target::Essl, Target::Hlsl}) {
    const std::string text = print(b.module, Stage::Fragment, target);
    expectText(text, " target = frame.self * frame.self;");
  }
  expectText(wgslOf(b.module), "let lacquer_target = frame.lacquer_self * frame.lacquer_self;");
}

/// Its compilers refuse what they can tell is not finite.
TEST(Wgsl, NumbersWithoutAFiniteResultAreLeftToTheDevice) {
  Builder b;
  ir::Dag& dag = b.dag();
  const ValueId x = dag.component(b.varying("v", b.attribute("COLOR_0", Type::Vec4)), 0);
  const auto number = [&](double value) { return dag.constant(value); };
  const ValueId zero = dag.constant(Type::Vec3, {});
  const ValueId large = dag.constant(Type::Vec3, {3e38, 3e38, 1});
  ValueId total = x;
  for (const ValueId each :
       {dag.make(Op::Log2, {number(-1)}), dag.make(Op::Sqrt, {number(-1)}),
        dag.make(Op::InverseSqrt, {number(0)}), dag.make(Op::Div, {number(1), number(0)}),
        dag.make(Op::Acos, {number(2)}), dag.make(Op::Pow, {number(-1), number(0.5)}),
        dag.make(Op::Exp2, {number(1e5)}), dag.component(dag.make(Op::Normalize, {zero}), 0),
        dag.make(Op::Length, {large}), dag.make(Op::Dot, {large, large}),
        dag.make(Op::Clamp, {x, number(2), number(1)}),
        dag.component(dag.make(Op::Clamp, {dag.construct(Type::Vec3, {x}), number(2), number(1)}), 1)}) {
    total = dag.add(total, each);
  }
  for (const double small : {1e-45, 1e-40, 1.17549435e-38, 3.4028235e38, -3.4028235e38, 1e300})
    total = dag.make(Op::Max, {total, dag.mul(x, number(small))});
  b.color("color", dag.construct(Type::Vec4, {total}));
  const std::string text = wgslOf(b.module);
  expectText(text, "fn lacquer_late_float(number: f32) -> f32 {\n    return number;\n}\n");
  expectText(text, "fn lacquer_late_vec3(number: vec3f) -> vec3f {");
  expectText(text, "log2(lacquer_late_float(-1.0))");
  expectText(text, "lacquer_late_float(1.0) / 0.0");
  expectText(text, "normalize(lacquer_late_vec3(vec3f(0.0)))");
  expectText(text, "clamp(v_v.x, lacquer_late_float(2.0), 1.0)");
  expectText(text, "3.4028234e38");
  EXPECT_EQ(text.find("3.4028235e38"), std::string::npos) << "beyond the largest float, as a double";
  expectCompiles(text, Stage::Fragment, Target::Wgsl);
  // Nowhere else.
  EXPECT_EQ(print(b.module, Stage::Fragment, Target::Glsl).find("lacquer_"), std::string::npos);
  EXPECT_EQ(wgslOf(everyOpSample()).find("lacquer_late"), std::string::npos);
}

TEST(Wgsl, LargestNumberIsTheLargestFloat) {
  for (const double x : {3.4028235e38, 1e300, std::numeric_limits<double>::infinity()}) {
    const std::string text = wgsl().literal(x).text;
    EXPECT_LE(std::stod(text), static_cast<double>(std::numeric_limits<float>::max()));
    EXPECT_EQ(static_cast<float>(std::stod(text)), std::numeric_limits<float>::max());
    EXPECT_EQ(wgsl().literal(-x).text, '-' + text);
  }
}

TEST(Wgsl, AndBesideOrIsInParentheses) {
  Builder b;
  ir::Dag& dag = b.dag();
  const ValueId v = b.varying("v", b.attribute("COLOR_0", Type::Vec4));
  std::vector<ValueId> bits;
  for (int i = 0; i < 4; ++i) bits.push_back(dag.make(Op::Less, {dag.component(v, i), dag.constant(0.5)}));
  const ValueId both = dag.make(Op::And, {bits[0], bits[1]});
  const ValueId either = dag.make(Op::Or, {both, dag.make(Op::And, {bits[2], bits[3]})});
  b.discard(either);
  b.color("color", v);
  const std::string text = wgslOf(b.module);
  expectText(text, "= (v_v.x < 0.5 && v_v.y < 0.5) || (v_v.z < 0.5 && v_v.w < 0.5);");
  expectCompiles(text, Stage::Fragment, Target::Wgsl);
}

/// Every kind of texture, with and without a level.
TEST(Wgsl, TexturesAndSamplersAreApart) {
  Builder b;
  ir::Dag& dag = b.dag();
  const ValueId at = b.varying("at", b.attribute("NORMAL", Type::Vec3));
  const ValueId uv = dag.swizzle(at, {{0, 1}});
  ValueId total = dag.constant(Type::Vec4, {});
  for (const Type type : {Type::Texture2D, Type::TextureCube, Type::Texture2DArray, Type::Texture3D}) {
    const ValueId map = b.texture(fmt::format("map_{}", static_cast<int>(type)), type);
    const ValueId place = type == Type::Texture2D ? uv : at;
    total = dag.add(total, dag.make(Op::Texture, {map, place}));
    total = dag.add(total, dag.make(Op::TextureLod, {map, place, dag.component(at, 0)}));
  }
  const ValueId depth = b.texture("depth", Type::Texture2DShadow, true);
  const ValueId lit =
      dag.add(dag.make(Op::TextureCompare, {depth, at}), dag.make(Op::TextureCompareLod, {depth, at}));
  b.color("color", dag.mul(total, lit));
  const std::string text = wgslOf(b.module);
  // The builder's environment is at set 0, binding 2; the material's textures at set 1 from binding 1 on.
  expectText(text,
             "@group(0) @binding(4) var depth: texture_depth_2d;\n"
             "@group(0) @binding(5) var depth_sampler: sampler_comparison;\n");
  expectText(text,
             "@group(1) @binding(2) var map_7: texture_2d<f32>;\n@group(1) @binding(3) var map_7_sampler: "
             "sampler;\n");
  expectText(text, "@group(1) @binding(8) var map_11: texture_3d<f32>;\n");
  expectText(text, "textureSampleLevel(map_10, map_10_sampler, v_at.xy, i32(floor(v_at.z + 0.5)), v_at.x)");
  expectText(text, "textureSampleCompareLevel(depth, depth_sampler, v_at.xy, v_at.z)");
  expectCompiles(text, Stage::Fragment, Target::Wgsl);
}

/// Blocks stand at even places, samplers at odd ones: what the contract keeps apart stays apart.
TEST(Wgsl, NoTwoResourcesShareAPlace) {
  std::set<std::pair<uint32_t, uint32_t>> places;
  for (uint32_t set = 0; set < 3; ++set) {
    for (uint32_t binding = 0; binding < 20; ++binding) {
      const WgslBinding at = wgslBinding({set, binding, 0});
      EXPECT_TRUE(places.emplace(at.group, at.binding).second);
      EXPECT_TRUE(places.emplace(at.group, at.sampler).second);
    }
  }
}

namespace {

struct Member {
  uint32_t offset = 0, end = 0;
};

/// The layout of a struct by WGSL's rules ("Alignment and Size"), read from the text.
std::map<std::string, Member> layoutOf(const std::string& text, const std::string& structure,
                                       uint32_t& size) {
  const std::map<std::string, std::pair<uint32_t, uint32_t>> kTypes = {// alignment, size
                                                                       {"f32", {4, 4}},
                                                                       {"i32", {4, 4}},
                                                                       {"vec2f", {8, 8}},
                                                                       {"vec3f", {16, 12}},
                                                                       {"vec4f", {16, 16}},
                                                                       {"mat4x4f", {16, 64}},
                                                                       {"array<vec4f, 3>", {16, 48}}};
  std::map<std::string, Member> members;
  const size_t begin = text.find(fmt::format("struct {} {{\n", structure));
  std::istringstream lines(text.substr(begin, text.find("\n}", begin) - begin));
  std::string line;
  std::getline(lines, line);
  uint32_t cursor = 0, widest = 4;
  while (std::getline(lines, line)) {
    const size_t colon = line.find(": ");
    const auto& [alignment, bytes] = kTypes.at(line.substr(colon + 2, line.size() - colon - 3));
    cursor = (cursor + alignment - 1) / alignment * alignment;
    members[line.substr(4, colon - 4)] = {cursor, cursor + bytes};
    cursor += bytes;
    widest = std::max(widest, alignment);
  }
  size = (cursor + widest - 1) / widest * widest;
  return members;
}

}  // namespace

TEST(Wgsl, LayoutsAreThoseOfTheContract) {
  Builder b;
  b.block(ir::BlockRole::Frame, "Frame", "frame",
          {{"a", Type::Float},
           {"b", Type::Vec2},
           {"c", Type::Float},
           {"d", Type::Vec3},
           {"e", Type::Float},
           {"f", Type::Vec3},
           {"g", Type::Vec2},
           {"h", Type::Mat4},
           {"j", Type::Int},
           {"k", Type::Vec4}});
  // Narrow: the array's elements would be 8 bytes apart.
  b.block(ir::BlockRole::Lights, "Light", "light", {{"l", Type::Float}, {"m", Type::Float}}, 4);
  const ValueId v = b.varying("v", b.attribute("COLOR_0", Type::Vec4));
  const ValueId read = b.dag().add(b.field("frame.a"), b.field("light.l", 1));
  b.color("color", b.dag().mul(v, read));
  const std::string text = wgslOf(b.module);
  for (const ir::Block& block : b.module.blocks) {
    uint32_t size = 0;
    const auto members = layoutOf(text, block.name, size);
    for (const ir::BlockField& field : block.fields) {
      ASSERT_TRUE(members.contains(field.name)) << field.name;
      EXPECT_EQ(members.at(field.name).offset, field.offset) << field.name;
    }
    EXPECT_EQ((size + 15) / 16 * 16, block.size);
    if (block.array != 0) {
      EXPECT_EQ(size, block.size) << "the stride";
    }
  }
  expectText(text, "@group(0) @binding(2) var<uniform> lights: array<Light, 4>;\n");
  expectCompiles(text, Stage::Fragment, Target::Wgsl);
}

}  // namespace lacquer::targets
