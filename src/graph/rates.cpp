#include "graph/rates.h"

#include <algorithm>

#include "lang/builtins.h"

namespace lacquer::graph {

namespace {

using lang::Expr;

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
    for (const lang::ExprPtr& arg : expr->args) open.push_back({arg.get(), untied});
  }
  return ties;
}

}  // namespace

TemplateRates templateRates(const lang::TemplateDecl& decl) {
  const bool vertex_stage = std::any_of(decl.outputs.begin(), decl.outputs.end(), [](const auto& output) {
    return output.role == lang::OutputRole::Position;
  });
  Slots slots{std::vector<Ties>(decl.slots), std::vector<bool>(decl.slots), std::vector<Ties>(decl.slots)};
  for (const lang::BlockDecl& block : decl.blocks) {
    const Ties ties = block.role == lang::BlockRole::Lights                   ? kLight
                      : block.role == lang::BlockRole::Object && vertex_stage ? kVertex
                                                                              : Ties{0};
    for (const lang::BlockFieldDecl& field : block.fields) slots.ties[field.slot] = ties;
  }
  // Without a vertex stage the attributes come to the fragment as they are.
  for (const lang::AttributeDecl& attribute : decl.attributes)
    slots.ties[attribute.slot] = vertex_stage ? kVertex : 0;
  TemplateRates rates;
  for (const lang::GivenDecl& given : decl.givens) {
    const Ties ties = given.value ? tiesOf(*given.value, slots, 0) : Ties{0};
    for (size_t i = 0; i < given.results.size(); ++i) {
      slots.ties[given.slot + i] = ties;
      std::string name(given.name);
      if (given.multiple) name += "." + std::string(given.results[i].name);
      rates.givens[name] = ties;
    }
  }
  for (const lang::PortDecl& port : decl.ports) slots.port[port.slot] = true;
  for (const lang::OutputDecl& output : decl.outputs) {
    if (output.role != lang::OutputRole::Position && output.value) {
      tiesOf(*output.value, slots, kLight | kVertex);
    }
  }
  // A port's default may use the ports before it, in its place.
  for (size_t i = decl.ports.size(); i > 0; --i) {
    const lang::PortDecl& port = decl.ports[i - 1];
    if (port.default_value) tiesOf(*port.default_value, slots, slots.refused[port.slot]);
    rates.refused[port.param.name] = slots.refused[port.slot];
  }
  return rates;
}

}  // namespace lacquer::graph
