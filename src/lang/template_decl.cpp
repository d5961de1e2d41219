#include <fmt/format.h>

#include <algorithm>

#include "lang/ast.h"
#include "lang/builtins.h"
#include "lang/reporter.h"

namespace lacquer::lang {

namespace {

Ties untiedBy(const Expr& expr) {
  if (expr.kind == Expr::Kind::Call && expr.node != nullptr) return expr.node->unties;
  if (expr.kind != Expr::Kind::Operation || expr.builtin == nullptr) return 0;
  return lang::untiedBy(expr.builtin->op);
}

/// What a template's expressions see of its slots.
struct Slots {
  std::vector<Ties> ties;     ///< of the slot's value
  std::vector<bool> port;     ///< the slot is a port
  std::vector<Ties> refused;  ///< of a port: ties under which it is used without being untied
};

/// The ties of an expression. What is refused where the expression stands is refused to the ports in it.
Ties tiesOf(const Expr& root, Slots& slots, Ties refused) {
  struct Open {
    const Expr* expr;
    Ties untied;
  };
  Ties ties = 0;
  std::vector<Open> open = {{&root, 0}};
  while (!open.empty()) {
    const auto [expr, outer] = open.back();
    open.pop_back();
    if (expr == nullptr) continue;
    if (expr->kind == Expr::Kind::Slot && expr->slot < slots.ties.size()) {
      ties |= slots.ties[expr->slot] & static_cast<Ties>(~outer);
      if (slots.port[expr->slot]) slots.refused[expr->slot] |= refused & static_cast<Ties>(~outer);
    }
    const Ties untied = outer | untiedBy(*expr);
    for (const ExprPtr& arg : expr->args) open.push_back({arg.get(), untied});
  }
  return ties;
}

}  // namespace

void tie(TemplateDecl& decl, Reporter& reporter) {
  const bool vertex_stage = std::any_of(decl.outputs.begin(), decl.outputs.end(), [](const auto& output) {
    return output.role == OutputRole::Position;
  });
  Slots slots{std::vector<Ties>(decl.slots), std::vector<bool>(decl.slots), std::vector<Ties>(decl.slots)};
  for (const BlockDecl& block : decl.blocks) {
    const Ties ties = block.role == BlockRole::Lights                   ? kLight
                      : block.role == BlockRole::Object && vertex_stage ? kVertex
                                                                        : Ties{0};
    for (const BlockFieldDecl& field : block.fields)
      std::fill_n(slots.ties.begin() + field.slot, field.elements(), ties);
  }
  // Without a vertex stage the attributes come to the fragment as they are.
  for (const AttributeDecl& attribute : decl.attributes)
    slots.ties[attribute.slot] = vertex_stage ? kVertex : 0;
  for (GivenDecl& given : decl.givens) {
    given.ties = given.value ? tiesOf(*given.value, slots, 0) : Ties{0};
    for (size_t i = 0; i < given.results.size(); ++i) slots.ties[given.slot + i] = given.ties;
  }
  for (const PortDecl& port : decl.ports) slots.port[port.slot] = true;
  for (const OutputDecl& output : decl.outputs) {
    if (!output.value) continue;
    const bool vertex = output.role == OutputRole::Position;
    const Ties ties = tiesOf(*output.value, slots, vertex ? Ties{0} : Ties{kLight | kVertex});
    if ((ties & kLight) != 0) {
      reporter.error("one-light", output.span, fmt::format("'{}' is the value of one light", output.name),
                     "write sum_over_lights(...) around what differs from light to light");
    }
    if ((ties & kVertex) != 0 && !vertex) {
      reporter.error("one-vertex", output.span, fmt::format("'{}' is the value of one vertex", output.name),
                     "write interpolate(...) around what differs from vertex to vertex");
    }
  }
  // A port's default may use the ports before it, in its place.
  for (size_t i = decl.ports.size(); i > 0; --i) {
    PortDecl& port = decl.ports[i - 1];
    if (port.default_value) tiesOf(*port.default_value, slots, slots.refused[port.slot]);
    port.refused = slots.refused[port.slot];
  }
}

std::optional<GivenResult> TemplateDecl::find(std::string_view given) const {
  const size_t dot = given.find('.');
  const std::string_view head = given.substr(0, dot);
  for (const GivenDecl& decl : givens) {
    if (decl.name != head) continue;
    if (decl.multiple == (dot == std::string_view::npos)) return std::nullopt;
    if (!decl.multiple) return GivenResult{&decl, 0};
    for (size_t i = 0; i < decl.results.size(); ++i) {
      if (decl.results[i].name == given.substr(dot + 1)) return GivenResult{&decl, i};
    }
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace lacquer::lang
