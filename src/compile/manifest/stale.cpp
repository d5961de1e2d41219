#include "manifest/stale.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <utility>

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

/// Adds the paths of all files that a target writes for the shader `id`.
static void addPaths(Target target, const std::string& id, std::vector<std::string>& paths) {
  for (int stage = firstStage(target, true); stage < 2; ++stage)
    paths.push_back(shaderPath(target, id, stage));
}

/// True for what addPaths() may give, so that a note has no say about other files.
static bool isShaderPath(const std::string& path) {
  const size_t begin = path.find('/') + 1;
  const std::string id = path.substr(begin, path.find('.', begin) - begin);
  std::vector<std::string> paths;
  for (const std::string& name : targetNames()) {
    Target target{};
    if (isShaderId(id) && findTarget(name, target)) addPaths(target, id, paths);
  }
  return std::find(paths.begin(), paths.end(), path) != paths.end();
}

std::vector<std::string> listedShaders(const std::string& path) {
  std::vector<std::string> listed;
  Result<std::string> text = readFile(path);
  if (!text) return listed;
  dropFiles(*text);
  Result<json::Json> manifest = json::parse(*text, path);
  if (!manifest) return listed;
  // Memory may have run out when it goes.
  struct Dismantled {
    json::Json& json;
    ~Dismantled() { json::dismantle(json); }
  } const dismantled{*manifest};
  if (json::member(*manifest, "lacquer") == nullptr) return listed;
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
      addPaths(target, id, listed);
    }
  }
  return listed;
}

void removeStale(const std::string& folder, const std::vector<std::string>& earlier,
                 const std::vector<std::string>& kept, const std::vector<std::string>& inputs) {
  namespace fs = std::filesystem;
  const std::set<std::string> needed(kept.begin(), kept.end());
  std::set<std::string> left;  // folders of targets
  std::error_code ignored;     // what cannot be removed stays, and harms nobody
  for (const std::string& path : earlier) {
    const std::string file = folder + "/" + path;
    if (needed.contains(path) || !fs::is_regular_file(fs::symlink_status(file, ignored))) continue;
    if (clashes(inputs, {file}).empty() && fs::remove(file, ignored))
      left.insert(folder + "/" + path.substr(0, path.find('/')));
  }
  for (const std::string& target : left) {
    if (fs::is_directory(fs::symlink_status(target, ignored))) fs::remove(target, ignored);  // an empty one
  }
}

LeftShaders::LeftShaders(std::string folder, Scratch& scratch, std::vector<std::string> earlier)
    : folder_(std::move(folder)), scratch_(scratch), earlier_(std::move(earlier)) {
  for (const std::string& note : scratch_.notes()) {
    std::istringstream lines(note);
    for (std::string path; std::getline(lines, path);) {
      if (isShaderPath(path)) earlier_.push_back(path);
    }
  }
}

void LeftShaders::expect(const std::vector<std::string>& paths) {
  const std::set<std::string> needed(paths.begin(), paths.end());
  std::set<std::string> all(earlier_.begin(), earlier_.end());
  const auto goes = [&](const std::string& path) {
    std::error_code ignored;
    return !needed.contains(path) && std::filesystem::exists(folder_ + "/" + path, ignored);
  };
  // A run that is killed leaves no file behind where the lists before and after it name the same ones.
  if (scratch_.notes().empty() && std::includes(all.begin(), all.end(), needed.begin(), needed.end()) &&
      std::none_of(all.begin(), all.end(), goes)) {
    return;
  }
  all.insert(paths.begin(), paths.end());
  std::string text;
  for (const std::string& path : all) text += path + '\n';
  scratch_.note(text);
}

void LeftShaders::remove(const std::vector<std::string>& kept, const std::vector<std::string>& inputs) {
  removeStale(folder_, earlier_, kept, inputs);
  scratch_.forget();
}

void removeManifest(const std::string& path) {
  std::error_code ignored;
  if (!listedShaders(path).empty()) std::filesystem::remove(path, ignored);
}

}  // namespace lacquer
