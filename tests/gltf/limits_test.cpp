// Inputs that are too large, too deep or too odd for a file of cases/.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <ctime>

#include "gltf/dump.h"
#include "support/materials.h"

namespace lacquer::test {
namespace {

using material::Document;

std::string repeated(const std::string& text, size_t count) {
  std::string out;
  out.reserve(text.size() * count);
  for (size_t i = 0; i < count; ++i) out += text;
  return out;
}

/// A file whose only material holds `members`.
std::string withMaterial(const std::string& members) {
  return R"({"asset":{"version":"2.0"},"materials":[{)" + members + "}]}";
}

/// A member that holds so many arrays, one in the other.
std::string nested(size_t depth) {
  return fmt::format(R"("extras":{}{})", std::string(depth, '['), std::string(depth, ']'));
}

std::string failure(const std::string& text) {
  const auto document = materialsOf(text, "x");
  if (document) return "read";
  std::string out;
  for (const Diagnostic& one : document.error()) out.append(out.empty() ? "" : "\n").append(format(one));
  return out;
}

TEST(GltfLimits, deepNestingIsAnError) {
  const std::string brackets = std::string(60, '[');
  const std::string help = "\n  help: nothing needs that: the file is damaged or made to do harm";
  const std::string excerpt = "\n  ..." + brackets + brackets + "...\n  " + std::string(63, ' ') + "^";
  const std::string message = ": error: nested more than 512 levels deep [json-too-deep]";
  EXPECT_EQ(failure(std::string(100'000, '[')), "x:1:513" + message + excerpt + help);
  EXPECT_EQ(failure(repeated(R"({"a":)", 100'000)).substr(0, 65), "x:1:2561" + message);
  EXPECT_EQ(failure(withMaterial(nested(600))).substr(0, 7), "x:1:560");
  EXPECT_EQ(failure(withMaterial(nested(500))), "read");
  EXPECT_EQ(failure(withMaterial(fmt::format(R"("name":"{:[>600}")", ""))), "read");
}

TEST(GltfLimits, numbersOutOfRangeAreErrors) {
  EXPECT_EQ(failure(withMaterial(R"("alphaCutoff":1e999)")),
            "x:1:56: error: the number 1e999 is out of range [json-number-range]\n"
            "  {\"asset\":{\"version\":\"2.0\"},\"materials\":[{\"alphaCutoff\":1e999}]}\n"
            "  " +
                std::string(55, ' ') +
                "^~~~~\n"
                "  help: a number must fit a double: at most about 1.8e308");
  const std::string nan = failure(withMaterial(R"("alphaCutoff":NaN)"));
  EXPECT_EQ(nan.substr(0, 7), "x:1:56:");
  EXPECT_NE(nan.find("\n  help: JSON has no NaN and no infinity"), std::string::npos) << nan;
  EXPECT_NE(failure(withMaterial(R"("alphaCutoff":-Infinity)")).find("no infinity"), std::string::npos);
}

TEST(GltfLimits, longLinesAreCut) {
  const std::string text =
      withMaterial(fmt::format(R"("name":"{}","x":?,"y":"{:y>5000}")", repeated("\xC3\xA9", 5000), ""));
  const std::string found = failure(text);
  EXPECT_EQ(found.substr(0, 9), "x:1:10056") << found;
  EXPECT_LT(found.size(), 500u);
}

TEST(GltfLimits, syntaxErrorsCarryTheirPlace) {
  EXPECT_EQ(failure("{\r\n\t\"asset\": }\r\n"),
            "x:2:11: error: not valid JSON: syntax error while parsing value - unexpected '}'; expected '[', "
            "'{', or "
            "a literal [json-syntax]\n"
            "   \"asset\": }\n"
            "            ^");
  EXPECT_EQ(failure("{\"a\": 1"),
            "x:1:8: error: not valid JSON: syntax error while parsing object - unexpected end of input; "
            "expected '}' "
            "[json-syntax]\n"
            "  {\"a\": 1\n"
            "         ^");
  const std::string binary = failure("\x89PNG\r\n\x1A\n");
  EXPECT_EQ(binary.find('\x89'), std::string::npos);
  EXPECT_EQ(binary.find('\x1A'), std::string::npos);
}

TEST(GltfLimits, rootMustBeAGltf) {
  EXPECT_EQ(failure("[]"), "x: error: the file is an array [wrong-type]\n  help: it must be a JSON object");
  EXPECT_EQ(failure("{}"),
            "x: error: the file has no \"asset\" [missing-property]\n"
            "  help: every glTF has one: \"asset\": { \"version\": \"2.0\" }");
  EXPECT_EQ(failure(R"({"asset":3})"),
            "x:/asset: error: asset is a number [wrong-type]\n  help: it must be an object");
  EXPECT_EQ(
      failure(R"({"asset":{}})"),
      "x:/asset: error: the asset has no \"version\" [missing-property]\n  help: Lacquer reads glTF 2.0 "
      "and 2.1");
  EXPECT_EQ(
      failure(R"({"asset":{"version":"1.0"}})"),
      "x:/asset/version: error: version is \"1.0\" [unsupported-version]\n  help: Lacquer reads glTF 2.0 "
      "and 2.1");
  EXPECT_EQ(failure(R"({"asset":{"version":2.0}})"),
            "x:/asset/version: error: version is a number [wrong-type]\n  help: it must be a string such as "
            "\"2.0\"");
  EXPECT_EQ(failure(R"({"asset":{"version":"2.2","minVersion":"2.2"}})"),
            "x:/asset/minVersion: error: minVersion is \"2.2\" [unsupported-version]\n  help: Lacquer reads "
            "glTF 2.0 and 2.1");
  EXPECT_EQ(failure(R"({"asset":{"version":"2.1","minVersion":"2.1"}})"), "read");
  EXPECT_EQ(failure(R"({"asset":{"version":"2.9"}})"), "read");
  EXPECT_EQ(failure(R"({"asset":{"version":"2.0"},"materials":{}})"),
            "x:/materials: error: materials is an object [wrong-type]\n  help: it must be an array");
}

TEST(GltfLimits, namesAreKept) {
  const auto document = materialsOf(withMaterial(R"("name":"a\u0000b/../\n\ud83d\ude00")"), "x");
  ASSERT_TRUE(document);
  EXPECT_EQ(document->materials[0].name, std::string("a\0b/../\n\xF0\x9F\x98\x80", 12));
}

TEST(GltfLimits, lastOfDoubleMembersCounts) {
  const auto document =
      materialsOf(withMaterial(R"("alphaCutoff":0.1,"name":"a","alphaCutoff":0.2,"alphaCutoff":0.3)"), "x");
  ASSERT_TRUE(document);
  ASSERT_EQ(document->materials[0].numbers.size(), 1U);
  EXPECT_EQ(document->materials[0].numbers[0].value[0], 0.3);
  EXPECT_EQ(document->materials[0].name, "a");
}

TEST(GltfLimits, unknownPropertiesAreCounted) {
  std::string members = "\"doubleSided\":true";
  for (int i = 0; i < 1000; ++i) members += fmt::format(",\"unknown {}\":1", i);
  const auto document = materialsOf(withMaterial(members), "x");
  ASSERT_TRUE(document);
  ASSERT_EQ(document->materials[0].diagnostics.size(), 17u);
  EXPECT_EQ(document->materials[0].diagnostics.back().message,
            "the material has 984 more unknown properties");
}

/// Of this process, whatever else the machine does.
double secondsFor(const std::string& text) {
  const std::clock_t start = std::clock();
  const auto document = materialsOf(text, "x");
  EXPECT_TRUE(document);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// As many materials, textures, primitives and nodes.
std::string largeFile(size_t count) {
  std::string materials, textures, primitives, nodes;
  for (size_t i = 0; i < count; ++i) {
    const std::string comma = i == 0 ? "" : ",";
    const std::string n = std::to_string(i);
    materials +=
        comma + R"({"name":"material )" + n +
        R"(","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,1],"baseColorTexture":{"index":)" + n +
        R"(}},"extensions":{"KHR_materials_coat":{"coatFactor":1,"coatColorFactor":[0.9,0.3,0.3]}}})";
    textures += comma + R"({"source":0})";
    primitives += comma + R"({"attributes":{"POSITION":0,"NORMAL":0,"TEXCOORD_0":0},"material":)" + n + "}";
    nodes += comma + R"({"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}}})";
  }
  return R"({"asset":{"version":"2.0"},"accessors":[{}],"images":[{"uri":"a.png"}],"materials":[)" +
         materials + R"(],"textures":[)" + textures + R"(],"meshes":[{"primitives":[)" + primitives +
         R"(]}],"nodes":[)" + nodes +
         R"(],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}}})";
}

// The bounds are wide: they tell linear from quadratic, whatever the machine and its load.
TEST(GltfLimits, manyMaterialsTakeLinearTime) {
  const double tenth = secondsFor(largeFile(10'000));
  const double whole = secondsFor(largeFile(100'000));
  RecordProperty("seconds", std::to_string(whole));
  EXPECT_LT(whole, 40 * tenth + 1);
}

TEST(GltfLimits, largeObjectsTakeLinearTime) {
  const auto object = [](size_t count) {
    std::string members = R"("extras":{"a":0)";
    for (size_t i = 0; i < count; ++i) members += fmt::format(",\"member {}\":1", i);
    return withMaterial(members + "}");
  };
  const double tenth = secondsFor(object(40'000));
  const double whole = secondsFor(object(400'000));
  EXPECT_LT(whole, 40 * tenth + 1);
}

}  // namespace
}  // namespace lacquer::test
