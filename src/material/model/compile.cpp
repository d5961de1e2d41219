#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "lang/checker.h"
#include "lang/forms.h"
#include "lang/parser.h"
#include "lang/reporter.h"
#include "lang/suggest.h"
#include "model/check.h"
#include "model/connect.h"
#include "model/model.h"
#include "model/names.h"
#include "model/order.h"

namespace lacquer::model {

using lang::Expr;
using lang::ExprPtr;
using lang::LineDecl;
using lang::Span;
namespace {

/// Turns the declarations of one library into a Model.
class Compiler {
public:
  Compiler(const lang::Library& library, const material::Schema& schema)
      : library_(library), names_(library, schema, model_) {
    model_.library = &library;
    model_.schema = &schema;
  }
  Result<Model> run(std::string_view profile, const std::set<std::string, std::less<>>& lods);

private:
  void collectParts();
  void declare(const std::vector<LineDecl>& lines, bool overlay);
  void enter(uint32_t part);
  void enter(const lang::ProfileDecl& overlay);
  void findOverridden();
  void part(uint32_t index);
  void nameTerms(uint32_t index);
  void lines(uint32_t part, uint32_t first_term);
  void overridden(uint32_t id, const LineDecl& own, const LineDecl& other);
  void addedLines(const lang::ProfileDecl& overlay);
  Line line(const LineDecl& decl, uint32_t part, uint32_t term);
  void carry(Line& line, const LineDecl& decl);
  void place(Line line, const LineDecl& decl);
  Condition condition(const ExprPtr& expr);
  Condition operation(const Expr& expr);
  Condition comparison(const Expr& expr);
  Condition named(const Expr& expr);
  bool question(const Expr& expr, Condition& out);
  Value operand(const ExprPtr& expr);
  Value value(const ExprPtr& expr);
  Value call(const Expr& expr);
  void argument(Value& call, const Expr& expr, size_t at);
  bool constant(const Expr& expr, Value& out);
  Value reference(const Expr& expr);
  bool comparable(const Value& left, const Value& right, const Expr& expr);
  void checkNames();
  void checkWriterNames();
  void checkLines();

  void error(Span span, std::string code, std::string message, std::string help = {});
  void error(const Text& source, Span span, std::string code, std::string message, std::string help = {});

  const lang::Library& library_;
  Model model_;
  Names names_;
  Text source_;
  Diagnostics wrong_;
  Uses uses_;
  std::vector<const lang::PartDecl*> decls_;        ///< of the parts
  std::map<std::string_view, uint32_t> nodes_;      ///< the model's, by name
  std::vector<const lang::ProfileDecl*> overlays_;  ///< the lods, then the profile: the first has its say
  std::vector<std::map<uint32_t, const LineDecl*>> overriding_;  ///< their lines, by id
  std::set<const LineDecl*> placed_;                             ///< those that stand in place of others
  std::string_view overlay_;                                     ///< the one whose added lines are placed
};

void Compiler::error(const Text& source, Span span, std::string code, std::string message, std::string help) {
  lang::Reporter reporter(source.file, source.text);
  reporter.error(code, span, std::move(message), std::move(help));
  Diagnostics one = reporter.take();
  wrong_.insert(wrong_.end(), one.begin(), one.end());
}

void Compiler::error(Span span, std::string code, std::string message, std::string help) {
  error(source_, span, std::move(code), std::move(message), std::move(help));
}

// -- what there is --

void Compiler::collectParts() {
  std::vector<const lang::PartDecl*> parts;
  const std::vector<std::string_view> orders = library_.names(lang::DeclKind::Layers);
  for (const std::string_view name : orders) {
    const Result<const lang::LayersDecl*> layers = library_.layers(name);
    if (!layers) {
      wrong_.insert(wrong_.end(), layers.error().begin(), layers.error().end());
      continue;
    }
    source_ = {(*layers)->origin.file, (*layers)->text};
    if (orders.size() > 1) {
      error((*layers)->span, "duplicate-name", "there is another order of layers",
            "a part of your own says `over PART` instead");
    }
    names_.sections((*layers)->sections);
    for (size_t i = 0; i < (*layers)->parts.size(); ++i) {
      const Result<const lang::PartDecl*> part = library_.part((*layers)->parts[i]);
      if (part) {
        parts.push_back(*part);
      } else if (!library_.has(lang::DeclKind::Part, (*layers)->parts[i])) {
        error((*layers)->spans[i], "unknown-part", fmt::format("there is no part '{}'", (*layers)->parts[i]),
              lang::didYouMean((*layers)->parts[i], library_.names(lang::DeclKind::Part)));
      } else {
        wrong_.insert(wrong_.end(), part.error().begin(), part.error().end());
      }
    }
  }
  for (const lang::PartDecl* decl : withInserted(library_, std::move(parts), wrong_)) {
    Part part;
    part.name = decl->name;
    part.origin = decl->origin;
    source_ = {decl->origin.file, decl->text};
    for (const std::string_view name : decl->of) {
      if (const std::optional<uint16_t> extension = model_.schema->find(name)) {
        part.of.push_back(*extension);
      } else {
        error(decl->span, "unknown-extension", fmt::format("there is no extension '{}'", name),
              "declare it: `extension NAME { ... }`");
      }
    }
    model_.parts.push_back(std::move(part));
    decls_.push_back(decl);
  }
  // The names that all share come first, so that a vendor's text is wrong where it takes one.
  for (const bool vendors : {false, true}) {
    for (uint32_t i = 0; i < decls_.size(); ++i) {
      enter(i);
      if (vendors != names_.vendor().empty()) declare(decls_[i]->lines, false);
    }
  }
}

/// What is resolved from now on stands in the text of a part.
void Compiler::enter(uint32_t part) {
  source_ = {decls_[part]->origin.file, decls_[part]->text};
  std::vector<std::string_view> vendors;
  const auto add = [&](std::string_view vendor) {
    if (!vendor.empty() && std::find(vendors.begin(), vendors.end(), vendor) == vendors.end())
      vendors.push_back(vendor);
  };
  add(decls_[part]->origin.vendor);
  for (const uint16_t extension : model_.parts[part].of)
    add(model_.schema->extensions[extension]->origin.vendor);
  names_.setVendors(std::move(vendors));
}

void Compiler::enter(const lang::ProfileDecl& overlay) {
  source_ = {overlay.origin.file, overlay.text};
  std::vector<std::string_view> vendors;
  if (!overlay.origin.vendor.empty()) vendors.push_back(overlay.origin.vendor);
  names_.setVendors(std::move(vendors));
}

void Compiler::declare(const std::vector<LineDecl>& lines, bool overlay) {
  for (const LineDecl& line : lines) {
    const bool value = line.kind == LineDecl::Kind::Value || line.kind == LineDecl::Kind::Flag;
    // A profile's line stands in place of that line, whosever it is.
    if (value && (!overlay || !names_.findId(line.id))) names_.addId(line.id);
    if (line.kind == LineDecl::Kind::Flag) names_.addFlag(line.id);
    if (line.kind == LineDecl::Kind::Out) names_.addOut(line.id);
  }
}

// -- lines --

void Compiler::findOverridden() {
  for (const lang::ProfileDecl* overlay : overlays_) {
    enter(*overlay);
    std::map<uint32_t, const LineDecl*>& lines = overriding_.emplace_back();
    for (const LineDecl& line : overlay->lines) {
      const bool value = line.kind == LineDecl::Kind::Value || line.kind == LineDecl::Kind::Flag;
      if (value) lines.emplace(names_.id(line.id), &line);
    }
  }
}

Line Compiler::line(const LineDecl& decl, uint32_t part, uint32_t term) {
  Line line;
  line.kind = decl.kind;
  line.shared = decl.shared;
  line.part = part;
  line.term = term;
  line.code = decl.code;
  line.message = decl.message;
  line.help = decl.help;
  line.reason = decl.reason;
  if (decl.place) line.place = operand(decl.place);
  if (decl.kind == LineDecl::Kind::Replace) {
    const size_t before = wrong_.size();
    line.target = value(decl.target);
    if (line.target.kind != Value::Kind::Id && wrong_.size() == before)
      error(decl.target->span, "wrong-line", "only another line's value can be replaced");
  }
  if (decl.kind == LineDecl::Kind::Out) line.id = names_.out(decl.id);
  if (decl.kind == LineDecl::Kind::Replace && line.target.kind == Value::Kind::Id)
    uses_.ids.insert(line.target.index);
  if (decl.kind == LineDecl::Kind::Value || decl.kind == LineDecl::Kind::Flag) line.id = names_.id(decl.id);
  for (const lang::Alternative& alternative : decl.alternatives) {
    Alternative one;
    if (decl.kind == LineDecl::Kind::Flag) {
      one.condition = condition(alternative.value);
    } else {
      const bool asked = decl.kind == LineDecl::Kind::Require;
      one.value = asked ? operand(alternative.value) : value(alternative.value);
      if (alternative.condition) one.condition = condition(alternative.condition);
      one.unless = alternative.unless;
    }
    line.alternatives.push_back(std::move(one));
  }
  return line;
}

/// A node behind `out` or `replace` has a line of its own, with a name that no text says: "coat.direct" of
/// the part coat, `out direct = ...`.
void Compiler::carry(Line& line, const LineDecl& decl) {
  const bool out = line.kind == LineDecl::Kind::Out;
  const bool calls = std::any_of(line.alternatives.begin(), line.alternatives.end(),
                                 [](const Alternative& one) { return one.value.kind == Value::Kind::Call; });
  if (!calls || (!out && line.kind != LineDecl::Kind::Replace)) return;
  const bool of_part = line.part < model_.parts.size();
  const std::string_view owner = of_part ? model_.parts[line.part].name : overlay_;
  const std::string_view what = out ? decl.id : names_.textOf(source_.text, decl.target->span);
  Line own = line;
  own.kind = LineDecl::Kind::Value;
  own.id = names_.makeId(fmt::format("{}.{}", owner, what));
  own.target = {};
  uses_.ids.insert(own.id);
  Value carried;
  carried.kind = Value::Kind::Id;
  carried.index = own.id;
  line.alternatives.clear();
  line.alternatives.emplace_back();
  line.alternatives[0].value = std::move(carried);
  line.carried = true;
  place(std::move(own), decl);
}

void Compiler::place(Line line, const LineDecl& decl) {
  carry(line, decl);
  const auto index = static_cast<uint32_t>(model_.lines.size());
  model_.lines.push_back(std::move(line));
  uses_.lines.push_back({index, &decl, source_});
}

void Compiler::part(uint32_t index) {
  const lang::PartDecl& decl = *decls_[index];
  const auto first = static_cast<uint32_t>(model_.terms.size());
  model_.parts[index].term = first;
  for (const lang::TermDecl& term : decl.terms) {
    Term made;
    made.name = term.name;
    made.part = index;
    made.parent = &term == decl.terms.data() ? Line::kNone : first + term.parent;
    made.when_reason = term.when_reason;
    made.unless_reason = term.unless_reason;
    made.has_unless = term.unless != nullptr;
    model_.terms.push_back(std::move(made));
  }
}

void Compiler::nameTerms(uint32_t index) {
  const std::vector<lang::TermDecl>& terms = decls_[index]->terms;
  for (size_t i = 0; i < terms.size(); ++i) {
    if (names_.addTerm(terms[i].name, model_.parts[index].term + static_cast<uint32_t>(i))) continue;
    error(terms[i].span, "duplicate-name",
          fmt::format("there is a term or a part '{}' already", terms[i].name), "give this one another name");
  }
}

void Compiler::lines(uint32_t part, uint32_t first_term) {
  const lang::PartDecl& decl = *decls_[part];
  enter(part);
  for (size_t i = 0; i < decl.terms.size(); ++i) {
    Term& term = model_.terms[first_term + i];
    if (decl.terms[i].when) term.when = condition(decl.terms[i].when);
    if (decl.terms[i].unless) term.unless = condition(decl.terms[i].unless);
  }
  for (size_t i = 0; i < decl.lines.size(); ++i) {
    const LineDecl& own = decl.lines[i];
    const bool value = own.kind == LineDecl::Kind::Value || own.kind == LineDecl::Kind::Flag;
    const std::optional<uint32_t> section = names_.section(own.section);
    if (!section) {
      error(own.span, "unknown-section", fmt::format("there is no section '{}'", own.section),
            "the layers say which sections there are");
    }
    constexpr uint32_t kLinesOfPart = 1024, kParts = 1024;
    const uint32_t order = (section.value_or(0) * kParts + std::min(part, kParts - 1)) * kLinesOfPart +
                           static_cast<uint32_t>(std::min<size_t>(i, kLinesOfPart - 1));
    const auto put = [&](const LineDecl& line_decl) {
      Line made = line(line_decl, part, first_term + own.term);
      made.order = made.shared ? Line::kNone : order;
      place(std::move(made), line_decl);
    };
    if (own.light) model_.ids[names_.id(own.id)].light = true;
    bool replaced = false;
    for (size_t k = 0; value && !replaced && k < overlays_.size(); ++k) {
      const auto found = overriding_[k].find(names_.id(own.id));
      if (found == overriding_[k].end()) continue;
      const LineDecl* other = found->second;
      // Where a lod's line comes to nothing, the one in whose place it stands holds.
      replaced = k + 1 == overlays_.size();
      if (!placed_.insert(other).second) continue;
      const uint32_t id = found->first;
      enter(*overlays_[k]);
      overridden(id, own, *other);
      uses_.overlays.insert(static_cast<uint32_t>(model_.lines.size()));
      put(*other);
      enter(part);
    }
    if (!replaced) put(own);
  }
}

/// `other`, of a profile or a lod, stands in place of a part's line.
void Compiler::overridden(uint32_t id, const LineDecl& own, const LineDecl& other) {
  model_.ids[id].overridden = true;
  if (own.kind == other.kind) return;
  const bool flag = own.kind == LineDecl::Kind::Flag;
  error(other.span, "wrong-type", fmt::format("'{}' is {}", own.id, flag ? "a bool" : "a value, no bool"),
        flag ? fmt::format("write `bool {} = ...;`", own.id) : fmt::format("write `{} = ...;`", own.id));
}

/// What a profile or a lod adds beside the lines that it replaces stands outside of all parts.
void Compiler::addedLines(const lang::ProfileDecl& overlay) {
  overlay_ = overlay.name;
  enter(overlay);
  for (const LineDecl& decl : overlay.lines) {
    if (placed_.contains(&decl)) continue;
    if (decl.kind == LineDecl::Kind::Require) {
      error(decl.span, "wrong-line", "profiles and lods have no terms that could require something");
      continue;
    }
    Line made = line(decl, static_cast<uint32_t>(model_.parts.size()), Line::kNone);
    made.order = Line::kNone;
    if (decl.light) model_.ids[made.id].light = true;
    uses_.adds.insert(static_cast<uint32_t>(model_.lines.size()));
    place(std::move(made), decl);
  }
}

// -- values --

bool Compiler::constant(const Expr& expr, Value& out) {
  out.kind = Value::Kind::Constant;
  if (expr.kind == Expr::Kind::Literal) {
    out.type = expr.type == ir::Type::Bool ? ir::Type::Bool : ir::Type::Float;
    out.constant[0] = expr.number;
    return true;
  }
  if (expr.kind == Expr::Kind::Operation && expr.name == "-" && expr.args.size() == 1) {
    if (!constant(*expr.args[0], out)) return false;
    for (double& x : out.constant) x = -x;
    return true;
  }
  if (expr.kind == Expr::Kind::Name && library_.has(lang::DeclKind::Const, expr.name, names_.vendor())) {
    const Result<const lang::ConstDecl*> decl = library_.constant(expr.name, names_.vendor());
    if (!decl) return false;
    out.type = (*decl)->type;
    out.constant = (*decl)->value;
    return true;
  }
  if (expr.kind != Expr::Kind::Construct || !ir::isFloating(expr.type)) return false;
  out.type = expr.type;
  size_t filled = 0;
  const auto wanted = static_cast<size_t>(ir::componentCount(expr.type));
  for (const ExprPtr& arg : expr.args) {
    Value one;
    if (!constant(*arg, one) || filled >= wanted) return false;
    for (int i = 0; i < ir::componentCount(one.type) && filled < wanted; ++i)
      out.constant[filled++] = one.constant[static_cast<size_t>(i)];
  }
  for (; filled == 1 && wanted > 1;) {
    std::fill(out.constant.begin() + 1, out.constant.begin() + static_cast<ptrdiff_t>(wanted),
              out.constant[0]);
    filled = wanted;
  }
  return filled == wanted;
}

Value Compiler::value(const ExprPtr& expr) {
  if (expr->kind == Expr::Kind::Name && expr->name == "none") return {};
  if (expr->kind == Expr::Kind::Call) return call(*expr);
  Value number;
  if (constant(*expr, number)) return number;
  if (expr->kind == Expr::Kind::Name || expr->kind == Expr::Kind::Member) return reference(*expr);
  error(expr->span, "wrong-line", "a line is one node, a name or a number",
        "put the calculation into a node, or into a line of its own");
  return {};
}

Value Compiler::reference(const Expr& expr) {
  const std::string_view text = names_.textOf(source_.text, expr.span);
  Value out;
  if (std::vector<std::string_view> candidates; !names_.resolve(text, out, candidates)) {
    const std::vector<std::string> members = names_.membersOf(text);
    candidates.insert(candidates.end(), members.begin(), members.end());
    error(expr.span, "unknown-name", fmt::format("there is no line, property or given '{}'", text),
          lang::didYouMean(text, candidates));
    return {};
  }
  if (out.kind == Value::Kind::Id) uses_.ids.insert(out.index);
  if (out.kind == Value::Kind::Below) uses_.outs.insert(out.index);
  if (out.kind == Value::Kind::Id && !out.path.empty())
    uses_.paths.push_back({out.index, out.path, source_, expr.span});
  return out;
}

Value Compiler::call(const Expr& expr) {
  Value out;
  out.kind = Value::Kind::Call;
  const std::string name = lang::formName(expr.name, expr.form);
  const Result<const lang::NodeDecl*> node =
      expr.variant.empty() ? library_.signature(name, names_.vendor()) : library_.node(name, names_.vendor());
  if (!node) {
    if (library_.has(lang::DeclKind::Node, name, names_.vendor())) {
      wrong_.insert(wrong_.end(), node.error().begin(), node.error().end());
    } else {
      error(expr.span, "unknown-node", fmt::format("there is no node '{}'", name),
            lang::didYouMean(name, library_.names(lang::DeclKind::Node)));
    }
    return {};
  }
  const auto [known, fresh] = nodes_.try_emplace((*node)->name, static_cast<uint32_t>(model_.nodes.size()));
  if (fresh) model_.nodes.emplace_back((*node)->name, *node);
  out.index = known->second;
  out.variant = expr.variant;
  if (!expr.variant.empty() && (*node)->find(expr.variant) == nullptr) {
    error(expr.span, "unknown-variant", fmt::format("'{}' has no variant '{}'", expr.name, expr.variant));
  }
  Value absent;
  absent.absent = true;
  out.args.assign((*node)->params.size(), absent);
  for (size_t i = 0; i < expr.args.size(); ++i) argument(out, expr, i);
  for (size_t i = 0; i < out.args.size(); ++i) {
    const lang::Param& param = (*node)->params[i];
    if (!out.args[i].absent || param.hasDefault()) continue;
    error(expr.span, "wrong-count", fmt::format("'{}' needs '{}'", expr.name, param.name),
          "it has no default");
  }
  return out;
}

void Compiler::argument(Value& call, const Expr& expr, size_t at) {
  const std::vector<lang::Param>& params = model_.nodeOf(call).params;
  size_t index = at;
  if (!expr.labels[at].empty()) {
    const auto param = std::find_if(params.begin(), params.end(),
                                    [&](const lang::Param& p) { return p.name == expr.labels[at]; });
    index = static_cast<size_t>(param - params.begin());
    if (param == params.end()) {
      std::vector<std::string_view> candidates;
      for (const lang::Param& p : params) candidates.push_back(p.name);
      return error(expr.args[at]->span, "unknown-parameter",
                   fmt::format("'{}' has no parameter '{}'", expr.name, expr.labels[at]),
                   lang::didYouMean(expr.labels[at], candidates));
    }
  }
  if (index >= params.size()) {
    return error(expr.span, "wrong-count",
                 fmt::format("'{}' takes {} arguments, not {}", expr.name, params.size(), expr.args.size()));
  }
  if (!call.args[index].absent) {
    return error(expr.args[at]->span, "wrong-argument",
                 fmt::format("'{}' is given twice", params[index].name));
  }
  if (expr.args[at]->kind == Expr::Kind::Call) {
    return error(expr.args[at]->span, "wrong-line", "a line is one node", "give this one a line of its own");
  }
  call.args[index] = value(expr.args[at]);
  uses_.arguments.push_back({call.args[index], &params[index], source_, expr.args[at]->span});
}

// -- conditions --

/// What a condition or a requirement asks for: no node comes of it.
Value Compiler::operand(const ExprPtr& expr) {
  if (expr->kind != Expr::Kind::Call) return value(expr);
  error(expr->span, "wrong-line", "only a line can call a node",
        "give the call a line of its own, and ask for that one");
  return {};
}

/// `uniform(x)` and others that are written as calls.
bool Compiler::question(const Expr& expr, Condition& out) {
  const ExprPtr& asked = expr.args[0];
  if (expr.name == "uniform") {
    out.kind = Condition::Kind::Uniform;
    out.values.push_back(operand(asked));
    return true;
  }
  if (expr.name == "replaced") {
    out.kind = Condition::Kind::Replaced;
    out.values.push_back(operand(asked));
    if (out.values[0].kind != Value::Kind::Id)
      error(asked->span, "wrong-condition", "only a line's value can be replaced");
    return true;
  }
  const std::string_view port = names_.textOf(source_.text, asked->span);
  if (expr.name == "takes") {
    out.kind = Condition::Kind::Takes;
    out.name = port;
    uses_.ports.push_back({port, source_, asked->span});
    return true;
  }
  if (expr.name != "dimmable") return false;
  out.kind = Condition::Kind::Dimmable;
  if (const std::optional<uint32_t> found = names_.findOut(port)) {
    out.index = *found;
    model_.outs[*found].dimmed = true;
  } else {
    error(asked->span, "unknown-port", fmt::format("no part puts out '{}'", port),
          lang::didYouMean(port, names_.outs()));
  }
  return true;
}

Condition Compiler::condition(const ExprPtr& expr) {
  if (expr->kind == Expr::Kind::Operation) return operation(*expr);
  Condition out;
  if (expr->kind == Expr::Kind::Literal && expr->type == ir::Type::Bool) {
    if (expr->number != 0) return out;
    out.kind = Condition::Kind::Not;
    out.conditions.emplace_back();
    return out;
  }
  if (expr->kind == Expr::Kind::Call && expr->args.size() == 1 && question(*expr, out)) return out;
  if (expr->kind == Expr::Kind::Name || expr->kind == Expr::Kind::Member) return named(*expr);
  error(expr->span, "wrong-condition", "this is no condition",
        "conditions are names, comparisons, uniform(x), takes(port), replaced(line), dimmable(port), and "
        "'!', '&&', '||' of them");
  return out;
}

Condition Compiler::operation(const Expr& expr) {
  Condition out;
  const bool logic = expr.name == "&&" || expr.name == "||" || expr.name == "!";
  if (!logic) return comparison(expr);
  out.kind = expr.name == "!"    ? Condition::Kind::Not
             : expr.name == "&&" ? Condition::Kind::And
                                 : Condition::Kind::Or;
  for (const ExprPtr& arg : expr.args) out.conditions.push_back(condition(arg));
  return out;
}

/// Whether a value may be compared with a number, or a bool.
bool Compiler::comparable(const Value& left, const Value& right, const Expr& expr) {
  const auto wrong = [&](std::string message, std::string help = {}) {
    error(expr.span, "wrong-condition", std::move(message), std::move(help));
    return false;
  };
  if (left.kind == Value::Kind::None) return false;  // said already
  if (left.kind != Value::Kind::Role)
    return wrong("only a property of the material can be compared with a number");
  const lang::PropertyDecl* decl = model_.schema->properties[model_.roles[left.index].providers[0]].decl;
  if (decl->kind == material::Kind::Choice) return true;
  if (decl->kind == material::Kind::Texture) {
    if (left.member < 0)
      return wrong(fmt::format("'{}' is a texture", decl->name),
                   fmt::format("`!{}` asks whether there is none", decl->name));
    decl = &decl->members[static_cast<size_t>(left.member)];
  }
  if (!left.path.empty()) return wrong("the whole property is compared, no component of it");
  if (decl->type == right.type) return true;
  return wrong(fmt::format("'{}' is {}, it is compared with {}", decl->name, lang::aType(decl->type),
                           lang::aType(right.type)));
}

Condition Compiler::comparison(const Expr& expr) {
  Condition out;
  const bool unlike = expr.name == "!=";
  if (!unlike && expr.name != "==") {
    error(expr.span, "wrong-condition", fmt::format("'{}' is no comparison of a condition", expr.name),
          "write '==' or '!='");
    return out;
  }
  const Value left = operand(expr.args[0]);
  const lang::PropertyDecl* choice = names_.choice(left);
  Value right;
  if (choice != nullptr) {
    const std::string_view wanted = expr.args[1]->name;
    const auto found = std::find(choice->choices.begin(), choice->choices.end(), wanted);
    if (found == choice->choices.end()) {
      error(expr.args[1]->span, "unknown-value",
            fmt::format("'{}' is no value of '{}'", wanted, choice->name),
            lang::didYouMean(wanted, choice->choices));
    }
    right.kind = Value::Kind::Constant;
    right.constant[0] = static_cast<double>(found - choice->choices.begin());
    out.name = wanted;
  } else {
    right = operand(expr.args[1]);
  }
  if (right.kind == Value::Kind::Constant) {
    out.kind = Condition::Kind::Equal;
    out.constant = right.constant;
    if (right.type == ir::Type::Float) out.constant.fill(right.constant[0]);
    comparable(left, right, *expr.args[0]);
    out.values = {left};
  } else {
    out.kind = Condition::Kind::Same;
    out.values = {left, right};
  }
  if (!unlike) return out;
  Condition negated;
  negated.kind = Condition::Kind::Not;
  negated.conditions.push_back(std::move(out));
  return negated;
}

Condition Compiler::named(const Expr& expr) {
  const std::string_view text = names_.textOf(source_.text, expr.span);
  Condition out;
  if (names_.condition(text, out)) {
    if (out.kind == Condition::Kind::Flag) uses_.ids.insert(out.index);
    return out;
  }
  out.kind = Condition::Kind::Present;
  out.values.push_back(reference(expr));
  return out;
}

// -- what holds across lines --

/// A property's name is that of nothing else that a line could mean.
void Compiler::checkNames() {
  for (const Role& role : model_.roles) {
    const material::Property& property = model_.schema->properties[role.providers[0]];
    const lang::ExtensionDecl& extension = *model_.schema->extensions[property.extension];
    names_.setVendors({});
    if (!extension.origin.vendor.empty()) names_.setVendors({extension.origin.vendor});
    const std::string_view name = property.decl->role;
    const char* what = names_.hasGiven(name) ? "what templates give"
                       : names_.hasId(name)  ? "a line"
                                             : nullptr;
    if (what == nullptr) continue;
    error({extension.origin.file, extension.text}, property.decl->span, "duplicate-name",
          fmt::format("'{}' is the name of {}, too", name, what),
          fmt::format("parts can call it otherwise: `{} as NAME`", property.decl->name));
  }
}

/// Nodes of textures are named after their slots: no line has such a name.
void Compiler::checkWriterNames() {
  for (const material::Property& property : model_.schema->properties) {
    if (property.decl->kind != material::Kind::Texture) continue;
    for (const std::string_view what : {"uv", "texel", "channels", "decoded"}) {
      const std::string name = fmt::format("{}.{}", property.parameter_name, what);
      if (what == "decoded" && !property.decl->srgb) continue;
      const lang::ExtensionDecl& extension = *model_.schema->extensions[property.extension];
      names_.setVendors({});
      if (!extension.origin.vendor.empty()) names_.setVendors({extension.origin.vendor});
      if (!names_.hasId(name)) {
        names_.keepFree(name);
        continue;
      }
      error({extension.origin.file, extension.text}, property.decl->span, "duplicate-name",
            fmt::format("its node '{}' has the name of a line", name), "give the line another name");
    }
  }
}

/// What is made of a wrong line is wrong as well: of a text that has one, and of the library's own, no more
/// is said.
void Compiler::checkLines() {
  if (library_.isBuiltIn()) return;  // they were checked when the library was built
  std::set<std::string> files;
  for (const Diagnostic& one : wrong_) files.insert(one.place.file);
  for (const Part& part : model_.parts) {
    if (!wrong_.empty() && part.origin.built_in) files.insert(std::string(part.origin.file));
  }
  for (Diagnostic& one : check(library_, model_, uses_)) {
    if (!files.contains(one.place.file)) wrong_.push_back(std::move(one));
  }
}

Result<Model> Compiler::run(std::string_view profile, const std::set<std::string, std::less<>>& lods) {
  const Result<const lang::ProfileDecl*> found = library_.profile(profile);
  if (!found) return tl::make_unexpected(found.error());
  model_.profile = (*found)->name;
  model_.profile_origin = (*found)->origin;
  for (const std::string& name : lods) {
    const Result<const lang::ProfileDecl*> lod = library_.lod(name);
    if (!lod) return tl::make_unexpected(lod.error());
    overlays_.push_back(*lod);
  }
  overlays_.push_back(*found);
  names_.addRoles();
  names_.addSwitches(wrong_);
  collectParts();
  for (const lang::ProfileDecl* overlay : overlays_) {
    enter(*overlay);
    declare(overlay->lines, true);
  }
  findOverridden();
  for (uint32_t i = 0; i < model_.parts.size(); ++i) part(i);
  for (const bool vendors : {false, true}) {
    for (uint32_t i = 0; i < model_.parts.size(); ++i) {
      enter(i);
      if (vendors != names_.vendor().empty()) nameTerms(i);
    }
  }
  for (uint32_t i = 0; i < model_.parts.size(); ++i) lines(i, model_.parts[i].term);
  for (const lang::ProfileDecl* overlay : overlays_) addedLines(*overlay);
  connect(model_);
  checkNames();
  checkWriterNames();
  checkLines();
  if (!wrong_.empty()) return tl::make_unexpected(withWrongTemplates(library_, wrong_));
  model_.unordered = findUnordered(model_, library_);
  return std::move(model_);
}

}  // namespace

Result<Model> compile(const lang::Library& library, const material::Schema& schema, std::string_view profile,
                      const std::set<std::string, std::less<>>& lods) {
  return Compiler(library, schema).run(profile, lods);
}

}  // namespace lacquer::model
