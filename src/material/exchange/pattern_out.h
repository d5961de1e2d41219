// Groups of a graph as elements of a MaterialX document.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/surface_out.h"
#include "gltf/facts.h"
#include "graph/contracts.h"
#include "graph/graph.h"
#include "materialx/patterns.h"
#include "mtlx/element.h"
#include "support/relative.h"

namespace lacquer::exchange {

/// A value in MaterialX's types: a colour is not a vector there.
struct Typed {
  ir::Type type = ir::Type::Float;
  bool color = false;
  bool operator==(const Typed&) const = default;
};
std::string typeName(Typed type);
/// Nothing for what no value has.
std::optional<Typed> typedOf(std::string_view name);
/// "0.5, 1": as many numbers as the type has.
std::string valueText(ir::Type type, const ir::Components& value);

/// Puts elements that stand beside each other behind those that they are connected to, in the order in which
/// `users` ask for them; nodegraphs and definitions come first. So the order says nothing of where they came
/// from.
void orderElements(std::vector<materialx::Element>& elements, const std::vector<materialx::Element>& users);

/// The last groups of `graph` are the bodies of `surfaces`, in their order: their nodes stand beside the
/// nodegraphs. The graph is checked, and stays as it is.
class PatternsOut {
public:
  /// Where textures have numbers and not files: that of one, which becomes the attribute `texture`.
  using Number = std::function<std::optional<uint64_t>(const graph::Texture&)>;
  PatternsOut(const graph::Graph& graph, const lang::Library& library, const gltf::Scene& scene,
              const std::vector<SurfaceOut>& surfaces, const Moved& moved, Diagnostics& said,
              Number number = {});
  ~PatternsOut();
  PatternsOut(const PatternsOut&) = delete;
  PatternsOut& operator=(const PatternsOut&) = delete;
  /// The nodegraphs, definitions, and the nodes of all bodies that their surfaces reach.
  void write(materialx::Element& root);
  /// The surface's inputs, connected to the nodes of its body.
  void inputs(size_t surface, materialx::Element& shader);
  /// Keeps a name from those that free() gives.
  void take(std::string_view name) { names_.take(std::string(name)); }
  /// A name that no other element beside the nodegraphs has.
  std::string free(std::string_view name) { return names_.free(materialx::graphName(name)); }

private:
  struct Scope;
  struct Link {
    std::vector<std::pair<std::string, std::string>> attributes;
    Typed type;
  };

  void plan();
  void instances();
  void mark(size_t group, const graph::Source& source, bool color);
  void classify(size_t group);
  bool isDefinition(size_t group) const { return definition_[group]; }
  bool colorOf(const lang::NodeDecl& decl, size_t group, const graph::Node& node) const;
  void body(Scope& scope, const std::vector<bool>& reached);
  void group(size_t group, materialx::Element& root);
  void element(Scope& scope, size_t node);
  void sampler(materialx::Element& element, const lang::NodeDecl& decl, const graph::Texture& texture,
               Typed type, std::string_view ends);
  void give(Scope& scope, materialx::Element& element, std::string_view name, const graph::Source& source,
            Typed wanted);
  Link link(Scope& scope, const graph::Source& source);
  Link nodeLink(Scope& scope, const graph::NodeRef& ref);
  Link given(Scope& scope, const std::string& name);
  Link swizzled(Scope& scope, Link link, const std::string& swizzle);
  Link converted(Scope& scope, Link link, Typed wanted);
  Link helper(Scope& scope, std::string_view category, std::string_view name, Typed type,
              std::vector<materialx::Element> inputs);
  void texture(materialx::Element& input, const graph::Texture& texture);
  std::string fileOf(const graph::Texture& texture);
  std::vector<double> matrixOf(const graph::Source& source) const;
  std::optional<std::pair<Typed, ir::Components>> constant(const graph::Source& source) const;
  void lost(std::string message, std::string help = {});

  const graph::Graph& graph_;
  const gltf::Scene& scene_;
  const std::vector<SurfaceOut>& surfaces_;
  const Moved& moved_;
  Diagnostics& said_;
  const Number number_;
  graph::Contracts contracts_;
  size_t bodies_ = 0;                          ///< the number of the first body
  std::vector<bool> wanted_;                   ///< by group: something has an instance of it
  std::vector<bool> definition_;               ///< by group
  std::vector<std::vector<bool>> node_color_;  ///< by group and node: something wants a colour of it
  std::vector<std::vector<bool>> reached_;     ///< by group and node
  std::vector<std::map<std::string, bool>> input_color_, output_color_;
  std::map<std::string, size_t> groups_;
  materialx::NameSet names_;
  std::vector<std::unique_ptr<Scope>> scopes_;  ///< of bodies
};

}  // namespace lacquer::exchange
