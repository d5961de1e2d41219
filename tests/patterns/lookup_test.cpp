// The evaluator's lookups over a footprint, the sizes of textures, and arrays of tiles.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "eval/evaluate.h"
#include "eval/image.h"
#include "lower/inline.h"
#include "patterns/run.h"

namespace lacquer::test::lookup_test {
namespace {

/// A node of a text, whose textures are these and whose other parameters these numbers, the same at each
/// point.
template <class T>
std::vector<std::vector<T>> valuesOf(const std::string& text, const eval::Sampler& sampler,
                                     const Arguments& arguments) {
  auto library = lang::Library::fromFiles({{"lookups.node", "/// D.\n/// source: S\nnode looked_up" + text}});
  if (!library) throw std::runtime_error(format(library.error().at(0)));
  if (const Diagnostics wrong = library->checkAll(); !wrong.empty())
    throw std::runtime_error(format(wrong[0]));
  const lang::NodeDecl& node = **library->node("looked_up");
  ir::Module module;
  eval::Bindings bindings;
  std::vector<ir::ValueId> values;
  for (const lang::Param& param : node.params) {
    const std::string name(param.name);
    const bool texture = ir::isTexture(param.type);
    const auto index = static_cast<uint32_t>(texture ? module.textures.size() : module.varyings.size());
    if (texture) {
      ir::TextureSlot& slot = module.textures.emplace_back();
      slot.name = name;
      slot.type = param.type;
      bindings.textures[name] = sampler;
    } else {
      module.varyings.push_back({name, param.type, index, ir::kNoValue});
      bindings.columns[name] = eval::Column::perPoint(ir::componentCount(param.type), arguments.at(name));
    }
    values.push_back(
        module.dag.input({texture ? ir::InputKind::Texture : ir::InputKind::Varying, name, param.type,
                          texture ? ir::Rate::Frame : ir::Rate::Fragment, param.range, 0, index}));
  }
  lower::Inliner inliner(module.dag);
  const lower::Values results = inliner.call(node, {}, values);
  auto evaluated =
      eval::evaluate<T>(module, std::vector<ir::ValueId>(results.begin(), results.end()), bindings, 1);
  if (!evaluated) throw std::runtime_error(format(evaluated.error().at(0)));
  return std::move(*evaluated);
}

/// The level that it is asked for is its texel.
eval::Sampler levels(int width, int height, int depth = 1) {
  eval::Sampler sampler = [](size_t, const std::array<double, 3>& at, double lod) {
    return std::array<double, 4>{lod, at[0], at[1], at[2]};
  };
  sampler.size = {width, height, depth};
  return sampler;
}

template <class T>
void expectLevels() {
  const std::string flat =
      "(sampler2D s, vec2 uv, vec2 x, vec2 y) -> vec4 { return textureGrad(s, uv, x, y); }";
  // 16 of 64 texels along u, 3 of 32 along v: the longer one is 16 texels long.
  const auto wide =
      valuesOf<T>(flat, levels(64, 32), {{"uv", {0.25, 0.5}}, {"x", {0.25, 0}}, {"y", {0, 0.1}}})[0];
  EXPECT_NEAR(wide[0], 4, 1e-6);
  EXPECT_EQ(wide[1], 0.25);
  const auto long_y =
      valuesOf<T>(flat, levels(64, 32), {{"uv", {0, 0}}, {"x", {0.01, 0}}, {"y", {3.0 / 64, 4.0 / 32}}})[0];
  EXPECT_NEAR(long_y[0], std::log2(5.0), 1e-6);
  // Magnified: the first level.
  EXPECT_EQ(valuesOf<T>(flat, levels(64, 32), {{"uv", {0, 0}}, {"x", {0.001, 0}}, {"y", {0, 0}}})[0][0], 0);
  const std::string array =
      "(sampler2DArray s, vec3 at, vec2 x, vec2 y) -> vec4 { return textureGrad(s, at, x, y); }";
  EXPECT_NEAR(
      valuesOf<T>(array, levels(64, 32, 5), {{"at", {0, 0, 2}}, {"x", {0.125, 0}}, {"y", {0, 0}}})[0][0], 3,
      1e-6);
  const std::string volume =
      "(sampler3D s, vec3 at, vec3 x) -> vec4 { return textureGrad(s, at, x, x.zyx); }";
  EXPECT_NEAR(valuesOf<T>(volume, levels(8, 8, 64), {{"at", {0, 0, 0}}, {"x", {0, 0, 0.25}}})[0][0], 4, 1e-6);
  // Seen straight on, a face is 2 wide.
  const std::string cube = "(samplerCube s, vec3 at, vec3 x) -> vec4 { return textureGrad(s, at, x, x); }";
  EXPECT_NEAR(valuesOf<T>(cube, levels(64, 64), {{"at", {0, 0, 2}}, {"x", {0.5, 0, 0}}})[0][0], 3, 1e-6);
}

TEST(Lookups, AFootprintChoosesTheLevel) {
  expectLevels<float>();
  expectLevels<double>();
}

template <class T>
void expectSizes() {
  const std::string sizes =
      "(sampler2D s, int level) -> vec2 { ivec2 n = textureSize(s, level); return vec2(float(n.x), "
      "float(n.y)); }";
  const auto at = [&](double level) { return valuesOf<T>(sizes, levels(40, 12), {{"level", {level}}})[0]; };
  EXPECT_EQ(at(0), (std::vector<T>{40, 12}));
  EXPECT_EQ(at(2), (std::vector<T>{10, 3}));
  EXPECT_EQ(at(5), (std::vector<T>{1, 1}));
  // No such levels: within what a size can be.
  for (const double none : {6.0, 1000.0, -1.0}) EXPECT_EQ(at(none), (std::vector<T>{1, 1})) << none;
  const std::string layers =
      "(sampler2DArray s) -> vec3 { ivec3 n = textureSize(s, 1); return vec3(float(n.x), float(n.y), "
      "float(n.z)); }";
  EXPECT_EQ(valuesOf<T>(layers, levels(40, 12, 7), {})[0], (std::vector<T>{20, 6, 7}));
}

TEST(Lookups, ATextureKnowsItsSize) {
  expectSizes<float>();
  expectSizes<double>();
}

std::shared_ptr<const eval::Image> oneColor(uint8_t red, int side = 2) {
  auto image = std::make_shared<eval::Image>();
  image->width = image->height = side;
  image->texels =
      eval::Image::Texels<uint8_t>(static_cast<size_t>(side) * static_cast<size_t>(side), {red, 0, 0, 255});
  return image;
}

TEST(Lookups, TilesAreLayers) {
  // 1001, 1003 and 1012; the array ends there.
  std::vector<std::shared_ptr<const eval::Image>> layers(12);
  layers[0] = oneColor(51);
  layers[2] = oneColor(102);
  layers[11] = oneColor(153);
  const auto array = eval::layered(layers, {0.8, 0.2, 0, 1}, {});
  ASSERT_TRUE(array);
  EXPECT_EQ(array->layers, 12);
  const eval::Sampler sampler =
      eval::makeSampler(std::make_shared<const eval::Image>(*array), {eval::Wrap::Clamp, eval::Wrap::Clamp});
  EXPECT_EQ(sampler.size, (std::array<int, 3>{2, 2, 12}));
  const std::vector<double> places = {0.3, 0.4, 2.9,  0.1, 1.5,  1.5, 1.5, 0.5,
                                      5.5, 1.5, -0.1, 0.5, 10.5, 0.5, 0.5, -0.5};
  const auto got = runNode<double>("texture_tiles", {{"uv", places}, {"outside", {0.1, 0, 0, 1}}}, 8, {},
                                   false, sampler)[0];
  const double expected[] = {0.2, 0.4, 0.6, 0.8, 0.1, 0.1, 0.1, 0.1};
  for (size_t i = 0; i < 8; ++i) EXPECT_NEAR(got[4 * i], expected[i], 1e-6) << i;
  layers[5] = oneColor(0, 4);
  const auto uneven = eval::layered(layers, {}, {});
  ASSERT_FALSE(uneven);
  EXPECT_EQ(uneven.error().at(0).code, "image-size");
}

TEST(Lookups, OutsideOfAnImageIsAColor) {
  const auto got = runNode<float>(
      "texture_within", {{"uv", {0.5, 0.5, 1.5, 0.5, 0.5, -0.1, 1, 1}}, {"outside", {9, 8, 7, 6}}}, 4)[0];
  EXPECT_NEAR(got[0], texelAt(0.5, 0.5)[0], 1e-6);
  for (const size_t i : {size_t{1}, size_t{2}}) EXPECT_EQ(got[4 * i + 3], 6);
  EXPECT_NEAR(got[12], texelAt(1, 1)[0], 1e-6);
}

}  // namespace
}  // namespace lacquer::test::lookup_test
