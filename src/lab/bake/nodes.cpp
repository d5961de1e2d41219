#include "bake/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "exchange/graph_out.h"
#include "graph/contracts.h"
#include "support/text.h"

namespace lacquer::baking {

namespace {

using graph::Source;

bool fitsTexel(ir::Type type) { return !ir::isMatrix(type) && !ir::isTexture(type); }

/// What a value depends on, of all that it is made of.
struct Depends {
  bool varies = false;     ///< on texture coordinates
  bool elsewhere = false;  ///< on the view, the light, the geometry
};

Depends ofGiven(std::string_view name) {
  const bool uv = name.starts_with("uv") || name.starts_with("TEXCOORD_");
  return {uv, !uv};
}

/// The path of what gives a value of a flat graph, before which instances of groups stand: "rust/mix" for the
/// node "rust.mix" there. An instance that hands the value on is named where nothing else has it.
std::string pathOf(const graph::FlatOutputs& outputs, const graph::NodeRef& ref) {
  const Source wanted{ref, {}};
  std::string found;
  for (const auto& [path, of] : outputs) {
    for (const auto& [output, source] : of) {
      if (source != wanted) continue;
      const std::string name = of.size() == 1 ? path : path + "." + output;
      std::string id = path;
      std::replace(id.begin(), id.end(), '/', '.');
      if (id == ref.node) return name;
      if (found.empty() || output == ref.output) found = name;
    }
  }
  if (!found.empty()) return found;
  return ref.output.empty() ? ref.node : ref.node + "." + ref.output;
}

/// Of a flat, checked graph.
class Patterns {
public:
  Patterns(const Nodes& nodes, const Language& library, bool materialx)
      : graph_(nodes.flat),
        outputs_(nodes.outputs),
        contracts_(nodes.flat, library),
        materialx_(materialx),
        of_(nodes.flat.nodes.size()) {
    const graph::Graph& graph = nodes.flat;
    for (const size_t place : contracts_.main().order().order) of_[place] = ofNode(graph.nodes[place]);
  }

  Strings names() const {
    Strings names;
    const auto take = [&](const Source& source) {
      const auto* ref = std::get_if<graph::NodeRef>(&source.from);
      const std::optional<size_t> place = ref == nullptr ? std::nullopt : contracts_.main().find(ref->node);
      if (!place || !of_[*place].varies || of_[*place].elsewhere) return;
      const std::optional<graph::Offer> offer = contracts_.base(source, contracts_.main());
      if (!offer || !fitsTexel(offer->type)) return;
      std::string name = pathOf(outputs_, *ref);
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
    };
    for (size_t i = 0; i < graph_.nodes.size(); ++i) {
      if (!of_[i].elsewhere) continue;
      for (const auto& [input, source] : graph_.nodes[i].inputs) take(source);
    }
    for (const auto& [port, source] : graph_.outputs) take(source);
    return names;
  }

private:
  Depends ofNode(const graph::Node& node) const {
    Depends all;
    const auto add = [&](const Depends& one) {
      all.varies = all.varies || one.varies;
      all.elsewhere = all.elsewhere || one.elsewhere;
    };
    for (const auto& [input, source] : node.inputs) add(ofSource(source));
    const graph::Contract* contract = contracts_.of(node);
    if (materialx_ && !exchange::isOfMaterialX(contract)) all.elsewhere = true;
    for (size_t i = 0; contract != nullptr && i < contract->params.size(); ++i) {
      const lang::Param& param = contract->params[i];
      const bool connected = std::any_of(node.inputs.begin(), node.inputs.end(),
                                         [&](const auto& input) { return input.first == param.name; });
      if (!connected && !param.given.empty()) add(ofGiven(param.given));
    }
    return all;
  }

  Depends ofSource(const Source& source) const {
    if (const auto* given = std::get_if<graph::GivenRef>(&source.from)) return ofGiven(given->name);
    if (const auto* attribute = std::get_if<graph::AttributeRef>(&source.from))
      return ofGiven(attribute->name);
    if (const auto* texture = std::get_if<graph::TextureRef>(&source.from))
      return {false, !graph_.findTexture(texture->name)};
    const auto* ref = std::get_if<graph::NodeRef>(&source.from);
    const std::optional<size_t> place = ref == nullptr ? std::nullopt : contracts_.main().find(ref->node);
    return place ? of_[*place] : Depends{};
  }

  const graph::Graph& graph_;
  const graph::FlatOutputs& outputs_;
  const graph::Contracts contracts_;
  const bool materialx_;
  std::vector<Depends> of_;
};

/// The one name that ends like this, between dots; the name itself where there is none, which looking it up
/// then says; an error where there are several.
Result<std::string> fullName(const std::string& wanted, const Strings& all) {
  Strings found;
  for (const std::string& name : all) {
    if (name == wanted) return wanted;
    if (name.ends_with("." + wanted)) found.push_back(name);
  }
  if (found.empty()) return wanted;
  if (found.size() == 1) return found[0];
  return fail("no-such-node", {}, fmt::format("{} may be any of {} nodes", quote(wanted), found.size()),
              "name one: " + listOf(std::vector<std::string_view>(found.begin(), found.end())));
}

}  // namespace

Result<Nodes> nodesOf(const EvalSubject& subject, const Strings& wanted, bool materialx,
                      const Language& library, Options options) {
  options.ibl = false;
  if (Result<void> named = subject.isGraph() ? Result<void>() : resolveNames(library, options); !named)
    return tl::make_unexpected(std::move(named.error()));
  Nodes nodes;
  Diagnostics warnings;
  Result<graph::Graph> built =
      subject.built({true, true, true, {true, true, true, true}}, library, options, warnings, &nodes.outputs);
  if (!built) return tl::make_unexpected(built.error());
  nodes.flat = std::move(*built);
  if (wanted.empty()) {
    nodes.names = Patterns(nodes, library, materialx).names();
    return nodes;
  }
  Strings all;
  const graph::Contracts contracts(nodes.flat, library);
  for (const auto& [node, of] : nodes.outputs) {
    for (const auto& [output, source] : of) {
      const std::optional<graph::Offer> offer = contracts.offer(source, contracts.main());
      if (offer && fitsTexel(offer->type)) all.push_back(of.size() == 1 ? node : node + "." + output);
    }
  }
  for (const std::string& one : wanted) {
    if (one == "*") {
      nodes.names.insert(nodes.names.end(), all.begin(), all.end());
      continue;
    }
    Result<std::string> name = fullName(one, all);
    if (!name) return tl::make_unexpected(std::move(name.error()));
    nodes.names.push_back(std::move(*name));
  }
  std::set<std::string> seen;
  std::erase_if(nodes.names, [&](const std::string& name) { return !seen.insert(name).second; });
  return nodes;
}

bool isMaterialX(const graph::Graph& flat, const graph::Source& source, const Language& library) {
  const graph::Contracts contracts(flat, library);
  std::vector<bool> seen(flat.nodes.size(), false);
  std::vector<size_t> open;
  const auto reach = [&](const graph::Source& from) {
    const auto* ref = std::get_if<graph::NodeRef>(&from.from);
    const std::optional<size_t> place = ref == nullptr ? std::nullopt : contracts.main().find(ref->node);
    if (!place || seen[*place]) return;
    seen[*place] = true;
    open.push_back(*place);
  };
  reach(source);
  while (!open.empty()) {
    const graph::Node& node = flat.nodes[open.back()];
    open.pop_back();
    if (!exchange::isOfMaterialX(contracts.of(node)) && !node.type.starts_with("texel_")) return false;
    for (const auto& [input, from] : node.inputs) reach(from);
  }
  return true;
}

}  // namespace lacquer::baking
