// Which nodes of the library a material's terms are of.
#pragma once

#include <map>
#include <string_view>
#include <vector>

#include "lang/library.h"
#include "stress/subject.h"

namespace lacquer::stress {

class NodesByPlace {
public:
  explicit NodesByPlace(const lang::Library& library);
  /// Names the nodes of the subject's terms, and what they call.
  void nameTerms(Subject& subject) const;

private:
  /// By file and line: the forms of one text stand in one place.
  std::map<std::pair<std::string_view, uint32_t>, std::vector<const lang::NodeDecl*>> nodes_;
};

}  // namespace lacquer::stress
