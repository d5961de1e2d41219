#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "docs/tables.h"
#include "lang/library.h"
#include "support/cases.h"

namespace lacquer::test {

namespace {

/// What stands between the angle brackets of a form's name; of a node that is alone, its result's type.
std::string typesOf(const lang::NodeDecl& node) {
  const size_t at = node.name.find('<');
  if (at == std::string_view::npos)
    return node.results.size() == 1 ? std::string(ir::typeName(node.results[0].type)) : "";
  const std::string types(node.name.substr(at + 1, node.name.size() - at - 2));
  return types.find(',') == std::string::npos ? types : "(" + types + ")";
}

std::string inputsOf(const lang::NodeDecl& node) {
  // Of several that differ in a number alone, the first and the last.
  std::string text;
  for (size_t i = 0; i < node.params.size(); ++i) {
    if (node.params.size() > 12 && i == 6) {
      text += ", …";
      i = node.params.size() - 2;
    }
    text += fmt::format("{}`{}`", text.empty() ? "" : ", ", node.params[i].name);
  }
  return text;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

}  // namespace

namespace {

/// Of texts that say the same up to a colon of their first sentence, and behind it each its own: without
/// that.
std::string proseOf(const std::string& first, const std::set<std::string>& all) {
  const size_t colon = first.find(": ");
  const size_t stop = first.find('.');
  if (all.size() < 2 || colon == std::string::npos || stop < colon) return first;
  const bool alike = std::all_of(all.begin(), all.end(), [&](const std::string& one) {
    return one.compare(0, colon, first, 0, colon) == 0;
  });
  return alike ? first.substr(0, colon) + first.substr(stop) : first;
}

}  // namespace

std::string standardNodes() {
  const lang::Library library = lang::Library::embedded();
  struct Family {
    const lang::NodeDecl* first = nullptr;
    std::vector<std::string> types;
    std::set<std::string> docs;
  };
  std::map<std::string, std::map<std::string, Family>> categories;
  size_t forms = 0;
  for (const std::string_view name : library.names(lang::DeclKind::Node)) {
    const auto found = library.node(name);
    EXPECT_TRUE(found) << name;
    if (!found) continue;
    const lang::NodeDecl& node = **found;
    // One without a category is made for other texts.
    if (!node.origin.file.starts_with("nodes/standard/") || node.category.empty()) continue;
    Family& family = categories[std::string(node.category)][std::string(node.family)];
    // The text that is written first says what the node is.
    if (family.first == nullptr || node.origin.line < family.first->origin.line) family.first = &node;
    family.types.push_back(typesOf(node));
    family.docs.insert(node.doc);
    ++forms;
  }
  size_t families = 0;
  std::string out;
  for (const auto& [category, nodes] : categories) {
    out += fmt::format("\n### {}\n\n| node | inputs | forms | |\n|---|---|---|---|\n", category);
    for (const auto& [name, family] : nodes) {
      std::string doc = proseOf(family.first->doc, family.docs);
      std::replace(doc.begin(), doc.end(), '\n', ' ');
      out +=
          fmt::format("| `{}` | {} | {} | {} |\n", name, inputsOf(*family.first), joined(family.types), doc);
      ++families;
    }
  }
  return fmt::format("{} nodes in {} forms.\n", families, forms) + out;
}

/// bench/pictures.py draws them.
TEST(StandardPictures, AreThereForEachNode) {
  const lang::Library library = lang::Library::embedded();
  const std::string page = readFile(sourceFolder() / "docs/standard-pictures.md");
  size_t nodes = 0;
  for (const std::string_view name : library.names(lang::DeclKind::Node)) {
    const auto node = library.node(name);
    ASSERT_TRUE(node) << name;
    if (!(*node)->origin.file.starts_with("nodes/standard/") || (*node)->category.empty()) continue;
    const size_t section = page.find(fmt::format("## {}\n", (*node)->category));
    const size_t end = page.find("\n## ", section);
    const size_t at = page.find(fmt::format("`{}`", (*node)->family), section);
    EXPECT_TRUE(section != std::string::npos && at < end) << "./dev bench pictures draws " << name;
    EXPECT_TRUE(std::filesystem::exists(sourceFolder() /
                                        fmt::format("docs/images/standard-{}.png", (*node)->category)));
    ++nodes;
  }
  EXPECT_GT(nodes, 500U);
}

}  // namespace lacquer::test
