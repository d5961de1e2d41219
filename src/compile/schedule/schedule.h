// A stage of a module, decided to the last detail: which values get a variable and its name, in which order,
// where the light loops stand, what the interface is. A printer walks it and decides nothing.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "ir/module.h"

namespace lacquer::schedule {

enum class StatementKind : uint8_t {
  Section,      ///< a comment: `term` of the dag (name and source)
  Let,          ///< declares the variable names[value] and computes `value` into it
  LoopBegin,    ///< declares `sums` (names[sum], zero), then opens the loop over light group `group`
  Accumulate,   ///< names[value] += operand 0 of the SumOverLights `value`; inside the loop
  LoopEnd,      ///< closes the loop
  RoundsBegin,  ///< declares what the loop whose chain `value` ends carries (names[LoopValue], the first
                ///< values), then opens it; its counter is names[LoopIndex]
  Hold,         ///< declares the variable `name` with what the LoopValue `value` is in this round
  Next,         ///< names[value] = `next`, or what is held under `name` where that is not empty
  RoundsEnd,    ///< closes the loop whose chain `value` ends
  Discard,      ///< drops the fragment when the Bool `value` is true
  Output,       ///< assigns outputs[output].value to that output
};

struct Statement {
  StatementKind kind;
  ir::ValueId value = ir::kNoValue;
  ir::TermId term = 0;
  uint32_t group = 0;
  uint32_t output = 0;            ///< index into Module::outputs
  std::vector<ir::ValueId> sums;  ///< SumOverLights values of a loop
  ir::ValueId next = ir::kNoValue;
  std::string name{};
};

struct Program {
  ir::Stage stage = ir::Stage::Fragment;
  std::vector<Statement> statements;
  std::vector<ir::ValueId> live;  ///< what the outputs, or the preshader's fields, reach; ascending
  /// By value id: the variable's name, or empty when the value is written where it is used. Names are unique
  /// in the stage and are identifiers in every target. An Input has none, but for those of loops; what a loop
  /// has carried is called as in its rounds.
  std::vector<std::string> names;
  std::vector<uint32_t> blocks;    ///< used, indices into Module::blocks, ascending; all fields are declared
  std::vector<uint32_t> textures;  ///< used, indices into Module::textures, by binding
  std::vector<uint32_t> attributes;  ///< vertex stage: used, indices into Module::attributes, by location
  std::vector<uint32_t>
      varyings;  ///< indices into Module::varyings, by location: written (vertex) or read (fragment)
  std::vector<uint32_t>
      parameters;  ///< used specialization constants, indices into Module::parameters, by constant id
  std::vector<uint32_t> outputs;  ///< Color outputs (fragment), indices into Module::outputs
  bool front_facing = false;
};

/// Schedules one stage of a placed and legalized module.
Program schedule(const ir::Module& module, ir::Stage stage);

/// The values that the preshader's expressions share or that deserve a name, as Section and Let statements;
/// the fields themselves are Module::preshader's. Variables get none of the `taken` names.
Program schedulePreshader(const ir::Module& module, std::span<const std::string> taken);

}  // namespace lacquer::schedule
