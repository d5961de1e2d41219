// Rebuilding a module's DAG value by value: the frame that most passes share.
#pragma once

#include <functional>
#include <vector>

#include "ir/module.h"

namespace lacquer::passes {

/// Makes module.dag anew from the values that its outputs, varyings and preshader reach, in ascending order.
/// `make` is given each old value with its operands already mapped and returns the new value; it usually ends
/// in `dag.make(value.op, operands, value.payload)` through Rewriter::copy. Terms, names and assumed ranges
/// are carried over. All ids held by the module are remapped.
class Rewriter {
public:
  explicit Rewriter(ir::Module& module) : module_(module), old_(std::move(module.dag)) {}

  using Make =
      std::function<ir::ValueId(Rewriter&, ir::ValueId old_id, std::span<const ir::ValueId> operands)>;
  void run(const Make& make);

  const ir::Dag& old() const { return old_; }
  ir::Dag& dag() { return module_.dag; }
  ir::Module& module() { return module_; }
  /// The plain copy of an old value on new operands.
  ir::ValueId copy(ir::ValueId old_id, std::span<const ir::ValueId> operands);
  /// The new value of an old one that has been made already.
  ir::ValueId mapped(ir::ValueId old_id) const { return map_[old_id]; }

private:
  ir::Module& module_;
  ir::Dag old_;
  std::vector<ir::ValueId> map_;
};

}  // namespace lacquer::passes
