// What is searched, how often, and what a higher level has more.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "eval/subject.h"
#include "lacquer/contract.h"
#include "optimize/optimize.h"
#include "passes/pipeline.h"
#include "setting/language.h"
#include "setting/options.h"
#include "shader/module.h"
#include "support/cases.h"

namespace lacquer::test::searches_test {
namespace {

Options oneLight() {
  Options options;
  options.targets = {Target::Spirv};
  options.validate = false;
  options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
  options.programs_model = true;
  return options;
}

/// A work as it comes to the search.
ir::Module beforeSearch(const std::string& work, bool ibl, const std::string& profile = "khr") {
  Options options = oneLight();
  options.ibl = ibl;
  options.profile = profile;
  const auto language = libraryFor(options);
  EXPECT_TRUE(resolveNames(**language, options));
  const std::string path = (sourceFolder() / "bench/works" / (work + ".gltf")).string();
  const Result<material::Document> document = readMaterials(path, **language, options);
  EXPECT_TRUE(document.has_value()) << path;
  const EvalSubject subject(document->materials[0]);
  Diagnostics warnings;
  const auto graph = subject.built(document->uses[0][0], **language, options, warnings);
  ir::Module before;
  const Result<ir::Module> module =
      toModule(*graph, **language, options, {}, [&](std::string_view pass, const ir::Module& after) {
        if (pass == "vertex") before = after;
      });
  EXPECT_TRUE(module);
  return before;
}

// A driver may count other cycles than the model: what a lower level would be chosen of, a higher one is,
// too.
TEST(Searches, AHigherLevelHasTheFormsOfALowerOne) {
  for (const char* work : {"w3"}) {
    const ir::Module module = beforeSearch(work, false);
    std::vector<Digest> forms;
    const std::vector<optimize::Candidate> more = optimize::search(module, {2, 0, nullptr});
    for (const optimize::Candidate& form : more) forms.push_back(passes::contentDigest(form.module));
    for (size_t i = 2; i < more.size(); ++i)
      EXPECT_LE(more[i].outcome.cycles, more[i - 1].outcome.cycles) << work;
    const std::vector<optimize::Candidate> fewer = optimize::search(module, {1, 0, nullptr});
    EXPECT_GT(fewer.size(), 1U) << work;
    for (const optimize::Candidate& form : fewer) {
      const Digest digest = passes::contentDigest(form.module);
      EXPECT_NE(std::find(forms.begin(), forms.end(), digest), forms.end()) << work;
    }
  }
}

// Where clamps that are idle in real numbers go, this work's colour may be negative by float32's ranges.
TEST(Searches, ClampsStayWhereRoundingMayPassTheirBounds) {
  EXPECT_GT(optimize::search(beforeSearch("w2", true, "physical"), {1, 0, nullptr}).size(), 1U);
}

// Light through the body has no largest value. Behind it errors are held against the plain form's by what is
// multiplied, in whatever order.
TEST(Searches, FormsOfLightThroughABodyAreFound) {
  EXPECT_GT(optimize::search(beforeSearch("b", false), {1, 0, nullptr}).size(), 1U);
}

// A material's own shader has other places beside a fallback than without one, and the same form.
TEST(Searches, AShaderBesideAFallbackIsSearchedOnce) {
  constexpr const char* kThree = R"({
    "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_sheen"],
    "materials": [
      {"name": "plain"},
      {"name": "coated", "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5}}},
      {"name": "cloth", "extensions": {"KHR_materials_sheen": {"sheenColorFactor": [1, 0.5, 0.25]}}}],
    "accessors": [{"count": 3, "type": "VEC3", "componentType": 5126}],
    "meshes": [{"primitives": [
      {"material": 0, "attributes": {"POSITION": 0, "NORMAL": 0}},
      {"material": 1, "attributes": {"POSITION": 0, "NORMAL": 0}},
      {"material": 2, "attributes": {"POSITION": 0, "NORMAL": 0}}]}]
  })";
  Options options = oneLight();
  options.ibl = false;
  options.optimize = 1;
  options.fallback = true;
  Messages messages;
  const Scene scene = Scene::fromMemory(kThree, "three", options, messages);
  ASSERT_TRUE(scene);
  const size_t before = optimize::searched();
  const Contract contract = lacquer::contract(scene, {}, options, messages);
  ASSERT_FALSE(hasError(messages));
  std::set<std::string> shaders;
  for (const auto& each : contract.shaders) shaders.insert(each.shader.id());
  EXPECT_EQ(shaders.size(), 4U);  // three, and what stands in for them
  EXPECT_EQ(optimize::searched() - before, shaders.size());
}

}  // namespace
}  // namespace lacquer::test::searches_test
