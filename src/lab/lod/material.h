// One material, or a graph, while its levels are looked for: simpler shaders of it, measured.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "cost/cost.h"
#include "eval/material.h"
#include "lod/search.h"
#include "lod/store.h"
#include "preview/shot.h"

namespace lacquer {

/// Vertices for each pixel that a level is charged for: triangles of four pixels, as there are two triangles
/// for each vertex. What a level computes more at the vertices than the exact shader counts so much.
inline constexpr double kVertexShare = 0.125;

/// Pixels of the pictures that candidates are searched by, and of those that numbers are fitted to; each with
/// kSearchedGrid samples along each side.
inline constexpr uint32_t kSearched = 24, kFitted = 16, kSearchedGrid = 2;

/// Whether something is computed at vertices that was not: pictures are of triangles then.
bool atVertices(const lod::Words& words);

class LodMaterial {
public:
  struct Given {
    EvalSubject subject;
    gltf::VertexAttributes attributes;  ///< of the primitives that use it
    passes::LightFacts lights;          ///< of the file
    FileImages& images;
    const Language& language;
    const Options& options;  ///< with its names resolved
    const Strings& texels;
    const preview::Mesh& mesh;          ///< the file's own geometry; without triangles where there is none
    double radius;                      ///< of the ball where there is no geometry
    const LevelStore* store = nullptr;  ///< null where nothing is kept
    Key file{};                         ///< of what a graph was read from, where something is
  };
  /// What is given must outlive this. Pictures that levels are chosen by are `size` pixels wide; those to
  /// search by have kSearched.
  LodMaterial(const Given& given, uint32_t size);

  /// Measures the exact shader. What is to be said of the material goes to `messages`.
  Result<lod::Tried> open(Messages& messages);
  /// The words that change the material's graph, those for its textures' means among them.
  lod::Words words() const;
  /// For lod::search(). A set that makes no shader, or one with other textures, is none; nobody draws one
  /// that costs more than `most`.
  std::vector<std::optional<lod::Tried>> measure(const std::vector<lod::Words>& sets,
                                                 double most = std::numeric_limits<double>::infinity());
  /// Whether two sets make one shader; false where one of them makes none.
  bool same(const lod::Words& a, const lod::Words& b);
  /// The same words with a few numbers of the material fitted again to the exact pictures;
  /// nothing where that cannot be, or changes nothing.
  std::optional<lod::Words> fitted(const lod::Words& words) const;

  /// The shader of a set of words, placed.
  Result<ir::Module> module(const lod::Words& words) const;
  /// Pictures by a set of words: of the ball one for each studio, then as many of the file's geometry. With
  /// `triangles` the ball is one of 1,010 vertices; else it is as round as can be, and has a facet.
  Result<std::vector<preview::Shot>> shots(const lod::Words& words, uint32_t size, bool triangles) const;
  /// What two sets of pictures of one size differ by: all of them, and those of the geometry.
  void compare(const std::vector<preview::Shot>& exact, const std::vector<preview::Shot>& simpler,
               SeenDifference& seen, std::optional<SeenDifference>& on_mesh, bool flip = true) const;
  /// What was found of a set that was measured, seen again by pictures of the whole size; with FLIP, which
  /// the search does without.
  Result<LevelFigures> seen(const lod::Words& words, bool flip);
  /// The same as the search has it, by small pictures and without FLIP.
  const LevelFigures& figures(const lod::Words& words) const { return figures_.at(ids_.at(words)); }
  /// "Mesa 22.3.6"; empty where the costs are estimates.
  const std::string& driver() const { return driver_; }
  size_t measured() const { return figures_.size(); }
  /// Sets of words that an earlier run had measured.
  size_t remembered() const { return remembered_; }
  /// Of the ball in the pictures: the geometry's, where there is one.
  double radius() const { return radius_; }

  /// Measures modules: cycles and instructions alone. Those with roots at a quarter of the rate take the
  /// driver half as long again, and are 0 unless `quarters`.
  Result<std::vector<LevelFigures>> costs(const std::vector<ir::Module>& modules, bool quarters);

private:
  /// A component of a number of the material.
  struct Parameter {
    std::string name;
    size_t component = 0, components = 1;
    double value = 0;
    std::vector<double> whole{};  ///< today's of all components
  };

  Options optionsOf(const lod::Words& words) const;
  Result<graph::Graph> graphOf(const lod::Words& words) const;
  Result<std::vector<preview::Shading>> shadings(const lod::Words& words, Messages& messages) const;
  const std::vector<preview::Coverage>& coverages(const preview::Mesh& mesh, uint32_t size,
                                                  uint32_t grid) const;
  std::vector<preview::Shot> shotsOf(const std::vector<preview::Shading>& shadings, uint32_t size,
                                     uint32_t grid, bool triangles) const;
  bool remembers(const lod::Words& set, double most);
  std::optional<lod::Tried> triedOf(const lod::Words& set, double most, bool remembered);
  void draw(const std::vector<ir::Module>& fresh,
            const std::vector<std::pair<std::string, const lod::Words*>>& of_fresh, double most);
  double costOf(const LevelFigures& figures) const;
  const std::string& idOf(const lod::Words& words);
  static std::vector<double> scalesOf(const lod::Words& words, const std::vector<Parameter>& parameters);
  std::vector<Parameter> fittable(const lod::Words& words) const;
  std::optional<std::vector<preview::Shot>> shotsWith(const std::vector<preview::Shading>& shadings,
                                                      const std::vector<Parameter>& parameters,
                                                      const std::vector<double>& scales,
                                                      bool triangles) const;
  void readTextures(EvalMaterial& evaluated);
  Key keyOf(const EvalMaterial& evaluated) const;
  std::optional<lod::Words> fit(const lod::Words& words) const;

  Given given_;
  uint32_t size_;
  double radius_;
  std::vector<preview::Studio> studios_;
  std::vector<preview::Shot> exact_[2], small_[2], fit_[2];  ///< to compare with; to search by; to fit
                                                             ///< to; the second of triangles
  preview::Mesh ball_;
  /// What is seen of a mesh, by size and grid, a view for each studio; none where it cannot be drawn.
  mutable std::map<std::tuple<const preview::Mesh*, uint32_t, uint32_t>, std::vector<preview::Coverage>>
      coverages_;
  std::string exact_graph_;
  std::optional<ir::Module> exact_module_;
  lod::Words means_;                             ///< words for textures that have images
  std::set<std::string> absent_;                 ///< textures that have none: nothing is known of them
  std::map<lod::Words, std::string> ids_;        ///< of what was measured
  std::map<lod::Words, std::string> shaders_;    ///< of what was asked for; empty where there is none
  std::map<std::string, LevelFigures> figures_;  ///< by shader
  std::map<Key, cost::Statistics> statistics_;   ///< of code without its disassembly, by the code
  std::string driver_;
  cost::Driver compiler_{cost::kFamilies[0]};
  std::map<std::string, LevelFigures> undrawn_;  ///< by shader, of those that cost too much to be drawn
  std::optional<uint64_t> exact_vertex_;         ///< cycles of the exact shader's vertex stage
  lod::Memory memory_;
  size_t remembered_ = 0;
};

}  // namespace lacquer
