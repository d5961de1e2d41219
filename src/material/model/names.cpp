#include "model/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace lacquer::model {

bool isSwizzle(std::string_view text) {
  if (text.empty() || text.size() > 4) return false;
  return text.find_first_not_of("xyzw") == std::string_view::npos ||
         text.find_first_not_of("rgba") == std::string_view::npos;
}

Names::Names(const lang::Library& library, const material::Schema& schema, Model& model)
    : library_(library), schema_(schema), model_(model) {
  // A template that is wrong says so when it is used; what the others give has names all the same.
  std::set<std::string> all;
  for (const std::string_view name : library.names(lang::DeclKind::Template)) {
    const Result<const lang::TemplateDecl*> decl = library.template_(name);
    if (!decl) continue;
    for (const lang::EnvironmentDecl& one : (*decl)->environments) all.emplace(one.name);
    for (const lang::GivenDecl& one : (*decl)->givens) {
      if (!one.multiple) all.emplace(one.name);
      for (const lang::Param& result : one.results) {
        if (one.multiple) all.insert(fmt::format("{}.{}", one.name, result.name));
      }
    }
  }
  for (const std::string& name : all) {
    givens_.emplace(name, static_cast<uint32_t>(model_.givens.size()));
    model_.givens.push_back(name);
  }
}

void Names::addRoles() {
  for (const auto& [name, providers] : schema_.roles) {
    roles_.emplace(name, static_cast<uint32_t>(model_.roles.size()));
    model_.roles.push_back({name, providers, {}, {}});
  }
}

void Names::addSwitches(Diagnostics& wrong) {
  for (const std::string_view name : library_.names(lang::DeclKind::Switch)) {
    const Result<const lang::SwitchDecl*> decl = library_.switch_(name);
    if (!decl) {
      wrong.insert(wrong.end(), decl.error().begin(), decl.error().end());
      continue;
    }
    switches_.emplace(name, static_cast<uint32_t>(model_.switches.size()));
    model_.switches.push_back(name);
    model_.switch_defaults.push_back((*decl)->value);
  }
}

void Names::addId(std::string_view name) {
  const auto [it, fresh] = ids_.emplace(name, static_cast<uint32_t>(model_.ids.size()));
  if (fresh) model_.ids.push_back({name, {}, {}});
}

uint32_t Names::makeId(const std::string& name) {
  std::string free = name;
  for (int i = 2; ids_.contains(free) || made_.contains(free); ++i) free = fmt::format("{}_{}", name, i);
  model_.made_names.push_back(std::make_shared<const std::string>(std::move(free)));
  made_.insert(*model_.made_names.back());
  model_.ids.push_back({*model_.made_names.back(), {}, {}});
  return static_cast<uint32_t>(model_.ids.size() - 1);
}

std::optional<uint32_t> Names::findOut(std::string_view name) const {
  const auto it = outs_.find(name);
  return it == outs_.end() ? std::nullopt : std::optional(it->second);
}

std::vector<std::string_view> Names::outs() const {
  std::vector<std::string_view> names;
  for (const auto& [name, index] : outs_) names.push_back(name);
  return names;
}

void Names::addOut(std::string_view name) {
  const auto [it, fresh] = outs_.emplace(name, static_cast<uint32_t>(model_.outs.size()));
  if (fresh) model_.outs.push_back({name, {}});
}

bool Names::hasGiven(std::string_view name) const {
  return std::any_of(givens_.begin(), givens_.end(), [&](const auto& given) {
    return std::string_view(given.first).substr(0, given.first.find('.')) == name;
  });
}

std::optional<uint32_t> Names::section(std::string_view name) const {
  if (name.empty()) return 0;
  const auto it = std::find(sections_.begin(), sections_.end(), name);
  if (it == sections_.end()) return std::nullopt;
  return static_cast<uint32_t>(it - sections_.begin());
}

std::string_view Names::textOf(std::string_view text, lang::Span span) {
  std::string_view name = text.substr(span.offset, span.length);
  while (!name.empty() && (name.back() == ' ' || name.back() == '\n')) name.remove_suffix(1);
  return name;
}

const lang::PropertyDecl& Names::declOf(uint32_t role) const {
  return *schema_.properties[model_.roles[role].providers[0]].decl;
}

const lang::PropertyDecl* Names::choice(const Value& value) const {
  if (value.kind != Value::Kind::Role) return nullptr;
  const lang::PropertyDecl& decl = declOf(value.index);
  return decl.kind == lang::PropertyDecl::Kind::Choice ? &decl : nullptr;
}

bool Names::role(std::string_view text, Value& out) const {
  const std::string_view head = text.substr(0, text.find('.'));
  const auto it = roles_.find(head);
  if (it == roles_.end()) return false;
  out.kind = Value::Kind::Role;
  out.index = it->second;
  if (head.size() == text.size()) return true;
  const std::string_view rest = text.substr(head.size() + 1);
  const lang::PropertyDecl& decl = declOf(it->second);
  if (decl.kind == lang::PropertyDecl::Kind::Texture) {
    if (rest == "uv") return out.coordinate = true;
    for (size_t i = 0; i < decl.members.size(); ++i) {
      if (decl.members[i].name != rest) continue;
      out.member = static_cast<int>(i);
      return true;
    }
  }
  out.path = rest;
  return isSwizzle(rest);
}

bool Names::given(std::string_view text, Value& out) const {
  for (size_t end = text.size(); end != std::string_view::npos && end > 0; end = text.rfind('.', end - 1)) {
    const auto it = givens_.find(text.substr(0, end));
    if (it == givens_.end()) continue;
    out.kind = Value::Kind::Given;
    out.index = it->second;
    out.path = end == text.size() ? std::string_view{} : text.substr(end + 1);
    return out.path.empty() || isSwizzle(out.path);
  }
  return false;
}

bool Names::resolve(std::string_view text, Value& out, std::vector<std::string_view>& candidates) const {
  constexpr std::string_view kBelow = "below.";
  if (text.starts_with(kBelow)) {
    const std::string_view rest = text.substr(kBelow.size());
    const auto it = outs_.find(rest.substr(0, rest.find('.')));
    if (it != outs_.end()) {
      out.kind = Value::Kind::Below;
      out.index = it->second;
      out.path = rest.size() == it->first.size() ? std::string_view{} : rest.substr(it->first.size() + 1);
      return true;
    }
  }
  for (size_t end = text.size(); end != std::string_view::npos && end > 0; end = text.rfind('.', end - 1)) {
    const auto it = ids_.find(text.substr(0, end));
    if (it == ids_.end()) continue;
    out.kind = Value::Kind::Id;
    out.index = it->second;
    out.path = end == text.size() ? std::string_view{} : text.substr(end + 1);
    return true;
  }
  if (role(text, out) || given(text, out)) return true;
  out = {};
  for (const auto& [name, index] : ids_) candidates.push_back(name);
  for (const auto& [name, index] : roles_) candidates.push_back(name);
  for (const auto& [name, index] : givens_) candidates.push_back(name);
  return false;
}

bool Names::condition(std::string_view text, Condition& out) const {
  const auto as = [&](Condition::Kind kind, uint32_t index) {
    out.kind = kind;
    out.index = index;
    return true;
  };
  if (const auto it = ids_.find(text); it != ids_.end())
    return flags_.contains(text) && as(Condition::Kind::Flag, it->second);
  if (const auto it = terms_.find(text); it != terms_.end()) return as(Condition::Kind::Term, it->second);
  if (const auto it = switches_.find(text); it != switches_.end())
    return as(Condition::Kind::Switch, it->second);
  if (const std::optional<uint16_t> extension = schema_.find(text); extension && *extension != 0)
    return as(Condition::Kind::Extension, *extension);
  return false;
}

}  // namespace lacquer::model
