// Random materials. LACQUER_RANDOM_COUNT makes it more of them, LACQUER_RANDOM_SEED others.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "compare.h"
#include "output.h"
#include "random_material.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

uint64_t fromEnvironment(const char* name, uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

const uint64_t kSeed = fromEnvironment("LACQUER_RANDOM_SEED", 1);
const uint64_t kCount = fromEnvironment("LACQUER_RANDOM_COUNT", 200);

/// Where a failing file is kept for the person who looks at it.
std::string kept(uint64_t seed, const std::string& text) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("lacquer-random-" + std::to_string(seed) + ".gltf");
  writeText(file, text);
  return file.string();
}

/// One of many combinations.
Options someOptions(uint64_t seed) {
  std::mt19937_64 random(seed);
  Options options;
  const char* kTemplates[] = {"forward", "forward", "surface", "bsdf"};
  options.template_name = kTemplates[random() % 4];
  if (random() % 3 == 0) options.parameters = Parameters::Baked;
  if (random() % 3 == 0)
    options.lights = {Lights::Mode::Fixed,
                      {{"directional", 1}, {"point", static_cast<uint32_t>(random() % 3)}, {"spot", 1}}};
  options.ibl = random() % 4 != 0;
  options.multiple_scattering = random() % 4 != 0;
  options.decode_srgb = random() % 4 == 0;
  if (random() % 3 == 0) options.live = {"coat", "coat.darkening", "coat.absorption", "coat.anisotropy"};
  return options;
}

/// Everything that follows the rules compiles and validates in every target.
TEST(RandomMaterials, validOnesValidate) {
  size_t materials = 0;
  size_t shaders = 0;
  for (uint64_t i = 0; i * 10 < kCount; ++i) {
    const uint64_t seed = kSeed * 1'000'003 + i;
    RandomMaterial random(seed);
    const std::string text = random.valid(10).dump(1);
    const Folder folder;
    writeText(folder / "in.gltf", text);
    Messages messages;
    const Report report = generate({folder / "in.gltf"}, {}, folder / "out", someOptions(seed), messages);
    bool good = report.ok && !hasError(messages) && report.materials.size() == 10;
    for (const ShaderReport& shader : report.shaders) good &= shader.validated && !shader.files.empty();
    for (const MaterialReport& material : report.materials) good &= material.ok && !material.shaders.empty();
    EXPECT_TRUE(good) << kept(seed, text) << "\n" << textOf(messages);
    if (!good) return;
    materials += report.materials.size();
    shaders += report.shaders.size();
  }
  std::cout << materials << " materials, " << shaders << " shaders\n";
  EXPECT_GE(materials, kCount);
}

/// What is wrong gives messages; what remains is whole. Twice the same.
TEST(RandomMaterials, wrongOnesGiveMessages) {
  size_t bad = 0;
  for (uint64_t i = 0; i < kCount * 2; ++i) {
    const uint64_t seed = kSeed * 1'000'003 + i;
    RandomMaterial random(seed);
    const std::string text = random.damaged();
    const Folder folder;
    writeText(folder / "in.gltf", text);
    Options options;
    options.targets = {Target::Glsl, Target::Hlsl, Target::Spirv};
    Messages messages;
    const Report report = generate({folder / "in.gltf"}, {}, folder / "out", options, messages);
    std::string wrong;
    if (report.ok == hasError(messages)) wrong += "the report and the messages disagree\n";
    for (const Message& m : messages) {
      if (m.code.empty() || m.message.empty() || m.file != folder / "in.gltf")
        wrong += "unfinished: " + m.text + "\n";
      if (m.code == "glslang" || m.code == "spirv-val") wrong += "invalid output: " + m.text + "\n";
    }
    for (const ShaderReport& shader : report.shaders) {
      if (!shader.validated) wrong += shader.id + " is not valid\n";
    }
    if (!manifestOf(folder.path() / "out").is_object()) wrong += "no manifest\n";
    options.validate = false;
    Messages again;
    generate({folder / "in.gltf"}, {}, folder / "again", options, again);
    if (textOf(messages) != textOf(again)) wrong += "other messages the second time:\n" + textOf(again);
    EXPECT_EQ(wrong, "") << kept(seed, text) << "\n" << textOf(messages);
    if (!wrong.empty()) return;
    bad += report.ok ? 0 : 1;
  }
  std::cout << bad << " of " << kCount * 2 << " files have errors\n";
  EXPECT_GT(bad, kCount / 2);
  EXPECT_LT(bad, kCount * 2);
}

}  // namespace
}  // namespace lacquer::test
