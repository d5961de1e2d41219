#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "json/path.h"
#include "mtlx/element.h"
#include "support/text.h"

namespace lacquer::materialx {

namespace {

using json::Json;
using json::Path;

/// A procedural in any of its spellings: ports as an object by name or as an array with `name`, references
/// by name or by number, one number alone or in an array.
class ProceduralReader {
public:
  ProceduralReader(const std::string& path, const Limits& limits, size_t textures, Diagnostics& wrong)
      : path_(path), limits_(limits), textures_(textures), wrong_(wrong) {}

  Element graph(const Json& json, const Path& path, bool definition);

private:
  bool fails(const Path& at, std::string code, std::string message, std::string help = {}) {
    addBounded(wrong_, {std::move(code),
                        Severity::Error,
                        {path_, 0, 0, at.text()},
                        std::move(message),
                        std::move(help),
                        {}});
    return false;
  }
  Place placeOf(const Path& at) const { return {path_, 0, 0, at.text()}; }
  static std::string textOf(const Json& json);
  template <class Each>
  bool ports(const Json& owner, std::string_view key, const Path& path, Each each);
  bool port(const Json& json, std::string_view name, const Path& path, std::string_view category,
            Element& into);
  bool reference(const Json& json, const Path& path, std::string_view key, std::string_view attribute,
                 const std::vector<std::string>& names, Element& to);
  bool node(const Json& json, const Path& path, const std::string& name, Element& into);

  const std::string& path_;
  const Limits& limits_;
  const size_t textures_;
  Diagnostics& wrong_;
  std::vector<std::string> nodes_, inputs_;  ///< names by number
};

/// A value as MaterialX writes it: "1,0.5", "true", a text.
std::string ProceduralReader::textOf(const Json& json) {
  if (json.is_string()) return json.text();
  if (json.is_boolean()) return json.get<bool>() ? "true" : "false";
  if (json.is_number()) return json.dump();
  std::string text;
  for (const Json& one : json) {
    if (!text.empty()) text += ",";
    if (one.is_array()) {
      for (const Json& inner : one) text += (&inner == one.begin() ? "" : ",") + textOf(inner);
    } else {
      text += textOf(one);
    }
  }
  return text;
}

template <class Each>
bool ProceduralReader::ports(const Json& owner, std::string_view key, const Path& path, Each each) {
  const Json* list = json::member(owner, key);
  if (list == nullptr) return true;
  const Path at(path, key);
  if (list->is_object()) {
    for (const auto& [name, one] : list->items()) {
      if (!each(one, std::string(name), Path(at, name))) return false;
    }
    return true;
  }
  if (!list->is_array())
    return fails(at, "wrong-type", fmt::format("{} is {}", key, json::describe(*list)),
                 "it is an object by name, or an array of objects with a \"name\"");
  for (size_t i = 0; i < list->size(); ++i) {
    const Json& one = (*list)[i];
    const Json* name = json::member(one, "name");
    const std::string given =
        name != nullptr && name->is_string() ? name->text() : fmt::format("{}{}", key, i);
    if (!each(one, given, Path(at, i))) return false;
  }
  return true;
}

bool ProceduralReader::reference(const Json& json, const Path& path, std::string_view key,
                                 std::string_view attribute, const std::vector<std::string>& names,
                                 Element& to) {
  const Json* found = json::member(json, key);
  if (found == nullptr) return true;
  if (found->is_string()) {
    to.set(attribute, found->text());
    return true;
  }
  const bool whole =
      found->is_number_unsigned() || (found->is_number_integer() && found->get<int64_t>() >= 0);
  if (!whole || found->get<uint64_t>() >= names.size())
    return fails(Path(path, key), "wrong-reference",
                 fmt::format("there is no {} {}", key, printable(found->dump())),
                 fmt::format("there are {}", names.size()));
  to.set(attribute, names[found->get<uint64_t>()]);
  return true;
}

bool ProceduralReader::port(const Json& json, std::string_view name, const Path& path,
                            std::string_view category, Element& into) {
  if (!json.is_object())
    return fails(path, "wrong-type", fmt::format("{} is {}", category, json::describe(json)),
                 "it is an object");
  Element& port = into.children.emplace_back();
  port.category = category;
  port.place = placeOf(path);
  port.set("name", std::string(name));
  const Json* type = json::member(json, "type");
  if (type != nullptr && type->is_string()) {
    std::string text = type->text();
    if (text == "matrix3x3") text = "matrix33";
    if (text == "matrix4x4") text = "matrix44";
    port.set("type", text);
  }
  for (const std::string_view key : {"colorspace", "unit", "unittype"}) {
    const Json* text = json::member(json, key);
    if (text != nullptr && text->is_string() && text->text() != "none") port.set(key, text->text());
  }
  if (const Json* value = json::member(json, "value")) port.set("value", textOf(*value));
  if (const Json* texture = json::member(json, "texture")) {
    if (!texture->is_number_unsigned() && !texture->is_number_integer())
      return fails(Path(path, "texture"), "wrong-type",
                   fmt::format("texture is {}", json::describe(*texture)), "it is the number of a texture");
    if (!texture->is_number_unsigned() || texture->get<uint64_t>() >= textures_)
      return fails(Path(path, "texture"), "wrong-reference",
                   fmt::format("there is no texture {}", printable(texture->dump())),
                   fmt::format("the file has {}", textures_));
    port.set("texture", texture->dump());
  }
  if (!reference(json, path, "node", "nodename", nodes_, port)) return false;
  if (!reference(json, path, "input", "interfacename", inputs_, port)) return false;
  const Json* output = json::member(json, "output");
  if (output != nullptr && output->is_string()) port.set("output", output->text());
  // A number here is that of an output of the node it is taken from, which has it by name or alone.
  if (output != nullptr && output->is_number()) port.set("outputnumber", output->dump());
  return true;
}

bool ProceduralReader::node(const Json& json, const Path& path, const std::string& name, Element& into) {
  if (!json.is_object()) return fails(path, "wrong-type", fmt::format("a node is {}", json::describe(json)));
  const Json* type = json::member(json, "nodetype");
  if (type == nullptr || !type->is_string())
    return fails(path, "missing-property", "the node has no \"nodetype\"", "it names a node of MaterialX");
  Element& node = into.children.emplace_back();
  node.category = type->text();
  node.place = placeOf(path);
  node.set("name", name);
  if (const Json* out = json::member(json, "type"); out != nullptr && out->is_string())
    node.set("type", out->text());
  return ports(json, "inputs", path, [&](const Json& one, const std::string& port_name, const Path& at) {
    return port(one, port_name, at, "input", node);
  });
}

Element ProceduralReader::graph(const Json& json, const Path& path, bool definition) {
  const size_t before = wrong_.size();
  Element graph;
  graph.category = "nodegraph";
  graph.place = placeOf(path);
  nodes_.clear();
  inputs_.clear();
  if (!json.is_object()) {
    fails(path, "wrong-type", fmt::format("the procedural is {}", json::describe(json)), "it is an object");
    return {};
  }
  for (const std::string_view key : {"name", "type", "nodedef"}) {
    const Json* text = json::member(json, key);
    if (text != nullptr && text->is_string()) graph.set(key, text->text());
  }
  const Json* nodes = json::member(json, "nodes");
  if (nodes != nullptr && !nodes->is_array()) {
    fails(Path(path, "nodes"), "wrong-type", fmt::format("nodes is {}", json::describe(*nodes)),
          "it is an array");
    return {};
  }
  const size_t count = nodes == nullptr ? 0 : nodes->size();
  if (count > limits_.nodes) {
    fails(Path(path, "nodes"), "too-many", fmt::format("the procedural has {} nodes", count),
          raising("nodes"));
    return {};
  }
  std::set<std::string, std::less<>> names;
  for (size_t i = 0; i < count; ++i) {
    const Json* name = json::member((*nodes)[i], "name");
    std::string own = name != nullptr && name->is_string() ? name->text() : std::string();
    if (own.empty() || !names.insert(own).second) own += fmt::format("_{}", i);
    nodes_.push_back(std::move(own));
  }
  bool good = ports(json, "inputs", path, [&](const Json&, const std::string& name, const Path&) {
    inputs_.push_back(name);
    return true;
  });
  good = good && ports(json, "inputs", path, [&](const Json& one, const std::string& name, const Path& at) {
           return port(one, name, at, "input", graph);
         });
  for (size_t i = 0; good && i < count; ++i) {
    const Path all(path, "nodes");
    good = node((*nodes)[i], Path(all, i), nodes_[i], graph);
  }
  good = good && ports(json, "outputs", path, [&](const Json& one, const std::string& name, const Path& at) {
           return port(one, name, at, "output", graph);
         });
  if (good && !definition && std::none_of(graph.children.begin(), graph.children.end(), [](const Element& e) {
        return e.category == "output";
      }))
    fails(path, "missing-property", "the procedural has no outputs");
  return wrong_.size() == before ? graph : Element{};
}

}  // namespace

std::vector<Element> readProcedurals(const Json& extension, const std::string& path, const Limits& limits,
                                     size_t textures, Diagnostics& wrong) {
  std::vector<Element> graphs;
  const Path root;
  const Path extensions(root, "extensions");
  const Path own(extensions, "KHR_texture_procedurals");
  const Json* list = json::member(extension, "procedurals");
  if (list == nullptr || !list->is_array()) {
    wrong.push_back({"missing-property",
                     Severity::Error,
                     {path, 0, 0, own.text()},
                     "KHR_texture_procedurals has no array \"procedurals\"",
                     {},
                     {}});
    return graphs;
  }
  const Path all(own, "procedurals");
  for (size_t i = 0; i < list->size(); ++i)
    graphs.push_back(ProceduralReader(path, limits, textures, wrong).graph((*list)[i], Path(all, i), false));
  return graphs;
}

}  // namespace lacquer::materialx
