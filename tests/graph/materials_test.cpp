// The graphs that are built from materials, with the library that is embedded: each passes the check and
// reads back.
#include <gtest/gtest.h>

#include "graph/sample.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test::materials_test {
namespace {

void buildAndCheck(const material::Material& material, const gltf::VertexAttributes& attributes,
                   const BuildSetup& setup) {
  Diagnostics warnings;
  graph::Graph graph = buildGraph(material, attributes, setup, warnings);
  EXPECT_FALSE(hasError(warnings)) << formatAll(warnings);
  const std::vector<graph::Node> built = graph.nodes;
  EXPECT_EQ(formatAll(graph::check(graph, builtInLibrary())), "") << toJson(graph);
  EXPECT_EQ(formatAll(graph::doubts(graph, builtInLibrary())), "") << "no node gives more than is taken";
  EXPECT_EQ(graph.nodes, built) << "sources stand before their users already";
  const std::string text = toJson(graph);
  EXPECT_EQ(toJson(graphOf(text)), text);
}

void buildMaterials(const std::filesystem::path& file) {
  const auto document = materialsOf(readFile(file), file.filename().string());
  if (!document) GTEST_SKIP() << "is about a file that cannot be read";
  for (const material::Material& material : document->materials) {
    if (hasError(material.diagnostics)) continue;
    for (const std::string template_name : {"forward", "surface", "bsdf"}) {
      for (const bool rich : {false, true}) {
        gltf::VertexAttributes attributes;
        attributes.normal = attributes.tangent = rich;
        attributes.texCoord = {true, rich, rich, rich};
        BuildSetup setup;
        setup.template_name = template_name;
        setup.decode_srgb = setup.multiple_scattering = rich;
        SCOPED_TRACE(template_name + (rich ? ", with all attributes, " : ", with few attributes, ") +
                     material.name);
        buildAndCheck(material, attributes, setup);
      }
    }
  }
}

const bool kRegistered =
    registerFiles("GraphMaterial", sourceFolder() / "tests/gltf/cases", ".gltf", buildMaterials);

TEST(GraphMaterials, areRegistered) { EXPECT_TRUE(kRegistered); }

}  // namespace
}  // namespace lacquer::test::materials_test
