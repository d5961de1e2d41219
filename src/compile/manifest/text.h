// The text of a manifest, piece by piece: a run writes each of its entries as soon as it is known.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "json/text.h"
#include "lacquer/manifest.h"

namespace lacquer::manifest {

using json::JsonText;

/// How deep the entries lie.
inline constexpr size_t kEntryDepth = 2;     ///< manifest, "files" or "shaders"
inline constexpr size_t kMaterialDepth = 4;  ///< the file, "materials"

void write(const ContractMaterial& material, JsonText& to);
void write(const FileContract& file, JsonText& to);
void write(const ShaderOutput& output, JsonText& to);
void write(const Blend& blend, JsonText& to);
/// A file's entry whose materials are not all in memory at once: its beginning, to which their texts are
/// added as raw items, and what stands behind them, of a value without materials.
void beginFile(const std::string& source, JsonText& to);
void endFile(const FileContract& file, JsonText& to);

/// The files of a shader for a target.
ManifestCode codeOf(Target target, const std::string& id, bool has_vertex, bool validated);

/// What of a shader is in the manifest for these targets beside its files.
void writeReflection(const Reflection& of, std::span<const Target> targets, bool argument_buffers,
                     JsonText& to);
/// A shader's entry.
void writeShader(std::span<const ManifestCode> code, const Reflection& of, bool argument_buffers,
                 JsonText& to);
/// The entries of levels: a list.
void writeLevels(const std::vector<MaterialLevels>& materials, JsonText& to);

/// The number of a manifest's form, which it names as its `schema`. Another one is another form.
inline constexpr int kSchema = 1;

/// A manifest entry by entry: first files, then shaders in the order of their ids, then levels.
class Writer {
public:
  using Append = std::function<void(std::string_view)>;
  /// `append` is given the text, from front to back.
  explicit Writer(Append append, std::string_view version = lacquer::version());
  /// The entry's text, from a JsonText of kEntryDepth.
  void file(std::string_view entry);
  void shader(std::string_view id, std::string_view entry);
  void finish(const std::vector<MaterialLevels>& levels = {});

private:
  void beginShaders();
  Append append_;
  size_t files_ = 0, shaders_ = 0;
};

}  // namespace lacquer::manifest
