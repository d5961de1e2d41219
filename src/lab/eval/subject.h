// What instruments look at: a material of a file, or a graph of one's own.
#pragma once

#include <memory>
#include <string>
#include <variant>

#include "gltf/geometry.h"
#include "graph/graph.h"
#include "lacquer.h"
#include "material/material.h"
#include "setting/language.h"

namespace lacquer {

/// One of the two, which must outlive this.
class EvalSubject {
public:
  EvalSubject(const material::Material& material) : of_(&material) {}  // NOLINT: either will do
  EvalSubject(const graph::Graph& graph) : of_(&graph) {}              // NOLINT

  const std::string& name() const;
  /// The name for people, where there is none the material's number; and its place in the file.
  std::string title() const;
  std::string pointer() const;
  /// What was said of a material when it was read; of a graph nothing.
  const Diagnostics& diagnostics() const;
  /// The material; null for a graph.
  const material::Material* material() const;
  bool isGraph() const { return material() == nullptr; }

  /// The graph to lower. A material's is built for the options' template, profile and switches; a graph is
  /// what it is, checked and flat, and options that would build it otherwise are an error ("graph-is-built").
  /// `outputs`: those of its nodes.
  Result<graph::Graph> built(const gltf::VertexAttributes& attributes, const Language& library,
                             const Options& options, Diagnostics& warnings,
                             graph::FlatOutputs* outputs = nullptr) const;
  /// The same with the index of each texture being that of what it was in `originals`.
  Result<graph::Graph> graph(const gltf::VertexAttributes& attributes, const Language& library,
                             const Options& options, std::vector<graph::Texture>& originals,
                             Diagnostics& warnings, graph::FlatOutputs* outputs = nullptr) const;

private:
  std::variant<const material::Material*, const graph::Graph*> of_;
};

/// Errors: "file-unreadable" and those of graph::fromJson().
Result<graph::Graph> readGraphFile(const std::string& path, const Options& options);

}  // namespace lacquer
