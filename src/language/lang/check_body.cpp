#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lang/bounds.h"
#include "lang/checker.h"
#include "lang/evaluate.h"
#include "lang/parser.h"

namespace lacquer::lang {

using ir::Type;
using ir::typeName;

namespace {

constexpr uint64_t kMostTrips = 1024;
constexpr uint64_t kMostWeight = 1U << 20U;
constexpr uint32_t kMostHeight = 4096;
constexpr size_t kMostNames = 4096;  ///< looked through for each name

template <class Visit>
void eachAssignment(const std::vector<Statement>& statements, const Visit& visit) {
  for (const Statement& statement : statements) {
    if (statement.kind == Statement::Kind::Assign) visit(statement);
    eachAssignment(statement.body, visit);
    eachAssignment(statement.otherwise, visit);
  }
}

}  // namespace

void Checker::body(NodeDecl& decl, std::string_view variant, Span place, Body& body) {
  variant_ = variant;
  names_.clear();
  unused_.clear();
  slots_.clear();
  bounds_.clear();
  assigned_.clear();
  eachAssignment(body.statements, [this](const Statement& s) { assigned_.insert(s.name); });
  arms_ = block_depth_ = 0;
  crowded_ = false;
  may_have_returned_ = false;
  trips_ = 1;
  weight_ = 0;
  unties_ = 0;
  deepest_statement_ = deepest_expression_ = deepest_callee_ = 0;
  const size_t errors = reporter_.count();
  for (const Param& param : decl.params) {
    names_.push_back({param.name, Name::Kind::Param, param.type, slotCount(), param.span, true, false, {}});
    slots_.push_back(param.name);
    bounds_.push_back(param.range);
    if (param.name == "PI" ||
        around_.find(param.name).value_or(Surroundings::Found{}).kind == DeclKind::Const) {
      if (!variant.empty()) continue;  // said once, at the reference
      reporter_.error("shadowing", param.span, fmt::format("'{}' is a constant", param.name),
                      "give the parameter another name");
    }
  }
  const Flow flow = block(body.statements);
  body.slots = std::move(slots_);
  // Other errors may be why a local seems unused, and so may a missing return.
  if (flow == Flow::Returns && reporter_.count() == errors) unused();
  if (flow != Flow::Returns && reporter_.count() == errors) {
    reporter_.error("missing-return", place,
                    fmt::format("'{}' can end without a value", variant.empty() ? decl.name : variant),
                    "every way through the body ends with a return");
  }
  const uint32_t height = deepest_statement_ + deepest_expression_ + deepest_callee_;
  decl.weight = std::max(decl.weight, static_cast<uint32_t>(std::min(weight_, kMostWeight + 1)));
  decl.height = std::max(decl.height, height);
  decl.unties |= unties_;
  if (weight_ > kMostWeight || height > kMostHeight) {
    reporter_.error("node-too-large", place,
                    fmt::format("'{}' is too large once its calls and loops are written out", decl.name));
  }
}

void Checker::declare(Name name) {
  const auto same = [&](const Name& other) { return other.name == name.name; };
  const auto other = std::find_if(names_.begin(), names_.end(), same);
  const auto found = around_.find(name.name);
  if (other != names_.end()) {
    const std::string where = other->inherited
                                  ? "it comes from the template that this one extends"
                                  : fmt::format("the other is in line {}", reporter_.lineOf(other->span));
    reporter_.error("shadowing", name.span, fmt::format("'{}' is declared already", name.name),
                    where + "; give this one another name");
    // The uses that follow may mean either.
    other->broken = other->used = true;
    return;
  }
  if (name.name == "PI" || (found && found->kind == DeclKind::Const)) {
    reporter_.error("shadowing", name.span, fmt::format("'{}' is a constant", name.name),
                    "give this another name");
  }
  if (names_.size() == kMostNames) {
    if (std::exchange(crowded_, true)) return;
    reporter_.error("node-too-large", name.span, fmt::format("more than {} names are in scope", kMostNames),
                    "write several nodes");
    return;
  }
  names_.push_back(std::move(name));
}

/// Ends a scope: what it declared is forgotten, and must have been used.
void Checker::leave(size_t scope) {
  for (size_t i = scope; i < names_.size(); ++i) {
    const Name& name = names_[i];
    if (name.used || name.broken || name.kind != Name::Kind::Local) continue;
    unused_.emplace_back(name.name, name.span);
  }
  names_.resize(scope);
}

void Checker::unused() {
  std::sort(unused_.begin(), unused_.end(),
            [](const auto& a, const auto& b) { return a.second.offset < b.second.offset; });
  for (const auto& [name, span] : unused_) {
    reporter_.error("unused-local", span, fmt::format("'{}' is never used", name), "remove it");
  }
}

Checker::Flow Checker::block(std::vector<Statement>& statements) {
  const size_t scope = names_.size();
  Flow flow = Flow::Falls;
  deepest_statement_ = std::max(deepest_statement_, ++block_depth_);
  bool said = false;
  for (Statement& s : statements) {
    if (flow == Flow::Returns && !said) {
      said = true;
      reporter_.error("unreachable", s.span, "nothing comes here: every way before it returns", "remove it");
    }
    const Flow here = statement(s);
    if (flow == Flow::Returns) continue;
    if (here != Flow::Falls) flow = here;
    may_have_returned_ = may_have_returned_ || here == Flow::MayReturn;
  }
  --block_depth_;
  leave(scope);
  return flow;
}

Checker::Flow Checker::statement(Statement& statement) {
  weight_ += trips_;
  switch (statement.kind) {
    case Statement::Kind::Let: let(statement); return Flow::Falls;
    case Statement::Kind::Assign: assign(statement); return Flow::Falls;
    case Statement::Kind::If: return ifElse(statement);
    case Statement::Kind::For: return loop(statement);
    case Statement::Kind::Return: returns(statement); return Flow::Returns;
    case Statement::Kind::Assume: assume(statement); return Flow::Falls;
  }
  return Flow::Falls;
}

void Checker::let(Statement& statement) {
  Name name{statement.name, Name::Kind::Local, statement.type, 0, statement.name_span, false, false, {}};
  ExprPtr& value = statement.values[0];
  bool good = false;
  if (statement.inferred) {
    good = expression(value);
    if (good) makeFloat(*value);
    if (good && value->kind == Expr::Kind::Call && value->node->results.size() > 1) {
      name.multiple = true;
      for (const Param& result : value->node->results) name.members.push_back({result.name, result.type});
      statement.results = static_cast<uint32_t>(name.members.size());
    }
    if (good) name.type = value->type;
  } else {
    good = typed(value, statement.type, fmt::format("'{}'", statement.name));
  }
  const bool possible = !ir::isTexture(name.type);
  if ((good || !statement.inferred) && !possible) {
    reporter_.error("wrong-type", statement.name_span, fmt::format("a local cannot be {}", aType(name.type)),
                    "use the value where it is needed");
    good = false;
  }
  name.broken = statement.inferred ? !good : !possible;
  statement.type = name.type;
  statement.slot = name.slot = slotCount();
  if (good && !assigned_.contains(name.name) && ir::componentCount(name.type) == 1) {
    bounds_.resize(slotCount());
    bounds_.push_back(boundOf(*value));
  }
  if (name.members.empty()) slots_.push_back(name.name);
  for (Member& member : name.members) {
    member.slot = slotCount();
    slots_.push_back(member.name);
  }
  declare(std::move(name));
}

void Checker::assign(Statement& statement) {
  Name* target = find(statement.name);
  const size_t index = target == nullptr ? 0 : static_cast<size_t>(target - names_.data());
  const bool was_used = target != nullptr && target->used;
  if (target == nullptr) {
    ExprPtr& value = statement.inferred ? statement.values[0]->args[1] : statement.values[0];
    const auto constant = around_.find(statement.name);
    if (constant && constant->kind == DeclKind::Const) {
      reporter_.error("not-assignable", statement.name_span,
                      fmt::format("'{}' is a constant", statement.name));
      return;
    }
    std::vector<std::string_view> locals;
    for (const Name& name : names_) {
      if (name.kind == Name::Kind::Local) locals.push_back(name.name);
    }
    unknown(statement.name, "local", std::move(locals),
            fmt::format("declare it: `let {} = ...;`", statement.name));
    expression(value);
    return;
  }
  if (target->kind != Name::Kind::Local || target->multiple) {
    const std::string_view what = target->kind == Name::Kind::Param     ? "a parameter"
                                  : target->kind == Name::Kind::Counter ? "a loop's counter"
                                                                        : "the result of a call";
    reporter_.error("not-assignable", statement.name_span, fmt::format("'{}' is {}", statement.name, what),
                    "only locals can be assigned; copy it into one");
    expression(statement.values[0]);
    return;
  }
  if (target->broken) return;
  statement.type = target->type;
  statement.slot = target->slot;
  typed(statement.values[0], target->type, fmt::format("'{}'", statement.name));
  // `x += e` alone does not use x.
  if (statement.inferred) names_[index].used = was_used;
}

Checker::Flow Checker::ifElse(Statement& statement) {
  typed(statement.values[0], Type::Bool, "the condition");
  statement.slot = slotCount();
  ++arms_;
  const bool before = may_have_returned_;
  const Flow yes = block(statement.body);
  may_have_returned_ = before;
  const Flow no = block(statement.otherwise);
  may_have_returned_ = before;
  --arms_;
  if (yes == no) return yes;
  return Flow::MayReturn;
}

ir::Interval Checker::boundOf(const Expr& expr) const {
  return boundsOf(expr,
                  [this](uint32_t slot) { return slot < bounds_.size() ? bounds_[slot] : ir::Interval{}; });
}

/// How many rounds a loop has at most; 1 where that is wrong.
uint64_t Checker::rounds(Statement& statement) {
  const std::optional<int> first = constantInt(statement.values[0], "the first value of the counter");
  ExprPtr& bound = statement.values[1];
  if (!typed(bound, Type::Int, "the bound of the loop") || !first) return 1;
  if (!scratch_) scratch_.emplace();
  const Constant constant = evaluateConstant(*scratch_, *bound);
  statement.open = !constant;
  ir::Interval last = constant ? ir::Interval{(*constant)[0], (*constant)[0]} : boundOf(*bound);
  if (!(last.hi < 0x1p31)) {
    reporter_.error("unbounded-loop", bound->span, "how far this loop may run is not known",
                    "a constant, a parameter or a result with a range, what is made of these by + - *, or "
                    "`min(..., 16)`");
    return 1;
  }
  const double inclusive = statement.inclusive ? 1 : 0;
  const double count = last.hi - *first + inclusive;
  statement.surely = last.lo - *first + inclusive >= 1;
  statement.first = *first;
  statement.last = static_cast<int>(*first + std::clamp<double>(count, 0, kMostTrips));
  if (count >= 1) return static_cast<uint64_t>(std::min<double>(count, kMostTrips + 1));
  reporter_.error("empty-loop", bound->span, "the loop never runs",
                  constant
                      ? "the bound lies above the start"
                      : fmt::format("the bound is no constant, and by the ranges of what it is made of it is "
                                    "{} at most: it must lie above the start",
                                    last.hi));
  return 1;
}

Checker::Flow Checker::loop(Statement& statement) {
  const uint64_t count = rounds(statement);
  const uint64_t outer = trips_;
  trips_ *= count;
  if (trips_ > kMostTrips) {
    reporter_.error("loop-too-long", statement.values[1]->span,
                    fmt::format("this loop runs more than {} times, enclosing loops counted", kMostTrips),
                    statement.open ? "a smaller range of what it runs up to, or `min(..., 16)`"
                                   : "fewer rounds, or several nodes");
    trips_ = outer;
  }
  const size_t scope = names_.size();
  statement.slot = slotCount();
  slots_.push_back(statement.name);
  declare(
      {statement.name, Name::Kind::Counter, Type::Int, statement.slot, statement.name_span, true, false, {}});
  bounds_.resize(slotCount());
  bounds_.back() = {static_cast<double>(statement.first), static_cast<double>(statement.last) - 1};
  const Ties before = std::exchange(unties_, Ties{0});
  const uint64_t weight = weight_;
  const Flow flow = block(statement.body);
  statement.weight = static_cast<uint32_t>(std::min<uint64_t>((weight_ - weight) / trips_, kMostWeight));
  statement.direct = flow != Flow::Falls || unties_ != 0;
  if (statement.open && flow != Flow::Falls) {
    reporter_.error("return-in-loop", statement.span, "a loop whose length is not a constant cannot return",
                    "keep what was found in a local, and return it behind the loop");
  }
  if (statement.open && unties_ != 0) {
    reporter_.error("tied-loop", statement.values[1]->span,
                    fmt::format("the length of a loop in which there is {} must be a constant",
                                (unties_ & kLight) != 0 ? "sum_over_lights()" : "interpolate()"),
                    "it is written out, round by round");
  }
  unties_ |= before;
  leave(scope);
  trips_ = outer;
  std::set<uint32_t> assigned;
  eachAssignment(statement.body, [&](const Statement& s) {
    if (s.slot < statement.slot) assigned.insert(s.slot);
  });
  statement.assigned.assign(assigned.begin(), assigned.end());
  return flow;
}

void Checker::returns(Statement& statement) {
  const std::vector<Param>& results = node_->results;
  std::vector<ExprPtr>& values = statement.values;
  const std::string all =
      results.size() == 1 ? std::string(typeName(results[0].type)) : fmt::format("{} values", results.size());
  if (values.size() == 1 && results.size() > 1) {
    // All of them at once, from a call with the same results.
    if (!expression(values[0])) return;
    const Expr& value = *values[0];
    const auto same = [](const Param& a, const Param& b) { return a.type == b.type; };
    if (value.kind == Expr::Kind::Call &&
        std::equal(results.begin(), results.end(), value.node->results.begin(), value.node->results.end(),
                   same)) {
      return;
    }
    reporter_.error("wrong-count", value.span,
                    fmt::format("'{}' gives {}, and this is one", node_->name, all),
                    "return them in parentheses: `return (a, b);`");
    return;
  }
  if (values.size() != results.size()) {
    reporter_.error("wrong-count", statement.span,
                    fmt::format("'{}' gives {}, not {} values", node_->name,
                                results.size() == 1 ? "one value" : all, values.size()));
    for (ExprPtr& value : values) expression(value);
    return;
  }
  for (size_t i = 0; i < values.size(); ++i) {
    const std::string what =
        results[i].name.empty() ? "the result" : fmt::format("the result '{}'", results[i].name);
    typed(values[i], results[i].type, what);
  }
}

void Checker::assume(Statement& statement) {
  bool good = expression(statement.values[0]);
  if (good) makeFloat(*statement.values[0]);
  good = good && fits(*statement.values[0], statement.values[0]->type, "what is assumed about");
  const auto range = interval(statement.range_syntax, Type::Float);
  if (arms_ > 0 || may_have_returned_) {
    reporter_.error("conditional-assume", statement.span,
                    "an assumption holds always, and this stands under a condition",
                    "put it before the 'if'");
    return;
  }
  if (!good || !range) return;
  const Expr& value = *statement.values[0];
  if (!ir::isFloating(value.type)) {
    reporter_.error("wrong-type", value.span, fmt::format("{} has no range", aType(value.type)),
                    "assume something about a float or a vector");
    return;
  }
  statement.range = *range;
  node_->assumptions.push_back(
      {variant_, written(value.span), *range, statement.reason, reporter_.lineOf(statement.span)});
}

}  // namespace lacquer::lang
