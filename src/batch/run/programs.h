// The programs of a run with --programs: which structures share one, and what each brings to it.
#pragma once

#include <memory>

#include "programs/curve.h"
#include "programs/unite.h"
#include "programs/weights.h"
#include "run/lift.h"
#include "run/structures.h"

namespace lacquer {

/// A material's use of a shader, and its share of the picture.
struct ProgramUse {
  std::string shader;
  double weight = 0;
};

class Programs {
public:
  /// `structures`: those that the run has met, with their examples; `uses`: of every material. Decides which
  /// of them share a program, as the options say.
  Programs(const std::vector<const Structure*>& structures, const Examples& examples,
           const std::vector<ProgramUse>& uses, size_t materials, const Setting& setting);

  /// Puts the graph of a material's program in place of its own, and returns what that has beside its own;
  /// null for a material that keeps its program. Until close() it only looks at the graph, and leaves it.
  /// `material`: that the graph was built of; null for a graph that is the input. From several threads at
  /// once.
  const programs::Fill* bring(graph::Graph& graph, const material::Material* material,
                              const gltf::VertexAttributes& attributes,
                              const passes::LightFacts& lights) const;
  /// Unites what was looked at. Not beside bring().
  void close();

  bool closed() const { return closed_; }
  /// Of everything that it decides.
  const Key& digest() const { return digest_; }
  const programs::Curve& curve() const { return curve_; }
  /// Different known lights: materials share programs only within one of these.
  size_t lightSets() const { return light_sets_; }

private:
  /// Structures that share a program.
  struct Group {
    Lift lift;
    std::mutex mutex;
    std::map<Key, graph::Graph> graphs;  ///< of its materials, lifted: one for each structure
    std::map<Key, size_t> places;        ///< of those in the united graph
    programs::United united;
  };
  void look(Group& group, const Key& key, const graph::Graph& graph) const;

  const Setting& setting_;
  std::map<Key, std::shared_ptr<Group>> groups_;  ///< by the structure of a material's own graph
  bool closed_ = false;
  Key digest_;
  programs::Curve curve_;
  size_t light_sets_ = 0;
};

/// A texture that a material has not: what it binds.
void writeStandIn(const programs::TextureFill& fill, bool srgb, JsonText& json);

}  // namespace lacquer
