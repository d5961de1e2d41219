// What a manifest or a shard must be before something is made of it: it may come from another machine.
#pragma once

#include <string>
#include <vector>

#include "json/json.h"
#include "support/diagnostic.h"

namespace lacquer {

/// "no-manifest" for what is no manifest, or is one of another version or form (`schema`).
Result<void> checkManifestHead(const json::Json& manifest, const std::string& path);

/// A shader that a use of a manifest names.
struct NamedShader {
  std::string id, pointer;
};

/// The head, and the entries as far as a reader relies on them without looking: ids are ids, a shader's files
/// are those that follow from its id, members have their types. Errors: "no-manifest", "wrong-type",
/// "missing-property", "wrong-id", "wrong-path", each with a pointer. The shaders that uses name are appended
/// to `named`: they may stand in another shard.
Result<void> checkManifest(const json::Json& manifest, const std::string& path,
                           std::vector<NamedShader>& named);

}  // namespace lacquer
