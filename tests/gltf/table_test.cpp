// The declarations of glTF's properties against the extensions' JSON schemas, where these are at hand, and
// against the reader.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "gltf/dump.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test {
namespace {

using lang::PropertyDecl;
using material::Kind;
using nlohmann::json;

json defaultOf(const PropertyDecl& decl) {
  const ir::Components value = decl.default_value.value_or(ir::Components{});
  if (decl.kind == Kind::Choice) return decl.choices.at(static_cast<size_t>(value[0]));
  if (decl.kind == Kind::Bool) return value[0] != 0;
  if (decl.type == ir::Type::Float) return value[0];
  json array = json::array();
  for (int i = 0; i < ir::componentCount(decl.type); ++i) array.push_back(value[static_cast<size_t>(i)]);
  return array;
}

/// A material with every object of the table, and in it every default or nothing.
json everything(bool spelt_out, const std::vector<std::string_view>& without) {
  const material::Schema& schema = builtInSchema();
  const auto left = [&](const std::string& path) {
    return std::any_of(without.begin(), without.end(),
                       [&](std::string_view name) { return path.find(name) != std::string::npos; });
  };
  json material = json::object();
  for (uint16_t n = 2; n < 2 * schema.extensions.size();
       ++n) {  // twice: an object may stand in one of a later name
    const auto i = static_cast<uint16_t>(std::max<size_t>(n % schema.extensions.size(), 1));
    const lang::ExtensionDecl& decl = *schema.extensions[i];
    const std::string path = schema.pathOf(i);
    const bool whole = schema.extensions[i]->inside.empty() ||
                       material.contains(json::json_pointer("/extensions/" + std::string(decl.inside)));
    if (!decl.properties.empty() && whole && !left(path) &&
        !material.contains(json::json_pointer("/" + path)))
      material[json::json_pointer("/" + path)] = json::object();
  }
  for (const material::Property& property : schema.properties) {
    const bool optional = property.decl->kind == Kind::Number && !property.decl->default_value;
    if (left(property.path) || !spelt_out || property.decl->kind == Kind::Texture || optional) continue;
    material[json::json_pointer("/" + property.path)] = defaultOf(*property.decl);
  }
  return material;
}

/// Not an index into what is not there.
TEST(GltfTable, nodeFilesWithoutTheMaterialHaveNoSchema) {
  for (const std::string& text :
       {std::string(),
        std::string("/// E.\n/// source: S\nextension FUZZ_e {\n    float x in [0, 1] = 0;\n}\n")}) {
    const auto library = lang::Library::fromFiles({{"t.node", text}});
    ASSERT_TRUE(library);
    const auto schema = material::schemaOf(*library);
    ASSERT_FALSE(schema);
    EXPECT_EQ(schema.error()[0].code, "unknown-extension");
  }
}

TEST(GltfTable, defaultsSpeltOutChangeNothing) {
  const auto text = [](bool spelt_out) {
    const json materials = {everything(spelt_out, {"clearcoat", "Glossiness", "_scatter"}),
                            everything(spelt_out, {"_coat", "ADOBE", "Glossiness", "_diffuse_transmission"}),
                            everything(spelt_out, {"_coat", "EXT", "Glossiness", "_scatter"})};
    return json{{"asset", {{"version", "2.0"}}}, {"materials", materials}}.dump();
  };
  const auto spelt_out = materialsOf(text(true), "x");
  const auto empty = materialsOf(text(false), "x");
  ASSERT_TRUE(spelt_out && empty);
  EXPECT_EQ(formatAll(*spelt_out), formatAll(*empty));
  EXPECT_EQ(formatAll(*spelt_out).find(": error: "), std::string::npos) << formatAll(*spelt_out);
  EXPECT_EQ(dump(*spelt_out), dump(*empty));
  EXPECT_FALSE(spelt_out->materials[0].numbers.empty());
}

/// A schema's minimum and maximum of a number, or of each element of an array.
void checkRange(const PropertyDecl& decl, const json& schema) {
  const json& numbers = schema.contains("items") ? schema["items"] : schema;
  const bool or_zero = numbers.contains("oneOf");
  const json& bounds = or_zero ? numbers["oneOf"][1] : numbers;
  const ir::Interval all;
  // A bound that the schema leaves out is let in: the formulas hold there.
  const double least = bounds.value("minimum", bounds.value("exclusiveMinimum", all.lo));
  EXPECT_EQ(decl.range.gap > 0 ? decl.range.gap : decl.range.lo, least);
  // No boundary to air reflects more than one of IOR_MAX does to float32's last bit: what is larger is
  // refused.
  const double most = bounds.value("maximum", bounds.value("exclusiveMaximum", all.hi));
  if (decl.role == "ior" || decl.role == "coatIor" || decl.role == "iridescenceIor")
    EXPECT_GE(decl.range.hi, std::min(most, 1e9));
  else
    EXPECT_EQ(decl.range.hi, most);
  // coatIor's 0 is a reading of Lacquer's own: KHR_materials_ior allows it, the coat's schema is silent.
  if (decl.name != "coatIor") {
    EXPECT_EQ(decl.range.gap > 0, or_zero);
  }
}

void checkProperty(const PropertyDecl& decl, const json& schema) {
  SCOPED_TRACE(std::string(decl.name));
  if (decl.kind == Kind::Texture) {
    const bool normal = schema["allOf"][0]["$ref"] == "material.normalTextureInfo.schema.json";
    EXPECT_EQ(normal, decl.members.size() == 1 && decl.members[0].name == "scale");
    return;
  }
  EXPECT_EQ(schema["default"], defaultOf(decl));
  if (decl.kind == Kind::Bool) {
    EXPECT_EQ(schema["type"], "boolean");
    return;
  }
  ASSERT_EQ(decl.kind, Kind::Number);
  const bool number = decl.type == ir::Type::Float;
  ASSERT_EQ(schema["type"], number ? "number" : "array");
  if (!number) {
    EXPECT_EQ(schema["minItems"], ir::componentCount(decl.type));
    EXPECT_EQ(schema["maxItems"], ir::componentCount(decl.type));
  }
  checkRange(decl, schema);
}

/// Where a text and its schema disagree, or the schema is silent, and which of them is declared
/// (docs/specification.md).
const std::map<std::string, std::string> kReadings = {
    {"ADOBE_materials_clearcoat_specular/clearcoatIor",
     "the schema's maximum of 1 excludes its own default of 1.5"},
    {"ADOBE_materials_thin_transparency/ior", "for a material without the extension it is that of glTF"},
    {"EXT_materials_specular_edge_color/specularEdgeColorEnabled", "the schema has no properties"},
    {"KHR_materials_diffuse_roughness/diffuseRoughnessFactor", "the text's default is 0, the schema's 1"},
    {"KHR_materials_fuzz/fuzzRoughnessFactor", "the text's default is 0.5, the schema's 0"},
    {"KHR_materials_scatter/scatterStrengthFactor", "the text's name, which the schema lacks"},
    {"KHR_materials_scatter/scatterStrengthTexture", "the text's name, which the schema lacks"},
    {"KHR_materials_volume/attenuationDistance", "above 0, and without a default: what float32 divides by"},
    {"KHR_materials_volume_scatter/multiscatterColorFactor", "the text's name, which the schema lacks"},
};

std::map<std::string, std::filesystem::path> schemas() {
  std::map<std::string, std::filesystem::path> found;
  const std::filesystem::path folder = sourceFolder() / "../shared/specs";
  if (!std::filesystem::exists(folder)) return found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    std::string name = entry.path().filename().string();
    constexpr std::string_view kEnd = ".schema.json";
    if (!name.ends_with(kEnd)) continue;
    name.resize(name.size() - kEnd.size());
    // What lies in `schemas` are the texts that the coat was written from; a later draft does not replace
    // them.
    const std::string extension = name.substr(name.find('.') + 1);
    if (entry.path().parent_path().filename() == "schemas" || !found.contains(extension))
      found[extension] = entry.path();
  }
  return found;
}

TEST(GltfTable, matchesTheSchemas) {
  const auto files = schemas();
  if (files.empty()) GTEST_SKIP() << "skipped: there are no schemas in ../shared/specs";
  std::set<std::string> compared, read;
  for (const lang::ExtensionDecl* decl : builtInSchema().extensions) {
    const auto file = files.find(std::string(decl->name));
    if (file == files.end()) continue;
    SCOPED_TRACE(std::string(decl->name));
    compared.insert(std::string(decl->name));
    json properties = json::parse(readFile(file->second)).value("properties", json::object());
    properties.erase("extensions");
    properties.erase("extras");
    for (const PropertyDecl& property : decl->properties) {
      const std::string name(property.name);
      if (kReadings.contains(file->first + "/" + name)) {
        read.insert(file->first + "/" + name);
      } else {
        ASSERT_TRUE(properties.contains(name)) << name;
        checkProperty(property, properties[name]);
      }
      properties.erase(name);
    }
    EXPECT_TRUE(properties.empty()) << "not declared: " << properties.dump();
  }
  EXPECT_EQ(read.size(), kReadings.size());
  EXPECT_GE(compared.size(), 25U);
}

}  // namespace
}  // namespace lacquer::test
