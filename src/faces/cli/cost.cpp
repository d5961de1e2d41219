#include "cli/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/graphs.h"
#include "cli/streams.h"
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
  fmt::print("{}\n", json::dump({{"shaders", shaders}}, 2));
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

bool holdsMaterials(const std::string& path) {
  return isGraphFile(path) || path.ends_with(".gltf") || path.ends_with(".glb") || path.ends_with(".mtlx");
}

}  // namespace

std::vector<ShaderCost> measurePaths(const std::vector<std::string>& paths,
                                     const std::vector<std::string>& materials, bool disassembly,
                                     const Options& options, Messages& messages) {
  std::vector<std::string> made, files;
  for (const std::string& path : paths) (holdsMaterials(path) ? files : made).push_back(path);
  std::vector<ShaderCost> costs;
  if (!made.empty()) costs = measureCost(made, disassembly, messages);
  if (files.empty()) return costs;
  Options spirv = options;
  spirv.targets = {Target::Spirv};
  spirv.validate = false;
  std::vector<Shader> shaders;
  size_t found = 0;
  const auto each = [&](Graph graph) {
    Shader shader = graph.generate(spirv, messages);
    if (!shader) return false;
    const auto known = [&](const Shader& other) { return other.id() == shader.id(); };
    if (std::none_of(shaders.begin(), shaders.end(), known)) shaders.push_back(std::move(shader));
    return true;
  };
  if (eachGraph(files, materials, options, messages, each, found) && found == 0 && !materials.empty())
    say("{}: error: no material of that name [no-such-material]\n", printable(files[0]));
  for (ShaderCost& cost : measureCost(shaders, disassembly, messages)) costs.push_back(std::move(cost));
  return costs;
}

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
