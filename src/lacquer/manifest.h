/// manifest.json as values. docs/manifest.md says what each member means to an application. lacquer.h says
/// what holds for every declaration.
#pragma once

#include "lacquer/contract.h"
#include "lacquer/results.h"

namespace lacquer {

/// The files of a target, as paths below the folder, by their kinds: "vert" and "frag"; "header"; "types" and
/// "module".
struct ManifestCode {
  Target target = Target::Glsl;
  std::vector<std::pair<std::string, std::string>> files;
  std::optional<bool> validated;  ///< none for what is no shader
};
struct ManifestShader {
  std::string id;
  std::vector<ManifestCode> targets;
  /// Read from a manifest, it has the places of the targets that the manifest has.
  Reflection reflection;
  bool argument_buffers = false;  ///< Target::Msl: of each descriptor set
};

struct Manifest {
  std::string lacquer;                  ///< the version that wrote it
  std::vector<FileContract> files;      ///< their `source` is as seen from the manifest's folder
  std::vector<ManifestShader> shaders;  ///< by id
  std::vector<MaterialLevels> levels;   ///< of `lacquer lod`
};

/// Reads a manifest, or what `gen --shard` wrote. ContractUse::shader is then an index into
/// Manifest::shaders, past their end where another shard has the shader; `structure` and `block` are empty.
/// Nothing on an error: "no-manifest" (another version's too), "wrong-type", "missing-property",
/// "unknown-property", "wrong-id", "wrong-path" and those of JSON. Of the options, `limits`.
std::optional<Manifest> readManifest(const std::string& path, const Options& options, Messages& messages);
/// Its text, as runs write it: what is read and written again has the same bytes.
std::string manifestJson(const Manifest& manifest);

}  // namespace lacquer
