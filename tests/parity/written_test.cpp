// What a run has written, as an engine takes it: the SPIR-V of programs that materials share on a Vulkan
// device, each material with what the manifest says of it, to the bounds of the shader that it has alone.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>

#include "lacquer.h"
#include "parity/subject.h"
#include "support/cases.h"

namespace lacquer::parity::written_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr size_t kPoints = 64;
constexpr uint64_t kSeed = 9;

/// A folder that a run has written to, and the graphs of its shaders.
class Written {
public:
  Written(const std::string& name, const Strings& files, uint32_t programs)
      : folder_(fs::path(testing::TempDir()) /
                ("lacquer-written-" + std::to_string(::getpid()) + "-" + name)) {
    Options options;
    options.targets = {Target::Spirv};
    options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
    options.programs = programs;
    options.programs_model = true;
    options.sync = false;
    Messages messages;
    fs::create_directories(folder_);
    EXPECT_TRUE(generate(files, {}, (folder_ / "out").string(), options, messages).ok);
    Plan actions;
    actions.ninja = (folder_ / "build.ninja").string();
    actions.program = "lacquer";
    actions.command = {"lacquer"};
    EXPECT_TRUE(plan(actions, files, {}, (folder_ / "planned").string(), options, messages).ok);
    manifest = Json::parse(test::readFile(folder_ / "out" / "manifest.json"));
  }
  ~Written() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Written(const Written&) = delete;
  Written& operator=(const Written&) = delete;

  /// A shader's graph with the numbers that the manifest gives a use of it.
  NamedGraph graphOf(const Json& use, const std::string& name) const {
    const std::string id = use["shader"];
    const std::string text = test::readFile(folder_ / "build.ninja.plan" / (id + ".graph.json"));
    Result<graph::Graph> graph = graph::fromJson(text, id);
    EXPECT_TRUE(graph) << id;
    if (!graph) return {};
    for (ir::Parameter& p : graph->parameters) {
      EXPECT_TRUE(use["parameters"].contains(p.name)) << name << " has no " << p.name;
      const std::vector<double> values = numbers(use["parameters"][p.name]["value"]);
      std::copy_n(values.begin(), std::min(values.size(), p.value.size()), p.value.begin());
    }
    EXPECT_FALSE(hasError(graph::check(*graph, library()))) << name;
    return {name, std::move(*graph)};
  }

  /// What a device is given: code, block and places from the folder; the template's values and the varyings
  /// from the subject.
  vulkan::Work workOf(const Json& use, const Subject& subject, const GpuTextures& own) const {
    const Json& shader = manifest["shaders"][use["shader"].get<std::string>()];
    Result<vulkan::Work> work =
        gpuWork(subject.module, subject.bindings, subject.textures, subject.points, FragmentRoute::Direct);
    EXPECT_TRUE(work) << subject.name;
    if (!work) return {};
    const std::string bytes = test::readFile(folder_ / "out" / shader["files"]["spirv"]["frag"]);
    work->fragment.resize(bytes.size() / sizeof(uint32_t));
    std::memcpy(work->fragment.data(), bytes.data(), work->fragment.size() * sizeof(uint32_t));
    for (const Json& block : shader["uniforms"]) {
      if (block["role"] == "material") fill(block, use, *work);
    }
    work->textures.clear();
    for (const Json& slot : shader["textures"])
      work->textures.push_back(textureOf(slot, use, subject.textures, own));
    return std::move(*work);
  }

  Json manifest;

private:
  static std::vector<double> numbers(const Json& value) {
    if (value.is_array()) return value.get<std::vector<double>>();
    return {value.is_boolean() ? static_cast<double>(value.get<bool>()) : value.get<double>()};
  }

  static void fill(const Json& block, const Json& use, vulkan::Work& work) {
    vulkan::UniformBlock made;
    made.place = {block["set"], block["binding"]};
    made.bytes.assign(block["size"], 0xff);  // NaN where nothing says what
    for (const Json& field : block["fields"]) {
      const std::vector<double> values = numbers(use["uniforms"][field["name"].get<std::string>()]);
      for (size_t c = 0; c < values.size(); ++c) {
        const auto number = static_cast<float>(values[c]);
        std::memcpy(&made.bytes.at(field["offset"].get<size_t>() + 4 * c), &number, sizeof(number));
      }
    }
    const auto is_it = [&](const vulkan::UniformBlock& one) { return one.place == made.place; };
    std::erase_if(work.blocks, is_it);
    work.blocks.push_back(std::move(made));
  }

  static vulkan::Texture textureOf(const Json& slot, const Json& use, const GpuTextures& given,
                                   const GpuTextures& own) {
    const std::string name = slot["name"];
    vulkan::Texture texture;
    if (slot["role"] == "material" && use["textures"].at(name).contains("stand_in")) {
      vulkan::Texel texel{};
      const std::vector<double> values = numbers(use["textures"][name]["stand_in"]["texel"]);
      std::transform(values.begin(), values.end(), texel.begin(),
                     [](double x) { return static_cast<float>(x); });
      texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(1, texel);
    } else {
      // Its own: what stands at that slot in the shader that it has alone.
      const auto it = own.find(name);
      texture = it == own.end() ? given.find(name)->second : it->second;
    }
    texture.image = texture.sampler = {slot["set"], slot["binding"]};
    return texture;
  }

  fs::path folder_;
};

/// Calls `each(name, alone, shared)` for the uses of both manifests.
template <class Each>
void eachUse(const Json& alone, const Json& shared, Each each) {
  for (size_t f = 0; f < alone["files"].size(); ++f) {
    const Json& materials = alone["files"][f]["materials"];
    for (size_t m = 0; m < materials.size(); ++m) {
      for (size_t u = 0; u < materials[m]["uses"].size(); ++u) {
        each(alone["files"][f]["source"].get<std::string>() + ", " + materials[m]["name"].get<std::string>(),
             materials[m]["uses"][u], shared["files"][f]["materials"][m]["uses"][u]);
      }
    }
  }
}

struct Tried {
  Comparison alone, shared;
  size_t merged = 0;     ///< materials whose program is another one than alone
  size_t discarded = 0;  ///< points that one discards and the other does not
};

/// A use as an engine would draw it: the points that it discards.
std::vector<bool> draw(const Written& written, const Json& use, const std::string& name, const Subject& own,
                       const std::vector<std::vector<analysis::Range>>& bounds, Comparison& comparison) {
  const Subject subject = materialSubject(written.graphOf(use, name), {}, kPoints, kSeed);
  const Result<vulkan::Outcome> outcome = device()->run(written.workOf(use, subject, own.textures));
  EXPECT_TRUE(outcome) << name << ": " << (outcome ? "" : format(outcome.error()[0]));
  if (!outcome) return {};
  std::vector<std::vector<analysis::Range>> seen = bounds;
  for (size_t i = 0; i < kPoints; ++i) {
    if (outcome->discarded[i]) seen[i].clear();
  }
  compare(subject, seen, outcome->outputs, "what was written", comparison);
  return outcome->discarded;
}

Strings exampleFiles() {
  Strings files;
  for (const char* name : {"clearcoat", "coat", "core", "cloth"})
    files.push_back((test::sourceFolder() / "examples" / (std::string(name) + ".gltf")).string());
  return files;
}

/// `change`: of the manifest of shared programs, before they are run.
Tried tryAll(uint32_t programs, const std::function<void(Json&)>& change) {
  Tried tried;
  const Written alone("alone", exampleFiles(), 0);
  Written shared("shared", exampleFiles(), programs);
  EXPECT_EQ(shared.manifest["shaders"].size(), programs);
  change(shared.manifest);
  eachUse(alone.manifest, shared.manifest, [&](const std::string& name, const Json& a, const Json& b) {
    if (a["shader"] == b["shader"]) return;
    ++tried.merged;
    const Subject own = materialSubject(alone.graphOf(a, name), {}, kPoints, kSeed);
    const auto bounds = boundsOf(own, true);
    const std::vector<bool> before = draw(alone, a, name, own, bounds, tried.alone);
    const std::vector<bool> after = draw(shared, b, name + " in one program", own, bounds, tried.shared);
    for (size_t i = 0; i < std::min(before.size(), after.size()); ++i)
      tried.discarded += before[i] != after[i];
  });
  return tried;
}

TEST(ParityWritten, SharedProgramsHaveTheColoursOfTheirOwn) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const Tried tried = tryAll(2, [](Json&) {});
  EXPECT_EQ(tried.alone.outside, 0U) << tried.alone.first;
  EXPECT_EQ(tried.shared.outside, 0U) << tried.shared.first;
  EXPECT_EQ(tried.alone.numbers, tried.shared.numbers);
  EXPECT_EQ(tried.discarded, 0U);
  EXPECT_GT(tried.merged, 15U);
  std::cout << tried.merged << " materials, " << tried.shared.numbers << " numbers, " << tried.shared.vague
            << " with a vague bound\n";
}

/// What the manifest says stands in is what must: with another texel or number the colours are others.
TEST(ParityWritten, AnotherTexelOrNumberShows) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const auto everyUse = [](Json& manifest, const std::function<void(Json&)>& each) {
    for (Json& file : manifest["files"]) {
      for (Json& material : file["materials"]) {
        for (Json& use : material["uses"]) each(use);
      }
    }
  };
  size_t texels = 0;
  const Tried texel = tryAll(2, [&](Json& manifest) {
    everyUse(manifest, [&](Json& use) {
      for (auto& [name, texture] : use["textures"].items()) {
        if (!texture.contains("stand_in")) continue;
        ++texels;
        for (Json& x : texture["stand_in"]["texel"]) x = 1 - x.get<double>();
      }
    });
  });
  EXPECT_GT(texels, 10U);
  EXPECT_GT(texel.shared.outside, 100U);
  EXPECT_EQ(texel.alone.outside, 0U) << texel.alone.first;
  const Tried choice = tryAll(2, [&](Json& manifest) {
    everyUse(manifest, [](Json& use) {
      for (auto& [name, value] : use["uniforms"].items()) {
        if (name.starts_with("choice_")) value = 1 - value.get<double>();
      }
    });
  });
  EXPECT_GT(choice.shared.outside, 100U);
  EXPECT_GT(choice.discarded, kPoints / 2);  // one masked material shares its program
}

}  // namespace
}  // namespace lacquer::parity::written_test
