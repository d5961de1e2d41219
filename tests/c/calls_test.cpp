// The calls of the C interface one by one, and what a caller can get wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "handle.h"
#include "support/cases.h"

extern "C" size_t fragmentBytesFromC(const char* path, const char* name);

namespace lacquer::test::calls_test {
namespace {

using Json = nlohmann::json;

const char* const kQuick = R"({"targets": ["essl"], "validate": false})";

class CCalls : public testing::Test {
protected:
  void SetUp() override {
    options_ = optionsFrom(kQuick);
    const std::string bytes = readFile(sourceFolder() / "examples/coat.gltf");
    scene_.reset(lacquer_scene_read(bytes.data(), bytes.size(), "coat.gltf", options_.get(), messages_));
    ASSERT_NE(scene_, nullptr);
  }
  CGraph graphOf(size_t material) {
    return CGraph(
        lacquer_scene_graph(scene_.get(), material, LACQUER_UNUSED_ATTRIBUTES, options_.get(), messages_));
  }
  size_t indexOf(const char* name) { return lacquer_scene_find_material(scene_.get(), name, messages_); }

  CMessages messages_;
  COptions options_;
  CScene scene_;
};

TEST_F(CCalls, versionsAreTold) {
  EXPECT_EQ(lacquer_c_version(), static_cast<uint32_t>(LACQUER_C_VERSION));
  EXPECT_NE(std::string(lacquer_version()), "");
}

TEST_F(CCalls, aProgramInCMakesAShader) {
  const std::string path = (sourceFolder() / "examples/car_paint.gltf").string();
  EXPECT_GT(fragmentBytesFromC(path.c_str(), "Car paint"), 5000u);
  EXPECT_EQ(fragmentBytesFromC(path.c_str(), "no such paint"), 0u);
}

TEST_F(CCalls, nothingIsDoneWithoutHandlesAndNothingBreaks) {
  EXPECT_EQ(lacquer_scene_material_count(nullptr), 0u);
  EXPECT_STREQ(lacquer_scene_material_name(nullptr, 0, nullptr), "");
  EXPECT_EQ(lacquer_scene_find_material(nullptr, "x", messages_), LACQUER_NONE);
  EXPECT_EQ(messages_.takeCodes(), "empty-handle");
  EXPECT_EQ(lacquer_scene_graph(nullptr, 0, 0, nullptr, messages_), nullptr);
  EXPECT_EQ(lacquer_scene_evaluate(nullptr, 0, "[]", 2, LACQUER_DOUBLE, nullptr, messages_), nullptr);
  EXPECT_EQ(messages_.takeCodes(), "empty-handle, empty-handle");
  EXPECT_EQ(lacquer_graph_json(nullptr), nullptr);
  EXPECT_EQ(lacquer_graph_parameters(nullptr), nullptr);
  EXPECT_EQ(lacquer_graph_add_node(nullptr, "a", "b", messages_), 0);
  EXPECT_EQ(lacquer_graph_check(nullptr, nullptr, messages_), 0);
  EXPECT_EQ(lacquer_graph_generate(nullptr, nullptr, messages_), nullptr);
  EXPECT_EQ(lacquer_graph_dump(nullptr, "", nullptr, messages_), nullptr);
  EXPECT_EQ(messages_.takeCodes(), "empty-handle, empty-handle, empty-handle, empty-handle");
  EXPECT_STREQ(lacquer_shader_id(nullptr), "");
  EXPECT_STREQ(lacquer_shader_text(nullptr, "essl", LACQUER_FRAGMENT, nullptr), "");
  EXPECT_EQ(lacquer_shader_spirv(nullptr, LACQUER_FRAGMENT, nullptr), nullptr);
  EXPECT_EQ(lacquer_shader_uniform_size(nullptr), 0u);
  EXPECT_EQ(lacquer_shader_block_count(nullptr), 0u);
  EXPECT_EQ(lacquer_shader_texture(nullptr, 0, nullptr, 0), 0);
  EXPECT_EQ(lacquer_graph_texture_count(nullptr), 0u);
  EXPECT_EQ(lacquer_shader_pack(nullptr, nullptr, 0, nullptr, 0, messages_), 0);
  EXPECT_EQ(messages_.takeCodes(), "empty-handle");
  EXPECT_EQ(lacquer_scene_load(nullptr, nullptr, nullptr), nullptr);
  EXPECT_EQ(lacquer_messages_count(nullptr), 0u);
  EXPECT_EQ(lacquer_message_level(nullptr, 0), -1);
  lacquer_scene_free(nullptr);
  lacquer_text_free(nullptr);
}

TEST_F(CCalls, indicesThatDoNotExistGiveNothing) {
  const size_t count = lacquer_scene_material_count(scene_.get());
  EXPECT_GT(count, 0u);
  EXPECT_STREQ(lacquer_scene_material_name(scene_.get(), count, nullptr), "");
  EXPECT_EQ(lacquer_scene_use_count(scene_.get(), count), 0u);
  EXPECT_EQ(lacquer_scene_use(scene_.get(), 0, 99), 0u);
  EXPECT_EQ(lacquer_scene_graph(scene_.get(), count, 1, nullptr, messages_), nullptr);
  uint8_t rgb[3 * 16 * 16];
  EXPECT_EQ(lacquer_scene_preview(scene_.get(), count, 16, rgb, sizeof rgb, nullptr, messages_), 0);
  EXPECT_EQ(lacquer_scene_evaluate(scene_.get(), count, "[{}]", 4, LACQUER_DOUBLE, nullptr, messages_),
            nullptr);
  EXPECT_EQ(messages_.takeCodes(), "no-such-material, no-such-material, no-such-material");
  for (const int engine : {77, -1, 300}) {
    EXPECT_EQ(lacquer_scene_evaluate(scene_.get(), 0, "[{}]", 4, engine, nullptr, messages_), nullptr);
    const std::string said = lacquer_message_part(messages_, 0, LACQUER_MESSAGE_WHAT, nullptr);
    EXPECT_NE(said.find(std::to_string(engine)), std::string::npos) << said;
    EXPECT_EQ(messages_.takeCodes(), "unknown-enumerator");
  }
}

TEST_F(CCalls, messagesHaveTheirParts) {
  const std::string broken = R"({"asset": )";
  EXPECT_EQ(lacquer_scene_read(broken.data(), broken.size(), "broken.gltf", nullptr, messages_), nullptr);
  ASSERT_EQ(lacquer_messages_count(messages_), 1u);
  EXPECT_EQ(lacquer_messages_have_error(messages_), 1);
  EXPECT_EQ(lacquer_message_level(messages_, 0), LACQUER_ERROR);
  EXPECT_STREQ(lacquer_message_part(messages_, 0, LACQUER_MESSAGE_FILE, nullptr), "broken.gltf");
  EXPECT_EQ(lacquer_message_line(messages_, 0), 1u);
  EXPECT_GT(lacquer_message_column(messages_, 0), 0u);
  size_t size = 0;
  const char* text = lacquer_message_part(messages_, 0, LACQUER_MESSAGE_TEXT, &size);
  EXPECT_EQ(std::strlen(text), size);
  EXPECT_NE(std::string(text).find("broken.gltf:1:"), std::string::npos) << text;
  EXPECT_STREQ(lacquer_message_part(messages_, 0, 99, nullptr), "");
}

TEST_F(CCalls, optionsAreReadAndRefused) {
  for (const char* wrong : {R"({"ibl": 1})", R"({"targets": ["pascal"]})", R"({"lights": {"point": -1}})",
                            R"({"parameters": "fixed"})", R"([])"}) {
    EXPECT_EQ(optionsFrom(wrong, messages_), nullptr) << wrong;
    EXPECT_EQ(messages_.takeCodes(), "wrong-type") << wrong;
  }
  EXPECT_EQ(optionsFrom(R"({"colour": 1})", messages_), nullptr);
  EXPECT_EQ(messages_.takeCodes(), "unknown-option");
  const COptions empty = optionsFrom("", messages_);
  EXPECT_NE(empty, nullptr);
  options_ =
      optionsFrom(R"({"targets": ["hlsl"], "ibl": false, "lights": {"directional": 1}, "validate": false,
                             "profile": "openpbr", "parameters": "baked"})",
                  messages_);
  ASSERT_NE(options_, nullptr) << messages_.takeCodes();
  const CGraph graph = graphOf(0);
  const CShader shader(lacquer_graph_generate(graph.get(), options_.get(), messages_));
  EXPECT_EQ(messages_.takeCodes(), "");
  const std::string text = lacquer_shader_text(shader.get(), "hlsl", LACQUER_FRAGMENT, nullptr);
  EXPECT_NE(text, "");
  EXPECT_EQ(text.find("environment_specular"), std::string::npos);
  EXPECT_EQ(text.find("for ("), std::string::npos) << "one light needs no loop";
  EXPECT_EQ(lacquer_shader_uniform_size(shader.get()), 0u);
  EXPECT_STREQ(lacquer_shader_text(shader.get(), "essl", LACQUER_FRAGMENT, nullptr), "");
}

TEST_F(CCalls, aGraphIsEditedAndChecked) {
  const CGraph graph = graphOf(0);
  const std::string before = textOf(CText(lacquer_graph_json(graph.get())));
  const CGraph again(lacquer_graph_read(before.data(), before.size(), "again.json", messages_));
  EXPECT_EQ(textOf(CText(lacquer_graph_json(again.get()))), before);
  EXPECT_NE(textOf(CText(lacquer_graph_dot(graph.get()))).find("digraph"), std::string::npos);
  const Json parameters = Json::parse(textOf(CText(lacquer_graph_parameters(graph.get()))));
  const std::string name = parameters[0]["name"];
  const std::vector<double> numbers(parameters[0]["value"].is_array() ? parameters[0]["value"].size() : 1,
                                    0.25);
  EXPECT_EQ(lacquer_graph_set_parameter(graph.get(), name.c_str(), numbers.data(), numbers.size(), messages_),
            1);
  EXPECT_EQ(lacquer_graph_set_parameter(graph.get(), name.c_str(), numbers.data(), 9000, messages_), 0);
  EXPECT_EQ(messages_.takeCodes(), "wrong-count");
  EXPECT_EQ(lacquer_graph_set_range(graph.get(), name.c_str(), 1, 0, 0, messages_), 0);
  EXPECT_EQ(messages_.takeCodes(), "wrong-range");
  EXPECT_EQ(lacquer_graph_add_node(graph.get(), "mine", "schlick", messages_), 1);
  EXPECT_EQ(lacquer_graph_connect(graph.get(), "mine", "F0", "0.04", messages_), 1);
  EXPECT_EQ(lacquer_graph_connect(graph.get(), "nobody", "F0", "0.04", messages_), 0);
  EXPECT_EQ(lacquer_graph_set_output(graph.get(), "alpha", "[1", messages_), 0);
  EXPECT_EQ(lacquer_graph_remove_node(graph.get(), "mine", messages_), 1);
  EXPECT_EQ(lacquer_graph_remove_node(graph.get(), "mine", messages_), 0);
  messages_.takeCodes();
  EXPECT_EQ(lacquer_graph_check(graph.get(), nullptr, messages_), 1) << messages_.takeCodes();
  EXPECT_EQ(lacquer_graph_set_output(graph.get(), "nowhere", "1", messages_), 0);
  EXPECT_NE(messages_.takeCodes(), "");
  // What takes values from a node that is gone is the check's to say.
  const Json nodes = Json::parse(textOf(CText(lacquer_graph_nodes(graph.get(), nullptr))));
  for (const Json& node : nodes)
    EXPECT_EQ(lacquer_graph_remove_node(graph.get(), node["id"].get<std::string>().c_str(), messages_), 1);
  EXPECT_EQ(lacquer_graph_check(graph.get(), nullptr, messages_), 0);
  EXPECT_NE(messages_.takeCodes(), "");
  EXPECT_EQ(lacquer_graph_generate(graph.get(), options_.get(), messages_), nullptr);
}

TEST_F(CCalls, aGraphIsListed) {
  const CGraph graph = graphOf(0);
  const auto json = [](lacquer_text* text) { return Json::parse(textOf(CText(text))); };
  const Json nodes = json(lacquer_graph_nodes(graph.get(), nullptr));
  ASSERT_FALSE(nodes.empty());
  const std::string id = nodes[0]["id"];
  const Json sockets = json(lacquer_graph_sockets(graph.get(), id.c_str(), messages_));
  EXPECT_FALSE(sockets["outputs"].empty());
  const Json ports = json(lacquer_graph_sockets(graph.get(), nullptr, messages_));
  EXPECT_TRUE(ports["outputs"].empty());
  size_t connected = 0;
  for (const Json& port : ports["inputs"]) connected += port["source"].is_null() ? 0 : 1;
  const Json outputs = json(lacquer_graph_outputs(graph.get(), nullptr));
  EXPECT_EQ(connected, outputs.size());
  const char* const names[] = {id.c_str()};
  EXPECT_EQ(lacquer_graph_make_group(graph.get(), names, 1, "folded", "it", messages_), 1);
  EXPECT_EQ(json(lacquer_graph_groups(graph.get())), Json::parse(R"(["folded"])"));
  EXPECT_EQ(json(lacquer_graph_nodes(graph.get(), "folded")).size(), 1u);
  EXPECT_FALSE(json(lacquer_graph_outputs(graph.get(), "folded")).empty());
  EXPECT_EQ(lacquer_graph_add_instance(graph.get(), "again", "folded", messages_), 1);
  EXPECT_EQ(lacquer_graph_rename_node(graph.get(), "again", "more", messages_), 1);
  EXPECT_EQ(lacquer_graph_disconnect(graph.get(), "more", "nothing", messages_), 0);
  EXPECT_EQ(messages_.takeCodes(), "not-connected");
  EXPECT_EQ(lacquer_graph_remove_node(graph.get(), "more", messages_), 1);
  EXPECT_EQ(lacquer_graph_expand(graph.get(), "it", messages_), 1);
  EXPECT_EQ(lacquer_graph_expand(graph.get(), "nobody", messages_), 0);
  EXPECT_EQ(lacquer_graph_sockets(graph.get(), "nobody", messages_), nullptr);
  EXPECT_EQ(messages_.takeCodes(), "no-such-node, no-such-node");
  const CGraph other = graphOf(0);
  EXPECT_EQ(lacquer_graph_add_group(graph.get(), "whole", other.get(), messages_), 1);
  EXPECT_EQ(lacquer_graph_remove_output(graph.get(), outputs.begin().key().c_str(), messages_), 1);
  EXPECT_EQ(messages_.takeCodes(), "");
  EXPECT_EQ(lacquer_graph_nodes(nullptr, nullptr), nullptr);
  EXPECT_EQ(lacquer_graph_changes(nullptr), LACQUER_CHANGED_PROGRAM);
}

TEST_F(CCalls, aDumpStopsAfterAPass) {
  const CGraph graph = graphOf(0);
  const std::string lowered = textOf(CText(lacquer_graph_dump(graph.get(), "lower", nullptr, messages_)));
  const std::string last = textOf(CText(lacquer_graph_dump(graph.get(), "", nullptr, messages_)));
  EXPECT_NE(lowered, "");
  EXPECT_NE(lowered, last);
  EXPECT_EQ(lacquer_graph_dump(graph.get(), "polish", nullptr, messages_), nullptr);
  EXPECT_EQ(messages_.takeCodes(), "unknown-pass");
}

TEST_F(CCalls, packTakesValuesByName) {
  const CGraph graph = graphOf(0);
  const CShader shader(lacquer_graph_generate(graph.get(), options_.get(), messages_));
  const size_t size = lacquer_shader_uniform_size(shader.get());
  ASSERT_GT(size, 0u);
  std::vector<uint8_t> todays(size), changed(size), same(size);
  const double quarter = 0.25;
  const double three[] = {1, 2, 3};
  const lacquer_value roughness{"coat_roughness_factor", &quarter, 1};
  const lacquer_value stranger{"no_such_factor", &quarter, 1};
  const lacquer_value wrong{"coat_roughness_factor", three, 3};
  EXPECT_EQ(lacquer_shader_pack(shader.get(), nullptr, 0, todays.data(), size, messages_), 1);
  EXPECT_EQ(lacquer_shader_pack(shader.get(), &roughness, 1, changed.data(), size, messages_), 1);
  EXPECT_EQ(lacquer_shader_pack(shader.get(), &stranger, 1, same.data(), size, messages_), 1);
  EXPECT_EQ(same, todays);
  EXPECT_NE(changed, todays);
  EXPECT_EQ(messages_.takeCodes(), "");
  EXPECT_EQ(lacquer_shader_pack(shader.get(), &wrong, 1, changed.data(), size, messages_), 0);
  EXPECT_EQ(lacquer_shader_pack(shader.get(), nullptr, 0, changed.data(), size - 1, messages_), 0);
  EXPECT_EQ(lacquer_shader_pack(shader.get(), nullptr, 0, nullptr, size, messages_), 0);
  EXPECT_EQ(messages_.takeCodes(), "wrong-count, block-too-small, block-too-small");
}

TEST_F(CCalls, packSaysWhatItDoesNotTake) {
  const CGraph graph = graphOf(0);
  const CShader shader(lacquer_graph_generate(graph.get(), options_.get(), messages_));
  const size_t size = lacquer_shader_uniform_size(shader.get());
  const auto packed = [&](double roughness) {
    std::vector<uint8_t> block(size);
    const lacquer_value value{"coat_roughness_factor", &roughness, 1};
    EXPECT_EQ(lacquer_shader_pack(shader.get(), &value, 1, block.data(), size, messages_), 1);
    return block;
  };
  const std::vector<uint8_t> roughest = packed(1);
  EXPECT_EQ(messages_.takeCodes(), "");
  EXPECT_EQ(packed(1e300), roughest);
  EXPECT_EQ(packed(std::numeric_limits<double>::infinity()), roughest);
  EXPECT_EQ(packed(1.5), roughest);
  EXPECT_EQ(messages_.takeCodes(), "out-of-range, out-of-range, out-of-range");
  std::vector<uint8_t> todays(size);
  EXPECT_EQ(lacquer_shader_pack(shader.get(), nullptr, 0, todays.data(), size, messages_), 1);
  EXPECT_EQ(packed(std::nan("")), todays);
  EXPECT_EQ(messages_.takeCodes(), "not-a-number");
}

TEST_F(CCalls, aMaterialIsEvaluatedAndDrawn) {
  const std::string path = (sourceFolder() / "examples/coat.gltf").string();
  scene_.reset(lacquer_scene_load(path.c_str(), options_.get(), messages_));  // with its images
  const std::string points = R"([{"v": [0, 0, 1], "l": [0, 0.6, 0.8]}])";
  const Json answer = Json::parse(textOf(CText(lacquer_scene_evaluate(
      scene_.get(), 0, points.data(), points.size(), LACQUER_FLOAT, options_.get(), messages_))));
  EXPECT_EQ(answer["engine"], "float");
  EXPECT_GT(answer["rgba"][0][0].get<double>(), 0);
  constexpr uint32_t kPixels = 16;
  std::vector<uint8_t> rgb(3 * kPixels * kPixels);
  EXPECT_EQ(
      lacquer_scene_preview(scene_.get(), 0, kPixels, rgb.data(), rgb.size(), options_.get(), messages_), 1);
  const size_t middle = 3 * (kPixels * kPixels / 2 + kPixels / 2);
  EXPECT_NE(rgb[0], rgb[middle]) << "the ball is not the background";
  EXPECT_EQ(lacquer_scene_preview(scene_.get(), 0, kPixels, rgb.data(), 5, options_.get(), messages_), 0);
  EXPECT_EQ(lacquer_scene_preview(scene_.get(), 0, 1, rgb.data(), rgb.size(), options_.get(), messages_), 0);
  EXPECT_EQ(lacquer_scene_preview(scene_.get(), 0, 0, rgb.data(), rgb.size(), options_.get(), messages_), 0);
  EXPECT_EQ(messages_.takeCodes(), "block-too-small, out-of-range, out-of-range");
}

TEST_F(CCalls, aGraphIsEvaluatedAndDrawnAsItsMaterial) {
  const std::string path = (sourceFolder() / "examples/coat.gltf").string();
  scene_.reset(lacquer_scene_load(path.c_str(), options_.get(), messages_));
  constexpr uint32_t kAll = 0x7F;  // NORMAL to TEXCOORD_3, which points have
  const CGraph graph(lacquer_scene_graph(scene_.get(), 0, kAll, options_.get(), messages_));
  const std::string points = R"([{"v": [0, 0, 1], "l": [0, 0.6, 0.8], "env": [1, 1, 1]}])";
  const auto of_graph = [&](int engine) {
    return textOf(CText(lacquer_graph_evaluate(graph.get(), points.data(), points.size(), engine,
                                               options_.get(), messages_)));
  };
  const Json expected = Json::parse(textOf(CText(lacquer_scene_evaluate(
      scene_.get(), 0, points.data(), points.size(), LACQUER_DOUBLE, options_.get(), messages_))));
  const Json answer = Json::parse(of_graph(LACQUER_DOUBLE));
  EXPECT_EQ(answer["rgba"], expected["rgba"]);
  EXPECT_FALSE(answer.contains("profile"));
  constexpr uint32_t kPixels = 16;
  std::vector<uint8_t> of_scene(3 * kPixels * kPixels), rgb(of_scene.size());
  EXPECT_EQ(lacquer_scene_preview(scene_.get(), 0, kPixels, of_scene.data(), of_scene.size(), options_.get(),
                                  messages_),
            1);
  EXPECT_EQ(lacquer_graph_preview(graph.get(), kPixels, rgb.data(), rgb.size(), options_.get(), messages_),
            1);
  EXPECT_EQ(rgb, of_scene);
  EXPECT_EQ(messages_.takeCodes(), "");
  EXPECT_EQ(of_graph(77), "");
  EXPECT_EQ(lacquer_graph_evaluate(nullptr, points.data(), points.size(), 0, nullptr, messages_), nullptr);
  EXPECT_EQ(lacquer_graph_preview(nullptr, kPixels, rgb.data(), rgb.size(), nullptr, messages_), 0);
  EXPECT_EQ(lacquer_graph_preview(graph.get(), kPixels, rgb.data(), 5, nullptr, messages_), 0);
  EXPECT_EQ(messages_.takeCodes(), "unknown-enumerator, empty-handle, empty-handle, block-too-small");
}

TEST_F(CCalls, aSceneFromMemoryReadsNoFiles) {
  const std::string path = (sourceFolder() / "examples/car_paint.gltf").string();
  const std::string bytes = readFile(path);
  const CScene from_file(lacquer_scene_load(path.c_str(), nullptr, messages_));
  const CScene from_memory(lacquer_scene_read(bytes.data(), bytes.size(), path.c_str(), nullptr, messages_));
  const std::string points = R"([{}])";
  EXPECT_NE(CText(lacquer_scene_evaluate(from_file.get(), 0, points.data(), points.size(), LACQUER_DOUBLE,
                                         nullptr, messages_)),
            nullptr)
      << messages_.takeCodes();
  EXPECT_EQ(CText(lacquer_scene_evaluate(from_memory.get(), 0, points.data(), points.size(), LACQUER_DOUBLE,
                                         nullptr, messages_)),
            nullptr);
  EXPECT_NE(messages_.takeCodes().find("image-missing"), std::string::npos);
}

TEST_F(CCalls, theLibraryTellsItsNodesAndTables) {
  const Json nodes = Json::parse(textOf(CText(lacquer_nodes(nullptr, messages_))));
  EXPECT_FALSE(nodes["nodes"].empty());
  std::vector<float> pairs(2 * 8 * 8);
  EXPECT_EQ(lacquer_environment_dfg(8, pairs.data(), pairs.size(), messages_), 1);
  EXPECT_GT(pairs[0] + pairs[1], 0.5F);
  EXPECT_EQ(lacquer_environment_sheen(8, pairs.data(), pairs.size(), messages_), 1);
  EXPECT_EQ(lacquer_environment_dfg(8, pairs.data(), 3, messages_), 0);
  EXPECT_EQ(lacquer_environment_dfg(1, pairs.data(), pairs.size(), messages_), 0);
  EXPECT_EQ(messages_.takeCodes(), "block-too-small, out-of-range");
}

}  // namespace
}  // namespace lacquer::test::calls_test
