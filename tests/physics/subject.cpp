#include "physics/subject.h"

#include <gtest/gtest.h>

#include "eval/dfg.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "support/materials.h"

namespace lacquer::physics {

namespace {

const lang::Library& library() {
  static const lang::Library kLibrary = lang::Library::embedded();
  return kLibrary;
}

std::string textOf(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics) text += format(d) + "\n";
  return text;
}

}  // namespace

Subject::Subject(const Material& material, const Configuration& setup) : texels_(material.texels) {
  make(gltfOf(material), 0, setup);
}

Subject::Subject(const std::string& gltf, size_t material, std::map<std::string, Vec4> texels,
                 const Configuration& setup)
    : texels_(std::move(texels)) {
  make(gltf, material, setup);
}

void Subject::make(const std::string& gltf, size_t material, const Configuration& setup) {
  const Result<material::Document> document = test::materialsOf(gltf, "test.gltf");
  ASSERT_TRUE(document) << textOf(document.error());
  const material::Material& m = document->materials.at(material);
  ASSERT_FALSE(hasError(m.diagnostics)) << textOf(m.diagnostics);
  test::BuildSetup options;
  options.template_name = setup.template_name;
  options.profile = setup.profile;
  options.ibl = setup.ibl;
  options.multiple_scattering = setup.multiple_scattering;
  options.direct_multiple_scattering = setup.direct_multiple_scattering;
  options.dfg_table = setup.dfg_table;
  options.live = setup.live;
  options.switches = setup.switches;
  Diagnostics warnings;
  graph_ = test::buildGraph(m, {true, setup.tangents, true, {true, true, true, true}}, options, warnings);
  const Diagnostics wrong = graph::check(graph_, library());
  ASSERT_FALSE(hasError(wrong)) << textOf(wrong);
  Result<ir::Module> module = lower::lower(graph_, library(), {.evaluable = true});
  ASSERT_TRUE(module) << textOf(module.error());
  module_ = std::move(*module);
  setup_ = setup;
  if (setup.placed) passes::runPipeline(module_, {{false, {{"directional", 1}}}, {}});
}

template <class T>
std::vector<Vec4> Subject::colors(std::span<const Sample> samples, const Vec3& environment) const {
  std::vector<eval::Point> points;
  for (const Sample& s : samples) {
    eval::Point point;
    point.n = s.n;
    point.t = s.t;
    point.v = s.v;
    point.l = s.l;
    point.color0 = s.color0;
    point.light = s.light;
    point.front_facing = s.front_facing;
    point.position = s.position;
    point.uv = {s.uv, s.uv, s.uv, s.uv};
    points.push_back(point);
  }
  eval::Bindings bindings;
  eval::bindPoints(module_, points, bindings);
  bindings.quads = setup_.quads;
  for (const auto& [name, column] : setup_.columns) bindings.columns[name] = column;
  for (const ir::TextureSlot& slot : module_.textures) {
    Vec4 texel{environment[0], environment[1], environment[2], 1};
    if (!slot.environment) {
      const std::string property = slot.pointer.substr(slot.pointer.rfind('/') + 1);
      const auto it = texels_.find(property);
      EXPECT_TRUE(it != texels_.end() || setup_.texel) << "no texel for " << property;
      if (it != texels_.end())
        texel = it->second;
      else if (setup_.texel)
        texel = *setup_.texel;
    }
    bindings.textures[slot.name] = [texel](size_t, const Vec3&, double) { return texel; };
    if (const auto it = setup_.textures.find(slot.name); it != setup_.textures.end()) {
      bindings.textures[slot.name] = it->second;
      continue;
    }
    if (eval::environmentTable(slot.name) == nullptr) continue;
    bindings.textures[slot.name] = eval::environmentSampler(slot.name);
  }
  EXPECT_TRUE(eval::bindMaterialBlock(module_, bindings));
  EXPECT_TRUE(eval::bindVaryings<T>(module_, points.size(), bindings));
  std::vector<Vec4> result(samples.size());
  for (const ir::Output& output : module_.outputs) {
    if (output.kind != ir::OutputKind::Color) continue;
    if (setup_.output.empty() ? output.location != 0 : output.name != setup_.output) continue;
    const auto values = eval::evaluate<T>(module_, {{output.value}}, bindings, points.size());
    EXPECT_TRUE(values) << textOf(values.error());
    if (!values) return result;
    for (size_t i = 0; i < result.size(); ++i) {
      for (size_t c = 0; c < 4; ++c) result[i][c] = static_cast<double>((*values)[0][i * 4 + c]);
    }
  }
  return result;
}

template std::vector<Vec4> Subject::colors<float>(std::span<const Sample>, const Vec3&) const;
template std::vector<Vec4> Subject::colors<double>(std::span<const Sample>, const Vec3&) const;

}  // namespace lacquer::physics
