// What the shaders of merged structures cost: by a driver that compiles them, or by a model.
#pragma once

#include <map>

#include "programs/curve.h"
#include "programs/merging.h"
#include "programs/unite.h"
#include "run/lift.h"
#include "structures/structure.h"

namespace lacquer {

/// A program of a run before any merge, and the structures that share it.
struct OwnProgram {
  std::string shader;
  std::vector<const Structure*> structures;
  std::vector<graph::Graph> graphs;      ///< of the structures, in the order of their texts
  std::vector<const Example*> examples;  ///< a material of each
};

/// Of shaders in their plain forms: a search for cheaper ones (Options::optimize) takes seconds a shader, and
/// groups are many.
class ProgramCosts {
public:
  /// `all` must outlive it. With `by_model` no driver is asked even if there is one.
  ProgramCosts(const Setting& setting, const std::vector<OwnProgram>& all, bool by_model);

  /// What the structures of these programs have together.
  Lift liftOf(const programs::Places& group) const;
  /// The program of a group; errors where it cannot be.
  Result<ir::Module> moduleOfGroup(const programs::Places& group) const;
  /// Measures groups for the search: by the driver where there are few programs in all. Of groups of many
  /// structures, terms and choices are added up in place of a shader. Items alone come first. Uses threads.
  std::vector<std::optional<programs::Program>> measure(const std::vector<programs::Places>& groups);
  /// What the driver says of groups, as many as the time allows: nothing without one.
  std::vector<std::optional<double>> byDriver(const std::vector<programs::Places>& groups);

  /// Costs are the driver's.
  bool measured() const { return by_driver_; }
  const std::string& driver() const { return driver_; }
  /// A driver had no answer to a question: it may have one another time.
  bool failed() const { return failed_; }

private:
  std::optional<double> told(const std::optional<Key>& key);
  std::vector<std::optional<double>> cyclesOf(const std::vector<Result<ir::Module>>& modules);
  programs::Program byModel(const ir::Module& module);
  programs::Program byTerms(const programs::Places& group) const;
  double choicesOf(size_t structures) const;
  size_t structuresOf(const programs::Places& group) const;

  const Options plain_;
  const Setting setting_;
  const std::vector<OwnProgram>& all_;
  bool by_driver_ = false;
  bool no_driver_ = false;
  bool failed_ = false;
  std::string driver_;
  std::map<std::string, uint32_t, std::less<>> features_;
  std::map<uint32_t, programs::Program> alone_;  ///< by item
  /// Cycles beyond the terms' of the groups that were made, the most of one of them, and their structures.
  double choices_ = 0, most_choices_ = 0, chosen_ = 0;
};

}  // namespace lacquer
