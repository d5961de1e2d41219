#include <map>
#include <string>
#include <utility>
#include <vector>

#include "json/json.h"
#include "json/text.h"
#include "manifest/check.h"
#include "manifest/manifest.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/outputs.h"
#include "support/relative.h"
#include "support/text.h"

namespace lacquer {

namespace {

constexpr size_t kEntryDepth = 2;  ///< manifest, "files" or "shaders"
/// Levels of a manifest; ours have eleven. Each level moves what is in it two columns to the right: what is
/// written may be so many times what was read.
constexpr uint64_t kMostLevels = 32;

Result<Json> readManifest(const std::string& path, std::vector<NamedShader>& named) {
  const Result<std::string> text = readFile(path);
  if (!text) return tl::make_unexpected(text.error());
  Limits limits;
  limits.depth = kMostLevels;
  Result<Json> json = json::parse(*text, path, limits);
  if (!json) {
    for (Diagnostic& one : json.error()) {
      if (one.code == "json-too-deep") one.help = "what `lacquer gen` writes has fewer levels";
    }
    return json;
  }
  if (Result<void> good = checkManifest(*json, path, named); !good)
    return tl::make_unexpected(std::move(good.error()));
  return json;
}

/// What a file's entry says of its source holds in the new manifest's folder.
void rebase(Json& file, const Moved& moved) {
  const Json* source = json::member(file, "source");
  if (source == nullptr || !source->is_string()) return;
  file["source"] = moved(source->text());
}

std::string entryText(const Json& json) { return JsonText(kEntryDepth).json(json).take(); }

using Shaders = std::map<std::string, std::pair<std::string, std::string>>;  ///< id: entry, where it is from

/// What the shards say, as it is to be written.
struct Merged {
  Strings files;
  Shaders shaders;
  std::vector<std::pair<std::string, std::vector<NamedShader>>> named;  ///< by the shard
};

Result<void> addShard(const std::string& path, const std::string& folder, Merged& merged) {
  Result<Json> json = readManifest(path, merged.named.emplace_back(path, std::vector<NamedShader>()).second);
  if (!json) return tl::make_unexpected(std::move(json.error()));
  const Moved moved(folderOf(path), folder);
  for (Json& file : (*json)["files"]) {
    rebase(file, moved);
    merged.files.push_back(entryText(file));
  }
  for (const auto& [id, shader] : (*json)["shaders"].items()) {
    std::string text = entryText(shader);
    const auto [it, fresh] = merged.shaders.try_emplace(id, text, path);
    if (fresh || it->second.first == text) continue;
    return fail("shards-differ", {path, 0, 0, {}},
                "its entry of " + id + " is not that of " + it->second.second,
                "merge shards that were made with the same options");
  }
  return {};
}

/// An error for each use whose shader is in none of the shards.
Diagnostics absent(const Merged& merged) {
  Diagnostics wrong;
  for (const auto& [path, uses] : merged.named) {
    for (const NamedShader& use : uses) {
      if (merged.shaders.contains(use.id)) continue;
      if (isFull(wrong)) return wrong;
      addBounded(wrong, {"no-such-shader",
                         Severity::Error,
                         {path, 0, 0, use.pointer},
                         "there is no shader " + quote(use.id),
                         "merge its shard, too",
                         {}});
    }
  }
  return wrong;
}

/// Nothing is written, and no folder made, before all that is read is known to be good.
Result<bool> mergeInto(const std::string& folder, const Strings& shards) {
  Result<void> good = hasPath("the output folder", folder);
  for (size_t i = 0; i < shards.size() && good; ++i) good = hasPath("a shard", shards[i]);
  if (good) good = hasPlace(folder);
  if (!good) return tl::make_unexpected(std::move(good.error()));
  const std::string path = folder + "/manifest.json";
  if (Diagnostics wrong = clashes(shards, {path}); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  Merged merged;
  for (const std::string& shard : shards) {
    good = addShard(shard, folder, merged);
    if (!good) return tl::make_unexpected(std::move(good.error()));
  }
  if (Diagnostics wrong = absent(merged); !wrong.empty()) return tl::make_unexpected(std::move(wrong));
  if (Result<bool> usable = makeFolder(folder); !usable) return usable;
  const Scratch scratch(folder);
  ManifestFile manifest(path, {&scratch});
  for (const std::string& file : merged.files) manifest.file(file);
  for (const auto& [id, entry] : merged.shaders) manifest.shader(id, entry.first);
  return manifest.finish();
}

}  // namespace

bool merge(const Strings& shards, const std::string& folder, Messages& messages) {
  const Result<bool> written = mergeInto(folder, shards);
  if (!written) report(written.error(), {}, messages);
  return written.has_value();
}

}  // namespace lacquer
