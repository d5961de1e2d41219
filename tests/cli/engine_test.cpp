// Templates of others: the made-up engine's in examples/engine, and one with more textures than the
// library's.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "command.h"
#include "vulkan/run.h"

namespace lacquer::test::engine_test {
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
  EXPECT_NE(outcome.err.find("more/more.node:3:35: error: 'sample' is no name in every target"),
            std::string::npos)
      << outcome.err;
}

/// Runs `lacquer gen` with a template `b`.
Outcome genWith(const Workplace& place, const std::string& node, const Words& more = {}) {
  std::filesystem::create_directory(place / "more");
  place.write("more/more.node", node);
  return place.run(with({"gen", example("core.gltf"), "--material", "Textured", "--nodes", "more",
                         "--template", "b", "-o", "out"},
                        more));
}

TEST(Templates, WhatExtendsBlocksCanBeExtended) {
  const Workplace place;
  const Outcome outcome = genWith(place, R"(/// D.
template a extends engine { extend block frame { float gamma in [0.1, 4] = 2; } }
/// D.
template b extends a {
    extend block frame { float gain = 1; }
    extend block atmosphere { float height = 1; }
    output color vec4 other = vec4(frame.exposure, frame.gamma, frame.gain, atmosphere.height);
}
)",
                                  {"--nodes", example("engine")});
  ASSERT_EQ(outcome.status, 0) << outcome.all();
  const Json manifest = Json::parse(place.read("out/manifest.json"));
  EXPECT_TRUE(resources(manifest).contains("Atmosphere 0.5 4"));
  std::string fields;
  for (const Json& block : (*manifest["shaders"].begin())["uniforms"]) {
    if (block["block"] != "Frame") continue;
    for (const Json& field : block["fields"]) fields += field["name"].get<std::string>() + " ";
  }
  EXPECT_NE(fields.find("light_count exposure gamma gain "), std::string::npos) << fields;
}

/// A field of an object is the same for all of its fragments: it takes no interpolant.
TEST(Templates, FieldsOfAnObjectAreReadInBothStages) {
  const Workplace place;
  const Outcome outcome = genWith(place, R"(/// D.
template b extends forward {
    block object Look look { vec4 tint; vec4 shift; }
    replace output position vec4 position_clip = frame.view_projection * (world + look.shift);
    output color vec4 tinted = look.tint + dFdx(look.tint);
}
)",
                                  {"--target", "glsl,essl,hlsl,spirv,msl,wgsl"});
  ASSERT_EQ(outcome.status, 0) << outcome.all();
  const Json manifest = Json::parse(place.read("out/manifest.json"));
  const Json& shader = *manifest["shaders"].begin();
  const std::string fragment = place.read("out/" + shader["files"]["glsl"]["frag"].get<std::string>());
  EXPECT_NE(fragment.find("tinted = look.tint"), std::string::npos) << fragment;
  for (const Json& binding : shader["webgpu"]["bindings"]) {
    if (binding["name"] != "look") continue;
    EXPECT_EQ(binding["visibility"], Json::parse(R"(["vertex", "fragment"])"));
  }
}

TEST(Templates, NoNameOfATemplateMeetsOneOfAMaterial) {
  const std::pair<const char*, const char*> kParts[] = {
      {"block frame base_color_texture film { vec4 x; }", "film.x"},
      {"block frame Film base_color_texture { vec4 x; }", "base_color_texture.x"},
      {"environment sampler2D base_color_texture_sampler;", "texture(base_color_texture_sampler, uv0)"},
  };
  for (const auto& [part, value] : kParts) {
    const Workplace place;
    const Outcome outcome = genWith(
        place, fmt::format("/// D.\ntemplate b extends forward {{ {} output color vec4 more = {}; }}\n", part,
                           value));
    EXPECT_EQ(outcome.status, 0) << part << outcome.all();
  }
}

TEST(Templates, WhatPlatformsDoNotHaveIsSaid) {
  std::string outputs, textures, sum = "vec4(0)";
  for (int i = 0; i < 8; ++i) outputs += fmt::format("output color vec4 o{} = vec4(1);\n", i);
  for (int i = 0; i < 17; ++i) {
    textures += fmt::format("environment sampler2D t{};\n", i);
    sum += fmt::format(" + texture(t{}, uv0)", i);
  }
  struct Over {
    std::string parts;
    Words options;
    int status;
    std::string said;
  };
  const auto block = [](const char* field) {
    return fmt::format("block frame Q q {{ {} }} output color vec4 o = q.a[0];", field);
  };
  const Over kOver[] = {
      {outputs,
       {"--target", "glsl,glsl-gl,essl,hlsl,spirv"},
       1,
       "error: the shader has 9 colour outputs; no device has more than 8 in glsl, 8 in glsl-gl, "
       "8 in essl, 8 in hlsl, 8 in spirv [over-limit]"},
      {textures + "output color vec4 o = " + sum + ";",
       {"--target", "essl"},
       0,
       "textures; sure to be there are: 16 in essl"},
      {block("vec4 a[256]; mat4 b[256];"),
       {"--target", "essl,hlsl"},
       0,
       "warning: the block 'Q' has 20480 bytes; sure to be there are: 16384 in essl"},
      {block("vec4 a[256]; mat4 b[256]; mat4 c[256]; mat4 d[256]; mat4 e[256];"),
       {"--target", "hlsl"},
       1,
       "error: the block 'Q' has 69632 bytes; no device has more than 65536 in hlsl"},
      {block("vec4 a[256]; mat4 b[128];"), {}, 0, ""},
  };
  for (const auto& [parts, options, status, said] : kOver) {
    const Workplace place;
    const Outcome outcome =
        genWith(place, "/// D.\ntemplate b extends forward {\n" + parts + "\n}\n", options);
    EXPECT_EQ(outcome.status, status) << outcome.all();
    EXPECT_NE(outcome.err.find(said), std::string::npos) << said << "\n" << outcome.all();
    EXPECT_EQ(outcome.err.find("over-limit") == std::string::npos, said.empty()) << outcome.all();
    // A second run finds what the first left, and says so again.
    const Outcome again = genWith(place, place.read("more/more.node"), options);
    EXPECT_NE(again.err.find(said), std::string::npos) << said << "\n" << again.all();
  }
}

TEST(Templates, PointsWhoseLightGoesNowhereAreToldSo) {
  const Workplace place;
  std::filesystem::create_directory(place / "more");
  place.write("more/more.node", R"(/// D.
template b {
    block frame Frame frame { int n in [0, 8] = 1; }
    block lights Area area[8] count frame.n { vec3 radiance in [0, inf]; }
    light kind disk { radiance = color * intensity; }
    output color vec4 color = vec4(sum_over_lights(area.radiance), 1);
}
)");
  const auto eval = [&](const std::string& points, const std::string& engine) {
    place.write("points.json", points);
    return place.run({"eval", example("core.gltf"), "--material", "Textured", "--nodes", "more", "--template",
                      "b", "--points", "points.json", "--engine", engine});
  };
  for (const char* engine : {"double", "float"}) {
    const Outcome dark = eval(R"({"points": [{}]})", engine);
    EXPECT_EQ(dark.status, 0) << dark.all();
    EXPECT_NE(dark.err.find("the points' 'l' and 'light' go nowhere"), std::string::npos) << dark.err;
    EXPECT_NE(dark.err.find("\"uniforms\" what its light is: \"area.radiance\""), std::string::npos)
        << dark.err;
    const Outcome lit = eval(R"({"uniforms": {"area.radiance": [1, 2, 3]}, "points": [{}]})", engine);
    ASSERT_EQ(lit.status, 0) << lit.all();
    EXPECT_EQ(lit.err.find("go nowhere"), std::string::npos) << lit.err;
    EXPECT_EQ(Json::parse(lit.out)["rgba"][0], Json({1, 2, 3, 1}));
  }
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

/// A file with one material on two primitives, of which the second has an attribute of the application's own.
static std::string wetGltf() {
  return R"({"asset": {"version": "2.0"}, "materials": [{"name": "wet"}],
    "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
                  {"componentType": 5126, "count": 3, "type": "SCALAR"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}, "material": 0},
                               {"attributes": {"POSITION": 0, "NORMAL": 0, "_WETNESS": 1}, "material": 0}]}],
    "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]})";
}

/// By glTF's own spelling, and by that without the underscore.
TEST(Templates, AnAttributeOfOnesOwnIsThereWhereThePrimitiveHasIt) {
  for (const std::string name : {"_WETNESS", "WETNESS"}) {
    const Workplace place;
    place.write("wet.gltf", wetGltf());
    place.write("more/wet.node",
                "/// T.\ntemplate wet extends forward {\n    optional attribute float " + name +
                    ";\n    given float wet in [0, 1] = has_WETNESS ? clamp(interpolate(" + name +
                    "), 0, 1) : 0.25;\n"
                    "    replace output color vec4 color = vec4(wet, 0, 0, 1);\n}\n");
    const Outcome outcome = place.run({"gen", "wet.gltf", "--nodes", "more", "--template", "wet", "-o", "out",
                                       "--target", "glsl,glsl-gl,essl,hlsl,spirv"});
    ASSERT_EQ(outcome.status, 0) << outcome.all();
    EXPECT_EQ(outcome.err, "");
    std::set<std::string> with, without;
    for (const std::string& file : place.names()) {
      if (file.find("glsl/") == std::string::npos || file.find(".vert") == std::string::npos) continue;
      const std::string text = place.read(file);
      EXPECT_EQ(text.find("__"), std::string::npos) << text;
      (text.find("in_wetness") == std::string::npos ? without : with).insert(file);
    }
    EXPECT_FALSE(with.empty());
    EXPECT_FALSE(without.empty()) << "the first primitive has none";
    const Json uses = place.manifest("out")["files"][0]["materials"][0]["uses"];
    ASSERT_EQ(uses.size(), 2U);
    EXPECT_NE(uses[0]["shader"], uses[1]["shader"]);
  }
}

TEST(Templates, OneAttributeHasOneSpelling) {
  const Workplace place;
  place.write("more/wet.node",
              "/// T.\ntemplate wet extends forward {\n    attribute float WETNESS;\n    attribute float "
              "_WETNESS;\n}\n");
  const Outcome outcome = place.run({"nodes", "--nodes", "more"});
  EXPECT_EQ(outcome.status, 1) << outcome.all();
  EXPECT_NE(outcome.err.find("[duplicate-name]"), std::string::npos) << outcome.all();
}

/// Whoever writes a page gives the counts: in WebGL and WebGPU no loop leaves an array or a list.
TEST(Templates, LoopsOfTheWebEndWithTheirArrays) {
  const Workplace place;
  for (const char* name : {"forward", "forward_clustered"}) {
    const Outcome outcome = place.run({"gen", example("coat.gltf"), "-o", name, "--template", name,
                                       "--target", "glsl,essl,hlsl,wgsl", "--no-validate"});
    ASSERT_EQ(outcome.status, 0) << outcome.all();
  }
  size_t loops = 0;
  for (const std::string& file : place.names()) {
    if (file.find(".frag.") == std::string::npos) continue;
    const bool web = file.find("/essl/") != std::string::npos || file.find("/wgsl/") != std::string::npos;
    const std::string text = place.read(file);
    for (size_t at = text.find("for ("); at != std::string::npos; at = text.find("for (", at + 1)) {
      const std::string line = text.substr(at, text.find('\n', at) - at);
      EXPECT_EQ(line.find("min(") != std::string::npos, web) << file << ": " << line;
      ++loops;
    }
  }
  EXPECT_GT(loops, 8U);
}

}  // namespace lacquer::test::engine_test
