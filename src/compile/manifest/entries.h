// The values of values.h as the manifest's entries.
#pragma once

#include <string>
#include <string_view>

#include "json/text.h"
#include "lacquer/contract.h"
#include "support/diagnostic.h"

namespace lacquer {

using json::JsonText;

inline constexpr size_t kFileDepth = 2;      ///< manifest, "files"
inline constexpr size_t kMaterialDepth = 4;  ///< the file, "materials"

void writeList(const std::vector<std::string>& names, JsonText& json);

/// The member "blend" of a material.
void writeBlend(const Blend& blend, JsonText& json);

/// What all materials of a structure say alike, as texts of its depth.
struct StructureTexts {
  std::string terms, skipped;    ///< members of the material
  std::string absent, unfilled;  ///< members of a use
};
StructureTexts textsOf(const MaterialTerms& terms, const StructureFacts& facts);

/// What an entry needs beside a use.
struct UseEntry {
  std::string shader;                     ///< its id
  const StructureTexts* texts = nullptr;  ///< of its structure, where they are known
};
/// A material's whole entry. `profile`: null for a graph in JSON, which is no glTF material. `texts`: of the
/// structure whose terms the material has, where they are known; may be null.
std::string materialText(const ContractMaterial& material, const std::vector<UseEntry>& uses,
                         const std::string* profile, const StructureTexts* texts,
                         const Diagnostics& diagnostics);

/// The members "files" and "validated" of a shader's entry. `validated`: of all targets that were asked for.
void writeCode(const std::string& id, bool has_vertex, const std::vector<std::pair<Target, bool>>& validated,
               JsonText& json);

/// What a file's entry has beside its materials. Those are texts.
struct FileEntry {
  const std::string& default_material;  ///< of materialText(); empty where there is none
  const Strings& variants;
  const std::vector<ContractPrimitive>& primitives;
  const std::vector<ContractTexture>& textures;
  const std::vector<ContractImage>& images;
  const Diagnostics& diagnostics;
};
/// Begins a file's entry, to which materials are then added as raw items.
void beginFile(const std::string& source, JsonText& json);
/// Ends it.
void endFile(const FileEntry& file, JsonText& json);

}  // namespace lacquer
