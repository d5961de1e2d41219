// The interface of the words is the interface of the GLSL for Vulkan, as glslang understands it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <spirv/unified1/spirv.hpp>

#include "check/check.h"
#include "targets/legalize.h"
#include "targets/samples.h"

namespace lacquer::spirv_test {

using ir::Stage;

namespace {

std::string literal(const uint32_t* words) {
  std::string text;
  for (size_t k = 0;; ++k) {
    const char c = static_cast<char>(words[k / 4] >> (8 * (k % 4)) & 0xffU);
    if (c == 0) return text;
    text += c;
  }
}

/// Each named variable with its storage class, its type's opcode and what decorates it.
std::map<std::string, std::string> variables(const check::Spirv& words) {
  std::map<uint32_t, std::string> names;
  std::map<uint32_t, std::set<std::string>> decorations;
  std::map<uint32_t, std::vector<uint32_t>> types;
  std::map<std::string, std::string> result;
  for (size_t at = 5; at < words.size(); at += words[at] >> spv::WordCountShift) {
    const uint32_t* a = words.data() + at + 1;
    const uint32_t count = (words[at] >> spv::WordCountShift) - 1;
    const uint32_t op = words[at] & spv::OpCodeMask;
    if (op == spv::OpName) names[a[0]] = literal(a + 1);
    if (op == spv::OpDecorate) decorations[a[0]].insert(fmt::format("{}={}", a[1], count > 2 ? a[2] : 0));
    const auto shape = [&](uint32_t id) {
      const std::vector<uint32_t>& t = types[id];
      const bool vector = t.at(0) == spv::OpTypeVector;
      return fmt::format("{}{}", t[0], vector ? fmt::format("x{}", t.at(2)) : "");
    };
    if (op >= spv::OpTypeVoid && op <= spv::OpTypeFunction) {
      types[a[0]] = {op};
      types[a[0]].insert(types[a[0]].end(), a + 1, a + count);
    }
    if (op != spv::OpVariable || a[2] == spv::StorageClassFunction || names[a[1]].empty()) continue;
    std::string text = fmt::format("class {} type {}", a[2], shape(types.at(a[0]).at(2)));
    for (const std::string& d : decorations[a[1]]) text += " " + d;
    result[names[a[1]]] = text;
  }
  return result;
}

/// The blocks' members and where they are; padding is not declared in words.
std::string blocks(const check::Spirv& words) {
  const auto found = check::reflectBlocks(words);
  if (!found) return "not read";
  std::string text;
  for (const check::Block& block : *found) {
    text += fmt::format("{} {} {}\n", block.name, block.set, block.binding);
    for (const check::BlockMember& m : block.members) {
      if (!m.name.starts_with("lacquer_padding"))
        text += fmt::format("  {} {} {}\n", m.name, m.offset, m.size);
    }
  }
  return text;
}

void expectEqualInterfaces(const ir::Module& module, Stage stage) {
  const check::Spirv by_glslang =
      targets::expectCompiles(targets::print(module, stage, Target::Glsl), stage, Target::Glsl);
  ir::Module legal = module;
  const check::Spirv direct = targets::writeSpirv(legal, schedule::schedule(legal, stage), {});
  EXPECT_EQ(blocks(by_glslang), blocks(direct));
  std::map<std::string, std::string> mine = variables(direct);
  // glslang declares all of gl_PerVertex, as a block without a name.
  EXPECT_EQ(mine.erase("gl_Position"), stage == Stage::Vertex ? 1u : 0u);
  EXPECT_EQ(variables(by_glslang), mine);
}

}  // namespace

TEST(Interface, LitFragment) { expectEqualInterfaces(targets::litSample({}), Stage::Fragment); }
TEST(Interface, LitVertex) { expectEqualInterfaces(targets::litSample({}), Stage::Vertex); }
TEST(Interface, FixedFragment) { expectEqualInterfaces(targets::fixedSample(), Stage::Fragment); }

}  // namespace lacquer::spirv_test
