// The cpp target: what a compiler makes of its headers must be what the library packs, to the bit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "header_cases.h"
#include "packs.h"
#include "targets/target.h"

namespace lacquer::test {
using Json = nlohmann::json;

TEST(Header, BytesOfTheExamplesAreTheLibrarys) {
  std::vector<HeaderCase> cases;
  std::vector<std::vector<std::string>> expected;
  std::map<std::string, size_t> index;
  std::mt19937 random(1);
  eachExample(packingOptions(Target::Cpp), [&](Graph& graph, const Shader& shader) {
    const auto [it, fresh] = index.emplace(shader.id(), cases.size());
    if (fresh) {
      cases.push_back({shader.id(), shader.headerText(), shader.uniformSize(), {}});
      expected.emplace_back();
    }
    // Materials that share a shader share its header, whatever their numbers are.
    EXPECT_EQ(cases[it->second].text, shader.headerText());
    const Json parameters = Json::parse(graph.toJson())["parameters"];
    for (int row = 0; row < 30; ++row) {
      const Numbers numbers = row == 0   ? valuesOf(parameters)
                              : row < 20 ? randomValues(parameters, random)
                                         : outsideValues(parameters, random);
      cases[it->second].rows.push_back(numbers);
      expected[it->second].push_back(packedByLibrary(shader, numbers));
    }
  });
  ASSERT_GT(cases.size(), 10u);
  const auto packed = packedByCompiler(cases);
  ASSERT_EQ(packed.size(), cases.size());
  for (size_t i = 0; i < cases.size(); ++i)
    EXPECT_EQ(packed[i], expected[i]) << cases[i].id << "\n" << cases[i].text;
}

TEST(Header, NeutralValuesAreGltfsDefaults) {
  std::string all;
  eachExample(packingOptions(Target::Cpp), [&](Graph&, const Shader& shader) { all += shader.headerText(); });
  for (const char* line :
       {"double coat_ior = 1.5;", "double base_color_factor[4] = {1.0, 1.0, 1.0, 1.0};",
        "double coat_factor = 0.0;", "double metallic_factor = 1.0;", "double normal_scale = 1.0;",
        "double alpha_cutoff = 0.5;", "double emissive_factor[3] = {0.0, 0.0, 0.0};",
        "double coat_color_uv_scale[2] = {1.0, 1.0};", "double coat_color_uv_rotation = 0.0;",
        "double occlusion_strength = 1.0;", "double emissive_strength = 1.0;"}) {
    EXPECT_NE(all.find(line), std::string::npos) << line;
  }
}

TEST(Header, BakedHasNoBlock) {
  Options options = packingOptions(Target::Cpp);
  options.parameters = Parameters::Baked;
  std::vector<HeaderCase> cases;
  eachExample(options, [&](Graph&, const Shader& shader) {
    EXPECT_EQ(shader.uniformSize(), 0u);
    if (cases.empty()) cases.push_back({shader.id(), shader.headerText(), 0, {Numbers{}}});
  });
  const std::vector<std::vector<std::string>> nothing{{""}};
  EXPECT_EQ(packedByCompiler(cases), nothing);
}

TEST(Header, EveryOperationIsTheLibrarys) {
  std::vector<HeaderCase> cases;
  std::vector<std::vector<std::string>> expected;
  for (uint32_t seed = 0; seed < 6; ++seed) {
    const ir::Module module = randomPreshader(seed, 180, preshaderOps());
    ASSERT_TRUE(ir::verify(module).empty());
    const std::string id = fmt::format("random-{}", seed);
    HeaderCase one{id, targets::headerText(module, id, "a head").code, module.blocks[0].size, {}};
    const std::vector<Member> members = membersOf(one.text);
    const std::vector<uint32_t> used = ir::usedParameters(module);
    ASSERT_EQ(members.size(), used.size());
    std::mt19937 random(seed);
    std::vector<std::string> bytes;
    for (int row = 0; row < 40; ++row) {
      Numbers by_member;
      const Numbers by_name = randomNumbers(module, random, row % 5 == 0);
      for (size_t i = 0; i < used.size(); ++i)
        by_member[members[i].name] = by_name.at(module.parameters[used[i]].name);
      one.rows.push_back(by_member);
      bytes.push_back(evaluated(module, by_name));
    }
    cases.push_back(std::move(one));
    expected.push_back(std::move(bytes));
  }
  EXPECT_EQ(packedByCompiler(cases), expected);
}

}  // namespace lacquer::test
