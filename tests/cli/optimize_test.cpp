// `--optimize` and `tune`: what a search does to a run's files, its cache and its manifest.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "command.h"
#include "support/cases.h"

namespace lacquer::test::optimize_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

constexpr std::chrono::seconds kLong(600);

Words words(Words first, const Words& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

/// Specular, IOR and sheen, of which a search finds cheaper forms.
std::string work() { return (sourceFolder() / "bench/works/a.gltf").string(); }

std::map<std::string, std::string> filesOf(const Workplace& place, const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const std::string& name : place.names()) {
    if (name.starts_with(folder + "/") && std::filesystem::is_regular_file(place / name))
      files[name.substr(folder.size())] = place.read(name);
  }
  return files;
}

TEST(Optimize, ARunIsRepeatedToTheByteAndKept) {
  const Workplace place;
  const Words common = {work(),          "-q",         "--lights", "directional:1", "--target", "glsl,spirv",
                        "--no-validate", "--optimize", "1",        "--model-costs"};
  const Outcome first = place.run(words({"gen", "-o", "one", "--cache", "kept"}, common), kLong);
  ASSERT_EQ(first.status, 0) << first.all();
  const Outcome again = place.run(words({"gen", "-o", "two", "--jobs", "1"}, common), kLong);
  ASSERT_EQ(again.status, 0) << again.all();
  EXPECT_EQ(filesOf(place, "one"), filesOf(place, "two"));
  // What is kept is not searched for again.
  const Outcome cached = place.run(words({"gen", "-o", "three", "--cache", "kept", "--time"}, common), kLong);
  EXPECT_EQ(cached.status, 0) << cached.all();
  EXPECT_NE(cached.all().find("0 shaders made"), std::string::npos) << cached.all();
  EXPECT_EQ(filesOf(place, "one"), filesOf(place, "three"));

  const json manifest = place.manifest("one");
  ASSERT_FALSE(manifest["shaders"].empty());
  for (const json& shader : manifest["shaders"]) {
    const json& optimized = shader["optimized"];
    EXPECT_EQ(optimized["level"], 1);
    EXPECT_EQ(optimized["family"], "navi21");
    EXPECT_EQ(optimized["by"], "model");
    EXPECT_LT(optimized["cycles"], optimized["of_cycles"]);
    EXPECT_LT(optimized["error_growth"], 2);
    EXPECT_EQ(optimized["error"], 0);
  }
}

TEST(Optimize, BoundsGrowByLessThanTwoWhereNodesAreAtTheVertices) {
  const Workplace place;
  const Outcome made =
      place.run({"gen", (sourceFolder() / "bench/works/c.gltf").string(), "-o", "o", "-q", "--target", "glsl",
                 "--no-validate", "--lights", "directional:1", "--optimize", "1", "--model-costs",
                 "--simplify", "vertex:base.indirect", "--simplify", "vertex:film.fresnel"},
                kLong);
  ASSERT_EQ(made.status, 0) << made.all();
  const json shaders = place.manifest("o")["shaders"];
  ASSERT_FALSE(shaders.empty());
  for (const json& shader : shaders) EXPECT_LT(shader["optimized"]["error_growth"], 2);
}

TEST(Optimize, IsOffByItselfAndSaysWhatDoesNotGoTogether) {
  const Workplace place;
  place.write("a.gltf", gltfOf({R"({"alphaMode": "MASK"})"}));
  const Outcome plain =
      place.run({"gen", "a.gltf", "-o", "o", "-q", "--unused", "--target", "glsl", "--no-validate"});
  ASSERT_EQ(plain.status, 0) << plain.all();
  for (const json& shader : place.manifest("o")["shaders"]) EXPECT_FALSE(shader.contains("optimized"));
  const Outcome error = place.run({"gen", "a.gltf", "-o", "p", "-q", "--optimize", "1", "--error", "0.01"});
  EXPECT_EQ(error.status, 1);
  EXPECT_NE(error.err.find("[no-approximations]"), std::string::npos) << error.all();
  EXPECT_NE(place.run({"gen", "a.gltf", "-o", "p", "-q", "--optimize", "3"}).status, 0);
  EXPECT_NE(place.run({"gen", "a.gltf", "-o", "p", "-q", "--optimize-for", "voodoo2"}).status, 0);
}

TEST(Tune, ANodesFrontFallsAsItsErrorGrows) {
  const Workplace place;
  const Outcome outcome = place.run({"tune", "coat_absorption", "--json"}, kLong);
  ASSERT_EQ(outcome.status, 0) << outcome.all();
  const json front = json::parse(outcome.out);
  EXPECT_EQ(front["name"], "coat_absorption");
  const json& forms = front["forms"];
  ASSERT_GE(forms.size(), 1U);
  EXPECT_EQ(forms[0]["error"], 0);
  EXPECT_LE(forms[0]["cycles"], front["of_cycles"]);
  for (size_t i = 1; i < forms.size(); ++i) {
    EXPECT_GT(forms[i]["error"], forms[i - 1]["error"]);
    EXPECT_LT(forms[i]["cycles"], forms[i - 1]["cycles"]);
    EXPECT_GE(forms[i]["approximations"], 1);
  }
  const Outcome table = place.run({"tune", "coat_absorption", "--picture", "front.svg"}, kLong);
  const std::string picture = readFile(place.path() / "front.svg");
  EXPECT_TRUE(picture.starts_with("<svg xmlns=")) << picture;
  size_t circles = 0;
  for (size_t at = 0; (at = picture.find("<circle", at)) != std::string::npos; ++at) ++circles;
  EXPECT_EQ(circles, forms.size());
  for (const char* wrong : {"nan", "inf", "-nan"}) EXPECT_EQ(picture.find(wrong), std::string::npos) << wrong;
  EXPECT_NE(table.out.find("coat_absorption: "), std::string::npos) << table.all();
  EXPECT_EQ(place.run({"tune", "no_such_node"}).status, 2);
  place.write("a.gltf", gltfOf({"{}"}));
  const Outcome over = place.run({"tune", "a.gltf", "--picture", "a.gltf"}, kLong);
  EXPECT_EQ(over.status, 1);
  EXPECT_TRUE(readFile(place.path() / "a.gltf").starts_with("{")) << "it is not written over";
  for (const char* file : {"absent.mtlx", "absent.gltf", "absent.json"})
    EXPECT_NE(place.run({"tune", file}).err.find("[file-unreadable]"), std::string::npos) << file;
  EXPECT_NE(place.run({"tune", "coat_absorption.none"}).err.find("[no-such-variant]"), std::string::npos);
}

/// What goes to the vertices of a material is seen in pictures, and is what the options make that are
/// printed.
TEST(Tune, MovesToTheVerticesAreSeenInPicturesAndMadeByTheirOptions) {
  const Workplace place;
  const Words subject{(sourceFolder() / "bench/works/w0.gltf").string(), "--lights", "directional:1"};
  const Outcome outcome =
      place.run(words(words({"tune"}, subject), {"--json", "--picture", "front.svg"}), kLong);
  ASSERT_EQ(outcome.status, 0) << outcome.all();
  const json front = json::parse(outcome.out);
  const json& moves = front["moves"];
  ASSERT_GE(moves.size(), 2U);
  double error = 0, cost = front["forms"][0]["cycles"];
  for (const json& move : moves) {
    EXPECT_GT(move["error"]["delta_e"]["mean"], error) << move;
    EXPECT_LT(move["cost"], cost) << move;
    EXPECT_NEAR(move["cost"], move["cycles"].get<double>() + move["vertex_cycles"].get<double>() / 8, 1e-9);
    error = move["error"]["delta_e"]["mean"];
    cost = move["cost"];
    ASSERT_FALSE(move["simplify"].empty());
    for (const json& word : move["simplify"]) EXPECT_TRUE(word.get<std::string>().starts_with("vertex:"));
  }
  for (const json* move : {&moves.front(), &moves.back()}) {
    const Outcome made =
        place.run(words(words({"gen", "-o", "o", "-q", "--target", "glsl", "--no-validate"}, subject),
                        (*move)["options"].get<Words>()),
                  kLong);
    ASSERT_EQ(made.status, 0) << made.all();
    const json shaders = place.manifest("o")["shaders"];
    ASSERT_EQ(shaders.size(), 1U);
    EXPECT_EQ(shaders.begin().key(), (*move)["shader"]);
    EXPECT_EQ(shaders.begin().value()["optimized"]["cycles"], (*move)["cycles"]);
  }
  const std::string picture = readFile(place.path() / "front.svg");
  for (const json& move : moves)
    EXPECT_NE(picture.find(move["simplify"][0].get<std::string>()), std::string::npos) << move;
  const Outcome table = place.run(words(words({"tune"}, subject), {"--no-ibl"}), kLong);
  EXPECT_NE(table.out.find("  --optimize 1 --model-costs --simplify vertex:normal.unit\n"), std::string::npos)
      << table.all();
}

TEST(Tune, SaysThatNothingPaysAndHowFarItIs) {
  const Workplace place;
  place.write("unlit.gltf", gltfOf({R"({"extensions": {"KHR_materials_unlit": {}}})"}));
  const Outcome unlit = place.run({"tune", "unlit.gltf"}, kLong);
  EXPECT_EQ(unlit.status, 0) << unlit.all();
  EXPECT_NE(unlit.out.find("\nnothing cheaper was found\n\nno node pays at the vertices\n"),
            std::string::npos)
      << unlit.all();
  const json none = json::parse(place.run({"tune", "unlit.gltf", "--json"}, kLong).out);
  EXPECT_EQ(none["moves"], json::array());
  const Outcome node = place.run({"tune", "schlick"}, kLong);
  EXPECT_EQ(node.out.find("vertices"), std::string::npos) << node.all();
  // A line for each fifty forms, where there is no terminal.
  const Words subject{"tune", (sourceFolder() / "bench/works/w3.gltf").string(), "--lights", "directional:1",
                      "--no-ibl"};
  const Outcome loud = place.run(subject, kLong);
  EXPECT_NE(loud.err.find(" forms tried\n"), std::string::npos) << loud.all();
  EXPECT_EQ(place.run(words(subject, {"--quiet"}), kLong).err, "");
}

TEST(Tune, AFormIsAVariantThatStandsInANodesFile) {
  const Workplace place;
  const std::string node =
      "/// A term.\n/// source: a test\n"
      "node glow(float x in [0, 1]) -> float in [0, 2] {\n"
      "    return exp2(0.3 * log2(1 + x)) / (1 + sqrt(x + 1));\n}\n";
  place.write("mine/glow.node", node);
  const json front = json::parse(place.run({"tune", "glow", "--nodes", "mine", "--json"}, kLong).out);
  ASSERT_GT(front["forms"].size(), 2U);
  const auto written = [&](const Words& more) {
    return place.run(words({"tune", "glow", "--nodes", "mine", "--variant"}, more), kLong);
  };
  const Outcome second = written({"quick", "--form", "2"});
  ASSERT_EQ(second.status, 0) << second.all();
  const Outcome last = written({"fastest"});
  const std::string error = fmt::format("{:.3g}", front["forms"].back()["error"].get<double>());
  EXPECT_NE(last.out.find("off by at most " + error + " of a result"), std::string::npos) << last.all();
  place.write("mine/glow.node", node + second.out + last.out);
  const Outcome checked = place.run({"check", "mine"}, kLong);
  EXPECT_EQ(checked.status, 0) << checked.all();
  EXPECT_EQ(
      json::parse(place.run({"tune", "glow.fastest", "--nodes", "mine", "--json"}, kLong).out)["of_cycles"],
      front["forms"].back()["cycles"]);
  EXPECT_NE(written({"quick"}).err.find("[wrong-variant]"), std::string::npos);
  EXPECT_NE(written({"Quick"}).err.find("[wrong-variant]"), std::string::npos);
  for (const char* word : {"true", "vec3", "node"})
    EXPECT_NE(written({word}).err.find("[wrong-variant]"), std::string::npos) << word;
  EXPECT_EQ(written({"other", "--form", "0"}).status, 2);
  EXPECT_NE(written({"other", "--form", "99"}).err.find("[no-such-form]"), std::string::npos);
}

/// Nodes that two vendors call alike have their extensions before their names.
TEST(Tune, TakesOneVendorsNode) {
  const Workplace place;
  for (const std::string vendor : {"ACME_glow", "BOLT_glow"}) {
    place.write("mine/" + vendor + ".node",
                "/// A light.\n/// source: a test\nextension " + vendor +
                    " {\n    float amount in [0, 1] = 0;\n}\n/// A term.\n/// source: a test\n"
                    "node glow(float x in [0, 1]) -> float in [0, 2] {\n    return exp2(x) / (1 + sqrt(x + "
                    "1));\n}\n");
  }
  const Outcome one = place.run({"tune", "ACME_glow.glow", "--nodes", "mine"}, kLong);
  EXPECT_EQ(one.status, 0) << one.all();
  EXPECT_NE(
      place.run({"tune", "ACME_glow.glow.none", "--nodes", "mine"}, kLong).err.find("[no-such-variant]"),
      std::string::npos);
}

}  // namespace
}  // namespace lacquer::test::optimize_test
