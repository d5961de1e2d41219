// The function of a module: the statements of a Program, each value computed once in a block that dominates
// its uses.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "ir/loops.h"
#include "ir/names.h"
#include "schedule/schedule.h"
#include "targets/spirv/interface.h"
#include "targets/target.h"

namespace lacquer::targets::spirv {

class Body {
public:
  Body(const ir::Module& module, const schedule::Program& program, const Interface& interface,
       Globals& globals, const SpirvOptions& options);

  /// Writes the function; returns its id.
  uint32_t write();
  const Words& code() const { return code_; }

private:
  /// A loop's sum: the phi at its head, and the value that the next round starts from.
  struct Sum {
    ir::ValueId value;
    uint32_t phi, next;
  };
  /// A loop over lights, or one of the DAG's.
  struct Loop {
    uint32_t head = 0, next_step = 0, merge = 0;
    uint32_t index = 0, next_index = 0;
    std::vector<Sum> sums;      ///< over lights
    std::vector<size_t> nexts;  ///< of a loop of the DAG: where in the code its phis have the next value
    std::vector<uint32_t> made, splats;  ///< indices of ids_ and of splats_: forgotten after the loop
  };
  struct Instruction {
    ir::SpirvSet set;
    uint32_t opcode;
  };

  // values
  uint32_t value(ir::ValueId id) { return in(id, false); }
  uint32_t in(ir::ValueId id, bool half);
  uint32_t own(ir::ValueId id);
  uint32_t make(ir::ValueId id);
  uint32_t special(ir::ValueId id);
  uint32_t operation(ir::ValueId id);
  uint32_t fusedSum(ir::ValueId id, size_t product);
  uint32_t operand(ir::ValueId user, size_t index);
  uint32_t splat(ir::ValueId scalar, ir::Type like, bool half);
  uint32_t constant(ir::ValueId id);
  uint32_t input(ir::ValueId id);
  uint32_t nonUniform(uint32_t made);
  uint32_t load(ir::ValueId id, uint32_t variable);
  uint32_t blockField(ir::ValueId id, const ir::Input& input, int component);
  uint32_t element(ir::ValueId id, int column = -1);
  uint32_t column(ir::ValueId id);
  uint32_t construct(ir::ValueId id);
  uint32_t swizzle(ir::ValueId id);
  uint32_t texture(ir::ValueId id);
  uint32_t textureAt(ir::ValueId id);
  uint32_t textureSize(ir::ValueId id);
  uint32_t component(uint32_t vector, uint32_t index);
  std::pair<uint32_t, uint32_t> boundsOf(const ir::LightGroup& group, const ir::Value& sum);
  uint32_t lightCount();
  uint32_t instruction(ir::ValueId id, const Instruction& what, const uint32_t* operands, size_t count);
  uint32_t result(ir::ValueId id);
  bool relaxed(ir::ValueId id) const { return relaxed_ && !half_ && dag_.relaxed(id); }
  bool half(ir::ValueId id) const { return half_ && dag_.relaxed(id) && ir::isFloating(dag_[id].type); }

  // statements
  void statement(const schedule::Statement& statement);
  void openLoop(const schedule::Statement& statement);
  void openRounds(ir::ValueId chain);
  Loop& enter();
  void begin(const Loop& loop, uint32_t first);
  void runWhile(const Loop& loop, uint32_t end);
  uint32_t lightIndex() const;
  void hoist(const std::vector<ir::ValueId>& sums);
  void hoist(const ir::Loop& loop);
  void accumulate(ir::ValueId sum);
  void closeLoop();
  void closeRounds(ir::ValueId chain);
  void discard(ir::ValueId condition);
  void derivativesFirst();
  void label(uint32_t id);

  // preparation
  void findLoneComponents();
  void findFusedProducts();

  const ir::Module& module_;
  const ir::Dag& dag_;
  const schedule::Program& program_;
  const Interface& interface_;
  Globals& globals_;
  const bool debug_;
  const bool relaxed_;  ///< what the Dag says is relaxed counts
  const bool half_;     ///< relaxed operations have types of 16 bits
  const size_t forms_;  ///< of a value in splats_
  Words code_;

  const std::vector<ir::ValueId>& live_;
  ir::Loops loops_;
  std::vector<uint8_t> product_in_;      ///< by value: of a sum, 1 + the operand that it multiplies itself
  std::vector<uint8_t> fused_;           ///< by value: a product that is part of the one sum that reads it
  std::vector<uint32_t> ids_;            ///< by value: its id, 0 while it has none here
  std::vector<uint32_t> splats_;         ///< forms_ ids a value: of its splats and its conversion
  std::vector<uint8_t> lone_component_;  ///< by value, see findLoneComponents
  std::vector<Loop> open_;               ///< the loops around what is written, the outermost first
  uint32_t block_ = 0;                   ///< the label of the block being written
  uint32_t light_count_ = 0;             ///< loaded once, before the first loop that needs it

  ir::TermId term_ = 0;                      ///< that the last OpLine named
  std::map<std::string, uint32_t> strings_;  ///< the ids of OpStrings
};

}  // namespace lacquer::targets::spirv
