#include "parity/browser.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "support/base64.h"
#include "support/cases.h"

namespace lacquer::parity {

using nlohmann::json;
namespace fs = std::filesystem;

std::string base64(const std::vector<unsigned char>& bytes) {
  return toBase64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

bool isList(const ir::Module& module, const vulkan::UniformBlock& block) {
  return std::any_of(module.blocks.begin(), module.blocks.end(), [&](const ir::Block& declared) {
    return declared.list &&
           vulkan::BindingPlace(declared.binding.set, declared.binding.binding) == block.place;
  });
}

json textureWords(const vulkan::Texture& texture) {
  constexpr const char* kWraps[] = {"repeat", "clamp", "mirror"};
  constexpr const char* kShapes[] = {"2d", "cube", "2d-array", "3d"};
  json texels = json::array();
  for (const vulkan::Texel& texel : *texture.texels) {
    for (const float x : texel) texels.push_back(x);
  }
  return {{"shape", kShapes[static_cast<size_t>(texture.shape)]},
          {"compares", texture.compares},
          {"width", texture.width},
          {"height", texture.height},
          {"texels", std::move(texels)},
          {"wrap", {kWraps[static_cast<size_t>(texture.s)], kWraps[static_cast<size_t>(texture.t)]}},
          {"nearest", texture.nearest}};
}

json workWords(const vulkan::Work& work, const ir::Module& module) {
  json made = {{"points", work.points}, {"backFacing", work.back_facing}};
  for (const char* list : {"outputs", "inputs", "blocks", "lists", "textures"}) made[list] = json::array();
  made["constants"] = json::object();
  for (const ir::Output& output : module.outputs) {
    if (output.kind == ir::OutputKind::Color) made["outputs"].push_back(output.location);
  }
  return made;
}

static double numberOf(const json& spelled) {
  if (spelled.is_number()) return spelled.get<double>();
  return std::strtod(spelled.get<std::string>().c_str(), nullptr);  // NaN, Infinity, -Infinity
}

std::optional<json> colorsOf(const char* program, const json& works) {
  const fs::path folder = fs::path(testing::TempDir()) / fmt::format("lacquer-browser-{}", getpid());
  fs::create_directories(folder);
  std::ofstream(folder / "works.json") << works;
  const std::string command =
      fmt::format("'{}' '{}' '{}'", (test::sourceFolder() / program).string(),
                  (folder / "works.json").string(), (folder / "colors.json").string());
  const int status = std::system(command.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  std::optional<json> colors;
  // 3: no browser; 126 and 127: no node.
  if (code != 3 && code != 126 && code != 127) {
    EXPECT_EQ(code, 0) << command;
    std::ifstream in(folder / "colors.json");
    colors = json::parse(in, nullptr, false);
  }
  fs::remove_all(folder);
  return colors;
}

std::vector<std::vector<float>> outputsOf(const Subject& subject, const json& colors,
                                          const std::string& text) {
  if (!colors.contains("outputs")) {
    ADD_FAILURE() << subject.name << ": " << colors << "\n" << text;
    return {};
  }
  std::vector<std::vector<float>> outputs;
  for (const json& rgba : colors["outputs"]) {
    EXPECT_EQ(rgba.size(), 4 * subject.points) << subject.name << ": " << rgba;
    if (rgba.size() != 4 * subject.points) return {};
    outputs.emplace_back();
    for (const json& x : rgba) outputs.back().push_back(static_cast<float>(numberOf(x)));
  }
  const std::vector<std::vector<float>> cpu = onCpu(subject);
  for (size_t i = 0; i < subject.points; ++i) {
    for (size_t o = 0; o < outputs.size() && colors["discarded"][i].get<bool>(); ++o)
      std::copy_n(cpu[o].begin() + static_cast<ptrdiff_t>(4 * i), 4,
                  outputs[o].begin() + static_cast<ptrdiff_t>(4 * i));
  }
  return outputs;
}

void expectColors(const char* program, const std::vector<Subject>& subjects,
                  const std::function<json(const Subject&)>& work_of, size_t least) {
  json works = json::array();
  for (const Subject& subject : subjects) works.push_back(work_of(subject));
  const std::optional<json> colors = colorsOf(program, works);
  if (!colors)
    GTEST_SKIP() << "NOT TESTED: there is no Chromium that can run this, or no node, on this machine";
  ASSERT_EQ(colors->size(), subjects.size());
  Comparison all;
  for (size_t i = 0; i < subjects.size(); ++i) {
    Comparison one;
    compare(subjects[i], boundsOf(subjects[i]),
            outputsOf(subjects[i], (*colors)[i], works[i].dump(1).substr(0, 400)), program, one);
    EXPECT_EQ(one.outside, 0U) << one.first;
    all.numbers += one.numbers;
    all.vague += one.vague;
    all.endless += one.endless;
  }
  std::cout << all.numbers << " numbers, " << all.vague << " with a vague bound, " << all.endless
            << " with none\n";
  EXPECT_GT(all.numbers, least);
  EXPECT_LT(all.vague, all.numbers / 2);
}

std::vector<Subject> materials(const MaterialSetting& setting, size_t points, size_t stride) {
  const std::vector<NamedGraph> graphs = exampleGraphs(setting);
  std::vector<Subject> subjects;
  for (size_t i = 0; i < graphs.size(); i += stride)
    subjects.push_back(materialSubject(graphs[i], setting, points, i));
  return subjects;
}

}  // namespace lacquer::parity
