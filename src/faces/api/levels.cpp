// Levels of detail, with what the cache knows of them.
#include "cache/cache.h"
#include "lacquer/tools.h"
#include "lod/lod.h"
#include "setting/messages.h"
#include "structures/contract.h"
#include "support/outputs.h"

namespace lacquer {

std::optional<Levels> makeLevels(const Lod& lod, const Strings& files, const Strings& materials,
                                 const Options& options, Messages& messages, const Progress& progress) {
  if (options.cache.empty())
    return lookForLevels(lod, files, materials, options, messages, progress, nullptr);
  Diagnostics wrong =
      reservedNames({Cache::entriesBelow(options.cache)}, {}, {lod.output + "/manifest.json"});
  for (Diagnostic& one : wrong) one.message = "this file is to be written where the cache's own are";
  report(wrong, {}, messages);
  if (!wrong.empty()) return std::nullopt;
  Result<std::string> secret;
  if (!options.cache_key.empty()) secret = Cache::secretOf(options.cache_key);
  if (!secret) {
    report(secret.error(), {}, messages);
    return std::nullopt;
  }
  Cache cache(options.cache, options.cache_size, std::move(*secret));
  LevelStore store{baseOf(options)};
  store.load = [&](const Key& key) { return cache.get(key); };
  store.save = [&](const Key& key, std::string_view bytes) { cache.put(key, bytes); };
  std::optional<Levels> levels = lookForLevels(lod, files, materials, options, messages, progress, &store);
  report(cache.problems(), {}, messages);
  return levels;
}

}  // namespace lacquer
