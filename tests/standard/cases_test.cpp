// The numbers of the standard nodes. cases/NAME.txt has lines for each form of each node in
// nodes/standard/NAME.node, whose results follow from MaterialX's definitions: of a node that is a graph
// there, from the graph, in double, by a program that shares nothing with the node texts. cases/edges.txt has
// what the definitions leave open (docs/standard-nodes.md).
//
//     add<vec2>: in1 = 1 2; in2 = 3 4 -> 4 6
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "eval/evaluate.h"
#include "lang/library.h"
#include "prove/nodes.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

const lang::Library& library() {
  static const lang::Library kLibrary = lang::Library::embedded();
  return kLibrary;
}

struct Line {
  std::string node;
  std::vector<std::pair<std::string, std::vector<double>>> inputs;
  std::vector<double> expected;
};

std::vector<double> numbersOf(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<double>(stream), {}};
}

std::vector<std::string> splitAt(const std::string& text, const std::string& mark) {
  std::vector<std::string> parts;
  size_t from = 0;
  for (size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, from)) {
    parts.push_back(text.substr(from, at - from));
    from = at + mark.size();
  }
  parts.push_back(text.substr(from));
  return parts;
}

Line lineOf(const std::string& text) {
  Line line;
  const std::vector<std::string> sides = splitAt(text, " -> ");
  const size_t colon = sides[0].find(": ");
  EXPECT_TRUE(sides.size() == 2 && colon != std::string::npos) << text;
  line.node = sides[0].substr(0, colon);
  for (const std::string& input : splitAt(sides[0].substr(colon + 2), "; ")) {
    const std::vector<std::string> ends = splitAt(input, " = ");
    EXPECT_EQ(ends.size(), 2U) << text;
    line.inputs.emplace_back(ends[0], numbersOf(ends[1]));
  }
  line.expected = numbersOf(sides[1]);
  return line;
}

/// The results side by side.
template <class T>
std::vector<double> resultsOf(const Line& line, const std::string& variant) {
  const auto found = library().node(line.node);
  EXPECT_TRUE(found) << line.node;
  if (!found) return {};
  const NodeModule made = nodeModule(**found, variant);
  eval::Bindings bindings;
  bindings.quads = true;
  for (const lang::Param& param : (*found)->params) {
    const auto given = std::find_if(line.inputs.begin(), line.inputs.end(),
                                    [&](const auto& input) { return input.first == param.name; });
    EXPECT_TRUE(given != line.inputs.end()) << line.node << " lacks " << param.name;
    eval::Column& column = bindings.columns[std::string(param.name)];
    column.components = ir::componentCount(param.type);
    column.per_point = true;
    if (given == line.inputs.end()) continue;
    EXPECT_EQ(given->second.size(), static_cast<size_t>(column.components)) << line.node << " " << param.name;
    // Derivatives are taken between four neighbours.
    for (int neighbour = 0; neighbour < 4; ++neighbour)
      column.values.insert(column.values.end(), given->second.begin(), given->second.end());
  }
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : made.module.outputs) roots.push_back(output.value);
  const auto values = eval::evaluate<T>(made.module, roots, bindings, 4);
  EXPECT_TRUE(values) << line.node;
  std::vector<double> all;
  for (size_t i = 0; values && i < roots.size(); ++i)
    all.insert(all.end(), (*values)[i].begin(),
               (*values)[i].begin() + static_cast<ptrdiff_t>((*values)[i].size() / 4));
  return all;
}

template <class T>
void expectLine(const Line& line, const std::string& text, double tolerance) {
  const std::vector<double> results = resultsOf<T>(line, {});
  ASSERT_EQ(results.size(), line.expected.size()) << text;
  for (size_t i = 0; i < results.size(); ++i)
    EXPECT_NEAR(results[i], line.expected[i], tolerance * std::max(1.0, std::abs(line.expected[i]))) << text;
}

class StandardCases : public testing::TestWithParam<std::string> {};

std::vector<std::string> linesOf(const std::string& name) {
  std::istringstream stream(readFile(sourceFolder() / "tests/standard/cases" / (name + ".txt")));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line[0] != '#') lines.push_back(line);
  }
  return lines;
}

TEST_P(StandardCases, HaveTheNumbersOfTheirDefinitions) {
  const std::vector<std::string> lines = linesOf(GetParam());
  EXPECT_FALSE(lines.empty());
  for (const std::string& text : lines) {
    const Line line = lineOf(text);
    expectLine<double>(line, text, 1e-7);
    expectLine<float>(line, text, 1e-5);
  }
}

/// No form of a file is without a line.
TEST_P(StandardCases, AreThereForEachForm) {
  if (GetParam() == "edges") return;
  const std::string file = "nodes/standard/" + GetParam() + ".node";
  std::set<std::string> told;
  for (const std::string& text : linesOf(GetParam())) told.insert(lineOf(text).node);
  size_t forms = 0;
  for (const std::string_view name : library().names(lang::DeclKind::Node)) {
    const lang::NodeDecl& node = **library().node(name);
    // What begins so is made for the other texts alone.
    if (node.origin.file != file || node.name.starts_with("standard_")) continue;
    ++forms;
    EXPECT_TRUE(told.contains(std::string(name))) << name << " has no line in " << GetParam() << ".txt";
  }
  EXPECT_GT(forms, 0U);
}

std::vector<std::string> files() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(sourceFolder() / "tests/standard/cases"))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Files, StandardCases, testing::ValuesIn(files()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace lacquer::test
