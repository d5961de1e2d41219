// What is attacked: a node by itself, or a whole material, as a function from a sample to values.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "analysis/interval_math.h"
#include "eval/evaluate.h"
#include "ir/module.h"
#include "stress/space.h"

namespace lacquer::stress {

enum class Arithmetic : uint8_t { Float, Double, Half };

struct Root {
  enum class Kind : uint8_t {
    Result,     ///< what the node or the material gives
    Fact,       ///< a value that an `assume` speaks of
    Condition,  ///< a comparison: where it turns, results may jump
    Gap,        ///< the difference of the numbers that the comparison before it compares
  };
  Kind kind = Kind::Result;
  std::string name;  ///< "the result", "planar2", "NdotSum > 0"
  int components = 1;
  bool flag = false;        ///< a Bool: 0 or 1, and no jump when it turns
  analysis::Range allowed;  ///< Result, Fact: with the slack of float32
};

/// By parameter: the value of each component.
using Layers = std::vector<std::pair<std::string, std::vector<double>>>;

/// By root: the components of each sample side by side.
using Values = std::vector<std::vector<double>>;

class Subject {
public:
  virtual ~Subject() = default;

  std::string name;
  bool is_node = true;
  Space space;
  std::vector<Root> roots;
  /// Samples stand in groups of so many: 4 where derivatives are taken between neighbours, else 1.
  size_t group = 1;
  /// Points that stand for one sample: 4 for a material that takes derivatives, since its neighbours belong
  /// to it.
  size_t lanes = 1;
  /// Of a material: the parameters by which its layers vanish, and at which numbers they do.
  Layers layers;
  /// Of a material, by the term that stands before a condition's name: the library's nodes that it is of.
  struct OfTerm {
    std::string own, called;  ///< their names, joined by spaces; those of all that they call
  };
  std::map<std::string, OfTerm, std::less<>> terms;

  /// `samples` are those of `count` points, side by side. Thread-safe.
  virtual Values evaluate(Arithmetic arithmetic, std::span<const double> samples, size_t count) const = 0;
  /// The same in one of the arithmetics that Vulkan allows float32 (eval/rough.h); another seed draws
  /// another.
  virtual Values evaluateRough(std::span<const double> samples, size_t count, uint64_t seed) const = 0;

  /// What a device runs, and what its inputs are, in float: `lanes` points for each sample.
  virtual const ir::Module& module() const = 0;
  virtual eval::Bindings inputs(std::span<const double> samples, size_t count) const = 0;
  /// By sample: whether the numbers mean one result. Not where steps to the neighbours span no area: which
  /// way a tangent lies that comes of them is rounding's to say, and it must only be finite.
  virtual std::vector<bool> defined(std::span<const double> samples, size_t count) const = 0;
};

/// A node's own module: inputs are its parameters, outputs its results, in order, `results` with their
/// ranges. Parameters that nodes call N, V, L, T, B, sum, length2, NdotL and so on belong to one geometry of
/// unit vectors, rounded as float32 rounds them. Open ends of ranges are cut at 2^27.
struct NodeSource {
  std::string name;
  ir::Module module;
  std::vector<std::pair<std::string, ir::Interval>> results;
};
Result<std::unique_ptr<Subject>> nodeSubject(NodeSource source);

/// A forward module after all passes, with one directional light: a sample is a point, its view and its
/// light, every texel and every parameter of the material.
/// `layers` are those that may lie over the base; names that the module does not have count for nothing.
Result<std::unique_ptr<Subject>> materialSubject(std::string name, ir::Module module, Layers layers);

/// A comparison's roots, and their values: its own, and of two numbers the gap between them.
void addCondition(ir::Module& module, ir::ValueId id, std::string name, std::vector<Root>& roots,
                  std::vector<ir::ValueId>& ids);

/// A comparison as a person writes it, of two names or constants where they have such.
std::string conditionName(const ir::Module& module, ir::ValueId id);

}  // namespace lacquer::stress
