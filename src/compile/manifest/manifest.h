// manifest.json: what an engine needs to know of the generated shaders.
#pragma once

#include <string>
#include <vector>

#include "json/text.h"
#include "support/file.h"

namespace lacquer {

using json::Json;
using json::JsonText;

/// A diagnostic's entry.
Json diagnosticJson(const Diagnostic& diagnostic);

/// The form of a manifest: the `schema` that it names. Another number is another form.
inline constexpr int kManifestSchema = 1;

/// A manifest, written entry by entry: first files, then shaders in the order of their ids.

class ManifestFile {
public:
  explicit ManifestFile(const std::string& path, const Writing& how);
  /// The entry's text, from a JsonText of depth 2.
  void file(std::string_view entry);
  void shader(std::string_view id, std::string_view entry);
  Result<bool> finish();

private:
  ReplacingFile file_;
  size_t files_ = 0, shaders_ = 0;
};

}  // namespace lacquer
