// Lists of what a graph has, and edits of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/internal.h"
#include "edit/edit.h"
#include "graph/check_parts.h"
#include "graph/contracts.h"
#include "graph/json_parts.h"
#include "graph/text.h"
#include "setting/messages.h"
#include "support/text.h"

namespace lacquer {

namespace {

Range rangeOf(const ir::Range& range) {
  const bool gap = range.gap > 0;
  return {gap ? range.gap : range.lo, range.hi, gap};
}

std::vector<Connection> connectionsOf(const graph::Inputs& sources) {
  std::vector<Connection> connections;
  for (const auto& [name, source] : sources) connections.push_back({name, graph::textOf(source)});
  return connections;
}

const graph::Group* groupOf(const graph::Graph& graph, const std::string& name) {
  const std::optional<size_t> found = graph.findGroup(name);
  return found ? &graph.groups[*found] : nullptr;
}

Socket socketOf(const lang::Param& param) {
  return {std::string(param.name), std::string(ir::typeName(param.type)),
          param.has_range ? rangeOf(param.range) : Range{}};
}

std::string sourceOf(const graph::Inputs& inputs, std::string_view name) {
  for (const auto& [input, source] : inputs) {
    if (input == name) return graph::textOf(source);
  }
  return {};
}

/// A name is given numbers that it cannot have.
tl::unexpected<Diagnostics> wrongNumbers(std::string code, const std::string& name, const std::string& given,
                                         std::string help) {
  return fail(std::move(code), {}, fmt::format("'{}' is given {}", printable(name), given), std::move(help));
}

/// A parameter's numbers, but for ranges.
Result<void> readNumbers(const std::string& name, const std::vector<double>& value, graph::Parameter& to,
                         bool known) {
  const auto count = known ? static_cast<size_t>(ir::componentCount(to.type)) : value.size();
  if (value.size() != count || value.empty() || (!known && value.size() > 4)) {
    return wrongNumbers("wrong-count", name, fmt::format("{} numbers", value.size()),
                        known ? "it is " + graph::article(to.type) : "a parameter has 1 to 4");
  }
  if (!known) to.type = ir::floatType(static_cast<int>(count));
  const ir::Type part = ir::partType(to.type);
  for (const double x : value) {
    if (!graph::fitsFloat(x))
      return wrongNumbers(std::isfinite(x) ? "out-of-range" : "not-finite", name, fmt::format("{}", x),
                          std::string(graph::kFloatHelp));
    if (part == ir::Type::Bool && x != 0 && x != 1)
      return wrongNumbers("wrong-type", name, fmt::format("{}", x), "it is a bool, 0 or 1");
    if (ir::isWhole(part) && x != std::trunc(x))
      return wrongNumbers("wrong-type", name, fmt::format("{}", x), "it is a whole number");
  }
  to.setNumbers(value);
  return {};
}

/// A range as a parameter has it.
Result<ir::Range> readRange(const std::string& parameter, const Range& range) {
  const std::string said = fmt::format("[{}, {}]{} is no range of '{}'", range.low, range.high,
                                       range.or_zero ? " or 0" : "", printable(parameter));
  if (!(range.low <= range.high) || (range.or_zero && !(range.low > 0))) {
    return fail("wrong-range", {}, said,
                "the lowest number comes first; 0 stands beside a range that begins above it");
  }
  // -inf below and inf above stand for no end; between them there are numbers.
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (range.low == kInfinite || range.high == -kInfinite)
    return fail("wrong-range", {}, said, "no number is in it");
  for (const double end : {range.low, range.high}) {
    if (std::isfinite(end) && !graph::fitsFloat(end))
      return fail("out-of-range", {}, said, std::string(graph::kFloatHelp));
  }
  ir::Range to;
  if (range.or_zero)
    to = {{0, range.high}, range.low};
  else
    to = {{range.low, range.high}, 0};
  return to;
}

}  // namespace

// -- what is there

std::vector<TextureUse> Graph::textures() const {
  std::vector<TextureUse> textures;
  if (!impl_) return textures;
  for (const graph::Texture& slot : impl_->graph.textures)
    textures.push_back({slot.name, std::string(ir::typeName(slot.type)), slot.srgb, slot.texture,
                        slot.pointer, slot.file, slot.ui, slot.also, samplerOf(slot)});
  return textures;
}

std::vector<Parameter> Graph::parameters() const {
  std::vector<Parameter> parameters;
  if (!impl_) return parameters;
  for (const graph::Parameter& p : impl_->graph.parameters) {
    parameters.push_back(
        {p.name, std::string(ir::typeName(p.type)), p.numbers(), rangeOf(p.range), p.pointer, p.ui});
  }
  return parameters;
}

Strings Graph::groups() const {
  Strings names;
  if (!impl_) return names;
  for (const graph::Group& group : impl_->graph.groups) names.push_back(group.name);
  return names;
}

std::vector<NodeUse> Graph::nodes(const std::string& group) const {
  std::vector<NodeUse> uses;
  if (!impl_) return uses;
  const graph::Group* of = groupOf(impl_->graph, group);
  if (of == nullptr && !group.empty()) return uses;
  for (const graph::Node& node : of == nullptr ? impl_->graph.nodes : of->nodes)
    uses.push_back({node.id, node.type, node.variant, node.group, node.at_vertices,
                    connectionsOf(node.inputs), node.ui});
  return uses;
}

std::vector<Connection> Graph::outputs(const std::string& group) const {
  if (!impl_) return {};
  const graph::Group* of = groupOf(impl_->graph, group);
  if (of == nullptr && !group.empty()) return {};
  return connectionsOf(of == nullptr ? impl_->graph.outputs : of->outputs);
}

/// The template's ports, as inputs.
static Result<Sockets> portsOf(const graph::Graph& graph, const Language& language) {
  const Result<const lang::TemplateDecl*> decl = language.template_(graph.template_name);
  if (!decl) return tl::make_unexpected(decl.error());
  Sockets sockets;
  for (const lang::PortDecl& port : (*decl)->ports) {
    Socket& socket = sockets.inputs.emplace_back(socketOf(port.param));
    socket.optional = port.default_value != nullptr;
    socket.source = sourceOf(graph.outputs, port.param.name);
  }
  return sockets;
}

static Result<Sockets> socketsOf(graph::Graph& graph, const Language& language, const std::string& node) {
  graph::Editor::Where at;
  const Result<size_t> found = graph::Editor(graph, language).node(node, at);
  if (!found) return tl::make_unexpected(found.error());
  const graph::Node& use = (*at.nodes)[*found];
  const graph::Contracts contracts(graph, language);
  const graph::Contract* contract = contracts.of(use);
  if (contract == nullptr) {
    Diagnostics why = graph::checkNode(graph, language, at.group, *found, nullptr);
    if (lacquer::hasError(why)) return tl::make_unexpected(std::move(why));
    return fail("unknown-node", {}, fmt::format("nothing is known of the node '{}'", printable(node)), {});
  }
  Sockets sockets;
  for (const lang::Param& param : contract->params) {
    Socket& socket = sockets.inputs.emplace_back(socketOf(param));
    socket.optional = contracts.hasDefault(param);
    socket.source = sourceOf(use.inputs, param.name);
  }
  for (const lang::Param& param : contract->results) sockets.outputs.push_back(socketOf(param));
  return sockets;
}

std::optional<Sockets> Graph::sockets(const std::string& node, Messages& messages) const {
  if (!filled(impl_.get(), "graph", messages)) return std::nullopt;
  return valueOf(node.empty() ? portsOf(impl_->graph, *impl_->language)
                              : socketsOf(impl_->graph, *impl_->language, node),
                 impl_->file, messages);
}

// -- edits

void Graph::Impl::edited() {
  if (made) made->structure = true;
  may_be.clear();
}

/// `edit` is given an editor of the graph.
template <class Edit>
bool Graph::Impl::edit(Messages& messages, const Edit& edit) {
  const Result<void> done = edit(graph::Editor(graph, *language, limits.nodes));
  if (done) return edited(), true;
  report(done.error(), file, messages);
  return false;
}

bool Graph::addNode(const std::string& id, const std::string& type, Messages& messages) {
  graph::Node node;
  node.id = id;
  node.type = type;
  return filled(impl_.get(), "graph", messages) &&
         impl_->edit(messages, [&](graph::Editor editor) { return editor.addNode(std::move(node)); });
}

bool Graph::addInstance(const std::string& id, const std::string& group, Messages& messages) {
  graph::Node node;
  node.id = id;
  node.type = group;
  node.group = true;
  return filled(impl_.get(), "graph", messages) &&
         impl_->edit(messages, [&](graph::Editor editor) { return editor.addNode(std::move(node)); });
}

bool Graph::removeNode(const std::string& id, Messages& messages) {
  return filled(impl_.get(), "graph", messages) &&
         impl_->edit(messages, [&](graph::Editor editor) { return editor.removeNode(id); });
}

bool Graph::renameNode(const std::string& id, const std::string& to, Messages& messages) {
  return filled(impl_.get(), "graph", messages) &&
         impl_->edit(messages, [&](graph::Editor editor) { return editor.renameNode(id, to); });
}

bool Graph::connect(const std::string& node, const std::string& input, std::string_view source,
                    Messages& messages) {
  return filled(impl_.get(), "graph", messages) &&
         impl_->edit(messages, [&](graph::Editor editor) -> Result<void> {
           const Result<graph::Source> from = graph::sourceFromJson(source);
           return from ? editor.connect(node, input, *from) : tl::make_unexpected(from.error());
         });
}

bool Graph::disconnect(const std::string& node, const std::string& input, Messages& messages) {
  return filled(impl_.get(), "graph", messages) &&
         impl_->edit(messages, [&](graph::Editor editor) { return editor.disconnect(node, input); });
}

bool Graph::setOutput(const std::string& port, std::string_view source, Messages& messages) {
  return filled(impl_.get(), "graph", messages) &&
         impl_->edit(messages, [&](graph::Editor editor) -> Result<void> {
           const Result<graph::Source> from = graph::sourceFromJson(source);
           return from ? editor.setOutput(port, *from) : tl::make_unexpected(from.error());
         });
}

bool Graph::removeOutput(const std::string& port, Messages& messages) {
  return filled(impl_.get(), "graph", messages) &&
         impl_->edit(messages, [&](graph::Editor editor) { return editor.removeOutput(port); });
}

bool Graph::setParameter(const std::string& name, const std::vector<double>& value, Messages& messages) {
  if (!filled(impl_.get(), "graph", messages)) return false;
  const std::optional<size_t> found = impl_->graph.findParameter(name);
  graph::Parameter parameter;
  if (found) parameter = impl_->graph.parameters[*found];
  parameter.name = name;
  const Result<void> read = readNumbers(name, value, parameter, found.has_value());
  if (!read) return report(read.error(), impl_->file, messages), false;
  if (!found)
    return impl_->edit(messages, [&](graph::Editor editor) { return editor.addParameter(parameter); });
  // Of a number that is good nothing is asked but its range, which stays until something else is edited.
  if (impl_->may_be.empty()) impl_->may_be = graph::parameterLimits(impl_->graph, *impl_->language);
  const ir::Range& range = impl_->may_be[*found];
  if (std::all_of(value.begin(), value.end(), [&](double x) { return range.contains(x); })) {
    impl_->graph.parameters[*found].setNumbers(value);
    if (impl_->made) impl_->made->numbers = true;
    return true;
  }
  return impl_->edit(messages, [&](graph::Editor editor) { return editor.setParameter(parameter); });
}

bool Graph::setRange(const std::string& parameter, const Range& range, Messages& messages) {
  return filled(impl_.get(), "graph", messages) &&
         impl_->edit(messages, [&](graph::Editor editor) -> Result<void> {
           const Result<ir::Range> to = readRange(parameter, range);
           if (!to) return tl::make_unexpected(to.error());
           graph::Parameter changed;
           if (const std::optional<size_t> found = impl_->graph.findParameter(parameter))
             changed = impl_->graph.parameters[*found];
           changed.name = parameter;
           changed.range = *to;
           return editor.setParameter(changed);
         });
}

bool Graph::makeGroup(const Strings& nodes, const std::string& group, const std::string& instance,
                      Messages& messages) {
  return filled(impl_.get(), "graph", messages) && impl_->edit(messages, [&](graph::Editor editor) {
    return editor.makeGroup(nodes, group, instance);
  });
}

bool Graph::addGroup(const std::string& group, const Graph& graph, Messages& messages) {
  return filled(impl_.get(), "graph", messages) && filled(graph.impl_.get(), "graph", messages) &&
         impl_->edit(messages, [&](graph::Editor editor) -> Result<void> {
           Diagnostics wrong = graph::check(graph.impl_->graph, *impl_->language, impl_->limits.nodes);
           if (lacquer::hasError(wrong)) return tl::make_unexpected(std::move(wrong));
           // A copy: the two may be one.
           const graph::Graph other = graph.impl_->graph;
           return editor.addGroup(group, other);
         });
}

bool Graph::expand(const std::string& node, Messages& messages) {
  return filled(impl_.get(), "graph", messages) &&
         impl_->edit(messages, [&](graph::Editor editor) { return editor.expand(node); });
}

std::string Graph::edit(std::string_view json, Messages& messages) {
  if (!filled(impl_.get(), "graph", messages)) return {};
  std::string inverse;
  impl_->edit(messages, [&](const graph::Editor& /*editor*/) -> Result<void> {
    Result<std::string> done = graph::edit(impl_->graph, *impl_->language, json, impl_->limits);
    if (!done) return tl::make_unexpected(std::move(done.error()));
    inverse = std::move(*done);
    return {};
  });
  return inverse;
}

// -- what has changed

/// Whether textures are looked up in other images or otherwise.
static bool differInTextures(const graph::Graph& a, const graph::Graph& b) {
  const auto same = [](const graph::Texture& x, const graph::Texture& y) {
    return x.name == y.name && x.texture == y.texture && x.file == y.file && x.wrap == y.wrap &&
           x.nearest == y.nearest && x.color == y.color;
  };
  return std::any_of(a.textures.begin(), a.textures.end(), [&](const graph::Texture& texture) {
    const std::optional<size_t> other = b.findTexture(texture.name);
    return other && !same(texture, b.textures[*other]);
  });
}

static bool differInNumbers(const graph::Graph& a, const graph::Graph& b) {
  return std::any_of(a.parameters.begin(), a.parameters.end(), [&](const graph::Parameter& parameter) {
    const std::optional<size_t> other = b.findParameter(parameter.name);
    return other && (b.parameters[*other].value != parameter.value ||
                     b.parameters[*other].columns != parameter.columns);
  });
}

Change Graph::changes() const {
  if (!impl_ || !impl_->made) return Change::Program;
  const Impl::Made& made = *impl_->made;
  if (!made.structure && !made.numbers) return Change::Nothing;
  Change change = Change::Nothing;
  if (made.structure) {
    const Result<graph::Graph> flat = impl_->flat(made.options, *made.language);
    if (!flat || graph::programKey(*flat, *made.language) != made.key) return Change::Program;
    if (differInTextures(impl_->graph, made.graph)) change = Change::Textures;
  }
  if (!differInNumbers(impl_->graph, made.graph)) return change;
  return made.options.parameters == Parameters::Baked ? Change::Program : std::max(change, Change::Numbers);
}

}  // namespace lacquer
