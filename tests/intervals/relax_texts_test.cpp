// What targets say of relaxed operations: valid in each, the same in GLSL as in SPIR-V, nothing elsewhere,
// and nothing at all where it is not asked for.
#include <gtest/gtest.h>

#include <spirv/unified1/GLSL.std.450.h>
#include <cmath>
#include <map>
#include <set>
#include <spirv/unified1/spirv.hpp>

#include "check/check.h"
#include "lacquer/generate.h"
#include "support/cases.h"

namespace lacquer::test::relax_texts_test {
namespace {

/// The relaxed operations of a module on scalars, by kind. What moves numbers is none.
std::map<std::string, int> relaxedOperations(const std::vector<uint32_t>& words) {
  std::set<uint32_t> relaxed;
  std::map<uint32_t, int> widths;        // by type
  std::map<uint32_t, uint32_t> type_of;  // by value
  std::map<std::string, int> counts;
  for (size_t at = 5; at < words.size(); at += words[at] >> spv::WordCountShift) {
    const auto op = static_cast<spv::Op>(words[at] & spv::OpCodeMask);
    if (op == spv::OpDecorate && words[at + 2] == spv::DecorationRelaxedPrecision)
      relaxed.insert(words[at + 1]);
    if (op == spv::OpTypeFloat) widths[words[at + 1]] = 1;
    if (op == spv::OpTypeVector) widths[words[at + 1]] = static_cast<int>(words[at + 3]);
    if ((words[at] >> spv::WordCountShift) < 4 || !widths.contains(words[at + 1])) continue;
    type_of[words[at + 2]] = words[at + 1];
    if (!relaxed.contains(words[at + 2])) continue;
    const int width = widths[words[at + 1]];
    switch (op) {
      case spv::OpFMul:
      case spv::OpVectorTimesScalar: counts["product"] += width; break;
      case spv::OpFAdd:
      case spv::OpFSub: counts["sum"] += width; break;
      case spv::OpFDiv: counts["division"] += width; break;
      case spv::OpDot: counts["dot"] += 2 * widths[type_of[words[at + 3]]] - 1; break;
      case spv::OpSelect: counts["choice"] += width; break;
      case spv::OpExtInst:
        // A compiler that has it in two operations fuses none.
        if (words[at + 4] == GLSLstd450Fma) {
          counts["product"] += width, counts["sum"] += width;
        } else if (words[at + 4] != GLSLstd450FAbs) {
          counts["function " + std::to_string(words[at + 4])] += width;
        }
        break;
      default: break;
    }
  }
  return counts;
}

/// What the manifest says of them.
int operationsOf(const Shader& shader) {
  const std::string key = "\"operations\": ";
  const size_t at = shader.interfaceJson().find(key);
  return at == std::string::npos ? 0 : std::stoi(shader.interfaceJson().substr(at + key.size()));
}

/// The lines but for those that name the shader.
std::string withoutId(const std::string& text, const std::string& id) {
  std::string rest;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
    const std::string line = text.substr(at, end - at);
    if (line.find(id) == std::string::npos) rest += line;
    at = end;
  }
  return rest;
}

struct Pair {
  std::string name;
  Shader plain, relaxed;
};

void eachPair(const Options& options, const std::function<void(const Pair&)>& f) {
  std::vector<std::filesystem::path> files = findFiles(sourceFolder() / "examples", ".gltf");
  for (const auto& file : findFiles(sourceFolder() / "bench/works", ".gltf")) files.push_back(file);
  for (const auto& file : files) {
    Messages messages;
    const Scene scene = Scene::load(file.string(), options, messages);
    ASSERT_TRUE(scene) << file;
    for (size_t i = 0; i < scene.materialCount(); ++i) {
      Messages said;
      Graph graph = scene.graph(i, kUnusedAttributes, options, said);
      if (!graph) continue;
      Pair pair{file.filename().string() + " " + scene.materialName(i), {}, {}};
      Options half = options;
      half.relaxed = 0.5;
      Options plain = options;
      plain.validate = false;
      pair.plain = graph.generate(plain, said);
      pair.relaxed = graph.generate(half, said);
      for (const Message& message : said) EXPECT_NE(message.level, Message::Level::Error) << message.text;
      ASSERT_TRUE(pair.plain && pair.relaxed) << pair.name;
      f(pair);
    }
  }
}

TEST(RelaxedTexts, AreValidAndSayTheSame) {
  Options options;
  options.targets = {Target::Glsl, Target::Essl, Target::Spirv};
  options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
  size_t relaxed = 0;
  for (const Parameters parameters : {Parameters::Uniform, Parameters::Baked}) {
    options.parameters = parameters;
    eachPair(options, [&](const Pair& pair) {
      if (pair.plain.id() == pair.relaxed.id()) {
        EXPECT_EQ(pair.plain.fragmentSpirv(), pair.relaxed.fragmentSpirv()) << pair.name;
        return;
      }
      ++relaxed;
      auto written = relaxedOperations(pair.relaxed.fragmentSpirv());
      EXPECT_FALSE(written.empty()) << pair.name;
      // What the rules of GLSL make of the text's precisions, by another compiler.
      const Result<check::Spirv> compiled = check::compile(
          pair.relaxed.fragmentText(Target::Glsl), Target::Glsl, check::Stage::Fragment, "relaxed.frag");
      ASSERT_TRUE(compiled) << pair.name;
      std::map<std::string, int> said = relaxedOperations(*compiled);
      // A choice is a branch to that compiler.
      said["choice"] = written["choice"];
      int all = 0;
      for (const auto& [kind, count] : said) all += count;
      EXPECT_EQ(all, operationsOf(pair.relaxed)) << pair.name;
      // A product that several sums read is part of each of them.
      EXPECT_LE(said["product"], written["product"]) << pair.name;
      said["product"] = written["product"];
      EXPECT_EQ(said, written) << pair.name;
      EXPECT_TRUE(relaxedOperations(pair.plain.fragmentSpirv()).empty());
      EXPECT_EQ(relaxedOperations(pair.relaxed.vertexSpirv()), (std::map<std::string, int>()));
      EXPECT_NE(pair.relaxed.fragmentText(Target::Essl).find("    mediump "), std::string::npos) << pair.name;
      EXPECT_EQ(pair.plain.fragmentText(Target::Essl).find("mediump"), std::string::npos) << pair.name;
      EXPECT_NE(pair.relaxed.interfaceJson().find("\"relaxed\""), std::string::npos) << pair.name;
      EXPECT_EQ(pair.plain.interfaceJson().find("\"relaxed\""), std::string::npos) << pair.name;
    });
  }
  EXPECT_GT(relaxed, 20U);
}

TEST(RelaxedTexts, OtherTargetsStayAsTheyAre) {
  Options options;
  options.targets = {Target::GlslGl, Target::Hlsl, Target::Wgsl, Target::Msl};
  options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
  options.parameters = Parameters::Baked;
  options.validate = false;
  size_t relaxed = 0;
  eachPair(options, [&](const Pair& pair) {
    relaxed += pair.plain.id() != pair.relaxed.id() ? 1 : 0;
    for (const Target target : options.targets) {
      EXPECT_EQ(withoutId(pair.plain.fragmentText(target), pair.plain.id()),
                withoutId(pair.relaxed.fragmentText(target), pair.relaxed.id()))
          << pair.name << " " << targetName(target);
    }
  });
  EXPECT_GT(relaxed, 10U);
}

TEST(RelaxedTexts, AShareThatIsNoneIsRefused) {
  const Scene scene = [] {
    Messages messages;
    return Scene::load((sourceFolder() / "bench/works/w0.gltf").string(), {}, messages);
  }();
  ASSERT_TRUE(scene);
  for (const double share : {-0.01, 0.6, std::nan("")}) {
    Options options;
    options.relaxed = share;
    Messages messages;
    EXPECT_FALSE(scene.graph(0, kUnusedAttributes, options, messages));
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_EQ(messages[0].code, "out-of-range");
  }
}

}  // namespace
}  // namespace lacquer::test::relax_texts_test
