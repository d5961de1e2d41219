// Numbers of MaterialX documents: what their authors change is a change of bytes, never another shader.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "inputs.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDocument = R"(<materialx version="1.39">
  <nodegraph name="NG_marble">
    <input name="tint" type="color3" value="0.2, 0.3, 0.5" />
    <position name="place" type="vector3" />
    <transformmatrix name="turned" type="vector3">
      <input name="in" type="vector3" nodename="place" />
      <input name="mat" type="matrix33" value="2, 0, 0, 0, 1, 0, 0, 0, 1" />
    </transformmatrix>
    <fractal3d name="veins" type="float">
      <input name="position" type="vector3" nodename="turned" />
      <input name="amplitude" type="float" value="0.4" />
      <input name="lacunarity" type="float" value="2.1" />
    </fractal3d>
    <mix name="color" type="color3">
      <input name="fg" type="color3" interfacename="tint" />
      <input name="bg" type="color3" value="0.9, 0.85, 0.8" />
      <input name="mix" type="float" nodename="veins" />
    </mix>
    <output name="out" type="color3" nodename="color" />
  </nodegraph>
  <standard_surface name="SR_marble" type="surfaceshader">
    <input name="base_color" type="color3" nodegraph="NG_marble" />
    <input name="specular_roughness" type="float" value="0.3" />
    <input name="coat" type="float" value="0.5" />
    <input name="coat_roughness" type="float" value="0.1" />
  </standard_surface>
  <surfacematerial name="Marble" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="SR_marble" />
  </surfacematerial>
</materialx>
)";

/// A number in the range, away from its ends, where terms come and go.
double numberIn(const Range& range, std::mt19937& random) {
  const double low = std::max(range.low, -4.0), high = std::max(low, std::min(range.high, low + 4));
  return std::uniform_real_distribution<double>(low + 0.05 * (high - low),
                                                high - 0.05 * (high - low))(random);
}

/// Edits so many numbers of a graph; how many were edited without another shader.
size_t edited(Graph& graph, const Options& options, size_t edits, std::mt19937& random) {
  Messages messages;
  const Shader shader = graph.generate(options, messages);
  EXPECT_TRUE(shader) << errorsOf(messages);
  const std::string structure = graph.structure(options, messages);
  std::vector<std::byte> block(shader.uniformSize());
  const std::vector<Parameter> parameters = graph.parameters();
  size_t good = 0;
  for (size_t i = 0; i < edits && !parameters.empty(); ++i) {
    const Parameter& parameter = parameters[random() % parameters.size()];
    std::vector<double> value(parameter.value.size());
    for (double& x : value) x = numberIn(parameter.range, random);
    if (parameter.type == "bool") continue;
    if (parameter.type[0] == 'i' || parameter.type[0] == 'u')
      std::transform(value.begin(), value.end(), value.begin(), [](double x) { return std::round(x); });
    if (!graph.setParameter(parameter.name, value, messages)) {
      // A range that another input narrows; the number is as it was.
      EXPECT_EQ(messages.back().code, "out-of-range") << messages.back().text;
      messages.clear();
      continue;
    }
    EXPECT_NE(graph.changes(), Change::Program) << parameter.name;
    EXPECT_TRUE(shader.packGraph(graph, block, messages)) << errorsOf(messages);
    ++good;
  }
  EXPECT_EQ(graph.structure(options, messages), structure);
  return good;
}

TEST(Documents, EditsOfNumbersMakeNoShader) {
  const fs::path folder = emptyFolder();
  fs::create_directories(folder);
  const std::string path = (folder / "marble.mtlx").string();
  std::ofstream(path) << kDocument;
  Messages messages;
  const Scene scene = Scene::load(path, quick(), messages);
  ASSERT_TRUE(scene) << errorsOf(messages);
  Graph graph = scene.graph(0, {true, true, true, {true, true, false, false}}, quick(), messages);
  ASSERT_TRUE(graph) << errorsOf(messages);
  std::mt19937 random(7);
  std::vector<std::string> names;
  for (const Parameter& parameter : graph.parameters()) names.push_back(parameter.name);
  EXPECT_NE(std::find(names.begin(), names.end(), "NG_marble_turned_mat_0"), names.end());
  EXPECT_GT(edited(graph, quick(), 1000, random), 900U);
}

TEST(Documents, EditsOfMaterialXsExamplesMakeNoShader) {
  const char* set = std::getenv("LACQUER_ASSETS");
  const fs::path folder =
      (set != nullptr ? fs::path(set) : fs::path(LACQUER_EXAMPLES) / "../../shared/assets") /
      "materialx/examples";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << "; set LACQUER_ASSETS";
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".mtlx") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::mt19937 random(11);
  size_t edits = 0;
  for (const fs::path& file : files) {
    Messages messages;
    const Scene scene = Scene::load(file.string(), quick(), messages);
    if (!scene) continue;
    for (size_t i = 0; i < scene.materialCount(); ++i) {
      Graph graph = scene.graph(i, {true, true, true, {true, true, false, false}}, quick(), messages);
      if (graph) edits += edited(graph, quick(), 50, random);
    }
  }
  EXPECT_GT(edits, 1000U);
}

}  // namespace
}  // namespace lacquer::test
