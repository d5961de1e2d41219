// The actions of a plan, as a farm runs them: each with what it declares and nothing else, in other folders,
// by other users, in other languages, in other orders.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "processes.h"
#include "random_gltf.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

Words wordsOf(const Json& list) { return list.get<Words>(); }

class Farm : public testing::Test {
protected:
  void SetUp() override {
    folder_ = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
    writeText(folder_ / "a b.gltf", RandomGltf(1).text(3));
    writeText(folder_ / "c.gltf", RandomGltf(2).text(3));
    const Words common{"a b.gltf", "c.gltf", "-q", "--no-sync"};
    Words plan{LACQUER_PROGRAM, "plan", "--ninja", "build.ninja", "--json", "actions.json", "-o", "out"};
    Words gen{LACQUER_PROGRAM, "gen", "-o", "local"};
    plan.insert(plan.end(), common.begin(), common.end());
    gen.insert(gen.end(), common.begin(), common.end());
    ASSERT_EQ(runProgram(plan, folder_), 0);
    ASSERT_EQ(runProgram(gen, folder_), 0);
    actions_ = Json::parse(readText(folder_ / "actions.json"))["actions"];
    ASSERT_GT(actions_.size(), 3U);
  }
  void TearDown() override { fs::remove_all(folder_.parent_path()); }

  /// An empty folder that holds the inputs of an action that are relative, copied from the first store.
  fs::path workplace(const std::string& name, const Json& action) const {
    const fs::path place = folder_ / name;
    fs::remove_all(place);
    for (const std::string& input : wordsOf(action["inputs"])) {
      if (fs::path(input).is_absolute()) continue;
      fs::create_directories((place / input).parent_path());
      fs::copy_file(folder_ / input, place / input);
    }
    for (const std::string& output : wordsOf(action["outputs"]))
      fs::create_directories((place / output).parent_path());
    return place;
  }

  /// Brings what an action has declared back; what it wrote beside that is an error.
  void deliver(const fs::path& place, const Json& action) const {
    Words declared = wordsOf(action["outputs"]);
    for (const auto& [name, state] : filesBelow(place)) {
      const Words inputs = wordsOf(action["inputs"]);
      if (std::find(inputs.begin(), inputs.end(), name) != inputs.end()) continue;
      EXPECT_NE(std::find(declared.begin(), declared.end(), name), declared.end())
          << action["name"] << " writes " << name << ", which it does not declare";
    }
    for (const std::string& output : declared) {
      ASSERT_TRUE(fs::exists(place / output)) << action["name"] << " does not write " << output;
      fs::create_directories((folder_ / output).parent_path());
      fs::copy_file(place / output, folder_ / output, fs::copy_options::overwrite_existing);
    }
  }

  /// The command in front of an action's own, in its folder.
  void runAll(const std::function<Words(const fs::path&, const Json&)>& around, bool backwards = false) {
    std::vector<Json> shaders(actions_.begin(), actions_.end() - 1);
    if (backwards) std::reverse(shaders.begin(), shaders.end());
    shaders.push_back(actions_.back());
    for (const Json& action : shaders) {
      EXPECT_EQ(action["environment"], Json::object());
      const fs::path place = workplace("work", action);
      Words words = around(place, action);
      const Words command = wordsOf(action["command"]);
      words.insert(words.end(), command.begin(), command.end());
      std::string output;
      ASSERT_EQ(runProgram(words, place, &output), 0) << action["name"] << ": " << output;
      deliver(place, action);
    }
    EXPECT_EQ(differences(folder_ / "local", folder_ / "out"), "");
  }

  fs::path folder_;
  Json actions_;
};

/// Nothing but the system's libraries, the program and the declared inputs is there: no home, no network, no
/// process beside it, no environment. The sandbox's devices are its own.
Words sandbox(const fs::path& place, const Json& action) {
  Words words{"bwrap", "--unshare-all", "--clearenv", "--die-with-parent", "--proc", "/proc", "--dev",
              "/dev",  "--tmpfs",       "/tmp",       "--ro-bind",         "/usr",   "/usr"};
  for (const char* link : {"/lib", "/lib64", "/bin"}) {
    if (fs::is_symlink(link)) words.insert(words.end(), {"--symlink", fs::read_symlink(link).string(), link});
  }
  for (const std::string& input : wordsOf(action["inputs"])) {
    if (fs::path(input).is_absolute()) words.insert(words.end(), {"--ro-bind", input, input});
  }
  words.insert(words.end(), {"--bind", place.string(), "/place"});
  for (const std::string& input : wordsOf(action["inputs"])) {
    if (!fs::path(input).is_absolute())
      words.insert(words.end(), {"--ro-bind", (place / input).string(), "/place/" + input});
  }
  words.insert(words.end(), {"--chdir", "/place", "--"});
  return words;
}

TEST_F(Farm, ActionsAreHermetic) {
  std::string output;
  if (runProgram({"/usr/bin/env", "bwrap", "--unshare-all", "--ro-bind", "/", "/", "--", "/bin/true"},
                 folder_, &output) != 0)
    GTEST_SKIP() << "NOT TESTED: bubblewrap cannot make a sandbox here: " << output;
  runAll([](const fs::path& place, const Json& action) {
    Words words{"/usr/bin/env"};
    const Words inner = sandbox(place, action);
    words.insert(words.end(), inner.begin(), inner.end());
    return words;
  });
  // The sandbox holds: with an input less, the action fails.
  Json poor = actions_[0];
  const fs::path place = workplace("poor", poor);
  poor["inputs"] = Json::array({LACQUER_PROGRAM});
  fs::remove_all(place / "build.ninja.plan");
  Words words{"/usr/bin/env"};
  const Words inner = sandbox(place, poor);
  words.insert(words.end(), inner.begin(), inner.end());
  const Words command = wordsOf(poor["command"]);
  words.insert(words.end(), command.begin(), command.end());
  EXPECT_NE(runProgram(words, folder_, &output), 0);
}

TEST_F(Farm, OtherFoldersLanguagesAndOrdersGiveTheSameBytes) {
  runAll(
      [](const fs::path&, const Json&) {
        return Words{
            "/usr/bin/env",  "-i",         "LC_ALL=tr_TR.UTF-8", "LANG=de_DE.UTF-8", "TZ=Pacific/Chatham",
            "HOME=/nowhere", "USER=nobody"};
      },
      true);
}

TEST_F(Farm, AnotherUserGivesTheSameBytes) {
  std::string output;
  const Words as_nobody{"/usr/bin/env", "setpriv", "--reuid", "65534", "--regid", "65534", "--clear-groups"};
  Words probe = as_nobody;
  probe.insert(probe.end(), {LACQUER_PROGRAM, "--version"});
  if (runProgram(probe, folder_, &output) != 0)
    GTEST_SKIP() << "NOT TESTED: nobody cannot run the program here: " << output;
  runAll([&](const fs::path& place, const Json&) {
    for (const auto& entry : fs::recursive_directory_iterator(place)) {
      if (entry.is_directory()) fs::permissions(entry.path(), fs::perms::all);
    }
    fs::permissions(place, fs::perms::all);
    return as_nobody;
  });
}

/// The JSON and the Ninja file say the same.
TEST_F(Farm, ActionsAreThoseOfTheNinjaFile) {
  std::string commands;
  if (runProgram({"/usr/bin/env", "ninja", "-f", "build.ninja", "-t", "commands"}, folder_, &commands) != 0)
    GTEST_SKIP() << "NOT TESTED: there is no ninja";
  EXPECT_EQ(static_cast<size_t>(std::count(commands.begin(), commands.end(), '\n')), actions_.size());
  for (const Json& action : actions_) {
    std::string line;
    for (const std::string& word : wordsOf(action["command"])) line += (line.empty() ? "" : " ") + word;
    EXPECT_NE(commands.find(line), std::string::npos) << line;
  }
}

// -- what a change costs, in actions and shaders --

/// "N shaders made, M from the cache, K files written" of a run with --time.
struct Counts {
  int made = -1, cached = -1, written = -1;
};

Counts counts(const Words& words, const fs::path& folder) {
  std::string output;
  EXPECT_EQ(runProgram(words, folder, &output), 0) << output;
  Counts counts;
  const size_t line = output.find(" shaders made");
  if (line == std::string::npos) return counts;
  std::sscanf(output.c_str() + output.rfind('\n', line) + 1, "%d shaders made, %d from the cache, %d files",
              &counts.made, &counts.cached, &counts.written);
  return counts;
}

TEST(Increments, OneChangedMaterialAmongMany) {
  const fs::path folder = freshFolder("increments");
  RandomGltf random(4);
  // A hundred files of a thousand materials of thirty kinds.
  constexpr size_t kFiles = 100, kMaterials = 1000, kKinds = 30;
  Words words{LACQUER_PROGRAM, "gen"};
  for (size_t i = 0; i < kFiles; ++i) {
    const std::string name = "many" + std::to_string(i) + ".gltf";
    writeText(folder / name, random.text(kMaterials, kKinds));
    words.push_back(name);
  }
  words.insert(words.end(), {"-o", "out", "--cache", "cache", "-q", "--no-validate", "--no-sync", "--target",
                             "glsl", "--time"});
  const Counts first = counts(words, folder);
  EXPECT_GT(first.made, 5);
  // Another number: no shader, the manifest alone.
  std::string text = readText(folder / "many50.gltf");
  const size_t place = text.find("\"metallicFactor\": ");
  ASSERT_NE(place, std::string::npos);
  text[text.find('.', place) + 1] = text[text.find('.', place) + 1] == '5' ? '6' : '5';
  writeText(folder / "many50.gltf", text);
  const Counts number = counts(words, folder);
  EXPECT_EQ(number.made, 0);
  EXPECT_EQ(number.written, 1);
  // Another structure: one shader.
  const std::string kind = "\"KHR_materials_sheen\": {\"sheenColorFactor\": [1, 0, 0]}";
  const size_t first_material = text.find("\"materials\": [{") + std::string("\"materials\": [{").size();
  text.insert(first_material, "\"name\": \"new\", \"extensions\": {" + kind + "}}, {");
  writeText(folder / "many50.gltf", text);
  const Counts structure = counts(words, folder);
  EXPECT_EQ(structure.made, 1);
  EXPECT_EQ(structure.written, 3);  // two stages and the manifest
  fs::remove_all(folder.parent_path());
}

/// A node that one kind of material has: the shaders that hold it are remade, and no other.
TEST(Increments, OneChangedNode) {
  const fs::path folder = freshFolder("node");
  const auto node = [&](const char* factor) {
    writeText(folder / "nodes" / "varnish.node", std::string(R"(
/// Varnish: a layer that tints what is below it.
/// source: EXAMPLE_materials_varnish
extension EXAMPLE_materials_varnish {
    status vendor;
    vec3 varnishColorFactor in [0, 1] = vec3(1);
}
/// A filter.
/// source: EXAMPLE_materials_varnish
part varnish of EXAMPLE_materials_varnish over coat unless varnishColorFactor == vec3(1) {
direct:
    varnish.direct = varnished(below.direct, varnishColorFactor);
    out direct = varnish.direct;
}
/// Light through a filter.
/// source: EXAMPLE_materials_varnish
node varnished(
    vec3 light in [0, inf],
    vec3 color in [0, 1]
) -> vec3 in [0, inf] {
    return light * color * )") + factor + ";\n}\n");
  };
  fs::create_directories(folder / "nodes");
  node("0.5");
  writeText(folder / "a.gltf",
            R"({"asset": {"version": "2.0"}, "extensionsUsed": ["EXAMPLE_materials_varnish"],
"materials": [{}, {"doubleSided": true}, {"alphaMode": "MASK"},
  {"extensions": {"EXAMPLE_materials_varnish": {"varnishColorFactor": [1, 0, 0]}}},
  {"doubleSided": true, "extensions": {"EXAMPLE_materials_varnish": {"varnishColorFactor": [1, 0, 0]}}}]})");
  const Words words{LACQUER_PROGRAM, "gen",       "a.gltf",   "-o",   "out",   "--nodes", "nodes", "-q",
                    "--no-validate", "--no-sync", "--target", "glsl", "--time"};
  EXPECT_EQ(counts(words, folder).made, 5);
  const auto before = filesBelow(folder / "out");
  node("0.25");
  // Files of the others are left alone; those of the two that hold the node are new.
  EXPECT_EQ(counts(words, folder).written, 2 * 2 + 1);
  size_t kept = 0;
  for (const auto& [name, state] : filesBelow(folder / "out")) {
    if (name == "manifest.json") continue;
    const auto it = before.find(name);
    if (it != before.end() && it->second.time == state.time) ++kept;
  }
  EXPECT_EQ(kept, before.size() - 1 - 2 * 2);
  fs::remove_all(folder.parent_path());
}

}  // namespace
}  // namespace lacquer::test
