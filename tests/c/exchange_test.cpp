// Materials of other tools, in and out, from C: what C++ reads, writes and bakes.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "handle.h"
#include "lacquer.h"
#include "lacquer/exchange.h"
#include "support/cases.h"

namespace lacquer::test::exchange_test {
namespace {

namespace fs = std::filesystem;

class CExchange : public testing::Test {
protected:
  CExchange() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(document_) << R"(<materialx version="1.39">
      <nodegraph name="NG">
        <ramplr name="across" type="color3">
          <input name="valuel" type="color3" value="0.1, 0.2, 0.9"/>
          <input name="valuer" type="color3" value="0.8, 0.4, 0.1"/>
        </ramplr>
        <output name="color" type="color3" nodename="across"/>
      </nodegraph>
      <gltf_pbr name="shader" type="surfaceshader">
        <input name="base_color" type="color3" nodegraph="NG" output="color"/>
        <input name="roughness" type="float" value="0.25"/>
      </gltf_pbr>
      <surfacematerial name="Ramp" type="material">
        <input name="surfaceshader" type="surfaceshader" nodename="shader"/>
      </surfacematerial></materialx>)";
  }
  ~CExchange() override { fs::remove_all(folder_); }

  const fs::path folder_ = fs::path(testing::TempDir()) / "lacquer_c_exchange";
  const std::string document_ = (folder_ / "ramp.mtlx").string();
  const std::string coat_ = (sourceFolder() / "examples/coat.gltf").string();
  Messages messages_;
  CMessages c_messages_;
};

TEST_F(CExchange, DocumentsAreRead) {
  const CScene scene(lacquer_scene_load(document_.c_str(), nullptr, c_messages_));
  ASSERT_EQ(lacquer_scene_material_count(scene.get()), 1U);
  const CGraph graph(lacquer_scene_graph(scene.get(), 0, LACQUER_UNUSED_ATTRIBUTES, nullptr, c_messages_));
  const Scene expected = Scene::load(document_, {}, messages_);
  EXPECT_EQ(textOf(CText(lacquer_graph_json(graph.get()))),
            expected.graph(0, kUnusedAttributes, {}, messages_).toJson());
  EXPECT_EQ(c_messages_.takeCodes(), "");
}

TEST_F(CExchange, MaterialsAreWritten) {
  const char* names[] = {"Darkening"};
  const std::string expected = toMaterialX(coat_, {"Darkening"}, "open_pbr_surface", {}, messages_);
  EXPECT_NE(expected, "");
  const CText text(lacquer_materialx(coat_.c_str(), names, 1, "open_pbr_surface", nullptr, c_messages_));
  EXPECT_EQ(textOf(text), expected);
  const std::string output = (folder_ / "coat.mtlx").string();
  EXPECT_EQ(lacquer_convert(output.c_str(), coat_.c_str(), nullptr, 0, "", nullptr, c_messages_), 1);
  const CScene again(lacquer_scene_load(output.c_str(), nullptr, c_messages_));
  EXPECT_EQ(lacquer_scene_material_count(again.get()), Scene::load(coat_, {}, messages_).materialCount());
  c_messages_.takeCodes();
  EXPECT_EQ(lacquer_materialx(coat_.c_str(), nullptr, 0, "phong", nullptr, c_messages_), nullptr);
  EXPECT_EQ(lacquer_convert(coat_.c_str(), coat_.c_str(), nullptr, 0, "", nullptr, c_messages_), 0);
  EXPECT_EQ(lacquer_materialx(nullptr, nullptr, 0, nullptr, nullptr, c_messages_), nullptr);
  EXPECT_EQ(c_messages_.takeCodes(), "unknown-surface, output-clash, file-unreadable");
}

TEST_F(CExchange, PatternsAreBaked) {
  const std::string output = (folder_ / "ramp.gltf").string();
  const CText text(lacquer_bake(output.c_str(), document_.c_str(), nullptr, 0, 8, nullptr, c_messages_));
  EXPECT_NE(textOf(text).find("\"textures\": 1"), std::string::npos) << textOf(text);
  EXPECT_TRUE(fs::exists(output));
  EXPECT_TRUE(fs::exists(folder_ / "Ramp_baseColorTexture.png"));
  EXPECT_EQ(lacquer_bake(output.c_str(), document_.c_str(), nullptr, 0, 0, nullptr, c_messages_), nullptr);
  EXPECT_EQ(lacquer_bake(output.c_str(), coat_.c_str(), nullptr, 0, 8, nullptr, c_messages_), nullptr);
  EXPECT_EQ(c_messages_.takeCodes(), "out-of-range, nothing-to-bake");
}

TEST_F(CExchange, BakesWithAllThatCppSays) {
  const std::string output = (folder_ / "across.ktx2").string();
  const char* how = R"({"size": 4, "nodes": ["across"], "levels": true, "bits": 16})";
  const CText text(lacquer_bake_as(output.c_str(), document_.c_str(), nullptr, 0, how, nullptr, c_messages_));
  EXPECT_NE(textOf(text).find("across.ktx2"), std::string::npos) << textOf(text);
  EXPECT_TRUE(fs::exists(output));
  EXPECT_EQ(lacquer_bake_as(output.c_str(), document_.c_str(), nullptr, 0, R"({"texels": 4})", nullptr,
                            c_messages_),
            nullptr);
  EXPECT_EQ(lacquer_bake_as(output.c_str(), document_.c_str(), nullptr, 0, R"({"also": ["png"]})", nullptr,
                            c_messages_),
            nullptr);
  EXPECT_EQ(lacquer_bake_as(output.c_str(), document_.c_str(), nullptr, 0, "[", nullptr, c_messages_),
            nullptr);
  EXPECT_EQ(c_messages_.takeCodes(), "unknown-option, wrong-type, json-syntax");
}

TEST_F(CExchange, ConversionsAreMeasured) {
  const std::string output = (folder_ / "open.mtlx").string();
  const CText text(lacquer_convert_as(output.c_str(), document_.c_str(), nullptr, 0,
                                      R"({"surface": "open_pbr_surface", "measured": true, "size": 16})",
                                      nullptr, c_messages_));
  EXPECT_NE(textOf(text).find("\"material\": \"Ramp\""), std::string::npos) << textOf(text);
  EXPECT_TRUE(fs::exists(output));
}

TEST_F(CExchange, ScenesAreTexts) {
  const CText file(lacquer_gltf(document_.c_str(), nullptr, 0, 4, nullptr, c_messages_));
  EXPECT_EQ(textOf(file), toGltf(document_, {}, 4, {}, messages_));
  const CScene scene(lacquer_scene_load(document_.c_str(), nullptr, c_messages_));
  const CText same(lacquer_scene_gltf(scene.get(), nullptr, 0, 4, nullptr, c_messages_));
  EXPECT_EQ(textOf(same), textOf(file));
  const CText plain(
      lacquer_scene_materialx(scene.get(), nullptr, 0, "", nullptr, nullptr, 0, nullptr, c_messages_));
  EXPECT_EQ(textOf(plain), toMaterialX(document_, {}, "", {}, messages_));
  EXPECT_EQ(c_messages_.takeCodes(), "");
  // Of an edited graph the numbers of its patterns.
  lacquer_graph* graph = lacquer_scene_graph(scene.get(), 0, LACQUER_UNUSED_ATTRIBUTES, nullptr, c_messages_);
  const double blue[] = {0.0625, 0.125, 0.25};
  ASSERT_EQ(lacquer_graph_set_parameter(graph, "NG_across_valuel", blue, 3, c_messages_), 1);
  const size_t first = 0;
  const CText edited(
      lacquer_scene_materialx(scene.get(), nullptr, 0, "", &first, &graph, 1, nullptr, c_messages_));
  EXPECT_NE(textOf(edited).find("value=\"0.0625, 0.125, 0.25\""), std::string::npos) << textOf(edited);
  EXPECT_EQ(textOf(edited).size() > 0, true);
  EXPECT_EQ(c_messages_.takeCodes(), "not-said");
  const size_t none = 7;
  EXPECT_EQ(lacquer_scene_materialx(scene.get(), nullptr, 0, "", &none, &graph, 1, nullptr, c_messages_),
            nullptr);
  EXPECT_EQ(lacquer_scene_materialx(nullptr, nullptr, 0, "", nullptr, nullptr, 0, nullptr, c_messages_),
            nullptr);
  EXPECT_EQ(lacquer_scene_gltf(scene.get(), nullptr, 0, 0, nullptr, c_messages_), nullptr);
  EXPECT_EQ(c_messages_.takeCodes(), "no-such-material, empty-handle, out-of-range");
  lacquer_graph_free(graph);
}

TEST_F(CExchange, IncludedTextsAreGiven) {
  const std::string main = R"(<materialx version="1.39"><xi:include href="lib/s.mtlx"/></materialx>)";
  const auto materials = [&](const char* json) {
    const COptions options = optionsFrom(json, c_messages_);
    const CScene scene(
        lacquer_scene_read(main.data(), main.size(), "a/main.mtlx", options.get(), c_messages_));
    return lacquer_scene_material_count(scene.get());
  };
  EXPECT_EQ(materials(R"({"document_texts": {"lib/s.mtlx":
    "<materialx version='1.39'><surface_unlit name='s' type='surfaceshader'/></materialx>"}})"),
            1U);
  EXPECT_EQ(c_messages_.takeCodes(), "");
  EXPECT_EQ(materials(R"({"document_texts": {"s.mtlx": "<materialx version='1.39'/>"}})"), 0U);
  EXPECT_EQ(materials(R"({"document_texts": {"lib/s.mtlx":
    "<materialx version='1.39'><xi:include href='../../b.mtlx'/></materialx>"}})"),
            0U);
  EXPECT_EQ(c_messages_.takeCodes(), "include-missing, include-outside");
}

TEST_F(CExchange, DefinitionsAreGiven) {
  const std::string main = R"(<materialx version="1.39"><mine name="s" type="surfaceshader"/></materialx>)";
  const auto codes = [&](const std::string& definitions) {
    const COptions options =
        optionsFrom(R"({"materialx_texts": {"studio.mtlx": ")" + definitions + R"("}})", c_messages_);
    const CScene scene(lacquer_scene_read(main.data(), main.size(), "main.mtlx", options.get(), c_messages_));
    const size_t count = lacquer_scene_material_count(scene.get());
    return std::to_string(count) + c_messages_.takeCodes();
  };
  const std::string good =
      "<materialx version='1.39'><nodedef name='ND' node='mine'><output name='out' "
      "type='surfaceshader'/></nodedef>"
      "<nodegraph name='NG' nodedef='ND'><surface_unlit name='s' type='surfaceshader'/>"
      "<output name='out' type='surfaceshader' nodename='s'/></nodegraph></materialx>";
  EXPECT_EQ(codes(good), "1");
  EXPECT_EQ(codes("<materialx version='1.39'><nodedef node='mine'/></materialx>"), "0no-name");
}

/// A picture of four by two pixels, as Radiance has it without runs.
std::string smallPicture() {
  std::string picture = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
  for (char i = 1; i <= 8; ++i) picture += {static_cast<char>(16 * i - 1), 64, 32, static_cast<char>(129)};
  return picture;
}

TEST(CEnvironments, AreFilteredInMemory) {
  const std::string picture = smallPicture();
  Messages messages;
  const auto expected = filterEnvironment({"", 32, 64, false, true}, picture, "sky.hdr", {}, messages);
  ASSERT_TRUE(expected);
  CMessages said;
  const CEnvironment made(
      lacquer_environment_filter(picture.data(), picture.size(), "sky.hdr",
                                 R"({"size": 32, "samples": 64, "shared_exponents": true})", nullptr, said));
  ASSERT_TRUE(made) << said.takeCodes();
  size_t size = 0;
  const char* text = lacquer_environment_description(made.get(), &size);
  EXPECT_EQ(std::string(text, size), expected->description);
  for (size_t i = 0; i < expected->files.size(); ++i) {
    const char* file = lacquer_environment_file(made.get(), expected->maps.textures[i].slot.c_str(), &size);
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(std::string(file, size), expected->files[i]);
  }
  EXPECT_EQ(lacquer_environment_file(made.get(), "environment_none", &size), nullptr);
  EXPECT_EQ(size, 0U);
  const CEnvironment draft(lacquer_environment_filter(picture.data(), picture.size(), "sky.hdr",
                                                      R"({"draft": true})", nullptr, said));
  ASSERT_TRUE(draft) << said.takeCodes();
  Environment form;
  form.draft = true;
  const auto drafted = filterEnvironment(form, picture, "sky.hdr", {}, messages);
  ASSERT_TRUE(drafted);
  text = lacquer_environment_description(draft.get(), &size);
  EXPECT_EQ(std::string(text, size), drafted->description);
}

TEST(CEnvironments, WrongOnesAreSaid) {
  CMessages said;
  const std::string picture = smallPicture();
  const auto filter = [&](const char* bytes, size_t size, const char* how) {
    return CEnvironment(lacquer_environment_filter(bytes, size, "sky.hdr", how, nullptr, said));
  };
  EXPECT_FALSE(filter(picture.data(), picture.size(), R"({"faces": 32})"));
  EXPECT_EQ(said.takeCodes(), "unknown-option");
  EXPECT_FALSE(filter(picture.data(), picture.size(), R"({"size": 33})"));
  EXPECT_EQ(said.takeCodes(), "out-of-range");
  EXPECT_FALSE(filter(nullptr, 0, nullptr));
  EXPECT_EQ(said.takeCodes(), "environment-unreadable");
  EXPECT_FALSE(filter(picture.data(), picture.size() - 1, nullptr));
  EXPECT_EQ(said.takeCodes(), "environment-unreadable");
  EXPECT_EQ(lacquer_environment_file(nullptr, "environment_dfg", nullptr), nullptr);
  lacquer_environment_free(nullptr);
}

}  // namespace
}  // namespace lacquer::test::exchange_test
