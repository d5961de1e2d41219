#include <algorithm>
#include <map>
#include <mutex>
#include <optional>

#include "model/model.h"

namespace lacquer::model {

struct Models::State {
  const lang::Library& library;
  materialx::Definitions definitions;
  std::span<const Prepared> prepared;
  std::mutex mutex;
  std::optional<Result<material::Schema>> schema;
  std::map<std::string, Result<Model>, std::less<>> models;

  Result<Model> make(const material::Schema& of, std::string_view profile,
                     const std::set<std::string, std::less<>>& lods) const {
    const auto found = std::find_if(prepared.begin(), prepared.end(),
                                    [&](const Prepared& one) { return one.profile == profile; });
    if (found != prepared.end() && lods.empty() && library.isBuiltIn())
      return found->read(found->bytes, library, of);
    return compile(library, of, profile, lods);
  }
};

Models::Models(const lang::Library& library, materialx::Definitions definitions,
               std::span<const Prepared> prepared)
    : state_(new State{library, std::move(definitions), prepared, {}, {}, {}}) {}
Models::~Models() = default;

Result<const material::Schema*> Models::schema() const {
  const std::lock_guard lock(state_->mutex);
  if (!state_->schema) {
    state_->schema = material::schemaOf(state_->library);
    if (*state_->schema) (*state_->schema)->definitions = state_->definitions;
  }
  if (!*state_->schema) return tl::make_unexpected(state_->schema->error());
  return &**state_->schema;
}

Result<const Model*> Models::of(std::string_view profile,
                                const std::set<std::string, std::less<>>& lods) const {
  const Result<const material::Schema*> schema = this->schema();
  if (!schema) return tl::make_unexpected(schema.error());
  const std::lock_guard lock(state_->mutex);
  std::string key(profile);
  for (const std::string& lod : lods) key += "\n" + lod;
  auto it = state_->models.find(key);
  if (it == state_->models.end())
    it = state_->models.emplace(key, state_->make(**schema, profile, lods)).first;
  if (!it->second) return tl::make_unexpected(it->second.error());
  return &*it->second;
}

Result<std::vector<const lang::ProfileDecl*>> profiles(const lang::Library& library) {
  std::vector<const lang::ProfileDecl*> all;
  for (const std::string_view name : library.names(lang::DeclKind::Profile)) {
    const Result<const lang::ProfileDecl*> found = library.profile(name);
    if (!found) return tl::make_unexpected(found.error());
    all.push_back(*found);
  }
  const Result<std::string> by_default = library.defaultProfile();
  if (!by_default) return tl::make_unexpected(by_default.error());
  std::stable_partition(all.begin(), all.end(),
                        [&](const lang::ProfileDecl* decl) { return decl->name == *by_default; });
  return all;
}

namespace {

/// The first comparison with a number in a condition.
const Condition* comparison(const Condition& condition) {
  if (condition.kind == Condition::Kind::Equal && condition.name.empty()) return &condition;
  for (const Condition& inner : condition.conditions) {
    if (const Condition* found = comparison(inner)) return found;
  }
  return nullptr;
}

}  // namespace

std::vector<std::pair<std::string, std::vector<double>>> Model::layers() const {
  std::vector<std::pair<std::string, std::vector<double>>> all;
  for (const Part& part : parts) {
    const Condition* gone = part.of.empty() ? nullptr : comparison(terms[part.term].unless);
    if (gone == nullptr || gone->values[0].member >= 0) continue;
    const material::Property& property = schema->properties[roles[gone->values[0].index].providers[0]];
    const auto count = static_cast<size_t>(ir::componentCount(property.decl->type));
    all.emplace_back(
        property.parameter_name,
        std::vector<double>(gone->constant.begin(), gone->constant.begin() + static_cast<ptrdiff_t>(count)));
  }
  return all;
}

std::vector<std::pair<std::string, std::vector<std::string>>> Model::absent(
    const std::set<std::string, std::less<>>& skipped) const {
  // For each term that can be kept and is not there: itself, and those around it.
  std::map<std::string_view, std::vector<std::string>> kept_by;
  for (const Term& term : terms) {
    bool off = skipped.contains(term.name);
    std::vector<std::string> chain{std::string(term.name)};
    bool possible = term.has_unless;
    for (uint32_t outer = term.parent; outer != Line::kNone; outer = terms[outer].parent) {
      if (!skipped.contains(terms[outer].name)) continue;
      off = true;
      possible = possible && terms[outer].has_unless;
      chain.emplace(chain.begin(), terms[outer].name);
    }
    if (off && possible) kept_by.emplace(term.name, std::move(chain));
  }
  std::map<std::string, std::vector<std::string>> all;
  for (const Role& role : roles) {
    const material::Property& property = schema->properties[role.providers[0]];
    if (property.decl->kind != material::Kind::Number) continue;
    for (const std::string_view term : role.live) {
      if (const auto it = kept_by.find(term); it != kept_by.end())
        all.emplace(property.parameter_name, it->second);
    }
  }
  return {all.begin(), all.end()};
}

const lang::NodeDecl& Node::of(const lang::Library& library) const {
  // Two threads find the same.
  const lang::NodeDecl* decl = decl_.load(std::memory_order_acquire);
  if (decl == nullptr) {
    decl = *library.node(name_);
    decl_.store(decl, std::memory_order_release);
  }
  return *decl;
}

std::optional<std::vector<std::string>> Model::keeping(std::string_view path) const {
  std::optional<std::vector<std::string>> kept;
  // The first term that can be kept, with those around it.
  const auto keep = [&](const std::vector<std::string_view>& live) {
    if (!kept) kept.emplace();
    for (const std::string_view name : live) {
      const auto term =
          std::find_if(terms.begin(), terms.end(), [&](const Term& one) { return one.name == name; });
      if (term == terms.end() || !term->has_unless) continue;
      for (auto at = static_cast<uint32_t>(term - terms.begin()); at != Line::kNone; at = terms[at].parent) {
        if (terms[at].has_unless) kept->emplace_back(terms[at].name);
      }
      return;
    }
  };
  for (const material::Property& property : schema->properties) {
    if (property.path == path) keep({});
  }
  for (const Role& role : roles) {
    for (const uint16_t provider : role.providers) {
      const material::Property& property = schema->properties[provider];
      if (property.path == path) keep(role.live);
      for (size_t i = 0; i < property.decl->members.size(); ++i) {
        if (path.starts_with(property.path) &&
            path.substr(property.path.size()) == "/" + std::string(property.decl->members[i].name))
          keep(i < role.member_live.size() ? role.member_live[i] : std::vector<std::string_view>());
      }
    }
  }
  return kept;
}

std::vector<std::string_view> Model::liveTerms() const {
  std::vector<std::string_view> names;
  for (const Term& term : terms) {
    if (term.has_unless) names.push_back(term.name);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace lacquer::model
