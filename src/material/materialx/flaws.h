// Errors in the definitions of a document or of a library, whoever uses them.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "mtlx/element.h"

namespace lacquer::materialx {

/// Elements by their names.
using Siblings = std::unordered_map<std::string_view, const Element*>;

/// The element of that name, which may begin with the element's namespace: "studio:ND_dust". Null for none.
const Element* findNamed(const Siblings& all, std::string_view name);

/// Adds what stands in namespaces by its name alone, where nothing has that name.
void addBareNames(const Element& root, Siblings& nodedefs, Siblings& nodegraphs);

/// Whether two versions are one: "1" is "1.0".
bool isOneVersion(std::string_view a, std::string_view b);

inline constexpr size_t kDeepestInheritance = 16;  ///< definitions behind one that inherits

struct Flaw {
  Diagnostic said;
  std::vector<std::string_view> nodedefs;  ///< by their names: those that cannot be taken
};

/// Bodies of a definition that is not there, or that has one already, and what inherits from itself.
/// `nodedefs` and `nodegraphs`: all that are there, by their names.
std::vector<Flaw> flawsOf(const Element& root, const Siblings& nodedefs, const Siblings& nodegraphs);

}  // namespace lacquer::materialx
