// A tool's session through the C interface: a material is edited for a hundred steps. After each one its
// graph has the colours of the file that it is saved to, and all of them together are taken back.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <vector>

#include "handle.h"
#include "support/cases.h"

namespace lacquer::test::session_test {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSteps = 100;
constexpr std::string_view kPoints = R"([{"v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "env": [0.3, 0.2, 0.1]}])";

class CSession : public testing::Test {
protected:
  void SetUp() override {
    const std::string path = (sourceFolder() / "examples/coat.gltf").string();
    options_ = optionsFrom(R"({"targets": ["essl"], "validate": false})");
    const CScene scene(lacquer_scene_load(path.c_str(), options_.get(), messages_));
    // What points have: NORMAL to TEXCOORD_3.
    graph_.reset(lacquer_scene_graph(scene.get(), 0, 127, options_.get(), messages_));
    ASSERT_NE(graph_, nullptr) << messages_.takeCodes();
    Json lookups = Json::array();
    for (const Json& texture : json(lacquer_graph_textures(graph_.get())))
      lookups.push_back(texture["name"].get<std::string>() + "=0.2,0.4,0.6,0.8");
    lookups_ = optionsFrom(Json{{"texels", lookups}}.dump(), messages_);
    make();
  }

  static Json json(lacquer_text* text) { return Json::parse(textOf(CText(text))); }
  size_t pick(size_t count) { return random_() % count; }
  std::string text() const { return textOf(CText(lacquer_graph_json(graph_.get()))); }
  Json nodes() const { return json(lacquer_graph_nodes(graph_.get(), nullptr)); }
  std::string colors(const lacquer_graph* of) {
    return textOf(CText(lacquer_graph_evaluate(of, kPoints.data(), kPoints.size(), LACQUER_DOUBLE,
                                               lookups_.get(), messages_)));
  }
  void make() {
    shader_.reset(lacquer_graph_generate(graph_.get(), options_.get(), messages_));
    ASSERT_NE(shader_, nullptr) << messages_.takeCodes();
    EXPECT_EQ(lacquer_graph_changes(graph_.get()), LACQUER_CHANGED_NOTHING);
  }

  /// What takes values from a node, as the edits that connect it again.
  std::vector<Json> usersOf(const std::string& id) const {
    std::vector<Json> users;
    for (const Json& node : nodes()) {
      for (const auto& [input, source] : node["inputs"].items()) {
        if (source.is_object() && source.value("node", "") == id)
          users.push_back({{"do", "connect"}, {"node", node["id"]}, {"input", input}, {"source", source}});
      }
    }
    const Json outputs = json(lacquer_graph_outputs(graph_.get(), nullptr));
    for (const auto& [output, source] : outputs.items()) {
      if (source.is_object() && source.value("node", "") == id)
        users.push_back({{"do", "set_output"}, {"output", output}, {"source", source}});
    }
    return users;
  }

  /// Another number for a parameter, within what it may be.
  Json setValue() {
    const Json all = json(lacquer_graph_parameters(graph_.get()));
    const Json& parameter = all[pick(all.size())];
    const Json range = parameter.value("range", Json::array({nullptr, nullptr}));
    const double low = range[0].is_null() ? 0 : range[0].get<double>();
    const double high = range[1].is_null() ? low + 1 : range[1].get<double>();
    const auto number = [&] { return low + (high - low) * static_cast<double>(1 + pick(98)) / 100; };
    Json value = parameter["value"];
    if (value.is_array()) {
      for (Json& component : value) component = number();
    } else {
      value = value.is_boolean() ? Json(!value.get<bool>()) : Json(number());
    }
    return {{"do", "set_value"}, {"parameter", parameter["name"]}, {"value", value}};
  }

  /// A node like one that is used, beside it.
  Json addCopy(int number) {
    Json models = Json::array();
    for (const Json& node : nodes()) {
      if (node.contains("node") && !usersOf(node["id"]).empty()) models.push_back(node);
    }
    const Json& model = models[pick(models.size())];
    copied_ = model["id"];
    copy_ = "tool.n" + std::to_string(number);
    return {{"do", "add_node"},
            {"node", {{"id", copy_}, {"node", model["node"]}, {"inputs", model["inputs"]}}}};
  }

  Json useCopy() {
    const std::vector<Json> users = usersOf(copied_);
    Json edit = users[pick(users.size())];
    edit["source"]["node"] = copy_;
    return edit;
  }

  /// An input that has a default has it again, and back; no texture falls out of use.
  Json disconnect() {
    for (const Json& node : nodes()) {
      const Json sockets =
          json(lacquer_graph_sockets(graph_.get(), node["id"].get<std::string>().c_str(), messages_));
      for (const Json& input : sockets["inputs"]) {
        const Json& source = input["source"];
        const bool plain = source.is_number() || (source.is_object() && source.contains("parameter"));
        if (plain && input.value("optional", false) && pick(3) == 0)
          return {{"do", "disconnect"}, {"node", node["id"]}, {"input", input["name"]}};
      }
    }
    return setValue();
  }

  Json step(int number) {
    switch (number % 10) {
      case 1: return addCopy(number);
      case 2: return useCopy();
      case 3: {
        const std::string from = copy_;
        copy_ = "my.n" + std::to_string(number);
        return {{"do", "rename_node"}, {"node", from}, {"to", copy_}};
      }
      case 4: {
        group_ = "group_" + std::to_string(number);
        return {{"do", "make_group"}, {"nodes", {copy_}}, {"group", group_}, {"node", "instance"}};
      }
      case 5: return {{"do", "set_ui"}, {"group", group_}, {"ui", {{"x", number}, {"note", "\u00e4"}}}};
      case 6:
        return Json::array(
            {{{"do", "expand"}, {"node", "instance"}}, {{"do", "remove_group"}, {"group", group_}}});
      case 7: return disconnect();
      default: return setValue();
    }
  }

  /// Nothing is changed by what cannot be done.
  void refused() {
    const std::string before = text();
    lacquer_graph* graph = graph_.get();
    const std::string node = nodes()[0]["id"];
    EXPECT_EQ(lacquer_graph_add_node(graph, node.c_str(), "schlick", messages_), 0);
    EXPECT_EQ(lacquer_graph_connect(graph, node.c_str(), "no_such_input", "1", messages_), 0);
    EXPECT_EQ(lacquer_graph_rename_node(graph, "nobody", "body", messages_), 0);
    EXPECT_EQ(lacquer_graph_set_output(graph, "nowhere", "1", messages_), 0);
    EXPECT_EQ(lacquer_graph_add_instance(graph, "x", "no_such_group", messages_), 0);
    const std::string fly = R"([{"do": "set_name", "name": "x"}, {"do": "fly"}])";
    EXPECT_EQ(lacquer_graph_edit(graph, fly.data(), fly.size(), messages_), nullptr);
    EXPECT_EQ(messages_.takeCodes(),
              "duplicate-name, unknown-input, no-such-node, unknown-port, unknown-group, unknown-edit");
    EXPECT_EQ(text(), before);
  }

  /// With a fresh load of the saved file, and of the shader's block with a new one.
  void compare() {
    const std::string saved = text();
    const CGraph loaded(
        lacquer_graph_read_with(saved.data(), saved.size(), "saved.json", options_.get(), messages_));
    const std::string expected = colors(loaded.get());
    ASSERT_NE(expected, "") << messages_.takeCodes();
    ASSERT_EQ(colors(graph_.get()), expected);
    seen_.insert(expected);
    const int change = lacquer_graph_changes(graph_.get());
    if (change == LACQUER_CHANGED_PROGRAM) return make();
    std::vector<uint8_t> packed(lacquer_shader_uniform_size(shader_.get())), fresh(packed.size());
    EXPECT_EQ(lacquer_shader_pack_graph(shader_.get(), graph_.get(), packed.data(), packed.size(), messages_),
              1);
    const std::string id = lacquer_shader_id(shader_.get());
    make();
    EXPECT_EQ(lacquer_shader_id(shader_.get()), id);
    EXPECT_EQ(lacquer_shader_pack(shader_.get(), nullptr, 0, fresh.data(), fresh.size(), messages_), 1);
    EXPECT_EQ(packed, fresh);
    ++kept_;
  }

  CMessages messages_;
  COptions options_, lookups_;
  CGraph graph_;
  CShader shader_;
  std::mt19937 random_{5};
  std::string copied_, copy_, group_;
  std::set<std::string> seen_;  ///< colours
  int kept_ = 0;                ///< steps after which the shader did as it was
};

TEST_F(CSession, ofAHundredSteps) {
  const std::string start = text();
  std::vector<std::string> back;
  for (int number = 0; number < kSteps; ++number) {
    SCOPED_TRACE("step " + std::to_string(number));
    if (number % 10 == 9) {
      refused();
    } else {
      const std::string edit = step(number).dump();
      const CText done(lacquer_graph_edit(graph_.get(), edit.data(), edit.size(), messages_));
      ASSERT_EQ(messages_.takeCodes(), "") << edit;
      back.push_back(textOf(done));
    }
    compare();
    if (HasFailure()) return;
  }
  EXPECT_GT(kept_, kSteps / 3);
  EXPECT_LT(kept_, kSteps);
  EXPECT_GT(seen_.size(), size_t{kSteps / 10}) << "the steps are to change what is seen";
  for (; !back.empty(); back.pop_back()) {
    const CText done(lacquer_graph_edit(graph_.get(), back.back().data(), back.back().size(), messages_));
    ASSERT_NE(done, nullptr) << messages_.takeCodes();
  }
  EXPECT_EQ(text(), start);
}

TEST_F(CSession, packsIntoBlocksThatAreLargeEnough) {
  std::vector<uint8_t> block(lacquer_shader_uniform_size(shader_.get()));
  ASSERT_GT(block.size(), 0u);
  EXPECT_EQ(lacquer_shader_pack_graph(shader_.get(), graph_.get(), block.data(), block.size() - 1, messages_),
            0);
  EXPECT_EQ(lacquer_shader_pack_graph(shader_.get(), nullptr, block.data(), block.size(), messages_), 0);
  EXPECT_EQ(messages_.takeCodes(), "block-too-small, empty-handle");
}

}  // namespace
}  // namespace lacquer::test::session_test
