// `lacquer convert` and `lacquer bake`: materials for other tools, and patterns as images.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "command.h"
#include "lacquer.h"
#include "lacquer/exchange.h"
#include "support/cases.h"

namespace lacquer::test::exchange_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kDocument = R"(<materialx version="1.39">
  <nodegraph name="NG">
    <ramplr name="across" type="color3">
      <input name="valuel" type="color3" value="0.1, 0.2, 0.9"/>
      <input name="valuer" type="color3" value="0.8, 0.4, 0.1"/>
    </ramplr>
    <ramptb name="along" type="float">
      <input name="valuet" type="float" value="0.2"/>
      <input name="valueb" type="float" value="0.9"/>
    </ramptb>
    <output name="color" type="color3" nodename="across"/>
    <output name="roughness" type="float" nodename="along"/>
  </nodegraph>
  <standard_surface name="shader" type="surfaceshader">
    <input name="base" type="float" value="0.5"/>
    <input name="base_color" type="color3" nodegraph="NG" output="color"/>
    <input name="specular_roughness" type="float" nodegraph="NG" output="roughness"/>
    <input name="coat" type="float" value="0.5"/>
  </standard_surface>
  <surfacematerial name="Ramp" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="shader"/>
  </surfacematerial>
</materialx>
)";

constexpr const char* kProcedural = R"({
  "asset": {"version": "2.0"},
  "extensionsUsed": ["KHR_texture_procedurals", "EXT_texture_procedurals_mx_1_39"],
  "images": [{"uri": "one texel.png"}],
  "textures": [{"source": 0}],
  "extensions": {"KHR_texture_procedurals": {"procedurals": [{
    "name": "graph", "nodetype": "nodegraph", "type": "color3",
    "nodes": [
      {"name": "ramp", "nodetype": "ramplr", "type": "color3",
       "inputs": {"valuel": {"nodetype": "input", "type": "color3", "value": [0, 0.5, 1]},
                  "valuer": {"nodetype": "input", "type": "color3", "value": [1, 0.5, 0]}},
       "outputs": {"out": {"nodetype": "output", "type": "color3"}}}],
    "outputs": {"out": {"nodetype": "output", "type": "color3", "node": "ramp"}}
  }]}},
  "materials": [{"name": "Ramp", "extensions": {"KHR_materials_unlit": {}}, "pbrMetallicRoughness": {
    "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_procedurals": {"index": 0, "output": "out"}}}
  }}]
})";

/// In the middles of texels of images of 16 by 16.
constexpr const char* kPoints = R"([
  {"v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "uv0": [0.03125, 0.03125]},
  {"v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "uv0": [0.28125, 0.71875]},
  {"v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "uv0": [0.96875, 0.53125]}])";

/// The largest difference of two files' colours, of all that eval prints for the points.
double difference(const Workplace& place, const std::string& a, const std::string& b) {
  const Outcome of_a = place.run({"eval", a, "--points", "points.json", "--as", "gltf"});
  const Outcome of_b = place.run({"eval", b, "--points", "points.json", "--as", "gltf"});
  EXPECT_EQ(of_a.status, 0) << of_a.err;
  EXPECT_EQ(of_b.status, 0) << of_b.err;
  const Json first = Json::parse(of_a.out)["rgba"];
  const Json second = Json::parse(of_b.out)["rgba"];
  EXPECT_EQ(first.size(), 3U);
  EXPECT_EQ(second.size(), 3U);
  double most = 0;
  for (size_t i = 0; i < first.size(); ++i) {
    for (size_t c = 0; c < 4; ++c)
      most = std::max(most, std::abs(first[i][c].get<double>() - second[i][c].get<double>()));
  }
  EXPECT_NE(first[0], first[1]);
  return most;
}

TEST(Bake, ofADocumentIsItsMaterial) {
  const Workplace place;
  place.write("ramp.mtlx", kDocument);
  place.write("points.json", kPoints);
  const Outcome baked = place.run({"bake", "ramp.mtlx", "-o", "out/ramp.gltf", "--size", "16"});
  ASSERT_EQ(baked.status, 0) << baked.err;
  EXPECT_EQ(baked.out,
            "out/Ramp_baseColorTexture.png\nout/Ramp_metallicRoughnessTexture.png\n2 textures in "
            "out/ramp.gltf\n");
  const Json gltf = Json::parse(place.read("out/ramp.gltf"));
  EXPECT_EQ(gltf["images"].size(), 2U);
  EXPECT_EQ(gltf["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"], Json({0.5, 0.5, 0.5, 1.0}));
  EXPECT_LT(difference(place, "ramp.mtlx", "out/ramp.gltf"), 0.004);
  const std::string once = place.read("out/Ramp_baseColorTexture.png");
  EXPECT_EQ(place.run({"bake", "ramp.mtlx", "-o", "out/ramp.gltf", "--size", "16", "--jobs", "1"}).status, 0);
  EXPECT_EQ(place.read("out/Ramp_baseColorTexture.png"), once);
}

TEST(Bake, ofProceduralsKeepsThem) {
  const Workplace place;
  place.write("in/ramp.gltf", kProcedural);
  place.write("points.json", kPoints);
  const Outcome baked = place.run({"bake", "in/ramp.gltf", "-o", "ramp.gltf", "--size", "16", "-q"});
  ASSERT_EQ(baked.status, 0) << baked.err;
  EXPECT_EQ(baked.out, "");
  Json gltf = Json::parse(place.read("ramp.gltf"));
  EXPECT_EQ(gltf["images"][0]["uri"], "in/one texel.png");
  EXPECT_EQ(gltf["images"][1]["uri"], "Ramp_baseColorTexture.png");
  Json& info = gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  EXPECT_EQ(info["index"], 1);
  EXPECT_EQ(info["extensions"]["KHR_texture_procedurals"]["index"], 0);
  // Who does not know the extension sees the image. Half a step of eight bits is 0.0044 next to white.
  info.erase("extensions");
  place.write("plain.gltf", gltf.dump());
  EXPECT_LT(difference(place, "in/ramp.gltf", "plain.gltf"), 0.0045);
}

TEST(Bake, saysWhatIsWrong) {
  const Workplace place;
  place.write("plain.gltf", gltfOf({R"({"name": "plain"})"}));
  const Outcome none = place.run({"bake", "plain.gltf", "-o", "out.gltf"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("[nothing-to-bake]"), std::string::npos) << none.err;
  place.write("ramp.gltf", kProcedural);
  const Outcome over = place.run({"bake", "ramp.gltf", "-o", "ramp.gltf"});
  EXPECT_EQ(over.status, 1);
  EXPECT_NE(over.err.find("[output-clash]"), std::string::npos) << over.err;
  EXPECT_EQ(place.read("ramp.gltf"), kProcedural);
}

TEST(Bake, refusesWhatNoReaderFollows) {
  const Workplace place;
  Json gltf = Json::parse(kProcedural);
  gltf["images"][0]["uri"] = "/etc/passwd";
  place.write("absolute.gltf", gltf.dump());
  const Outcome refused = place.run({"bake", "absolute.gltf", "-o", "out/absolute.gltf", "--size", "4"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("absolute.gltf:/images/0/uri: error: \"/etc/passwd\" is no relative path "
                             "[image-missing]"),
            std::string::npos)
      << refused.err;
  EXPECT_FALSE(place.has("out/absolute.gltf"));
  // A whole address stays where it leads.
  gltf["images"][0]["uri"] = "https://example.com/a.png";
  place.write("far.gltf", gltf.dump());
  EXPECT_EQ(place.run({"bake", "far.gltf", "-o", "out/far.gltf", "--size", "4", "-q"}).status, 0);
  EXPECT_EQ(Json::parse(place.read("out/far.gltf"))["images"][0]["uri"], "https://example.com/a.png");
}

/// A part that samples a texture itself takes the image that is beside the nodes.
TEST(Bake, givesImagesToWhatSamplesThemItself) {
  const Workplace place;
  place.write("nodes/moss.node", R"(/// E.
/// source: ACME_moss
extension ACME_moss {
    texture mossTexture .rgb;
}
/// P.
/// source: ACME_moss
part moss of ACME_moss over coat {
surface:
    moss.light = moss_light(mossTexture.image, mossTexture.uv);
    out emission = moss.light;
}
/// N.
/// source: ACME_moss
node moss_light(sampler2D image, vec2 uv) -> vec3 in [0, inf] {
    return max(texture(image, uv).rgb, vec3(0));
}
)");
  Json gltf = Json::parse(kProcedural);
  Json info = gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  info.erase("index");
  gltf["materials"][0] = {{"name", "Moss"}, {"extensions", {{"ACME_moss", {{"mossTexture", info}}}}}};
  gltf["extensionsUsed"].push_back("ACME_moss");
  place.write("moss.gltf", gltf.dump());
  const Outcome before = place.run({"graph", "moss.gltf", "--nodes", "nodes"});
  EXPECT_EQ(before.status, 0) << before.err;
  EXPECT_NE(before.err.find("[no-image]"), std::string::npos) << before.err;
  EXPECT_NE(before.err.find("`lacquer bake`"), std::string::npos) << before.err;
  const Outcome baked =
      place.run({"bake", "moss.gltf", "-o", "out/moss.gltf", "--size", "4", "--nodes", "nodes"});
  EXPECT_EQ(baked.status, 0) << baked.err;
  EXPECT_NE(baked.out.find("\n1 texture in out/moss.gltf\n"), std::string::npos) << baked.out;
  const Outcome after = place.run({"graph", "out/moss.gltf", "--nodes", "nodes"});
  EXPECT_EQ(after.status, 0) << after.err;
  EXPECT_EQ(after.err.find("[no-image]"), std::string::npos) << after.err;
  EXPECT_NE(after.out.find("moss_texture"), std::string::npos) << after.out;
}

/// Graphs are built of a material's terms: the verb has no use for one, and says so.
TEST(Convert, takesNoGraph) {
  const Workplace place;
  place.write("paint.json", place.run({"graph", example("core.gltf"), "--material", "Plastic"}).out);
  const Outcome outcome = place.run({"convert", "paint.json", "-o", "out.mtlx"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("[graph-is-built]"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("asset"), std::string::npos) << outcome.err;
}

/// Numbers of a matrix stand in a graph, column by column, and in a document as MaterialX's rows.
TEST(Convert, matricesOfAGraph) {
  const Workplace place;
  place.write("moved.json", R"({"lacquer_graph": 1, "name": "moved", "template": "forward", "nodes": [
    {"id": "at", "node": "transformmatrix",
     "inputs": {"in": {"given": "uv0"}, "mat": [0.5, 0, 0, 0, 2, 0, 0.25, 0.125, 1]}},
    {"id": "seen", "node": "convert<vec3>", "inputs": {"in": {"node": "at", "swizzle": "y"}}}],
    "outputs": {"emission": {"node": "seen"}}})");
  place.write("points.json", R"([{"uv0": [0.5, 0.75]}])");
  for (const char* const engine : {"double", "float"}) {
    const Outcome outcome =
        place.run({"eval", "moved.json", "--points", "points.json", "--node", "at", "--engine", engine});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(Json::parse(outcome.out)["values"], Json::parse("[[0.5, 1.625]]")) << engine;
  }
  EXPECT_NE(place.run({"graph", "moved.json"}).out.find("[0.5, 0, 0, 0, 2, 0, 0.25, 0.125, 1]"),
            std::string::npos);
  const std::string document = place.run({"graph", "moved.json", "--format", "mtlx"}).out;
  EXPECT_NE(document.find(R"(type="matrix33" value="0.5, 0, 0, 0, 2, 0, 0.25, 0.125, 1")"), std::string::npos)
      << document;
  EXPECT_EQ(document.find("creatematrix"), std::string::npos) << document;
}

uint64_t wordAt(const std::string& bytes, size_t at, size_t count) {
  uint64_t word = 0;
  for (size_t i = 0; i < count; ++i) word |= uint64_t{static_cast<uint8_t>(bytes.at(at + i))} << (8 * i);
  return word;
}

/// Of a KTX2 file of 8 bits: the texel of a level.
std::vector<int> texelOf(const std::string& ktx2, size_t level, size_t index) {
  constexpr size_t kHeader = 80;
  const uint64_t place = wordAt(ktx2, kHeader + 24 * level, 8);
  std::vector<int> texel;
  for (size_t c = 0; c < 4; ++c) texel.push_back(static_cast<int>(wordAt(ktx2, place + 4 * index + c, 1)));
  return texel;
}

/// A graph of one's own: what depends on texture coordinates alone, and any node by the end of its name.
TEST(Bake, ofAGraph) {
  const Workplace place;
  place.write("ramp.mtlx", kDocument);
  place.write("ramp.json", place.run({"graph", "ramp.mtlx", "--as", "gltf"}).out);
  const Outcome all = place.run({"bake", "ramp.json", "-o", "out/ramp.gltf", "--size", "8"});
  ASSERT_EQ(all.status, 0) << all.err;
  EXPECT_NE(all.out.find("base_color.png\n"), std::string::npos) << all.out;
  const Json gltf = Json::parse(place.read("out/ramp.gltf"));
  EXPECT_EQ(gltf["materials"][0]["extensions"].count("KHR_materials_unlit"), 1U);
  EXPECT_EQ(gltf["materials"].size(), gltf["images"].size());
  for (const char* file : {"ramp.json", "ramp.mtlx"}) {
    const Outcome one = place.run({"bake", file, "--node", "NG.across", "-o", "one.ktx2", "--size", "4"});
    ASSERT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(one.out, "one.ktx2\n");
    // Linear: of the first texel the left colour has seven of eight parts.
    EXPECT_EQ(texelOf(place.read("one.ktx2"), 0, 0), (std::vector<int>{48, 57, 204, 255}));
  }
  const Outcome none = place.run({"bake", "ramp.json", "--node", "NG.acros", "-o", "one.png"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("[no-such-node]"), std::string::npos) << none.err;
  const Outcome linear =
      place.run({"bake", "ramp.json", "--node", "NG.across", "-o", "one.ktx2", "--bits", "16", "--srgb"});
  EXPECT_EQ(linear.status, 1);
  EXPECT_NE(linear.err.find("only an image of 8 bits is encoded by sRGB"), std::string::npos) << linear.err;
  const Outcome lit = place.run({"bake", "ramp.json", "--node", "base.direct", "-o", "one.png"});
  EXPECT_EQ(lit.status, 0) << lit.err;
  EXPECT_NE(lit.err.find("[depends-on-view]"), std::string::npos) << lit.err;
}

/// In a document and in the glTF file that is made of it.
TEST(Exchange, aMissingImageIsItsDefault) {
  const Workplace place;
  place.write("lost.mtlx", R"(<?xml version="1.0"?>
<materialx version="1.39">
  <nodegraph name="NG">
    <image name="i" type="color3"><input name="file" type="filename" value="lost.png"/>
      <input name="default" type="color3" value="0.2, 0.4, 0.6"/></image>
    <output name="out" type="color3" nodename="i"/>
  </nodegraph>
</materialx>)");
  place.write("points.json", "[{}]");
  const Outcome written = place.run({"graph", "lost.mtlx", "--format", "gltf"});
  ASSERT_EQ(written.status, 0) << written.err;
  place.write("lost.gltf", written.out);
  for (const char* file : {"lost.mtlx", "lost.gltf"}) {
    const Outcome seen = place.run({"eval", file, "--points", "points.json"});
    EXPECT_EQ(seen.status, 0) << seen.err;
    EXPECT_NE(seen.err.find("lost.png\" cannot be read"), std::string::npos) << seen.err;
    EXPECT_NE(seen.err.find("its default colour stands for it"), std::string::npos) << seen.err;
    EXPECT_EQ(nlohmann::json::parse(seen.out)["rgba"][0], nlohmann::json({0.2, 0.4, 0.6, 1})) << seen.out;
  }
}

TEST(Bake, saysWhatDependsOnTheViewInAFileToo) {
  const Workplace place;
  place.write("seen.mtlx", R"(<?xml version="1.0"?>
<materialx version="1.39">
  <nodegraph name="NG">
    <viewdirection name="v" type="vector3"/>
    <convert name="c" type="color3"><input name="in" type="vector3" nodename="v"/></convert>
    <output name="out" type="color3" nodename="c"/>
  </nodegraph>
  <gltf_pbr name="s" type="surfaceshader"><input name="base_color" type="color3" nodegraph="NG"/></gltf_pbr>
  <surfacematerial name="m" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial>
</materialx>)");
  const Outcome seen = place.run({"bake", "seen.mtlx", "-o", "seen.gltf", "--size", "4"});
  EXPECT_EQ(seen.status, 0) << seen.err;
  EXPECT_NE(seen.err.find("[depends-on-view]"), std::string::npos) << seen.err;
}

/// What a node asks of its neighbours are the places beside it: sixteen along a side of eight texels.
TEST(Bake, hasDerivatives) {
  const Workplace place;
  place.write("nodes/slope.node", R"(
/// How fast the texture coordinates change.
/// source: the tests
node slope(vec2 at = given uv0) -> vec3 in [0, 1] {
    return clamp(vec3(8 * fwidth(at), 0), 0, 1);
}
)");
  place.write("slope.json", R"({"lacquer_graph": 1, "name": "slope", "template": "forward",
    "nodes": [{"id": "slope", "node": "slope"}], "outputs": {"emission": {"node": "slope"}}})");
  const Outcome baked = place.run(
      {"bake", "slope.json", "--nodes", "nodes", "--node", "slope", "-o", "one.ktx2", "--size", "8"});
  ASSERT_EQ(baked.status, 0) << baked.err;
  for (const size_t texel : {0U, 9U, 63U})
    EXPECT_EQ(texelOf(place.read("one.ktx2"), 0, texel), (std::vector<int>{128, 128, 0, 255})) << texel;
}

/// Each level is the mean of the area below it, in linear light, whatever the size.
TEST(Bake, levelsAreMeans) {
  const Workplace place;
  place.write("ramp.mtlx", kDocument);
  for (const std::string size : {"8", "7"}) {
    const Outcome baked = place.run(
        {"bake", "ramp.mtlx", "--node", "NG.across", "-o", "one.ktx2", "--size", size, "--mips", "--srgb"});
    ASSERT_EQ(baked.status, 0) << baked.err;
    const std::string ktx2 = place.read("one.ktx2");
    EXPECT_EQ(wordAt(ktx2, 12, 4), 43U);  // VK_FORMAT_R8G8B8A8_SRGB
    EXPECT_EQ(wordAt(ktx2, 20, 4), std::stoul(size));
    const uint64_t levels = wordAt(ktx2, 40, 4);
    EXPECT_EQ(levels, size == "8" ? 4U : 3U);
    EXPECT_EQ(wordAt(ktx2, wordAt(ktx2, 48, 4) + 14, 1), 2U);  // the transfer function is sRGB's
    // The middle of the ramp: 0.45, 0.3, 0.5.
    EXPECT_EQ(texelOf(ktx2, levels - 1, 0), (std::vector<int>{179, 149, 188, 255}));
  }
  const Outcome png =
      place.run({"bake", "ramp.mtlx", "--node", "NG.across", "-o", "one.png", "--size", "4", "--mips"});
  EXPECT_EQ(png.out, "one.png\none_1.png\none_2.png\n");
}

TEST(Bake, otherFormsLieBesideGltf) {
  const Workplace place;
  place.write("ramp.mtlx", kDocument);
  const Outcome baked = place.run({"bake", "ramp.mtlx", "-o", "out/ramp.gltf", "--size", "8", "--also",
                                   "ktx2", "--also", "exr", "--bits", "16", "--mips"});
  if (baked.err.find("[no-openexr]") != std::string::npos) GTEST_SKIP() << "built without OpenEXR";
  ASSERT_EQ(baked.status, 0) << baked.err;
  EXPECT_TRUE(place.has("out/Ramp_baseColorTexture_3.png"));
  EXPECT_EQ(wordAt(place.read("out/Ramp_baseColorTexture.ktx2"), 12, 4), 97U);  // R16G16B16A16_SFLOAT
  const std::string exr = place.read("out/Ramp_baseColorTexture.exr");
  EXPECT_EQ(exr.substr(0, 4), "\x76\x2f\x31\x01");
  EXPECT_NE(exr.find("tiledesc"), std::string::npos);
  EXPECT_EQ(Json::parse(place.read("out/ramp.gltf"))["images"].size(), 2U);
  const Outcome wrong = place.run({"bake", "ramp.mtlx", "-o", "one.png", "--bits", "16"});
  EXPECT_NE(wrong.err.find("[unknown-format]"), std::string::npos) << wrong.err;
  const Outcome what = place.run({"bake", "ramp.mtlx", "-o", "one.jpg"});
  EXPECT_NE(what.err.find("[unknown-format]"), std::string::npos) << what.err;
}

bool has(const Messages& messages, std::string_view code) {
  return std::any_of(messages.begin(), messages.end(),
                     [&](const Message& m) { return std::string_view(m.code).starts_with(code); });
}

/// The largest difference of colours of each of a file's materials and of those of what it is written as.
/// Nothing where the file is wrong, or names images that are not there, or has what cannot be said.
std::optional<double> differenceOfAll(const fs::path& file, const fs::path& back) {
  Messages messages;
  Options options;
  options.as = "gltf";
  const Scene scene = Scene::load(file.string(), options, messages);
  if (!scene || hasError(messages)) return std::nullopt;
  const std::string text = toGltf(file.string(), {}, 2, {}, messages);
  if (hasError(messages) || has(messages, "image-") || has(messages, "not-said")) return std::nullopt;
  std::ofstream(back) << text;
  const Scene again = Scene::load(back.string(), {}, messages);
  EXPECT_TRUE(again) << file;
  if (!again) return std::nullopt;
  EXPECT_EQ(scene.materialCount(), again.materialCount()) << file;
  double most = 0;
  for (size_t i = 0; i < std::min(scene.materialCount(), again.materialCount()); ++i) {
    const auto before = evaluate(scene, i, kPoints, Engine::Float, {}, {}, messages);
    const auto after = evaluate(again, i, kPoints, Engine::Float, {}, {}, messages);
    if (!before) continue;
    EXPECT_TRUE(after) << file;
    for (size_t p = 0; after && p < before->rgba.size(); ++p) {
      for (size_t c = 0; c < 4; ++c) most = std::max(most, std::abs(before->rgba[p][c] - after->rgba[p][c]));
    }
  }
  return most;
}

/// The wood of an image, in all address modes.
constexpr const char* kImages = R"(<materialx version="1.39">
  <image name="clamped" type="color3">
    <input name="file" type="filename" value="ramp.png" colorspace="srgb_texture"/>
    <input name="texcoord" type="vector2" nodename="far"/>
    <input name="uaddressmode" type="string" value="clamp"/>
    <input name="vaddressmode" type="string" value="mirror"/>
    <input name="filtertype" type="string" value="closest"/>
  </image>
  <texcoord name="uv" type="vector2"/>
  <multiply name="far" type="vector2">
    <input name="in1" type="vector2" nodename="uv"/>
    <input name="in2" type="vector2" value="2.5, 3.5"/>
  </multiply>
  <gltf_pbr name="shader" type="surfaceshader">
    <input name="base_color" type="color3" nodename="clamped"/>
    <input name="roughness" type="float" value="0.25"/>
  </gltf_pbr>
  <surfacematerial name="Clamped" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="shader"/>
  </surfacematerial>
</materialx>
)";

TEST(ToGltf, givesTheSameColours) {
  const Workplace place;
  place.write("ramp.mtlx", kDocument);
  place.write("ramp.gltf", kProcedural);
  place.write("images.mtlx", kImages);
  ASSERT_EQ(place.run({"bake", "ramp.mtlx", "--node", "NG.across", "-o", "ramp.png", "--size", "8"}).status,
            0);
  for (const char* file : {"ramp.mtlx", "ramp.gltf", "images.mtlx"})
    EXPECT_EQ(differenceOfAll(place / file, place / "back.gltf"), 0) << file;
}

TEST(ToGltf, givesTheSameColoursOfTheCases) {
  const Workplace place;
  size_t files = 0;
  for (const char* folder : {"written", "cases", "procedurals"}) {
    for (const fs::path& file : findFiles(sourceFolder() / "tests/materialx" / folder, ".case")) {
      const Case of(file);
      const std::string name = file.stem().string() + (of.input().starts_with('{') ? ".gltf" : ".mtlx");
      place.write(name, of.input());
      const std::optional<double> most = differenceOfAll(place / name, place / "back.gltf");
      EXPECT_EQ(most.value_or(0), 0) << file;
      files += most ? 1 : 0;
    }
  }
  EXPECT_GT(files, 5U);
}

TEST(ToGltf, givesTheSameColoursOfTheExamples) {
  const char* set = std::getenv("LACQUER_ASSETS");
  const fs::path folder =
      (set != nullptr ? fs::path(set) : sourceFolder() / "../shared/assets") / "materialx";
  if (!fs::exists(folder)) GTEST_SKIP() << "NOT TESTED: no " << folder << "; set LACQUER_ASSETS";
  const Workplace place;
  size_t files = 0;
  for (const char* part : {"examples", "procedurals"}) {
    for (const char* ending : {".mtlx", ".gltf"}) {
      for (const fs::path& file : findFiles(folder / part, ending)) {
        const std::optional<double> most = differenceOfAll(file, place / "back.gltf");
        EXPECT_LT(most.value_or(0), 1e-6) << file;
        files += most ? 1 : 0;
      }
    }
  }
  EXPECT_GT(files, 30U);
}

/// The file has a fallback for who does not know the extension, and a graph its patterns.
TEST(ToGltf, hasAFallback) {
  const Workplace place;
  place.write("ramp.mtlx", kDocument);
  place.write("points.json", kPoints);
  Json back = Json::parse(place.run({"graph", "ramp.mtlx", "--format", "gltf", "--fallback", "16"}).out);
  EXPECT_EQ(back["extensionsUsed"].back(), "EXT_texture_procedurals_mx_1_39");
  for (const char* texture : {"baseColorTexture", "metallicRoughnessTexture"})
    back["materials"][0]["pbrMetallicRoughness"][texture].erase("extensions");
  place.write("plain.gltf", back.dump());
  EXPECT_LT(difference(place, "ramp.mtlx", "plain.gltf"), 0.004);
  place.write("ramp.json", place.run({"graph", "ramp.mtlx", "--as", "gltf"}).out);
  const Json patterns = Json::parse(place.run({"graph", "ramp.json", "--format", "gltf"}).out);
  EXPECT_EQ(patterns["materials"].size(), 2U);
  EXPECT_EQ(patterns["extensions"]["KHR_texture_procedurals"]["procedurals"][0]["nodes"][0]["nodetype"],
            "ramplr");
  const Outcome one = place.run({"graph", example("core.gltf"), "--format", "gltf", "--material", "Glass"});
  EXPECT_EQ(one.status, 1);
  EXPECT_NE(one.err.find("[whole-file]"), std::string::npos) << one.err;
}

/// A pattern in a group is not the group's output that is called like it.
TEST(ToGltf, ofAGraphHasPatternsOfGroups) {
  const Workplace place;
  place.write("noise.json", R"({"lacquer_graph": 1, "name": "noise", "template": "forward",
    "groups": {"g": {
      "nodes": [{"id": "n", "node": "noise2d<vec3>"},
                {"id": "size", "node": "absval<vec3>", "inputs": {"in": {"node": "n"}}}],
      "outputs": {"size": {"node": "n"}, "there": {"node": "size"}}}},
    "nodes": [{"id": "a", "group": "g"}, {"id": "a.size", "group": "g"}],
    "outputs": {"emission": {"node": "a", "output": "there"}}})");
  const Outcome written = place.run({"graph", "noise.json", "--format", "gltf"});
  ASSERT_EQ(written.status, 0) << written.err;
  const Json gltf = Json::parse(written.out);
  ASSERT_EQ(gltf["materials"].size(), 1U);
  EXPECT_EQ(gltf["materials"][0]["name"], "a/size");
  const Json& procedurals = gltf["extensions"]["KHR_texture_procedurals"]["procedurals"];
  ASSERT_EQ(procedurals.size(), 1U);
  ASSERT_EQ(procedurals[0]["nodes"].size(), 2U);
  EXPECT_EQ(procedurals[0]["nodes"][1]["nodetype"], "absval");
}

/// Two patterns share a node that MaterialX says otherwise: both are images alone, and it is said once.
TEST(ToGltf, saysOnceWhatPatternsShare) {
  const Workplace place;
  place.write("cells.json", R"({"lacquer_graph": 1, "name": "cells", "template": "forward",
    "nodes": [{"id": "cells", "node": "worleynoise2d<vec3>", "inputs": {"metric": "manhattan"}},
              {"id": "size", "node": "absval<vec3>", "inputs": {"in": {"node": "cells"}}}],
    "outputs": {"emission": {"node": "size"}, "alpha": {"node": "cells", "swizzle": "x"}}})");
  const Outcome written = place.run({"graph", "cells.json", "--format", "gltf"});
  ASSERT_EQ(written.status, 0) << written.err;
  const Json gltf = Json::parse(written.out);
  EXPECT_FALSE(gltf.contains("extensions")) << gltf["extensions"].dump();
  EXPECT_EQ(gltf["images"].size(), 2U);
  const size_t first = written.err.find("[not-said]");
  ASSERT_NE(first, std::string::npos) << written.err;
  EXPECT_EQ(written.err.find("[not-said]", first + 1), std::string::npos) << written.err;
}

/// MaterialX has letters and digits in names; what a material is called stands beside them.
TEST(Convert, keepsNamesOutsideOfAscii) {
  const Workplace place;
  place.write("names.gltf", R"({"asset": {"version": "2.0"}, "materials": [
    {"name": "床"}, {"name": "Café au lait"}, {"name": "Лак 2"}, {"name": "plain"}, {"name": "..."}]})");
  const Outcome converted = place.run({"convert", "names.gltf", "-o", "names.mtlx"});
  EXPECT_EQ(converted.status, 0) << converted.err;
  const std::string text = place.read("names.mtlx");
  EXPECT_NE(text.find("<surfacematerial name=\"u5e8a\" type=\"material\" uiname=\"床\">"), std::string::npos)
      << text;
  EXPECT_NE(text.find("name=\"Caf_u00e9_au_lait\""), std::string::npos) << text;
  EXPECT_NE(text.find("name=\"u041b_u0430_u043a_2\""), std::string::npos) << text;
  EXPECT_NE(text.find("<surfacematerial name=\"plain\" type=\"material\">"), std::string::npos) << text;
  for (const char* name : {"床", "Café au lait", "Лак 2", "plain", "..."}) {
    const Outcome graph = place.run({"graph", "names.mtlx", "--material", name});
    EXPECT_EQ(graph.status, 0) << graph.err;
    EXPECT_NE(graph.out.find("\"name\": \"" + std::string(name) + "\""), std::string::npos) << graph.out;
  }
}

/// A material's name makes the name of an image: none that the file has, whether it is opened or not.
TEST(Bake, replacesNoFileThatTheFileNames) {
  const Workplace place;
  for (const std::string list : {"images", "buffers"}) {
    Json gltf = Json::parse(kProcedural);
    gltf["materials"][0]["name"] = "own one";
    gltf[list].push_back({{"uri", "own%5Fone_baseColorTexture.png"}});
    if (list == "buffers") gltf[list][0]["byteLength"] = 4;
    place.write(list + ".gltf", gltf.dump());
    place.write("own_one_baseColorTexture.png", "mine");
    const Outcome over = place.run({"bake", list + ".gltf", "-o", "out.gltf", "--size", "4"});
    EXPECT_EQ(over.status, 1);
    EXPECT_NE(over.err.find("[output-clash]"), std::string::npos) << over.err;
    EXPECT_EQ(place.read("own_one_baseColorTexture.png"), "mine");
  }
}

TEST(Bake, saysWhatIsNoList) {
  const Workplace place;
  Json gltf = Json::parse(kProcedural);
  gltf["images"] = Json::object();
  place.write("wrong.gltf", gltf.dump());
  const Outcome wrong = place.run({"bake", "wrong.gltf", "-o", "out.gltf", "--size", "4"});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.err.find("wrong.gltf:/images: error"), std::string::npos) << wrong.err;
  EXPECT_EQ(wrong.err.find("[stopped]"), std::string::npos) << wrong.err;
}

TEST(Convert, namesImagesFromWhereItLies) {
  const Workplace place;
  place.write("look.gltf", R"({"asset": {"version": "2.0"}, "images": [{"uri": "tex/one%20texel%25.png"}],
    "textures": [{"source": 0}], "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]})");
  const Outcome beside = place.run({"convert", "look.gltf", "-o", "look.mtlx"});
  EXPECT_EQ(beside.status, 0) << beside.err;
  EXPECT_NE(place.read("look.mtlx").find("value=\"tex/one texel%.png\""), std::string::npos);
  const Outcome below = place.run({"convert", "look.gltf", "-o", "sub/look.mtlx"});
  EXPECT_EQ(below.status, 0) << below.err;
  EXPECT_NE(place.read("sub/look.mtlx").find("value=\"../tex/one texel%.png\""), std::string::npos);
  // And back: a document names files.
  const Outcome again = place.run({"graph", "look.mtlx"});
  EXPECT_NE(again.out.find("tex/one texel%25.png"), std::string::npos) << again.out;
}

TEST(Convert, saysThatThereIsNothing) {
  const Workplace place;
  place.write("none.gltf", R"({"asset": {"version": "2.0"}})");
  const Outcome none = place.run({"convert", "none.gltf", "-o", "none.mtlx"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("[no-such-material]"), std::string::npos) << none.err;
}

TEST(Convert, toEachSurface) {
  const Workplace place;
  place.write("ramp.mtlx", kDocument);
  const Outcome open = place.run({"convert", "ramp.mtlx", "-o", "open.mtlx", "-q"});
  EXPECT_EQ(open.status, 0) << open.err;
  EXPECT_EQ(open.out, "");
  EXPECT_NE(place.read("open.mtlx").find("<open_pbr_surface name=\"SR_Ramp\""), std::string::npos);
  // By glTF's properties what has no translation graph.
  const Outcome gltf = place.run({"convert", "open.mtlx", "-o", "gltf.mtlx", "--as", "gltf_pbr"});
  EXPECT_EQ(gltf.status, 0) << gltf.err;
  EXPECT_NE(place.read("gltf.mtlx").find("<gltf_pbr name=\"SR_Ramp\""), std::string::npos);
  EXPECT_NE(place.read("gltf.mtlx").find("<input name=\"clearcoat\" type=\"float\" value=\"0.5\"/>"),
            std::string::npos);
  EXPECT_NE(gltf.err.find("KHR_materials_coat/coatDarkeningFactor has no counterpart in gltf_pbr"),
            std::string::npos)
      << gltf.err;
  // What is of the kind already stays.
  const Outcome same =
      place.run({"convert", "open.mtlx", "-o", "same.mtlx", "--as", "open_pbr_surface", "-q"});
  EXPECT_EQ(same.err, "");
  EXPECT_EQ(place.read("same.mtlx"), place.read("open.mtlx"));
  const Outcome over = place.run({"convert", "ramp.mtlx", "-o", "ramp.mtlx"});
  EXPECT_EQ(over.status, 1);
  EXPECT_NE(over.err.find("[output-clash]"), std::string::npos) << over.err;
}

/// What an input of the document's only surface is: its value, or the category of the node that it takes.
std::string inputOf(const std::string& document, const std::string& name) {
  const size_t surface = document.find("_pbr");
  const size_t at = document.find("<input name=\"" + name + "\"", surface);
  if (surface == std::string::npos || at == std::string::npos) return "none";
  const std::string line = document.substr(at, document.find("/>", at) - at);
  const size_t value = line.find("value=\"");
  if (value != std::string::npos) return line.substr(value + 7, line.find('"', value + 7) - value - 7);
  const size_t node = line.find("nodename=\"");
  if (node == std::string::npos) return "graph";
  const std::string named = "name=\"" + line.substr(node + 10, line.find('"', node + 10) - node - 10) + "\"";
  const size_t element = document.rfind('<', document.find(named));
  return document.substr(element + 1, document.find(' ', element) - element - 1);
}

/// A standard_surface in its place, by MaterialX's translation graphs. Numbers by hand of their formulas.
TEST(Convert, byTranslationGraphs) {
  const Workplace place;
  place.write("all.mtlx", R"(<materialx version="1.39" fileprefix="tex/">
  <image name="rust" type="float"><input name="file" type="filename" value="rust.png"/></image>
  <standard_surface name="shader" type="surfaceshader">
    <input name="base" type="float" value="0.5"/>
    <input name="base_color" type="color3" value="0.8, 0.4, 0.2"/>
    <input name="specular_roughness" type="float" value="0.5"/>
    <input name="specular_anisotropy" type="float" value="0.36"/>
    <input name="specular_rotation" type="float" value="0.25"/>
    <input name="sheen" type="float" value="0.5"/>
    <input name="sheen_roughness" type="float" value="0.25"/>
    <input name="coat" type="float" nodename="rust"/>
    <input name="coat_color" type="color3" value="1, 0.5, 0"/>
    <input name="coat_affect_color" type="float" value="0.7"/>
    <input name="thin_film_thickness" type="float" value="400"/>
    <input name="subsurface_radius" type="color3" value="3, 2, 1"/>
  </standard_surface>
  <surfacematerial name="All" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="shader"/>
  </surfacematerial></materialx>)");
  const Outcome open =
      place.run({"convert", "all.mtlx", "-o", "out/open.mtlx", "--as", "open_pbr_surface", "-q"});
  EXPECT_EQ(open.status, 0) << open.err;
  const std::string document = place.read("out/open.mtlx");
  EXPECT_EQ(inputOf(document, "base_weight"), "0.5");
  EXPECT_EQ(inputOf(document, "base_color"), "multiply");
  EXPECT_EQ(inputOf(document, "specular_roughness"), "0.5");
  EXPECT_EQ(inputOf(document, "fuzz_roughness").substr(0, 6), "0.5743");  // 0.25 ^ 0.4
  EXPECT_EQ(inputOf(document, "coat_weight"), "image");
  EXPECT_EQ(inputOf(document, "coat_darkening"), "0");
  EXPECT_EQ(inputOf(document, "thin_film_thickness"), "0.4");
  EXPECT_EQ(inputOf(document, "subsurface_radius_scale"), "none");
  EXPECT_NE(document.find("value=\"../tex/rust.png\""), std::string::npos) << document;
  EXPECT_EQ(document.find("fileprefix"), std::string::npos);
  EXPECT_NE(open.err.find("coat_affect_color has no counterpart in open_pbr_surface: 0.7 is lost"),
            std::string::npos)
      << open.err;
  EXPECT_NE(open.err.find("specular_rotation has no counterpart"), std::string::npos) << open.err;
  EXPECT_EQ(open.err.find("subsurface_radius"), std::string::npos) << open.err;

  const Outcome gltf = place.run({"convert", "all.mtlx", "-o", "gltf.mtlx", "--as", "gltf_pbr", "-q"});
  EXPECT_EQ(gltf.status, 0) << gltf.err;
  const std::string as_gltf = place.read("gltf.mtlx");
  // alpha is 0.25; 0.25 / 0.8 across and 0.25 * 0.8 along.
  EXPECT_EQ(inputOf(as_gltf, "roughness").substr(0, 7), "0.44721");
  EXPECT_NEAR(std::stod(inputOf(as_gltf, "anisotropy_strength")), 0.375, 1e-12);
  EXPECT_EQ(inputOf(as_gltf, "anisotropy_rotation"), "-1.57075");
  EXPECT_EQ(inputOf(as_gltf, "sheen_roughness"), "0.5");
  EXPECT_EQ(inputOf(as_gltf, "clearcoat"), "dotproduct");
  EXPECT_EQ(inputOf(as_gltf, "iridescence_thickness"), "400");
  EXPECT_EQ(inputOf(as_gltf, "metallic"), "0");
}

/// Variants change what the surface has become, by the same formulas.
TEST(Convert, translatesVariants) {
  const Workplace place;
  place.write("all.mtlx", R"(<materialx version="1.39">
  <image name="rust" type="float"><input name="file" type="filename" value="rust.png"/></image>
  <standard_surface name="shader" type="surfaceshader">
    <input name="base" type="float" value="0.5"/>
    <input name="base_color" type="color3" value="0.8, 0.8, 0.8"/>
    <input name="sheen" type="float" nodename="rust"/>
    <input name="coat" type="float" value="0"/>
  </standard_surface>
  <surfacematerial name="M" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="shader"/>
  </surfacematerial>
  <variantset name="any">
    <variant name="red"><input name="base_color" type="color3" value="0.8, 0, 0"/></variant>
    <variant name="coated">
      <input name="coat" type="float" value="1"/>
      <input name="coat_roughness" type="float" value="0.25"/>
    </variant>
    <variant name="dusty"><input name="sheen_color" type="color3" value="0.5, 0.5, 0.5"/>
      <input name="base" type="float" value="1"/></variant>
  </variantset>
  <variantset name="named" node="standard_surface" nodedef="ND_standard_surface_surfaceshader">
    <variant name="glow">
      <input name="emission" type="float" value="2"/>
      <input name="emission_color" type="color3" value="1, 0.5, 0"/>
      <token name="kept" type="string" value="a"/>
    </variant>
  </variantset></materialx>)");
  const Outcome gltf = place.run({"convert", "all.mtlx", "-o", "gltf.mtlx", "--as", "gltf_pbr", "-q"});
  EXPECT_EQ(gltf.status, 0) << gltf.err;
  const std::string document = place.read("gltf.mtlx");
  const auto variant = [&](const std::string& name) {
    const size_t at = document.find("<variant name=\"" + name);
    return "_pbr" + document.substr(at, document.find("</variant>", at) - at);
  };
  EXPECT_EQ(inputOf(variant("red"), "base_color"), "0.4, 0, 0");
  EXPECT_EQ(inputOf(variant("coated"), "clearcoat"), "1");
  EXPECT_EQ(inputOf(variant("coated"), "clearcoat_roughness"), "0.25");
  EXPECT_EQ(inputOf(variant("dusty"), "base_color"), "0.8, 0.8, 0.8");
  EXPECT_NE(gltf.err.find("all.mtlx:18:6: warning: the variant \"dusty\" has no value for sheen_color of "
                          "gltf_pbr [not-said]"),
            std::string::npos)
      << gltf.err;
  EXPECT_EQ(inputOf(variant("glow"), "emissive_strength"), "2");
  EXPECT_EQ(inputOf(variant("glow"), "emissive"), "1, 0.5, 0");
  EXPECT_NE(variant("glow").find("kept"), std::string::npos) << document;
  EXPECT_NE(document.find("node=\"gltf_pbr\" nodedef=\"ND_gltf_pbr_surfaceshader\""), std::string::npos)
      << document;
  for (const char* name : {"M/any/red", "M/any/coated", "M/named/glow"}) {
    const Outcome made = place.run({"gen", "gltf.mtlx", "-o", "out", "--material", name});
    EXPECT_EQ(made.status, 0) << made.err;
  }
}

TEST(Convert, measuresAndShows) {
  const Workplace place;
  place.write("ramp.mtlx", kDocument);
  const Outcome measured = place.run({"convert", "ramp.mtlx", "-o", "open.mtlx", "--as", "open_pbr_surface",
                                      "--picture", "both.png", "--size", "32"});
  EXPECT_EQ(measured.status, 0) << measured.err;
  EXPECT_NE(measured.out.find("rms  material\n"), std::string::npos) << measured.out;
  EXPECT_NE(measured.out.find("  Ramp\n"), std::string::npos) << measured.out;
  EXPECT_EQ(place.read("both.png").substr(1, 3), "PNG");
  // A surface that becomes itself loses nothing.
  const Outcome same = place.run({"convert", "open.mtlx", "-o", "same.mtlx", "--size", "32"});
  EXPECT_NE(same.out.find("0.000e+00    0.000e+00    0.000e+00  Ramp"), std::string::npos) << same.out;
  const Outcome over = place.run({"convert", "ramp.mtlx", "-o", "open.mtlx", "--picture", "ramp.mtlx"});
  EXPECT_NE(over.err.find("[output-clash]"), std::string::npos) << over.err;
  EXPECT_EQ(place.read("ramp.mtlx"), kDocument);
}

}  // namespace
}  // namespace lacquer::test::exchange_test
