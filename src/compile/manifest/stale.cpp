#include "manifest/stale.h"

#include <filesystem>
#include <set>

#include "json/json.h"
#include "setting/options.h"
#include "shader/module.h"
#include "shader/print.h"
#include "support/file.h"
#include "support/outputs.h"

namespace lacquer {

/// Leaves of a manifest as it is written only what stands behind its files: they are most of it.
static void dropFiles(std::string& text) {
  constexpr std::string_view kFirst = "{\n  \"lacquer\": ", kShaders = ",\n  \"shaders\": {";
  const size_t at = text.rfind(kShaders);
  const size_t files = text.find(",\n  \"schema\": ");
  if (text.starts_with(kFirst) && files < at && at != std::string::npos) text.erase(files, at - files);
}

std::vector<std::string> listedShaders(const std::string& path) {
  std::vector<std::string> listed;
  Result<std::string> text = readFile(path);
  if (!text) return listed;
  dropFiles(*text);
  const Result<json::Json> manifest = json::parse(*text, path);
  if (!manifest || json::member(*manifest, "lacquer") == nullptr) return listed;
  const json::Json* shaders = json::member(*manifest, "shaders");
  if (shaders == nullptr || !shaders->is_object()) return listed;
  // What the paths are follows from the ids: a manifest that says otherwise has no say.
  for (const auto& [id, shader] : shaders->items()) {
    const json::Json* files = json::member(shader, "files");
    if (!isShaderId(id) || files == nullptr) continue;
    for (const std::string& name : targetNames()) {
      Target target{};
      findTarget(name, target);
      if (json::member(*files, targetName(target)) == nullptr) continue;
      for (int stage = firstStage(target, true); stage < 2; ++stage)
        listed.push_back(shaderPath(target, id, stage));
    }
  }
  return listed;
}

void removeStale(const std::string& folder, const std::vector<std::string>& earlier,
                 const std::vector<std::string>& kept, const std::vector<std::string>& inputs) {
  namespace fs = std::filesystem;
  const std::set<std::string> needed(kept.begin(), kept.end());
  for (const std::string& path : earlier) {
    const std::string file = folder + "/" + path;
    std::error_code ignored;  // what cannot be removed stays, and harms nobody
    if (needed.contains(path) || !fs::is_regular_file(fs::symlink_status(file, ignored))) continue;
    if (clashes(inputs, {file}).empty()) fs::remove(file, ignored);
  }
}

void removeManifest(const std::string& path) {
  std::error_code ignored;
  if (!listedShaders(path).empty()) std::filesystem::remove(path, ignored);
}

}  // namespace lacquer
