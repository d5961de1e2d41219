// A glTF material as its file gives it: values and textures by their numbers in the schema, and nothing for
// what the file leaves out. Numbers are doubles as the JSON has them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gltf/facts.h"
#include "ir/dag.h"
#include "lacquer/looks.h"
#include "material/schema.h"
#include "support/limits.h"

namespace lacquer::graph {
struct Graph;
}

namespace lacquer::material {

struct Material {
  struct Number {
    uint16_t property = 0;
    ir::Components value{};  ///< a bool is 0 or 1, a choice the place of its value
  };
  struct Texture {
    uint16_t property = 0;
    gltf::TextureInfo info;
  };

  int index = -1;    ///< in the file's materials; -1 is the default material of primitives without one
  std::string name;  ///< as in the file; may be empty or not unique
  std::vector<Number> numbers;
  std::vector<Texture> textures;     ///< in the order of the JSON
  std::vector<uint16_t> animated;    ///< numbers that animations change, sorted
  std::vector<uint16_t> extensions;  ///< those that have an effect; glTF's own (0) is not listed
  std::vector<std::string> ignored;  ///< JSON pointers of extensions that are not implemented, sorted
  /// The groups that compute texels (gltf::TextureInfo::group), with their parameters and textures.
  std::shared_ptr<const graph::Graph> patterns;
  /// Of a surface of closures: the group of `patterns` that computes it.
  std::string closures;
  /// Ports of a template, and what the group has for them; the material's properties say nothing of these.
  std::vector<std::pair<std::string, std::string>> ports;
  std::string surface;           ///< of a MaterialX document: "standard_surface"
  std::string surface_pointer;   ///< of closures: what pointers of its own numbers begin with, "/paint"
  Place surface_place;           ///< of a MaterialX document: where that stands
  double translation_error = 0;  ///< where that was translated to properties: materialx::translationError()
  std::string displacement;      ///< the group whose only output moves the vertices; empty for none
  Diagnostics diagnostics;       ///< of this material; one of severity Error means: generate nothing for it

  bool has(uint16_t extension) const;
  const ir::Components* number(uint16_t property) const;      ///< null where the file says nothing
  const gltf::TextureInfo* texture(uint16_t property) const;  ///< null where there is none
  bool isAnimated(uint16_t property) const;                   ///< of a number
};

/// A file's materials and the facts of its scene.
struct Document : gltf::Scene {
  std::vector<Material> materials;
  std::vector<std::string> included;  ///< files whose text is a part of it
  Looks looks;                        ///< of a MaterialX document
};

struct ReadOptions {
  bool permissive = false;  ///< exclusion violations become warnings and the extension is dropped
  Limits limits = {};
  /// What a MaterialX document includes, by its path as seen from there; null: files are read.
  const std::vector<std::pair<std::string, std::string>>* included = nullptr;
  bool translate = true;  ///< surfaces of a MaterialX document to glTF's properties
};

/// Reads a .gltf, .glb or .mtlx file. Buffers and images need not exist. Errors: what makes the whole file
/// unusable (unreadable, not JSON, truncated GLB, wrong root type); errors of one material are in that
/// material.
Result<Document> read(const std::string& path, const Schema& schema, const ReadOptions& options);

/// As read(), from memory; `name` stands for the path in diagnostics.
Result<Document> readText(const std::string& bytes, const std::string& name, const Schema& schema,
                          const ReadOptions& options);

/// The index of the first material of that name or, without a name, of the only one. Errors:
/// "no-such-material"; the warning "duplicate-name" where several have the name.
Result<size_t> findMaterial(const Document& document, const std::optional<std::string>& name,
                            Diagnostics& warnings);

}  // namespace lacquer::material
