#include "optimize/pattern.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cstdio>
#include <cstdlib>

#include "support/letters.h"

namespace lacquer::optimize {

using ir::Op;

namespace {

using Term = Pattern::Term;

[[noreturn]] void wrong(std::string_view text, const char* what) {
  std::fprintf(stderr, "the rule \"%.*s\": %s\n", static_cast<int>(text.size()), text.data(), what);
  std::abort();
}

class Parser {
public:
  explicit Parser(std::string_view text) : text_(text) {}

  Pattern pattern() {
    pattern_.root = sum();
    if (peek() != 0) wrong(text_, "there is more behind the expression");
    return std::move(pattern_);
  }

  std::vector<Condition> conditions() {
    std::vector<Condition> all;
    while (peek() != 0) {
      all.push_back(condition());
      if (peek() == ',') ++at_;
    }
    return all;
  }

private:
  char peek() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(std::string_view token) {
    peek();
    if (!text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }
  void expect(char c) {
    if (peek() != c) wrong(text_, "a parenthesis or comma is missing");
    ++at_;
  }

  uint8_t add(const Term& term) {
    pattern_.terms.push_back(term);
    return static_cast<uint8_t>(pattern_.terms.size() - 1);
  }
  uint8_t operation(Op op, std::initializer_list<uint8_t> args) {
    Term term;
    term.kind = Term::Kind::Operation;
    term.op = op;
    for (const uint8_t arg : args) term.args[term.count++] = arg;
    return add(term);
  }

  uint8_t sum() {
    uint8_t left = product();
    while (true) {
      if (take("+")) {
        const uint8_t right = product();
        left = operation(Op::Add, {left, right});
      } else if (take("-")) {
        const uint8_t right = product();
        left = operation(Op::Add, {left, operation(Op::Neg, {right})});
      } else {
        return left;
      }
    }
  }
  uint8_t product() {
    uint8_t left = factor();
    while (true) {
      if (take("*")) {
        const uint8_t right = factor();
        left = operation(Op::Mul, {left, right});
      } else if (take("/")) {
        const uint8_t right = factor();
        left = operation(Op::Mul, {left, operation(Op::Div, {right})});
      } else {
        return left;
      }
    }
  }
  uint8_t factor() {
    if (take("-")) {
      const bool literal = isDigit(peek());
      const uint8_t of = factor();
      if (!literal) return operation(Op::Neg, {of});
      pattern_.terms[of].number *= -1;
      return of;
    }
    if (take("(")) {
      const uint8_t inner = sum();
      expect(')');
      return inner;
    }
    if (isDigit(peek())) {
      Term term;
      term.kind = Term::Kind::Number;
      term.number = number();
      return add(term);
    }
    const std::string_view word = this->word();
    if (word.size() == 1) {
      Term term;
      term.letter = letterOf(word);
      return add(term);
    }
    return call(word);
  }

  uint8_t call(std::string_view name) {
    std::vector<uint8_t> args;
    expect('(');
    do {
      args.push_back(sum());
    } while (take(","));
    expect(')');
    if (name == "rcp" && args.size() == 1) return operation(Op::Div, {args[0]});
    const std::optional<Op> op = ir::findOp(name);
    if (!op || ir::info(*op).arity != static_cast<int>(args.size()))
      wrong(text_, "no operation has that name");
    Term term;
    term.kind = Term::Kind::Operation;
    term.op = *op;
    for (const uint8_t arg : args) term.args[term.count++] = arg;
    return add(term);
  }

  std::string_view word() {
    peek();
    const size_t begin = at_;
    while (at_ < text_.size() && (isLetterOrDigit(text_[at_]) || text_[at_] == '_')) ++at_;
    if (at_ == begin) wrong(text_, "an expression is missing");
    return text_.substr(begin, at_ - begin);
  }

  uint8_t letterOf(std::string_view word) const {
    if (word.size() != 1 || word[0] < 'a' || word[0] >= static_cast<char>('a' + kMostLetters))
      wrong(text_, "letters are a to f");
    return static_cast<uint8_t>(word[0] - 'a');
  }

  double number() {
    peek();
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) wrong(text_, "a number is missing");
    at_ = static_cast<size_t>(end - text_.data());
    return value;
  }

  Condition condition() {
    using Kind = Condition::Kind;
    std::string_view first = word();
    if (first == "float" || first == "slow" || first == "finite") {
      const Kind kind = first == "float" ? Kind::Number : first == "slow" ? Kind::Slow : Kind::Finite;
      return {kind, letterOf(word())};
    }
    Condition result{Kind::NotZero, letterOf(first)};
    const bool at_most = take("<=");
    const bool at_least = !at_most && take(">=");
    const bool positive = !at_most && !at_least && take(">");
    if (!at_most && !at_least && !positive && !take("!=")) wrong(text_, "a relation is missing");
    if (isLetter(peek())) {
      result.other = letterOf(word());
      result.kind = at_most ? Kind::AtMost : Kind::AtLeast;
      if (!at_most && !at_least) wrong(text_, "letters are compared by <= and >=");
      return result;
    }
    result.number = number();
    const bool zero = result.number == 0;
    if (at_most) result.kind = zero ? Kind::NotPositive : Kind::AtMost;
    if (at_least) result.kind = zero ? Kind::NotNegative : Kind::AtLeast;
    if (positive) result.kind = Kind::Positive;
    if ((positive || result.kind == Kind::NotZero) && !zero) wrong(text_, "it is compared with 0");
    return result;
  }

  std::string_view text_;
  size_t at_ = 0;
  Pattern pattern_;
};

class Matcher {
public:
  Matcher(const EGraph& graph, const Pattern& pattern, const std::function<bool(const Letters&)>& found)
      : graph_(graph), pattern_(pattern), found_(found) {
    letters_.fill(kNoRef);
  }

  void run(NodeId node) {
    const Term& root = pattern_.terms[pattern_.root];
    node_(root, node, 0);
  }

private:
  struct Goal {
    uint8_t term;
    Ref id;
  };

  /// What is left to be met; true goes on.
  bool goals() {
    if (open_.empty()) return found_(letters_);
    const Goal goal = open_.back();
    open_.pop_back();
    const bool more = this->goal(goal);
    open_.push_back(goal);
    return more;
  }

  bool goal(const Goal& goal) {
    const Term& term = pattern_.terms[goal.term];
    const Ref id = graph_.find(goal.id);
    if (term.kind == Term::Kind::Letter) {
      Ref& letter = letters_[term.letter];
      if (letter != kNoRef) return letter == id ? goals() : true;
      letter = id;
      const bool more = goals();
      letters_[term.letter] = kNoRef;
      return more;
    }
    if (term.kind == Term::Kind::Number) return graph_.isNumber(id, term.number) ? goals() : true;
    for (const NodeId node : graph_[id].nodes) {
      if (!node_(term, node, 0)) return false;
    }
    return true;
  }

  bool node_(const Term& term, NodeId id, int) {
    const Node& node = graph_.node(id);
    if (!graph_.live(id) || node.opaque() || node.op != term.op || node.count != term.count) return true;
    if (!inOrder(term, node, false)) return false;
    if (!commutes(node.op) || graph_.find(node.args[0]) == graph_.find(node.args[1])) return true;
    return inOrder(term, node, true);
  }

  bool inOrder(const Term& term, const Node& node, bool exchanged) {
    const size_t before = open_.size();
    for (size_t k = term.count; k-- > 0;) {
      const size_t from = exchanged ? 1 - k : k;
      open_.push_back({term.args[k], node.args[from]});
    }
    const bool more = goals();
    open_.resize(before);
    return more;
  }

  const EGraph& graph_;
  const Pattern& pattern_;
  const std::function<bool(const Letters&)>& found_;
  Letters letters_;
  std::vector<Goal> open_;
};

}  // namespace

Rule ruleOf(std::string_view name, std::string_view left, std::string_view right, std::string_view conditions,
            std::string_view why) {
  return {name,
          left,
          right,
          conditions,
          why,
          Parser(left).pattern(),
          Parser(right).pattern(),
          Parser(conditions).conditions()};
}

void match(const EGraph& graph, const Pattern& pattern, NodeId node,
           const std::function<bool(const Letters&)>& found) {
  Matcher(graph, pattern, found).run(node);
}

namespace {

bool holdsIn(const EGraph& graph, std::span<const Condition> conditions, const Letters& letters,
             const Range& (EGraph::*range)(Ref, int) const) {
  using Kind = Condition::Kind;
  for (const Condition& condition : conditions) {
    const Ref id = letters[condition.letter];
    const Class& of = graph[id];
    if (condition.kind == Kind::Number) {
      if (of.type != ir::Type::Float) return false;
      continue;
    }
    if (condition.kind == Kind::Slow) {
      if (of.rate > ir::Rate::Material) return false;
      continue;
    }
    int width = ir::componentCount(of.type);
    if (condition.other >= 0)
      width = std::max(width, graph.width(letters[static_cast<size_t>(condition.other)]));
    for (int c = 0; c < width && c < 4; ++c) {
      const Range& a = (graph.*range)(id, c);
      Range b{condition.number, condition.number, false};
      if (condition.other >= 0) b = (graph.*range)(letters[static_cast<size_t>(condition.other)], c);
      if (a.nan || b.nan) return false;
      bool good = false;
      switch (condition.kind) {
        case Kind::Positive: good = a.lo > 0; break;
        case Kind::NotNegative: good = a.lo >= 0; break;
        case Kind::NotPositive: good = a.hi <= 0; break;
        case Kind::NotZero: good = a.lo > 0 || a.hi < 0; break;
        case Kind::AtMost: good = a.hi <= b.lo; break;
        case Kind::AtLeast: good = a.lo >= b.hi; break;
        case Kind::Finite: good = a.finite(); break;
        case Kind::Number:
        case Kind::Slow: break;
      }
      if (!good) return false;
    }
  }
  return true;
}

}  // namespace

bool holds(const EGraph& graph, std::span<const Condition> conditions, const Letters& letters, bool floats) {
  return holdsIn(graph, conditions, letters, &EGraph::range) &&
         (!floats || holdsIn(graph, conditions, letters, &EGraph::floatRange));
}

Ref build(EGraph& graph, const Pattern& pattern, const Letters& letters) {
  std::array<Ref, 24> made{};
  assert(pattern.terms.size() <= made.size());
  // Terms stand behind their operands.
  for (size_t i = 0; i < pattern.terms.size(); ++i) {
    const Term& term = pattern.terms[i];
    switch (term.kind) {
      case Term::Kind::Letter: made[i] = letters[term.letter]; break;
      case Term::Kind::Number: made[i] = graph.constant(ir::Type::Float, term.number); break;
      case Term::Kind::Operation:
        if (term.count == 1) made[i] = graph.make(term.op, {made[term.args[0]]});
        if (term.count == 2) made[i] = graph.make(term.op, {made[term.args[0]], made[term.args[1]]});
        if (term.count == 3)
          made[i] = graph.make(term.op, {made[term.args[0]], made[term.args[1]], made[term.args[2]]});
        break;
    }
    if (made[i] == kNoRef) return kNoRef;
  }
  return made[pattern.root];
}

}  // namespace lacquer::optimize
