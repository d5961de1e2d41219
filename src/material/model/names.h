// What names in parts stand for.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "model/model.h"

namespace lacquer::model {

/// One to four letters of xyzw or rgba.
bool isSwizzle(std::string_view text);

/// What texts call by a name, where each vendor (lang::Origin) has names of its own. A name that several have
/// is "VENDOR.name" to all others.
class VendorNames {
public:
  using Rename = std::function<void(uint32_t index, std::string name)>;

  /// What the name means already in a vendor's text: its own, or what all share. Else it means `index` from
  /// now on, and whoever is to be known by another name is told to `rename`.
  std::optional<uint32_t> add(std::string_view vendor, std::string_view name, uint32_t index,
                              const Rename& rename);
  std::optional<uint32_t> own(const std::vector<std::string_view>& vendors, std::string_view name) const;
  std::optional<uint32_t> shared(std::string_view name) const;
  std::optional<uint32_t> any(std::string_view name) const;
  /// Its own before what all share before another's.
  std::optional<uint32_t> find(const std::vector<std::string_view>& vendors, std::string_view name) const;
  std::vector<std::string_view> all() const;
  /// Gives another name to what a name means, unless all share it.
  void move(std::string_view name, const Rename& rename);

private:
  struct Meaning {
    uint32_t index = 0;
    std::string_view vendor;
  };
  void qualify(const Meaning& meaning, std::string_view name, const Rename& rename);

  struct Hash {
    using is_transparent = void;
    size_t operator()(std::string_view text) const { return std::hash<std::string_view>()(text); }
  };
  std::unordered_map<std::string, Meaning, Hash, std::equal_to<>> by_name_;
  std::map<std::pair<std::string_view, std::string_view>, uint32_t> own_;  ///< by vendor and name
  std::set<std::string_view> several_;
};

class Names {
public:
  /// Fills the model's lists of names as they are added.
  Names(const lang::Library& library, const material::Schema& schema, Model& model);

  /// In whose texts names are said from now on, the first one's above all; none: the library's, or a text
  /// that all share.
  void setVendors(std::vector<std::string_view> vendors) { vendors_ = std::move(vendors); }
  std::string_view vendor() const { return vendors_.empty() ? std::string_view{} : vendors_[0]; }

  void addRoles();
  void addSwitches(Diagnostics& wrong);
  void addId(std::string_view name);
  void addFlag(std::string_view name) { flags_.insert(id(name)); }
  void addOut(std::string_view name);
  /// Of the model's term `index`. False when there is one.
  bool addTerm(std::string_view name, uint32_t index);
  void sections(const std::vector<std::string_view>& names) { sections_ = names; }

  uint32_t id(std::string_view name) const { return *findId(name); }
  std::optional<uint32_t> findId(std::string_view name) const { return ids_.find(vendors_, name); }
  uint32_t out(std::string_view name) const { return outs_.at(name); }
  std::optional<uint32_t> findOut(std::string_view name) const;
  std::vector<std::string_view> outs() const;
  /// A line that no text refers to: its name, or the next one with a number behind it that is no other's.
  uint32_t makeId(const std::string& name);
  /// Whether a line of the vendor's, or one that all share, has that name.
  bool hasId(std::string_view name) const { return ids_.own(vendors_, name) || ids_.shared(name); }
  /// Sees to it that no line of another vendor has that name.
  void keepFree(std::string_view name);
  /// "view", "light_sample" of "light_sample.L", a texture of the environment: of a template of the library's
  /// or of the vendor's.
  bool hasGiven(std::string_view name) const;
  /// The place of a section; of none, the first.
  std::optional<uint32_t> section(std::string_view name) const;

  /// The text of a reference, which has no spaces.
  static std::string_view textOf(std::string_view text, lang::Span span);

  /// What a dotted name stands for as a value. False when nothing: `candidates` are then what it could have
  /// been.
  bool resolve(std::string_view text, Value& out, std::vector<std::string_view>& candidates) const;
  /// Of "normalTexture.x": what else could stand behind the texture's point, "normalTexture.image".
  std::vector<std::string> membersOf(std::string_view text) const;

  /// What a name says as a condition of its own; false when it is a value, which may be present.
  bool condition(std::string_view text, Condition& out) const;

  /// The declaration of a value that is a choice; null for others.
  const lang::PropertyDecl* choice(const Value& value) const;

private:
  /// Where a name is looked for: its own vendor's text, what all share, everywhere.
  enum class Where : uint8_t { Own, Shared, Any };
  bool id(std::string_view text, Where where, Value& out) const;
  bool role(std::string_view text, Where where, Value& out) const;
  std::optional<uint32_t> roleOf(std::string_view head, Where where) const;
  std::string_view keep(std::string name);
  bool given(std::string_view text, Value& out) const;
  const lang::PropertyDecl& declOf(uint32_t role) const;

  const lang::Library& library_;
  const material::Schema& schema_;
  Model& model_;
  std::vector<std::string_view> sections_;
  std::vector<std::string_view> vendors_;
  VendorNames ids_, terms_;
  std::map<std::string_view, uint32_t> outs_, roles_, switches_;
  std::set<uint32_t> flags_;
  std::set<std::string_view> made_;
  struct Given {
    uint32_t index = 0;
    bool built_in = false;
    std::set<std::string_view> vendors;  ///< whose templates give it
  };
  std::map<std::string, Given, std::less<>> givens_;
};

}  // namespace lacquer::model
