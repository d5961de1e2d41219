// manifest.json: what an engine needs to know of the generated shaders.
#pragma once

#include <string>
#include <vector>

#include "api/internal.h"
#include "api/json_text.h"
#include "support/file.h"

namespace lacquer {

/// The interface of a placed module: "template", "uniforms", "parameters", "textures", "inputs", "outputs".
/// `schema`: whose prose says what the parameters are; may be null.
Json interfaceOf(const ir::Module& module, bool has_vertex, const material::Schema* schema);

/// {"safe": n, "unproved": [...]}: the operations that have a domain.
Json proofsJson(const ir::Module& module);

/// A diagnostic's entry.
Json diagnosticJson(const Diagnostic& diagnostic);

/// Numbers of a value: one, or an array.
Json componentsJson(ir::Type type, const ir::Components& components);

/// A manifest, written entry by entry: first files, then shaders in the order of their ids.
/// What its form is: the `schema` that a manifest names. Another number is another form.
inline constexpr int kManifestSchema = 1;

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
