// MaterialX as a source of materials: a document's surfaces as glTF's properties, its patterns as groups of a
// graph; and the procedural textures of a glTF file, which are the same patterns.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "graph/graph.h"
#include "json/json.h"
#include "lacquer/looks.h"
#include "lang/library.h"
#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer::materialx {

/// What computes a texel in a texture's place.
struct Procedural {
  std::string group;  ///< of Procedurals::patterns; each of its outputs is a vec4 in [0, 1]
  /// By what the file calls it, and in the group.
  std::vector<std::pair<std::string, std::string>> outputs;
  bool wrong = false;  ///< it cannot be read, and that was said

  /// What the group calls an output; the only one for an empty name; empty where there is no such.
  std::string_view output(std::string_view name) const;
};

struct Procedurals {
  std::vector<Procedural> list;
  bool required = false;  ///< by the file: what names none of them is an error
  /// Groups, parameters and textures; null where there are none.
  std::shared_ptr<const graph::Graph> patterns;
};

/// What a document has: as a glTF file would have it, its `materials`, whose textures name the procedurals by
/// their numbers.
struct Materials {
  json::Json materials = json::Json::array();
  std::vector<Diagnostics> of_materials;  ///< of each, beside what reading `materials` finds
  /// Of each, where it is made of closures: ports of a template, and outputs of its procedural's group.
  std::vector<std::vector<std::pair<std::string, std::string>>> closures;
  struct Surface {
    std::string category;  ///< empty for a pattern
    double error = 0;      ///< how far the material is from it, where it was translated
    std::string pointer;   ///< of closures the element: "/paint", which pointers of its numbers begin with
    Place place;           ///< of the element, of a pattern its output
  };
  std::vector<Surface> surfaces;
  /// Of each the group, of procedurals.patterns, whose output moves the vertices; empty for none.
  std::vector<std::string> displacements;
  Procedurals procedurals;
  Looks looks;
  Diagnostics diagnostics;         ///< of the document as a whole
  std::vector<std::string> files;  ///< that it includes
};

/// Files that documents include, by their paths as seen from the document, and their texts.
using IncludedTexts = std::vector<std::pair<std::string, std::string>>;
using Names = std::set<std::string, std::less<>>;

struct Element;

/// Definitions that every document may use: a library of nodedefs, and the nodegraphs that implement them.
using Definitions = std::shared_ptr<const Element>;

/// Reads such a library of files, in their order. All else in them counts for nothing, and so do includes:
/// the files are all there. Errors: those of readXml(), and what is wrong whoever uses it: "no-name",
/// "duplicate-definition", "no-such-definition", "inherit-cycle".
Result<Definitions> readDefinitions(const std::vector<lang::SourceFile>& files, const Limits& limits);

/// What is wrong within them, as a document that uses each of them would be told.
Diagnostics checkDefinitions(const Definitions& definitions, const lang::Library& library,
                             const Limits& limits);

/// True for text that is XML and no JSON: its first character that is no space is `<`, in any encoding.
bool isXml(std::string_view text);

struct MaterialOptions {
  const Limits& limits;
  Names reserved{};
  const IncludedTexts* included = nullptr;
  /// Surfaces are translated to glTF's properties; else those that there is a model for are its closures.
  bool translate = true;
  Definitions definitions = {};  ///< null for none
};

/// Reads a document; `path` is where its included files are looked for. Surfaces are closures or, where asked
/// for, translated to glTF's properties, and numbers of patterns become parameters with other names than the
/// reserved ones; without a material, and without a surface, each output of a pattern is an unlit material.
/// Errors: those of readXml(), and "no-materials".
Result<Materials> readMaterials(std::string_view text, const std::string& path, const lang::Library& library,
                                MaterialOptions options);

struct ProceduralOptions {
  const Limits& limits;
  bool required = false;
  Names animated{};  ///< JSON pointers of what animations change
  Names reserved{};
  Definitions definitions = {};
  size_t textures = 0;  ///< of the file
};

/// Of a glTF file's extension KHR_texture_procedurals: one for each entry of `procedurals`. What is wrong
/// goes to the diagnostics, with JSON pointers, as warnings unless the file requires the extension. Numbers
/// of inputs are parameters where animations change them.
Procedurals readProcedurals(const json::Json& extension, const std::string& path,
                            const lang::Library& library, const ProceduralOptions& options,
                            Diagnostics& diagnostics);

}  // namespace lacquer::materialx
