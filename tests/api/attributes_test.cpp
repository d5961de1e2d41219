// What vertices and objects have of an application's own reaches a layer in every target, checked by those
// compilers that are there: of any type, integers and bools one vertex's, fields of objects as no value of a
// vertex at all.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "inputs.h"

namespace lacquer::test {
namespace {

constexpr const char* kFile = R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ACME_wet"],
  "materials": [{"name": "Wet", "extensions": {"ACME_wet": {"amount": 0.5}}}]})";

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

/// A layer that takes the attribute, of type T in the file and M in lines.
std::string textOf(const std::string& type, const std::string& read, const std::string& otherwise,
                   const std::string& given_type, const std::string& number) {
  std::string text = R"(
/// An engine's own.
template masked extends forward {
    extend block object {
        float wetness in [0, 1] = 0;
    }
    optional attribute T _MASK;
    given M mask = has_MASK ? READ : OTHERWISE;
    given float wetness in [0, 1] = object.wetness;
}
/// E.
/// source: ACME_wet
extension ACME_wet {
    float amount in [0, 1] = 0;
}
/// P.
/// source: ACME_wet
part wet of ACME_wet over coat unless amount == 0 {
direct:
    out direct = wetted(below.direct, amount, mask, wetness);
}
/// N.
/// source: ACME_wet
node wetted(vec3 below in [0, inf], float amount in [0, 1], M mask, float wetness in [0, 1]) -> vec3 in [0, inf] {
    float taken = clamp(NUMBER, 0, 1);
    return below * (1 - amount * taken * wetness);
}
)";
  text = replaced(text, "attribute T", "attribute " + type);
  text = replaced(text, "given M", "given " + given_type);
  text = replaced(text, ", M mask", ", " + given_type + " mask");
  text = replaced(text, "READ", read);
  text = replaced(text, "OTHERWISE", otherwise);
  return replaced(text, "NUMBER", number);
}

struct Made {
  Shader shader;
  std::string errors;
};

Made made(const std::string& text, bool has_mask) {
  Options options;
  options.targets.clear();
  for (const std::string& name : targetNames()) {
    Target target{};
    EXPECT_TRUE(findTarget(name, target));
    options.targets.push_back(target);
  }
  options.node_texts = {{"wet.node", text}};
  options.template_name = "masked";
  Messages messages;
  const Scene scene = Scene::fromMemory(kFile, "wet.gltf", options, messages);
  Attributes attributes = kUnusedAttributes;
  if (has_mask) attributes.application = {"_MASK"};
  Graph graph = scene.graph(0, attributes, options, messages);
  Made result;
  result.shader = graph.generate(options, messages);
  for (const Message& message : messages) {
    if (message.level == Message::Level::Error) result.errors += message.text + "\n";
  }
  return result;
}

size_t countOf(const std::string& text, std::string_view what) {
  size_t count = 0;
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

struct Kind {
  std::string type, read, otherwise, given_type, number;
  size_t flat = 0;  ///< values between the stages that are one vertex's
};

TEST(OwnAttributes, OfAnyTypeReachEveryTarget) {
  const Kind kinds[] = {
      {"float", "interpolate(_MASK)", "1", "float", "mask", 0},
      {"vec2", "interpolate(_MASK)", "vec2(1)", "vec2", "mask.x * mask.y", 0},
      {"vec3", "interpolate(_MASK)", "vec3(1)", "vec3", "mask.x * mask.z", 0},
      {"vec4", "interpolate(_MASK)", "vec4(1)", "vec4", "mask.x * mask.w", 0},
      {"int", "interpolate(_MASK)", "1", "int", "float(mask)", 1},
      {"uint", "interpolate(_MASK)", "1u", "uint", "float(mask & 3u)", 1},
      {"ivec2", "interpolate(_MASK)", "ivec2(1)", "ivec2", "float(mask.x + mask.y)", 2},
      {"ivec3", "interpolate(_MASK)", "ivec3(1)", "ivec3", "float(mask.x + mask.z)", 2},
      {"ivec4", "interpolate(_MASK)", "ivec4(1)", "ivec4", "float(mask.w)", 1},
      {"uvec2", "interpolate(_MASK)", "uvec2(1u)", "uvec2", "float(mask.x)", 1},
      {"uvec3", "interpolate(_MASK + uvec3(1u))", "uvec3(1u)", "uvec3", "float(mask.y)", 1},
      {"uvec4", "interpolate(_MASK)", "uvec4(1u)", "uvec4", "float(mask.z)", 1},
      {"float", "interpolate(_MASK > 0.5)", "true", "bool", "mask ? 1.0 : 0.5", 1},
      {"uint", "interpolate((_MASK & 4u) != 0u)", "true", "bool", "mask ? 1.0 : 0.5", 1},
  };
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(kind.type + " " + kind.read);
    const std::string text = textOf(kind.type, kind.read, kind.otherwise, kind.given_type, kind.number);
    const Made masked = made(text, true);
    ASSERT_TRUE(masked.shader) << masked.errors;
    EXPECT_EQ(masked.errors, "");
    const auto codeOf = [&](Target target) { return masked.shader.fragmentText(target); };
    EXPECT_EQ(countOf(codeOf(Target::Glsl), "flat in "), kind.flat) << codeOf(Target::Glsl);
    EXPECT_EQ(countOf(codeOf(Target::Essl), "flat in "), kind.flat);
    EXPECT_EQ(countOf(codeOf(Target::Hlsl), "nointerpolation "), kind.flat);
    EXPECT_EQ(countOf(codeOf(Target::Wgsl), "@interpolate(flat) "), kind.flat);
    // Metal has no other integers between the stages, and does not ask for the word.
    EXPECT_GE(countOf(codeOf(Target::Msl), "[[user("), kind.flat) << codeOf(Target::Msl);
    EXPECT_GE(countOf(codeOf(Target::Msl), "mask"), 2U);
    // Without the attribute nothing is between the stages.
    const Made plain = made(text, false);
    ASSERT_TRUE(plain.shader) << plain.errors;
    EXPECT_EQ(plain.errors, "");
    const std::string glsl = plain.shader.fragmentText(Target::Glsl);
    EXPECT_EQ(countOf(glsl, "flat in "), 0U);
    EXPECT_EQ(countOf(plain.shader.vertexText(Target::Glsl), "in_mask"), 0U);
  }
}

TEST(OwnAttributes, FieldsOfObjectsAreNoValuesOfVertices) {
  const std::string text = textOf("float", "interpolate(_MASK)", "1", "float", "mask");
  const Made wet = made(text, false);
  const Made dry = made(replaced(text, "taken * wetness", "taken * 0.5"), false);
  ASSERT_TRUE(wet.shader && dry.shader) << wet.errors << dry.errors;
  EXPECT_EQ(wet.errors + dry.errors, "");
  const auto inputs = [](const Shader& shader) {
    return countOf(shader.fragmentText(Target::Glsl), ") in ");
  };
  EXPECT_EQ(inputs(wet.shader), inputs(dry.shader));
  for (const Target target : {Target::Glsl, Target::Essl, Target::Hlsl, Target::Wgsl, Target::Msl}) {
    EXPECT_EQ(countOf(dry.shader.fragmentText(target), "object.wetness"), 0U);
    EXPECT_GE(countOf(wet.shader.fragmentText(target), "wetness"), 2U) << targetName(target);
  }
}

/// Devices take sixteen attributes: those that a template has behind the sixteen of the one it extends lie
/// where this primitive has none.
TEST(OwnAttributes, OfATemplateLieAtTheFirstFreeLocations) {
  const std::string text = textOf("float", "interpolate(_MASK)", "1", "float", "mask");
  const Made masked = made(text, true);
  ASSERT_TRUE(masked.shader) << masked.errors;
  uint32_t last = 0;
  bool found = false;
  for (const ShaderInput& input : masked.shader.reflection().inputs) {
    last = std::max(last, input.location);
    found |= input.name == "_MASK" || input.name == "MASK";
  }
  EXPECT_TRUE(found);
  EXPECT_LT(last, 16u);
}

/// A material is evaluated with the attributes that its points have.
TEST(OwnAttributes, OfPointsReachMaterials) {
  Options options = quick();
  options.node_texts = {{"wet.node", textOf("float", "interpolate(_MASK)", "1", "float", "mask")}};
  options.template_name = "masked";
  Messages messages;
  const Scene scene = Scene::fromMemory(kFile, "wet.gltf", options, messages);
  const auto redAt = [&](const char* mask) {
    const std::string points =
        std::string(R"({"uniforms": {"object.wetness": 1}, "points": [{"l": [0.6, 0, 0.8])") + mask + "}]}";
    const auto colors = evaluate(scene, 0, points, Engine::Double, {}, options, messages);
    return colors ? colors->rgba.at(0)[0] : -1;
  };
  const double dry = redAt(R"(, "_MASK": 0)");
  EXPECT_GT(dry, 0);
  EXPECT_NEAR(redAt(R"(, "_MASK": 1)"), 0.5 * dry, 1e-12);
  EXPECT_NEAR(redAt(R"(, "_MASK": 0.5)"), 0.75 * dry, 1e-12);
  EXPECT_NEAR(redAt(""), 0.5 * dry, 1e-12) << "as the template has it without the attribute";
  EXPECT_EQ(errorsOf(messages), "");
  EXPECT_EQ(redAt(R"(, "_MASK": [0, 1])"), -1);
  EXPECT_EQ(errorsOf(messages), "wrong-type");
}

/// Integers of points are whole, and have 32 bits.
TEST(OwnAttributes, OfPointsFitTheirType) {
  Options options = quick();
  options.node_texts = {{"wet.node", textOf("int", "interpolate(_MASK)", "1", "int", "float(mask)")}};
  options.template_name = "masked";
  Messages messages;
  const Scene scene = Scene::fromMemory(kFile, "wet.gltf", options, messages);
  const auto errorsAt = [&](const std::string& mask) {
    Messages said;
    const auto found = evaluate(scene, 0, R"([{"_MASK": )" + mask + "}]", Engine::Double, {}, options, said);
    EXPECT_EQ(found.has_value(), errorsOf(said).empty());
    return errorsOf(said);
  };
  for (const char* mask : {"2147483647", "-2147483648"}) EXPECT_EQ(errorsAt(mask), "") << mask;
  for (const char* mask : {"0.5", "2147483648", "1e300"}) EXPECT_EQ(errorsAt(mask), "wrong-type") << mask;
}

/// A picture is of points that have none: what is not there is 0, of colours 1.
TEST(OwnAttributes, ThatPicturesLackAreZero) {
  constexpr const char* kGraph =
      R"({"lacquer_graph": 1, "name": "worn", "template": "forward", "parameters": {},
    "textures": {}, "nodes": [
      {"id": "worn", "node": "multiply", "inputs": {"in1": {"attribute": "_WORN", "type": "float"}, "in2": 2}},
      {"id": "shade", "node": "multiply", "inputs": {"in1": {"attribute": "COLOR_1", "type": "vec4"}, "in2": 0.5}}],
    "outputs": {"emission": {"node": "shade", "swizzle": "rgb"}, "alpha": {"node": "worn"}}, "skipped": {}})";
  Messages messages;
  const Options options = quick();
  const Graph graph = Graph::fromJson(kGraph, "worn.json", messages, options);
  ASSERT_TRUE(graph) << errorsOf(messages);
  const auto middleOf = [&](const char* node) {
    Trial trial;
    trial.node = node;
    const std::vector<uint8_t> picture = drawBall(graph, 32, {}, options, messages, trial);
    return picture.empty() ? -1 : static_cast<int>(picture[3 * (32 * 16 + 16)]);
  };
  EXPECT_EQ(middleOf("worn"), 0);
  EXPECT_EQ(middleOf("shade"), 191) << "a vector: half of it, from -1 to 1";
  EXPECT_EQ(errorsOf(messages), "");
}

/// A triangle whose mask is stored in that way.
std::string storedAs(const std::string& type, int component, bool normalized = false) {
  return R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ACME_wet"],
  "materials": [{"name": "Wet", "extensions": {"ACME_wet": {"amount": 0.5}}}],
  "accessors": [{"componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 0]},
    {"componentType": )" +
         std::to_string(component) + R"(, "type": ")" + type + R"(", "normalized": )" +
         (normalized ? "true" : "false") + R"(, "count": 3}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "_MASK": 1}, "material": 0}]}]})";
}

/// The warnings of a run.
std::string warningsOf(const std::string& file, const std::string& type) {
  const std::filesystem::path folder = emptyFolder();
  std::ofstream(folder / "wet.gltf") << file;
  Options options = quick();
  options.node_texts = {
      {"wet.node", textOf(type, "interpolate(_MASK)", "1", type, type == "float" ? "mask" : "float(mask)")}};
  options.template_name = "masked";
  Messages messages;
  const Report report =
      generate({(folder / "wet.gltf").string()}, {}, (folder / "out").string(), options, messages);
  EXPECT_TRUE(report.ok) << errorsOf(messages);
  std::string warnings;
  for (const Message& message : messages) {
    if (message.level == Message::Level::Warning) warnings += message.text + "\n";
  }
  return warnings;
}

/// A primitive that stores an attribute otherwise than its shader reads it draws nonsense: it is said.
TEST(OwnAttributes, ThatAreStoredOtherwiseAreSaid) {
  constexpr int kByte = 5120, kUnsignedShort = 5123, kFloat = 5126;
  EXPECT_EQ(warningsOf(storedAs("SCALAR", kFloat), "float"), "");
  EXPECT_EQ(warningsOf(storedAs("SCALAR", kUnsignedShort), "float"), "");
  EXPECT_EQ(warningsOf(storedAs("SCALAR", kUnsignedShort), "int"), "");
  EXPECT_EQ(warningsOf(storedAs("SCALAR", kByte), "int"), "");
  const std::string pair = warningsOf(storedAs("VEC2", kFloat), "float");
  EXPECT_NE(
      pair.find("/meshes/0/primitives/0/attributes/_MASK: warning: _MASK is stored as FLOAT VEC2, and the "
                "shader reads a float [attribute-format]"),
      std::string::npos)
      << pair;
  const std::string floats = warningsOf(storedAs("SCALAR", kFloat), "int");
  EXPECT_NE(floats.find("_MASK is stored as FLOAT SCALAR, and the shader reads an int"), std::string::npos)
      << floats;
  const std::string normal = warningsOf(storedAs("SCALAR", kUnsignedShort, true), "int");
  EXPECT_NE(normal.find("_MASK is stored as normalized UNSIGNED_SHORT SCALAR"), std::string::npos) << normal;
}

/// Integers of vertices and of blocks on a device are what they are on the processor.
TEST(OwnAttributes, IntegersReachADevice) {
  std::string text = textOf("int", "interpolate(_MASK)", "1", "int", "mask == 3 ? 1.0 : 0.25");
  text = replaced(text, "float wetness in [0, 1] = 0;", "uint wetness in [0, 9] = 0;");
  text = replaced(text, "given float wetness in [0, 1] = object.wetness",
                  "given float wetness in [0, 1] = float(object.wetness) * 0.1");
  Options options = quick();
  options.node_texts = {{"wet.node", text}};
  options.template_name = "masked";
  Messages messages;
  const Scene scene = Scene::fromMemory(kFile, "wet.gltf", options, messages);
  Attributes attributes = kUnusedAttributes;
  attributes.application = {"_MASK"};
  Graph graph = scene.graph(0, attributes, options, messages);
  ASSERT_TRUE(graph) << errorsOf(messages);
  Options of_graph = options;  // its template is its own
  of_graph.template_name = {};
  const auto colors = [&](Engine engine) {
    std::vector<std::array<double, 4>> all;
    for (const char* mask : {"3", "2"}) {
      const std::string points =
          fmt::format(R"({{"uniforms": {{"object.wetness": 5}}, "points": [{{"_MASK": {}}}]}})", mask);
      Messages said;
      const std::optional<Evaluation> result = evaluate(graph, points, engine, {}, of_graph, said);
      const std::string errors = errorsOf(said);
      if (errors != "vulkan-unavailable") {
        EXPECT_EQ(errors, "");
      }
      if (result) all.push_back(result->rgba[0]);
    }
    return all;
  };
  const auto cpu = colors(Engine::Float);
  const auto gpu = colors(Engine::Vulkan);
  if (gpu.empty()) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  ASSERT_EQ(cpu.size(), 2U);
  for (size_t i = 0; i < 2; ++i) EXPECT_NEAR(cpu[i][0], gpu[i][0], 1e-4) << i;
  EXPECT_NE(cpu[0][0], cpu[1][0]);
}

}  // namespace
}  // namespace lacquer::test
