// Finds the fragment shaders in files and folders, and has them measured.
#include "cost/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <future>
#include <optional>

#include "json/json.h"
#include "lacquer/tools.h"
#include "run/manifest_check.h"
#include "shader/messages.h"
#include "support/contain.h"
#include "support/file.h"
#include "support/text.h"

namespace lacquer {
namespace {

namespace fs = std::filesystem;
using Subjects = std::vector<lacquer::cost::Subject>;

constexpr std::string_view kFragmentEnd = ".frag.spv";
constexpr std::string_view kVertexEnd = ".vert.spv";

Result<cost::Spirv> readSpirv(const std::string& path) {
  const Result<std::string> bytes = readFile(path);
  if (!bytes) return tl::unexpected(bytes.error());
  cost::Spirv words(bytes->size() / 4);
  for (size_t i = 0; i < words.size(); ++i) {
    for (size_t byte = 0; byte < 4; ++byte) {
      words[i] |= static_cast<uint32_t>(static_cast<unsigned char>((*bytes)[4 * i + byte])) << (8 * byte);
    }
  }
  if (bytes->size() % 4 != 0 || words.empty() || words[0] != 0x07230203) {
    return fail("spirv-unreadable", {path, 0, 0, {}}, "this is no SPIR-V module",
                "name .spv files of fragment shaders");
  }
  return words;
}

/// Empty `vertex`: the fragment shader comes alone.
void addPair(const std::string& name, const std::string& vertex, const std::string& fragment,
             Subjects& subjects, Messages& messages) {
  cost::Subject subject;
  subject.name = name;
  for (const auto& [path, words] :
       {std::pair(&vertex, &subject.vertex), std::pair(&fragment, &subject.fragment)}) {
    if (path->empty()) continue;
    Result<cost::Spirv> read = readSpirv(*path);
    if (!read) return report(read.error(), *path, messages);
    *words = std::move(*read);
  }
  subjects.push_back(std::move(subject));
}

void addFile(const std::string& path, Subjects& subjects, Messages& messages) {
  std::string vertex;
  if (path.ends_with(kFragmentEnd)) {
    const std::string beside = path.substr(0, path.size() - kFragmentEnd.size()) + std::string(kVertexEnd);
    std::error_code error;
    if (fs::exists(beside, error)) vertex = beside;
  }
  addPair(path, vertex, path, subjects, messages);
}

/// The value at a path of keys when it is a text; else empty.
std::string textAt(const json::Json& json, std::initializer_list<const char*> keys) {
  const json::Json* at = &json;
  for (const char* key : keys) {
    at = json::member(*at, key);
    if (at == nullptr) return {};
  }
  return at->is_string() ? at->get<std::string>() : std::string();
}

void addManifest(const fs::path& folder, Subjects& subjects, Messages& messages) {
  const std::string path = (folder / "manifest.json").string();
  const Result<std::string> text = readFile(path);
  if (!text) return report(text.error(), path, messages);
  const Result<json::Json> manifest = json::parse(*text, path);
  if (!manifest) return report(manifest.error(), path, messages);
  if (const Result<void> head = checkManifestHead(*manifest, path); !head)
    return report(head.error(), path, messages);
  const json::Json* shaders = json::member(*manifest, "shaders");
  const size_t before = subjects.size();
  for (const auto& [id, shader] : shaders->items()) {
    const std::string vertex = textAt(shader, {"files", "spirv", "vert"});
    const std::string fragment = textAt(shader, {"files", "spirv", "frag"});
    if (fragment.empty()) continue;
    // A manifest of others does not choose which files are read.
    const std::optional<std::string> vertex_file = resolveBelow(folder.string(), vertex, {});
    const std::optional<std::string> file = resolveBelow(folder.string(), fragment, {});
    if (!vertex_file || !file) {
      report({{"manifest-outside",
               Severity::Error,
               {path, 0, 0, {}},
               "the files of " + quote(id) + " lie outside of the folder",
               {},
               {}}},
             path, messages);
      continue;
    }
    addPair(id, vertex.empty() ? "" : *vertex_file, *file, subjects, messages);
  }
  if (subjects.size() > before || hasError(messages)) return;
  const Diagnostic none{"no-spirv",
                        Severity::Error,
                        {path, 0, 0, {}},
                        "the manifest lists no fragment shader in SPIR-V",
                        "generate with the target spirv",
                        {}};
  report({none}, path, messages);
}

void addFolder(const fs::path& folder, Subjects& subjects, Messages& messages) {
  std::error_code error;
  if (fs::exists(folder / "manifest.json", error)) return addManifest(folder, subjects, messages);
  std::vector<std::string> files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().string();
    if (name.ends_with(kFragmentEnd)) files.push_back(name);
  }
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) addFile(file, subjects, messages);
  if (!files.empty()) return;
  const Diagnostic none{"no-spirv",
                        Severity::Error,
                        {folder.string(), 0, 0, {}},
                        "the folder holds neither a manifest.json nor *.frag.spv files",
                        "name a folder that `lacquer gen` wrote, or .spv files",
                        {}};
  report({none}, folder.string(), messages);
}

GpuCost toGpuCost(const std::string& family, cost::Outcome& outcome) {
  GpuCost result;
  result.gpu = family;
  result.problem = std::move(outcome.problem);
  result.disassembly = std::move(outcome.disassembly);
  if (!outcome.statistics) return result;
  const cost::Statistics& s = *outcome.statistics;
  result.instructions = s.instructions;
  result.sgprs = s.sgprs;
  result.vgprs = s.vgprs;
  result.spilled_sgprs = s.spilled_sgprs;
  result.spilled_vgprs = s.spilled_vgprs;
  result.code_size = s.code_size;
  result.latency = s.latency;
  result.inverse_throughput = s.inverse_throughput;
  return result;
}

void measureAll(const Subjects& subjects, bool disassembly, std::vector<ShaderCost>& costs,
                Messages& messages) {
  std::vector<std::future<cost::Measurement>> running;
  for (const std::string& family : cost::kFamilies) {
    running.push_back(std::async(std::launch::async, [&subjects, &family, disassembly] {
      return cost::measure(subjects, family, disassembly);
    }));
  }
  for (size_t f = 0; f < running.size(); ++f) {
    cost::Measurement measurement = running[f].get();
    for (size_t i = 0; i < costs.size(); ++i) {
      costs[i].gpus.push_back(toGpuCost(cost::kFamilies[f], measurement.outcomes[i]));
      const GpuCost& gpu = costs[i].gpus.back();
      if (gpu.problem.empty()) continue;
      const Diagnostic failed{"cost-unknown",
                              Severity::Error,
                              {costs[i].name, 0, 0, {}},
                              fmt::format("no cost for {}: {}", gpu.gpu, gpu.problem),
                              {},
                              {}};
      report({failed}, costs[i].name, messages);
    }
  }
}

}  // namespace

std::vector<ShaderCost> measureCost(const std::vector<std::string>& paths, bool disassembly,
                                    Messages& messages) {
  Subjects subjects;
  for (const std::string& path : paths) {
    std::error_code error;
    if (fs::is_directory(path, error)) {
      addFolder(path, subjects, messages);
    } else {
      addFile(path, subjects, messages);
    }
  }
  std::vector<ShaderCost> costs;
  for (const cost::Subject& subject : subjects) {
    costs.push_back({subject.name, cost::spirvInstructions(subject.fragment), {}});
  }
  if (const std::string reason = cost::unavailable(); reason.empty()) {
    if (!subjects.empty()) measureAll(subjects, disassembly, costs, messages);
  } else {
    const Diagnostic missing{
        "cost-unavailable",
        Severity::Warning,
        {},
        fmt::format("only SPIR-V instructions can be counted: {}", reason),
        "install the Vulkan loader and Mesa's drivers (Debian: libvulkan1, mesa-vulkan-drivers)",
        {}};
    report({missing}, {}, messages);
  }
  return costs;
}

}  // namespace lacquer
