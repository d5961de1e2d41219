// The node library for tools, and folders of node files that are checked where they are to stand.
#include <gtest/gtest.h>

#include <algorithm>

#include "command.h"
#include "support/cases.h"

namespace lacquer::test {
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

}  // namespace
}  // namespace lacquer::test
