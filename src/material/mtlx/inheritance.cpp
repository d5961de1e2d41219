#include "mtlx/inheritance.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>
#include <vector>

#include "lang/suggest.h"
#include "support/text.h"

namespace lacquer::materialx {

namespace {

constexpr size_t kDeepestNode = 32;                 ///< nodes that inherit from each other
constexpr size_t kMostInherited = size_t{1} << 18;  ///< inputs that nodes get so

class NodeInheritance {
public:
  explicit NodeInheritance(Diagnostics& wrong) : wrong_(wrong) {}

  void within(Element& owner);

private:
  static bool inherits(const Element& element) {
    return isNodeElement(element) && element.category != "nodegraph" && element.find("inherit") != nullptr;
  }
  void give(Element& node, size_t depth);
  void resolve(Element& node, size_t depth) {
    give(node, depth);
    std::erase_if(node.attributes, [](const auto& one) { return one.first == "inherit"; });
  }
  void error(const Element& at, const char* code, std::string message, std::string help = {}) {
    addBounded(wrong_, {code, Severity::Error, at.place, std::move(message), std::move(help), {}});
  }

  Diagnostics& wrong_;
  const Element* owner_ = nullptr;
  std::unordered_map<std::string_view, Element*> nodes_;  ///< of the owner
  size_t given_ = 0;
};

/// `depth`: how many nodes inherit from this one here.
void NodeInheritance::give(Element& node, size_t depth) {
  const std::string name(node.get("inherit"));
  const auto found = nodes_.find(name);
  if (found == nodes_.end()) {
    std::vector<std::string_view> names;
    for (const Element& one : owner_->children)
      if (one.category == node.category && &one != &node) names.push_back(one.name());
    return error(node, "no-such-node",
                 fmt::format("{} inherits from {}, which is not there", quote(node.name()), quote(name)),
                 lang::didYouMean(name, names));
  }
  Element& base = *found->second;
  if (base.category != node.category)
    return error(node, "inherit-kind",
                 fmt::format("{} is a {}, and inherits from {}, a {}", quote(node.name()), node.category,
                             quote(name), base.category),
                 "a node inherits from one of its kind");
  const bool deep = depth == kDeepestNode && inherits(base);
  if (&base == &node || deep)
    return error(node, "inherit-cycle",
                 fmt::format("{} inherits from itself, or through more than {} others", quote(node.name()),
                             kDeepestNode));
  if (inherits(base)) resolve(base, depth + 1);
  for (const std::string_view attribute : {"type", "nodedef", "version"})
    if (node.find(attribute) == nullptr && base.find(attribute) != nullptr)
      node.set(attribute, std::string(base.get(attribute)));
  std::set<std::pair<std::string_view, std::string_view>> own;
  for (const Element& port : node.children) own.emplace(port.category, port.name());
  std::vector<Element> more;
  for (const Element& port : base.children)
    if (!own.contains({port.category, port.name()})) more.push_back(port);
  given_ += more.size();
  if (given_ > kMostInherited)
    return error(node, "xml-too-many", fmt::format("nodes inherit more than {} inputs", kMostInherited));
  node.children.insert(node.children.end(), std::make_move_iterator(more.begin()),
                       std::make_move_iterator(more.end()));
}

void NodeInheritance::within(Element& owner) {
  if (std::any_of(owner.children.begin(), owner.children.end(), inherits)) {
    owner_ = &owner;
    nodes_.clear();
    for (Element& child : owner.children)
      if (isNodeElement(child)) nodes_.try_emplace(child.name(), &child);
    for (Element& child : owner.children)
      if (inherits(child) && given_ <= kMostInherited) resolve(child, 0);
  }
  for (Element& child : owner.children)
    if (child.category == "nodegraph") within(child);
}

}  // namespace

void inheritNodes(Element& root, Diagnostics& wrong) { NodeInheritance(wrong).within(root); }

}  // namespace lacquer::materialx
