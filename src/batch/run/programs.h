// The programs of a run with --programs: which structures share one, and what each brings to it.
#pragma once

#include <functional>
#include <memory>
#include <set>

#include "programs/curve.h"
#include "programs/unite.h"
#include "programs/weights.h"
#include "run/divided.h"
#include "run/program_costs.h"
#include "structures/structures.h"

namespace lacquer {

/// What a look at all inputs has found.
class Uses {
public:
  void structure(const Key& key) { structures_.insert(key); }
  /// The ids of its shaders, by use, and the material's share of the picture.
  void material(const std::vector<std::string>& shaders, double share) {
    ++materials_;
    for (const std::string& shader : shaders)
      uses_.push_back({shader, share / static_cast<double>(shaders.size())});
  }
  const std::set<Key>& structures() const { return structures_; }
  const std::vector<ProgramUse>& uses() const { return uses_; }
  size_t materials() const { return materials_; }

private:
  std::set<Key> structures_;
  std::vector<ProgramUse> uses_;
  size_t materials_ = 0;
};

class Programs : public Sharing {
public:
  /// `structures`: those that the run has met, with their examples; `uses`: of every material. Decides which
  /// of them share a program, as the options say, or finds in the cache what was decided for such materials.
  Programs(const std::vector<const Structure*>& structures, const Examples& examples,
           const std::vector<ProgramUse>& uses, size_t materials, const Setting& setting);

  void note(const Key&, const material::Material&, const gltf::VertexAttributes&,
            const std::string&) override {}
  void note(const Key&, const graph::Graph&) override {}
  /// Until close() it only looks at the graph, and leaves it. From several threads at once.
  Share bring(Traced& own, const material::Material* material, const gltf::VertexAttributes& attributes,
              const passes::LightFacts& lights) override;
  /// Unites what was looked at. Not beside bring().
  void close();
  /// True where an earlier run has united what these materials bring: then nothing needs to be looked at.
  bool closeAsBefore();
  /// The examples may go from here on.
  void forgetExamples() { shapes_ = nullptr; }

  bool beside() const override;
  bool closed() const override { return closed_; }
  const Key& digest() const override { return digest_; }
  const programs::Curve& curve() const { return divided_.curve; }
  Diagnostics about(size_t made) const override;

private:
  void decide(const std::vector<const Structure*>& structures, const Examples& examples,
              const std::vector<ProgramUse>& uses);
  void share(const std::vector<OwnProgram>& all, const std::vector<programs::Places>& groups,
             const ProgramCosts& costs);
  std::optional<Key> unitedKey() const;
  void divide(const std::vector<OwnProgram>& all, const std::vector<ProgramUse>& uses, ProgramCosts& costs);
  /// Structures that share a program.
  struct Group {
    Lift lift;
    std::mutex mutex;
    std::map<Key, graph::Graph> graphs;  ///< of its materials, lifted: one for each structure
    std::map<Key, size_t> places;        ///< of those in the united graph
    programs::United united;
    passes::Readers readers;  ///< its materials' own programs
  };
  const Setting& setting_;
  struct Member {
    std::shared_ptr<Group> group;
    bool looks_through = false;  ///< its own shader does
  };
  std::map<Key, Member> members_;  ///< by the structure of a material's own graph
  bool closed_ = false;
  Key digest_;
  std::vector<std::shared_ptr<Group>> groups_;  ///< of divided_.shared
  std::optional<Key> key_;                      ///< of divided_; absent where it is not kept
  /// Of all materials; null where they do not say what the materials bring.
  const std::set<std::pair<Key, Key>>* shapes_ = nullptr;
  Divided divided_;
};

/// What is wrong with the options that ask for programs: "programs-baked", "report-format",
/// "fallback-parameters", "fallback-programs".
Diagnostics wrongOfPrograms(const Options& options);
/// Of the options' file; every material counts the same where they name none.
Result<programs::Weights> weightsOf(const Options& options, const Limits& limits);

/// The programs of all materials, as the options ask for them; the setting and the structures are then such
/// that describe() brings materials to them. `look`: describes all materials, and says what it finds. It is
/// called once, or twice: the first look finds the structures and how much each is used, the second, at one
/// material of each shape, what materials bring to the program that they share.
std::unique_ptr<Programs> sharePrograms(Setting& setting, Structures& structures,
                                        const std::function<void(Uses&)>& look);
/// The same for the materials of one document, or for those of the names in `only` where there are some.
/// Warnings go to `said`. Uses threads.
Result<std::unique_ptr<Sharing>> shareDocument(const material::Document& document,
                                               const std::vector<std::string>& only, Setting& setting,
                                               Structures& structures, Diagnostics& said);

}  // namespace lacquer
