// Every extension whose terms cost something has words that make them cost less.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "graph/graph.h"
#include "lacquer.h"
#include "lod/estimate.h"
#include "setting/simplify.h"
#include "shader/module.h"
#include "shader/print.h"
#include "support/answers.h"
#include "support/materials.h"

namespace lacquer::test {
namespace {

using nlohmann::json;

/// A number of that property that is not its default, well inside of its range.
json otherThanDefault(const lang::PropertyDecl& decl) {
  if (decl.kind == material::Kind::Bool) return true;
  const double high = decl.tested.value_or(decl.range.hi);
  double x = 0.7;
  if (high <= 4 && std::isfinite(decl.range.lo)) x = decl.range.lo + 0.6 * (high - decl.range.lo);
  if (high > 4 && std::isfinite(high)) x = 1.7;  // an index of refraction
  if (decl.default_value && std::abs((*decl.default_value)[0] - x) < 0.01) x *= 0.8;
  const auto count = static_cast<size_t>(ir::componentCount(decl.type));
  if (count == 1) return x;
  std::vector<double> values;
  for (size_t i = 0; i < count; ++i) values.push_back(i == 3 ? 1 : x * (1 - 0.25 * static_cast<double>(i)));
  return values;
}

json bodyOf(const lang::ExtensionDecl& extension) {
  json body = json::object();
  for (const lang::PropertyDecl& decl : extension.properties) {
    if (decl.kind == material::Kind::Number || decl.kind == material::Kind::Bool)
      body[std::string(decl.name)] = otherThanDefault(decl);
  }
  return body;
}

/// The extension with what it needs and stands in, each with all of its numbers.
void put(json& material, const lang::ExtensionDecl& extension) {
  const material::Schema& schema = builtInSchema();
  const auto declOf = [&](std::string_view name) { return schema.extensions[*schema.find(name)]; };
  for (const std::string_view other : extension.needs) put(material, *declOf(other));
  json* at = &material;
  if (!extension.inside.empty()) {
    put(material, *declOf(extension.inside));
    at = &material["extensions"][std::string(extension.inside)];
  }
  json& own = (*at)["extensions"][std::string(extension.name)];
  const json before = own;
  own = bodyOf(extension);
  if (before.contains("extensions")) own["extensions"] = before["extensions"];
}

json plain() {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", {0.8, 0.4, 0.2, 1}}, {"metallicFactor", 0.3}, {"roughnessFactor", 0.5}}}};
}

/// What of others is there anyway, and decides whether an extension has a say: a body to look through.
json inGlass(const lang::ExtensionDecl& but) {
  json material = plain();
  for (const char* name : {"KHR_materials_transmission", "KHR_materials_volume"}) {
    if (but.name != name) put(material, *builtInSchema().extensions[*builtInSchema().find(name)]);
  }
  return material;
}

/// Those whose numbers are folded into others of the material's rate, or do nothing without a texture, or
/// make it cheaper, or leave no light.
const std::set<std::string> kCostNothing = {
    "ADOBE_materials_clearcoat_specular", "EXT_materials_anisotropy_openpbr", "EXT_materials_bump",
    "KHR_materials_clearcoat_ior",        "KHR_materials_emissive_strength",  "KHR_materials_unlit",
    "KHR_materials_volume_scatter"};

struct Made {
  material::Material material;
  std::shared_ptr<const Language> language;
  Options options;
  Scene scene;
  graph::Graph graph;
  ir::Module module;
  bool good = false;
};

/// The material's shader under one directional lamp and image-based light.
Made make(const json& material, const Strings& words) {
  Made made;
  made.options.targets = {Target::Spirv, Target::Glsl, Target::Hlsl};
  made.options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
  made.options.simplify = words;
  const Result<std::shared_ptr<const Language>> language = libraryFor(made.options);
  if (!language || !resolveNames(**language, made.options)) return made;
  made.language = *language;
  const std::string text = json{{"asset", {{"version", "2.0"}}}, {"materials", {material}}}.dump();
  const Result<material::Document> document = materialsOf(text, "m.gltf");
  EXPECT_TRUE(document && !hasError(document->materials[0].diagnostics))
      << text << " " << (document ? document->materials[0].diagnostics[0].message : "");
  if (!document) return made;
  made.material = document->materials[0];
  Messages messages;
  made.scene = Scene::fromMemory(text, "m.gltf", made.options, messages);
  Diagnostics warnings;
  Result<graph::Graph> graph = lacquer::buildGraph(made.material, {true, true, false, {true, true}},
                                                   *made.language, made.options, warnings);
  if (!graph || hasError(graph::check(*graph, *made.language))) return made;
  made.graph = std::move(*graph);
  Result<ir::Module> module = toModule(made.graph, *made.language, made.options, {});
  if (!module) return made;
  made.module = std::move(*module);
  made.good = true;
  return made;
}

uint64_t cyclesOf(const Made& made) { return lod::estimate(made.module).cycles; }

/// Straight on, from aside, and lit from behind, at both ends of a texture.
constexpr const char* kPoints = R"([
  {"n": [0, 0, 1], "v": [0, 0, 1], "l": [0.6, 0, 0.8], "env": [0.5, 0.6, 0.7]},
  {"n": [0, 0, 1], "v": [0.9950371902, 0, 0.0995037190], "l": [0, 0.9950371902, 0.0995037190], "env": [1, 1, 1]},
  {"n": [0, 0, 1], "v": [0.8, 0, 0.6], "l": [-0.8, 0, 0.6], "env": [0, 0, 0], "uv0": [1, 1]},
  {"n": [0, 0, 1], "v": [0, 0.6, 0.8], "l": [0, 0.6, -0.8], "env": [0.2, 0.1, 0.3]},
  {"n": [0, 0, 1], "v": [1, 0, 0], "l": [1, 0, 0], "env": [2, 2, 2]}])";

void expectGoodColors(const Made& made, const std::string& what) {
  Messages messages;
  const std::string answer =
      jsonOf(evaluate(made.scene, 0, kPoints, Engine::Float, {}, made.options, messages));
  ASSERT_FALSE(answer.empty()) << what << ": " << (messages.empty() ? "" : messages[0].text);
  for (const json& color : json::parse(answer)["rgba"]) {
    for (const json& channel : color) {
      ASSERT_TRUE(channel.is_number()) << what << " " << color.dump();
      EXPECT_GE(channel.get<double>(), 0) << what << " " << color.dump();
    }
  }
}

void expectValidCode(const Made& made, const std::string& what) {
  ShaderData data;
  data.id = "level";
  data.has_vertex = hasVertexStage(made.module);
  data.module = made.module;
  Options options = made.options;
  options.validate = true;
  Wrong wrong;
  print(data, options, wrong);
  for (const Diagnostics& of_target : wrong)
    EXPECT_FALSE(hasError(of_target)) << what << ": " << of_target[0].message;
}

class EveryExtension : public testing::TestWithParam<std::string> {};

/// What a lod of the library saves for the material, by name; those that change nothing or cost more are not
/// there. Each gives valid code and colours that are some.
std::vector<std::string> cheaperLods(const json& material, const Made& exact) {
  std::vector<std::string> cheaper;
  const std::string graph = graph::toJson(exact.graph);
  for (const std::string& word :
       possibleWords(exact.graph, &exact.material, *exact.language, exact.options)) {
    if (!word.starts_with("lod:")) continue;
    const Made simpler = make(material, {word});
    EXPECT_TRUE(simpler.good) << word;
    if (!simpler.good || graph::toJson(simpler.graph) == graph) continue;
    if (cyclesOf(simpler) >= cyclesOf(exact)) continue;
    cheaper.push_back(word);
    expectGoodColors(simpler, word);
    expectValidCode(simpler, word);
  }
  return cheaper;
}

TEST_P(EveryExtension, OffersCheaperShadersOfWhatItCosts) {
  const material::Schema& schema = builtInSchema();
  const lang::ExtensionDecl& extension = *schema.extensions[*schema.find(GetParam())];
  bool costs = false;
  std::set<std::string> own;
  for (const bool glass : {false, true}) {
    const auto excludes = [&](const lang::ExtensionDecl& decl) {
      return std::any_of(decl.excludes.begin(), decl.excludes.end(), [&](std::string_view other) {
        return other == "KHR_materials_transmission" || other == "KHR_materials_volume";
      });
    };
    if (glass && (excludes(extension) || GetParam() == "KHR_materials_pbrSpecularGlossiness" ||
                  GetParam() == "KHR_materials_unlit"))
      continue;
    // What it stands in or needs is there without it as well: what is compared is its own doing.
    json without = glass ? inGlass(extension) : plain();
    json with = without;
    put(with, extension);
    for (const std::string_view other : extension.needs)
      put(without, *schema.extensions[*schema.find(other)]);
    if (!extension.inside.empty()) put(without, *schema.extensions[*schema.find(extension.inside)]);
    const Made exact = make(with, {});
    const Made bare = make(without, {});
    ASSERT_TRUE(exact.good && bare.good);
    if (cyclesOf(exact) <= cyclesOf(bare)) continue;
    costs = true;
    const std::vector<std::string> offered = cheaperLods(with, exact);
    // One that the material without the extension has as well counts where it takes back half of what the
    // extension costs beside what it saves there.
    const std::string graph = graph::toJson(bare.graph);
    const double added = static_cast<double>(cyclesOf(exact)) - static_cast<double>(cyclesOf(bare));
    for (const std::string& word : offered) {
      const Made same = make(without, {word});
      const bool elsewhere = same.good && graph::toJson(same.graph) != graph;
      const double saved =
          static_cast<double>(cyclesOf(exact)) - static_cast<double>(cyclesOf(make(with, {word})));
      const double saved_there =
          same.good ? static_cast<double>(cyclesOf(bare)) - static_cast<double>(cyclesOf(same)) : 0;
      if (!elsewhere || saved - saved_there >= 0.5 * added) own.insert(word);
    }
    if (!own.empty()) break;
  }
  EXPECT_EQ(costs, !kCostNothing.contains(GetParam())) << GetParam();
  EXPECT_TRUE(!costs || !own.empty()) << GetParam() << " costs something, and no lod makes that less";
}

std::vector<std::string> extensions() {
  std::vector<std::string> names;
  for (const lang::ExtensionDecl* decl : builtInSchema().extensions) {
    if (!decl->core) names.emplace_back(decl->name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, EveryExtension, testing::ValuesIn(extensions()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace lacquer::test
