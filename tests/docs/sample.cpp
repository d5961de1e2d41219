#include "docs/sample.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "docs/page.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test {

namespace {

using lang::PropertyDecl;
using material::Kind;

/// A value that is not the default; textures count up, and take a UV set each in turn, so that all are used.
Json valueOf(const PropertyDecl& decl, int& textures) {
  const ir::Components by_default = decl.default_value.value_or(ir::Components{});
  const auto number = [&](size_t i) { return decl.range.hi == 1 ? 0.5 : by_default[i] + 0.5; };
  switch (decl.kind) {
    case Kind::Bool: return true;
    case Kind::Choice: return decl.choices.at(1);
    case Kind::Texture: {
      Json info = {{"index", textures}, {"texCoord", textures++ % 4}};
      for (const PropertyDecl& member : decl.members)
        info[std::string(member.name)] = valueOf(member, textures);
      return info;
    }
    case Kind::Object: {
      Json object = Json::object();
      for (const PropertyDecl& member : decl.members)
        object[std::string(member.name)] = valueOf(member, textures);
      return object;
    }
    case Kind::Number: break;
  }
  if (decl.type == ir::Type::Float) return number(0);
  Json array = Json::array();
  for (int i = 0; i < ir::componentCount(decl.type); ++i) array.push_back(number(static_cast<size_t>(i)));
  return array;
}

Json objectOf(const lang::ExtensionDecl& decl, int& textures) {
  Json object = Json::object();
  std::set<std::string_view> roles;
  for (const PropertyDecl& one : decl.properties) {
    // Of two spellings the first has a say.
    if (one.kind == Kind::Object || roles.insert(one.role).second)
      object[std::string(one.name)] = valueOf(one, textures);
  }
  return object;
}

const lang::ExtensionDecl& extensionOf(std::string_view name) {
  const material::Schema& schema = builtInSchema();
  return *schema.extensions.at(schema.find(name).value_or(0));
}

/// Puts an extension's object where it belongs, and beside it what it needs; returns its pointer.
std::string place(Json& material, const std::string& name, int& textures) {
  const material::Schema& schema = builtInSchema();
  const lang::ExtensionDecl& decl = extensionOf(name);
  for (const std::string_view other : decl.needs)
    material["extensions"][std::string(other)] = objectOf(extensionOf(other), textures);
  if (!decl.inside.empty())
    material["extensions"][std::string(decl.inside)] = objectOf(extensionOf(decl.inside), textures);
  const std::string pointer = "/" + schema.pathOf(*schema.find(name));
  material[Json::json_pointer(pointer)] = objectOf(decl, textures);
  return pointer;
}

/// What must stand beside an extension for all of its properties to be seen, and a template that takes them.
struct Stage {
  std::vector<std::string> beside;
  std::string template_name;
};
const std::map<std::string, Stage> kStages = {
    {"KHR_materials_volume", {{"KHR_materials_transmission"}, {}}},
    {"KHR_materials_dispersion", {{"KHR_materials_transmission", "KHR_materials_volume"}, {}}},
    {"KHR_materials_volume_scatter", {{"KHR_materials_transmission"}, "bsdf"}},
};

FullMaterial fullMaterial(const std::string& extension) {
  const auto stage = kStages.find(extension);
  int textures = 0;
  Json material = objectOf(extensionOf({}), textures);
  material["name"] = "everything";
  FullMaterial full{extension, {}, {}};
  if (!extension.empty()) full.place = place(material, extension, textures);
  Options options;
  if (stage != kStages.end()) {
    for (const std::string& other : stage->second.beside) place(material, other, textures);
    options.template_name = stage->second.template_name;
  }
  Json root = {{"asset", {{"version", "2.0"}}}, {"materials", Json::array({material})}};
  root["textures"] = std::vector<Json>(static_cast<size_t>(textures), Json::object());
  full.made = make(root.dump(), options);
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
    for (const lang::ExtensionDecl* decl : builtInSchema().extensions) {
      // What shows the base colour alone has nothing else to show.
      if (!decl->core && !decl->properties.empty()) all.push_back(fullMaterial(std::string(decl->name)));
    }
    return all;
  }();
  return kAll;
}

}  // namespace lacquer::test
