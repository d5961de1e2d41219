// Finds the fragment shaders in files and folders, and has them measured.
#include "cost/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "check/reflect.h"
#include "json/json.h"
#include "lacquer/manifest.h"
#include "setting/messages.h"
#include "support/contain.h"
#include "support/file.h"
#include "support/text.h"
#include "targets/target.h"

namespace lacquer {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kModuleEnd = ".spv";
constexpr std::string_view kFragmentEnd = ".frag.spv";
constexpr std::string_view kVertexEnd = ".vert.spv";
constexpr uint64_t kLargestModule = uint64_t{1} << 26U;  // bytes; SPIR-V has 4,194,303 ids at most

struct SpirvFile {
  std::shared_ptr<const cost::Spirv> words;
  size_t instructions = 0;
};

/// What was read, by where it lies: a manifest may name one file many times, or many files that are equal.
/// Each is read once, and held once.
class SpirvFiles {
public:
  const Result<SpirvFile>& read(const std::string& path, Links links) {
    std::error_code error;
    std::string resolved = links == Links::None ? path : fs::canonical(path, error).string();
    if (error) resolved = path;
    const auto known = files_.find(resolved);
    return known != files_.end() ? known->second : files_.emplace(resolved, load(path, links)).first->second;
  }

private:
  struct ByWords {
    bool operator()(const SpirvFile& a, const SpirvFile& b) const {
      if (a.words->size() != b.words->size()) return a.words->size() < b.words->size();
      return *a.words < *b.words;
    }
  };

  Result<SpirvFile> load(const std::string& path, Links links);

  std::map<std::string, Result<SpirvFile>> files_;
  std::set<SpirvFile, ByWords> distinct_;
  uint64_t bytes_ = 0;  ///< of all that are distinct
};

tl::unexpected<Diagnostics> tooLarge(const std::string& path, std::string message) {
  return fail("spirv-too-large", {path, 0, 0, {}}, std::move(message),
              "name fewer modules at a time, or smaller ones");
}

Result<cost::Spirv> readSpirv(const std::string& path, Links links) {
  std::error_code error;
  const std::string too_large = fmt::format("a module has at most {} bytes", kLargestModule);
  if (fs::file_size(path, error) > kLargestModule && !error) return tooLarge(path, too_large);
  // It may have become longer.
  const Result<std::string> bytes = readFile(path, kLargestModule, links);
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

Result<SpirvFile> SpirvFiles::load(const std::string& path, Links links) {
  Result<cost::Spirv> words = readSpirv(path, links);
  if (!words) return tl::unexpected(words.error());
  const uint64_t size = words->size() * sizeof(uint32_t);
  SpirvFile file{std::make_shared<const cost::Spirv>(std::move(*words)), 0};
  if (const auto known = distinct_.find(file); known != distinct_.end()) return *known;
  const uint64_t most = Limits{}.file;
  if (size > most - bytes_)
    return tooLarge(path, fmt::format("with this module they have more than {} bytes together", most));
  bytes_ += size;
  file.instructions = cost::spirvInstructions(*file.words);
  return *distinct_.insert(std::move(file)).first;
}

/// The shaders that were found: what is measured of each, and where that goes.
struct Shaders {
  SpirvFiles files;
  std::vector<cost::FileSubject> subjects;
  std::vector<ShaderCost> costs;  ///< as many
};

/// Without `vertex` the fragment shader comes alone.
void addPair(const std::string& name, const std::optional<std::string>& vertex, const std::string& fragment,
             Links links, Shaders& shaders, Messages& messages) {
  cost::FileSubject subject;
  if (vertex) {
    const Result<SpirvFile>& file = shaders.files.read(*vertex, links);
    if (!file) return report(file.error(), *vertex, messages);
    subject.vertex = file->words;
  }
  const Result<SpirvFile>& file = shaders.files.read(fragment, links);
  if (!file) return report(file.error(), fragment, messages);
  subject.fragment = file->words;
  // A module may be a whole program.
  if (!vertex && check::hasEntryPoint(*file->words, check::Stage::Vertex)) subject.vertex = file->words;
  shaders.subjects.push_back(std::move(subject));
  shaders.costs.push_back({name, file->instructions, {}});
}

void addFile(const std::string& path, Shaders& shaders, Messages& messages) {
  std::optional<std::string> vertex;
  if (path.ends_with(kFragmentEnd)) {
    const std::string beside = path.substr(0, path.size() - kFragmentEnd.size()) + std::string(kVertexEnd);
    std::error_code error;
    if (fs::exists(beside, error)) vertex = beside;
  }
  addPair(path, vertex, path, Links::Follow, shaders, messages);
}

/// The file of that kind; empty where there is none.
std::string fileOf(const ManifestCode& code, std::string_view kind) {
  const auto it = std::find_if(code.files.begin(), code.files.end(),
                               [&](const auto& file) { return file.first == kind; });
  return it == code.files.end() ? std::string() : it->second;
}

void addManifest(const fs::path& folder, Shaders& shaders, Messages& messages) {
  const std::string path = (folder / "manifest.json").string();
  const std::optional<Manifest> manifest = readManifest(path, {}, messages);
  if (!manifest) return;
  const size_t before = shaders.subjects.size();
  for (const ManifestShader& shader : manifest->shaders) {
    const auto spirv = std::find_if(shader.targets.begin(), shader.targets.end(),
                                    [](const ManifestCode& code) { return targets::row(code.target).words; });
    if (spirv == shader.targets.end()) continue;
    const std::string vertex = fileOf(*spirv, "vert"), fragment = fileOf(*spirv, "frag");
    if (fragment.empty()) continue;
    // A link may lead out of the folder.
    std::optional<std::string> vertex_file = resolveBelow(folder.string(), vertex, {});
    const std::optional<std::string> file = resolveBelow(folder.string(), fragment, {});
    if (!vertex_file || !file) {
      report({{"manifest-outside",
               Severity::Error,
               {path, 0, 0, {}},
               "the files of " + quote(shader.id) + " lie outside of the folder",
               {},
               {}}},
             path, messages);
      continue;
    }
    if (vertex.empty()) vertex_file.reset();
    addPair(shader.id, vertex_file, *file, Links::None, shaders, messages);
  }
  if (shaders.subjects.size() > before || hasError(messages)) return;
  const Diagnostic none{"no-spirv",
                        Severity::Error,
                        {path, 0, 0, {}},
                        "the manifest lists no fragment shader in SPIR-V",
                        "generate with the target spirv",
                        {}};
  report({none}, path, messages);
}

bool holdsFragment(const Result<SpirvFile>& file) {
  return file && check::hasEntryPoint(*file->words, check::Stage::Fragment);
}

void addFolder(const fs::path& folder, Shaders& shaders, Messages& messages) {
  std::error_code error;
  if (fs::exists(folder / "manifest.json", error)) return addManifest(folder, shaders, messages);
  std::vector<std::string> files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().string();
    if (name.ends_with(kFragmentEnd) || (name.ends_with(kModuleEnd) && !name.ends_with(kVertexEnd) &&
                                         holdsFragment(shaders.files.read(name, Links::Follow))))
      files.push_back(name);
  }
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) addFile(file, shaders, messages);
  if (!files.empty()) return;
  const Diagnostic none{"no-spirv",
                        Severity::Error,
                        {folder.string(), 0, 0, {}},
                        "the folder holds neither a manifest.json nor .spv files of fragment shaders",
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

void measureAll(Shaders& shaders, bool disassembly, Messages& messages) {
  std::vector<cost::Measurement> measurements = cost::measureFiles(shaders.subjects, disassembly);
  for (size_t f = 0; f < measurements.size(); ++f) {
    for (size_t i = 0; i < shaders.costs.size(); ++i) {
      ShaderCost& shader = shaders.costs[i];
      shader.gpus.push_back(toGpuCost(cost::kFamilies[f], measurements[f].outcomes[i]));
      const GpuCost& gpu = shader.gpus.back();
      if (gpu.problem.empty()) continue;
      const Diagnostic failed{"cost-unknown",
                              Severity::Error,
                              {shader.name, 0, 0, {}},
                              fmt::format("no cost for {}: {}", gpu.gpu, gpu.problem),
                              {},
                              {}};
      report({failed}, shader.name, messages);
    }
  }
}

void addPath(const std::string& path, Shaders& shaders, Messages& messages) {
  std::error_code error;
  if (path.empty()) {
    const Diagnostic empty{"file-unreadable",
                           Severity::Error,
                           {},
                           "\"\" is the name of no file",
                           "name .spv files, or folders that hold some",
                           {}};
    report({empty}, {}, messages);
  } else if (fs::is_directory(path, error)) {
    addFolder(path, shaders, messages);
  } else {
    addFile(path, shaders, messages);
  }
}

std::vector<ShaderCost> measured(Shaders shaders, bool disassembly, Messages& messages) {
  if (const std::string reason = cost::unavailable(); reason.empty()) {
    if (!shaders.subjects.empty()) measureAll(shaders, disassembly, messages);
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
  return std::move(shaders.costs);
}

}  // namespace

std::vector<ShaderCost> measureCost(const std::vector<std::string>& paths, bool disassembly,
                                    Messages& messages) {
  Shaders shaders;
  for (const std::string& path : paths) addPath(path, shaders, messages);
  return measured(std::move(shaders), disassembly, messages);
}

std::vector<ShaderCost> measureCostOf(std::vector<cost::Subject> shaders, bool disassembly,
                                      Messages& messages) {
  Shaders all;
  const auto shared = [](cost::Spirv& words) {
    return words.empty() ? nullptr : std::make_shared<const cost::Spirv>(std::move(words));
  };
  std::map<std::string, cost::FileSubject> known;
  for (cost::Subject& shader : shaders) {
    if (shader.fragment.empty()) continue;
    const size_t instructions = cost::spirvInstructions(shader.fragment);
    const auto [it, fresh] = known.try_emplace(shader.name);
    if (fresh) it->second = {shared(shader.vertex), shared(shader.fragment)};
    all.subjects.push_back(it->second);
    all.costs.push_back({shader.name, instructions, {}});
  }
  return measured(std::move(all), disassembly, messages);
}

}  // namespace lacquer
