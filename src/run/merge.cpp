#include <map>
#include <string>
#include <utility>
#include <vector>

#include "json/json.h"
#include "json/text.h"
#include "run/manifest.h"
#include "run/manifest_check.h"
#include "shader/messages.h"
#include "shader/options.h"
#include "support/outputs.h"
#include "support/relative.h"
#include "support/text.h"

namespace lacquer {

namespace {

constexpr size_t kEntryDepth = 2;  ///< manifest, "files" or "shaders"

Result<Json> readManifest(const std::string& path, std::vector<NamedShader>& named) {
  const Result<std::string> text = readFile(path);
  if (!text) return tl::make_unexpected(text.error());
  Result<Json> json = json::parse(*text, path);
  if (!json) return json;
  if (Result<void> good = checkManifest(*json, path, named); !good)
    return tl::make_unexpected(std::move(good.error()));
  return json;
}

/// What a file's entry says of its source holds in the new manifest's folder.
void rebase(Json& file, const std::string& from, const std::string& to) {
  const Json* source = json::member(file, "source");
  if (source == nullptr || !source->is_string()) return;
  file["source"] = moved(source->get<std::string>(), from, to);
}

std::string entryText(const Json& json) { return JsonText(kEntryDepth).json(json).take(); }

using Shaders = std::map<std::string, std::pair<std::string, std::string>>;  ///< id: entry, where it is from

/// An error for each use whose shader is in none of the shards.
Diagnostics absent(const std::vector<std::pair<std::string, std::vector<NamedShader>>>& named,
                   const Shaders& shaders) {
  Diagnostics wrong;
  for (const auto& [path, uses] : named) {
    for (const NamedShader& use : uses) {
      if (shaders.contains(use.id)) continue;
      wrong.push_back({"no-such-shader",
                       Severity::Error,
                       {path, 0, 0, use.pointer},
                       "there is no shader " + quote(use.id),
                       "merge its shard, too",
                       {}});
    }
  }
  return wrong;
}

}  // namespace

bool merge(const std::vector<std::string>& shards, const std::string& folder, Messages& messages) {
  Shaders shaders;
  if (const Result<void> named = hasPath("the output folder", folder); !named) {
    report(named.error(), {}, messages);
    return false;
  }
  if (const Diagnostics wrong = clashes(shards, {folder + "/manifest.json"}); !wrong.empty()) {
    report(wrong, {}, messages);
    return false;
  }
  if (const Result<bool> usable = makeFolder(folder); !usable) {
    report(usable.error(), {}, messages);
    return false;
  }
  const Scratch scratch(folder);
  ManifestFile manifest(folder + "/manifest.json", {&scratch});
  std::vector<std::pair<std::string, std::vector<NamedShader>>> named;  // by the shard
  for (const std::string& path : shards) {
    Result<Json> json = readManifest(path, named.emplace_back(path, std::vector<NamedShader>()).second);
    if (!json) {
      report(json.error(), {}, messages);
      return false;
    }
    for (Json& file : (*json)["files"]) {
      rebase(file, folderOf(path), folder);
      manifest.file(entryText(file));
    }
    for (const auto& [id, shader] : (*json)["shaders"].items()) {
      std::string text = entryText(shader);
      const auto [it, fresh] = shaders.try_emplace(id, text, path);
      if (fresh || it->second.first == text) continue;
      report(fail("shards-differ", {path, 0, 0, {}},
                  "its entry of " + id + " is not that of " + it->second.second,
                  "merge shards that were made with the same options")
                 .value(),
             {}, messages);
      return false;
    }
  }
  if (const Diagnostics wrong = absent(named, shaders); !wrong.empty()) {
    report(wrong, {}, messages);
    return false;
  }
  for (const auto& [id, entry] : shaders) manifest.shader(id, entry.first);
  const Result<bool> written = manifest.finish();
  if (!written) report(written.error(), {}, messages);
  return written.has_value();
}

}  // namespace lacquer
