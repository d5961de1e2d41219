// Rules as text: "a * b + a * c => a * (b + c)".
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "optimize/egraph.h"

namespace lacquer::optimize {

/// Letters of a pattern stand for classes.
inline constexpr size_t kMostLetters = 6;
using Letters = std::array<Ref, kMostLetters>;

/// An expression over letters, numbers and operations. `a - b` is a + -b, `a / b` is a * rcp(b), as in a
/// Plan.
struct Pattern {
  struct Term {
    enum class Kind : uint8_t { Letter, Number, Operation };
    Kind kind = Kind::Letter;
    ir::Op op = ir::Op::Constant;
    uint8_t letter = 0;  ///< Letter: its place
    double number = 0;
    uint8_t count = 0;
    std::array<uint8_t, 3> args{};  ///< places of terms
  };
  std::vector<Term> terms;
  uint8_t root = 0;
};

/// What must hold of a letter for a rule to hold.
struct Condition {
  enum class Kind : uint8_t {
    Positive,     ///< a > 0
    NotNegative,  ///< a >= 0
    NotPositive,  ///< a <= 0
    NotZero,      ///< a != 0
    AtMost,       ///< a <= b, or a number
    AtLeast,      ///< a >= b, or a number
    Number,       ///< float a: no vector
    Slow,         ///< slow a: of the material's rate, or a constant
    Finite,       ///< finite a: no infinity, and a number
  };
  Kind kind;
  uint8_t letter = 0;
  int other = -1;  ///< another letter, or the number below
  double number = 0;
};

struct Rule {
  std::string_view name, left, right, conditions, why;
  Pattern from, to;
  std::vector<Condition> when;
};

/// Aborts where the text is none: rules are part of the program.
Rule ruleOf(std::string_view name, std::string_view left, std::string_view right, std::string_view conditions,
            std::string_view why);

/// Calls `found` with the letters of each way in which a node of the graph is the pattern. False ends it.
void match(const EGraph& graph, const Pattern& pattern, NodeId node,
           const std::function<bool(const Letters&)>& found);
/// Whether the conditions hold for the graph's classes.
/// `floats`: in float32 as well as in real arithmetic.
bool holds(const EGraph& graph, std::span<const Condition> conditions, const Letters& letters, bool floats);
/// The class of a pattern over classes; kNoRef where types do not fit or the graph is full.
Ref build(EGraph& graph, const Pattern& pattern, const Letters& letters);

}  // namespace lacquer::optimize
