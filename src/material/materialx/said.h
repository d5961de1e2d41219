// What readers of looks and of variants have in common.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "materialx/element.h"
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
/// A look and what it inherits from, the eldest first. What is wrong is said where `said` is given.
std::vector<const Element*> chainOf(const Element& look, const ByName& looks, const Element* document,
                                    Said* said);

}  // namespace lacquer::materialx
