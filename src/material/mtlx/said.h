// What readers of looks and of variants have in common.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mtlx/element.h"
#include "support/diagnostic.h"

namespace lacquer::materialx {

/// Says what is wrong where it stands.
class Said {
public:
  explicit Said(Diagnostics& to) : to_(&to) {}
  void operator()(const Element& at, Severity severity, std::string code, std::string message,
                  std::string help = {}) const;
  /// "did you mean": one of the children of that category.
  std::string meant(const Element& of, std::string_view category, std::string_view name);
  /// What has been said to so far.
  Diagnostics* to(Diagnostics* other) { return std::exchange(to_, other); }

private:
  Diagnostics* to_;
  size_t suggestions_ = 0;
};

using ByName = std::map<std::string_view, const Element*>;
/// The children of a category; of a name the first one.
ByName namesOf(const Element& document, std::string_view category);
/// The looks of a document, and what they inherit from.
class LookChains {
public:
  explicit LookChains(const Element& document);
  /// Says which looks inherit from themselves, each circle once, and from what is not there.
  void tell(Said& said) const;
  /// A look and what it inherits from, the eldest first; of these none that is empty.
  std::vector<const Element*> of(const Element& look) const;
  const ByName& looks() const { return looks_; }

private:
  const Element& document_;
  ByName looks_;
  std::map<const Element*, const Element*> bases_;  ///< the next that has something; looked up, never walked
  std::vector<const Element*> circles_, missing_;   ///< one look of each circle; looks without their base
};

}  // namespace lacquer::materialx
