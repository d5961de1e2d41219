// ir::canonical(): everything that reaches a shader changes it, and nothing else does.
#include "ir/canonical.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "passes/pipeline.h"

namespace lacquer::test {
namespace {

using ir::Op;
using ir::Type;

struct Made {
  ir::Module module;
  ir::ValueId tint = ir::kNoValue, texel = ir::kNoValue, color = ir::kNoValue;
};

Made made(const std::function<void(ir::Dag&)>& before = {}) {
  Made out;
  ir::Dag& dag = out.module.dag;
  if (before) before(dag);
  out.module.template_name = "t";
  out.module.parameters.push_back({"tint", Type::Vec3, {}, {0, 1}, {}});
  out.module.textures.emplace_back();
  out.module.textures[0].name = "map";
  out.module.light_groups.push_back({0, 2});
  dag.setTerm(dag.addTerm("term", "source"));
  out.tint = dag.input({ir::InputKind::Parameter, "tint", Type::Vec3, ir::Rate::Material, {}, 0, 0});
  const ir::ValueId map =
      dag.input({ir::InputKind::Texture, "map", Type::Texture2D, ir::Rate::Frame, {}, 0, 0});
  const ir::ValueId uv = dag.input({ir::InputKind::Varying, "uv", Type::Vec2, ir::Rate::Fragment, {}, 0, 0});
  out.texel = dag.make(Op::Texture, {map, uv});
  const int components[] = {0, 1, 2};
  const ir::ValueId scaled = dag.mul(dag.swizzle(out.texel, components), dag.constant(0.25));
  dag.name(scaled, "scaled");
  out.color = dag.add(scaled, out.tint);
  out.module.outputs.push_back({ir::OutputKind::Color, ir::Stage::Fragment, "color", 0, out.color});
  return out;
}

TEST(Canonical, WhatReachesAShaderChangesIt) {
  const std::function<void(Made&)> changes[] = {
      [](Made& m) { m.module.template_name = "u"; },
      [](Made& m) { m.module.outputs[0].name = "colour"; },
      [](Made& m) { m.module.outputs[0].location = 1; },
      [](Made& m) { m.module.outputs[0].value = m.tint; },
      [](Made& m) {
        m.module.outputs.push_back({ir::OutputKind::Color, ir::Stage::Fragment, "more", 1, m.texel});
      },
      [](Made& m) { m.module.textures[0].srgb = true; },
      [](Made& m) { m.module.textures[0].type = Type::TextureCube; },
      [](Made& m) { m.module.parameters[0].range.hi = 2; },
      [](Made& m) { m.module.parameters[0].neutral[1] = 1; },
      [](Made& m) { m.module.light_groups[0].count = 3; },
      [](Made& m) {
        m.module.varyings.push_back({"uv", Type::Vec2});
      },
      [](Made& m) { m.module.dag.name(m.color, "sum"); },
      [](Made& m) { m.module.dag.relax(m.color); },
      [](Made& m) { m.module.outputs[0].value = m.module.dag.sub(m.color, m.module.dag.constant(1)); },
  };
  const std::string plain = ir::canonical(made().module);
  std::set<std::string> all{plain};
  for (const auto& change : changes) {
    Made one = made();
    change(one);
    EXPECT_TRUE(all.insert(ir::canonical(one.module)).second) << &change - changes;
  }
}

/// Neither what else the DAG holds nor today's numbers.
TEST(Canonical, NothingElseDoes) {
  const std::string plain = ir::canonical(made().module);
  Made later = made([](ir::Dag& dag) {
    dag.constant(0.25);
    dag.add(dag.input({ir::InputKind::Varying, "uv", Type::Vec2, ir::Rate::Fragment, {}, 0, 0}),
            dag.constant(7));
  });
  EXPECT_EQ(ir::canonical(later.module), plain);
  later.module.parameters[0].value[0] = 0.5;
  later.module.parameters[0].pointer = "/materials/3";
  later.module.textures[0].texture = 4;
  EXPECT_EQ(ir::canonical(later.module), plain);
}

TEST(Canonical, AddressesHave128Bits) {
  const std::string address = passes::contentAddress(passes::contentDigest(made().module));
  EXPECT_EQ(address.size(), 32U);
  EXPECT_EQ(address.find_first_not_of("0123456789abcdef"), std::string::npos);
}

}  // namespace
}  // namespace lacquer::test
