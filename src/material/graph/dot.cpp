// A graph as GraphViz draws it: data flows from left to right.
#include <fmt/format.h>

#include <map>

#include "graph/graph.h"
#include "support/text.h"

namespace lacquer::graph {

namespace {

/// Text inside an HTML-like label, which must be UTF-8 and on one line.
std::string html(std::string_view text) {
  std::string out;
  for (const char c : printable(text)) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

/// Text inside double quotes. A backslash would begin an escape sequence.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : printable(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string components(ir::Type type, const ir::Components& value) {
  if (type == ir::Type::Bool) return value[0] != 0 ? "true" : "false";
  std::string text;
  const int count = ir::isFloatVector(type) ? ir::componentCount(type) : 1;
  for (int i = 0; i < count; ++i)
    text += fmt::format("{}{}", i == 0 ? "" : ", ", value[static_cast<size_t>(i)]);
  return count == 1 ? text : "(" + text + ")";
}

std::string written(const Literal& literal) {
  if (!ir::isMatrix(literal.type)) return components(literal.type, literal.value);
  return fmt::format("({})", fmt::join(literal.matrix, ", "));
}

class DotWriter {
public:
  explicit DotWriter(const Graph& graph) : graph_(graph) {}

  std::string run() {
    text_ = fmt::format("digraph {} {{\n", quoted(graph_.name));
    text_ += "  rankdir=LR;\n";
    text_ += "  node [shape=plain, fontname=\"Helvetica\", fontsize=11];\n";
    text_ += "  edge [fontname=\"Helvetica\", fontsize=9, color=\"#555555\"];\n";
    for (size_t i = 0; i < graph_.parameters.size(); ++i) {
      const ir::Parameter& p = graph_.parameters[i];
      leaf("parameter", p.name, fmt::format("p{}", i),
           fmt::format("{}<br/>{} {}", html(p.name), ir::typeName(p.type), components(p.type, p.value)),
           "#e2f0d9");
    }
    for (size_t i = 0; i < graph_.textures.size(); ++i) {
      const ir::TextureSlot& t = graph_.textures[i];
      std::string label =
          fmt::format("{}<br/>{}{}", html(t.name), ir::typeName(t.type), t.srgb ? ", sRGB" : "");
      if (t.texture >= 0) label += fmt::format(", texture {}", t.texture);
      leaf("texture", t.name, fmt::format("t{}", i), label, "#fff2cc");
    }
    for (size_t g = 0; g < graph_.groups.size(); ++g) cluster(g);
    scope_.clear();
    body(graph_.nodes, "n");
    box("out", fmt::format("<b>{}</b><br/>template", html(graph_.template_name)), "#f8cecc", graph_.outputs);
    return text_ + edges_ + "}\n";
  }

private:
  /// A group's definition, in a frame.
  void cluster(size_t index) {
    const Group& group = graph_.groups[index];
    text_ += fmt::format("  subgraph {} {{\n  label={};\n", quoted(fmt::format("cluster_{}", index)),
                         quoted("group " + group.name));
    scope_ = fmt::format("g{}_", index);
    for (size_t i = 0; i < group.inputs.size(); ++i) {
      leaf("input", group.inputs[i].name, fmt::format("{}i{}", scope_, i),
           fmt::format("{}<br/>{}", html(group.inputs[i].name), ir::typeName(group.inputs[i].type)),
           "#e1d5e7");
    }
    body(group.nodes, scope_ + "n");
    box(scope_ + "out", fmt::format("<b>{}</b><br/>outputs", html(group.name)), "#f8cecc", group.outputs);
    text_ += "  }\n";
  }

  void body(const std::vector<Node>& nodes, const std::string& prefix) {
    for (size_t i = 0; i < nodes.size(); ++i)
      ids_.emplace(key("node", nodes[i].id), fmt::format("{}{}", prefix, i));
    for (size_t i = 0; i < nodes.size(); ++i) {
      const Node& node = nodes[i];
      const std::string variant = node.variant.empty() ? "" : fmt::format(", {}", html(node.variant));
      box(fmt::format("{}{}", prefix, i),
          fmt::format("<b>{}</b><br/>{}{}{}", html(node.id), node.group ? "group " : "", html(node.type),
                      variant),
          "#dae8fc", node.inputs);
    }
  }

  /// Nodes and inputs are seen where they stand alone.
  std::string key(std::string_view kind, std::string_view name) const {
    const bool here = kind == "node" || kind == "input";
    return fmt::format("{}{} {}", here ? scope_ : "", kind, name);
  }

  void leaf(std::string_view kind, std::string_view name, const std::string& id, std::string_view label,
            std::string_view color) {
    ids_.emplace(key(kind, name), id);
    text_ += fmt::format("  {} [shape=box, style=\"rounded,filled\", fillcolor=\"{}\", label=<{}>];\n", id,
                         color, label);
  }

  /// A table with a row for each input, to which the edges lead.
  void box(const std::string& id, std::string_view head, std::string_view color,
           const std::vector<std::pair<std::string, Source>>& inputs) {
    std::string rows = fmt::format("<tr><td bgcolor=\"{}\">{}</td></tr>", color, head);
    for (size_t i = 0; i < inputs.size(); ++i) {
      const auto& [name, source] = inputs[i];
      std::string row = html(name);
      if (const auto* literal = std::get_if<Literal>(&source.from)) {
        row += " = " + written(*literal);
        if (!source.swizzle.empty()) row += "." + html(source.swizzle);
      } else {
        edge(source, fmt::format("{}:i{}", id, i));
      }
      rows += fmt::format("<tr><td align=\"left\" port=\"i{}\">{}</td></tr>", i, row);
    }
    text_ += fmt::format(
        "  {} [label=<<table border=\"0\" cellborder=\"1\" cellspacing=\"0\" "
        "cellpadding=\"4\">{}</table>>];\n",
        id, rows);
  }

  void edge(const Source& source, const std::string& to) {
    std::string label;
    std::string from;
    if (const auto* ref = std::get_if<NodeRef>(&source.from)) {
      from = idOf("node", ref->node);
      label = ref->output;
    } else if (const auto* p = std::get_if<ParameterRef>(&source.from)) {
      from = idOf("parameter", p->name);
    } else if (const auto* t = std::get_if<TextureRef>(&source.from)) {
      from = idOf("texture", t->name);
    } else if (const auto* g = std::get_if<GivenRef>(&source.from)) {
      from = idOf("given", g->name);
    } else if (const auto* a = std::get_if<AttributeRef>(&source.from)) {
      from = idOf("attribute", a->name);
    } else if (const auto* i = std::get_if<InputRef>(&source.from)) {
      from = idOf("input", i->name);
    }
    if (!source.swizzle.empty()) label += "." + source.swizzle;
    edges_ += fmt::format("  {} -> {}", from, to);
    edges_ += label.empty() ? ";\n" : fmt::format(" [label={}];\n", quoted(label));
  }

  /// What the template gives has no list in the graph and gets its leaf at the first use. So do names that
  /// the graph lacks, marked as such: a texture may be the template's, a parameter or a node is missing.
  std::string idOf(std::string_view kind, const std::string& name) {
    const auto it = ids_.find(key(kind, name));
    if (it != ids_.end()) return it->second;
    std::string id = fmt::format("g{}", others_++);
    if (kind == "given" || kind == "attribute")
      leaf(kind, name, id, html(name), "#e1d5e7");
    else if (kind == "texture")
      leaf(kind, name, id, html(name) + "<br/>environment", "#e1d5e7");
    else
      leaf(kind, name, id, fmt::format("no {} {}", kind, html(name)), "#ff9999");
    return id;
  }

  const Graph& graph_;
  std::string text_, edges_;
  std::string scope_;                                    ///< begins the ids of what is in a group
  std::map<std::string, std::string, std::less<>> ids_;  ///< by key()
  size_t others_ = 0;
};

}  // namespace

std::string toDot(const Graph& graph) { return DotWriter(graph).run(); }

}  // namespace lacquer::graph
