#include "model/connect.h"

#include <algorithm>
#include <set>
#include <utility>

namespace lacquer::model {

namespace {

using LineKind = lang::LineDecl::Kind;

/// Calls `see(role, member)` for every property in a value or a condition.
template <class See>
void rolesOf(const Value& value, const See& see) {
  if (value.kind == Value::Kind::Role) see(value.index, value.member);
  for (const Value& arg : value.args) rolesOf(arg, see);
}

template <class See>
void rolesOf(const Condition& condition, const See& see) {
  for (const Value& value : condition.values) rolesOf(value, see);
  for (const Condition& inner : condition.conditions) rolesOf(inner, see);
}

void list(Model& model, uint32_t index) {
  const Line& line = model.lines[index];
  switch (line.kind) {
    case LineKind::Value:
    case LineKind::Flag: model.ids[line.id].lines.push_back(index); break;
    case LineKind::Out: model.outs[line.id].lines.push_back(index); break;
    case LineKind::Replace:
      if (line.target.kind == Value::Kind::Id) model.ids[line.target.index].replaced.push_back(index);
      break;
    case LineKind::Require:
      if (line.term != Line::kNone) model.terms[line.term].requirements.push_back(index);
      break;
  }
  for (uint32_t term = line.kind == LineKind::Value ? line.term : Line::kNone; term != Line::kNone;
       term = model.terms[term].parent)
    model.terms[term].valued = true;
}

/// A number stays editable for the terms whose `unless` asks for it, else for the terms that use it.
void findLive(Model& model) {
  std::set<std::pair<uint32_t, int>> asked;
  const auto add = [&](uint32_t role, int member, std::string_view term) {
    Role& to = model.roles[role];
    if (member >= static_cast<int>(to.member_live.size()))
      to.member_live.resize(static_cast<size_t>(member) + 1);
    auto& terms = member < 0 ? to.live : to.member_live[static_cast<size_t>(member)];
    if (std::find(terms.begin(), terms.end(), term) == terms.end()) terms.push_back(term);
  };
  for (const Term& term : model.terms) {
    rolesOf(term.unless, [&](uint32_t role, int member) {
      asked.emplace(role, member);
      add(role, member, term.name);
    });
  }
  for (const Line& line : model.lines) {
    if (line.term == Line::kNone) continue;
    const auto see = [&](uint32_t role, int member) {
      if (!asked.contains({role, member})) add(role, member, model.terms[line.term].name);
    };
    for (const Alternative& alternative : line.alternatives) rolesOf(alternative.value, see);
  }
}

void order(Model& model) {
  for (size_t i = 0; i < model.lines.size(); ++i) {
    const Line& line = model.lines[i];
    if (line.kind == LineKind::Value && line.order != Line::kNone)
      model.ordered.push_back(static_cast<uint32_t>(i));
  }
  std::stable_sort(model.ordered.begin(), model.ordered.end(),
                   [&](uint32_t a, uint32_t b) { return model.lines[a].order < model.lines[b].order; });
}

}  // namespace

void connect(Model& model) {
  for (uint32_t i = 0; i < model.lines.size(); ++i) list(model, i);
  findLive(model);
  order(model);
}

}  // namespace lacquer::model
