// WGSL and MSL: what the manifest says of them is what the texts have, and a WebGPU implementation agrees.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>

#include "check/check.h"
#include "command.h"
#include "support/cases.h"

namespace lacquer::test::webgpu_test {
namespace {

using Words = std::vector<std::string>;
using nlohmann::json;

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// A number, and a name, by each match of a pattern with two groups.
std::set<std::string> matches(const std::string& text, const char* pattern, const char* form) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    found.insert(it->format(form));
  return found;
}

std::set<std::string>& operator|=(std::set<std::string>& to, const std::set<std::string>& from) {
  to.insert(from.begin(), from.end());
  return to;
}

class Apis : public testing::Test {
protected:
  /// The manifest of a run over two examples.
  json generate(const Words& more, const std::string& out = "out") {
    const Outcome outcome =
        place_.run(with({"gen", example("coat.gltf"), example("core.gltf"), "-o", out}, more));
    EXPECT_EQ(outcome.status, 0) << outcome.all();
    said_ = outcome.out + outcome.err;
    const json manifest = place_.manifest(out);
    EXPECT_FALSE(manifest["shaders"].empty());
    return manifest;
  }
  std::string text(const json& shader, const char* target, const char* stage) const {
    return shader["files"][target].contains(stage)
               ? place_.read("out/" + shader["files"][target][stage].get<std::string>())
               : "";
  }

  Workplace place_;
  std::string said_;
};

/// Every declaration of a text is in the manifest with its stage, and the other way round.
void expectBindings(const json& shader, const std::string& vertex, const std::string& fragment) {
  constexpr const char* kDeclaration = R"(@group\((\d+)\) @binding\((\d+)\) var(?:<uniform>)? (\w+): (\w+))";
  std::set<std::string> declared, said;
  declared |= matches(vertex, kDeclaration, "vertex $1.$2");
  declared |= matches(fragment, kDeclaration, "fragment $1.$2");
  for (const json& b : shader["webgpu"]["bindings"]) {
    for (const json& stage : b["visibility"])
      said.insert(
          fmt::format("{} {}.{}", stage.get<std::string>(), b["group"].get<int>(), b["binding"].get<int>()));
    const std::string& text = b["visibility"].back() == "fragment" ? fragment : vertex;
    const std::string place =
        fmt::format("@group({}) @binding({}) var", b["group"].get<int>(), b["binding"].get<int>());
    const std::string line =
        text.substr(text.find(place), text.find('\n', text.find(place)) - text.find(place));
    const bool buffer = b.contains("buffer");
    EXPECT_EQ(line.find("var<uniform>") != std::string::npos, buffer) << line;
    EXPECT_EQ(line.find(": sampler") != std::string::npos, b.contains("sampler")) << line;
    EXPECT_EQ(line.find(": texture_") != std::string::npos, b.contains("texture")) << line;
    if (!buffer) {
      EXPECT_NE(line.find(" " + b["name"].get<std::string>() + ":"), std::string::npos) << line;
    }
  }
  EXPECT_EQ(declared, said);
}

TEST_F(Apis, WgslIsBoundAsTheManifestSays) {
  const Words kSettings[] = {{},
                             {"--template", "surface"},
                             {"--template", "bsdf"},
                             {"--switch", "skinning=on", "--switch", "skinning_8=on", "--switch",
                              "morphing=on", "--switch", "instancing=on", "--switch", "dequantizing=on"},
                             {"--lights", "directional:1", "--no-ibl"},
                             {"--nodes", example("engine"), "--template", "engine"}};
  for (const Words& setting : kSettings) {
    const json manifest = generate(with(setting, {"--target", "wgsl,glsl"}));
    for (const auto& [id, shader] : manifest["shaders"].items()) {
      SCOPED_TRACE(id);
      expectBindings(shader, text(shader, "wgsl", "vert"), text(shader, "wgsl", "frag"));
      EXPECT_EQ(shader["validated"]["glsl"], true);
      EXPECT_EQ(shader["validated"]["wgsl"], check::haveTint());
      EXPECT_FALSE(shader.contains("metal"));
    }
    EXPECT_EQ(said_.find("not-validated") == std::string::npos, check::haveTint()) << said_;
    std::filesystem::remove_all(place_ / "out");
  }
}

TEST_F(Apis, LimitsBeyondTheDefaultsAreSaid) {
  const json forward = generate({"--target", "wgsl"});
  for (const json& shader : forward["shaders"]) EXPECT_EQ(shader["webgpu"]["limits"], json::object());
  const json surface = generate({"--target", "wgsl", "--template", "surface"}, "surface");
  for (const json& shader : surface["shaders"]) {
    const size_t colors = shader["outputs"].size();
    EXPECT_GE(colors, 6U);
    EXPECT_EQ(shader["webgpu"]["limits"]["maxColorAttachmentBytesPerSample"], 8 * colors);
    EXPECT_FALSE(shader["webgpu"]["limits"].contains("maxColorAttachments"));
  }
}

TEST_F(Apis, WithoutTheTargetsTheManifestIsWhatItWas) {
  const json manifest = generate({"--target", "glsl"});
  for (const json& shader : manifest["shaders"]) {
    EXPECT_FALSE(shader.contains("webgpu"));
    EXPECT_FALSE(shader.contains("metal"));
  }
}

TEST_F(Apis, OverridesAreTheSpecializationConstants) {
  const json manifest = generate({"--target", "wgsl", "--params", "spec"});
  for (const auto& [id, shader] : manifest["shaders"].items()) {
    std::set<std::string> declared, said;
    for (const char* stage : {"vert", "frag"})
      declared |= matches(text(shader, "wgsl", stage), R"(@id\((\d+)\) override \w+: (\w+) = )", "$1 $2");
    for (const json& constant : shader["spec_constants"])
      said.insert(
          fmt::format("{} {}", constant["id"].get<int>(), constant["type"] == "bool" ? "bool" : "f32"));
    EXPECT_FALSE(said.empty());
    EXPECT_EQ(declared, said) << id;
  }
}

/// Dawn makes pipelines of all, from the manifest alone.
TEST_F(Apis, PipelinesAreMade) {
  if (!check::haveTint()) GTEST_SKIP() << "NOT TESTED: nothing here compiles WGSL (checks/wgsl)";
  const std::string program = (sourceFolder() / "checks/wgsl/lacquer-wgsl-pipelines").string();
  const auto run = [&](const std::string& folder) {
    const std::string log = (place_ / "log.txt").string();
    const int status = std::system(
        fmt::format("'{}' '{}' > '{}' 2>&1", program, (place_ / folder / "manifest.json").string(), log)
            .c_str());
    return std::pair(status, place_.read("log.txt"));
  };
  const Words kSettings[] = {{},
                             {"--params", "spec"},
                             {"--params", "baked", "--lights", "point:2,spot:1"},
                             {"--template", "surface"},
                             {"--template", "bsdf"},
                             {"--switch", "skinning=on", "--switch", "skinning_8=on", "--switch",
                              "morphing=on", "--switch", "instancing=on", "--switch", "dequantizing=on"},
                             {"--nodes", example("engine"), "--template", "engine"}};
  for (const Words& setting : kSettings) {
    const json manifest = generate(with(setting, {"--target", "wgsl"}));
    const auto [status, said] = run("out");
    EXPECT_EQ(status, 0) << said;
    // What has more colours than a device without a GPU takes is counted apart.
    size_t made = 0, skipped = 0;
    EXPECT_EQ(std::sscanf(said.c_str(), "%zu pipelines\n%zu shaders", &made, &skipped) >= 1, true) << said;
    EXPECT_EQ(made + skipped, manifest["shaders"].size()) << said;
    EXPECT_GT(made, 0U) << said;
    std::filesystem::remove_all(place_ / "out");
  }
  // One that says something else is refused.
  json manifest = generate({"--target", "wgsl"});
  for (json& shader : manifest["shaders"]) shader["webgpu"]["bindings"].back()["binding"] = 99;
  std::ofstream(place_ / "out/manifest.json") << manifest;
  EXPECT_NE(run("out").first, 0);
}

/// The numbers behind a resource of a kind, in the two texts of a shader.
std::set<std::string> slots(const std::string& both, const char* kind) {
  return matches(both, fmt::format(R"(\[\[{}\((\d+)\)\]\])", kind).c_str(), "$1");
}

std::set<std::string> saidSlots(const json& shader, const char* key) {
  std::set<std::string> said;
  for (const json& b : shader["metal"]["bindings"]) {
    if (b.contains(key)) said.insert(std::to_string(b[key].get<int>()));
  }
  return said;
}

class Metal : public Apis {
protected:
  /// False where Lacquer was built without SPIRV-Cross.
  bool there() const {
    const Outcome outcome = place_.run({"gen", example("core.gltf"), "-o", "try", "--target", "msl"});
    return outcome.all().find("msl-unavailable") == std::string::npos;
  }
};

TEST_F(Metal, PlainBindingsAreTheFlatNumbers) {
  if (!there()) GTEST_SKIP() << "NOT TESTED: built without SPIRV-Cross";
  for (const Words& setting : {Words{}, Words{"--template", "surface"}, Words{"--params", "spec"},
                               Words{"--nodes", example("engine"), "--template", "engine"}}) {
    const json manifest = generate(with(setting, {"--target", "msl"}));
    EXPECT_NE(said_.find("not-validated"), std::string::npos) << said_;
    for (const auto& [id, shader] : manifest["shaders"].items()) {
      SCOPED_TRACE(id);
      EXPECT_EQ(shader["validated"], (json{{"msl", false}}));
      EXPECT_FALSE(shader.contains("webgpu"));
      EXPECT_EQ(shader["metal"]["argument_buffers"], false);
      const std::string both = text(shader, "msl", "vert") + text(shader, "msl", "frag");
      EXPECT_EQ(both.find("// " + id), 0U);
      EXPECT_NE(both.find("fragment main0_out main0("), std::string::npos);
      EXPECT_EQ(slots(both, "buffer"), saidSlots(shader, "buffer"));
      EXPECT_EQ(slots(both, "texture"), saidSlots(shader, "texture"));
      EXPECT_EQ(slots(both, "sampler"), saidSlots(shader, "sampler"));
      for (const json& resource : shader["uniforms"])
        EXPECT_TRUE(saidSlots(shader, "buffer").contains(std::to_string(resource["flat"].get<int>())));
      for (const json& constant : shader.value("spec_constants", json::array()))
        EXPECT_NE(both.find(fmt::format("[[function_constant({})]]", constant["id"].get<int>())),
                  std::string::npos);
    }
    std::filesystem::remove_all(place_ / "out");
  }
}

TEST_F(Metal, ArgumentBuffersHaveIds) {
  if (!there()) GTEST_SKIP() << "NOT TESTED: built without SPIRV-Cross";
  const json manifest = generate({"--target", "msl", "--msl-argument-buffers"});
  for (const auto& [id, shader] : manifest["shaders"].items()) {
    SCOPED_TRACE(id);
    EXPECT_EQ(shader["metal"]["argument_buffers"], true);
    const std::string both = text(shader, "msl", "vert") + text(shader, "msl", "frag");
    EXPECT_EQ(slots(both, "buffer"), saidSlots(shader, "argument_buffer"));
    std::set<std::string> ids = saidSlots(shader, "id");
    ids |= saidSlots(shader, "sampler_id");
    EXPECT_EQ(slots(both, "id"), ids) << both;
    EXPECT_TRUE(slots(both, "texture").empty());
  }
}

TEST_F(Metal, TheSameTwice) {
  if (!there()) GTEST_SKIP() << "NOT TESTED: built without SPIRV-Cross";
  const json one = generate({"--target", "msl,wgsl", "-j", "1"}, "one");
  const json other = generate({"--target", "msl,wgsl", "-j", "4"}, "other");
  EXPECT_EQ(one, other);
  for (const json& shader : one["shaders"]) {
    for (const char* target : {"msl", "wgsl"}) {
      for (const json& file : shader["files"][target])
        EXPECT_EQ(place_.read("one/" + file.get<std::string>()),
                  place_.read("other/" + file.get<std::string>()));
    }
  }
}

/// A small shader in Metal's language, as it is made today.
TEST_F(Metal, Text) {
  if (!there()) GTEST_SKIP() << "NOT TESTED: built without SPIRV-Cross";
  place_.write("one.gltf", gltfOf({R"({"extensions": {"KHR_materials_unlit": {}}})"}));
  for (const bool argument_buffers : {false, true}) {
    const Outcome outcome = place_.run(with({"gen", "one.gltf", "-o", "unlit", "--target", "msl", "--unused"},
                                            argument_buffers ? Words{"--msl-argument-buffers"} : Words{}));
    ASSERT_EQ(outcome.status, 0) << outcome.all();
    const json manifest = place_.manifest("unlit");
    ASSERT_EQ(manifest["shaders"].size(), 1U);
    const json files = manifest["shaders"].front()["files"]["msl"];
    const std::string kind = argument_buffers ? "buffers" : "plain";
    for (const char* stage : {"vert", "frag"})
      expectFile(sourceFolder() / fmt::format("tests/cli/expected/unlit_{}.{}.metal", kind, stage),
                 place_.read("unlit/" + files[stage].get<std::string>()));
  }
}

}  // namespace
}  // namespace lacquer::test::webgpu_test
