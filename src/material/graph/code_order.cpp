// The order in which a graph's nodes become code: a function of what is connected, of terms and of names that
// the library gives, and of nothing else.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "graph/contracts.h"
#include "graph/graph.h"
#include "graph/program_key.h"

namespace lacquer::graph {

namespace {

/// The parameters of a node of a flat graph, which names forms of nodes; none of an unknown node.
std::span<const lang::Param> paramsOf(const Node& node, const lang::Library& library) {
  if (node.group) return {};
  const Result<const lang::NodeDecl*> found = library.node(node.type);
  return found ? std::span<const lang::Param>((*found)->params) : std::span<const lang::Param>();
}

class CodeOrder {
public:
  CodeOrder(const Graph& graph, const lang::Library& library, const Body& body, const Source* also)
      : graph_(graph), library_(library), body_(body), also_(also) {}

  std::vector<size_t> run() {
    by_node_.resize(graph_.nodes.size());
    sources_.reserve(graph_.nodes.size());
    // As the ports ask for them, which also says what nobody asks for.
    const std::vector<size_t> reached = from(ports());
    std::vector<size_t> roots;
    for (const size_t node : reached) {
      if (graph_.nodes[node].place != Node::kAnyPlace) roots.push_back(node);
    }
    if (roots.empty()) return reached;
    std::stable_sort(roots.begin(), roots.end(),
                     [&](size_t a, size_t b) { return graph_.nodes[a].place < graph_.nodes[b].place; });
    roots.insert(roots.end(), reached.begin(), reached.end());
    return from(roots);
  }

private:
  /// A range of sources_.
  struct Places {
    size_t begin, end;
  };

  std::vector<size_t> ports() const {
    std::vector<size_t> nodes;
    if (library_.has(lang::DeclKind::Template, graph_.template_name)) {
      const Result<const lang::TemplateDecl*> decl = library_.template_(graph_.template_name);
      for (size_t i = 0; decl && i < (*decl)->ports.size(); ++i) {
        for (const auto& [name, source] : graph_.outputs) {
          if (name == (*decl)->ports[i].param.name) add(source, nodes);
        }
      }
    }
    if (also_ != nullptr) add(*also_, nodes);
    return nodes;
  }

  void add(const Source& source, std::vector<size_t>& nodes) const {
    const auto* ref = std::get_if<NodeRef>(&source.from);
    const std::optional<size_t> place = ref == nullptr ? std::nullopt : body_.find(ref->node);
    if (place) nodes.push_back(*place);
  }

  /// In the order in which the library declares the inputs; found once for both walks.
  Places sourcesOf(size_t index) {
    std::optional<Places>& places = by_node_[index];
    if (places) return *places;
    const Inputs& inputs = graph_.nodes[index].inputs;
    const std::span<const lang::Param> params = paramsOf(graph_.nodes[index], library_);
    found_.clear();
    size_t expected = 0;
    for (size_t i = 0; i < inputs.size(); ++i) {
      const std::optional<size_t> source = body_.source(index, i);
      const auto named = [&](const lang::Param& param) { return param.name == inputs[i].first; };
      // Inputs mostly stand in the order of the parameters.
      auto param = std::find_if(params.begin() + static_cast<ptrdiff_t>(expected), params.end(), named);
      if (param == params.end()) param = std::find_if(params.begin(), params.end(), named);
      if (param == params.end()) continue;
      expected = static_cast<size_t>(param - params.begin());
      if (source) found_.emplace_back(expected, *source);
    }
    const auto before = [](const auto& a, const auto& b) { return a.first < b.first; };
    if (!std::is_sorted(found_.begin(), found_.end(), before))
      std::stable_sort(found_.begin(), found_.end(), before);
    places = {sources_.size(), sources_.size() + found_.size()};
    for (const auto& [of, source] : found_) sources_.push_back(source);
    return *places;
  }

  /// The roots and what they take values from, sources first; no stack, whatever the graph.
  std::vector<size_t> from(const std::vector<size_t>& roots) {
    struct Visit {
      size_t node;
      Places left;
    };
    std::vector<size_t> order;
    std::vector<uint8_t> seen(graph_.nodes.size(), false);
    std::vector<Visit> path;
    order.reserve(graph_.nodes.size());
    path.reserve(graph_.nodes.size());
    const auto open = [&](size_t node) {
      if (seen[node]) return;
      seen[node] = true;
      path.push_back({node, sourcesOf(node)});
    };
    for (const size_t root : roots) {
      open(root);
      while (!path.empty()) {
        Visit& visit = path.back();
        if (visit.left.begin < visit.left.end) {
          open(sources_[visit.left.begin++]);
        } else {
          order.push_back(visit.node);
          path.pop_back();
        }
      }
    }
    return order;
  }

  const Graph& graph_;
  const lang::Library& library_;
  const Body& body_;
  const Source* also_;
  std::vector<std::pair<size_t, size_t>> found_;  ///< of a node: a parameter's place, and its source's
  std::vector<size_t> sources_;                   ///< the nodes' sources, node by node
  std::vector<std::optional<Places>> by_node_;    ///< each node's sources, once they were asked for
};

}  // namespace

std::vector<size_t> codeOrder(const Graph& graph, const lang::Library& library, const Source* also) {
  const Body body(graph, nullptr);
  return CodeOrder(graph, library, body, also).run();
}

namespace {

/// A text of what a graph's code is made of, in the order of the code.
class ProgramKey {
public:
  ProgramKey(const Graph& graph, const lang::Library& library, bool values)
      : graph_(graph), contracts_(graph, library), values_(values) {
    const std::vector<size_t> order = CodeOrder(graph, library, contracts_.main(), nullptr).run();
    places_.resize(graph.nodes.size());
    for (size_t i = 0; i < order.size(); ++i) places_[order[i]] = i;
    word(graph.template_name);
    std::vector<std::string> attributes = graph.attributes;
    std::sort(attributes.begin(), attributes.end());
    for (const std::string& name : attributes) word(name);
    for (const size_t index : order) node(graph.nodes[index]);
    const lang::TemplateDecl* decl = contracts_.templateDecl();
    for (size_t i = 0; decl != nullptr && i < decl->ports.size(); ++i)
      named(graph.outputs, decl->ports[i].param.name);
  }
  std::string take() { return std::move(key_); }

private:
  void number(uint64_t x) {
    char digits[24];
    key_.append(digits, std::to_chars(digits, std::end(digits), x).ptr);
    key_ += ' ';
  }
  void bits(double x) { number(std::bit_cast<uint64_t>(x)); }
  void bits(const ir::Components& x) {
    for (const double component : x) bits(component);
  }
  void word(std::string_view text) {
    number(text.size());
    key_ += text;
    key_ += ' ';
  }

  void node(const Node& node) {
    key_ += '\n';
    const Contract* contract = contracts_.of(node);
    word(contract != nullptr && contract->decl != nullptr ? std::string_view(contract->decl->name)
                                                          : node.type);
    word(node.variant);
    word(node.term);
    key_ += node.at_vertices ? "v " : "";
    for (size_t i = 0; contract != nullptr && i < contract->params.size(); ++i)
      named(node.inputs, contract->params[i].name);
  }

  void named(const Inputs& sources, std::string_view wanted) {
    for (const auto& [name, source] : sources) {
      if (name != wanted) continue;
      word(name);
      std::visit([this](const auto& from) { this->from(from); }, source.from);
      word(source.swizzle);
    }
  }

  void from(const Literal& literal) {
    word(ir::typeName(literal.type));
    bits(literal.value);
    for (const double x : literal.matrix) bits(x);
  }
  void from(const ParameterRef& ref) {
    word(ref.name);
    const Parameter* p = contracts_.parameter(ref.name);
    if (p == nullptr) return;
    word(ir::typeName(p->type));
    for (const double end : {p->range.lo, p->range.hi, p->range.gap}) bits(end);
    word(p->animated ? "animated" : "");
    bits(p->neutral);
    if (values_ && !p->animated) bits(p->value);
  }
  void from(const TextureRef& ref) {
    word(ref.name);
    const std::optional<size_t> place = graph_.findTexture(ref.name);
    if (!place) return;
    word(ir::typeName(graph_.textures[*place].type));
    word(graph_.textures[*place].srgb ? "srgb" : "");
    const std::optional<ir::Sampler>& sampler = graph_.textures[*place].sampler;
    if (!sampler) return;
    for (const ir::Sampler::Wrap wrap : {sampler->wrap_s, sampler->wrap_t})
      word(kWrapWords[static_cast<size_t>(wrap)]);
    for (const ir::Sampler::Filter filter : {sampler->mag, sampler->min})
      word(kFilterWords[static_cast<size_t>(filter)]);
  }
  void from(const GivenRef& ref) { word("given"), word(ref.name); }
  void from(const AttributeRef& ref) { word("attribute"), word(ref.name), word(ir::typeName(ref.type)); }
  void from(const InputRef& ref) { word("input"), word(ref.name); }
  void from(const Choice& choice) { word("choice"), word(choice.name); }
  void from(const NodeRef& ref) {
    const std::optional<size_t> place = contracts_.main().find(ref.node);
    number(place ? places_[*place] : 0);
    word(ref.output);
  }

  const Graph& graph_;
  Contracts contracts_;
  const bool values_;
  std::vector<size_t> places_;
  std::string key_;
};

}  // namespace

std::string programKey(const Graph& graph, const lang::Library& library) {
  return ProgramKey(graph, library, false).take();
}

std::string programKeyWithValues(const Graph& graph, const lang::Library& library) {
  return ProgramKey(graph, library, true).take();
}

}  // namespace lacquer::graph
