// Fewer programs than structures, by the program itself: how many there are, what each material is given, and
// that neither orders nor threads show.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "processes.h"
#include "random_gltf.h"

namespace lacquer::test::programs_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

class ProgramsRun : public testing::Test {
protected:
  void SetUp() override {
    folder_ = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
    for (uint64_t seed = 0; seed < 3; ++seed) {
      const std::string name = "file" + std::to_string(seed) + ".gltf";
      writeText(folder_ / name, RandomGltf(seed).text(4));
      files_.push_back(name);
    }
  }
  void TearDown() override { fs::remove_all(folder_.parent_path()); }

  int gen(const std::string& out, const Words& more, std::string* output = nullptr,
          bool backwards = false) const {
    Words words{LACQUER_PROGRAM, "gen", "-q", "--no-validate", "--no-sync", "--target", "glsl", "-o", out};
    Words files = files_;
    if (backwards) std::reverse(files.begin(), files.end());
    words.insert(words.end(), files.begin(), files.end());
    words.insert(words.end(), more.begin(), more.end());
    return runProgram(words, folder_, output);
  }
  Json manifest(const std::string& out) const {
    return Json::parse(readText(folder_ / out / "manifest.json"));
  }

  fs::path folder_;
  Words files_;
};

/// Calls `each(material, use)` for all uses.
template <class Each>
void eachUse(const Json& manifest, Each each) {
  for (const Json& file : manifest["files"]) {
    for (const Json& material : file["materials"]) {
      for (const Json& use : material["uses"]) each(material, use);
    }
  }
}

TEST_F(ProgramsRun, ThereAreAsFewAsAskedFor) {
  ASSERT_EQ(gen("all", {}), 0);
  const size_t all = manifest("all")["shaders"].size();
  ASSERT_GT(all, 6U);
  for (const size_t wanted : {size_t{1}, size_t{4}, all}) {
    const std::string out = "out" + std::to_string(wanted);
    ASSERT_EQ(gen(out, {"--programs", std::to_string(wanted), "--model-costs"}), 0);
    EXPECT_EQ(manifest(out)["shaders"].size(), wanted);
  }
  // Nothing is merged that need not be.
  EXPECT_EQ(differences(folder_ / "all", folder_ / ("out" + std::to_string(all))), "");
}

/// Its own numbers and textures are as they were; what it has not stands in.
TEST_F(ProgramsRun, EachMaterialKeepsWhatItHas) {
  ASSERT_EQ(gen("all", {}), 0);
  ASSERT_EQ(gen("few", {"--programs", "2", "--model-costs"}), 0);
  const Json before = manifest("all");
  const Json after = manifest("few");
  std::vector<Json> own;
  eachUse(before, [&](const Json&, const Json& use) { own.push_back(use); });
  size_t place = 0;
  size_t numbers = 0;
  size_t texels = 0;
  eachUse(after, [&](const Json& material, const Json& use) {
    const Json& was = own.at(place++);
    const Json& shader = after["shaders"][use["shader"].get<std::string>()];
    for (const auto& [name, parameter] : use["parameters"].items()) {
      if (parameter.contains("stand_in")) {
        EXPECT_EQ(parameter["pointer"], "");
        ++numbers;
      } else if (was["parameters"].contains(name)) {
        EXPECT_EQ(parameter, was["parameters"][name]) << material["name"] << " " << name;
      }
    }
    // All of its own that the colour depends on are still there.
    for (const auto& [name, parameter] : was["parameters"].items())
      EXPECT_TRUE(use["parameters"].contains(name)) << material["name"] << " " << name;
    for (const auto& [slot, texture] : use["textures"].items()) {
      if (!texture.contains("stand_in")) {
        EXPECT_EQ(texture, was["textures"][slot]);
        continue;
      }
      ++texels;
      EXPECT_EQ(texture["texture"], -1);
      EXPECT_FALSE(was["textures"].contains(slot));
      const auto listed = std::find_if(shader["textures"].begin(), shader["textures"].end(),
                                       [&, &name = slot](const Json& one) { return one["name"] == name; });
      ASSERT_NE(listed, shader["textures"].end());
      EXPECT_EQ((*listed)["color_space"], texture["stand_in"]["color_space"]);
    }
    // Every field of the block has a value.
    for (const Json& block : shader["uniforms"]) {
      if (block["role"] != "material") continue;
      for (const Json& field : block["fields"]) EXPECT_TRUE(use["uniforms"].contains(field["name"])) << field;
    }
  });
  EXPECT_EQ(place, own.size());
  EXPECT_GT(numbers, 10U);
  EXPECT_GT(texels, 10U);
}

TEST_F(ProgramsRun, NeitherThreadsNorOrdersNorTheCacheShow) {
  const Words few{"--programs", "3", "--model-costs"};
  const auto with = [&](const Words& more) {
    Words words = few;
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  ASSERT_EQ(gen("one", with({"--jobs", "1"})), 0);
  ASSERT_EQ(gen("many", with({"--jobs", "7"})), 0);
  EXPECT_EQ(differences(folder_ / "one", folder_ / "many"), "");
  ASSERT_EQ(gen("first", with({"--cache", "cache"})), 0);
  ASSERT_EQ(gen("second", with({"--cache", "cache"})), 0);
  EXPECT_EQ(differences(folder_ / "one", folder_ / "first"), "");
  EXPECT_EQ(differences(folder_ / "one", folder_ / "second"), "");
  // The same shaders from the files in another order; the manifest lists those as they were given.
  ASSERT_EQ(gen("turned", few, nullptr, true), 0);
  Json one = manifest("one");
  Json turned = manifest("turned");
  EXPECT_EQ(one["shaders"], turned["shaders"]);
  std::reverse(turned["files"].begin(), turned["files"].end());
  EXPECT_EQ(one, turned);
}

/// What a driver said of a program is in the cache: another run of the same programs waits for none.
TEST_F(ProgramsRun, TheDriverIsAskedOnce) {
  const Words more{"--programs", "3", "--cache", "kept", "--time"};
  std::string first, second;
  ASSERT_EQ(gen("out", more, &first), 0) << first;
  if (first.find("\ndriver ") == std::string::npos) GTEST_SKIP() << "NOT TESTED: there is no driver to ask";
  // All count twice as much: what is decided is decided anew, and the same.
  Json weights;
  for (const std::string& file : files_) {
    for (int i = 0; i < 4; ++i) weights["weights"].push_back({{"file", file}, {"material", i}, {"share", 2}});
  }
  writeText(folder_ / "twice.json", weights.dump());
  Words again = more;
  again.insert(again.end(), {"--weights", "twice.json"});
  ASSERT_EQ(gen("out", again, &second), 0) << second;
  EXPECT_NE(second.find("\nprograms "), std::string::npos) << second;
  EXPECT_EQ(second.find("\ndriver "), std::string::npos) << second;
}

bool measures(const std::string& output) { return output.find("\nprograms ") != std::string::npos; }

/// What an edit leaves as it was comes from the cache, and never shows: each folder is that of a run from
/// nothing.
TEST_F(ProgramsRun, EditsLeaveWhatARunFromNothingMakes) {
  Json file = Json::parse(readText(folder_ / files_[1]));
  const Json before = file;
  const auto all = [&]() -> Json& { return file["materials"]; };
  const std::vector<std::tuple<std::string, bool, std::function<void()>>> edits = {
      {"nothing", false, [] {}},
      {"a number", false, [&] { all()[0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.4375; }},
      {"a number that removes a term", true, [&] { all()[1]["pbrMetallicRoughness"]["metallicFactor"] = 0; }},
      {"a number that is wrong", true, [&] { all()[0]["pbrMetallicRoughness"]["roughnessFactor"] = 7; }},
      {"the number right", true, [&] { all()[0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.25; }},
      {"a texture more", true,
       [&] {
         all()[2]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 1}};
       }},
      {"the texture away", true, [&] { all()[2]["pbrMetallicRoughness"].erase("baseColorTexture"); }},
      {"a material more", true, [&] { all().push_back(all()[0]); }},
      {"another order", false, [&] { std::reverse(all().begin(), all().end()); }},
      {"a material away", true, [&] { all().erase(1); }},
      {"all as it was", false, [&] { file = before; }}};
  for (const bool fallback : {false, true}) {
    file = before;
    Words more{"--model-costs", "--time", "--pipelines", "pipelines.json"};
    if (fallback)
      more.push_back("--fallback");
    else
      more.insert(more.end(), {"--programs", "3", "--programs-report", "curve.json"});
    Words kept = more;
    kept.insert(kept.end(), {"--cache", "cache"});
    writeText(folder_ / files_[1], file.dump());
    ASSERT_EQ(gen("out", kept), 0);
    for (const auto& [name, decides, edit] : edits) {
      edit();
      writeText(folder_ / files_[1], file.dump());
      std::string output;
      const int status = gen("out", kept, &output);
      if (!decides) {
        EXPECT_FALSE(measures(output)) << name << output;
      }
      const std::string pipelines = readText(folder_ / "pipelines.json");
      const std::string curve = fallback ? "" : readText(folder_ / "curve.json");
      fs::remove_all(folder_ / "fresh");
      std::string said;
      EXPECT_EQ(gen("fresh", more, &said), status) << name << output << said;
      EXPECT_EQ(differences(folder_ / "fresh", folder_ / "out"), "") << name;
      EXPECT_EQ(pipelines, readText(folder_ / "pipelines.json")) << name;
      if (!fallback) {
        EXPECT_EQ(curve, readText(folder_ / "curve.json")) << name;
      }
    }
  }
}

/// A cache that lies is worth nothing, and does no harm.
TEST_F(ProgramsRun, WhatIsDamagedIsDecidedAnew) {
  const Words more{"--programs", "3", "--model-costs", "--cache", "cache", "--time"};
  ASSERT_EQ(gen("fresh", {"--programs", "3", "--model-costs"}), 0);
  ASSERT_EQ(gen("out", more), 0);
  for (const auto& [name, state] : filesBelow(folder_ / "cache")) {
    std::string bytes = readText(folder_ / "cache" / name);
    bytes[bytes.size() - 1] ^= 1;
    writeText(folder_ / "cache" / name, bytes);
  }
  std::string output;
  ASSERT_EQ(gen("out", more, &output), 0) << output;
  EXPECT_TRUE(measures(output)) << output;
  EXPECT_EQ(differences(folder_ / "fresh", folder_ / "out"), "");
  ASSERT_EQ(gen("out", more, &output), 0) << output;
  EXPECT_FALSE(measures(output)) << output;
  EXPECT_EQ(differences(folder_ / "fresh", folder_ / "out"), "");
}

TEST_F(ProgramsRun, WeightsSayWhatMayCostMore) {
  // All but the first material of each file are hardly seen.
  writeText(folder_ / "weights.json",
            R"({"weights": [{"material": 0, "share": 1}, {"material": "material 1", "share": 0.001}]})");
  ASSERT_EQ(gen("all", {}), 0);
  std::string output;
  ASSERT_EQ(gen("few", {"--programs", "4", "--weights", "weights.json", "--model-costs"}, &output), 0)
      << output;
  std::map<std::string, std::set<bool>> seen;  // shader -> whether first materials use it
  size_t alone = 0;
  std::map<std::string, size_t> uses;
  eachUse(manifest("few"), [&](const Json&, const Json& use) { ++uses[use["shader"]]; });
  eachUse(manifest("few"), [&](const Json& material, const Json& use) {
    if (material["index"] == 0 && uses[use["shader"]] == 1) ++alone;
  });
  // Three that count, each with a program of its own, and one for all the rest.
  EXPECT_EQ(alone, 3U);
  writeText(folder_ / "weights.json", R"({"weights": 3})");
  EXPECT_EQ(gen("no", {"--programs", "4", "--weights", "weights.json"}, &output), 1);
  EXPECT_NE(output.find("weights.json"), std::string::npos);
  EXPECT_EQ(gen("no", {"--programs", "4", "--weights", "nowhere.json"}, &output), 1);
}

TEST_F(ProgramsRun, ReportsTheWholeCurve) {
  ASSERT_EQ(gen("all", {}), 0);
  const size_t all = manifest("all")["shaders"].size();
  for (const char* name : {"curve.json", "curve.md", "curve.svg"})
    ASSERT_EQ(gen("out", {"--programs", "5", "--programs-report", name, "--model-costs"}), 0);
  const Json report = Json::parse(readText(folder_ / "curve.json"));
  ASSERT_EQ(report["curve"].size(), all);
  EXPECT_EQ(report["structures"], all);
  EXPECT_EQ(report["programs"], 5);
  EXPECT_EQ(report["materials"], 12);
  double before = 0;
  for (size_t i = 0; i < all; ++i) {
    const Json& point = report["curve"][i];
    EXPECT_EQ(point["programs"], all - i);
    EXPECT_GE(point["cost"].get<double>(), before - 1e-9);
    before = point["cost"];
  }
  EXPECT_EQ(report["curve"][0]["largest_rise"], 0);
  EXPECT_NE(readText(folder_ / "curve.md").find("| 1 |"), std::string::npos);
  EXPECT_TRUE(readText(folder_ / "curve.svg").starts_with("<svg"));
  // Without --programs nothing is merged, whatever is reported.
  ASSERT_EQ(gen("told", {"--programs-report", "curve.json", "--model-costs"}), 0);
  EXPECT_EQ(differences(folder_ / "all", folder_ / "told"), "");
  std::string output;
  EXPECT_EQ(gen("no", {"--programs-report", "curve.txt"}, &output), 1);
  EXPECT_NE(output.find("report-format"), std::string::npos) << output;
  EXPECT_EQ(gen("no", {"--programs", "2", "--params", "baked"}, &output), 1);
  EXPECT_NE(output.find("programs-baked"), std::string::npos) << output;
}

TEST_F(ProgramsRun, ManifestsFitTheSchema) {
  ASSERT_EQ(gen("few", {"--programs", "2", "--model-costs", "--pipelines", "pipelines.json"}), 0);
  const fs::path source = fs::path(LACQUER_SOURCE);
  for (const auto& [schema, file] : {std::pair<const char*, const char*>{"manifest", "few/manifest.json"},
                                     {"pipelines", "pipelines.json"}}) {
    std::string output;
    const int status =
        runProgram({"/usr/bin/env", "python3", (source / "tests/cli/validate_manifest.py").string(),
                    (source / "docs" / (std::string(schema) + ".schema.json")).string(), file},
                   folder_, &output);
    if (status == 77) GTEST_SKIP() << "NOT TESTED: " << output;
    EXPECT_EQ(status, 0) << output;
  }
}

/// More programs than were asked for are never made in silence.
TEST_F(ProgramsRun, SaysWhereThereAreMore) {
  const auto lit = [&](const std::string& name, int lights) {
    std::string list, nodes;
    for (int i = 0; i < lights; ++i) {
      list += std::string(i == 0 ? "" : ", ") + R"({"type": "point"})";
      nodes += R"(, {"extensions": {"KHR_lights_punctual": {"light": )" + std::to_string(i) + "}}}";
    }
    writeText(folder_ / name, R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [)" +
                                  list + R"(]}}, "nodes": [{})" + nodes + R"(],
"materials": [{}, {"doubleSided": true}]})");
  };
  lit("one.gltf", 1);
  lit("two.gltf", 2);
  files_ = {"one.gltf", "two.gltf"};
  std::string output;
  ASSERT_EQ(gen("out", {"--lights", "scene", "--programs", "1", "--model-costs"}, &output), 0) << output;
  EXPECT_EQ(manifest("out")["shaders"].size(), 2U);
  EXPECT_NE(output.find("there are 2 programs, not at most 1"), std::string::npos) << output;
  EXPECT_NE(output.find("2 different sets of known lights"), std::string::npos) << output;
  EXPECT_NE(output.find("--lights any"), std::string::npos) << output;
  ASSERT_EQ(gen("out", {"--lights", "scene", "--programs", "2", "--model-costs"}, &output), 0);
  EXPECT_EQ(output.find("not at most"), std::string::npos) << output;
  ASSERT_EQ(gen("any", {"--programs", "1", "--model-costs"}, &output), 0);
  EXPECT_EQ(manifest("any")["shaders"].size(), 1U);
  EXPECT_EQ(output.find("not at most"), std::string::npos) << output;
}

/// What a plan hands out with shared programs is what one run makes.
TEST_F(ProgramsRun, APlanSharesThemToo) {
  const Words few{"--programs", "3", "--model-costs"};
  ASSERT_EQ(gen("local", few), 0);
  Words words{LACQUER_PROGRAM, "plan", "--ninja",   "build.ninja", "--json", "actions.json", "-q",
              "--target",      "glsl", "--no-sync", "-o",          "out",    "--no-validate"};
  words.insert(words.end(), files_.begin(), files_.end());
  words.insert(words.end(), few.begin(), few.end());
  ASSERT_EQ(runProgram(words, folder_), 0);
  const Json actions = Json::parse(readText(folder_ / "actions.json"))["actions"];
  EXPECT_EQ(actions.size(), 4U);
  for (const Json& action : actions) ASSERT_EQ(runProgram(action["command"].get<Words>(), folder_), 0);
  EXPECT_EQ(differences(folder_ / "local", folder_ / "out"), "");
}

// -- pipelines --

constexpr const char* kScene = R"({"asset": {"version": "2.0"},
"accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
  {"componentType": 5123, "normalized": true, "count": 3, "type": "VEC2"}, {"componentType": 5126, "count": 3, "type": "VEC2"}],
"images": [{"uri": "a.png"}], "textures": [{"source": 0}],
"materials": [
  {"name": "a", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
  {"name": "b", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "roughnessFactor": 0.5}},
  {"name": "c", "alphaMode": "BLEND"},
  {"name": "d", "doubleSided": true}],
"extensionsUsed": ["KHR_mesh_quantization"],
"meshes": [{"primitives": [
  {"material": 2, "attributes": {"POSITION": 0, "NORMAL": 0}},
  {"material": 0, "attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 2}},
  {"material": 1, "attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 2}},
  {"material": 0, "attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1}},
  {"material": 3, "attributes": {"POSITION": 0, "NORMAL": 0}}]}]})";

TEST_F(ProgramsRun, PipelinesAreDistinctAndInTheOrderOfUse) {
  writeText(folder_ / "scene.gltf", kScene);
  files_ = {"scene.gltf"};
  ASSERT_EQ(gen("out", {"--pipelines", "pipelines.json"}), 0);
  const Json list = Json::parse(readText(folder_ / "pipelines.json"))["pipelines"];
  ASSERT_EQ(list.size(), 4U);  // the second and the third primitive need the same
  EXPECT_EQ(list[0]["blend"]["color"][0], "src-alpha");
  EXPECT_EQ(list[0]["depth_write"], false);
  EXPECT_EQ(list[1]["uses"], 2);
  EXPECT_EQ(list[1]["first"]["primitive"], 1);
  EXPECT_EQ(list[1]["cull"], "back");
  EXPECT_EQ(list[1]["vertex"].back()["vulkan"], "VK_FORMAT_R32G32_SFLOAT");
  EXPECT_EQ(list[2]["vertex"].back()["vulkan"], "VK_FORMAT_R16G16_UNORM");
  EXPECT_EQ(list[2]["vertex"].back()["d3d12"], "DXGI_FORMAT_R16G16_UNORM");
  EXPECT_EQ(list[2]["vertex"].back()["webgpu"], "unorm16x2");
  EXPECT_EQ(list[3]["cull"], "none");
  EXPECT_EQ(list[3]["stages"], Json({"vertex", "fragment"}));
}

TEST_F(ProgramsRun, PipelinesHaveTheirConstants) {
  writeText(folder_ / "scene.gltf", kScene);
  files_ = {"scene.gltf"};
  ASSERT_EQ(gen("out", {"--pipelines", "pipelines.json", "--params", "spec"}), 0);
  const Json list = Json::parse(readText(folder_ / "pipelines.json"))["pipelines"];
  // The roughness of the third primitive's material is another constant: another pipeline.
  ASSERT_EQ(list.size(), 5U);
  EXPECT_EQ(list[1]["shader"], list[2]["shader"]);
  EXPECT_NE(list[1]["specialization"], list[2]["specialization"]);
  // A program for all: choices are constants, too.
  ASSERT_EQ(gen("one", {"--pipelines", "one.json", "--params", "spec", "--programs", "1", "--model-costs"}),
            0);
  bool flags = false;
  const Json one = Json::parse(readText(folder_ / "one.json"));
  for (const Json& pipeline : one["pipelines"]) {
    for (const Json& constant : pipeline["specialization"]) flags |= constant["value"].is_boolean();
  }
  EXPECT_TRUE(flags);
}

}  // namespace
}  // namespace lacquer::test::programs_test
