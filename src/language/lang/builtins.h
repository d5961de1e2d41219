// The operators and functions of the node language that are ops of the DAG, or expand to some.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "ir/dag.h"

namespace lacquer::lang {

struct Builtin {
  std::string_view name;  ///< a function's name, or an operator's spelling
  int arity = 1;
  bool is_operator = false;
  std::string_view prose;
  std::string_view shape;        ///< what the operands must be, for a diagnostic
  ir::Op op = ir::Op::Constant;  ///< Constant: none, but an expansion
  std::optional<ir::Type> (*type)(const Builtin&, std::span<const ir::Type>) = nullptr;
  ir::ValueId (*make)(const Builtin&, ir::Dag&, std::span<const ir::ValueId>) = nullptr;
};

/// All of them, in the order in which the reference lists them.
std::span<const Builtin> builtins();

const Builtin* findFunction(std::string_view name, int arity);
/// The function of that name, whatever its arity.
const Builtin* findFunction(std::string_view name);
const Builtin* findOperator(std::string_view spelling, int arity);

}  // namespace lacquer::lang
