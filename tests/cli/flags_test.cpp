// The flags of a material: every verb that looks at one takes all of them, before and behind the file.
#include <gtest/gtest.h>

#include "command.h"

namespace lacquer::test::flags_test {
namespace {

using Words = std::vector<std::string>;
using nlohmann::json;

constexpr const char* kPoints = R"([{"n": [0, 0, 1], "v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8]}])";

const Words kFlags = {"--profile",
                      "physical",
                      "--template",
                      "forward",
                      "--switch",
                      "ibl=off",
                      "--simplify",
                      "without:coat.darkening",
                      "--live",
                      "coat.f0",
                      "--lights",
                      "directional:1",
                      "--params",
                      "baked",
                      "--relaxed",
                      "0.01",
                      "--dfg",
                      "fit",
                      "--no-multiple-scattering",
                      "--decode-srgb",
                      "--permissive",
                      "--no-ibl",
                      "--limit",
                      "images=1G",
                      "--nodes",
                      "more"};

Words joinedWords(const Words& a, const Words& b, const Words& c = {}) {
  Words all = a;
  all.insert(all.end(), b.begin(), b.end());
  all.insert(all.end(), c.begin(), c.end());
  return all;
}

struct Place : Workplace {
  Place() {
    write("points.json", kPoints);
    write("more/more.node", "");
    write("page.html", R"(<script type="application/json" id="files">[]</script>)");
  }
};

TEST(Flags, everyVerbOfMaterialsTakesAllBeforeAndBehindTheFile) {
  const Place place;
  const std::string coat = example("coat.gltf");
  const Words kVerbs[] = {
      {"gen", "-o", "out", "--target", "glsl", "--material", "Off"},
      {"plan", "-o", "out", "--ninja", "build.ninja", "--material", "Off"},
      {"graph", "--material", "Off"},
      {"dump", "--material", "Off"},
      {"prove", "--material", "Off"},
      {"eval", "--material", "Off", "--points", "points.json"},
      {"preview", "--material", "Off", "-o", "sheet.png", "--size", "16"},
      {"lod", "--material", "Off", "-o", "levels", "--size", "16", "--levels", "2", "--target", "spirv"},
      {"stress", "--samples", "16"},
      {"view", "-o", "view.html", "--page", "page.html", "--no-cost"},
  };
  for (const Words& verb : kVerbs) {
    SCOPED_TRACE(verb[0]);
    const Outcome before = place.run(joinedWords(verb, kFlags, {coat}));
    const Words name{verb[0]};
    const Outcome behind =
        place.run(joinedWords(name, {coat}, joinedWords(Words(verb.begin() + 1, verb.end()), kFlags)));
    // A file may be read, and what is found there be wrong: no flag is refused.
    EXPECT_NE(before.status, 2) << before.all();
    EXPECT_EQ(before.status, behind.status) << behind.all();
    EXPECT_EQ(before.out, behind.out);
    EXPECT_EQ(before.err, behind.err);
  }
}

/// The colour of the coated material of an example, with these flags.
std::vector<double> colorWith(const Words& flags) {
  const Place place;
  const Outcome outcome = place.run(joinedWords(
      {"eval", example("coat.gltf"), "--points", "points.json", "--material", "Weight and roughness",
       "--texel", "coatTexture=1,1,1,1", "--texel", "coatRoughnessTexture=1,1,1,1"},
      flags));
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  return outcome.status == 0 ? json::parse(outcome.out)["rgba"][0].get<std::vector<double>>()
                             : std::vector<double>();
}

TEST(Flags, theyMeanTheSameWhereColorsAreComputed) {
  const std::vector<double> usual = colorWith({});
  ASSERT_EQ(usual.size(), 4U);
  for (const Words& flags : {Words{"--profile", "physical"}, Words{"--simplify", "without:coat"}})
    EXPECT_NE(colorWith(flags), usual) << flags[1];
  for (const Words& flags :
       {Words{"--params", "baked"}, Words{"--lights", "directional:1"}, Words{"--lights", "scene"}}) {
    const std::vector<double> same = colorWith(flags);
    ASSERT_EQ(same.size(), 4U);
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(same[i], usual[i], 1e-12) << flags[0] << " " << flags[1];
  }
  // Without light there is none.
  EXPECT_EQ(colorWith({"--lights", "none"}), (std::vector<double>{0, 0, 0, 1}));
}

}  // namespace
}  // namespace lacquer::test::flags_test
