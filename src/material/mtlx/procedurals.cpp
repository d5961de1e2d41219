#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

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

  Element graph(const Json& json, const Path& path);
  /// Those of `procedural_definitions`: definitions, and nodegraphs that name theirs.
  std::vector<Element> definitions(const Json& list, const Path& path);

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
  bool body(const Json& json, const Path& path, Element& graph);
  bool output(const Json& json, const Path& path, Element& port);
  Element definition(const Json& json, const Path& path, const std::string& name);

  const std::string& path_;
  const Limits& limits_;
  const size_t textures_;
  Diagnostics& wrong_;
  std::vector<std::string> nodes_, inputs_;  ///< names by number
  /// Of nodes, by their numbers, the names of the outputs that they list.
  std::vector<std::vector<std::string>> outputs_;
};

/// A value as MaterialX writes it: "1,0.5", "true", a text.
std::string ProceduralReader::textOf(const Json& json) {
  if (json.is_string()) return json::text(json);
  if (json.is_boolean()) return json.get<bool>() ? "true" : "false";
  if (json.is_number()) return json::dump(json);
  std::string text;
  for (const Json& one : json::elements(json)) {
    if (!text.empty()) text += ",";
    if (one.is_array()) {
      for (const Json& inner : json::elements(one)) text += (&inner == &one[0] ? "" : ",") + textOf(inner);
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
        name != nullptr && name->is_string() ? json::text(*name) : fmt::format("{}{}", key, i);
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
    to.set(attribute, json::text(*found));
    return true;
  }
  const bool whole =
      found->is_number_unsigned() || (found->is_number_integer() && found->get<int64_t>() >= 0);
  if (!whole || found->get<uint64_t>() >= names.size())
    return fails(Path(path, key), "wrong-reference",
                 fmt::format("there is no {} {}", key, printable(json::dump(*found))),
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
    std::string text = json::text(*type);
    if (text == "matrix3x3") text = "matrix33";
    if (text == "matrix4x4") text = "matrix44";
    port.set("type", text);
  }
  for (const std::string_view key : {"colorspace", "unit", "unittype"}) {
    const Json* text = json::member(json, key);
    if (text != nullptr && text->is_string() && json::text(*text) != "none") port.set(key, json::text(*text));
  }
  if (const Json* value = json::member(json, "value")) {
    if (value->is_object() || value->is_null())
      return fails(Path(path, "value"), "wrong-type", fmt::format("value is {}", json::describe(*value)),
                   "it is a number, a boolean, a text, or an array of numbers");
    port.set("value", textOf(*value));
  }
  if (const Json* texture = json::member(json, "texture")) {
    if (!texture->is_number_unsigned() && !texture->is_number_integer())
      return fails(Path(path, "texture"), "wrong-type",
                   fmt::format("texture is {}", json::describe(*texture)), "it is the number of a texture");
    if (!texture->is_number_unsigned() || texture->get<uint64_t>() >= textures_)
      return fails(Path(path, "texture"), "wrong-reference",
                   fmt::format("there is no texture {}", printable(json::dump(*texture))),
                   fmt::format("the file has {}", textures_));
    port.set("texture", json::dump(*texture));
  }
  if (!reference(json, path, "node", "nodename", nodes_, port)) return false;
  if (!reference(json, path, "input", "interfacename", inputs_, port)) return false;
  return output(json, path, port);
}

/// Which output of a node a port takes: by its name, or by its place among the outputs that the node lists.
bool ProceduralReader::output(const Json& json, const Path& path, Element& port) {
  const Json* named = json::member(json, "output");
  if (named == nullptr) return true;
  if (named->is_string()) return port.set("output", json::text(*named)), true;
  if (!named->is_number())
    return fails(Path(path, "output"), "wrong-type", fmt::format("output is {}", json::describe(*named)),
                 "it is the name of an output, or its number");
  const auto node = std::find(nodes_.begin(), nodes_.end(), port.get("nodename"));
  const auto place = static_cast<size_t>(node - nodes_.begin());
  if (node == nodes_.end() || outputs_[place].empty()) {
    // Of one that lists none its definition has the order.
    port.set("outputnumber", json::dump(*named));
    return true;
  }
  const std::vector<std::string>& all = outputs_[place];
  if (!named->is_number_unsigned() || named->get<uint64_t>() >= all.size())
    return fails(Path(path, "output"), "wrong-reference",
                 fmt::format("the node {} has no output {}", quote(*node), printable(json::dump(*named))),
                 fmt::format("it lists {}", all.size()));
  port.set("output", all[named->get<uint64_t>()]);
  return true;
}

bool ProceduralReader::node(const Json& json, const Path& path, const std::string& name, Element& into) {
  if (!json.is_object()) return fails(path, "wrong-type", fmt::format("a node is {}", json::describe(json)));
  const Json* type = json::member(json, "nodetype");
  if (type == nullptr || !type->is_string())
    return fails(path, "missing-property", "the node has no \"nodetype\"", "it names a node of MaterialX");
  Element& node = into.children.emplace_back();
  node.category = json::text(*type);
  node.place = placeOf(path);
  node.set("name", name);
  for (const std::string_view key : {"type", "version"}) {
    const Json* text = json::member(json, key);
    if (text != nullptr && text->is_string()) node.set(key, json::text(*text));
  }
  return ports(json, "inputs", path, [&](const Json& one, const std::string& port_name, const Path& at) {
    return port(one, port_name, at, "input", node);
  });
}

/// The nodes and outputs of a graph, whose inputs are known.
bool ProceduralReader::body(const Json& json, const Path& path, Element& graph) {
  const Json* nodes = json::member(json, "nodes");
  if (nodes != nullptr && !nodes->is_array())
    return fails(Path(path, "nodes"), "wrong-type", fmt::format("nodes is {}", json::describe(*nodes)),
                 "it is an array");
  const size_t count = nodes == nullptr ? 0 : nodes->size();
  if (count > limits_.nodes)
    return fails(Path(path, "nodes"), "too-many", fmt::format("the procedural has {} nodes", count),
                 raising("nodes"));
  std::set<std::string, std::less<>> names;
  nodes_.clear();
  outputs_.assign(count, {});
  for (size_t i = 0; i < count; ++i) {
    const Json* name = json::member((*nodes)[i], "name");
    std::string own = name != nullptr && name->is_string() ? json::text(*name) : std::string();
    if (own.empty() || !names.insert(own).second) own += fmt::format("_{}", i);
    nodes_.push_back(std::move(own));
    const Json* outputs = json::member((*nodes)[i], "outputs");
    if (outputs == nullptr || (!outputs->is_object() && !outputs->is_array())) continue;
    (void)ports((*nodes)[i], "outputs", path, [&](const Json&, const std::string& of, const Path&) {
      outputs_[i].push_back(of);
      return true;
    });
  }
  bool good = true;
  for (size_t i = 0; good && i < count; ++i) {
    const Path all(path, "nodes");
    good = node((*nodes)[i], Path(all, i), nodes_[i], graph);
  }
  return good && ports(json, "outputs", path, [&](const Json& one, const std::string& name, const Path& at) {
           return port(one, name, at, "output", graph);
         });
}

Element ProceduralReader::graph(const Json& json, const Path& path) {
  Element graph;
  graph.category = "nodegraph";
  graph.place = placeOf(path);
  nodes_.clear();
  inputs_.clear();
  if (!json.is_object()) {
    fails(path, "wrong-type", fmt::format("the procedural is {}", json::describe(json)), "it is an object");
    return {};
  }
  for (const std::string_view key : {"name", "type"}) {
    const Json* text = json::member(json, key);
    if (text != nullptr && text->is_string()) graph.set(key, json::text(*text));
  }
  bool good = ports(json, "inputs", path, [&](const Json&, const std::string& name, const Path&) {
    inputs_.push_back(name);
    return true;
  });
  good = good && ports(json, "inputs", path, [&](const Json& one, const std::string& name, const Path& at) {
           return port(one, name, at, "input", graph);
         });
  good = good && body(json, path, graph);
  if (good && std::none_of(graph.children.begin(), graph.children.end(),
                           [](const Element& e) { return e.category == "output"; }))
    good = fails(path, "missing-property", "the procedural has no outputs");
  return good ? graph : Element{};
}

Element ProceduralReader::definition(const Json& json, const Path& path, const std::string& name) {
  Element made;
  made.category = "nodedef";
  made.place = placeOf(path);
  made.set("name", name);
  const Json* node = json::member(json, "node");
  if (node == nullptr || !node->is_string()) {
    fails(path, "missing-property", "the definition has no \"node\"", "it is the nodetype of its instances");
    return {};
  }
  made.set("node", json::text(*node));
  const Json* version = json::member(json, "version");
  if (version != nullptr && version->is_string()) made.set("version", json::text(*version));
  const Json* by_default = json::member(json, "defaultVersion");
  if (by_default != nullptr && *by_default == Json(true)) made.set("isdefaultversion", "true");
  nodes_.clear();
  inputs_.clear();
  bool good = true;
  for (const std::string_view category : {"input", "output"}) {
    good = good && ports(json, category == "input" ? "inputs" : "outputs", path,
                         [&](const Json& one, const std::string& port_name, const Path& at) {
                           if (!port(one, port_name, at, category, made)) return false;
                           const Json* given = json::member(one, "defaultgeomprop");
                           if (given != nullptr && given->is_string())
                             made.children.back().set("defaultgeomprop", json::text(*given));
                           return true;
                         });
  }
  return good ? made : Element{};
}

std::vector<Element> ProceduralReader::definitions(const Json& list, const Path& path) {
  const auto isGraph = [&](size_t i) {
    const Json* type = json::member(list[i], "nodetype");
    return type != nullptr && *type == Json("nodegraph");
  };
  std::vector<Element> made(list.size());
  std::set<std::string, std::less<>> names;
  for (size_t i = 0; i < list.size(); ++i) {
    const Path at(path, i);
    const Json* name = json::member(list[i], "name");
    std::string own = name != nullptr && name->is_string() ? json::text(*name) : std::string();
    if (own.empty() || !names.insert(own).second) own += fmt::format("_{}", i);
    const Json* type = json::member(list[i], "nodetype");
    if (!isGraph(i) && (type == nullptr || *type != Json("nodedef"))) {
      fails(at, "wrong-type", "this is no definition", "its nodetype is \"nodedef\" or \"nodegraph\"");
      continue;
    }
    if (!isGraph(i)) made[i] = definition(list[i], at, own);
    if (isGraph(i)) made[i].set("name", own);
  }
  for (size_t i = 0; i < list.size(); ++i) {
    if (!isGraph(i)) continue;
    const Path at(path, i);
    const Json* of = json::member(list[i], "nodedef");
    const auto named = std::find_if(made.begin(), made.end(), [&](const Element& e) {
      return of != nullptr && of->is_string() && e.category == "nodedef" && e.name() == json::text(*of);
    });
    size_t place = static_cast<size_t>(named - made.begin());
    if (of != nullptr && of->is_number_unsigned())
      place = std::min<uint64_t>(of->get<uint64_t>(), made.size());
    Element graph = std::exchange(made[i], {});
    if (place == made.size() || isGraph(place)) {
      const std::string said = of == nullptr ? "no \"nodedef\"" : "the nodedef " + printable(json::dump(*of));
      fails(at, "wrong-reference", fmt::format("the nodegraph has {}", said),
            "it is the number of a definition of this array");
      continue;
    }
    if (made[place].category.empty()) continue;  // it is wrong itself
    graph.category = "nodegraph";
    graph.place = placeOf(at);
    graph.set("nodedef", std::string(made[place].name()));
    inputs_.clear();
    for (const Element& port : made[place].children)
      if (port.category == "input") inputs_.emplace_back(port.name());
    if (body(list[i], at, graph)) made[i] = std::move(graph);
  }
  std::erase_if(made, [](const Element& one) { return one.category.empty(); });
  return made;
}

}  // namespace

ProceduralElements readProcedurals(const Json& extension, const std::string& path, const Limits& limits,
                                   size_t textures, Diagnostics& wrong) {
  ProceduralElements read;
  const Path root;
  const Path extensions(root, "extensions");
  const Path own(extensions, "KHR_texture_procedurals");
  const auto listed = [&](std::string_view key) {
    const Json* list = json::member(extension, key);
    return list != nullptr && list->is_array() ? list : nullptr;
  };
  const auto isNoArray = [&](std::string_view key) {
    wrong.push_back({"missing-property",
                     Severity::Error,
                     {path, 0, 0, own.text()},
                     fmt::format("KHR_texture_procedurals has no array {}", quote(key)),
                     {},
                     {}});
  };
  constexpr std::string_view kDefinitions = "procedural_definitions";
  const Json* definitions = listed(kDefinitions);
  if (definitions == nullptr && json::member(extension, kDefinitions) != nullptr) isNoArray(kDefinitions);
  if (definitions != nullptr)
    read.definitions =
        ProceduralReader(path, limits, textures, wrong).definitions(*definitions, Path(own, kDefinitions));
  const Json* list = listed("procedurals");
  if (list == nullptr) return isNoArray("procedurals"), read;
  const Path all(own, "procedurals");
  for (size_t i = 0; i < list->size(); ++i)
    read.list.push_back(ProceduralReader(path, limits, textures, wrong).graph((*list)[i], Path(all, i)));
  return read;
}

}  // namespace lacquer::materialx
