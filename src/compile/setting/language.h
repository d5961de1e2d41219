// The node library with what it makes of materials.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lacquer/options.h"
#include "lang/library.h"
#include "material/material.h"
#include "model/model.h"
#include "setting/prepared.h"
#include "support/file.h"

namespace lacquer {

struct Language : lang::Library {
  explicit Language(lang::Library&& library, materialx::Definitions definitions = {})
      : lang::Library(std::move(library)), models(*this, std::move(definitions), preparedModels()) {}
  Language(const Language&) = delete;
  Language& operator=(const Language&) = delete;

  /// Everything that can be wrong without a material: declarations, and parts under each profile and with
  /// each lod, whose names and types meet there. Errors and warnings, each once.
  Diagnostics check() const;

  model::Models models;
};

/// The node files of a folder, sorted by name.
Result<std::vector<lang::SourceFile>> nodeFiles(const std::string& folder);

/// The options' own node files: those of its folders, then its texts.
Result<std::vector<lang::SourceFile>> ownNodeFiles(const Options& options);

/// An error for each of their folders in which there is nothing to read.
Diagnostics emptyFolders(const Options& options);

/// The documents of a folder and those below it that MaterialX documents find definitions in, sorted by path.
Result<std::vector<lang::SourceFile>> definitionFiles(const std::string& folder);

/// The options' own definitions for MaterialX documents; null where they name none.
Result<materialx::Definitions> ownDefinitions(const Options& options);

/// All files of the options' folders that are there now: nodes, then definitions. `all_known` is false
/// afterwards where a folder cannot be read.
std::vector<lang::SourceFile> filesOfFolders(const Options& options, bool* all_known = nullptr);

/// A file's materials by the library's declarations.
Result<material::Document> readMaterials(const std::string& path, const Language& language,
                                         const Options& options, Links links = Links::Follow);

/// The built-in library with the options' own files added. The built-in one alone is made once, and one with
/// texts alone is kept until it is asked for with others: a tool that edits a text makes it anew.
Result<std::shared_ptr<const Language>> libraryFor(const Options& options);

/// Of an entry of Options::live that is a JSON pointer: the property, from the material on, where it is one
/// of this material; without a material of any.
std::optional<std::string_view> watchedPath(std::string_view live, std::optional<int> material = {});

/// The profile of MaterialX documents: their own formulas.
inline constexpr std::string_view kMaterialX = "materialx";
/// Whether surfaces of MaterialX documents are translated to glTF's properties (Options::as).
bool translates(const Options& options);
/// The profile that a material's graph follows: the options', or a document's own formulas.
const std::string& profileOf(const material::Material& material, const Options& options);
/// The options where glTF's properties are asked for.
Options translating(Options options);

/// Puts the library's defaults in where no template or no profile is named.
Result<void> resolveNames(const lang::Library& library, Options& options);

}  // namespace lacquer
