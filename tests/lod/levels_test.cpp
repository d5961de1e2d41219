// Levels of detail from files, as the public function makes them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "cost/cost.h"
#include "lacquer.h"
#include "lod/material.h"
#include "manifest/stale.h"
#include "setting/language.h"
#include "setting/options.h"
#include "support/answers.h"
#include "support/cases.h"
#include "support/file.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Levels : public testing::Test {
protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              fmt::format("lacquer_levels_{}", testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  static void TearDownTestSuite() { fs::remove_all(chainFolder()); }

  static Options quick() {
    Options options;
    options.targets = {Target::Spirv, Target::Glsl};
    options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
    options.ibl = false;  // half the candidates
    return options;
  }

  json make(const std::string& file, Lod lod, const Options& options) {
    lod.output = (folder_ / "out").string();
    return makeIn(lod, file, options);
  }

  static json makeIn(const Lod& lod, const std::string& file, const Options& options) {
    Messages messages;
    const std::string answer = jsonOf(makeLevels(lod, {file}, {}, options, messages));
    EXPECT_FALSE(hasError(messages)) << messages[0].text;
    return answer.empty() ? json() : json::parse(answer);
  }

  static std::string work(const char* name) {
    return (sourceFolder() / "bench/works" / (std::string(name) + ".gltf")).string();
  }

  /// A search takes seconds: the levels of W1 are looked for once, and several tests look at them.
  static fs::path chainFolder() { return fs::path(testing::TempDir()) / "lacquer_levels_of_w1"; }
  static Lod chainLod(const fs::path& folder) {
    Lod lod;
    lod.size = 16;
    lod.most_error = 1;  // what looks twice as wrong is not tried
    lod.output = folder.string();
    return lod;
  }
  static const json& chain() {
    static const json kAnswer = [] {
      fs::remove_all(chainFolder());
      fs::create_directories(chainFolder());
      return makeIn(chainLod(chainFolder()), work("w1"), quick());
    }();
    return kAnswer;
  }

  fs::path folder_;
};

const json* materialBlock(const json& shader) {
  for (const json& block : shader["uniforms"]) {
    if (block["role"] == "material") return &block;
  }
  return nullptr;
}

/// What a block has where: that a shader makes a field of what it does is its own.
json placesOf(const json& fields) {
  json places = json::array();
  for (const json& field : fields) places.push_back({field["name"], field["offset"], field["type"]});
  return places;
}

TEST_F(Levels, CostByTheModelWhereThatIsAsked) {
  Options options = quick();
  options.programs_model = true;
  Lod lod = chainLod(folder_ / "out");
  lod.costs = {0.95};
  Messages messages;
  const std::optional<lacquer::Levels> made = makeLevels(lod, {work("w0")}, {}, options, messages);
  ASSERT_TRUE(made && !hasError(messages)) << messages[0].text;
  EXPECT_EQ(made->driver, "") << "no driver is asked";
  EXPECT_GT(made->materials[0].levels[0].figures.cost, 0);
}

TEST_F(Levels, AreAChainOfOneInterfaceThatIsAsMeasured) {
  const json& answer = chain();
  ASSERT_EQ(answer["materials"].size(), 1U);
  const json& levels = answer["materials"][0]["levels"];
  ASSERT_GE(levels.size(), 3U);
  const json manifest = json::parse(readFile(chainFolder() / "manifest.json"));
  EXPECT_EQ(manifest["levels"], answer["materials"]);

  const json& exact = manifest["shaders"][levels[0]["shader"].get<std::string>()];
  EXPECT_TRUE(levels[0]["simplify"].empty());
  EXPECT_EQ(levels[0]["error"]["delta_e"]["mean"], 0);
  EXPECT_GT(levels[0]["cost"]["quarter_rate"], levels[0]["cost"]["inverse_throughput"]);
  for (size_t i = 0; i < levels.size(); ++i) {
    const json& shader = manifest["shaders"][levels[i]["shader"].get<std::string>()];
    EXPECT_TRUE(shader["validated"]["spirv"].get<bool>());
    EXPECT_TRUE(shader["validated"]["glsl"].get<bool>());
    for (const json& texture : shader["textures"])
      EXPECT_NE(std::find(exact["textures"].begin(), exact["textures"].end(), texture),
                exact["textures"].end());
    if (const json* block = materialBlock(shader)) {
      const json* whole = materialBlock(exact);
      ASSERT_NE(whole, nullptr);
      EXPECT_EQ((*block)["size"], (*whole)["size"]);
      EXPECT_EQ((*block)["binding"], (*whole)["binding"]);
      EXPECT_EQ(placesOf((*block)["fields"]), placesOf((*whole)["fields"]));
    }
    if (i == 0) continue;
    EXPECT_LT(levels[i]["cost"]["counted"], levels[i - 1]["cost"]["counted"]);
    EXPECT_GE(levels[i]["cost"]["counted"], levels[i]["cost"]["inverse_throughput"]);
    EXPECT_GE(levels[i]["error"]["delta_e"]["mean"], levels[i - 1]["error"]["delta_e"]["mean"]);
    // What has all of its roots at the vertices has none left to count.
    EXPECT_GE(levels[i]["cost"]["quarter_rate"], levels[i]["cost"]["inverse_throughput"]);
    EXPECT_TRUE(fs::exists(chainFolder() / fmt::format("pictures/0-0-{}.png", i)));
  }
  EXPECT_EQ(levels.back()["screen_size"], 32);
  EXPECT_LE(levels.back()["error"]["delta_e"]["mean"], 1);

  if (!cost::unavailable().empty()) GTEST_SKIP() << "the costs are estimates: " << cost::unavailable();
  Messages messages;
  for (const ShaderCost& cost : measureCost({chainFolder().string()}, false, messages)) {
    for (const json& level : levels) {
      if (level["shader"] != cost.name) continue;
      EXPECT_EQ(level["cost"]["inverse_throughput"], cost.gpus[0].inverse_throughput) << cost.name;
    }
  }
}

TEST_F(Levels, AreLookedForFromWhereASearchWasEnded) {
  struct Ended {};
  Options options = quick();
  options.cache = (folder_ / "cache").string();
  Lod lod = chainLod(folder_ / "out");
  Messages messages;
  size_t steps = 0;
  LodStep last;
  lod.step = [&](const LodStep& step) {
    last = step;
    if (++steps == 4) throw Ended();
  };
  EXPECT_THROW(makeLevels(lod, {work("w1")}, {}, options, messages), Ended);
  EXPECT_EQ(last.cached, 0U);
  EXPECT_EQ(last.material, "W1");

  std::vector<size_t> cached;
  LodStep::Stage stage = LodStep::Stage::Words;
  lod.step = [&](const LodStep& step) {
    last = step;
    cached.push_back(step.cached);
    EXPECT_GE(step.stage, stage) << "one after the other";
    stage = step.stage;
    // All words are done with the last step of theirs.
    EXPECT_LE(step.at + (stage == LodStep::Stage::Words ? 0 : 1), step.of);
  };
  EXPECT_EQ(makeIn(lod, work("w1"), options)["materials"], chain()["materials"]);
  ASSERT_GT(cached.size(), 4U);
  for (size_t i = 0; i + 1 < 4; ++i) EXPECT_GT(cached[i + 1], cached[i]);
  const size_t known = last.cached;
  EXPECT_GT(known, 48U);
  EXPECT_EQ(last.stage, LodStep::Stage::Levels);

  // All of it is known now; nothing is of a material of other numbers.
  stage = LodStep::Stage::Words;
  EXPECT_EQ(makeIn(lod, work("w1"), options)["materials"], chain()["materials"]);
  EXPECT_GT(last.cached, known);
  std::string other = readFile(work("w1"));
  const size_t place = other.find("\"roughnessFactor\"");
  ASSERT_NE(place, std::string::npos);
  other.replace(other.find_first_of("0123456789", place), 3, "0.7");
  std::ofstream(folder_ / "other.gltf") << other;
  lod.step = [&](const LodStep& step) {
    last = step;
    throw Ended();
  };
  EXPECT_THROW(makeLevels(lod, {(folder_ / "other.gltf").string()}, {}, options, messages), Ended);
  EXPECT_EQ(last.cached, 0U);
}

/// What is known of a material holds beside other ones, too, but not of other numbers.
TEST_F(Levels, AreKeptByMaterial) {
  json file = json::parse(readFile(work("w0")));
  json second = file["materials"][0];
  second["name"] = "Second";
  second["pbrMetallicRoughness"]["roughnessFactor"] = 0.33;
  file["materials"].push_back(second);
  const std::string path = (folder_ / "two.gltf").string();
  Options options = quick();
  options.cache = (folder_ / "cache").string();
  Lod lod = chainLod(folder_ / "out");
  lod.levels = 2;
  LodStep last;
  size_t fewest = 0;
  lod.step = [&](const LodStep& step) {
    fewest = last.measured == 0 ? step.cached : std::min(fewest, step.cached);
    last = step;
  };
  const auto of = [&](const std::string& name) {
    std::ofstream(path) << file.dump();
    last = {};
    Messages messages;
    const auto made = makeLevels(lod, {path}, {name}, options, messages);
    EXPECT_TRUE(made && !hasError(messages));
    return made ? json::parse(jsonOf(made))["materials"] : json();
  };
  Messages messages;
  std::ofstream(path) << file.dump();
  const auto whole = makeLevels(lod, {path}, {}, options, messages);
  ASSERT_TRUE(whole && !hasError(messages));
  const json both = json::parse(jsonOf(whole))["materials"];
  EXPECT_EQ(last.cached, 0U);
  EXPECT_EQ(of("Second")[0], both[1]);
  EXPECT_GT(fewest, 0U) << "a material alone";
  file["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.2;
  EXPECT_EQ(of("Second")[0], both[1]);
  EXPECT_GT(fewest, 0U) << "another material changed";
  file["materials"][1]["pbrMetallicRoughness"]["metallicFactor"] = 0.9;
  of("Second");
  EXPECT_EQ(last.cached, 0U) << "its own numbers changed";
}

/// Shaders that a killed run has noted and written go with the next run.
TEST_F(Levels, LeaveNoShadersOfAKilledRun) {
  const std::string out = (folder_ / "out").string();
  const std::string left = "spirv/forward-00000000000000000000000000000000.frag.spv";
  fs::create_directories(folder_ / "out/spirv");
  {
    Scratch scratch(out);
    LeftShaders(out, scratch, {}).expect({left});
    std::ofstream(folder_ / "out" / left) << "of a killed run";
  }
  const Lod lod = chainLod(out);
  EXPECT_FALSE(makeIn(lod, work("w0"), quick()).empty());
  EXPECT_FALSE(fs::exists(folder_ / "out" / left));
  EXPECT_FALSE(fs::exists(Scratch::below(out)));
}

/// The first material of a file, as levels are looked for.
void withFile(const std::string& path, Options named, const std::function<void(LodMaterial&)>& look) {
  named.switches["specular_antialiasing"] = true;  // as in all levels
  const auto language = libraryFor(named);
  ASSERT_TRUE(language.has_value());
  ASSERT_TRUE(resolveNames(**language, named).has_value());
  const auto document = readMaterials(path, **language, named);
  ASSERT_TRUE(document.has_value());
  FileImages images(path, named);
  const Strings no_texels;
  const preview::Mesh no_mesh;
  LodMaterial material({document->materials[0], document->uses[0][0], lightsOf(*document), images, **language,
                        named, no_texels, no_mesh, 1},
                       16);
  look(material);
}

TEST_F(Levels, HaveTheDifferenceThatTheirWordsMake) {
  const json& answer = chain();
  const json& level = answer["materials"][0]["levels"].back();
  withFile(work("w1"), quick(), [&](LodMaterial& again) {
    const auto words = level["simplify"].get<lod::Words>();
    const auto exact = again.shots({}, 16, atVertices(words));
    const auto simpler = again.shots(words, 16, atVertices(words));
    ASSERT_TRUE(exact && simpler);
    const SeenDifference seen = preview::compareShots(*exact, *simpler);
    EXPECT_EQ(seen.delta_e, level["error"]["delta_e"]["mean"].get<double>());
    EXPECT_EQ(seen.flip_95, level["error"]["flip"]["p95"].get<double>());
    EXPECT_GT(seen.delta_e, 0);
  });
}

/// Numbers are fitted to what is seen: with squares of distances in L*a*b* 0.97 and 0.89 would be left.
TEST_F(Levels, FittedNumbersLookLessWrong) {
  withFile(work("w1"), quick(), [&](LodMaterial& subject) {
    Messages messages;
    ASSERT_TRUE(subject.open(messages).has_value());
    for (const char* word : {"without:coat", "lod:coat_base_lobe"}) {
      const lod::Words words{word};
      const std::optional<lod::Words> fitted = subject.fitted(words);
      ASSERT_TRUE(fitted.has_value());
      const std::vector<std::optional<lod::Tried>> found = subject.measure({words, *fitted});
      ASSERT_TRUE(found[0] && found[1]);
      EXPECT_LT(found[1]->error, 0.7 * found[0]->error) << word;
    }
  });
}

/// Highlights hold still in every level, unless somebody says no; nothing that is tried takes it off.
TEST_F(Levels, AreAntialiased) {
  const auto derivatives = [](const fs::path& folder, const json& answer) {
    size_t count = 0;
    for (const json& level : answer["materials"][0]["levels"]) {
      const std::string shader = level["shader"].get<std::string>();
      const json manifest = json::parse(readFile(folder / "manifest.json"));
      const std::string file = manifest["shaders"][shader]["files"]["glsl"]["frag"].get<std::string>();
      count += readFile(folder / file).find("dFdx(") != std::string::npos ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(derivatives(chainFolder(), chain()), chain()["materials"][0]["levels"].size());
  Options off = quick();
  off.switches["specular_antialiasing"] = false;
  const json plain = make(work("w1"), chainLod({}), off);
  EXPECT_EQ(derivatives(folder_ / "out", plain), 0U);
}

/// What stands for a texture is the mean of the texels that it is made of, decoded before the mean is taken.
TEST_F(Levels, MeansAreOfTheChannelsTaken) {
  const std::string image =
      "data:image/png;base64,"
      "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR4nGM40aARJcL1Sw4ADvsDAbdwf6QAAAAASUVORK5CYII=";
  const auto textured = [&](const json& texture) {
    const json gltf = {{"asset", {{"version", "2.0"}}},
                       {"images", {{{"uri", image}}}},
                       {"textures", {texture}},
                       {"materials", {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}}}};
    const std::string file = (folder_ / "textured.gltf").string();
    std::ofstream(file) << gltf.dump();
    Options named = quick();
    const auto language = libraryFor(named);
    EXPECT_TRUE(resolveNames(**language, named).has_value());
    const auto document = readMaterials(file, **language, named);
    FileImages images(file, named);
    const Strings no_texels;
    const preview::Mesh no_mesh;
    const gltf::VertexAttributes attributes{true, false, false, {true, false, false, false}};
    LodMaterial subject({document->materials[0], attributes, lightsOf(*document), images, **language, named,
                         no_texels, no_mesh, 1},
                        16);
    Messages messages;
    EXPECT_TRUE(subject.open(messages).has_value());
    for (const std::string& word : subject.words()) {
      if (word.starts_with("texel:baseColorTexture=")) return word.substr(word.find('=') + 1);
    }
    return std::string("no word");
  };
  const auto swizzled = [](std::vector<int> channels) {
    return json{
        {"extensions", {{"NV_texture_swizzle", {{"options", {{{"source", 0}, {"channels", channels}}}}}}}}};
  };
  EXPECT_EQ(textured({{"source", 0}}), "0.2923,0.1094,0.4886,0.2353");
  EXPECT_EQ(textured(swizzled({2, 0, 1, 3})), "0.4886,0.2923,0.1094,0.2353");
  EXPECT_EQ(textured(swizzled({0, 3, -1, 1})), "0.2923,0.05761,1,0.2706");
}

/// A coat that hardly is one can go.
TEST_F(Levels, AWeakCoatCostsLess) {
  json gltf = json::parse(readFile(work("w1")));
  gltf["materials"][0]["extensions"]["KHR_materials_clearcoat"]["clearcoatFactor"] = 0.02;
  const std::string file = (folder_ / "weak.gltf").string();
  std::ofstream(file) << gltf.dump();
  Lod lod;
  lod.size = 16;
  lod.errors = {0.5};
  const json levels = make(file, lod, quick())["materials"][0]["levels"];
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_LE(levels[1]["error"]["delta_e"]["mean"], 0.5);
  EXPECT_LE(levels[1]["cost"]["inverse_throughput"].get<double>(),
            0.85 * levels[0]["cost"]["inverse_throughput"].get<double>());
}

/// Four triangles of a tetrahedron, as base64: positions of 12 vertices, three for each side.
json tetrahedron() {
  json gltf = json::parse(readFile(sourceFolder() / "bench/works/w1.gltf"));
  const std::array<std::array<float, 3>, 4> p{{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}};
  std::string bytes;
  for (const auto& side :
       {std::array{0, 1, 3}, std::array{0, 2, 1}, std::array{0, 3, 2}, std::array{1, 2, 3}}) {
    for (const int corner : side) {
      for (const float x : p[static_cast<size_t>(corner)])
        bytes += x > 0 ? std::string("\0\0\x80\x3f", 4) : std::string("\0\0\x80\xbf", 4);
    }
  }
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | static_cast<unsigned char>(bytes[i + k]);
    for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[word >> shift & 63];
  }
  gltf["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + text}}};
  gltf["bufferViews"] = {{{"buffer", 0}, {"byteLength", bytes.size()}}};
  gltf["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"count", 12}, {"type", "VEC3"}}};
  gltf["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 0}};
  return gltf;
}

TEST_F(Levels, AreComparedOnTheFilesOwnGeometryToo) {
  const std::string file = (folder_ / "tetrahedron.gltf").string();
  std::ofstream(file) << tetrahedron().dump();
  Lod lod;
  lod.size = 16;
  lod.errors = {0.5};
  const json with = make(file, lod, quick())["materials"][0];
  ASSERT_EQ(with["levels"].size(), 2U);
  EXPECT_EQ(with["triangles"], 4);
  EXPECT_NEAR(with["radius"].get<double>(), std::sqrt(3), 1e-12);
  const json& level = with["levels"].back();
  ASSERT_TRUE(level.contains("error_on_geometry"));
  EXPECT_GT(level["error_on_geometry"]["delta_e"]["mean"], 0);
  EXPECT_GT(level["error_on_geometry_at_screen_size"]["delta_e"]["mean"], 0);
  EXPECT_NE(level["error_on_geometry"], level["error"]);
  EXPECT_NE(readFile(folder_ / "out/report.html").find("4 triangles of the file"), std::string::npos);
  const json& without = chain()["materials"][0];
  EXPECT_EQ(without["triangles"], 0);
  EXPECT_FALSE(without["levels"].back().contains("error_on_geometry"));
}

/// Stripes in space, some four of them in a meter.
constexpr const char* kStripes = R"(
/// Stripes.
/// source: a test
extension ACME_materials_stripes {
    status vendor;
    float stripesFactor in [0, 1];
}
/// Stripes over the base.
/// source: a test
part stripes of ACME_materials_stripes over base unless stripesFactor == 0 {
surface:
    stripes.color = striped(base.color, position, stripesFactor);
    replace base.color with stripes.color;
}
/// Darker and brighter along x.
/// source: a test
node striped(vec4 below in [0, 1], vec3 p, float factor in [0, 1]) -> vec4 in [0, 1] {
    float waves = sin(25 * p.x + sin(23 * p.y) + sin(21 * p.z) + sin(19 * (p.x + p.y)) + sin(17 * (p.y + p.z)));
    return vec4(below.rgb * (1 - factor * (0.5 + 0.5 * waves)), below.a);
}
)";

/// Whether a level computes the stripes at the vertices of an object of that radius.
TEST_F(Levels, WhatIsDrawnInSpaceIsAsFineAsOnTheObject) {
  std::ofstream(folder_ / "stripes.node") << kStripes;
  const std::string file = (folder_ / "striped.gltf").string();
  std::ofstream(file) << R"({"asset": {"version": "2.0"}, "materials": [{"extensions": {
      "ACME_materials_stripes": {"stripesFactor": 1}}}]})";
  const auto atVertices = [&](double radius) {
    Lod lod;
    lod.size = 32;
    lod.errors = {1};
    lod.radius = radius;
    Options options = quick();
    options.node_directories = {folder_.string()};
    const json chain = make(file, lod, options)["materials"][0];
    EXPECT_EQ(chain["radius"], radius);
    for (const json& word : chain["levels"].back()["simplify"]) {
      if (word == "vertex:stripes.color") return true;
    }
    return false;
  };
  EXPECT_TRUE(atVertices(0.05));
  EXPECT_FALSE(atVertices(20));
}

TEST_F(Levels, EqualInputGivesEqualBytes) {
  EXPECT_EQ(makeIn(chainLod(folder_), work("w1"), quick())["materials"], chain()["materials"]);
  size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(chainFolder())) {
    if (!entry.is_regular_file()) continue;
    ++files;
    EXPECT_EQ(readFile(entry.path()), readFile(folder_ / fs::relative(entry.path(), chainFolder())))
        << entry.path();
  }
  EXPECT_GE(files, 8U);
}

TEST_F(Levels, WrongRequestsAreMessages) {
  struct Wrong {
    const char* code;
    std::function<void(Lod&, Options&)> make;
  };
  const Wrong kWrong[] = {
      {"no-path", [](Lod& lod, Options&) { lod.output.clear(); }},
      {"out-of-range", [](Lod& lod, Options&) { lod.levels = 1; }},
      {"out-of-range", [](Lod& lod, Options&) { lod.size = 1 << 20; }},
      {"out-of-range", [](Lod& lod, Options&) { lod.radius = 0; }},
      {"out-of-range",
       [](Lod& lod, Options&) {
         lod.errors = {2, 1};
       }},
      {"out-of-range", [](Lod& lod, Options&) { lod.errors = {std::nan("")}; }},
      {"out-of-range", [](Lod& lod, Options&) { lod.costs = {1.5}; }},
      {"out-of-range", [](Lod& lod, Options&) { lod.most_error = -1; }},
      {"wrong-count", [](Lod& lod, Options&) { lod.errors = {1}, lod.costs = {0.5}; }},
      {"lod-parameters",
       [](Lod&, Options& options) {
         options.parameters = Parameters::Spec;
         options.targets = {Target::Spirv};
       }},
      {"lod-template", [](Lod&, Options& options) { options.template_name = "surface"; }},
      {"bad-texel", [](Lod& lod, Options&) { lod.texels = {"nonsense"}; }},
      {"unknown-term", [](Lod&, Options& options) { options.simplify = {"without:nobody"}; }},
  };
  for (const Wrong& wrong : kWrong) {
    Lod lod;
    lod.output = (folder_ / "out").string();
    Options options = quick();
    options.lights = {};
    wrong.make(lod, options);
    Messages messages;
    EXPECT_FALSE(makeLevels(lod, {work("w0")}, {}, options, messages)) << wrong.code;
    const bool said = std::any_of(messages.begin(), messages.end(),
                                  [&](const Message& message) { return message.code == wrong.code; });
    EXPECT_TRUE(said) << wrong.code << ": " << (messages.empty() ? "nothing" : messages[0].text);
    EXPECT_FALSE(fs::exists(folder_ / "out/manifest.json"));
  }
  Lod lod;
  lod.output = (folder_ / "out").string();
  Messages messages;
  EXPECT_FALSE(makeLevels(lod, {(folder_ / "absent.gltf").string()}, {}, quick(), messages));
  EXPECT_TRUE(hasError(messages));
}

}  // namespace
}  // namespace lacquer::test
