// Patterns as the procedural textures of a glTF file: KHR_texture_procedurals with the nodes of
// EXT_texture_procedurals_mx_1_39.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "graph/graph.h"
#include "json/json.h"
#include "material/material.h"
#include "material/schema.h"
#include "support/diagnostic.h"

namespace lacquer::exchange {

class ProceduralsOut {
public:
  /// The index of a texture of the file that is written; nothing where it cannot have it, which was said.
  using TextureNumber = std::function<std::optional<uint64_t>(const graph::Texture&)>;
  struct Written {
    size_t number = 0;
    std::set<std::string, std::less<>> outputs{};  ///< those that it has; none: there is no procedural
  };
  ProceduralsOut(const material::Schema& schema, const gltf::Scene& scene, TextureNumber number,
                 Diagnostics& said)
      : schema_(schema), scene_(scene), number_(std::move(number)), said_(said) {}

  /// Writes a procedural of a group whose outputs are texels, with all of its outputs under their names, and
  /// gives its number. The extension has no graphs in graphs, so what the group uses stands in it. An output
  /// that the extension cannot say whole is left out, with a warning, "not-said".
  Written ofGroup(const graph::Graph& patterns, std::string_view group);
  /// The same of sources of a flat, checked graph.
  Written ofSources(const graph::Graph& flat, std::string_view name, const graph::Outputs& sources);

  /// {"procedurals": [...]}; ports are objects by name, references texts, and values arrays.
  json::Json extension() const;
  bool empty() const { return list_.empty(); }

private:
  Written write(graph::Graph flat, std::string_view name, graph::Outputs outputs);
  bool isWhole(const graph::Graph& flat, const std::pair<std::string, graph::Source>& output,
               std::string_view type);

  const material::Schema& schema_;
  const gltf::Scene& scene_;
  TextureNumber number_;
  Diagnostics& said_;
  json::Json list_ = json::Json::array();
};

}  // namespace lacquer::exchange
