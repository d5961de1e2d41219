// The works must not become dearer than bench/cost.json says without that file being renewed (`./dev bench
// cost`).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/works.h"
#include "cost/cost.h"
#include "support/file.h"

namespace lacquer::bench {
namespace {

const std::string kRoot = LACQUER_SOURCE_FOLDER;
constexpr uint64_t kPercent = 2;

bool risen(uint64_t now, uint64_t before) { return now * 100 > before * (100 + kPercent); }

std::string textOf(const Messages& messages) {
  std::string text;
  for (const Message& message : messages) text += message.text + "\n";
  return text;
}

nlohmann::json committed() {
  const Result<std::string> text = readFile(kRoot + "/bench/cost.json");
  return text ? nlohmann::json::parse(*text, nullptr, false) : nlohmann::json();
}

const Work& find(const std::string& name) {
  for (const Work& work : kWorks) {
    if (work.name == name) return work;
  }
  throw std::out_of_range(name);
}

TEST(Works, MoreThanTwoPercentIsARise) {
  EXPECT_FALSE(risen(100, 100));
  EXPECT_FALSE(risen(102, 100));
  EXPECT_TRUE(risen(103, 100));
  EXPECT_TRUE(risen(1, 0));
}

TEST(Works, ACoatOfFactorZeroIsTheBase) {
  for (const bool multiple_scattering : {true, false}) {
    Messages messages;
    const cost::Subject base =
        build(find("W0"), kRoot + "/bench/works", multiple_scattering, Route::Direct, messages);
    const cost::Subject off =
        build(find("W1off"), kRoot + "/bench/works", multiple_scattering, Route::Direct, messages);
    ASSERT_FALSE(hasError(messages)) << textOf(messages);
    ASSERT_FALSE(base.fragment.empty());
    EXPECT_EQ(off.fragment, base.fragment);
    EXPECT_EQ(off.vertex, base.vertex);
  }
}

// By the driver's count, which may be another than the one that the search goes by. Works without an
// environment, of which W3L once took more at level 2.
TEST(Works, AHigherLevelOfSearchIsNeverDearer) {
  if (const std::string reason = cost::unavailable(); !reason.empty()) GTEST_SKIP() << reason;
  for (const Work& work : kWorks) {
    if (work.name != std::string_view("W0L") && work.name != std::string_view("W3L")) continue;
    Options options;
    options.targets = {Target::Spirv};
    options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
    options.ibl = work.ibl;
    options.validate = false;
    Messages messages;
    const Scene scene = Scene::load(kRoot + "/bench/works/" + work.file, options, messages);
    std::vector<cost::Subject> levels;
    for (options.optimize = 0; options.optimize <= 2; ++options.optimize) {
      Graph graph = scene.graph(0, scene.uses(0)[0], options, messages);
      const Shader shader = graph.generate(options, messages);
      ASSERT_TRUE(shader) << textOf(messages);
      levels.push_back({work.name, shader.vertexSpirv(), shader.fragmentSpirv()});
    }
    const auto outcomes = cost::measure(levels, "navi21", false).outcomes;
    for (size_t level = 1; level < levels.size(); ++level)
      EXPECT_LE(outcomes[level].statistics->inverse_throughput,
                outcomes[level - 1].statistics->inverse_throughput)
          << work.name << ", level " << level;
  }
}

class Cost : public testing::TestWithParam<bool> {};

/// The works' direct SPIR-V on navi21, measured once in each mode: the same on every run (Driver).
const Table& directTable(bool multiple_scattering, Messages& messages) {
  static std::map<bool, std::pair<Table, Messages>> known;
  const auto [at, is_new] = known.try_emplace(multiple_scattering);
  auto& [table, said] = at->second;
  if (is_new)
    table = measureWorks(kRoot + "/bench/works", multiple_scattering, Route::Direct, {"navi21"}, said);
  messages.insert(messages.end(), said.begin(), said.end());
  return table;
}

TEST_P(Cost, HasNotRisen) {
  if (const std::string reason = cost::unavailable(); !reason.empty()) GTEST_SKIP() << reason;
  Messages messages;
  const Table& table = directTable(GetParam(), messages);
  ASSERT_FALSE(hasError(messages)) << textOf(messages);
  const nlohmann::json before = committed();
  ASSERT_TRUE(before.is_object()) << "bench/cost.json is missing or broken; `./dev bench cost` writes it";
  if (before.at("driver") != table.driver) {
    GTEST_SKIP() << "bench/cost.json was measured with " << before.at("driver") << ", this machine has "
                 << table.driver;
  }
  for (size_t i = 0; i < kWorks.size(); ++i) {
    const std::string mode = GetParam() ? "multiple_scattering" : "no_multiple_scattering";
    ASSERT_TRUE(before.at("works").contains(kWorks[i].name))
        << kWorks[i].name << " is not in bench/cost.json";
    const nlohmann::json& row = before.at("works").at(kWorks[i].name).at(mode).at("direct").at("navi21");
    const cost::Statistics& now = *table.rows[i].gpus.at("navi21").statistics;
    const auto check = [&](const char* name, uint64_t value) {
      const uint64_t was = row.at(name).get<uint64_t>();
      EXPECT_FALSE(risen(value, was)) << fmt::format(
          "{} ({}): {} rose from {} to {} on navi21. If that is meant, "
          "`./dev bench cost` renews the table",
          kWorks[i].name, mode, name, was, value);
    };
    check("instructions", now.instructions);
    check("inverse_throughput", now.inverse_throughput);
  }
}

/// What the optimizer would gain, which the direct SPIR-V has to have already. The two are not equal to the
/// digit: of a choice between values one makes a select, the other a branch.
TEST_P(Cost, OfTheDirectSpirvIsNotMoreThanOfTheOptimized) {
  if (const std::string reason = cost::unavailable(); !reason.empty()) GTEST_SKIP() << reason;
  Messages messages;
  const std::vector<std::string> families = {"navi21"};
  const Table& direct = directTable(GetParam(), messages);
  const Table optimized =
      measureWorks(kRoot + "/bench/works", GetParam(), Route::Optimized, families, messages);
  ASSERT_FALSE(hasError(messages)) << textOf(messages);
  for (size_t i = 0; i < kWorks.size(); ++i) {
    EXPECT_LE(direct.rows[i].spirv_instructions, optimized.rows[i].spirv_instructions) << kWorks[i].name;
    const cost::Statistics& ours = *direct.rows[i].gpus.at("navi21").statistics;
    const cost::Statistics& theirs = *optimized.rows[i].gpus.at("navi21").statistics;
    EXPECT_FALSE(risen(ours.instructions, theirs.instructions))
        << kWorks[i].name << ": " << ours.instructions << " instructions, optimized " << theirs.instructions;
    EXPECT_FALSE(risen(ours.inverse_throughput, theirs.inverse_throughput))
        << kWorks[i].name << ": " << ours.inverse_throughput << ", optimized " << theirs.inverse_throughput;
  }
}

INSTANTIATE_TEST_SUITE_P(Works, Cost, testing::Bool(), [](const testing::TestParamInfo<bool>& info) {
  return std::string(info.param ? "multiple_scattering" : "no_multiple_scattering");
});

}  // namespace
}  // namespace lacquer::bench
