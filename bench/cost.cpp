#include "bench/cost.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/page.h"
#include "bench/works.h"
#include "support/file.h"

namespace lacquer::bench {
namespace {

using Json = nlohmann::ordered_json;

const std::string kRoot = LACQUER_SOURCE_FOLDER;

/// All that is measured: with and without compensation for multiple scattering, directly and through an
/// optimizer.
struct Tables {
  std::array<Table, 2> direct, optimized;  ///< [0] with compensation
};

Json toJson(const Row& row) {
  Json json;
  json["spirv_instructions"] = row.spirv_instructions;
  for (const std::string& family : cost::kFamilies) {
    const cost::Statistics& s = *row.gpus.at(family).statistics;
    json[family] = {{"instructions", s.instructions},
                    {"inverse_throughput", s.inverse_throughput},
                    {"latency", s.latency},
                    {"vgprs", s.vgprs},
                    {"sgprs", s.sgprs},
                    {"spilled", s.spilled_sgprs + s.spilled_vgprs}};
  }
  return json;
}

Json toJson(const Tables& tables) {
  Json json;
  json["driver"] = tables.direct[0].driver;
  for (size_t i = 0; i < kWorks.size(); ++i) {
    Json& work = json["works"][kWorks[i].name];
    for (size_t mode = 0; mode < 2; ++mode) {
      Json& entry = work[mode == 0 ? "multiple_scattering" : "no_multiple_scattering"];
      entry["direct"] = toJson(tables.direct[mode].rows[i]);
      entry["glslang_and_spirv_opt"] = toJson(tables.optimized[mode].rows[i]);
    }
  }
  return json;
}

std::string pair(const Row& row) {
  const cost::Statistics& s = *row.gpus.at("navi21").statistics;
  return fmt::format("{} / {}", s.instructions, s.inverse_throughput);
}

/// What the works need on navi21, beside the goals. bench/cost.json has more, and the peers have a table of
/// their own.
std::string markdown(const Tables& tables) {
  std::string text =
      fmt::format("{}, navi21, instructions / inverse throughput.\n\n", tables.direct[0].driver);
  text +=
      "| work | | SPIR-V | cost | at most | with `--no-multiple-scattering` |\n|---|---|---|---|---|---|\n";
  for (size_t i = 0; i < kWorks.size(); ++i) {
    const Work& work = kWorks[i];
    const Row& row = tables.direct[0].rows[i];
    const cost::Statistics& s = *row.gpus.at("navi21").statistics;
    const bool met =
        s.instructions <= work.goal.instructions && s.inverse_throughput <= work.goal.inverse_throughput;
    text += fmt::format("| {} | {} | {} | **{}** | {} / {}{} | {} |\n", work.name, work.what,
                        row.spirv_instructions, pair(row), work.goal.instructions,
                        work.goal.inverse_throughput, met ? "" : " (missed)", pair(tables.direct[1].rows[i]));
  }
  return text;
}

}  // namespace

int runCost() {
  if (const std::string reason = cost::unavailable(); !reason.empty()) {
    fmt::print(stderr, "bench cost: {}\n", reason);
    return 1;
  }
  Tables tables;
  Messages messages;
  for (size_t mode = 0; mode < 2; ++mode) {
    const std::string folder = kRoot + "/bench/works";
    tables.direct[mode] = measureWorks(folder, mode == 0, Route::Direct, cost::kFamilies, messages);
    tables.optimized[mode] = measureWorks(folder, mode == 0, Route::Optimized, cost::kFamilies, messages);
  }
  for (const Message& message : messages) fmt::print(stderr, "{}\n", message.text);
  if (hasError(messages)) return 1;
  const std::string text = markdown(tables);
  fmt::print("{}", text);
  const bool written = writeFile(kRoot + "/bench/cost.json", toJson(tables).dump(2) + "\n").has_value();
  if (written && renewPage(kRoot + "/docs/cost.md", text)) return 0;
  fmt::print(stderr, "bench cost: bench/cost.json and docs/cost.md could not be renewed\n");
  return 1;
}

}  // namespace lacquer::bench
