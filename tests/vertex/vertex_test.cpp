// The vertex stage that the facts of a primitive choose: its own SPIR-V runs on
// Vulkan and gives what glTF says of a vertex. A vertex stage's outputs cannot
// be read back, so the stage is renamed: the words of its functions stay.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <set>

#include "lacquer.h"
#include "reference.h"
#include "vulkan/run.h"

namespace lacquer::test::vertex_test {
namespace {

using Json = nlohmann::json;

const vulkan::Device* device() {
  static const Result<vulkan::Device> kDevice = vulkan::Device::open();
  return kDevice ? &*kDevice : nullptr;
}

struct Kind {
  const char* name;
  bool skin4, skin8, morph, instances, quantized;
};

/// A file with one mesh of that kind and a material that reads position,
/// normal, tangent and a texture.
std::string fileOf(const Kind& kind) {
  Json attributes = {{"POSITION", kind.quantized ? 3 : 0},
                     {"NORMAL", 0},
                     {"TANGENT", 1},
                     {"TEXCOORD_0", kind.quantized ? 4 : 5}};
  if (kind.skin4 || kind.skin8) attributes.update({{"JOINTS_0", 2}, {"WEIGHTS_0", 1}});
  if (kind.skin8) attributes.update({{"JOINTS_1", 2}, {"WEIGHTS_1", 1}});
  Json primitive = {{"attributes", attributes}, {"material", 0}};
  if (kind.morph)
    primitive["targets"] = {{{"POSITION", 0}, {"NORMAL", 0}, {"TANGENT", 0}}, {{"POSITION", 0}}};
  Json node = {{"mesh", 0}};
  if (kind.instances) node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", 0}};
  const Json file = {{"asset", {{"version", "2.0"}}},
                     {"extensionsUsed", {"KHR_mesh_quantization", "EXT_mesh_gpu_instancing"}},
                     {"accessors",
                      {{{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
                       {{"componentType", 5126}, {"count", 3}, {"type", "VEC4"}},
                       {{"componentType", 5121}, {"count", 3}, {"type", "VEC4"}},
                       {{"componentType", 5123}, {"count", 3}, {"type", "VEC3"}},
                       {{"componentType", 5121}, {"count", 3}, {"type", "VEC2"}},
                       {{"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}}},
                     {"images", {{{"uri", "n.png"}}}},
                     {"textures", {{{"source", 0}}}},
                     {"materials", {{{"name", "m"}, {"normalTexture", {{"index", 0}}}}}},
                     {"meshes", {{{"primitives", {primitive}}}}},
                     {"nodes", {node}}};
  return file.dump();
}

struct Made {
  Graph graph;
  Shader shader;
  Attributes attributes;
  Json interface;
};

Made madeOf(const Kind& kind, Options options) {
  Messages messages;
  Made made;
  const Scene scene = Scene::fromMemory(fileOf(kind), "mesh.gltf", options, messages);
  EXPECT_TRUE(scene);
  made.attributes = scene.uses(0).at(0);
  made.graph = scene.graph(0, made.attributes, options, messages);
  made.shader = made.graph.generate(options, messages);
  EXPECT_TRUE(made.shader);
  for (const Message& message : messages) EXPECT_NE(message.level, Message::Level::Error) << message.text;
  made.interface = Json::parse(made.shader.interfaceJson());
  return made;
}

std::set<std::string> inputsOf(const Made& made) {
  std::set<std::string> names;
  for (const Json& input : made.interface["inputs"]) names.insert(input["name"]);
  return names;
}

/// A vertex stage as a fragment stage: the execution model, the origin that one
/// must name, and the position at a location of its own.
std::vector<uint32_t> renamed(const std::vector<uint32_t>& words, uint32_t position) {
  constexpr uint32_t kEntryPoint = 15, kExecutionMode = 16, kDecorate = 71;
  constexpr uint32_t kFragment = 4, kOriginUpperLeft = 7, kLocation = 30, kBuiltIn = 11;
  std::vector<uint32_t> out(words.begin(), words.begin() + 5);
  for (size_t at = 5; at < words.size();) {
    const uint32_t count = words[at] >> 16U;
    std::vector<uint32_t> one(words.begin() + static_cast<ptrdiff_t>(at),
                              words.begin() + static_cast<ptrdiff_t>(at + count));
    at += count;
    const uint32_t op = one[0] & 0xFFFFU;
    if (op == kEntryPoint) one[1] = kFragment;
    if (op == kDecorate && one[2] == kBuiltIn && one[3] == 0)
      one = {4U << 16U | kDecorate, one[1], kLocation, position};
    out.insert(out.end(), one.begin(), one.end());
    if (op == kEntryPoint) out.insert(out.end(), {3U << 16U | kExecutionMode, one[2], kOriginUpperLeft});
  }
  return out;
}

/// Where the GLSL of the stage, which has the same interface, says that an
/// output lies.
std::map<std::string, uint32_t> outputsOf(const std::string& glsl) {
  std::map<std::string, uint32_t> outputs;
  const std::regex line(R"(layout\(location = (\d+)\) out \w+ (\w+);)");
  for (std::sregex_iterator it(glsl.begin(), glsl.end(), line), end; it != end; ++it)
    outputs[(*it)[2]] = static_cast<uint32_t>(std::stoul((*it)[1]));
  return outputs;
}

class Numbers {
public:
  double in(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random_); }
  Vec3 vector(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
  /// Far from singular; mirrored now and then.
  Matrix matrix() {
    Matrix m{};
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 4; ++c)
        m[r][c] = in(-0.3, 0.3) + (r == c ? in(0.8, 1.6) : 0.0) + (c == 3 ? in(-1, 1) : 0);
    }
    return m;
  }

private:
  std::mt19937 random_{7};
};

constexpr size_t kVertices = 40;
constexpr size_t kJoints = 11;

Mesh meshOf(const Kind& kind, bool mirrored) {
  Numbers numbers;
  Mesh mesh;
  mesh.skinned = kind.skin4 || kind.skin8;
  mesh.morphed = kind.morph;
  mesh.instanced = kind.instances;
  mesh.model = numbers.matrix();
  for (size_t j = 0; j < kJoints; ++j) {
    mesh.joints.push_back(numbers.matrix());
    if (mirrored) {
      for (double& x : mesh.joints.back()[0]) x = -x;
    }
  }
  for (size_t i = 0; i < kVertices; ++i) {
    Vertex v;
    v.position = numbers.vector(2);
    if (kind.quantized)
      v.position = {std::floor(numbers.in(0, 9)), std::floor(numbers.in(0, 9)), std::floor(numbers.in(0, 9))};
    v.normal = numbers.vector(1);
    const Vec3 t = numbers.vector(1);
    v.tangent = {t[0], t[1], t[2], i % 2 == 0 ? 1.0 : -1.0};
    double sum = 0;
    for (size_t k = 0; k < (kind.skin8 ? 8U : 4U); ++k) {
      v.joint[k] = static_cast<int>(numbers.in(0, kJoints - 0.001));
      sum += v.weight[k] = numbers.in(0, 1);
    }
    for (double& w : v.weight) w /= sum;
    v.translation = numbers.vector(3);
    v.scale = {numbers.in(0.5, 2), numbers.in(0.5, 2), (mirrored ? -1 : 1) * numbers.in(0.5, 2)};
    double length = 0;
    for (double& x : v.rotation) {
      x = numbers.in(-1, 1);
      length += x * x;
    }
    for (double& x : v.rotation) x /= std::sqrt(length);
    mesh.vertices.push_back(v);
  }
  for (size_t t = 0; t < 5; ++t) {
    MorphTarget target;
    for (size_t i = 0; i < kVertices; ++i) {
      target.position.push_back(numbers.vector(0.5));
      target.normal.push_back(numbers.vector(0.2));
      target.tangent.push_back(numbers.vector(0.2));
    }
    mesh.targets.push_back(std::move(target));
    mesh.weights.push_back(t == 2 ? 0 : numbers.in(-0.3, 0.8));
  }
  return mesh;
}

/// What integers are divided by where a vertex format normalizes them; 1: they come as they are.
struct Scales {
  double joint = 1, position = 1, texcoord = 1;
};

constexpr std::array<double, 2> kTexcoord = {3, 200};

/// What the vertices have as an attribute, as floats.
std::vector<float> attributeOf(const Mesh& mesh, const std::string& name, const Scales& scales) {
  std::vector<float> list;
  const auto add = [&](const auto& values) {
    for (const auto x : values) list.push_back(static_cast<float>(x));
  };
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vertex& v = mesh.vertices[i];
    const size_t set = name.back() == '1' ? 4 : 0;
    if (name == "POSITION")
      for (const double x : v.position) list.push_back(static_cast<float>(x / scales.position));
    if (name == "NORMAL") add(v.normal);
    if (name == "TANGENT") add(v.tangent);
    if (name == "TEXCOORD_0")
      for (const double x : kTexcoord) list.push_back(static_cast<float>(x / scales.texcoord));
    if (name.starts_with("JOINTS"))
      for (size_t k = 0; k < 4; ++k) list.push_back(static_cast<float>(v.joint[set + k] / scales.joint));
    if (name.starts_with("WEIGHTS"))
      for (size_t k = 0; k < 4; ++k) list.push_back(static_cast<float>(v.weight[set + k]));
    if (name == "TRANSLATION") add(v.translation);
    if (name == "ROTATION") add(v.rotation);
    if (name == "SCALE") add(v.scale);
    if (name == "MORPH_VERTEX") list.push_back(static_cast<float>(i));
  }
  return list;
}

/// The columns of a matrix in a block.
void columns(const Matrix& m, std::vector<float>& to) {
  for (size_t c = 0; c < 4; ++c) {
    for (size_t r = 0; r < 3; ++r) to.push_back(static_cast<float>(m[r][c]));
    to.push_back(c == 3 ? 1.0F : 0.0F);
  }
}

constexpr uint32_t kMorphWidth = 16;

std::vector<float> fieldOf(const Mesh& mesh, const std::string& name, const Scales& scales) {
  std::vector<float> list;
  if (name == "model") columns(mesh.model, list);
  if (name == "normal_matrix") {
    const std::array<Vec3, 3> n = normalMatrix(mesh.model);
    columns(
        {{{n[0][0], n[0][1], n[0][2], 0}, {n[1][0], n[1][1], n[1][2], 0}, {n[2][0], n[2][1], n[2][2], 0}}},
        list);
  }
  if (name == "view_projection") columns({{{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}}}, list);
  if (name == "joint_count") list = {static_cast<float>(kJoints)};
  if (name == "joint_scale") list = {static_cast<float>(scales.joint)};
  if (name == "position_scale") list = {static_cast<float>(scales.position)};
  if (name == "texcoord_scale") list = {static_cast<float>(scales.texcoord), 1, 1, 1};
  if (name == "width") list = {static_cast<float>(kMorphWidth)};
  if (name == "height") list = {static_cast<float>((kVertices + kMorphWidth - 1) / kMorphWidth)};
  for (size_t t = 0; t < 8 && (name == "weights" || name == "targets"); ++t) {
    const bool there = t < mesh.targets.size();
    list.push_back(!there              ? 0.0F
                   : name == "weights" ? static_cast<float>(mesh.weights[t])
                                       : static_cast<float>(t));
  }
  return list;
}

vulkan::Texture textureOf(const Mesh& mesh, const std::string& name) {
  vulkan::Texture texture;
  std::vector<vulkan::Texel> texels;
  texture.nearest = true;
  texture.s = texture.t = vulkan::Wrap::Clamp;
  const auto texel = [](double x, double y, double z, double w) {
    return vulkan::Texel{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z),
                         static_cast<float>(w)};
  };
  if (name == "joint_matrices") {
    texture.width = 4;
    texture.height = kJoints;
    for (const Matrix& m : mesh.joints) {
      for (const Vec4& row : m) texels.push_back(texel(row[0], row[1], row[2], row[3]));
      texels.push_back(texel(9, 9, 9, 9));
    }
  } else {
    texture.shape = vulkan::Shape::Array;
    texture.width = kMorphWidth;
    texture.height = (kVertices + kMorphWidth - 1) / kMorphWidth;
    for (const MorphTarget& target : mesh.targets) {
      for (const std::vector<Vec3>* layer : {&target.position, &target.normal, &target.tangent}) {
        for (const Vec3& d : *layer) texels.push_back(texel(d[0], d[1], d[2], 7));
        texels.resize((texels.size() + kMorphWidth - 1) / kMorphWidth * kMorphWidth);
      }
    }
  }
  texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(std::move(texels));
  return texture;
}

vulkan::Work workOf(const Made& made, const Mesh& mesh, const Scales& scales, uint32_t position) {
  vulkan::Work work;
  work.fragment = renamed(made.shader.vertexSpirv(), position);
  work.points = mesh.vertices.size();
  std::map<uint32_t, std::string> inputs;
  for (const Json& input : made.interface["inputs"]) inputs[input["location"]] = input["name"];
  for (const auto& [location, name] : inputs) {
    vulkan::Varying varying;
    varying.values = attributeOf(mesh, name, scales);
    varying.components = static_cast<uint32_t>(varying.values.size() / work.points);
    work.inputs.push_back(std::move(varying));
  }
  for (const Json& block : made.interface["uniforms"]) {
    vulkan::UniformBlock bytes;
    bytes.place = {block["set"], block["binding"]};
    bytes.bytes.resize(block["size"]);
    for (const Json& field : block["fields"]) {
      const std::vector<float> values = fieldOf(mesh, field["name"], scales);
      const auto offset = field["offset"].get<size_t>();
      EXPECT_LE(offset + values.size() * 4, bytes.bytes.size());
      if (!values.empty()) std::memcpy(&bytes.bytes[offset], values.data(), values.size() * 4);
    }
    work.blocks.push_back(std::move(bytes));
  }
  for (const Json& slot : made.interface["textures"]) {
    if (slot["role"] != "object") continue;
    vulkan::Texture texture = textureOf(mesh, slot["name"]);
    texture.image = texture.sampler = {slot["set"], slot["binding"]};
    EXPECT_EQ(slot["set"], 2);
    work.textures.push_back(std::move(texture));
  }
  return work;
}

Options quick() {
  Options options;
  options.targets = {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl, Target::Spirv, Target::Wgsl};
  return options;
}

constexpr Kind kKinds[] = {
    {"plain", false, false, false, false, false},    {"skin4", true, false, false, false, false},
    {"skin8", false, true, false, false, false},     {"morph", false, false, true, false, false},
    {"instances", false, false, false, true, false}, {"quantized", false, false, false, false, true},
    {"all", false, true, true, true, true}};
constexpr const Kind& kAll = kKinds[6];

class VertexStage : public testing::TestWithParam<Kind> {};

TEST_P(VertexStage, GivesWhatGltfSays) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const Made made = madeOf(GetParam(), quick());
  const std::map<std::string, uint32_t> outputs = outputsOf(made.shader.vertexText(Target::Glsl));
  ASSERT_TRUE(outputs.contains("v_position") && outputs.contains("v_normal") &&
              outputs.contains("v_tangent"));
  const auto position = static_cast<uint32_t>(outputs.size());
  for (const bool mirrored : {false, true}) {
    const Scales scales =
        mirrored ? Scales{255, GetParam().quantized ? 65535.0 : 1, GetParam().quantized ? 255.0 : 1}
                 : Scales{};
    const Mesh mesh = meshOf(GetParam(), mirrored);
    const Result<vulkan::Outcome> outcome = device()->run(workOf(made, mesh, scales, position));
    ASSERT_TRUE(outcome) << format(outcome.error()[0]);
    const auto near = [&](uint32_t location, size_t i, const Vec3& expected, double size) {
      for (size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(outcome->outputs.at(location)[4 * i + c], expected[c], 2e-5 * size)
            << "vertex " << i << " location " << location << " mirrored " << mirrored;
      }
    };
    for (size_t i = 0; i < kVertices; ++i) {
      const Placed placed = place(mesh, i);
      near(outputs.at("v_position"), i, placed.position, 10);
      near(outputs.at("v_normal"), i, placed.normal, 1);
      near(outputs.at("v_tangent"), i, placed.tangent, 1);
      for (size_t c = 0; c < 2; ++c)
        EXPECT_EQ(outcome->outputs.at(outputs.at("v_uv0"))[4 * i + c], kTexcoord[c]);
      const Vec3& p = placed.position;
      near(position, i, {2 * p[0], 2 * p[1], 2 * p[2]}, 20);
    }
  }
}

/// What is not there has no code, no input, no texture.
TEST_P(VertexStage, DeclaresWhatThePrimitiveHas) {
  const Kind kind = GetParam();
  const Made made = madeOf(kind, quick());
  std::set<std::string> expected = {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"};
  if (kind.skin4 || kind.skin8) expected.insert({"JOINTS_0", "WEIGHTS_0"});
  if (kind.skin8) expected.insert({"JOINTS_1", "WEIGHTS_1"});
  if (kind.morph) expected.insert("MORPH_VERTEX");
  if (kind.instances) expected.insert({"TRANSLATION", "ROTATION", "SCALE"});
  EXPECT_EQ(inputsOf(made), expected);
  std::set<std::string> textures;
  for (const Json& slot : made.interface["textures"]) {
    if (slot["role"] == "object") textures.insert(slot["name"]);
  }
  std::set<std::string> wanted;
  if (kind.skin4 || kind.skin8) wanted.insert("joint_matrices");
  if (kind.morph) wanted.insert("morph_deltas");
  EXPECT_EQ(textures, wanted);
}

/// A graph in its JSON form knows what its primitive has.
TEST_P(VertexStage, SurvivesTheGraphsText) {
  const Made made = madeOf(GetParam(), quick());
  Messages messages;
  Graph again = Graph::fromJson(made.graph.toJson(), "again.json", messages);
  ASSERT_TRUE(again) << messages[0].text;
  EXPECT_EQ(again.generate(quick(), messages).id(), made.shader.id());
}

INSTANTIATE_TEST_SUITE_P(Kinds, VertexStage, testing::ValuesIn(kKinds),
                         [](const auto& info) { return info.param.name; });

TEST(VertexSwitch, decidesInPlaceOfTheFile) {
  const Kind plain = kKinds[0];
  const Kind all = kAll;
  Options options = quick();
  const std::string id = madeOf(plain, options).shader.id();
  options.switches = {
      {"skinning", false}, {"morphing", false}, {"instancing", false}, {"dequantizing", false}};
  const Made without = madeOf(all, options);
  EXPECT_EQ(without.shader.id(), id);
  const Json skipped = Json::parse(without.graph.toJson())["skipped"];
  for (const char* name : {"JOINTS_0", "WEIGHTS_0", "JOINTS_1", "WEIGHTS_1", "MORPH_VERTEX", "TRANSLATION",
                           "ROTATION", "SCALE", "QUANTIZED"})
    EXPECT_TRUE(skipped.contains(name)) << name;
  EXPECT_EQ(skipped["JOINTS_0"], "it is left out (--switch skinning=off)");
  options = quick();
  const std::string everything = madeOf(all, options).shader.id();
  options.switches = {{"skinning", true},
                      {"skinning_8", true},
                      {"morphing", true},
                      {"instancing", true},
                      {"dequantizing", true}};
  EXPECT_EQ(madeOf(plain, options).shader.id(), everything);
  EXPECT_NE(everything, id);
}

/// What is left out is a note of the material, too.
TEST(VertexSwitch, SaysWhatItLeavesOut) {
  Options options = quick();
  options.switches = {{"skinning_8", false}};
  Messages messages;
  const Scene scene = Scene::fromMemory(fileOf(kAll), "mesh.gltf", options, messages);
  ASSERT_TRUE(scene);
  messages.clear();
  const Graph graph = scene.graph(0, scene.uses(0).at(0), options, messages);
  ASSERT_TRUE(graph);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].code, "attribute-left-out");
  EXPECT_EQ(messages[0].level, Message::Level::Note);
  EXPECT_EQ(messages[0].pointer, "/materials/0");
  EXPECT_EQ(
      messages[0].message,
      "a primitive with this material has JOINTS_1, WEIGHTS_1, which its shader does not read: it is left "
      "out (--switch skinning_8=off)");
}

TEST(VertexFacts, ATemplateWithoutThemSaysSo) {
  Options options = quick();
  options.template_name = "bsdf";
  const Json skipped = Json::parse(madeOf(kAll, options).graph.toJson())["skipped"];
  EXPECT_EQ(skipped["WEIGHTS_1"], "the template 'bsdf' does not take it");
  EXPECT_EQ(skipped["MORPH_VERTEX"], "the template 'bsdf' does not take it");
}

}  // namespace
}  // namespace lacquer::test::vertex_test
