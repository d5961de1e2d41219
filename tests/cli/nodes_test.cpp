// The node library for tools, and folders of node files that are checked where they are to stand.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "command.h"
#include "support/cases.h"

namespace lacquer::test::nodes_test {
namespace {

using Json = nlohmann::json;

/// A layer with everything that a declaration can say to a tool.
constexpr const char* kMoss = R"(/// Moss grows where it is dark.
/// source: ACME_materials_moss
extension ACME_materials_moss {
    status vendor;
    excludes KHR_materials_unlit;
    float mossFactor in [0, 1] = 0;     // how much of the surface is moss
    texture mossTexture .r;
    vec3  mossColorFactor in [0, 1] = vec3(0.1, 0.3, 0.05);
}

/// It lies over the coat.
/// source: ACME_materials_moss, "Layering"
part moss of ACME_materials_moss over coat unless mossFactor == 0 {
surface:
    moss.cover = moss_cover(mossFactor, mossTexture);
direct:
    moss.direct = moss_direct(below.direct, mossColorFactor, moss.cover, base.cosines.NdotL);
    out direct = moss.direct;
}

/// How much of a point is moss.
/// source: ACME_materials_moss, "Cover"
node moss_cover(float factor in [0, 1], float texel in [0, 1] = 1) -> float in [0, 1] {
    return factor * texel;
}

/// Moss under one light, over what lies below.
/// source: ACME_materials_moss, "Layering"
node moss_direct(
    vec3  below in [0, inf],
    vec3  color in [0, 1],
    float cover in [0, 1],
    float NdotL in [0, COS_MAX]
) -> vec3 in [0, inf] {
    return mix(below, color * (NdotL / PI), cover);
}
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

const Json* named(const Json& list, const std::string& name) {
  const auto it =
      std::find_if(list.begin(), list.end(), [&](const Json& one) { return one["name"] == name; });
  return it == list.end() ? nullptr : &*it;
}

TEST(NodesAsJson, FollowTheirSchema) {
  const Workplace place;
  place.write("mine/moss.node", kMoss);
  const auto built_in = place.run({"nodes", "--json"});
  ASSERT_EQ(built_in.status, 0) << built_in.err;
  place.write("nodes.json", built_in.out);
  const auto own = place.run({"nodes", "--json", "--nodes", "mine"});
  ASSERT_EQ(own.status, 0) << own.err;
  place.write("own.json", own.out);
  const auto errors = schemaErrors({place / "nodes.json", place / "own.json"}, "nodes");
  if (!errors) GTEST_SKIP() << "there is no python3-jsonschema";
  EXPECT_EQ(*errors, "");
  // The schema is none that everything follows.
  Json wrong = Json::parse(own.out);
  wrong["nodes"][0].erase("inputs");
  wrong["templates"][0]["ports"][0]["type"] = "colour";
  place.write("wrong.json", wrong.dump());
  const std::string said = schemaErrors({place / "wrong.json"}, "nodes").value_or("");
  EXPECT_NE(said.find("'inputs' is a required property"), std::string::npos) << said;
  EXPECT_NE(said.find("'colour' is not one of"), std::string::npos) << said;
}

TEST(NodesAsJson, TellAToolEverything) {
  const Workplace place;
  place.write("mine/moss.node", kMoss);
  const Json all = Json::parse(place.run({"nodes", "--json", "--nodes", "mine"}).out);
  EXPECT_EQ(all["schema"], 1);
  const Json* forward = named(all["templates"], "forward");
  ASSERT_NE(forward, nullptr);
  const Json* direct = named((*forward)["ports"], "direct");
  ASSERT_NE(direct, nullptr);
  EXPECT_EQ((*direct)["type"], "vec3");
  EXPECT_EQ((*direct)["per_light"], true);
  const Json* alpha = named((*forward)["ports"], "alpha");
  ASSERT_NE(alpha, nullptr);
  EXPECT_EQ((*alpha)["required"], false);
  EXPECT_FALSE(alpha->contains("per_light"));
  const Json* light = named((*forward)["gives"], "light_sample.L");
  ASSERT_NE(light, nullptr);
  EXPECT_EQ((*light)["type"], "vec3");
  EXPECT_EQ((*light)["per_light"], true);
  ASSERT_NE(named((*forward)["gives"], "uv0"), nullptr);
  const Json* frame = named((*forward)["blocks"], "frame");
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ((*frame)["role"], "frame");
  EXPECT_FALSE((*frame)["fields"].empty());
  ASSERT_NE(named((*forward)["attributes"], "NORMAL"), nullptr);
  ASSERT_NE(named((*forward)["lights"], "spot"), nullptr);
  EXPECT_FALSE((*forward)["outputs"].empty());
  const Json* moss = named(all["extensions"], "ACME_materials_moss");
  ASSERT_NE(moss, nullptr);
  EXPECT_EQ((*moss)["file"], "mine/moss.node");
  EXPECT_EQ((*moss)["line"], 3);
  ASSERT_NE(named(all["parts"], "moss"), nullptr);
  EXPECT_EQ((*named(all["parts"], "moss"))["over"], Json::parse(R"(["coat"])"));
  const Json* exp2 = named(all["operations"], "exp2");
  ASSERT_NE(exp2, nullptr);
  EXPECT_EQ((*exp2)["operands"], 1);
  const Json* cosine = named(all["constants"], "COS_MAX");
  ASSERT_NE(cosine, nullptr);
  EXPECT_EQ((*cosine)["type"], "float");
}

TEST(Check, OfAGoodFolder) {
  const Workplace place;
  place.write("mine/moss.node", kMoss);
  const auto good = place.run({"check", "mine"});
  EXPECT_EQ(good.status, 0) << good.all();
  EXPECT_EQ(good.err, "");
  EXPECT_NE(good.out.find("good"), std::string::npos) << good.out;
}

/// All errors at once, each at its place.
TEST(Check, OfWrongDeclarations) {
  const Workplace place;
  place.write("mine/moss.node", replaced(replaced(kMoss, "return factor * texel;", "return factor * texell;"),
                                         "return mix(below", "return mixx(below"));
  const auto wrong = place.run({"check", "mine"});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.err.find("mine/moss.node:24:21: error:"), std::string::npos) << wrong.err;
  EXPECT_NE(wrong.err.find("mixx"), std::string::npos) << wrong.err;
  EXPECT_NE(wrong.err.find("texell"), std::string::npos) << wrong.err;
  place.write("other/moss.node", replaced(kMoss, "base.cosines.NdotL);", "base.cosine.NdotL);"));
  const auto part = place.run({"check", "other"});
  EXPECT_EQ(part.status, 1);
  EXPECT_NE(part.err.find("other/moss.node:17:"), std::string::npos) << part.err;
}

TEST(Check, OfNamesThatNobodyUses) {
  const Workplace place;
  std::string text = replaced(kMoss, "mossFactor, mossTexture)", "mossFactor)");
  text = replaced(text, "surface:\n", "surface:\n    moss.idle = moss_cover(1);\n");
  text += R"(
/// Nobody's.
const float LONELY = 3;

/// Nobody calls it.
/// source: ACME
node moss_alone(float x in [0, 1]) -> float in [0, 1] {
    return x;
}

/// Of several types, and wanted by nobody.
/// source: ACME
node moss_forms<T in float, vec2, vec3>(T x in [0, 1]) -> T in [0, 1] {
    return x;
}

/// Of a palette.
/// source: ACME
/// category: plants
node moss_palette(float x in [0, 1]) -> float in [0, 1] {
    return x;
}
)";
  place.write("mine/moss.node", text);
  const auto said = place.run({"check", "mine"});
  EXPECT_EQ(said.status, 0) << said.all();
  for (const char* name : {"mossTexture", "moss.idle", "LONELY", "moss_alone", "moss_forms"})
    EXPECT_NE(said.err.find("'" + std::string(name) + "'"), std::string::npos) << name << "\n" << said.err;
  EXPECT_EQ(said.err.find("moss_palette"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("[unused-name]"), std::string::npos);
  EXPECT_EQ(said.err.find("moss_forms"), said.err.rfind("'moss_forms'") + 1) << "once for all its forms";
}

TEST(Check, OfLinesThatLeaveARange) {
  const Workplace place;
  place.write("mine/moss.node", replaced(kMoss, "texel in [0, 1] = 1) -> float in [0, 1] {",
                                         "texel in [0, 1] = 1) -> float in [0, 2] {"));
  const auto said = place.run({"check", "mine"});
  EXPECT_EQ(said.status, 0) << said.all();
  EXPECT_NE(said.err.find("mine/moss.node:17:"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("[may-leave-range]"), std::string::npos) << said.err;
}

/// Which of two layers lies above is said, or it is an error.
TEST(Check, OfTwoPartsOverOnePlace) {
  const Workplace place;
  place.write("mine/moss.node", kMoss);
  std::string ice = kMoss;
  for (const auto& [from, to] : {std::pair("moss", "ice"), std::pair("Moss", "Ice")}) {
    for (size_t at = ice.find(from); at != std::string::npos; at = ice.find(from, at))
      ice.replace(at, std::string(from).size(), to);
  }
  place.write("mine/ice.node", ice);
  const auto said = place.run({"check", "mine"});
  EXPECT_EQ(said.status, 1) << said.all();
  EXPECT_NE(said.err.find("error: the parts 'ice' and 'moss' lie over the same part"), std::string::npos)
      << said.err;
  place.write("mine/ice.node", replaced(ice, "over coat", "over coat, moss"));
  EXPECT_EQ(place.run({"check", "mine"}).status, 0);
}

TEST(Check, OfNothing) {
  const Workplace place;
  EXPECT_EQ(place.run({"check"}).status, 2);
  EXPECT_EQ(place.run({"check", "nowhere"}).status, 1);
}

/// An extension that is spelled wrong does nothing, which is hard to see.
TEST(Undeclared, ExtensionsAreNamed) {
  const Workplace place;
  place.write("a.gltf", gltfOf({R"({"extensions": {"KHR_materials_cleercoat": {"clearcoatFactor": 1}}})",
                                R"({"extensions": {"KHR_materials_cleercoat": {}, "ACME_x": {}}})"}));
  const auto said = place.run({"gen", "a.gltf", "-o", "out", "--target", "glsl", "--no-validate"});
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("KHR_materials_cleercoat"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("did you mean 'KHR_materials_clearcoat'?"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("ACME_x"), std::string::npos) << said.err;
  size_t count = 0;
  for (size_t at = said.err.find("[undeclared-extension]"); at != std::string::npos;
       at = said.err.find("[undeclared-extension]", at + 1))
    ++count;
  EXPECT_EQ(count, 2u) << said.err;
}

/// What an author must know of an input: the names of its values, and what it is without a connection.
TEST(Nodes, ShowWhatInputsAreByDefault) {
  const Workplace place;
  const std::string worley = place.run({"nodes", "worleynoise2d<float>"}).out;
  EXPECT_NE(worley.find("texcoord = given uv0 or [0, 0]\n"), std::string::npos) << worley;
  EXPECT_NE(worley.find("metric of euclidean, squared, manhattan, chebyshev = euclidean"), std::string::npos)
      << worley;
  const std::string placed = place.run({"nodes", "place2d"}).out;
  EXPECT_NE(placed.find("texcoord = [0, 0]\n"), std::string::npos) << placed;
}

/// The plain name of a node that two vendors have names neither; who says it is told of both.
/// A name of none is answered with one that is near, or with those that are about it.
TEST(Nodes, AreFoundByWhatIsMeant) {
  const Workplace place;
  const auto said = [&](const char* name) {
    const Outcome outcome = place.run({"nodes", name});
    EXPECT_EQ(outcome.status, 1);
    return outcome.err;
  };
  EXPECT_NE(said("fractl2d").find("did you mean 'fractal2d'?"), std::string::npos) << said("fractl2d");
  EXPECT_NE(said("perlin").find("'noise2d'"), std::string::npos) << said("perlin");
  EXPECT_NE(said("perlin").find("are about perlin"), std::string::npos) << said("perlin");
  EXPECT_NE(said("noise2d<color3>").find("`lacquer nodes noise2d` lists its forms"), std::string::npos);
  EXPECT_NE(said("qwertyuiop").find("`lacquer nodes` lists them"), std::string::npos);
}

TEST(Nodes, OfTwoVendorsAreNamedBoth) {
  const Workplace place;
  place.write("nodes/acme.node", kMoss);
  std::string bolt = kMoss;
  while (bolt.find("ACME_materials_moss") != std::string::npos)
    bolt = replaced(bolt, "ACME_materials_moss", "BOLT_moss");
  place.write("nodes/bolt.node", replaced(bolt, "over coat unless", "over ACME_materials_moss.moss unless"));
  const std::string both = "'ACME_materials_moss.moss_cover' and 'BOLT_moss.moss_cover'";
  const auto expectBoth = [&](const std::vector<std::string>& words, int status) {
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.status, status) << outcome.all();
    const bool said =
        outcome.err.find(both) != std::string::npos ||
        outcome.err.find("'ACME_materials_moss.moss_cover' or 'BOLT_moss.moss_cover'") != std::string::npos;
    EXPECT_TRUE(said) << outcome.err;
  };
  // A list shows what there is.
  const Outcome listed = place.run({"nodes", "moss_cover", "--nodes", "nodes"});
  EXPECT_EQ(listed.status, 0) << listed.all();
  for (const char* name : {"ACME_materials_moss.moss_cover\n", "BOLT_moss.moss_cover\n"})
    EXPECT_NE(listed.out.find(name), std::string::npos) << listed.all();
  expectBoth({"tune", "moss_cover", "--nodes", "nodes"}, 2);
  expectBoth({"stress", "moss_cover", "--nodes", "nodes"}, 1);
  place.write("graph.json", R"({"lacquer_graph": 1, "template": "bsdf", "nodes": [
    {"id": "a", "node": "moss_cover", "inputs": {"factor": 0.5}}], "outputs": {"alpha": {"node": "a"}}})");
  expectBoth({"dump", "graph.json", "--nodes", "nodes"}, 1);
  EXPECT_EQ(place.run({"nodes", "BOLT_moss.moss_cover", "--nodes", "nodes"}).status, 0);
}

/// Hints of the node language come out, and the library's own nodes have some.
TEST(Nodes, HaveLabelsWhereNamesSayLittle) {
  const Workplace place;
  const Outcome outcome = place.run({"nodes", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json all = Json::parse(outcome.out);
  std::map<std::string, std::string> labels;
  for (const Json& node : all["nodes"]) {
    for (const Json& input : node["inputs"]) {
      if (input.contains("label")) labels[input["name"]] = input["label"];
    }
  }
  EXPECT_EQ(labels["fg"], "Foreground");
  EXPECT_EQ(labels["uvtiling"], "Tiling");
  EXPECT_EQ(labels["texcoord"], "Texture coordinates");
  place.write("nodes.json", outcome.out);
  EXPECT_EQ(schemaErrors({place / "nodes.json"}, "nodes").value_or(""), "");
}

}  // namespace
}  // namespace lacquer::test::nodes_test
