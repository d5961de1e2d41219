// Targets that a caller adds. In a program of its own: they stay for the rest of the process.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "../../examples/console/console.h"
#include "inputs.h"

namespace lacquer::test {
namespace {

using nlohmann::json;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TargetDescription described(const std::string& name, Target like) {
  TargetDescription description;
  description.name = name;
  description.extension = "sh";
  description.prose = "a test's";
  description.like = like;
  return description;
}

/// The errors of adding it; empty where it is added.
std::string added(const TargetDescription& description) {
  Messages messages;
  Target target = Target::Glsl;
  const bool good = addTarget(description, target, messages);
  EXPECT_EQ(good, messages.empty());
  return errorsOf(messages);
}

Shader shaderFor(Target target, bool validate, Messages& messages) {
  Options options;
  options.targets = {target};
  options.validate = validate;
  return paintGraph().generate(options, messages);
}

Target console() {
  static const Target kConsole = [] {
    Messages messages;
    Target target = Target::Glsl;
    EXPECT_TRUE(addConsole(target, messages)) << errorsOf(messages);
    return target;
  }();
  return kConsole;
}

TEST(Registered, IsATargetLikeAnyOther) {
  const Target target = console();
  EXPECT_EQ(targetName(target), "console");
  EXPECT_EQ(targetNames().back(), "console");
  Target found = Target::Glsl;
  EXPECT_TRUE(findTarget("console", found));
  EXPECT_EQ(found, target);
  EXPECT_FALSE(hasSpecializationConstants(target));
}

TEST(Registered, ItsTextIsTheOthersInItsWords) {
  Messages messages;
  const Shader shader = shaderFor(console(), true, messages);
  ASSERT_TRUE(shader) << errorsOf(messages);
  const Shader hlsl = shaderFor(Target::Hlsl, true, messages);
  EXPECT_EQ(shader.id(), hlsl.id());
  const std::string& text = shader.fragmentText(console());
  EXPECT_TRUE(has(text, "\n#pragma console(fast_math, off)\n")) << text;
  EXPECT_TRUE(has(text, "\nConstantBuffer Material")) << text;
  EXPECT_TRUE(has(text, ": S_TARGET_OUTPUT0")) << text;
  EXPECT_FALSE(has(text, "cbuffer") || has(text, "SV_"));
  EXPECT_TRUE(has(shader.vertexText(console()), ": S_POSITION"));
  EXPECT_TRUE(has(hlsl.fragmentText(Target::Hlsl), ": SV_Target0"));
  EXPECT_EQ(hlsl.fragmentText(console()), "");
}

TEST(Registered, ARunWritesItsFiles) {
  Options options;
  options.targets = {console(), Target::Glsl};
  options.cache = (emptyFolder() / "cache").string();
  const std::string out = (emptyFolder() / "out").string();
  for (int run = 0; run < 2; ++run) {
    Messages messages;
    const Report report =
        generate({std::string(LACQUER_EXAMPLES) + "/coat.gltf"}, {}, out, options, messages);
    ASSERT_TRUE(report.ok) << errorsOf(messages);
    ASSERT_FALSE(report.shaders.empty());
    EXPECT_EQ(report.made == 0, run == 1);
    for (const ShaderReport& shader : report.shaders) {
      EXPECT_TRUE(shader.validated);
      EXPECT_TRUE(std::filesystem::exists(out + "/console/" + shader.id + ".frag.cgx"));
    }
  }
  std::ifstream file(out + "/manifest.json");
  const json manifest = json::parse(file);
  EXPECT_TRUE(manifest["shaders"].begin()->at("files").contains("console")) << manifest["shaders"].dump(1);
}

TEST(Registered, WhatItsCheckSaysIsAnError) {
  TargetDescription picky = described("picky", Target::Glsl);
  picky.check = [](const std::string&, bool vertex) {
    return vertex ? Strings() : Strings{"the console's compiler has a bug"};
  };
  Target target = Target::Glsl;
  Messages messages;
  ASSERT_TRUE(addTarget(picky, target, messages));
  shaderFor(target, true, messages);
  EXPECT_EQ(errorsOf(messages), "target-check");
  messages.clear();
  shaderFor(target, false, messages);
  EXPECT_EQ(errorsOf(messages), "");
}

TEST(Registered, AVersionIsReplaced) {
  TargetDescription essl31 = described("essl31", Target::Essl);
  essl31.opening = "#version 310 es";
  Target target = Target::Glsl;
  Messages messages;
  ASSERT_TRUE(addTarget(essl31, target, messages));
  const Shader shader = shaderFor(target, true, messages);
  ASSERT_TRUE(shader) << errorsOf(messages);
  const Shader essl = shaderFor(Target::Essl, true, messages);
  std::string expected = essl.fragmentText(Target::Essl);
  const size_t at = expected.find("#version 300 es");
  ASSERT_NE(at, std::string::npos);
  expected.replace(at, 15, "#version 310 es");
  EXPECT_EQ(shader.fragmentText(target), expected);
}

TEST(Registered, ANameOfTheShaderIsNoWordOfTheTarget) {
  TargetDescription clash = described("clash", Target::Glsl);
  clash.words = {{"vec3", "base_color_factor"}};
  Target target = Target::Glsl;
  Messages messages;
  ASSERT_TRUE(addTarget(clash, target, messages));
  const Shader shader = shaderFor(target, false, messages);
  EXPECT_EQ(errorsOf(messages), "target-words");
  EXPECT_EQ(shader.fragmentText(target), "");
  EXPECT_TRUE(has(messages[0].file, "clash/")) << messages[0].file;
}

TEST(Registered, WhatIsWrongIsRefused) {
  console();
  for (const char* name : {"", "Glsl", "glsl", "console", "1d", "a/b", "..", "a b"})
    EXPECT_EQ(added(described(name, Target::Glsl)), "target-name") << name;
  for (const char* extension : {"", "f.x", "F", "../x"}) {
    TargetDescription wrong = described("wrong", Target::Glsl);
    wrong.extension = extension;
    EXPECT_EQ(added(wrong), "target-extension") << extension;
  }
  for (const Target like : {Target::Spirv, Target::Cpp, Target::Js, console(), static_cast<Target>(77)})
    EXPECT_EQ(added(described("wrong", like)), "target-like");
  const std::map<std::string, std::string, std::less<>> bad[] = {
      {{"", "x"}},        {{"a b", "x"}},       {{"+", "x"}},    {{"vec3", ""}},
      {{"vec3", "a\nb"}}, {{"vec3", "a // b"}}, {{"vec3", "/*"}}};
  for (const auto& words : bad) {
    TargetDescription wrong = described("wrong", Target::Glsl);
    wrong.words = words;
    EXPECT_EQ(added(wrong), "target-words") << words.begin()->first << " " << words.begin()->second;
  }
}

/// Makes the shaders of an example in a target "twin" that calls vec3 so; the folder is kept between
/// processes.
std::string fragmentOfTwin(const std::string& vec3, const std::filesystem::path& folder) {
  TargetDescription twin = described("twin", Target::Glsl);
  twin.words = {{"vec3", vec3}};
  Options options;
  options.validate = false;
  options.cache = (folder / "cache").string();
  options.targets.resize(1);
  Messages messages;
  if (!addTarget(twin, options.targets[0], messages)) return errorsOf(messages);
  const std::string out = (folder / "out").string();
  const Report report =
      generate({std::string(LACQUER_EXAMPLES) + "/clearcoat.gltf"}, {}, out, options, messages);
  if (!report.ok || report.shaders.empty()) return errorsOf(messages);
  std::ifstream file(out + "/twin/" + report.shaders[0].id + ".frag.sh");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Two programs may have a target of one name with other words, and one cache.
TEST(Registered, CodeIsKeptByItsWords) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "lacquer-twin";
  EXPECT_EXIT(
      {
        std::filesystem::remove_all(folder);
        std::exit(has(fragmentOfTwin("triple", folder), " triple ") ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
  const std::string text = fragmentOfTwin("threefold", folder);
  EXPECT_TRUE(has(text, " threefold ") && !has(text, " triple ")) << text;
  std::filesystem::remove_all(folder);
}

/// The shaders of an example in a target "checked", with what its check says of a fragment's text.
Report reportOfChecked(const std::string& said, const std::filesystem::path& folder, Messages& messages) {
  TargetDescription checked = described("checked", Target::Glsl);
  checked.check = [said](const std::string&, bool vertex) {
    return vertex || said.empty() ? Strings() : Strings{said};
  };
  Options options;
  options.cache = (folder / "cache").string();
  options.targets.resize(1);
  if (!addTarget(checked, options.targets[0], messages)) return {};
  return generate({std::string(LACQUER_EXAMPLES) + "/clearcoat.gltf"}, {}, (folder / "out").string(), options,
                  messages);
}

/// Checks cannot be compared: what another process's check said of the same text does not count.
TEST(Registered, ACheckIsAskedInEachProcess) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "lacquer-checked";
  EXPECT_EXIT(
      {
        std::filesystem::remove_all(folder);
        Messages messages;
        std::exit(reportOfChecked("", folder, messages).ok == 1 ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
  Messages messages;
  const Report report = reportOfChecked("no such instruction", folder, messages);
  EXPECT_EQ(report.ok, 0U);
  EXPECT_EQ(messages.size(), report.shaders.size());
  for (const Message& message : messages) {
    EXPECT_EQ(message.code, "target-check");
    EXPECT_TRUE(has(message.file, "checked/")) << message.file;
  }
  std::filesystem::remove_all(folder);
}

#ifdef LACQUER_CONSOLE
TEST(Registered, TheExampleRuns) {
  const std::string out = (emptyFolder() / "out").string();
  const std::string line =
      std::string("'") + LACQUER_CONSOLE + "' '" + out + "' '" + LACQUER_EXAMPLES + "/clearcoat.gltf'";
  EXPECT_EQ(std::system(line.c_str()), 0);
  EXPECT_FALSE(std::filesystem::is_empty(out + "/console"));
}
#endif

}  // namespace
}  // namespace lacquer::test
