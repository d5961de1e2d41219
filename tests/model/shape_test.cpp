// Materials of one shape have one graph but for its numbers, and those are where the origins say.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "model/shape.h"
#include "model/thresholds.h"
#include "support/materials.h"

namespace lacquer::test {
namespace {

using material::Kind;
using material::Material;

class Twins {
public:
  Twins(const model::Model& model, uint32_t seed) : model_(model), schema_(*model.schema), random_(seed) {
    for (const model::Threshold& threshold : model::thresholds(model)) {
      if (threshold.member < 0) special_[threshold.property].push_back(threshold.at);
    }
  }

  /// Any material: some extensions, numbers, textures.
  Material material() {
    Material m;
    m.index = static_cast<int>(below(9));
    m.name = "first";
    for (uint16_t e = 1; e < schema_.extensions.size(); ++e) {
      if (below(8) == 0) m.extensions.push_back(e);
    }
    for (uint16_t p = 0; p < schema_.properties.size(); ++p) {
      const material::Property& row = schema_.properties[p];
      if ((row.extension != 0 && !m.has(row.extension)) || below(3) == 0) continue;
      if (row.decl->kind == Kind::Number || row.decl->kind == Kind::Bool || row.decl->kind == Kind::Choice) {
        m.numbers.push_back({p, number(p)});
        if (below(16) == 0) m.animated.push_back(p);
      } else if (row.decl->kind == Kind::Texture && below(2) == 0) {
        m.textures.push_back({p, texture(p, m)});
      }
    }
    return m;
  }

  /// The same with some other numbers.
  Material twin(Material m) {
    m.index = static_cast<int>(below(9));
    m.name = "second";
    for (Material::Number& one : m.numbers) {
      if (below(3) == 0) one.value = number(one.property);
    }
    for (Material::Texture& one : m.textures) {
      const std::vector<size_t> animated = one.info.animated.members;
      if (below(6) == 0) one.info = texture(one.property, m);
      one.info.pointer = "/materials/7/t" + std::to_string(one.property);
      one.info.animated.members = animated;
    }
    return m;
  }

  uint32_t below(uint32_t count) { return static_cast<uint32_t>(random_() % count); }

private:
  double number() { return 0.1 + 0.01 * below(70); }

  ir::Components number(uint16_t property) {
    const lang::PropertyDecl& decl = *schema_.properties[property].decl;
    if (decl.kind == Kind::Bool) return {static_cast<double>(below(2))};
    if (decl.kind == Kind::Choice)
      return {static_cast<double>(below(static_cast<uint32_t>(decl.choices.size())))};
    std::vector<ir::Components> pool = special_[property];
    if (decl.default_value) pool.push_back(*decl.default_value);
    if (decl.neutral) pool.push_back(*decl.neutral);
    ir::Components value{};
    if (!pool.empty() && below(3) == 0)
      value = pool[below(static_cast<uint32_t>(pool.size()))];
    else
      std::generate_n(value.begin(), ir::componentCount(decl.type), [&] { return number(); });
    // Thresholds hold one number in all components; what is read has none behind the type's.
    std::fill(value.begin() + ir::componentCount(decl.type), value.end(), 0.0);
    if (value[0] == 0 && below(4) == 0) value[0] = -0.0;
    return value;
  }

  gltf::TextureInfo texture(uint16_t property, const Material& m) {
    gltf::TextureInfo info;
    info.texture = static_cast<int>(below(3));
    info.texCoord = static_cast<int>(below(2));
    info.pointer = "/materials/0/t" + std::to_string(property);
    if (below(2) == 0) {
      gltf::TextureTransform& t = info.transform.emplace();
      if (below(2) == 0) t.offset = {number(), 0};
      if (below(4) == 0) t.rotation = number();
      if (below(2) == 0) t.scale = {number(), below(2) == 0 ? -0.0 : number()};
    }
    // Some have one coordinate.
    if (!m.textures.empty() && below(2) == 0) {
      info.transform = m.textures[0].info.transform;
      info.texCoord = m.textures[0].info.texCoord;
    }
    info.animated.rotation = below(12) == 0;
    for (const lang::PropertyDecl& member : schema_.properties[property].decl->members)
      info.members.push_back(below(2) == 0 ? member.default_value.value_or(ir::Components{})[0] : number());
    if (!info.members.empty() && below(8) == 0) info.animated.members.push_back(0);
    return info;
  }

  const model::Model& model_;
  const material::Schema& schema_;
  std::mt19937 random_;
  std::map<uint16_t, std::vector<ir::Components>> special_;
};

struct Built {
  graph::Graph graph;
  model::Origins origins;
  Diagnostics warnings;
};

/// What is left of a graph without what belongs to one material.
std::string sharedText(graph::Graph graph) {
  graph.name.clear();
  for (ir::Parameter& p : graph.parameters) {
    p.value = {};
    p.pointer.clear();
  }
  for (graph::Texture& slot : graph.textures) {
    slot.texture = -1;
    slot.pointer.clear();
    slot.also.clear();
  }
  return graph::toJson(graph);
}

/// What a material's own are, by the origins of another graph of its shape.
void expectOwn(const Built& first, const Built& second, const Material& of, const material::Schema& schema) {
  ASSERT_EQ(first.graph.parameters.size(), second.graph.parameters.size());
  for (size_t i = 0; i < first.origins.parameters.size(); ++i) {
    const ir::Parameter& expected = second.graph.parameters[i];
    const model::Origin& origin = first.origins.parameters[i];
    EXPECT_EQ(valueOf(origin, of, first.graph.parameters[i].value), expected.value) << expected.name;
    EXPECT_EQ(pointerOf(origin, of, schema), expected.pointer);
    EXPECT_EQ(first.graph.parameters[i].animated, expected.animated);
    EXPECT_EQ(first.graph.parameters[i].neutral, expected.neutral);
  }
  for (size_t i = 0; i < first.origins.textures.size(); ++i) {
    const gltf::TextureInfo& info = *of.texture(first.origins.textures[i]);
    EXPECT_EQ(info.texture, second.graph.textures[i].texture);
    EXPECT_EQ(info.pointer, second.graph.textures[i].pointer);
  }
}

TEST(Shapes, OfEqualKeysHaveOneGraph) {
  size_t equal = 0, others = 0;
  for (const char* profile : {"khr", "openpbr", "physical"}) {
    const model::Model& model = **builtInModels().of(profile);
    const model::Shapes shapes(model);
    Twins twins(model, 7);
    for (int i = 0; i < 3000; ++i) {
      const Material a = twins.material();
      const Material b = twins.twin(a);
      const gltf::VertexAttributes attributes{true, twins.below(2) == 0, false, {true, true}};
      if (shapes.keyOf(a, attributes) != shapes.keyOf(b, attributes)) {
        ++others;
        continue;
      }
      model::BuildOptions options;
      options.template_name = "forward";
      const auto build = [&](const Material& m) {
        Built built;
        Result<graph::Graph> graph = model::build(model, **builtInLibrary().template_("forward"), m,
                                                  attributes, options, built.warnings, &built.origins);
        if (graph) built.graph = std::move(*graph);
        return built;
      };
      const Built first = build(a), second = build(b);
      if (!first.warnings.empty()) continue;
      ++equal;
      EXPECT_TRUE(second.warnings.empty());
      ASSERT_EQ(sharedText(first.graph), sharedText(second.graph)) << profile << " " << i;
      expectOwn(first, second, b, *model.schema);
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(equal, 500U);
  EXPECT_GT(others, 500U) << "numbers that decide are other shapes";
}

}  // namespace
}  // namespace lacquer::test
