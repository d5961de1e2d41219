// Targets that are another one's texts with other words.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "support/diagnostic.h"
#include "targets/target.h"

namespace lacquer::targets {

using WordMap = std::map<std::string, std::string, std::less<>>;

/// The text with a word in place of each identifier that `words` has, and `opening` in place of its
/// `#version` or, where it has none, above the first line that is no comment. Error "target-words": an
/// identifier is the first word of what stands for another one.
Result<std::string> reworded(std::string_view text, const WordMap& words, std::string_view opening);

struct Registered {
  std::string name, extension, prose;
  Target like = Target::Hlsl;
  WordMap words;
  std::string opening;
  std::function<Diagnostics(const std::string& text, ir::Stage stage)> check;
};
/// Errors: those of lacquer::addTarget().
Result<Target> registerTarget(Registered target);

}  // namespace lacquer::targets
