#include "stress/called.h"

#include <set>
#include <string>

namespace lacquer::stress {

namespace {

using Called = std::set<const lang::NodeDecl*>;

void callsOf(const lang::NodeDecl& node, Called& to);

void callsOf(const lang::ExprPtr& expr, Called& to) {
  if (!expr) return;
  if (expr->node != nullptr && to.insert(expr->node).second) callsOf(*expr->node, to);
  for (const lang::ExprPtr& arg : expr->args) callsOf(arg, to);
}

void callsOf(const std::vector<lang::Statement>& statements, Called& to) {
  for (const lang::Statement& statement : statements) {
    for (const lang::ExprPtr& value : statement.values) callsOf(value, to);
    callsOf(statement.body, to);
    callsOf(statement.otherwise, to);
  }
}

void callsOf(const lang::NodeDecl& node, Called& to) {
  callsOf(node.body.statements, to);
  for (const lang::Variant& variant : node.variants) callsOf(variant.body.statements, to);
}

void addName(std::string& names, std::string_view name) {
  names += names.empty() ? "" : " ";
  names += name;
}

}  // namespace

NodesByPlace::NodesByPlace(const lang::Library& library) {
  for (const std::string_view name : library.names(lang::DeclKind::Node)) {
    const Result<const lang::NodeDecl*> node = library.node(name);
    if (node) nodes_[{(*node)->origin.file, (*node)->origin.line}].push_back(*node);
  }
}

void NodesByPlace::nameTerms(Subject& subject) const {
  for (const ir::Term& term : subject.module().dag.terms()) {
    const auto found = nodes_.find({term.file, term.line});
    if (found == nodes_.end()) continue;
    Called called;
    Subject::OfTerm& of = subject.terms[term.name];
    for (const lang::NodeDecl* node : found->second) {
      addName(of.own, node->name);
      callsOf(*node, called);
    }
    std::set<std::string_view> names;
    for (const lang::NodeDecl* node : called) names.insert(node->name);
    for (const std::string_view name : names) addName(of.called, name);
  }
}

}  // namespace lacquer::stress
