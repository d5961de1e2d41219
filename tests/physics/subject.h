// What Lacquer makes of a material: its DAG, evaluated.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/evaluate.h"
#include "eval/points.h"
#include "physics/model.h"
#include "support/materials.h"

namespace lacquer::physics {

struct Configuration {
  std::string template_name = "forward";
  std::string profile = "khr";
  bool ibl = false;
  bool multiple_scattering = true;
  bool direct_multiple_scattering = false;
  bool dfg_table = true;
  bool placed = false;  ///< after the whole pipeline, with the preshader's values as floats
  bool tangents = true;
  bool quads = false;  ///< samples stand in fours, and derivatives are taken between them
  std::set<std::string> live;
  std::map<std::string, bool, std::less<>> switches;  ///< others
  std::optional<Vec4> texel;                          ///< of material textures without one of their own
  std::string output;                                 ///< the colour output's name; empty for the first
  /// What an engine gives, in place of what stands for it here: textures by slot, and fields by their names.
  std::map<std::string, eval::Sampler> textures;
  eval::Columns columns;
};

class Subject {
public:
  /// A test failure when the file or the material has an error.
  explicit Subject(const Material& material, const Configuration& setup = {});
  /// A material of a file's text.
  Subject(const std::string& gltf, size_t material, std::map<std::string, Vec4> texels,
          const Configuration& setup = {});

  /// The colour output at each point. A constant environment may be given.
  template <class T>
  std::vector<Vec4> colors(std::span<const Sample> samples, const Vec3& environment = {0, 0, 0}) const;
  template <class T>
  Vec4 color(const Sample& sample, const Vec3& environment = {0, 0, 0}) const {
    return colors<T>({&sample, 1}, environment)[0];
  }

  const ir::Module& module() const { return module_; }
  bool has(const std::string& node) const { return graph_.find(node).has_value(); }
  explicit operator bool() const { return !module_.outputs.empty(); }

private:
  void make(const std::string& gltf, size_t material, const Configuration& setup);

  graph::Graph graph_;
  ir::Module module_;
  std::map<std::string, Vec4> texels_;
  Configuration setup_;
};

}  // namespace lacquer::physics
