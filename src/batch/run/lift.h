// Graphs of a material with what other materials of its program have: layers and terms that are there though
// they change nothing for this one, so that one set of nodes does for all.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <set>

#include "structures/structure.h"

namespace lacquer {

/// What the materials of a program have together.
struct Lift {
  std::set<uint16_t> extensions;  ///< of the schema
  std::set<std::string> live;     ///< terms
};

/// A material that needs a structure, or a graph that is one.
struct Example {
  Key content;  ///< of everything in the material that a graph depends on; of the graph
  material::Material material;
  gltf::VertexAttributes attributes;
  std::optional<graph::Graph> graph;  ///< where it was not built of a material
  std::optional<Key> shape;           ///< of the material: what decides of its graphs but for values
};

/// For every structure of a run the example with the smallest content, whatever the order in which the
/// materials come. Materials keep their programs. May be used from several threads at once.
class Examples : public Sharing {
public:
  void note(const Key& structure, const material::Material& material,
            const gltf::VertexAttributes& attributes, const std::string& shape) override;
  void note(const Key& structure, const graph::Graph& graph) override;
  Share bring(Traced&, const material::Material*, const gltf::VertexAttributes&,
              const passes::LightFacts&) override {
    return {};
  }
  bool closed() const override { return false; }
  const Key& digest() const override { return digest_; }
  Diagnostics about(size_t) const override { return {}; }
  /// Null for a structure of which no material came. Not beside note().
  const Example* of(const Key& structure) const;
  /// Of all materials, by structure: whatever their graphs depend on beside the lift. Null where some have
  /// no shape. Not beside note().
  const std::set<std::pair<Key, Key>>* shapes() const { return shapeless_ ? nullptr : &shapes_; }

private:
  void keep(const Key& structure, Example example);

  std::mutex mutex_;
  std::map<Key, Example> examples_;
  std::set<std::pair<Key, Key>> shapes_;
  bool shapeless_ = false;
  Key digest_;
};

/// Adds what a structure has: its example's extensions, and the live terms that are nodes of its graph.
void addTo(Lift& lift, const Example& example, const graph::Graph& graph, const Setting& setting);

/// The graph of the example as it is without a lift: built anew, or the graph itself.
Result<graph::Graph> graphOf(const Example& example, const Setting& setting);

/// The material's graph with all of a lift that is neutral for it: an extension that it has not is added
/// where its defaults leave the graph as it is. `own`: the graph without, which comes back where there is no
/// other, and where there is no material (null). `origins`, where it is not null, has those of `own` and is
/// given those of the graph.
graph::Graph lifted(const material::Material* material, const gltf::VertexAttributes& attributes,
                    const graph::Graph& own, const Lift& lift, const Setting& setting,
                    model::Origins* origins = nullptr);

}  // namespace lacquer
