#include <map>

#include "json/json.h"
#include "json/text.h"
#include "run/manifest.h"
#include "shader/messages.h"
#include "shader/options.h"
#include "support/outputs.h"
#include "support/relative.h"

namespace lacquer {

namespace {

constexpr size_t kEntryDepth = 2;  ///< manifest, "files" or "shaders"

tl::unexpected<Diagnostics> noManifest(const std::string& path, std::string message) {
  return fail("no-manifest", {path, 0, 0, {}}, std::move(message),
              "name what `lacquer gen` wrote: a manifest or a shard");
}

Result<Json> readManifest(const std::string& path) {
  const Result<std::string> text = readFile(path);
  if (!text) return tl::make_unexpected(text.error());
  Result<Json> read = json::parse(*text, path);
  if (!read) return read;
  Json& json = *read;
  const auto is = [&](const char* name, Json::value_t type) {
    const Json* found = json::member(json, name);
    return found != nullptr && found->type() == type;
  };
  if (!is("lacquer", Json::value_t::string) || !is("files", Json::value_t::array) ||
      !is("shaders", Json::value_t::object)) {
    return noManifest(path, "this is no manifest of Lacquer's");
  }
  if (json["lacquer"] != version()) {
    return noManifest(path, "it was written by version " + json["lacquer"].get<std::string>());
  }
  return read;
}

/// What a file's entry says of its source holds in the new manifest's folder.
void rebase(Json& file, const std::string& from, const std::string& to) {
  const Json* source = json::member(file, "source");
  if (source == nullptr || !source->is_string()) return;
  file["source"] = relativeTo(to, fromFolder(from, source->get<std::string>()));
}

std::string entryText(const Json& json) { return JsonText(kEntryDepth).json(json).take(); }

}  // namespace

bool merge(const std::vector<std::string>& shards, const std::string& folder, Messages& messages) {
  std::map<std::string, std::pair<std::string, std::string>> shaders;  // id: entry, where it comes from
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
  for (const std::string& path : shards) {
    Result<Json> json = readManifest(path);
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
  for (const auto& [id, entry] : shaders) manifest.shader(id, entry.first);
  const Result<bool> written = manifest.finish();
  if (!written) report(written.error(), {}, messages);
  return written.has_value();
}

}  // namespace lacquer
