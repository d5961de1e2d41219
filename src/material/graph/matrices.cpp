#include "graph/matrices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <set>

#include "graph/text.h"

namespace lacquer::graph {

namespace {

size_t columnCount(ir::Type matrix) { return matrix == ir::Type::Mat3 ? 3 : 4; }

/// The form of `creatematrix` that makes a matrix of its columns: MaterialX's rows, since its vectors are
/// rows.
std::string formFor(ir::Type matrix, const lang::Library& library) {
  for (const lang::NodeDecl* form : library.forms("creatematrix")) {
    if (form->results[0].type == matrix && form->params[0].type == ir::partType(matrix))
      return std::string(form->name);
  }
  assert(false);
  return {};
}

template <class Get>
double oneOf(const Parameter& parameter, const ir::Components& plain, int component, Get get) {
  const auto i = static_cast<size_t>(component);
  if (!ir::isMatrix(parameter.type)) return plain[i];
  const size_t count = columnCount(parameter.type);
  return i / count < parameter.columns.size() ? get(parameter.columns[i / count])[i % count] : 0;
}

template <class Get>
void scatter(Parameter& parameter, ir::Components& plain, std::span<const double> all, Get get) {
  assert(all.size() == static_cast<size_t>(ir::componentCount(parameter.type)));
  if (!ir::isMatrix(parameter.type)) {
    std::copy(all.begin(), all.end(), plain.begin());
    return;
  }
  const size_t count = columnCount(parameter.type);
  parameter.columns.resize(count);
  for (size_t c = 0; c < count; ++c) {
    const std::span<const double> part = all.subspan(c * count, count);
    std::copy(part.begin(), part.end(), get(parameter.columns[c]).begin());
  }
}

constexpr auto kValue = [](auto& column) -> auto& { return column.value; };
constexpr auto kNeutral = [](auto& column) -> auto& { return column.neutral; };

}  // namespace

double Parameter::number(int component) const { return oneOf(*this, value, component, kValue); }
double Parameter::neutralNumber(int component) const { return oneOf(*this, neutral, component, kNeutral); }

std::vector<double> Parameter::numbers() const {
  std::vector<double> all;
  for (int i = 0; i < ir::componentCount(type); ++i) all.push_back(number(i));
  return all;
}

void Parameter::setNumbers(std::span<const double> all) { scatter(*this, value, all, kValue); }
void Parameter::setNeutralNumbers(std::span<const double> all) { scatter(*this, neutral, all, kNeutral); }

std::string columnName(std::string_view matrix, int column) { return fmt::format("{}_{}", matrix, column); }

bool hasMatrices(const Graph& graph) {
  return std::any_of(graph.parameters.begin(), graph.parameters.end(),
                     [](const Parameter& p) { return ir::isMatrix(p.type); });
}

std::vector<Parameter> columnsOf(const Parameter& parameter) {
  if (!ir::isMatrix(parameter.type)) return {parameter};
  std::vector<Parameter> columns;
  for (int c = 0; c < static_cast<int>(columnCount(parameter.type)); ++c) {
    Parameter& column = columns.emplace_back(parameter);
    column.columns.clear();
    column.column_of = parameter.name;
    column.name = columnName(parameter.name, c);
    column.type = ir::partType(parameter.type);
    if (static_cast<size_t>(c) < parameter.columns.size()) {
      column.value = parameter.columns[static_cast<size_t>(c)].value;
      column.neutral = parameter.columns[static_cast<size_t>(c)].neutral;
    }
    if (!parameter.pointer.empty()) column.pointer = fmt::format("{}/{}", parameter.pointer, c);
  }
  return columns;
}

void takeColumns(Graph& graph, const lang::Library& library, FlatOutputs* told) {
  std::set<std::string> ids;
  for (const Node& node : graph.nodes) ids.insert(node.id);
  std::vector<std::pair<std::string, std::string>> made;  // the matrix, its node
  std::vector<Parameter> parameters;
  std::vector<Node> nodes;
  for (const Parameter& parameter : graph.parameters) {
    const std::vector<Parameter> columns = columnsOf(parameter);
    parameters.insert(parameters.end(), columns.begin(), columns.end());
    if (!ir::isMatrix(parameter.type)) continue;
    Node& node = nodes.emplace_back();
    node.id = parameter.name;
    for (int i = 2; !ids.insert(node.id).second; ++i) node.id = fmt::format("{}_{}", parameter.name, i);
    node.type = formFor(parameter.type, library);
    for (size_t c = 0; c < columns.size(); ++c)
      node.inputs.emplace_back(fmt::format("in{}", c + 1), Source{ParameterRef{columns[c].name}, {}});
    made.emplace_back(parameter.name, node.id);
  }
  const auto take = [&](Source& source) {
    const auto* ref = std::get_if<ParameterRef>(&source.from);
    if (ref == nullptr) return;
    const auto it =
        std::find_if(made.begin(), made.end(), [&](const auto& m) { return m.first == ref->name; });
    if (it != made.end()) source.from = NodeRef{it->second, {}};
  };
  for (Node& node : graph.nodes) {
    for (auto& [name, source] : node.inputs) take(source);
  }
  for (auto& [port, source] : graph.outputs) take(source);
  if (told != nullptr) {
    for (auto& [path, outputs] : *told) {
      for (auto& [name, source] : outputs) take(source);
    }
  }
  nodes.insert(nodes.end(), std::make_move_iterator(graph.nodes.begin()),
               std::make_move_iterator(graph.nodes.end()));
  graph.nodes = std::move(nodes);
  graph.parameters = std::move(parameters);
}

}  // namespace lacquer::graph
