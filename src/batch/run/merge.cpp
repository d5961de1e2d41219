#include <fmt/format.h>

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "manifest/read.h"
#include "manifest/text.h"
#include "run/named_shaders.h"
#include "run/pack.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/file.h"
#include "support/outputs.h"
#include "support/relative.h"
#include "support/text.h"

namespace lacquer {

namespace {

/// Levels of a manifest; ours have eleven.
constexpr uint64_t kMostLevels = 32;

Result<Manifest> readShard(const std::string& path) {
  const Result<std::string> text = readFile(path);
  if (!text) return tl::make_unexpected(text.error());
  Limits limits;
  limits.depth = kMostLevels;
  Result<Manifest> manifest = manifest::read(*text, path, limits);
  if (!manifest) {
    for (Diagnostic& one : manifest.error()) {
      if (one.code == "json-too-deep") one.help = "what `lacquer gen` writes has fewer levels";
    }
    return manifest;
  }
  if (manifest->levels.empty()) return manifest;
  return fail("unknown-property", {path, 0, 0, "/levels"}, "levels of detail are not merged",
              "merge what `lacquer gen` wrote");
}

template <class Write>
std::string entryText(const Write& write) {
  json::JsonText json(manifest::kEntryDepth);
  write(json);
  return json.take();
}

/// What the shards say, as it is to be written.
struct Merged {
  Strings files;
  std::map<std::string, std::pair<std::string, std::string>> shaders;  ///< id: entry, where it is from
  /// By shard: those that no shard before it has.
  std::vector<std::pair<std::string, NamedShader>> named;
};

Result<void> addShard(const std::string& path, const std::string& folder, Merged& merged) {
  Result<Manifest> shard = readShard(path);
  if (!shard) return tl::make_unexpected(std::move(shard.error()));
  for (const ManifestShader& shader : shard->shaders) {
    std::string text = entryText([&](json::JsonText& json) {
      manifest::writeShader(shader.targets, shader.reflection, shader.argument_buffers, json);
    });
    const auto [it, fresh] = merged.shaders.try_emplace(shader.id, text, path);
    if (fresh || it->second.first == text) continue;
    return fail("shards-differ", {path, 0, 0, {}},
                "its entry of " + shader.id + " is not that of " + it->second.second,
                "merge shards that were made with the same options");
  }
  const Moved moved(folderOf(path), folder);
  for (size_t i = 0; i < shard->files.size(); ++i) {
    FileContract& file = shard->files[i];
    // What an entry says of its source holds in the new manifest's folder.
    file.source = moved(file.source);
    for (NamedShader& named : shadersNamedIn(file, i)) {
      if (!merged.shaders.contains(named.id)) merged.named.emplace_back(path, std::move(named));
    }
    merged.files.push_back(entryText([&](json::JsonText& json) { manifest::write(file, json); }));
    file = {};
  }
  return {};
}

/// An error for each use whose shader is in none of the shards.
Diagnostics absent(const Merged& merged) {
  Diagnostics wrong;
  for (const auto& [path, named] : merged.named) {
    if (merged.shaders.contains(named.id)) continue;
    if (isFull(wrong)) return wrong;
    addBounded(wrong, noSuchShader(path, named, "merge its shard, too"));
  }
  return wrong;
}

/// Nothing is written, and no folder made, before all that is read is known to be good.
Result<bool> mergeInto(const std::string& folder, const Strings& shards, const std::string& packed) {
  Result<void> good = hasPath("the output folder", folder);
  for (size_t i = 0; i < shards.size() && good; ++i) good = hasPath("a shard", shards[i]);
  if (good) good = hasPlace(folder);
  if (!good) return tl::make_unexpected(std::move(good.error()));
  const std::string path = packed.empty() ? folder + "/manifest.json" : packed;
  if (Diagnostics wrong = clashes(shards, {path}); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  Merged merged;
  for (const std::string& shard : shards) {
    good = addShard(shard, folder, merged);
    if (!good) return tl::make_unexpected(std::move(good.error()));
  }
  if (Diagnostics wrong = absent(merged); !wrong.empty()) return tl::make_unexpected(std::move(wrong));
  const auto write = [&](const std::function<void(std::string_view)>& to) {
    manifest::Writer writer(to);
    for (const std::string& file : merged.files) writer.file(file);
    for (const auto& [id, entry] : merged.shaders) writer.shader(id, entry.first);
    writer.finish();
  };
  if (!packed.empty()) {
    std::string text;
    write([&](std::string_view piece) { text += piece; });
    const Result<std::string> bytes = packedOf(text, folder, packed);
    if (!bytes) return tl::make_unexpected(bytes.error());
    return writeFile(packed, *bytes, {nullptr, true});
  }
  if (Result<bool> usable = makeFolder(folder); !usable) return usable;
  const Scratch scratch(folder);
  ReplacingFile to(path, {&scratch});
  write([&](std::string_view piece) { to.append(piece); });
  return to.finish();
}

}  // namespace

bool merge(const Strings& shards, const std::string& folder, Messages& messages, const std::string& packed) {
  const Result<bool> written = mergeInto(folder, shards, packed);
  if (!written) report(written.error(), {}, messages);
  return written.has_value();
}

}  // namespace lacquer
