#include "docs/sample.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "docs/page.h"
#include "gltf/table.h"
#include "support/cases.h"

namespace lacquer::test {

namespace {

using gltf::Kind;
using gltf::TableRow;

constexpr std::string_view kClearcoat = "KHR_materials_clearcoat";

/// A value that is not the default; textures count up.
Json valueOf(const gltf::PropertyFacts& facts, int& textures) {
  const auto number = [&](size_t i) { return facts.range.max == 1 ? 0.5 : facts.by_default[i] + 0.5; };
  switch (facts.kind) {
    case Kind::Number: return number(0);
    case Kind::Boolean: return true;
    case Kind::String: return "everything";
    case Kind::AlphaMode: return "MASK";
    case Kind::TextureIndex:
    case Kind::TexCoord: return 0;
    case Kind::Vec2:
    case Kind::Color3:
    case Kind::Color4: {
      Json array = Json::array();
      for (size_t i = 0; i < gltf::elementCount(facts.kind); ++i) array.push_back(number(i));
      return array;
    }
    // A UV set each in turn, so that all are used.
    case Kind::Texture: return {{"index", textures}, {"texCoord", textures++ % 4}};
    case Kind::NormalTexture: return {{"index", textures}, {"texCoord", textures++ % 4}, {"scale", 1.5}};
    case Kind::OcclusionTexture:
      return {{"index", textures}, {"texCoord", textures++ % 4}, {"strength", 0.5}};
    case Kind::Object: break;
  }
  return {};
}

Json objectOf(std::string_view name, int& textures) {
  Json object = Json::object();
  for (const TableRow& row : gltf::tableRows()) {
    if (row.object == name) object[std::string(row.facts.name)] = valueOf(row.facts, textures);
  }
  return object;
}

/// Puts an extension's object where it belongs; returns its pointer.
std::string place(Json& material, const std::string& name, int& textures) {
  const std::string_view where = gltf::placeOf(name).where;
  Json& extensions = material["extensions"];
  if (extensions.is_null()) extensions = Json::object();
  if (name.find("clearcoat") != std::string::npos)
    extensions[std::string(kClearcoat)] = objectOf(kClearcoat, textures);
  if (where.starts_with(kClearcoat)) {
    extensions[std::string(kClearcoat)]["extensions"][name] = objectOf(name, textures);
    return "/extensions/KHR_materials_clearcoat/extensions/" + name;
  }
  if (where == "a textureInfo's extensions") {
    material["pbrMetallicRoughness"]["baseColorTexture"]["extensions"][name] = objectOf(name, textures);
    return "/pbrMetallicRoughness/baseColorTexture/extensions/" + name;
  }
  if (name != kClearcoat) extensions[name] = objectOf(name, textures);
  return "/extensions/" + name;
}

FullMaterial fullMaterial(const std::string& extension) {
  int textures = 0;
  Json material = objectOf("material", textures);
  material["pbrMetallicRoughness"] = objectOf("pbrMetallicRoughness", textures);
  FullMaterial full{extension, {}, {}};
  if (!extension.empty()) full.place = place(material, extension, textures);
  Json root = {{"asset", {{"version", "2.0"}}}, {"materials", Json::array({material})}};
  root["textures"] = std::vector<Json>(static_cast<size_t>(textures), Json::object());
  full.made = make(root.dump(), {});
  return full;
}

/// The text between `<<'END'` and `END` of the page's first command that has such.
std::string nodeOfTheTutorial() {
  constexpr std::string_view kBegin = "<<'END'\n";
  const std::string page = readFile(sourceFolder() / "docs/adding-a-node.md");
  const size_t begin = page.find(kBegin);
  const size_t end = page.find("\nEND\n", begin);
  if (begin == std::string::npos || end == std::string::npos) {
    ADD_FAILURE() << "docs/adding-a-node.md writes no node";
    return {};
  }
  return page.substr(begin + kBegin.size(), end + 1 - begin - kBegin.size());
}

/// The same edits as on the page.
Made makeDusty() {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "lacquer_docs_dust";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "coat_dust.node") << nodeOfTheTutorial();
  Options options;
  options.ibl = false;
  options.validate = false;
  options.node_directories = {folder.string()};
  Made made = make(readFile(sourceFolder() / "examples/clearcoat.gltf"), options);
  Graph& graph = made.graph;
  Messages messages;
  bool done = graph && graph.setParameter("dust_amount", {0.4}, messages) &&
              graph.addNode("coat.dust", "coat_dust", messages);
  for (const auto& [input, source] : std::initializer_list<std::pair<const char*, const char*>>{
           {"below", R"({"node": "coat.layer_direct"})"},
           {"color", "[0.5, 0.45, 0.4]"},
           {"amount", R"({"parameter": "dust_amount"})"},
           {"NdotL", R"({"node": "base.cosines", "output": "NdotL"})"},
           {"cosine", R"({"node": "coat.view_cosine"})"}}) {
    done = done && graph.connect("coat.dust", input, source, messages);
  }
  done = done && graph.setOutput("direct", R"({"node": "coat.dust"})", messages);
  EXPECT_TRUE(done);
  if (done) made.shader = graph.generate(options, messages);
  for (const Message& message : messages) ADD_FAILURE() << message.text;
  if (made.shader) made.interface = Json::parse(made.shader.interfaceJson());
  std::filesystem::remove_all(folder);
  return made;
}

}  // namespace

Made make(const std::string& gltf, const Options& options) {
  Options fast = options;
  fast.validate = false;  // others test that
  Messages messages;
  Made made;
  const Scene scene = Scene::fromMemory(gltf, "example.gltf", fast, messages);
  if (scene) made.graph = scene.graph(0, {true, true, true, {true, true, true, true}}, fast, messages);
  if (made.graph) made.shader = made.graph.generate(fast, messages);
  for (const Message& message : messages) ADD_FAILURE() << message.text;
  if (!made.shader) return made;
  made.graph_json = Json::parse(made.graph.toJson());
  made.interface = Json::parse(made.shader.interfaceJson());
  return made;
}

std::string readmeGltf() {
  for (const Fence& fence : fences(readFile(sourceFolder() / "README.md"))) {
    if (fence.language == "json") return fence.text;
  }
  ADD_FAILURE() << "README.md has no example";
  return "{}";
}

const Made& readmeExample() {
  static const Made kMade = make(readmeGltf(), {});
  return kMade;
}

const Made& dustyExample() {
  static const Made kMade = makeDusty();
  return kMade;
}

const std::vector<FullMaterial>& fullMaterials() {
  static const std::vector<FullMaterial> kAll = [] {
    std::vector<FullMaterial> all;
    all.push_back(fullMaterial({}));
    std::set<std::string> seen;
    for (const TableRow& row : gltf::tableRows()) {
      const std::string name(row.object);
      if (gltf::placeOf(name).where.empty() || !seen.insert(name).second) continue;
      all.push_back(fullMaterial(name));
    }
    return all;
  }();
  return kAll;
}

}  // namespace lacquer::test
