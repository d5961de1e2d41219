// manifest.json: what an engine needs to know of the generated shaders.
#pragma once

#include <functional>
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
class ManifestText {
public:
  /// `append`: is given the text, piece by piece.
  explicit ManifestText(std::function<void(std::string_view)> append);
  /// The entry's text, from a JsonText of depth 2.
  void file(std::string_view entry);
  void shader(std::string_view id, std::string_view entry);
  void end();

private:
  std::function<void(std::string_view)> append_;
  size_t files_ = 0, shaders_ = 0;
};

/// The same as a file.
class ManifestFile {
public:
  explicit ManifestFile(const std::string& path, const Writing& how)
      : file_(path, how), text_([this](std::string_view bytes) { file_.append(bytes); }) {}
  ManifestFile(const ManifestFile&) = delete;  // the text knows the file
  ManifestFile& operator=(const ManifestFile&) = delete;
  void file(std::string_view entry) { text_.file(entry); }
  void shader(std::string_view id, std::string_view entry) { text_.shader(id, entry); }
  Result<bool> finish() {
    text_.end();
    return file_.finish();
  }

private:
  ReplacingFile file_;
  ManifestText text_;
};

}  // namespace lacquer
