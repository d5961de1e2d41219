#include "cli/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/table.h"
#include "json/json.h"

namespace lacquer::cli {
namespace {

void printJson(const std::vector<ShaderCost>& costs) {
  json::Json shaders = json::Json::array();
  for (const ShaderCost& shader : costs) {
    json::Json gpus = json::Json::object();
    for (const GpuCost& gpu : shader.gpus) {
      json::Json& row = gpus[gpu.gpu];
      if (!gpu.problem.empty()) {
        row = {{"problem", gpu.problem}};
        continue;
      }
      row = {{"instructions", gpu.instructions},
             {"sgprs", gpu.sgprs},
             {"vgprs", gpu.vgprs},
             {"spilled_sgprs", gpu.spilled_sgprs},
             {"spilled_vgprs", gpu.spilled_vgprs},
             {"code_size", gpu.code_size},
             {"latency", gpu.latency},
             {"inverse_throughput", gpu.inverse_throughput}};
      if (!gpu.disassembly.empty()) row["disassembly"] = gpu.disassembly;
    }
    shaders.push_back(
        {{"shader", shader.name}, {"spirv_instructions", shader.spirv_instructions}, {"gpus", gpus}});
  }
  fmt::print("{}\n", json::Json{{"shaders", shaders}}.dump(2));
}

std::string cells(const GpuCost& gpu) {
  if (!gpu.problem.empty()) return fmt::format(" | {:>12} {:>5} {:>5} {:>7} {:>14}", "-", "-", "-", "-", "-");
  return fmt::format(" | {:>12} {:>5} {:>5} {:>7} {:>14}", gpu.instructions, gpu.vgprs, gpu.sgprs,
                     gpu.latency, gpu.inverse_throughput);
}

void printTable(const std::vector<ShaderCost>& costs) {
  size_t width = 6;
  for (const ShaderCost& shader : costs) width = std::max(width, printable(shader.name).size());
  const std::vector<GpuCost>& gpus = costs[0].gpus;
  if (!gpus.empty()) {
    std::string head = fmt::format("{:{}}", "", width + 8);
    for (const GpuCost& gpu : gpus) head += fmt::format(" | {:47}", gpu.gpu);
    fmt::print("{}\n", head.substr(0, head.find_last_not_of(' ') + 1));
  }
  std::string head = fmt::format("{:{}} {:>7}", "shader", width, "SPIR-V");
  for (size_t i = 0; i < gpus.size(); ++i) head += " | instructions VGPRs SGPRs latency inv.throughput";
  fmt::print("{}\n", head);
  for (const ShaderCost& shader : costs) {
    std::string line = fmt::format("{:{}} {:>7}", printable(shader.name), width, shader.spirv_instructions);
    for (const GpuCost& gpu : shader.gpus) line += cells(gpu);
    fmt::print("{}\n", line);
  }
  for (const ShaderCost& shader : costs) {
    for (const GpuCost& gpu : shader.gpus) {
      if (gpu.spilled_sgprs + gpu.spilled_vgprs == 0) continue;
      fmt::print("{} spills {} SGPRs and {} VGPRs on {}\n", printable(shader.name), gpu.spilled_sgprs,
                 gpu.spilled_vgprs, gpu.gpu);
    }
  }
}

}  // namespace

void printCosts(const std::vector<ShaderCost>& costs, bool as_json) {
  if (as_json) return printJson(costs);
  if (costs.empty()) return;
  printTable(costs);
  for (const ShaderCost& shader : costs) {
    for (const GpuCost& gpu : shader.gpus) {
      if (!gpu.disassembly.empty())
        fmt::print("\n{} on {}:\n{}\n", printable(shader.name), gpu.gpu, gpu.disassembly);
    }
  }
}

}  // namespace lacquer::cli
