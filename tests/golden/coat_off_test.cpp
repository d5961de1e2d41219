// A coat of weight 0 is no coat: the shader of the material without it, byte for byte.
#include <gtest/gtest.h>

#include <set>

#include "compare.h"
#include "output.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCoats[] = {"KHR_materials_coat", "KHR_materials_clearcoat",
                                  "ADOBE_materials_clearcoat_tint"};

Json withWeightsZero(Json gltf) {
  for (Json& material : gltf["materials"]) {
    if (!material.contains("extensions")) continue;
    Json& extensions = material["extensions"];
    if (extensions.contains("KHR_materials_coat")) extensions["KHR_materials_coat"]["coatFactor"] = 0;
    if (extensions.contains("KHR_materials_clearcoat"))
      extensions["KHR_materials_clearcoat"]["clearcoatFactor"] = 0;
  }
  return gltf;
}

Json withoutCoats(Json gltf) {
  for (Json& material : gltf["materials"]) {
    for (const char* coat : kCoats) {
      if (material.contains("extensions")) material["extensions"].erase(coat);
    }
  }
  return gltf;
}

/// The shaders and uniforms of each use.
Json usesOf(const Json& manifest) {
  Json uses = Json::array();
  for (const Json& material : manifest["files"][0]["materials"]) {
    for (const Json& use : material["uses"])
      uses.push_back({use["attributes"], use["shader"], use["uniforms"]});
  }
  return uses;
}

void expectSame(const Json& one, const Json& other, const Options& options) {
  const Folder a;
  const Folder b;
  writeText(a / "in.gltf", one.dump());
  writeText(b / "in.gltf", other.dump());
  const Json with = generateWell({a / "in.gltf"}, a.path() / "out", options);
  const Json without = generateWell({b / "in.gltf"}, b.path() / "out", options);
  EXPECT_EQ(usesOf(with), usesOf(without));
  EXPECT_EQ(with["shaders"], without["shaders"]);
  // The manifests differ: one says that a coat was skipped.
  fs::remove(a.path() / "out" / "manifest.json");
  fs::remove(b.path() / "out" / "manifest.json");
  EXPECT_GT(filesOf(a.path() / "out").size(), 0u);
  EXPECT_EQ(outputDifferences(a.path() / "out", b.path() / "out"), "");
}

Options unvalidated(const std::string& template_name, Parameters parameters) {
  Options options;
  options.validate = false;
  options.template_name = template_name;
  options.parameters = parameters;
  return options;
}

TEST(CoatOff, weightZeroIsNoCoatInEveryExample) {
  for (const auto& [name, gltf] : exampleJson()) {
    SCOPED_TRACE(name);
    for (const char* template_name : {"forward", "surface", "bsdf"}) {
      for (const Parameters parameters : {Parameters::Uniform, Parameters::Baked}) {
        SCOPED_TRACE(template_name);
        expectSame(withWeightsZero(gltf), withoutCoats(gltf), unvalidated(template_name, parameters));
      }
    }
  }
}

/// The check can fail: a coat that is there is another shader.
TEST(CoatOff, weightAboveZeroIsAnotherShader) {
  const Folder a;
  const Folder b;
  const Json gltf = exampleJson().at("examples/coat.gltf");
  writeText(a / "in.gltf", gltf.dump());
  writeText(b / "in.gltf", withoutCoats(gltf).dump());
  const Options options = unvalidated("forward", Parameters::Uniform);
  EXPECT_NE(usesOf(generateWell({a / "in.gltf"}, a.path() / "out", options)),
            usesOf(generateWell({b / "in.gltf"}, b.path() / "out", options)));
}

/// The two materials that say so by their names.
TEST(CoatOff, examplesThatAreOffAreBaseShaders) {
  const Folder folder;
  const WorkingFolder here(sourceFolder());
  Options options;
  options.validate = false;
  const Json manifest =
      generateWell({"examples/clearcoat.gltf", "examples/coat.gltf"}, folder.path(), options);
  std::set<std::string> found;
  for (const Json& file : manifest["files"]) {
    for (const Json& material : file["materials"]) {
      const std::string name = material["name"];
      if (name != "No coat" && name != "Off") continue;
      found.insert(name);
      const std::string shader = material["uses"][0]["shader"];
      EXPECT_TRUE(shader.starts_with("forward-base-")) << name << ": " << shader;
      const std::string factor = name == "Off" ? "coatFactor" : "clearcoatFactor";
      EXPECT_EQ(material["skipped"]["coat"], factor + " is 0");
      const std::string text = readFile(folder / ("glsl/" + shader + ".frag.glsl"));
      EXPECT_EQ(text.find("coat"), std::string::npos) << text;
    }
  }
  EXPECT_EQ(found.size(), 2u);
}

}  // namespace
}  // namespace lacquer::test
