// What names in parts stand for.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "model/model.h"

namespace lacquer::model {

/// One to four letters of xyzw or rgba.
bool isSwizzle(std::string_view text);

class Names {
public:
  /// Fills the model's lists of names as they are added.
  Names(const lang::Library& library, const material::Schema& schema, Model& model);

  void addRoles();
  void addSwitches(Diagnostics& wrong);
  void addId(std::string_view name);
  void addFlag(std::string_view name) { flags_.insert(name); }
  void addOut(std::string_view name);
  /// False when there is one.
  bool addTerm(std::string_view name, uint32_t index) { return terms_.emplace(name, index).second; }
  void sections(const std::vector<std::string_view>& names) { sections_ = names; }

  uint32_t id(std::string_view name) const { return ids_.at(name); }
  uint32_t out(std::string_view name) const { return outs_.at(name); }
  std::optional<uint32_t> findOut(std::string_view name) const;
  std::vector<std::string_view> outs() const;
  /// A line that no text refers to: its name, or the next one with a number behind it that is no other's.
  uint32_t makeId(const std::string& name);
  bool hasId(std::string_view name) const { return ids_.contains(name); }
  /// "view", "light_sample" of "light_sample.L", a texture of the environment.
  bool hasGiven(std::string_view name) const;
  /// The place of a section; of none, the first.
  std::optional<uint32_t> section(std::string_view name) const;

  /// The text of a reference, which has no spaces.
  static std::string_view textOf(std::string_view text, lang::Span span);

  /// What a dotted name stands for as a value. False when nothing: `candidates` are then what it could have
  /// been.
  bool resolve(std::string_view text, Value& out, std::vector<std::string_view>& candidates) const;

  /// What a name says as a condition of its own; false when it is a value, which may be present.
  bool condition(std::string_view text, Condition& out) const;

  /// The declaration of a value that is a choice; null for others.
  const lang::PropertyDecl* choice(const Value& value) const;

private:
  bool role(std::string_view text, Value& out) const;
  bool given(std::string_view text, Value& out) const;
  const lang::PropertyDecl& declOf(uint32_t role) const;

  const lang::Library& library_;
  const material::Schema& schema_;
  Model& model_;
  std::vector<std::string_view> sections_;
  std::map<std::string_view, uint32_t> ids_, outs_, roles_, terms_, switches_;
  std::set<std::string_view> flags_, made_;
  std::map<std::string, uint32_t, std::less<>> givens_;
};

}  // namespace lacquer::model
