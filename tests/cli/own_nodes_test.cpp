// Node files of one's own: which of several errors is said, and how textures and parameters of theirs are
// named.
#include <gtest/gtest.h>

#include <algorithm>

#include "command.h"

namespace lacquer::test::own_nodes_test {
namespace {

using Json = nlohmann::json;

constexpr const char* kTemplate = R"(/// A G-buffer.
template ground extends mesh {
    environment samplerCube surroundings;
    port vec3 albedo in [0, 1] = vec3(0.5);
    port int kind in [0, 15] = DEFAULT;
    port float height in [-10, 10] = 0;
    output color vec3 out_albedo = albedo * textureLod(surroundings, normal, 0).rgb;
    output color int out_kind = kind;
    output displacement vec3 object_position = object_position + vec3(0, height, 0);
}

/// What a material is there.
/// source: ACME
part ground over base {
surface:
    ground.color = base.color;
    out albedo = ground.color.rgb;
}
)";

std::string ground(const std::string& kind) {
  std::string text = kTemplate;
  return text.replace(text.find("DEFAULT"), 7, kind);
}

/// A stain of a vendor's.
std::string stain(const std::string& vendor, const std::string& over) {
  std::string text = R"(/// A stain.
/// source: V_stain
extension V_stain {
    status vendor;
    float stainFactor in [0, 1] = 0;
    texture stainTexture .rgb;
}
/// Stains.
/// source: V_stain, "Colour"
part stain of V_stain over OVER unless stainFactor == 0 {
surface:
    stain.color = stained(base.color, stainTexture, stainFactor);
    replace base.color with stain.color;
}
/// Colour.
/// source: V_stain, "Colour"
node stained(vec4 base in [0, 1], vec3 texel in [0, 1] = vec3(1), float factor in [0, 1] = 1) -> vec4 in [0, 1] {
    return vec4(mix(base.rgb, texel, factor), base.a);
}
)";
  for (size_t at = text.find("V_stain"); at != std::string::npos; at = text.find("V_stain"))
    text.replace(at, 1, vendor);
  return text.replace(text.find("OVER"), 4, over);
}

constexpr const char* kPoint = R"([{"n": [0, 0, 1], "v": [0, 0, 1], "l": [0, 0, 1]}])";

size_t countOf(const std::string& text, const std::string& what) {
  size_t count = 0;
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST(OwnNodes, ATemplateThatIsWrongSaysSoItself) {
  const Workplace place;
  place.write("file.gltf", gltfOf({R"({"name": "A"})", R"({"name": "B"})"}));
  const std::vector<std::string> gen = {"gen",    "file.gltf",     "--nodes", "mine", "--template",
                                        "ground", "--no-validate", "-o",      "out"};
  // A default out of its port's range.
  place.write("mine/ground.node", ground("33"));
  Outcome outcome = place.run(gen);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(countOf(outcome.err, "mine/ground.node:5:32: error: the default 33 lies outside [0, 15]"), 1U)
      << outcome.all();
  EXPECT_EQ(outcome.err.find("no template has a port"), std::string::npos) << outcome.all();
  outcome = place.run({"check", "mine"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("[default-out-of-range]"), std::string::npos) << outcome.all();
  // One that does not parse: what follows from it is said behind it.
  place.write("mine/ground.node", ground("3 +"));
  outcome = place.run(gen);
  EXPECT_EQ(outcome.status, 1);
  const size_t cause = outcome.err.find("mine/ground.node:5:");
  EXPECT_NE(cause, std::string::npos) << outcome.all();
  EXPECT_LT(cause, outcome.err.find("no template has a port 'albedo'")) << outcome.all();
  place.write("mine/ground.node", ground("3"));
  EXPECT_EQ(place.run(gen).status, 0);
}

/// What is wrong in one file hides nothing in another.
TEST(OwnNodes, CheckSaysEverythingAtOnce) {
  const Workplace place;
  std::string wrong_default = stain("ACME", "base");
  wrong_default.replace(wrong_default.find("[0, 1] = 0"), 10, "[0, 1] = 2");
  place.write("mine/acme.node", wrong_default);
  std::string wrong_line = stain("BOLT", "base");
  wrong_line.replace(wrong_line.find("with stain.color"), 16, "with stain.colour");
  place.write("mine/bolt.node", wrong_line);
  std::string wrong_port = ground("33");
  wrong_port.replace(wrong_port.find("out albedo"), 10, "out albdo");
  place.write("mine/ground.node", wrong_port);
  // A node that is wrong hides nothing in the lines of the part that calls it.
  std::string wrong_node = stain("CRAG", "base");
  wrong_node.replace(wrong_node.find("mix(base.rgb"), 12, "mixx(base.rgb");
  wrong_node.replace(wrong_node.find("replace base.color"), 18, "replace base.colr ");
  place.write("mine/crag.node", wrong_node);
  const Outcome outcome = place.run({"check", "mine"});
  EXPECT_EQ(outcome.status, 1);
  for (const char* said :
       {"mine/acme.node:5:35: error: the default 2 lies outside [0, 1]",
        "mine/ground.node:5:32: error: the default 33 lies outside [0, 15]",
        "no line, property or given 'stain.colour'", "no line, property or given 'base.colr'",
        "no function 'mixx'", "no template has a port 'albdo'"})
    EXPECT_NE(outcome.err.find(said), std::string::npos) << said << "\n" << outcome.all();
}

TEST(OwnNodes, AnOverloadedNameListsItsForms) {
  const Workplace place;
  const Outcome text = place.run({"nodes", "noise2d"});
  EXPECT_EQ(text.status, 0) << text.all();
  for (const char* form : {"noise2d<float>\n", "noise2d<vec3>\n"})
    EXPECT_NE(text.out.find(form), std::string::npos) << text.out;
  const Outcome json = place.run({"nodes", "noise2d", "--json"});
  EXPECT_EQ(json.status, 0) << json.all();
  const Json forms = Json::parse(json.out);
  EXPECT_GE(forms.size(), 4U);
  for (const Json& form : forms) EXPECT_EQ(form["family"], "noise2d");
}

TEST(OwnNodes, LinesAreListedWithTheirTypes) {
  const Workplace place;
  place.write("mine/acme.node", stain("ACME", "base"));
  const Json all = Json::parse(place.run({"nodes", "--json", "--nodes", "mine"}).out);
  const auto line = [&](const std::string& name) {
    const auto it = std::find_if(all["lines"].begin(), all["lines"].end(),
                                 [&](const Json& one) { return one["name"] == name; });
    return it == all["lines"].end() ? Json::object() : *it;
  };
  EXPECT_EQ(line("base.color").value("type", ""), "vec4");
  EXPECT_EQ(line("base.color").value("part", ""), "base");
  EXPECT_EQ(line("stain.color").value("type", ""), "vec4");
  EXPECT_EQ(line("stain.color").value("meaning", ""), "Colour.");
  EXPECT_EQ(line("below.direct").value("type", ""), "vec3");
  EXPECT_TRUE(line("base.light").value("light", false));
  EXPECT_FALSE(line("base.cosines").value("outputs", Json::array()).empty());
  // What `out` and `replace` are given has no name that a text can say.
  EXPECT_FALSE(line("coat.direct").contains("part"));
}

/// A property of two vendors is named with its extension.
TEST(OwnNodes, TexelsOfTwoVendors) {
  const Workplace place;
  place.write("mine/acme.node", stain("ACME", "base"));
  place.write("mine/bolt.node", stain("BOLT", "base, ACME_stain.stain"));
  place.write("points.json", kPoint);
  place.write("file.gltf", R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ACME_stain", "BOLT_stain"],
    "textures": [{"source": 0}, {"source": 1}], "images": [{"uri": "a.png"}, {"uri": "b.png"}],
    "materials": [{"name": "Both", "extensions": {
      "ACME_stain": {"stainFactor": 1, "stainTexture": {"index": 0}},
      "BOLT_stain": {"stainFactor": 0.5, "stainTexture": {"index": 1}}}}]})");
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"eval", "file.gltf", "--nodes", "mine", "--points", "points.json"};
    words.insert(words.end(), more.begin(), more.end());
    return place.run(words);
  };
  const Outcome both = run({"--texel", "stainTexture=1,0,0,1"});
  EXPECT_EQ(both.status, 1);
  EXPECT_NE(both.err.find("error: --texel: 2 textures are called 'stainTexture' [ambiguous-texture]"),
            std::string::npos)
      << both.all();
  EXPECT_NE(both.err.find("name one: ACME_stain.stainTexture, BOLT_stain.stainTexture"), std::string::npos)
      << both.all();
  const Outcome named = run({"--texel", "ACME_stain.stainTexture=1,0,0,1", "--texel",
                             "/materials/0/extensions/BOLT_stain/stainTexture=0,1,0,1"});
  EXPECT_EQ(named.status, 0) << named.all();
  const Outcome slots =
      run({"--texel", "acme_stain_stain_texture=1,0,0,1", "--texel", "bolt_stain_stain_texture=0,1,0,1"});
  EXPECT_EQ(slots.status, 0) << slots.all();
  EXPECT_EQ(slots.out, named.out);
}

/// A cube map of the template's own may be a constant, of which points' surroundings are none.
TEST(OwnNodes, ATemplatesOwnCubeIsGivenByItsName) {
  const Workplace place;
  place.write("mine/ground.node", ground("3"));
  place.write("points.json", kPoint);
  place.write("file.gltf", gltfOf({R"({"name": "A"})"}));
  const Outcome outcome = place.run({"eval", "file.gltf", "--nodes", "mine", "--template", "ground",
                                     "--points", "points.json", "--texel", "surroundings=0.25,0.5,1,1"});
  ASSERT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_EQ(Json::parse(outcome.out)["rgba"][0], Json::parse("[0.25, 0.5, 1, 1]")) << outcome.out;
}

TEST(OwnNodes, SetTakesWordsAndOneNumberForAll) {
  const Workplace place;
  place.write("points.json", kPoint);
  place.write("graph.json", R"({"lacquer_graph": 1, "name": "g", "template": "forward",
    "parameters": {"tint": {"type": "vec3", "value": [0.1, 0.2, 0.3]}, "shiny": {"type": "bool", "value": false}},
    "textures": {}, "nodes": [
      {"id": "none", "node": "multiply", "inputs": {"in1": {"parameter": "tint"}, "in2": 0}},
      {"id": "one", "node": "ifequal", "inputs": {"value1": {"parameter": "shiny"}, "value2": true,
        "in1": {"parameter": "tint"}, "in2": {"node": "none"}}}],
    "outputs": {"direct": [0, 0, 0], "emission": {"node": "one"}}})");
  const Outcome outcome = place.run(
      {"eval", "graph.json", "--points", "points.json", "--set", "tint=0.5", "--set", "shiny=true"});
  ASSERT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_EQ(Json::parse(outcome.out)["rgba"][0], Json::parse("[0.5, 0.5, 0.5, 1]")) << outcome.out;
  const Outcome wrong = place.run({"eval", "graph.json", "--points", "points.json", "--set", "tnt=0.5"});
  EXPECT_NE(wrong.err.find("did you mean 'tint'?"), std::string::npos) << wrong.all();
}

/// The graph's own mistake is named, and not the template's line alone.
TEST(OwnNodes, ADisplacementThatVerticesCannotMakeNamesTheNode) {
  const Workplace place;
  place.write("mine/ground.node", ground("3"));
  place.write("graph.json", R"({"lacquer_graph": 1, "name": "g", "template": "ground", "parameters": {},
    "textures": {}, "nodes": [
      {"id": "side", "node": "ifequal", "inputs": {"value1": {"given": "front_facing"}, "value2": true,
        "in1": 1.5, "in2": 0.5}}],
    "outputs": {"height": {"node": "side"}}})");
  const Outcome outcome =
      place.run({"gen", "--graph", "graph.json", "--nodes", "mine", "--no-validate", "-o", "out"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(
      outcome.err.find("is not known to the vertices: the output /outputs/height takes the node 'side'"),
      std::string::npos)
      << outcome.all();
}

/// A node that samples a texture itself reads what the extension declares of it.
TEST(OwnNodes, CheckWarnsOfChannelsThatAreNotDeclared) {
  const Workplace place;
  std::string text = stain("ACME", "base");
  text.replace(text.find(".rgb;"), 5, ".rg;");
  text.replace(text.find("stainTexture, stainFactor"), 12, "stainTexture.image, stainTexture.uv");
  text.replace(text.find("vec3 texel in [0, 1] = vec3(1)"), 30, "sampler2D image, vec2 uv");
  const size_t at = text.find("texel, factor");
  const auto reading = [&](const std::string& swizzle) {
    std::string made = text;
    return made.replace(at, 5, "vec3(texture(image, uv)." + swizzle + ")");
  };
  place.write("mine/acme.node", reading("rgb"));
  const Outcome outcome = place.run({"check", "mine"});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_NE(outcome.err.find("warning: 'stainTexture' has the channels rg, and 'stained' reads b of it"),
            std::string::npos)
      << outcome.all();
  place.write("mine/acme.node", reading("rgr"));
  EXPECT_EQ(place.run({"check", "mine"}).err, "");
}

TEST(OwnNodes, CheckWarnsOfWhatAPropertyNeverIs) {
  const Workplace place;
  std::string text = stain("ACME", "base");
  text.replace(text.find("stainFactor == 0"), 16, "stainFactor == 2");
  place.write("mine/acme.node", text);
  const Outcome outcome = place.run({"check", "mine"});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_NE(outcome.err.find(
                "warning: 'stainFactor' is compared with 2, which is not in its range [0, 1] [out-of-range]"),
            std::string::npos)
      << outcome.all();
}

constexpr const char* kDusty = R"(<materialx version="1.39">
  <gltf_pbr name="s" type="surfaceshader">
    <input name="roughness" type="float" nodename="dusty"/>
  </gltf_pbr>
  <dust name="dusty" type="float"/>
  <surfacematerial name="M" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="s"/>
  </surfacematerial>
</materialx>)";
constexpr const char* kDust = R"(<materialx version="1.39">
  <nodedef name="ND_dust" node="dust">
    <input name="amount" type="float" value="0.25"/>
    <output name="out" type="float"/>
  </nodedef>
  <nodegraph name="NG_dust" nodedef="ND_dust">
    <noise2d name="n" type="float"/>
    <add name="sum" type="float">
      <input name="in1" type="float" nodename="n"/>
      <input name="in2" type="float" interfacename="amount"/>
    </add>
    <output name="out" type="float" nodename="sum"/>
  </nodegraph>
</materialx>)";

/// Definitions of a studio, from a folder below the one that is named.
TEST(OwnDefinitions, AreFound) {
  const Workplace place;
  place.write("dusty.mtlx", kDusty);
  place.write("studio/patterns/dust.mtlx", kDust);
  EXPECT_NE(place.run({"graph", "dusty.mtlx"}).err.find("there is no node \"dust\" [unknown-node]"),
            std::string::npos);
  Outcome outcome = place.run({"graph", "dusty.mtlx", "--materialx", "studio"});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_NE(outcome.out.find("NG_dust_amount"), std::string::npos);
  const std::vector<std::string> gen = {
      "gen",   "dusty.mtlx",    "--materialx", "studio",    "-o",       "out", "--cache",
      "cache", "--no-validate", "--depfile",   "out/gen.d", "--target", "glsl"};
  outcome = place.run(gen);
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_NE(place.read("out/gen.d").find("studio/patterns/dust.mtlx"), std::string::npos);
  const auto shader = [&] { return place.manifest("out")["shaders"].begin().key(); };
  const std::string before = shader();
  // A definition that has changed is read anew, whatever the cache has.
  std::string changed = kDust;
  changed.replace(changed.find("<add"), 4, "<multiply").replace(changed.find("</add"), 5, "</multiply");
  place.write("studio/patterns/dust.mtlx", changed);
  EXPECT_EQ(place.run(gen).status, 0);
  EXPECT_NE(shader(), before);
  // A picture replaces no definition.
  outcome = place.run({"preview", "dusty.mtlx", "--materialx", "studio", "-o", "studio/patterns/dust.mtlx"});
  EXPECT_NE(outcome.status, 0);
  EXPECT_EQ(place.read("studio/patterns/dust.mtlx"), changed);
  EXPECT_NE(place.run({"gen", "dusty.mtlx", "--materialx", "nowhere", "-o", "out"})
                .err.find("the folder of MaterialX definitions cannot be read"),
            std::string::npos);
  EXPECT_NE(place.run({"gen", "dusty.mtlx", "--materialx", "studio/patterns/dust.mtlx", "-o", "out"})
                .err.find("it is a file where a folder of MaterialX definitions is asked for"),
            std::string::npos);
}

TEST(OwnDefinitions, AreChecked) {
  const Workplace place;
  place.write("studio/dust.mtlx", kDust);
  Outcome outcome = place.run({"check", "--materialx", "studio"});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_EQ(outcome.out, "studio: good, no warnings\n");
  std::string wrong = kDust;
  place.write("studio/dust.mtlx", wrong.replace(wrong.find("noise2d"), 7, "noise2b"));
  outcome = place.run({"check", "--materialx", "studio"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("studio/dust.mtlx:7:6: error: there is no node \"noise2b\" [unknown-node]"),
            std::string::npos)
      << outcome.all();
  EXPECT_EQ(place.run({"check"}).status, 2);
  place.write("empty/within/some.node", "");
  for (const char* const option : {"--", "--materialx"}) {
    outcome = place.run({"check", option, "empty"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("[nothing-to-check]"), std::string::npos) << outcome.err;
  }
}

/// What instances have of an application's own is dropped, and said once.
TEST(OwnNodes, AttributesOfInstancesAreNamed) {
  const Workplace place;
  place.write("file.gltf", R"({"asset": {"version": "2.0"}, "extensionsUsed": ["EXT_mesh_gpu_instancing"],
    "materials": [{"name": "A"}],
    "accessors": [{"componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "nodes": [
      {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0, "_TINT": 0}}}},
      {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0, "_TINT": 0}}}}]})");
  const Outcome outcome = place.run({"gen", "file.gltf", "--no-validate", "-o", "out"});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_EQ(countOf(place.read("out/manifest.json"), "no shader reads _TINT of instances"), 1U)
      << outcome.all();
}

}  // namespace
}  // namespace lacquer::test::own_nodes_test
