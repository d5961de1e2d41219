// SPIR-V of somebody who means harm, which `lacquer cost` gives to a driver.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <vector>

#include "command.h"

namespace lacquer::test::hostile_cost_test {
namespace {

namespace fs = std::filesystem;

constexpr int kMost = 700;  // MiB of address space, for the program and for its driver

/// A module's words, an instruction at a time (SPIR-V specification, 2.3).
class Words {
public:
  Words() : words_{0x07230203, 0x00010000, 0, 4'000'000, 0} {}

  Words& op(uint32_t code, const std::vector<uint32_t>& operands) {
    words_.push_back(static_cast<uint32_t>(operands.size() + 1) << 16U | code);
    words_.insert(words_.end(), operands.begin(), operands.end());
    return *this;
  }
  std::string bytes() const {
    std::string bytes;
    for (const uint32_t word : words_) {
      for (uint32_t shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift & 0xFFU);
    }
    return bytes;
  }

private:
  std::vector<uint32_t> words_;
};

struct Block {
  uint32_t set = 0, binding = 0;
  std::vector<uint32_t> arrays;  ///< lengths, the innermost first
};

/// A fragment shader that writes a number of one uniform block.
std::string fragment(const Block& block) {
  Words words;
  words.op(17, {1}).op(14, {0, 1}).op(15, {4, 1, 0x6e69616d, 0, 20}).op(16, {1, 7});
  words.op(71, {3, 2}).op(72, {3, 0, 35, 0});
  words.op(71, {10, 34, block.set}).op(71, {10, 33, block.binding}).op(71, {20, 30, 0});
  words.op(19, {5}).op(33, {6, 5}).op(22, {2, 32}).op(23, {7, 2, 4}).op(30, {3, 7});
  words.op(21, {11, 32, 1}).op(43, {11, 12, 0});
  uint32_t type = 3;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < block.arrays.size(); ++i) {
    words.op(43, {11, 30 + 2 * i, block.arrays[i]}).op(28, {31 + 2 * i, type, 30 + 2 * i});
    type = 31 + 2 * i;
    indices.push_back(12);
  }
  indices.push_back(12);
  words.op(32, {4, 2, type}).op(59, {4, 10, 2}).op(32, {13, 2, 7}).op(32, {14, 3, 7}).op(59, {14, 20, 3});
  std::vector<uint32_t> access = {13, 22, 10};
  access.insert(access.end(), indices.begin(), indices.end());
  words.op(54, {5, 1, 0, 6}).op(248, {21}).op(65, access).op(61, {7, 23, 22}).op(62, {20, 23});
  return words.op(253, {}).op(56, {}).bytes();
}

/// A fragment shader that does nothing, with an array of so many zeros. Mesa has a pointer for each.
std::string zeros(uint32_t count) {
  Words words;
  words.op(17, {1}).op(14, {0, 1}).op(15, {4, 1, 0x6e69616d, 0}).op(16, {1, 7});
  words.op(19, {5}).op(33, {6, 5}).op(22, {2, 32}).op(21, {11, 32, 0}).op(43, {11, 12, count});
  words.op(28, {13, 2, 12}).op(46, {13, 14});
  return words.op(54, {5, 1, 0, 6}).op(248, {9}).op(253, {}).op(56, {}).bytes();
}

/// A fragment shader with so many uniform variables, all of a struct with so many members.
std::string blocks(uint32_t members, uint32_t variables) {
  Words words;
  words.op(17, {1}).op(14, {0, 1}).op(15, {4, 1, 0x6e69616d, 0}).op(16, {1, 7}).op(71, {5, 2});
  words.op(19, {7}).op(33, {8, 7}).op(22, {3, 32});
  std::vector<uint32_t> type(members + 1, 3);
  type[0] = 5;
  words.op(30, type).op(32, {6, 2, 5});
  for (uint32_t i = 0; i < variables; ++i) words.op(59, {6, 100 + i, 2});
  return words.op(54, {7, 1, 0, 8}).op(248, {9}).op(253, {}).op(56, {}).bytes();
}

/// A folder m whose shaders, s0 and so on, are all one module.
void writeShaders(const Workplace& place, size_t shaders, const std::string& module) {
  std::string list;
  for (size_t i = 0; i < shaders; ++i) {
    list += fmt::format(
        R"({}"s{}": {{"files": {{"spirv": {{"frag": "spirv/s{}.frag.spv"}}}}, "validated": {{}}, "template": "forward",
           "uniforms": [], "parameters": [], "textures": [], "inputs": [], "outputs": [],
           "proofs": {{"safe": 0, "unproved": []}}}})",
        i == 0 ? "" : ",", i, i);
  }
  place.write("m/manifest.json",
              R"({"lacquer": "0.2.0", "schema": 1, "files": [], "shaders": {)" + list + "}}");
  place.write("m/spirv/s0.frag.spv", module);
  for (size_t i = 1; i < shaders; ++i)
    fs::create_hard_link(place / "m/spirv/s0.frag.spv", place / fmt::format("m/spirv/s{}.frag.spv", i));
}

/// `lacquer cost` with no more than kMost of memory, and its driver with what that adds.
Outcome bounded(const Workplace& place, const std::string& arguments) {
  return place.within(kMost, "cost " + arguments, std::chrono::seconds(300));
}

bool says(const Outcome& outcome, const std::string& text) {
  return outcome.err.find(text) != std::string::npos;
}

bool haveDriver(const Outcome& outcome) { return !says(outcome, "[cost-unavailable]"); }

/// Nothing but a refusal. Without a driver nothing is asked of the modules.
void expectRefusal(const Outcome& outcome, const std::string& text) {
  if (!haveDriver(outcome)) GTEST_SKIP() << "NOT TESTED: " << outcome.err;
  EXPECT_EQ(outcome.status, 1) << outcome.all();
  EXPECT_TRUE(says(outcome, text)) << outcome.all();
  EXPECT_FALSE(says(outcome, "crashed")) << outcome.all();
  EXPECT_FALSE(says(outcome, "[stopped]")) << outcome.all();
}

TEST(HostileSpirv, sitsWhereADeviceHasPlace) {
  const Workplace place;
  const auto cost = [&](const Block& block) {
    place.write("a.frag.spv", fragment(block));
    return place.run({"cost", "a.frag.spv"}, std::chrono::seconds(60));
  };
  for (const Block& good : {Block{0, 0, {}}, Block{31, 65'535, {}}, Block{0, 3, {16}}}) {
    const Outcome outcome = cost(good);
    if (!haveDriver(outcome)) GTEST_SKIP() << "NOT TESTED: " << outcome.err;
    EXPECT_EQ(outcome.status, 0) << outcome.all();
  }
  expectRefusal(cost({32, 0, {}}), "the resource at set 32, binding 0: there are 32 sets");
  for (const uint32_t binding : {65'536U, 0x1000000U, 0xffffffffU}) {
    expectRefusal(cost({0, binding, {}}),
                  fmt::format("the resource at set 0, binding {}: a set has 65536 bindings", binding));
  }
  expectRefusal(cost({0, 1, {65'537}}), "set 0, binding 1 has more than 65536 descriptors");
  expectRefusal(cost({0, 1, {300, 300}}), "set 0, binding 1 has more than 65536 descriptors");
}

TEST(HostileSpirv, isValidBeforeADriverSeesIt) {
  const Workplace place;
  // The block's decoration on a vector.
  std::string wrong = fragment({0, 0, {}});
  const std::string block("\x47\0\3\0\3\0\0\0", 8);
  ASSERT_NE(wrong.find(block), std::string::npos);
  wrong[wrong.find(block) + 4] = '\7';
  place.write("a.frag.spv", wrong);
  expectRefusal(place.run({"cost", "a.frag.spv"}, std::chrono::seconds(60)), "the module is not valid: ");
  // The same in the stage beside it.
  place.write("b.frag.spv", fragment({0, 0, {}}));
  place.write("b.vert.spv", wrong);
  expectRefusal(place.run({"cost", "b.frag.spv"}, std::chrono::seconds(60)), "the module is not valid: ");
}

/// 2.5 GiB.
TEST(HostileSpirv, endsADriverThatTakesTooMuchMemory) {
  const Workplace place;
  place.write("a.frag.spv", zeros(0x14000000));
  place.write("b.frag.spv", zeros(4));
  const Outcome outcome = place.run({"cost", "a.frag.spv", "b.frag.spv"}, std::chrono::seconds(60));
  if (!haveDriver(outcome)) GTEST_SKIP() << "NOT TESTED: " << outcome.err;
  EXPECT_EQ(outcome.status, 1) << outcome.all();
  const std::string said = "the driver crashed, or asked for more than 2 GiB of memory";
  for (const char* gpu : {"navi21", "gfx1100"}) {
    EXPECT_TRUE(says(outcome, fmt::format("a.frag.spv: error: no cost for {}: {}", gpu, said)))
        << outcome.all();
  }
  EXPECT_FALSE(says(outcome, "b.frag.spv: error")) << outcome.all();
}

TEST(HostileSpirv, takesNoMoreThanItsWords) {
  const Workplace place;
  place.write("a.frag.spv", blocks(65'000, 4'000));
  const Outcome outcome = bounded(place, "a.frag.spv");
  EXPECT_FALSE(says(outcome, "[stopped]")) << outcome.all();
  expectRefusal(outcome, "the module is not valid: ");
}

/// 4 MB, 300 times over.
TEST(HostileManifest, namesAModuleManyTimesForThePriceOfOne) {
  const Workplace place;
  writeShaders(place, 300, blocks(60'000, 235'000));
  const Outcome outcome = bounded(place, "m");
  EXPECT_FALSE(says(outcome, "[stopped]")) << outcome.err.substr(0, 300);
  EXPECT_NE(outcome.out.find("\ns299 "), std::string::npos) << outcome.all().substr(0, 300);
}

TEST(HostileManifest, isMeasuredOnceForEachModule) {
  const Workplace place;
  writeShaders(place, 4'000, fragment({0, 0, {}}));
  // So many pipelines would take more than the time.
  const Outcome outcome = place.run({"cost", "m", "--json"}, std::chrono::seconds(60));
  if (!haveDriver(outcome)) GTEST_SKIP() << "NOT TESTED: " << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.all();
  const nlohmann::json shaders = nlohmann::json::parse(outcome.out)["shaders"];
  ASSERT_EQ(shaders.size(), 4'000U);
  for (const nlohmann::json& shader : shaders) {
    EXPECT_EQ(shader["spirv_instructions"], shaders[0]["spirv_instructions"]);
    EXPECT_EQ(shader["gpus"], shaders[0]["gpus"]);
  }
}

TEST(HostileSpirv, isNoLargerThanModulesAre) {
  const Workplace place;
  place.write("a.frag.spv", fragment({0, 0, {}}));
  fs::resize_file(place / "a.frag.spv", (size_t{1} << 26U) + 4);
  const Outcome outcome = bounded(place, "a.frag.spv");
  EXPECT_EQ(outcome.status, 1) << outcome.all();
  EXPECT_TRUE(says(outcome, "[spirv-too-large]")) << outcome.all();
}

TEST(CostPaths, areNotEmpty) {
  const Workplace place;
  place.write("a.frag.spv", fragment({0, 0, {}}));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"cost", ""}, {"cost", "a.frag.spv", ""}}) {
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.status, 2) << outcome.all();
    EXPECT_TRUE(says(outcome, "paths: must not be empty")) << outcome.all();
  }
}

}  // namespace
}  // namespace lacquer::test::hostile_cost_test
