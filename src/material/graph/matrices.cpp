#include "graph/matrices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <functional>
#include <map>
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
  const auto written = [](const auto& named) {
    const auto* literal = std::get_if<Literal>(&named.second.from);
    return literal != nullptr && ir::isMatrix(literal->type);
  };
  return std::any_of(graph.parameters.begin(), graph.parameters.end(),
                     [](const Parameter& p) { return ir::isMatrix(p.type); }) ||
         std::any_of(graph.nodes.begin(), graph.nodes.end(), [&](const Node& node) {
           return std::any_of(node.inputs.begin(), node.inputs.end(), written);
         });
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

namespace {

/// The nodes that make matrices of columns, before all others of a graph.
class Columns {
public:
  Columns(const Graph& graph, const lang::Library& library) : library_(library) {
    for (const Node& node : graph.nodes) ids_.insert(node.id);
  }

  /// The id of a node, `name` or one like it, that makes a matrix.
  template <class ColumnOf>
  std::string make(const std::string& name, ir::Type matrix, ColumnOf columnOf) {
    Node& node = nodes.emplace_back();
    node.id = name;
    for (int i = 2; !ids_.insert(node.id).second; ++i) node.id = fmt::format("{}_{}", name, i);
    node.type = formFor(matrix, library_);
    for (size_t c = 0; c < columnCount(matrix); ++c)
      node.inputs.emplace_back(fmt::format("in{}", c + 1), Source{columnOf(c), {}});
    return node.id;
  }

  std::vector<Node> nodes;

private:
  const lang::Library& library_;
  std::set<std::string> ids_;
};

Literal columnOf(const Literal& matrix, size_t column) {
  const size_t count = columnCount(matrix.type);
  Literal made{ir::partType(matrix.type), {}};
  for (size_t i = 0; i < count; ++i) made.value[i] = matrix.number(static_cast<int>(column * count + i));
  return made;
}

}  // namespace

void takeColumns(Graph& graph, const lang::Library& library, FlatOutputs* told) {
  Columns made(graph, library);
  std::map<std::string, std::string, std::less<>> by_parameter;
  std::vector<Parameter> parameters;
  for (const Parameter& parameter : graph.parameters) {
    const std::vector<Parameter> columns = columnsOf(parameter);
    parameters.insert(parameters.end(), columns.begin(), columns.end());
    if (!ir::isMatrix(parameter.type)) continue;
    by_parameter[parameter.name] =
        made.make(parameter.name, parameter.type, [&](size_t c) { return ParameterRef{columns[c].name}; });
  }
  const auto take = [&](Source& source, const std::string& name) {
    if (const auto* ref = std::get_if<ParameterRef>(&source.from)) {
      const auto it = by_parameter.find(ref->name);
      if (it != by_parameter.end()) source.from = NodeRef{it->second, {}};
    } else if (const auto* literal = std::get_if<Literal>(&source.from);
               literal != nullptr && ir::isMatrix(literal->type)) {
      const Literal matrix = *literal;
      source.from = NodeRef{made.make(name, matrix.type, [&](size_t c) { return columnOf(matrix, c); }), {}};
    }
  };
  for (Node& node : graph.nodes) {
    for (auto& [name, source] : node.inputs) take(source, fmt::format("{}.{}", node.id, name));
  }
  for (auto& [port, source] : graph.outputs) take(source, port);
  if (told != nullptr) {
    for (auto& [path, outputs] : *told) {
      for (auto& [name, source] : outputs) take(source, name.empty() ? std::string("matrix") : name);
    }
  }
  made.nodes.insert(made.nodes.end(), std::make_move_iterator(graph.nodes.begin()),
                    std::make_move_iterator(graph.nodes.end()));
  graph.nodes = std::move(made.nodes);
  graph.parameters = std::move(parameters);
}

}  // namespace lacquer::graph
