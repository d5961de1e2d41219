// How the program is called, rightly and wrongly: 0, 1 and 2.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "command.h"
#include "lacquer.h"

namespace lacquer::test::usage_test {
namespace {

using Words = std::vector<std::string>;

const Words kVerbs = {"gen",  "plan", "merge",   "graph",  "dump", "nodes",
                      "cost", "eval", "preview", "stress", "view"};

std::string joined(const Words& words) { return fmt::format("{}", fmt::join(words, " ")); }

TEST(Usage, helpEverywhere) {
  const Workplace place;
  const Outcome whole = place.run({"--help"});
  EXPECT_EQ(whole.status, 0) << whole.all();
  EXPECT_EQ(whole.err, "");
  for (const std::string& verb : kVerbs) {
    EXPECT_NE(whole.out.find("\n  " + verb + " "), std::string::npos) << verb << "\n" << whole.out;
    for (const char* flag : {"--help", "-h"}) {
      const Outcome one = place.run({verb, flag});
      EXPECT_EQ(one.status, 0) << one.all();
      EXPECT_EQ(one.err, "");
      EXPECT_NE(one.out.find("Usage: lacquer " + verb), std::string::npos) << one.out;
    }
  }
  EXPECT_TRUE(place.names().empty());
}

TEST(Usage, versionEverywhere) {
  const Workplace place;
  const std::string expected = std::string(version()) + "\n";
  EXPECT_EQ(place.run({"--version"}).out, expected);
  for (const std::string& verb : kVerbs) {
    const Outcome outcome = place.run({verb, "--version"});
    EXPECT_EQ(outcome.status, 0) << verb << outcome.all();
    EXPECT_EQ(outcome.out, expected);
    EXPECT_EQ(outcome.err, "");
  }
}

/// Words that the node library does not know are wrong usage, with what is known.
TEST(Usage, wrongWordsAreTwo) {
  const Workplace place;
  const std::string coat = example("coat.gltf");
  const std::pair<Words, std::string> kCases[] = {
      {{"gen", coat, "-o", "out", "--live", "varnish"}, "unknown-term"},
      {{"gen", coat, "-o", "out", "--live", "/materials/00/emissiveFactor"}, "unknown-property"},
      {{"gen", coat, "-o", "out", "--live", "/emissiveFactor"}, "unknown-property"},
      {{"graph", coat, "--simplify", "coat"}, "bad-simplification"},
      {{"graph", coat, "--simplify", "without:coat.darkning"}, "unknown-term"},
      {{"dump", coat, "--switch", "varnish=on"}, "unknown-switch"},
      {{"dump", coat, "--profile", "varnish"}, "unknown-profile"},
      {{"tune", "varnish"}, "no-such-node"},
      {{"tune", "coat_absorption.varnish"}, "no-such-variant"},
      {{"tune", "coat_absorption", "--live", "varnish"}, "unknown-term"},
  };
  for (const auto& [words, code] : kCases) {
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.status, 2) << joined(words) << "\n" << outcome.all();
    EXPECT_EQ(outcome.out, "") << joined(words);
    EXPECT_NE(outcome.err.find("[" + code + "]"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("\n  help: "), std::string::npos) << joined(words) << outcome.err;
  }
  EXPECT_TRUE(place.names().empty());
  // A file that is not there is none.
  EXPECT_EQ(place.run({"tune", "varnish.gltf"}).status, 1);
  EXPECT_EQ(place.run({"gen", "varnish.gltf", "-o", "out", "--live", "coat"}).status, 1);
}

/// A property of a material that the file does not have stays live nowhere, which is said; of several files
/// another may have it.
TEST(Usage, liveNamesMaterialsThatAreThere) {
  const Workplace place;
  place.write("one.gltf", gltfOf({R"({"name": "one"})"}));
  place.write("two.gltf", gltfOf({R"({"name": "a"})", R"({"name": "b"})"}));
  const std::string live = "/materials/1/emissiveFactor";
  for (const Words& verb : {Words{"gen", "one.gltf", "-o", "out"}, Words{"graph", "one.gltf"},
                            Words{"dump", "one.gltf"}, Words{"preview", "one.gltf", "-o", "one.png"}}) {
    Words words = verb;
    words.insert(words.end(), {"--live", live});
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.status, 1) << joined(words) << outcome.all();
    EXPECT_NE(outcome.err.find("[no-such-material]\n  help: the file has one: /materials/0\n"),
              std::string::npos)
        << joined(words) << outcome.err;
  }
  EXPECT_EQ(place.run({"gen", "two.gltf", "-o", "out", "--unused", "--live", live}).status, 0);
  const Outcome both =
      place.run({"gen", "one.gltf", "two.gltf", "-o", "out", "--unused", "--live", live, "--target", "glsl"});
  EXPECT_EQ(both.status, 0) << both.err;
  EXPECT_NE(both.err.find("one.gltf: warning: "), std::string::npos) << both.err;
  EXPECT_NE(both.out.find("\n3 materials, "), std::string::npos) << both.out;
  const Outcome single = place.run({"gen", "one.gltf", "-o", "single", "--unused", "--target", "glsl"});
  EXPECT_NE(single.out.find("\n1 material, 1 distinct shader, 1 validated\n"), std::string::npos)
      << single.out;
}

/// Nothing is written, nothing goes to stdout, and stderr says what is wrong.
TEST(Usage, wrongUsageIsTwo) {
  const Workplace place;
  const std::string coat = example("coat.gltf");
  const std::pair<Words, std::string> kCases[] = {
      {{}, "subcommand"},
      {{"frobnicate"}, "frobnicate"},
      {{"--frobnicate"}, "frobnicate"},
      {{"gen"}, "--output"},
      {{"gen", coat}, "--output"},
      {{"gen", coat, "-o"}, "--output"},
      {{"gen", coat, "-o", ""}, "empty"},
      {{"preview", coat}, "--output"},
      {{"preview", coat, "-o", ""}, "empty"},
      {{"preview", coat, "-o", "a.png", "--size", "5"}, "--size"},
      {{"preview", coat, "-o", "a.png", "--compare", "float"}, "--compare"},
      {{"preview", coat, "-o", "a.png", "--time", "soon"}, "--time: 'soon' is no number from 0 to 16777216"},
      {{"gen", coat, "-o", "out", "--relaxed", "nan"}, "--relaxed: 'nan' is no number from 0 to 0.5"},
      {{"gen", coat, "-o", "out", "--relaxed", "abc"}, "--relaxed: 'abc' is no number from 0 to 0.5"},
      {{"gen", coat, "-o", "out", "--relaxed", "0.6"}, "--relaxed: '0.6' is no number from 0 to 0.5"},
      {{"lod", coat, "-o", "out", "--most-error", "nan"}, "--most-error: 'nan' is no number from 0 to 100"},
      {{"lod", coat, "-o", "out", "--error", "0.5,nan"}, "--error: must be a number"},
      {{"tune", coat, "--variant", "quick"}, "--variant is of a node"},
      {{"stress", "--samples", "0"}, "--samples"},
      {{"stress", "--samples", "many"}, "--samples"},
      {{"gen", "-o", "out"}, "--graph"},
      {{"gen", coat, "-o", "out", "--frobnicate"}, "--frobnicate"},
      {{"gen", coat, "-o", "out", "--target", "metal"}, "metal"},
      {{"gen", coat, "-o", "out", "--target", "glsl,metal"}, "glsl, glsl-gl, essl, hlsl, spirv"},
      {{"gen", coat, "-o", "out", "--target", ""}, "--target"},
      {{"gen", coat, "-o", "out", "--target", "GLSL"}, "GLSL"},
      {{"gen", coat, "-o", "out", "--params", "frozen"}, "frozen"},
      {{"gen", coat, "-o", "out", "--spirv-from", "hlsl"}, "hlsl"},
      {{"gen", coat, "-o", "out", "--lights", "point:-1"}, "point:-1"},
      {{"gen", coat, "-o", "out", "--lights", "point:1,point:2"}, "'point' is counted twice"},
      {{"gen", coat, "-o", "out", "--jobs", "-1"}, "--jobs"},
      {{"gen", coat, "-o", "out", "--jobs", "many"}, "--jobs"},
      {{"gen", coat, "-o", "out", "--jobs", "99999999"}, "--jobs"},
      {{"gen", coat, "-o", "out", "--graph", "g.json"}, "--graph"},
      {{"gen", "--graph", "g.json", coat, "-o", "out"}, "--graph"},
      {{"gen", "--graph", "g.json", "-o", "out", "--material", "Paint"}, "--material"},
      {{"graph"}, "file"},
      {{"graph", coat, example("core.gltf"), "--material", "Off"}, "file"},
      {{"graph", coat, "--material", "Off", "--format", "xml"}, "xml"},
      {{"dump"}, "file"},
      {{"dump", coat, "--material", "Off", "--after", "nothing"}, "lower"},
      {{"nodes", "coat_f0", "coat_f0"}, "coat_f0"},
      {{"merge", "-o", "out"}, "shards"},
      {{"merge", "x.json"}, "--output"},
      {{"plan", coat, "-o", "out"}, "--ninja"},
  };
  for (const auto& [words, said] : kCases) {
    SCOPED_TRACE(joined(words));
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.status, 2) << outcome.all();
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
    EXPECT_TRUE(place.names().empty());
  }
}

/// What a script's unset variable or a wrong sum makes of an option.
TEST(Usage, wrongNumbersAreTwo) {
  const Workplace place;
  const std::string coat = example("coat.gltf");
  const Words kAll[] = {
      {"gen", coat, "-o", "out"},
      {"plan", coat, "-o", "out", "--ninja", "n"},
      {"graph", coat},
      {"dump", coat},
      {"prove", coat},
      {"eval", coat, "--points", "p"},
      {"preview", coat, "-o", "a.png"},
      {"stress", coat},
  };
  const auto refused = [&](Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    SCOPED_TRACE(joined(words));
    const Outcome outcome = place.run(words, std::chrono::seconds(20));
    EXPECT_EQ(outcome.status, 2) << outcome.all();
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(more[0]), std::string::npos) << outcome.err;
    EXPECT_TRUE(place.names().empty());
  };
  for (const Words& words : kAll) {
    for (const char* limit :
         {"foo", "colour=2", "file=-1", "file=", "file=0", "depth=nan", "", "file=9999999T"})
      refused(words, {"--limit", limit});
  }
  for (size_t i = 0; i < 6; ++i) {
    refused(kAll[i], {"--template", ""});
    refused(kAll[i], {"--profile", ""});
    refused(kAll[i], {"--nodes", ""});
  }
  for (const char* number : {"-1", "18446744073709551616", "", "1e3", "0x10", "010", " 1", "nan"}) {
    for (const char* option : {"--seed", "--samples", "--total", "--jobs"})
      refused(kAll[7], {option, number});
    for (const char* option : {"--size", "--columns", "--jobs"}) refused(kAll[6], {option, number});
    refused(kAll[0], {"--jobs", number});
    refused({"dfg", "-o", "x"}, {"--size", number});
  }
  for (const char* option : {"--cache", "--cache-key", "--depfile", "--shard"})
    refused(kAll[0], {option, ""});
  refused({"plan", coat, "-o", "out"}, {"--ninja", ""});
  refused({"dfg"}, {"--sheen", ""});
}

/// An option that may be repeated leaves the file behind its argument alone.
TEST(Usage, filesMayStandAnywhere) {
  const Workplace place;
  const std::string coat = example("coat.gltf");
  const Words kCases[] = {
      {"gen", coat, "-o", "out", "--target", "glsl", "--material", "Off"},
      {"gen", "--target", "glsl", "--material", "Off", coat, "-o", "out"},
      {"gen", "-o", "out", "--material", "Off", "--target", "glsl", coat},
      {"gen", "--live", "coat.f0", coat, "-o", "out", "--target=glsl", "--material=Off"},
  };
  for (const Words& words : kCases) {
    SCOPED_TRACE(joined(words));
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.all();
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(place.manifest("out")["files"][0]["materials"].size(), 1u);
    std::filesystem::remove_all(place / "out");
  }
}

TEST(Usage, materialThatIsNotThere) {
  const Workplace place;
  const std::string coat = example("coat.gltf");
  for (const Words& words :
       {Words{"gen", coat, "-o", "out", "--material", "Nope"}, Words{"graph", coat, "--material", "Nope"},
        Words{"dump", coat, "--material", "Nope"}, Words{"graph", coat, "--material", ""}}) {
    SCOPED_TRACE(joined(words));
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.status, 1) << outcome.all();
    for (const char* known : {"'Weight and roughness'", "'Index of refraction'", "'Off'"}) {
      EXPECT_NE(outcome.err.find(known), std::string::npos) << known << " is not named:\n" << outcome.err;
    }
    EXPECT_EQ(outcome.err.find("\n\n"), std::string::npos) << "an empty line:\n" << outcome.err;
  }
  const Outcome without = place.run({"graph", coat});
  EXPECT_EQ(without.status, 1);
  EXPECT_NE(without.err.find("several materials, and none is named"), std::string::npos) << without.err;
}

TEST(Usage, graphOfOneMaterialNeedsNoName) {
  const Workplace place;
  place.write("one.gltf", gltfOf({R"({"name": "Only"})"}));
  place.write("none.gltf", gltfOf({}));
  place.write("twice.gltf", gltfOf({R"({"name": "a"})", R"({"name": "a", "doubleSided": true})"}));
  EXPECT_EQ(place.run({"graph", "one.gltf"}).status, 0);
  EXPECT_EQ(place.run({"dump", "one.gltf"}).status, 0);
  const Outcome none = place.run({"graph", "none.gltf"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("no materials"), std::string::npos) << none.err;
  const Outcome twice = place.run({"graph", "twice.gltf", "--material", "a"});
  EXPECT_EQ(twice.status, 0) << twice.all();
  EXPECT_NE(twice.err.find("2 materials are named 'a'"), std::string::npos) << twice.err;
}

TEST(Usage, graphRoundTrip) {
  const Workplace place;
  const std::string paint = example("car_paint.gltf");
  const Outcome json = place.run({"graph", paint, "--material", "Car paint"});
  EXPECT_EQ(json.status, 0) << json.all();
  EXPECT_EQ(json.err, "");
  place.write("paint.json", json.out);
  const Outcome first = place.run({"gen", "--graph", "paint.json", "-o", "a"});
  const Outcome second = place.run({"gen", paint, "--material", "Car paint", "-o", "b"});
  EXPECT_EQ(first.status, 0) << first.all();
  EXPECT_EQ(second.status, 0) << second.all();
  EXPECT_EQ(place.manifest("a")["shaders"], place.manifest("b")["shaders"]);
  EXPECT_EQ(place.manifest("a")["files"][0]["source"], "../paint.json");
  EXPECT_EQ(place.manifest("a")["files"][0]["materials"][0]["name"], "Car paint");
  const Outcome dot = place.run({"graph", paint, "--material", "Car paint", "--format", "dot"});
  EXPECT_EQ(dot.status, 0);
  EXPECT_TRUE(dot.out.starts_with("digraph")) << dot.out;
}

TEST(Usage, dumpAfterEachPass) {
  const Workplace place;
  const std::vector<std::string> passes = passNames();
  EXPECT_EQ(passes.front(), "lower");
  ASSERT_GE(passes.size(), 4u);
  const Words base = {"dump", example("car_paint.gltf"), "--material", "Car paint"};
  const Outcome last = place.run(base);
  EXPECT_EQ(last.status, 0) << last.all();
  for (const std::string& pass : passes) {
    Words words = base;
    words.insert(words.end(), {"--after", pass});
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.status, 0) << pass << outcome.all();
    EXPECT_EQ(outcome.err, "");
    EXPECT_NE(outcome.out.find("fragment"), std::string::npos) << pass << ": no rates in\n" << outcome.out;
    if (pass == "lower") {
      EXPECT_NE(outcome.out, last.out);
    }
    if (pass == passes.back()) {
      EXPECT_EQ(outcome.out, last.out);
    }
  }
}

TEST(Usage, nodes) {
  const Workplace place;
  const Outcome list = place.run({"nodes"});
  EXPECT_EQ(list.status, 0) << list.all();
  EXPECT_NE(list.out.find("coat_absorption"), std::string::npos);
  for (const char* named : {"\ntemplates\n", "\nforward ", "\nprofiles\n", "\nopenpbr "})
    EXPECT_NE(list.out.find(named), std::string::npos) << named;
  const Outcome all = place.run({"nodes", "--json"});
  EXPECT_EQ(all.status, 0);
  const auto json = nlohmann::json::parse(all.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << all.out;
  ASSERT_GT(json["nodes"].size(), 20u);
  for (const auto& node : json["nodes"]) {
    SCOPED_TRACE(node["name"].get<std::string>());
    const std::string line = "\n" + node["name"].get<std::string>() + " ";
    EXPECT_NE(("\n" + list.out).find(line), std::string::npos) << "not listed";
    EXPECT_FALSE(node["source"].get<std::string>().empty());
    EXPECT_FALSE(node["doc"].get<std::string>().empty());
    EXPECT_FALSE(node["outputs"].empty());
    EXPECT_TRUE(node["inputs"].is_array());
    EXPECT_TRUE(node["variants"].is_array());
    for (const auto& input : node["inputs"]) EXPECT_TRUE(input.contains("name") && input.contains("type"));
  }
  const Outcome one = place.run({"nodes", "coat_absorption", "--json"});
  EXPECT_EQ(nlohmann::json::parse(one.out, nullptr, false)["name"], "coat_absorption");
  const Outcome text = place.run({"nodes", "coat_absorption"});
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.out.find("source: KHR_materials_coat"), std::string::npos) << text.out;
  const Outcome none = place.run({"nodes", "coat_absorbtion"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("coat_absorbtion"), std::string::npos);
}

/// A misspelt name must not mean that nothing was asked for.
TEST(Usage, previewWritesAPicture) {
  const Workplace place;
  const Outcome good = place.run({"preview", example("clearcoat_tint.gltf"), "-o", "a.png", "--size", "16",
                                  "--compare", "float", "double"});
  EXPECT_EQ(good.status, 0) << good.all();
  EXPECT_NE(good.out.find("Amber"), std::string::npos) << good.out;
  EXPECT_EQ(good.err, "");
  EXPECT_EQ(place.read("a.png").substr(1, 3), "PNG");
  const Outcome bad =
      place.run({"preview", example("clearcoat_tint.gltf"), "-o", "b.png", "--compare", "float", "quick"});
  EXPECT_EQ(bad.status, 1) << bad.all();
  EXPECT_NE(bad.err.find("[unknown-setting]"), std::string::npos) << bad.err;
  EXPECT_FALSE(place.has("b.png"));
}

TEST(Usage, stressSaysWhatItFinds) {
  const Workplace place;
  place.write("bad.node",
              "/// D.\n/// source: S\nnode bad(float x in [0, 1]) -> float { return sin(x) / x; }\n");
  const Outcome good = place.run({"stress", "schlick", "--samples", "100"});
  EXPECT_EQ(good.status, 0) << good.all();
  EXPECT_NE(good.out.find("0 faults"), std::string::npos) << good.out;
  const Outcome bad = place.run({"stress", "bad", "--nodes", ".", "--samples", "5000"});
  EXPECT_EQ(bad.status, 1) << bad.all();
  EXPECT_NE(bad.out.find(R"(case: {"node":"bad","fault":"nan","what":"the result","samples":[{"x":0.0}]})"),
            std::string::npos)
      << bad.out;
  const Outcome half = place.run({"stress", "bad", "--nodes", ".", "--samples", "5000", "--mediump"});
  EXPECT_EQ(half.status, 0) << half.all();
  EXPECT_NE(half.out.find("nan"), std::string::npos) << half.out;
  EXPECT_EQ(place.run({"stress", "worse"}).status, 1);
}

TEST(Usage, everyTargetIsNamedWhereOneIsMissing) {
  const Workplace place;
  const Outcome outcome = place.run({"gen", example("coat.gltf"), "-o", "out", "--target", "nope"});
  EXPECT_EQ(outcome.status, 2) << outcome.all();
  const Outcome help = place.run({"gen", "--help"});
  for (const std::string& name : targetNames()) {
    EXPECT_NE(outcome.err.find(" " + name), std::string::npos) << name << "\n" << outcome.err;
    EXPECT_NE(help.out.find(name), std::string::npos) << name;
  }
}

TEST(Usage, allThatLooksAtNodesLooksAtParts) {
  const Workplace place;
  place.write("n/a.node",
              "/// P.\npart example over base {\nsurface:\n    out emission = vec2(1);\n"
              "    out direct = missing.name;\n}\n");
  place.write("m/a.node",
              "/// P.\npart example_a over base {\nsurface:\n    out emission = vec3(1);\n}\n"
              "/// P.\npart example_b over base {\nsurface:\n    out emission = vec3(0);\n}\n");
  for (const Words& verb : {Words{"prove"}, Words{"nodes"}, Words{"stress", "schlick", "--samples", "100"}}) {
    Words words = verb;
    words.insert(words.end(), {"--nodes", "n"});
    const Outcome wrong = place.run(words);
    EXPECT_EQ(wrong.status, 1) << wrong.all();
    EXPECT_NE(wrong.err.find("n/a.node:5:"), std::string::npos) << wrong.all();
    words.back() = "m";
    const Outcome unordered = place.run(words);
    EXPECT_EQ(unordered.status, 0) << unordered.all();
    EXPECT_NE(unordered.err.find("[unordered-parts]"), std::string::npos) << unordered.all();
  }
}

TEST(Usage, misspeltTemplatesAndTermsAreErrors) {
  const Workplace place;
  const std::string coat = example("coat.gltf");
  const Outcome no_template = place.run({"gen", coat, "-o", "out", "--template", "foward"});
  EXPECT_NE(no_template.status, 0);
  EXPECT_NE(no_template.err.find("foward"), std::string::npos) << no_template.err;
  const Outcome no_term = place.run({"gen", coat, "-o", "out", "--live", "coat.darkning"});
  EXPECT_NE(no_term.status, 0) << no_term.all();
  EXPECT_NE(no_term.err.find("coat.darkning"), std::string::npos) << no_term.err;
  const Outcome no_folder = place.run({"gen", coat, "-o", "out", "--nodes", "nowhere"});
  EXPECT_EQ(no_folder.status, 1);
  EXPECT_NE(no_folder.err.find("nowhere"), std::string::npos) << no_folder.err;
}

}  // namespace
}  // namespace lacquer::test::usage_test
