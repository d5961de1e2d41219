// Builds of somebody who means harm, or who mistypes: shards, weights, plans, and the names that go into what
// is written and printed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "command.h"
#include "lacquer.h"
#include "setting/option_key.h"
#include "support/cases.h"

namespace lacquer::test::hostile_build_test {
namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

constexpr size_t kMostSaid = 1001;  ///< a thousand, and that there are more

void expectRefused(const Outcome& outcome, const std::string& code) {
  EXPECT_EQ(outcome.status, 1) << outcome.all();
  EXPECT_NE(outcome.err.find("[" + code + "]"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("[stopped]"), std::string::npos) << outcome.err;
}

size_t countOf(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// A manifest of these entries of files, with `more` members at the root.
std::string manifestOf(const std::string& files, const std::string& more = {}) {
  return fmt::format(R"({{"lacquer": "{}", "schema": 1, {}"files": [{}], "shaders": {{}}}})", version(), more,
                     files);
}

/// A file's entry.
std::string entryOf(const std::string& source, const std::string& materials = {},
                    const std::string& diagnostics = {}, const std::string& more = {}) {
  return fmt::format(R"({{{}"source": "{}", "materials": [{}], "diagnostics": [{}]}})", more, source,
                     materials, diagnostics);
}

std::string materialWith(const std::string& uses) {
  return R"({"index": 0, "name": "", "uses": [)" + uses +
         R"(], "terms": [], "skipped": {}, "ignored": [], "diagnostics": []})";
}

std::string repeated(const std::string& text, size_t count) {
  std::string all;
  for (size_t i = 0; i < count; ++i) all += (i == 0 ? "" : ",") + text;
  return all;
}

/// "k0": 0, "k1": 0, and so on.
std::string members(size_t count) {
  std::string all;
  for (size_t i = 0; i < count; ++i) all += fmt::format(R"("k{}": 0, )", i);
  return all;
}

Outcome merged(const Workplace& place, const std::string& shard) {
  place.write("shard.json", shard);
  return place.run({"merge", "shard.json", "-o", "out"}, std::chrono::seconds(60));
}

/// What is written is indented: a deep shard would become a large manifest.
TEST(HostileShard, isNoDeeperThanOurs) {
  const Workplace place;
  const auto deep = [](size_t levels) {
    constexpr size_t kAbove = 5;  // the manifest, its files, a file, its diagnostics, one of them
    const size_t count = levels - kAbove;
    return manifestOf(
        entryOf("a", {}, R"({"x": )" + std::string(count, '[') + std::string(count, ']') + "}"));
  };
  expectRefused(merged(place, deep(33)), "json-too-deep");
  EXPECT_FALSE(place.has("out"));
  expectRefused(merged(place, deep(32)), "unknown-property");
}

TEST(HostileShard, hasOnlyWhatAManifestHas) {
  const Workplace place;
  const Outcome outcome = merged(place, manifestOf(entryOf("a"), R"("\u001b[31m": 0, )"));
  expectRefused(outcome, "unknown-property");
  EXPECT_NE(outcome.err.find("it has lacquer, schema, files, shaders and levels"), std::string::npos)
      << outcome.err;
}

/// Nothing is looked up anew for each of many materials.
TEST(HostileShard, takesTimeInProportion) {
  const Workplace place;
  const std::string materials = repeated(materialWith(""), 50'000);
  const Outcome outcome = merged(place, manifestOf(entryOf("a", materials)));
  EXPECT_EQ(outcome.status, 0) << outcome.err.substr(0, 1000);
  expectRefused(merged(place, manifestOf(entryOf("a", materials, {}, members(200'000)))), "unknown-property");
}

TEST(HostileShard, isToldOfAThousandFaults) {
  const Workplace place;
  const std::string use = R"({"attributes": [], "shader": "forward-0", "parameters": {}, "uniforms": {},
"textures": {}, "absent_parameters": {}, "unfilled_ports": []})";
  std::vector<std::string> shards = {manifestOf(entryOf("a", repeated("{}", 5000))),
                                     manifestOf(repeated("7", 5000)), manifestOf(entryOf("a"), members(5000)),
                                     manifestOf(entryOf("a", materialWith(repeated("{}", 5000)))),
                                     manifestOf(entryOf("a", materialWith(repeated(use, 5000))))};
  for (const std::string& shard : shards) {
    const Outcome outcome = merged(place, shard);
    EXPECT_EQ(outcome.status, 1) << outcome.status;
    EXPECT_EQ(countOf(outcome.err, ": error: "), kMostSaid) << outcome.err.substr(0, 1000);
    EXPECT_FALSE(place.has("out"));
  }
}

TEST(HostileShard, leavesNothingBehind) {
  const Workplace place;
  place.write("good.json", manifestOf(entryOf("a")));
  place.write("bad.json", manifestOf("7"));
  expectRefused(place.run({"merge", "good.json", "bad.json", "-o", "out/deep"}), "wrong-type");
  expectRefused(place.run({"merge", "good.json", "absent.json", "-o", "out/deep"}), "file-unreadable");
  EXPECT_FALSE(place.has("out"));
}

/// What a shard says of its source is words: whether something is there does not show in what comes of it.
TEST(HostileShard, isNoWayToLookAround) {
  const Workplace place;
  fs::create_directories(place / "elsewhere/sub");
  fs::create_directory_symlink("elsewhere/sub", place / "link");
  const auto source = [&] {
    return nlohmann::json::parse(place.read("out/manifest.json"))["files"][0]["source"].get<std::string>();
  };
  for (const char* there : {"", "elsewhere/x.gltf", "x.gltf"}) {
    if (*there != '\0') place.write(there, "");
    for (const std::string& said : {(place / "link/../x.gltf").string(), std::string("link/../x.gltf")}) {
      const Outcome outcome = merged(place, manifestOf(entryOf(said)));
      EXPECT_EQ(outcome.status, 0) << outcome.all();
      EXPECT_EQ(source(), "../x.gltf") << there;
      const Outcome whole =
          place.run({"merge", (place / "shard.json").string(), "-o", (place / "out").string()});
      EXPECT_EQ(whole.status, 0) << whole.all();
      EXPECT_EQ(source(), "../x.gltf") << there;
    }
  }
}

TEST(HostileWeights, areReadWithLimits) {
  const Workplace place;
  place.write("a.gltf", gltfOf({R"({"name": "a"})"}));
  const auto gen = [&](const std::string& rows, const Words& more) {
    place.write("w.json", R"({"weights": [)" + rows + "]}");
    Words words = {"gen",           "a.gltf",       "-q", "-o",       "out",       "--target",
                   "glsl",          "--programs",   "1",  "--unused", "--weights", "w.json",
                   "--no-validate", "--model-costs"};
    words.insert(words.end(), more.begin(), more.end());
    return place.run(words);
  };
  const std::string row = R"({"material": "a", "share": 1})";
  const std::string other = R"({"material": "b", "share": 1})";
  EXPECT_EQ(gen(repeated(row, 100), {"--limit", "file=5000"}).status, 0);
  expectRefused(gen(repeated(row, 1000), {"--limit", "file=5000"}), "file-too-large");
  const Outcome wrong = gen(repeated("0", 5000), {});
  expectRefused(wrong, "wrong-type");
  EXPECT_EQ(countOf(wrong.err, ": error: "), kMostSaid);
  const Outcome members_wrong = gen("{" + members(5000) + R"("material": "a", "share": 1})", {});
  expectRefused(members_wrong, "unknown-property");
  EXPECT_EQ(countOf(members_wrong.err, ": error: "), kMostSaid);
  const Outcome unused = gen(row + "," + repeated(other, 5000), {});
  EXPECT_EQ(unused.status, 0) << unused.err.substr(0, 1000);
  EXPECT_EQ(countOf(unused.err, ": warning: "), kMostSaid);
}

/// Where a run writes by names of its own, nothing lies that the user named.
TEST(Places, ofTheRunAreItsOwn) {
  const Workplace place;
  place.write("a.gltf", readFile(example("clearcoat.gltf")));
  const Words gen = {"gen", "a.gltf", "-q", "--target", "glsl", "--no-validate", "-o", "out"};
  const Words plan = {"plan", "a.gltf", "-q", "--target", "glsl", "-o", "out", "--ninja", "b.ninja"};
  const auto refused = [&](Words words, const Words& more, const std::string& whose) {
    words.insert(words.end(), more.begin(), more.end());
    SCOPED_TRACE(fmt::format("{} {}", words[0], more.back()));
    const std::set<std::string> before = place.names();
    const Outcome outcome = place.run(words);
    expectRefused(outcome, "output-clash");
    EXPECT_NE(outcome.err.find("where the " + whose + " own are"), std::string::npos) << outcome.err;
    EXPECT_EQ(place.names(), before);
  };
  const std::string temporary = ".lacquer-tmp/lacquer-0000000000000000-0.tmp";
  const auto all = [&] {
    for (const std::string& name : {std::string("out/.lacquer-tmp"), "out/" + temporary}) {
      for (const char* option : {"--depfile", "--packed", "--shard", "--pipelines"})
        refused(gen, {option, name}, "output folder's");
      refused(plan, {"--json", name}, "output folder's");
    }
    for (const char* name : {"c/v1/83/83cc0123456789abcdef0123456789ab", "./c/../c/v1/x"}) {
      refused(gen, {"--cache", "c", "--depfile", name}, "cache's");
      refused(plan, {"--cache", "c", "--json", name}, "cache's");
    }
    for (const char* name : {"b.ninja.plan/x.graph.json", "./b.ninja.plan/sub/x"})
      refused(plan, {"--json", name}, "plan's");
  };
  all();
  refused(plan, {"--json", "b.ninja.plan"}, "plan's");
  refused(plan, {"--cache", "c", "--json", "c/v1"}, "cache's");
  Words words = plan;
  words.insert(words.end(), {"--json", "b.ninja.json", "--cache", "c"});
  ASSERT_EQ(place.run(words).status, 0);
  const auto graph = [&] {
    const std::set<std::string> names = place.names();
    return *std::find_if(names.begin(), names.end(),
                         [](const std::string& name) { return name.ends_with(".graph.json"); });
  };
  refused(plan, {"--json", graph()}, "plan's");
  fs::create_directory_symlink("b.ninja.plan", place / "link");
  refused(plan, {"--json", "link/x"}, "plan's");
  all();
}

TEST(BuildFiles, holdNoMembersOfArchives) {
  const Workplace place;
  for (const char* name : {"a(b).gltf", "a(b", "b)"}) {
    place.write(name, readFile(example("clearcoat.gltf")));
    expectRefused(place.run({"gen", name, "-q", "--no-validate", "-o", "out", "--depfile", "a.d"}),
                  "depfile-name");
    EXPECT_FALSE(place.has("a.d"));
  }
}

TEST(BuildFiles, ofJsonHoldUtf8) {
  const Workplace place;
  place.write("a.gltf", readFile(example("clearcoat.gltf")));
  place.write("n\xff/own.node", "node own(float a) -> float { return a; }\n");
  const std::set<std::string> before = place.names();
  const std::vector<Words> all = {{"-o", "o\xff", "--ninja", "b.ninja"},
                                  {"-o", "out", "--ninja", "b\xff.ninja"},
                                  {"-o", "out", "--ninja", "b.ninja", "--nodes", "n\xff"}};
  for (const Words& more : all) {
    Words words = {"plan", "a.gltf", "-q", "--target", "glsl", "--json", "b.json"};
    words.insert(words.end(), more.begin(), more.end());
    expectRefused(place.run(words), "json-name");
    EXPECT_EQ(place.names(), before);
  }
  EXPECT_EQ(place.run({"plan", "a.gltf", "-q", "-o", "o\xff", "--ninja", "b.ninja"}).status, 0);
  EXPECT_EQ(
      place.run({"plan", "a.gltf", "-q", "-o", "\xc3\xb6", "--ninja", "c.ninja", "--json", "c.json"}).status,
      0);
}

/// The files below a folder that are shaders, with their bytes.
std::map<std::string, std::string> shadersIn(const Workplace& place, const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const std::string& name : place.names()) {
    if (name.starts_with(folder + "/") && fs::is_regular_file(place / name) && !name.ends_with(".json"))
      files[name.substr(folder.size())] = place.read(name);
  }
  return files;
}

/// The words that make an option other than it is without; the option is where it lies in `options`.
std::map<const void*, Words> wordsOf(const Options& options) {
  return {{&options.parameters, {"--params", "spec"}},
          {&options.binding, {"--binding", "bindless"}},
          {&options.static_samplers, {"--static-samplers"}},
          {&options.validate, {"--no-validate"}},
          {&options.spirv_route, {"--spirv-from", "glslang"}},
          {&options.relaxed, {"--relaxed", "0.0123"}},
          {&options.half, {"--relaxed", "0.0123", "--half"}},
          {&options.optimize, {"--optimize", "1"}},
          {&options.optimize_error, {"--optimize", "2", "--error", "0.001"}},
          {&options.optimize_for, {"--optimize-for", optimizeFamilies().back()}},
          {&options.debug, {"--debug"}},
          {&options.argument_buffers, {"--msl-argument-buffers"}}};
}

/// Whoever runs the plan's commands gets what a run makes: they have every option that decides what becomes
/// of a graph.
TEST(Plans, carryEveryOptionThatDecidesBytes) {
  const Options options;
  const std::map<const void*, Words> known = wordsOf(options);
  std::vector<Words> all;
  eachOption(options, [&](Decides decides, const auto& value) {
    if (decides != Decides::Module && decides != Decides::Code && decides != Decides::SpirvCode &&
        decides != Decides::MslCode) {
      return;
    }
    const auto words = known.find(&value);
    ASSERT_NE(words, known.end()) << "an option that has no words above";
    all.push_back(words->second);
  });
  EXPECT_EQ(all.size(), known.size());
  for (const Words& words : all) {
    SCOPED_TRACE(words[0]);
    const Workplace place;
    place.write("a.gltf", gltfOf({R"({"alphaCutoff": 0.25, "alphaMode": "MASK"})"}));
    const auto run = [&](Words call) {
      call.insert(call.end(), {"a.gltf", "-q", "--target", "glsl,spirv,msl"});
      call.insert(call.end(), words.begin(), words.end());
      if (words[0] != "--no-validate") call.emplace_back("--no-validate");  // which takes most of the time
      const Outcome outcome = place.run(call);
      EXPECT_EQ(outcome.status, 0) << outcome.all();
    };
    run({"gen", "-o", "direct"});
    run({"plan", "-o", "planned", "--ninja", "b.ninja", "--json", "b.json"});
    const nlohmann::json plan = nlohmann::json::parse(place.read("b.json"));
    for (const auto& action : plan["actions"]) {
      const auto command = action["command"].get<Words>();
      EXPECT_EQ(place.run({command.begin() + 1, command.end()}).status, 0);
      if (action["name"] == "manifest") continue;
      EXPECT_NE(std::search(command.begin(), command.end(), words.begin(), words.end()), command.end())
          << action;
    }
    EXPECT_FALSE(shadersIn(place, "direct").empty());
    EXPECT_EQ(shadersIn(place, "planned"), shadersIn(place, "direct"));
    EXPECT_EQ(place.read("planned/manifest.json"), place.read("direct/manifest.json"));
  }
}

TEST(Usage, actsOnNoTerminal) {
  const Workplace place;
  const std::string coat = example("coat.gltf");
  const std::string acting = "x\x1b[31m\x9b\x7f\xe2\x80\xae\nFORGED\rFORGED";
  const Words all[] = {{"gen", "-o", "o", "-" + acting},
                       {"gen", "-o", "o", "--" + acting},
                       {"ge" + acting},
                       {"gen", coat, "-o", "o", "--target", acting},
                       {"gen", coat, "-o", "o", "--lights", acting},
                       {"gen", coat, "-o", "o", "--lights", "point:1,spot:" + acting},
                       {"gen", coat, "-o", "o", "--switch", acting},
                       {"gen", coat, "-o", "o", "--params", acting},
                       {"gen", coat, "-o", "o", "--limit", acting},
                       {"gen", coat, "-o", "o", "-j", acting},
                       {"graph", coat, "--format", acting},
                       {"merge", "a", "-o", "o", "--" + acting}};
  for (const Words& words : all) {
    SCOPED_TRACE(words.size() > 4 ? words[4] : words[0]);
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.status, 2) << outcome.all();
    EXPECT_NE(outcome.err.find("FORGED"), std::string::npos) << outcome.err;
    for (const char* bytes : {"\x1b", "\x9b", "\x7f", "\xe2\x80\xae", "\nFORGED", "\rFORGED"})
      EXPECT_EQ(outcome.err.find(bytes), std::string::npos) << outcome.err;
  }
}

/// A terminal of one byte a character obeys what is no UTF-8.
TEST(Tables, haveNoBytesThatAreNoUtf8) {
  const Workplace place;
  const std::string gltf = gltfOf({"{}"});
  for (const char* name : {"\x9b"
                           "31m.gltf",
                           "a\xc2.gltf", "\xe2\x80.gltf", "\xc0\x9b.gltf"}) {
    place.write(name, gltf);
    const Outcome outcome = place.run({"gen", name, "-o", "out", "--target", "glsl", "--no-validate"});
    EXPECT_EQ(outcome.status, 0) << outcome.all();
    EXPECT_NE(outcome.out.find("?"), std::string::npos) << outcome.out;
    for (const char byte : {'\x9b', '\xc0', '\xc2'})
      EXPECT_EQ(outcome.out.find(byte), std::string::npos) << outcome.out;
  }
  const std::string character = "\xc4\x9b";  // whose second byte alone would act
  place.write(character, gltf);
  const Outcome outcome = place.run({"gen", character, "-o", "out", "--target", "glsl", "--no-validate"});
  EXPECT_NE(outcome.out.find(character), std::string::npos) << outcome.out;
}

TEST(Inputs, haveNames) {
  const Workplace place;
  const std::string coat = example("coat.gltf");
  for (const Words& words :
       {Words{"gen", "", "-o", "out"}, Words{"gen", coat, "", "-o", "out"},
        Words{"gen", "--graph", "", "-o", "out"}, Words{"plan", "", "-o", "out", "--ninja", "b.ninja"},
        Words{"merge", "", "-o", "out"}, Words{"pack", "", "-o", "out"}}) {
    const Outcome outcome = place.run(words);
    expectRefused(outcome, "no-path");
    EXPECT_TRUE(place.names().empty());
  }
  for (const Words& words :
       {Words{"graph", ""}, Words{"dump", ""}, Words{"prove", ""}, Words{"cost", ""}, Words{"stress", ""},
        Words{"eval", "", "--points", "p"}, Words{"eval", coat, "--points", ""},
        Words{"preview", "", "-o", "a.png"}, Words{"lod", "", "-o", "out"},
        Words{"environment", "", "-o", "out"}, Words{"view", "", "-o", "a.html"},
        Words{"gen", coat, "-o", "out", "--lights", ""}, Words{"graph", coat, "--lights", ""}}) {
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.status, 2) << outcome.all();
    EXPECT_NE(outcome.err.find("must not be empty"), std::string::npos) << outcome.err;
    EXPECT_TRUE(place.names().empty());
  }
}

TEST(Places, thatCannotBeAreToldOf) {
  const Workplace place;
  place.write("a.gltf", gltfOf({"{}"}));
  const std::string longest(300, 'n');
  expectRefused(place.run({"plan", "a.gltf", "-q", "-o", "out", "--ninja", longest}), "file-unwritable");
  expectRefused(place.run({"gen", "a.gltf", "-q", "-o", longest}), "file-unwritable");
  place.write("s.json", manifestOf(entryOf("a.gltf")));
  expectRefused(place.run({"merge", "s.json", "-o", longest}), "file-unwritable");
  // In a working folder that is gone.
  const auto there = [&](const std::string& words) {
    const std::string command =
        fmt::format("cd '{}' && mkdir gone && cd gone && rmdir ../gone && '{}' {} >../sh.out 2>'{}/sh.err'",
                    place.path().string(), LACQUER_PROGRAM, words, place.path().string());
    Outcome outcome;
    const int status = std::system(command.c_str());
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    outcome.err = place.read("sh.err");
    return outcome;
  };
  const std::string at = place.path().string();
  expectRefused(there(fmt::format("plan '{}/a.gltf' -q -o out --ninja b.ninja", at)), "file-unwritable");
  expectRefused(there(fmt::format("gen '{}/a.gltf' -q -o out", at)), "file-unwritable");
  expectRefused(there(fmt::format("gen a.gltf -q -o '{}/out'", at)), "file-unwritable");
  expectRefused(there(fmt::format("merge '{}/s.json' -o out", at)), "file-unwritable");
  const Outcome whole =
      there(fmt::format("gen '{0}/a.gltf' -q --target glsl --no-validate -o '{0}/out'", at));
  EXPECT_EQ(whole.status, 0) << whole.err;
  EXPECT_EQ(place.manifest("out")["files"][0]["source"], "../a.gltf");
  const Outcome joined = there(fmt::format("merge '{0}/s.json' -o '{0}/merged'", at));
  EXPECT_EQ(joined.status, 0) << joined.err;
  EXPECT_EQ(place.manifest("merged")["files"][0]["source"], "../a.gltf");
}

TEST(Numbers, areDecimal) {
  const Workplace place;
  const std::string coat = example("coat.gltf");
  for (const Words& number : {Words{"-j", "010"}, Words{"--size", "020"}, Words{"--levels", "0x2"},
                              Words{"--levels", "010"}, Words{"-j", "0x2"}, Words{"--size", "0x20"}}) {
    Words words = {"lod", coat, "-o", "out"};
    words.insert(words.end(), number.begin(), number.end());
    const Outcome outcome = place.run(words, std::chrono::seconds(20));
    EXPECT_EQ(outcome.status, 2) << outcome.all();
    EXPECT_TRUE(place.names().empty());
  }
}

}  // namespace
}  // namespace lacquer::test::hostile_build_test
