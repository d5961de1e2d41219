#include "model/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace lacquer::model {

bool isSwizzle(std::string_view text) {
  if (text.empty() || text.size() > 4) return false;
  return text.find_first_not_of("xyzw") == std::string_view::npos ||
         text.find_first_not_of("rgba") == std::string_view::npos;
}

std::optional<uint32_t> VendorNames::add(std::string_view vendor, std::string_view name, uint32_t index,
                                         const Rename& rename) {
  const auto known = by_name_.find(name);
  const bool there = known != by_name_.end();
  if (there && (known->second.vendor == vendor || known->second.vendor.empty() || vendor.empty()))
    return known->second.index;
  const auto [own, fresh] = own_.try_emplace({vendor, name}, index);
  if (!fresh) return own->second;
  if (vendor.empty() || (!there && !several_.contains(name))) {
    by_name_.emplace(name, Meaning{index, vendor});
    return std::nullopt;
  }
  several_.insert(name);
  if (there) {
    const Meaning first = known->second;
    by_name_.erase(known);
    qualify(first, name, rename);
  }
  qualify({index, vendor}, name, rename);
  return std::nullopt;
}

void VendorNames::qualify(const Meaning& meaning, std::string_view name, const Rename& rename) {
  const std::string made = fmt::format("{}.{}", meaning.vendor, name);
  by_name_.emplace(made, meaning);
  rename(meaning.index, made);
}

void VendorNames::move(std::string_view name, const Rename& rename) {
  const auto known = by_name_.find(name);
  if (known == by_name_.end() || known->second.vendor.empty()) return;
  const Meaning meaning = known->second;
  by_name_.erase(known);
  qualify(meaning, name, rename);
}

std::optional<uint32_t> VendorNames::own(const std::vector<std::string_view>& vendors,
                                         std::string_view name) const {
  for (const std::string_view vendor : vendors) {
    if (const auto it = own_.find({vendor, name}); it != own_.end()) return it->second;
  }
  return std::nullopt;
}

std::optional<uint32_t> VendorNames::shared(std::string_view name) const {
  const auto it = by_name_.find(name);
  return it == by_name_.end() || !it->second.vendor.empty() ? std::nullopt : std::optional(it->second.index);
}

std::optional<uint32_t> VendorNames::any(std::string_view name) const {
  const auto it = by_name_.find(name);
  return it == by_name_.end() ? std::nullopt : std::optional(it->second.index);
}

std::optional<uint32_t> VendorNames::find(const std::vector<std::string_view>& vendors,
                                          std::string_view name) const {
  const std::optional<uint32_t> mine = own(vendors, name);
  return mine ? mine : any(name);
}

std::vector<std::string_view> VendorNames::all() const {
  std::vector<std::string_view> names;
  for (const auto& [name, meaning] : by_name_) names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

Names::Names(const lang::Library& library, const material::Schema& schema, Model& model)
    : library_(library), schema_(schema), model_(model) {
  // A template that is wrong says so when it is used; what the others give has names all the same.
  for (const std::string_view name : library.names(lang::DeclKind::Template)) {
    lang::GivenNames decl = library.givenNames(name);
    for (std::string& given : decl.names) {
      Given& one = givens_[std::move(given)];
      one.built_in = one.built_in || decl.origin.built_in;
      one.vendors.insert(decl.origin.vendor);
    }
  }
  for (auto& [name, given] : givens_) {
    given.index = static_cast<uint32_t>(model_.givens.size());
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

std::string_view Names::keep(std::string name) {
  model_.made_names.push_back(std::make_shared<const std::string>(std::move(name)));
  return *model_.made_names.back();
}

void Names::addId(std::string_view name) {
  const auto index = static_cast<uint32_t>(model_.ids.size());
  model_.ids.push_back({name, {}, {}});
  const auto known = ids_.add(vendor(), name, index, [&](uint32_t id, std::string made) {
    model_.ids[id].name = keep(std::move(made));
  });
  if (known) model_.ids.pop_back();
}

bool Names::addTerm(std::string_view name, uint32_t index) {
  return !terms_.add(vendor(), name, index, [&](uint32_t term, std::string made) {
    model_.terms[term].name = keep(std::move(made));
  });
}

void Names::keepFree(std::string_view name) {
  ids_.move(name, [&](uint32_t id, std::string made) { model_.ids[id].name = keep(std::move(made)); });
}

uint32_t Names::makeId(const std::string& name) {
  std::string free = name;
  for (int i = 2; ids_.any(free) || made_.contains(free); ++i) free = fmt::format("{}_{}", name, i);
  const std::string_view kept = keep(std::move(free));
  made_.insert(kept);
  model_.ids.push_back({kept, {}, {}});
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
    if (std::string_view(given.first).substr(0, given.first.find('.')) != name) return false;
    return given.second.built_in || (!vendor().empty() && given.second.vendors.contains(vendor()));
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

std::optional<uint32_t> Names::roleOf(std::string_view head, Where where) const {
  const auto find = [&](std::string_view name) -> std::optional<uint32_t> {
    const auto it = roles_.find(name);
    return it == roles_.end() ? std::nullopt : std::optional(it->second);
  };
  const auto vendorOf = [&](uint32_t role) {
    return schema_.vendorOf(schema_.properties[model_.roles[role].providers[0]]);
  };
  const std::optional<uint32_t> plain = find(head);
  if (where == Where::Any || (where == Where::Shared && plain && vendorOf(*plain).empty())) return plain;
  if (where == Where::Shared) return std::nullopt;
  for (const std::string_view vendor : vendors_) {
    if (plain && vendorOf(*plain) == vendor) return plain;
    if (const auto own = find(fmt::format("{}.{}", vendor, head))) return own;
  }
  return std::nullopt;
}

bool Names::role(std::string_view text, Where where, Value& out) const {
  std::string_view head = text.substr(0, text.find('.'));
  std::optional<uint32_t> found = roleOf(head, where);
  if (!found && where == Where::Any && head.size() < text.size()) {
    // "EXTENSION.name" of what several vendors have.
    head = text.substr(0, text.find('.', head.size() + 1));
    found = roleOf(head, where);
  }
  if (!found) return false;
  out.kind = Value::Kind::Role;
  out.index = *found;
  if (head.size() == text.size()) return true;
  const std::string_view rest = text.substr(head.size() + 1);
  const lang::PropertyDecl& decl = declOf(*found);
  if (decl.kind == lang::PropertyDecl::Kind::Texture) {
    if (rest == "uv") return out.coordinate = true;
    if (rest == "image") return out.image = true;
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
    out.index = it->second.index;
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
  // What its own vendor calls so goes before what all share, and that before what another vendor does.
  for (const Where where : {Where::Own, Where::Shared, Where::Any}) {
    if (where == Where::Own && vendors_.empty()) continue;
    if (id(text, where, out) || role(text, where, out)) return true;
    if (where == Where::Shared && given(text, out)) return true;
    out = {};
  }
  for (const std::string_view name : ids_.all()) candidates.push_back(name);
  for (const auto& [name, index] : roles_) candidates.push_back(name);
  for (const auto& [name, given] : givens_) candidates.push_back(name);
  return false;
}

std::vector<std::string> Names::membersOf(std::string_view text) const {
  Value texture;
  const std::string_view head = text.substr(0, text.rfind('.'));
  if (head.size() == text.size() || !role(head, Where::Any, texture) || !texture.path.empty()) return {};
  const lang::PropertyDecl& decl = declOf(texture.index);
  if (decl.kind != lang::PropertyDecl::Kind::Texture) return {};
  std::vector<std::string> names{fmt::format("{}.image", head), fmt::format("{}.uv", head)};
  for (const lang::PropertyDecl& member : decl.members)
    names.push_back(fmt::format("{}.{}", head, member.name));
  return names;
}

bool Names::id(std::string_view text, Where where, Value& out) const {
  for (size_t end = text.size(); end != std::string_view::npos && end > 0; end = text.rfind('.', end - 1)) {
    const std::string_view head = text.substr(0, end);
    const std::optional<uint32_t> found = where == Where::Own      ? ids_.own(vendors_, head)
                                          : where == Where::Shared ? ids_.shared(head)
                                                                   : ids_.any(head);
    if (!found) continue;
    out.kind = Value::Kind::Id;
    out.index = *found;
    out.path = end == text.size() ? std::string_view{} : text.substr(end + 1);
    return true;
  }
  return false;
}

bool Names::condition(std::string_view text, Condition& out) const {
  const auto as = [&](Condition::Kind kind, uint32_t index) {
    out.kind = kind;
    out.index = index;
    return true;
  };
  if (const auto found = ids_.find(vendors_, text))
    return flags_.contains(*found) && as(Condition::Kind::Flag, *found);
  if (const auto found = terms_.find(vendors_, text)) return as(Condition::Kind::Term, *found);
  if (const auto it = switches_.find(text); it != switches_.end())
    return as(Condition::Kind::Switch, it->second);
  if (const std::optional<uint16_t> extension = schema_.find(text); extension && *extension != 0)
    return as(Condition::Kind::Extension, *extension);
  return false;
}

}  // namespace lacquer::model
