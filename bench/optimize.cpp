#include "bench/optimize.h"

#include <fmt/format.h>

#include <array>
#include <ctime>
#include <nlohmann/json.hpp>

#include "bench/page.h"
#include "bench/works.h"
#include "cost/cost.h"
#include "support/file.h"

namespace lacquer::bench {

namespace {

using Json = nlohmann::ordered_json;

const std::string kRoot = LACQUER_SOURCE_FOLDER;
constexpr double kError = 1e-3;

/// How much is searched: what a column of the table shows.
struct Setting {
  const char* name;
  uint32_t level;
  double error;
};
constexpr Setting kSettings[] = {
    {"plain", 0, 0}, {"level 1", 1, 0}, {"level 2", 2, 0}, {"level 2, error 1e-3", 2, kError}};
constexpr size_t kCount = std::size(kSettings);

/// Cycles on navi21 that are wanted of a work: with equal forms alone, and with approximations.
struct Goal {
  const char* work;
  uint64_t exact, approximate;
};
constexpr Goal kGoals[] = {{"W0", 236, 215}, {"W0L", 140, 128}, {"W1", 293, 265},  {"W1L", 177, 160},
                           {"W2", 512, 470}, {"W3", 510, 460},  {"W3L", 322, 290}, {"A", 410, 370},
                           {"AL", 255, 232}, {"B", 482, 440},   {"BL", 360, 325},  {"C", 790, 700},
                           {"CL", 540, 480}};

struct Cell {
  cost::Subject subject;
  double seconds = 0;  ///< of one core
  double growth = 1, error = 0;
  double cycles = 0, of_cycles = 0;  ///< as the manifest has them
  cost::Statistics statistics;
};

Cell make(const Work& work, const std::string& profile, const Setting& setting, Messages& messages,
          const std::string& family = {}) {
  Options options;
  options.targets = {Target::Spirv};
  options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
  options.profile = profile;
  options.ibl = work.ibl;
  options.validate = false;
  options.optimize = setting.level;
  options.optimize_error = setting.error;
  options.optimize_for = family;
  Cell cell;
  cell.subject.name = work.name;
  const Scene scene = Scene::load(kRoot + "/bench/works/" + work.file, options, messages);
  if (!scene || scene.uses(0).empty()) return cell;
  Graph graph = scene.graph(0, scene.uses(0)[0], options, messages);
  if (!graph) return cell;
  const std::clock_t begin = std::clock();
  const Shader shader = graph.generate(options, messages);
  cell.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  if (!shader) return cell;
  cell.subject.vertex = shader.vertexSpirv();
  cell.subject.fragment = shader.fragmentSpirv();
  if (const auto& figures = shader.reflection().optimized) {
    cell.growth = figures->error_growth;
    cell.error = figures->error;
    cell.cycles = figures->cycles;
    cell.of_cycles = figures->of_cycles;
  }
  return cell;
}

/// Compiles all cells at once. False where the driver refuses one.
bool measure(std::vector<Cell>& cells, std::string& driver) {
  std::vector<cost::Subject> subjects;
  for (const Cell& cell : cells) subjects.push_back(cell.subject);
  const cost::Measurement measured = cost::measure(subjects, "navi21", false);
  driver = measured.driver;
  for (size_t i = 0; i < cells.size(); ++i) {
    if (!measured.outcomes[i].statistics) {
      fmt::print(stderr, "bench optimize: {}: {}\n", subjects[i].name, measured.outcomes[i].problem);
      return false;
    }
    cells[i].statistics = *measured.outcomes[i].statistics;
  }
  return true;
}

const Goal* goalOf(const Work& work) {
  for (const Goal& goal : kGoals) {
    if (work.name == goal.work) return &goal;
  }
  return nullptr;
}

/// Cells stand by work, then by setting.
std::string markdown(const std::vector<Cell>& cells, const std::string& driver) {
  std::string text = fmt::format("{}, cycles of inverse throughput on navi21.\n\n| work |", driver);
  for (const Setting& setting : kSettings) text += fmt::format(" {} |", setting.name);
  text += " goals: equal forms / error 1e-3 | bounds of errors grow by |\n|---|";
  for (size_t i = 0; i < kCount + 2; ++i) text += "---|";
  text += "\n";
  std::array<uint64_t, kCount> cycles{};
  std::array<double, kCount> seconds{};
  std::string unchanged;
  for (size_t w = 0; w < kWorks.size(); ++w) {
    const Cell* row = &cells[w * kCount];
    const Goal* goal = goalOf(kWorks[w]);
    const std::string goals = goal ? fmt::format("{} / {}", goal->exact, goal->approximate) : "none";
    std::string columns;
    bool cheaper = false;
    for (size_t s = 0; s < kCount; ++s) {
      cycles[s] += row[s].statistics.inverse_throughput;
      seconds[s] += row[s].seconds - row[0].seconds;
      cheaper |= row[s].statistics.inverse_throughput < row[0].statistics.inverse_throughput;
      columns += fmt::format(" {} |", row[s].statistics.inverse_throughput);
    }
    if (cheaper)
      text += fmt::format("| {} |{} {} | {:.2f} |\n", kWorks[w].name, columns, goals, row[3].growth);
    else
      unchanged += fmt::format("{}{} ({}; {})", unchanged.empty() ? "" : ", ", kWorks[w].name,
                               row[0].statistics.inverse_throughput, goals);
  }
  text += "| all |";
  for (const uint64_t sum : cycles) text += fmt::format(" {} |", sum);
  text += " | |\n| seconds of a core, in the mean | |";
  for (size_t s = 1; s < kCount; ++s)
    text += fmt::format(" {:.1f} |", seconds[s] / static_cast<double>(kWorks.size()));
  text += " | |\n";
  if (!unchanged.empty())
    text += fmt::format("\nNothing cheaper is found of, with cycles and goals: {}.\n", unchanged);
  return text;
}

Json toJson(const std::vector<Cell>& cells, const std::string& driver) {
  Json json;
  json["driver"] = driver;
  for (size_t w = 0; w < kWorks.size(); ++w) {
    for (size_t s = 0; s < kCount; ++s) {
      const Cell& cell = cells[w * kCount + s];
      json["works"][kWorks[w].name][kSettings[s].name] = {
          {"instructions", cell.statistics.instructions},
          {"inverse_throughput", cell.statistics.inverse_throughput},
          {"error_growth", cell.growth},
          {"error", cell.error}};
    }
  }
  return json;
}

/// What `physical` costs beside `openpbr`.
std::string profiles(bool& good, Messages& messages) {
  std::vector<Cell> cells;
  std::vector<const Work*> works;
  for (const Work& work : kWorks) {
    if (work.name == "W1" || work.name == "W2") works.push_back(&work);
  }
  for (const Work* work : works) {
    for (const Setting& setting : {kSettings[0], kSettings[1]}) {
      for (const char* profile : {"openpbr", "physical"})
        cells.push_back(make(*work, profile, setting, messages));
    }
  }
  std::string driver;
  good = !hasError(messages) && measure(cells, driver);
  if (!good) return "";
  std::string text =
      "\n| work | openpbr | physical | more | openpbr, level 1 | physical, level 1 | more |\n"
      "|---|---|---|---|---|---|---|\n";
  for (size_t w = 0; w < works.size(); ++w) {
    text += "| " + works[w]->name;
    for (size_t s = 0; s < 2; ++s) {
      const uint64_t a = cells[4 * w + 2 * s].statistics.inverse_throughput;
      const uint64_t b = cells[4 * w + 2 * s + 1].statistics.inverse_throughput;
      text += fmt::format(" | {} | {} | {:.0f} %", a, b,
                          100 * (static_cast<double>(b) / static_cast<double>(a) - 1));
    }
    text += " |\n";
  }
  return text;
}

/// What the search makes of the works for GPUs whose compiler is not there, by their model.
std::string otherFamily(const std::string& family, Messages& messages) {
  std::string text = fmt::format(
      "\nWorks that get cheaper for {}, by its model:\n\n| work | plain | level 1 |\n|---|---|---|\n",
      family);
  for (const Work& work : kWorks) {
    const Cell own = make(work, Options().profile, kSettings[1], messages, family);
    if (own.cycles < own.of_cycles)
      text += fmt::format("| {} | {:.0f} | {:.0f} |\n", work.name, own.of_cycles, own.cycles);
  }
  return text;
}

int measureAll() {
  if (const std::string reason = cost::unavailable(); !reason.empty()) {
    fmt::print(stderr, "bench optimize: {}\n", reason);
    return 1;
  }
  Messages messages;
  std::vector<Cell> cells;
  for (const Work& work : kWorks) {
    for (const Setting& setting : kSettings) {
      cells.push_back(make(work, Options().profile, setting, messages));
      fmt::print(stderr, "{} {}\n", work.name, setting.name);
    }
  }
  std::string driver;
  bool good = !hasError(messages) && measure(cells, driver);
  std::string text = good ? markdown(cells, driver) : "";
  if (good) text += profiles(good, messages);
  if (good) text += otherFamily("valhall", messages);
  for (const Message& message : messages) fmt::print(stderr, "{}\n", message.text);
  if (!good) return 1;
  fmt::print("{}", text);
  if (writeFile(kRoot + "/bench/optimize.json", toJson(cells, driver).dump(2) + "\n") &&
      renewPage(kRoot + "/docs/optimize.md", text)) {
    return 0;
  }
  fmt::print(stderr, "bench optimize: bench/optimize.json and docs/optimize.md could not be renewed\n");
  return 1;
}

}  // namespace

int runOptimize() { return measureAll(); }

}  // namespace lacquer::bench
