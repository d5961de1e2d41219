// The table against the structs' defaults and, where they are at hand, the extensions' JSON schemas.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "gltf/dump.h"
#include "gltf/table.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

using namespace gltf;

using nlohmann::json;

/// What an object of the table holds, as JSON.
using Contents = std::function<json(std::string_view object)>;

/// A file with every object of the table in it.
std::string everything(const Contents& of) {
  const auto texture = [&](std::string_view object) {
    json info = of(object);
    info["index"] = 0;
    info["extensions"]["KHR_texture_transform"] = of("KHR_texture_transform");
    return info;
  };
  json material = of("material");
  material["pbrMetallicRoughness"] = of("pbrMetallicRoughness");
  material["normalTexture"] = texture("normalTextureInfo");
  material["occlusionTexture"] = texture("occlusionTextureInfo");
  material["emissiveTexture"] = texture("textureInfo");
  json coated = material;
  const auto add = [&](json& to, const char* name) { to["extensions"][name] = of(name); };
  for (const char* name : {"KHR_materials_ior", "KHR_materials_emissive_strength", "KHR_materials_clearcoat",
                           "ADOBE_materials_clearcoat_tint"}) {
    add(material, name);
  }
  json& clearcoat = material["extensions"]["KHR_materials_clearcoat"];
  add(clearcoat, "EXT_materials_clearcoat_color");
  add(clearcoat, "EXT_materials_clearcoat_darkening");
  add(coated, "KHR_materials_coat");
  return json{
      {"asset", {{"version", "2.0"}}}, {"textures", {json::object()}}, {"materials", {material, coated}}}
      .dump();
}

TEST(GltfTable, defaultsSpeltOutChangeNothing) {
  std::set<std::string_view> used;
  const auto defaults = [&](std::string_view object) {
    json out = json::object();
    used.insert(object);
    for (const TableRow& row : tableRows()) {
      if (row.object != object) continue;
      const size_t count = elementCount(row.facts.kind);
      json& value = out[std::string(row.facts.name)];
      if (count == 1) value = row.facts.by_default[0];
      for (size_t i = 0; count > 1 && i < count; ++i) value.push_back(row.facts.by_default[i]);
      if (count == 0) out.erase(std::string(row.facts.name));
    }
    return out;
  };
  const auto speltOut = readText(everything(defaults), "x", {});
  const auto empty = readText(everything([](std::string_view) { return json::object(); }), "x", {});
  ASSERT_TRUE(speltOut && empty);
  EXPECT_EQ(formatAll(*speltOut), formatAll(*empty));
  EXPECT_EQ(formatAll(*speltOut).find(": error: "), std::string::npos) << formatAll(*speltOut);
  EXPECT_EQ(dump(*speltOut), dump(*empty));
  for (const TableRow& row : tableRows())
    EXPECT_TRUE(used.contains(row.object)) << row.object << " is not tested";
}

TEST(GltfTable, kindsFitTheMembers) {
  for (const TableRow& row : tableRows()) {
    const bool ranged = elementCount(row.facts.kind) != 0;
    EXPECT_TRUE(ranged || (std::isinf(row.facts.range.min) && std::isinf(row.facts.range.max)))
        << row.facts.name;
  }
}

TEST(GltfTable, placesAreKnown) {
  EXPECT_EQ(placeOf("KHR_materials_coat").where, "the material's extensions");
  EXPECT_EQ(placeOf("KHR_materials_clearcoat_color").now, "EXT_materials_clearcoat_color");
  EXPECT_EQ(placeOf("KHR_texture_transform").where, "a textureInfo's extensions");
  EXPECT_EQ(placeOf("KHR_materials_sheen").where, "");
  EXPECT_EQ(placeOf("").where, "");
}

using Schema = json;

/// A schema's minimum and maximum of a number, or of each element of an array.
void checkRange(const PropertyFacts& facts, const Schema& schema) {
  const Schema& numbers = schema.contains("items") ? schema["items"] : schema;
  const bool orZero = numbers.contains("oneOf");
  const Schema& bounds = orZero ? numbers["oneOf"][1] : numbers;
  EXPECT_EQ(facts.range.min, bounds.contains("minimum") ? bounds["minimum"].get<double>() : kAny.min);
  EXPECT_EQ(facts.range.max, bounds.contains("maximum") ? bounds["maximum"].get<double>() : kAny.max);
  // coatIor's 0 is a reading of Lacquer's own: KHR_materials_ior allows it, the coat's schema is silent.
  if (facts.name != "coatIor") {
    EXPECT_EQ(facts.range.orZero, orZero);
  }
}

void checkProperty(const PropertyFacts& facts, const Schema& schema) {
  SCOPED_TRACE(std::string(facts.name));
  if (facts.kind == Kind::TexCoord) {
    EXPECT_EQ(schema["type"], "integer");
  } else if (elementCount(facts.kind) == 0) {
    const bool normal = schema["allOf"][0]["$ref"] == "material.normalTextureInfo.schema.json";
    EXPECT_EQ(facts.kind, normal ? Kind::NormalTexture : Kind::Texture);
  } else if (facts.kind == Kind::Number) {
    EXPECT_EQ(schema["type"], "number");
    EXPECT_EQ(schema["default"].get<double>(), facts.by_default[0]);
    checkRange(facts, schema);
  } else {
    ASSERT_EQ(schema["type"], "array");
    EXPECT_EQ(schema["minItems"], elementCount(facts.kind));
    EXPECT_EQ(schema["maxItems"], elementCount(facts.kind));
    for (size_t i = 0; i < elementCount(facts.kind); ++i) {
      EXPECT_EQ(schema["default"][i].get<double>(), facts.by_default[i]);
    }
    checkRange(facts, schema);
  }
}

TEST(GltfTable, matchesTheSchemas) {
  const std::filesystem::path folder = sourceFolder() / "../shared/specs/schemas";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "skipped: no schemas in " << folder;
  std::map<std::string, std::vector<PropertyFacts>> objects;
  for (const TableRow& row : tableRows()) objects[std::string(row.object)].push_back(row.facts);
  size_t compared = 0;
  for (const auto& [name, rows] : objects) {
    std::filesystem::path file = folder / ("material." + name + ".schema.json");
    if (!std::filesystem::exists(file)) file = folder / ("textureInfo." + name + ".schema.json");
    if (!std::filesystem::exists(file)) continue;
    SCOPED_TRACE(name);
    ++compared;
    Schema properties = Schema::parse(readFile(file))["properties"];
    properties.erase("extensions");
    properties.erase("extras");
    for (const PropertyFacts& facts : rows) {
      ASSERT_TRUE(properties.contains(facts.name)) << facts.name;
      checkProperty(facts, properties[std::string(facts.name)]);
      properties.erase(std::string(facts.name));
    }
    EXPECT_TRUE(properties.empty()) << "not in the table: " << properties.dump();
  }
  EXPECT_EQ(compared, 8u);
}

}  // namespace
}  // namespace lacquer::test
