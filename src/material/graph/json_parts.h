// Parts of a graph in the JSON form, as edits are given them.
#pragma once

#include <string>
#include <string_view>

#include "graph/graph.h"
#include "json/json.h"

namespace lacquer::graph {

/// Each reads what fromJson() reads at such a place; pointers of errors begin with `at`.
Result<Node> readNode(const json::Json& json, std::string_view at, const Limits& limits);
Result<Source> readSource(const json::Json& json, std::string_view at, const Limits& limits);
Result<Parameter> readParameter(std::string_view name, const json::Json& json, std::string_view at,
                                const Limits& limits);
Result<Texture> readTexture(std::string_view name, const json::Json& json, std::string_view at,
                            const Limits& limits);
Result<Group> readGroup(std::string_view name, const json::Json& json, std::string_view at,
                        const Limits& limits);
Result<GroupInput> readInput(std::string_view name, const json::Json& json, std::string_view at,
                             const Limits& limits);
/// The numbers of a value of that type, as a parameter has one, of a matrix column by column.
Result<std::vector<double>> readValue(ir::Type type, const json::Json& json, std::string_view at,
                                      const Limits& limits);
Result<Graph> readGraph(const json::Json& json, std::string_view at, const Limits& limits);
/// The tree of an edit, without duplicate keys.
Result<json::Json> parseEdit(std::string_view text, const Limits& limits);

/// What toJson() writes there, of a parameter and the like without its name.
std::string textOf(const Node& node);
std::string textOf(const Source& source);
std::string textOf(const Parameter& parameter);
std::string textOf(const Texture& texture);
std::string textOf(const Group& group);
std::string textOf(const GroupInput& input);
/// Today's value of a parameter.
std::string valueText(const Parameter& parameter);

/// Bytes of all that tools keep in a graph.
uint64_t uiSize(const Graph& graph);

}  // namespace lacquer::graph
