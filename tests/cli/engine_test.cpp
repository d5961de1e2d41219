// Templates of others: the made-up engine's in examples/engine, and one with more textures than the
// library's.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "command.h"
#include "vulkan/run.h"

namespace lacquer::test {
namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;

std::string pointsOfTheExample() {
  std::ifstream in(example("engine/points.json"));
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Resources of all shaders of a manifest; fails where two are in one place.
std::set<std::string> resources(const Json& manifest) {
  std::set<std::string> names;
  for (const Json& shader : manifest["shaders"]) {
    for (const Json& valid : shader["validated"]) EXPECT_EQ(valid, true);
    std::map<std::pair<int, int>, std::string> places;
    std::map<std::pair<bool, int>, std::string> flat;
    for (const char* list : {"uniforms", "textures"}) {
      for (const Json& resource : shader[list]) {
        const bool block = resource.contains("block");
        const std::string name = resource[block ? "block" : "name"];
        names.insert(fmt::format("{} {}.{} {}", name, resource["set"].get<int>(),
                                 resource["binding"].get<int>(), resource["flat"].get<int>()));
        const auto& [at, fresh] = places.try_emplace({resource["set"], resource["binding"]}, name);
        EXPECT_TRUE(fresh) << name << " is where " << at->second << " is";
        const auto& [number, first] = flat.try_emplace({block, resource["flat"]}, name);
        EXPECT_TRUE(first) << name << " has the number of " << number->second;
      }
    }
  }
  return names;
}

std::string joined(const std::set<std::string>& names) { return fmt::format("{}", fmt::join(names, "\n")); }

std::vector<std::array<double, 4>> colors(const Workplace& place, const Words& more) {
  Words words = {"eval",       example("clearcoat.gltf"),
                 "--material", "Varnish",
                 "--nodes",    example("engine"),
                 "--template", "engine",
                 "--points",   "points.json"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = place.run(words);
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  std::vector<std::array<double, 4>> result;
  if (outcome.status == 0) result = Json::parse(outcome.out)["rgba"];
  return result;
}

const Words kClear = {"--texel", "fog_shape=1,0,0,0", "--texel", "grain=0.5,0.5,0.5,0"};

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST(Engine, EveryTargetIsValidAndNothingSharesAPlace) {
  const Workplace place;
  const Outcome outcome = place.run({"gen", example("coat.gltf"), example("core.gltf"), "--nodes",
                                     example("engine"), "--template", "engine", "-o", "out"});
  ASSERT_EQ(outcome.status, 0) << outcome.all();
  const std::set<std::string> found = resources(Json::parse(place.read("out/manifest.json")));
  for (const char* wanted : {"Frame 0.0 0", "Lights 0.1 1", "Atmosphere 0.5 4", "Shadow 0.6 5",
                             "shadow_near 0.7 3", "shadow_far 0.8 4", "fog_shape 0.9 5", "grain 0.10 6",
                             "Material 1.0 2", "Object 2.0 3", "base_color_texture 1.1 7"}) {
    EXPECT_TRUE(found.contains(wanted)) << wanted << " is not among\n" << joined(found);
  }
}

TEST(Engine, ShadowFogExposureAndGrainDoWhatTheySay) {
  const Workplace place;
  place.write("points.json", pointsOfTheExample());
  const auto lit = colors(place, kClear);
  ASSERT_EQ(lit.size(), 3U);
  const auto dark =
      colors(place, with(kClear, {"--texel", "shadow_near=0,0,0,0", "--texel", "shadow_far=0,0,0,0"}));
  // In front of half the map's depth: the first point lies behind it, the second before.
  const auto half =
      colors(place, with(kClear, {"--texel", "shadow_near=0.5,0,0,0", "--texel", "shadow_far=0,0,0,0"}));
  ASSERT_EQ(dark.size(), 3U);
  ASSERT_EQ(half.size(), 3U);
  const double cover = 1 - std::exp(-0.2);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT(dark[i][0], lit[i][0]) << i;
    // What is left without light is the fog.
    const double fog = 0.4 * cover * 1.5;
    EXPECT_NEAR(dark[i][0], fog / (1 + fog), 1e-9) << i;
  }
  EXPECT_EQ(half[0], dark[0]);
  EXPECT_EQ(half[1], lit[1]);
  const auto grained = colors(place, with(kClear, {"--texel", "grain=1.5,0.5,0.5,0"}));
  EXPECT_NEAR(grained[0][0], 2 * lit[0][0], 1e-9);
  EXPECT_EQ(grained[0][1], lit[0][1]);
}

TEST(Engine, TheDeviceGivesTheColorsOfTheCpu) {
  if (!vulkan::Device::open()) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const Workplace place;
  place.write("points.json", pointsOfTheExample());
  const Words texels = with(kClear, {"--texel", "shadow_near=0.5,0,0,0", "--texel", "shadow_far=0.9,0,0,0"});
  const auto right = colors(place, with(texels, {"--engine", "float"}));
  ASSERT_EQ(right.size(), 3U);
  for (const char* route : {"direct", "glslang", "hlsl"}) {
    const auto found = colors(place, with(texels, {"--engine", "vulkan", "--spirv-from", route}));
    ASSERT_EQ(found.size(), right.size());
    for (size_t i = 0; i < right.size(); ++i) {
      for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(found[i][c], right[i][c], 1e-5) << route << " " << i;
    }
  }
}

TEST(Engine, WrongUniformsAreSaid) {
  const std::pair<const char*, const char*> kWrong[] = {
      {R"({"frame.exposures": 1})", "the template 'engine' has no field 'frame.exposures'"},
      {R"({"frame.exposure": [1, 2]})", "'frame.exposure' is given 2 numbers"},
      {R"({"shadow.bias": 2})", "'shadow.bias' is 2"},
      {R"({"shadow.bias": "much"})", "/uniforms/shadow.bias"},
      {R"([1])", "/uniforms"},
  };
  for (const auto& [uniforms, said] : kWrong) {
    const Workplace place;
    place.write("points.json", fmt::format(R"({{"uniforms": {}, "points": [{{}}]}})", uniforms));
    const Outcome outcome =
        place.run(with({"eval", example("clearcoat.gltf"), "--material", "Varnish", "--nodes",
                        example("engine"), "--template", "engine", "--points", "points.json"},
                       kClear));
    EXPECT_EQ(outcome.status, 1) << uniforms;
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
  }
}

TEST(Templates, AFourthTextureHasItsOwnPlace) {
  const Workplace place;
  std::filesystem::create_directory(place / "more");
  place.write("more/more.node", R"(/// One texture more.
template more extends forward {
    environment sampler2D shade;
    given vec4 shadow = textureLod(shade, uv0, 0);
    replace output color vec4 color = vec4(sum_over_lights(direct * light_sample.radiance), alpha) * shadow;
}
)");
  const Outcome outcome =
      place.run({"gen", example("core.gltf"), "--nodes", "more", "--template", "more", "-o", "out"});
  ASSERT_EQ(outcome.status, 0) << outcome.all();
  const std::set<std::string> found = resources(Json::parse(place.read("out/manifest.json")));
  for (const char* wanted : {"shade 0.5 3", "base_color_texture 1.1 4"})
    EXPECT_TRUE(found.contains(wanted)) << wanted << " is not among\n" << joined(found);
}

TEST(Templates, TheLastDefaultIsMeantWhereNoneIsNamed) {
  const Workplace place;
  std::filesystem::create_directory(place / "more");
  place.write("more/more.node", "/// D.\ntemplate mine extends forward { default; }\n");
  const Words words = {"gen", example("core.gltf"), "--material", "Textured", "--target", "glsl", "-o"};
  ASSERT_EQ(place.run(with(words, {"out"})).status, 0);
  EXPECT_NE(place.read("out/manifest.json").find("\"template\": \"forward\""), std::string::npos);
  ASSERT_EQ(place.run(with(words, {"out", "--nodes", "more"})).status, 0);
  EXPECT_NE(place.read("out/manifest.json").find("\"template\": \"mine\""), std::string::npos);
}

TEST(Templates, WordsOfTheTargetsAreNoNames) {
  const Workplace place;
  std::filesystem::create_directory(place / "more");
  place.write("more/more.node", R"(/// D.
template more extends forward {
    block frame Film film { float sample; }
    replace output color vec4 color = vec4(film.sample);
}
)");
  const Outcome outcome = place.run({"gen", example("core.gltf"), "--material", "Textured", "--nodes", "more",
                                     "--template", "more", "-o", "out"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("'sample' in the template 'more' is no name in every target"), std::string::npos)
      << outcome.err;
}

TEST(Templates, LightsAreThoseThatTheTemplateNames) {
  const std::pair<const char*, const char*> kWrong[] = {
      {"moon",
       "the template 'forward' has no kind of light 'moon' [unknown-light]\n  help: it has directional, "
       "point, spot"},
      {"point:17", "there are 17 lights [too-many-lights]\n  help: the template 'forward' has room for 16"},
      {"point:9,spot:9", "there are 18 lights"},
  };
  for (const auto& [lights, said] : kWrong) {
    const Workplace place;
    const Outcome outcome =
        place.run({"gen", example("core.gltf"), "--material", "Textured", "-o", "out", "--lights", lights});
    EXPECT_EQ(outcome.status, 1) << lights;
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
  }
}

}  // namespace lacquer::test
