#include "mtlx/upgrade.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "mtlx/names.h"
#include "mtlx/values.h"
#include "support/text.h"

namespace lacquer::materialx {

Element nodeAt(const Place& place, std::string_view category, std::string_view name, std::string_view type) {
  Element made;
  made.category = category;
  made.place = place;
  made.set("name", std::string(name));
  if (!type.empty()) made.set("type", std::string(type));
  return made;
}

Element& addInput(Element& node, std::string_view name, std::string_view type, std::string_view value) {
  Element made = nodeAt(node.place, "input", name, type);
  if (!value.empty()) made.set("value", std::string(value));
  return node.children.emplace_back(std::move(made));
}

Element& connectInput(Element& node, std::string_view name, std::string_view type, std::string_view to,
                      std::string_view output) {
  Element& made = addInput(node, name, type, {});
  made.set("nodename", std::string(to));
  if (!output.empty()) made.set("output", std::string(output));
  return made;
}

Element* inputOf(Element& node, std::string_view name) {
  for (Element& child : node.children) {
    if (child.category == "input" && child.name() == name) return &child;
  }
  return nullptr;
}

namespace {

constexpr std::string_view kConnections[] = {"nodename", "nodegraph", "output", "outputnumber",
                                             "interfacename"};

void eraseAttribute(Element& element, std::string_view attribute) {
  std::erase_if(element.attributes, [&](const auto& one) { return one.first == attribute; });
}

/// Nodegraphs and definitions of a document by their names.
using Named = std::unordered_map<std::string, Element*>;

/// The nodes of a document or of a nodegraph, from 1.38 to 1.39.
class From38 {
public:
  From38(const Named& named, Element& scope, size_t first, Diagnostics& said)
      : named_(named), scope_(scope), first_(first), said_(said) {
    for (size_t i = 0; i < scope.children.size(); ++i) {
      names_.take(std::string(scope.children[i].name()));
      places_.emplace(scope.children[i].name(), i);
    }
  }

  void run() {
    for (size_t i = first_; i < scope_.children.size(); ++i) node(scope_.children[i]);
    for (size_t i = first_; i < scope_.children.size(); ++i) channels(scope_.children[i]);
    thinFilms();
    places_.clear();
    for (Element& one : more_) scope_.children.push_back(std::move(one));
  }

private:
  void warn(const Element& at, std::string message, std::string help) {
    addBounded(said_, {"not-upgraded", Severity::Warning, at.place, std::move(message), std::move(help), {}});
  }
  Element* beside(std::string_view name) {
    const auto it = places_.find(std::string(name));
    return it == places_.end() ? nullptr : &scope_.children[it->second];
  }
  void node(Element& element);
  void normalMap(Element& element);
  void radius(Element& element);
  void swizzle(Element& element);
  bool swizzled(Element& into, const Element& in, std::string_view channels);
  std::string sourceType(const Element& input);
  void channels(Element& element);
  void ofChannels(Element& input);
  void thinFilms();
  const Element* named(std::string_view category, std::string_view name) const {
    const auto it = named_.find(std::string(name));
    return it == named_.end() || it->second->category != category ? nullptr : it->second;
  }
  using Layers = std::map<std::string, Element, std::less<>>;  ///< and what stands for them
  struct Below {
    Named nodes;                                   ///< beside each other
    std::unordered_map<const Element*, bool> put;  ///< whether there was something for a film
  };
  bool putFilm(Below& below, std::string_view name, const Element& film, size_t depth);
  Below& belowOf(Element& scope);
  void resolve(Layers& layers) const;
  void redirect(const Layers& layers);

  const Named& named_;
  Element& scope_;
  size_t first_;
  Diagnostics& said_;
  NameSet names_;
  std::unordered_map<std::string, size_t> places_;
  std::vector<Element> more_;
  std::unordered_map<const Element*, Below> below_;
  std::map<std::string, std::string> made_channels_;  ///< nodes for them, by what is connected and how
};

void From38::node(Element& element) {
  if (element.category == "normalmap") return normalMap(element);
  if (element.category == "subsurface_bsdf") return radius(element);
  if (element.category == "swizzle") return swizzle(element);
  if (element.category == "time")  // the application's seconds, whatever its frames are
    std::erase_if(element.children, [](const Element& e) { return e.name() == "fps"; });
  if (element.category != "atan2") return;
  for (const auto& [old, now] : {std::pair("in1", "iny"), std::pair("in2", "inx")}) {
    if (Element* in = inputOf(element, old)) in->set("name", now);
  }
}

/// In the space of the object a map has the normal itself.
void From38::normalMap(Element& element) {
  if (element.get("nodedef") == "ND_normalmap") element.set("nodedef", "ND_normalmap_float");
  const Element* space = element.child("input", "space");
  if (space == nullptr) return;
  const std::string* interface = space->find("interfacename");
  const Element* said = interface == nullptr ? space : scope_.child("input", *interface);
  if (said == nullptr || isConnected(*said))
    warn(*space, "the space of the normal map is connected", "it is taken for the tangent space");
  const bool object = said != nullptr && said->get("value") == "object";
  std::erase_if(element.children, [](const Element& e) { return e.name() == "space"; });
  if (!object) return;
  const std::string doubled = names_.free(fmt::format("{}_doubled", element.name()));
  const std::string centred = names_.free(fmt::format("{}_centred", element.name()));
  const Element* in = element.child("input", "in");
  Element multiply = nodeAt(element.place, "multiply", doubled, "vector3");
  if (in == nullptr) addInput(multiply, "in1", "vector3", "0.5, 0.5, 1");
  if (in != nullptr) multiply.children.push_back(*in), multiply.children.back().set("name", "in1");
  addInput(multiply, "in2", "float", "2");
  Element subtract = nodeAt(element.place, "subtract", centred, "vector3");
  connectInput(subtract, "in1", "vector3", doubled);
  addInput(subtract, "in2", "float", "1");
  element.category = "normalize";
  eraseAttribute(element, "nodedef");
  element.children.clear();
  connectInput(element, "in", "vector3", centred);
  more_.push_back(std::move(multiply));
  more_.push_back(std::move(subtract));
}

/// The radius below a surface has become a colour, whose numbers are of no colour space.
void From38::radius(Element& element) {
  Element* in = inputOf(element, "radius");
  if (in == nullptr || in->get("type") != "vector3") return;
  if (!isConnected(*in)) {
    in->set("type", "color3");
    return in->set("colorspace", "none");
  }
  const std::string name = names_.free(fmt::format("{}_radius", element.name()));
  Element convert = nodeAt(element.place, "convert", name, "color3");
  convert.children.push_back(*in);
  convert.children.back().set("name", "in");
  for (const std::string_view attribute : kConnections) eraseAttribute(*in, attribute);
  in->set("type", "color3");
  in->set("nodename", name);
  more_.push_back(std::move(convert));
}

// -- channels --

void From38::swizzle(Element& element) {
  const Element* in = element.child("input", "in");
  const Element* channels = element.child("input", "channels");
  if (in == nullptr || channels == nullptr) return;
  Element source = *in;
  if (!swizzled(element, source, std::string(channels->get("value")))) return;  // said where it is taken
  eraseAttribute(element, "nodedef");
}

/// Makes of a node what takes these channels of an input; false where they are none of its type.
bool From38::swizzled(Element& into, const Element& in, std::string_view channels) {
  const std::string type(into.get("type"));
  const std::string from(in.get("type"));
  const std::optional<ir::Type> to_type = typeOf(type), from_type = typeOf(from);
  const auto isPlain = [](std::optional<ir::Type> t) {
    return t && (*t == ir::Type::Float || ir::isFloatVector(*t));
  };
  if (!isPlain(to_type) || !isPlain(from_type)) return false;
  const auto count = static_cast<size_t>(ir::componentCount(*to_type));
  const auto had = static_cast<size_t>(ir::componentCount(*from_type));
  if (channels.size() != count) return false;
  std::vector<size_t> places;  // beyond the components: 0 and 1
  for (const char c : channels) {
    const size_t color = std::string_view("rgba").find(c), vector = std::string_view("xyzw").find(c);
    if (c == '0' || c == '1')
      places.push_back(c == '0' ? 4 : 5);
    else
      places.push_back(std::min(color, vector));
    if (places.back() > 5 || (places.back() < 4 && places.back() >= had)) return false;
  }
  const auto letter = [](size_t place, bool color) {
    return std::string(1, (color ? std::string_view("rgba") : std::string_view("xyzw"))[place]);
  };
  const auto number = [](size_t place) { return place == 4 ? "0" : "1"; };
  bool same = count == had;
  for (size_t i = 0; i < count; ++i) same = same && places[i] == i;
  into.children.clear();
  if (count == 1 && places[0] > 3) {
    into.category = "constant";
    addInput(into, "value", type, number(places[0]));
  } else if (same) {
    into.category = type == from ? "dot" : "convert";
    into.children.push_back(in);
    into.children.back().set("name", "in");
  } else if (count == 1) {
    into.category = "extract";
    into.children.push_back(in);
    into.children.back().set("name", "in");
    addInput(into, "index", "integer", fmt::format("{}", places[0]));
  } else {
    std::string separate;
    if (had > 1) {
      separate = names_.free(fmt::format("{}_separate", into.name()));
      Element& made =
          more_.emplace_back(nodeAt(into.place, fmt::format("separate{}", had), separate, "multioutput"));
      made.children.push_back(in);
      made.children.back().set("name", "in");
    }
    into.category = fmt::format("combine{}", count);
    for (size_t i = 0; i < count; ++i) {
      const std::string name = fmt::format("in{}", i + 1);
      if (places[i] > 3) {
        addInput(into, name, "float", number(places[i]));
      } else if (had > 1) {
        connectInput(into, name, "float", separate, "out" + letter(places[i], from.starts_with("color")));
      } else {
        into.children.push_back(in);
        into.children.back().set("name", name);
      }
    }
  }
  return true;
}

/// The type of what an input is connected to; empty where that is not said.
std::string From38::sourceType(const Element& input) {
  if (const std::string* interface = input.find("interfacename")) {
    const Element* port = scope_.child("input", *interface);
    if (port == nullptr && !scope_.get("nodedef").empty()) {
      const Element* nodedef = named("nodedef", scope_.get("nodedef"));
      port = nodedef == nullptr ? nullptr : nodedef->child("input", *interface);
    }
    return port == nullptr ? std::string() : std::string(port->get("type"));
  }
  const std::string* graph = input.find("nodegraph");
  const Element* node = graph != nullptr ? named("nodegraph", *graph) : beside(input.get("nodename"));
  if (graph == nullptr && input.get("nodename").empty()) node = &scope_;
  if (node == nullptr) return {};
  const bool outputs = node->category == "nodegraph" || node == &scope_ || node->get("type") == "multioutput";
  if (!outputs) return std::string(node->get("type"));
  for (const Element& output : node->children) {
    const bool wanted = input.get("output").empty() || output.name() == input.get("output");
    if (output.category == "output" && wanted) return std::string(output.get("type"));
  }
  return {};
}

void From38::channels(Element& element) {
  ofChannels(element);
  for (Element& child : element.children) {
    if (element.category != "nodegraph" && child.category == "input") ofChannels(child);
  }
}

/// A node of its own for the channels of a connection.
void From38::ofChannels(Element& input) {
  const std::string channels(input.get("channels"));
  if (channels.empty() || (input.category != "input" && input.category != "output")) return;
  const std::string from = sourceType(input);
  std::string key = fmt::format("{} {} {}", from, input.get("type"), channels);
  for (const std::string_view one : kConnections) key += fmt::format(" {}", input.get(one));
  std::string& name = made_channels_[key];
  if (name.empty()) {
    const std::string wish = input.find("nodename") != nullptr    ? std::string(input.get("nodename"))
                             : input.find("nodegraph") != nullptr ? std::string(input.get("nodegraph"))
                                                                  : std::string(input.get("interfacename"));
    Element node =
        nodeAt(input.place, "swizzle", names_.free(fmt::format("{}_{}", wish, channels)), input.get("type"));
    Element in = nodeAt(input.place, "input", "in", from);
    for (const std::string_view one : kConnections) {
      if (const std::string* value = input.find(one)) in.set(one, *value);
    }
    if (!swizzled(node, in, channels)) return;
    name = node.name();
    more_.push_back(std::move(node));
  }
  for (const std::string_view one : kConnections) eraseAttribute(input, one);
  eraseAttribute(input, "channels");
  input.set("nodename", name);
}

// -- thin films --

From38::Below& From38::belowOf(Element& scope) {
  const auto [it, fresh] = below_.try_emplace(&scope);
  for (Element& child : scope.children) {
    if (fresh) it->second.nodes.emplace(child.name(), &child);
  }
  return it->second;
}

/// A film has become inputs of what it lies on, through what combines such. A node that has a film keeps it.
bool From38::putFilm(Below& below, std::string_view name, const Element& film, size_t depth) {
  constexpr size_t kDeepest = 64;
  constexpr std::string_view kFilmed[] = {"dielectric_bsdf", "conductor_bsdf", "generalized_schlick_bsdf"};
  constexpr std::string_view kThrough[] = {"layer", "mix", "add", "multiply"};
  const auto it = below.nodes.find(std::string(name));
  if (depth == kDeepest || it == below.nodes.end()) return false;
  Element& node = *it->second;
  const auto [known, fresh] = below.put.try_emplace(&node, false);
  if (!fresh) return known->second;
  bool any = false;
  if (std::find(std::begin(kFilmed), std::end(kFilmed), node.category) != std::end(kFilmed)) {
    any = true;
    for (const auto& [old, now, by_default] :
         {std::tuple("thickness", "thinfilm_thickness", "550"), std::tuple("ior", "thinfilm_ior", "1.5")}) {
      if (node.child("input", now) != nullptr) continue;
      const Element* in = film.child("input", old);
      if (in == nullptr) addInput(node, now, "float", by_default);
      if (in != nullptr) node.children.push_back(*in), node.children.back().set("name", now);
    }
  } else if (std::find(std::begin(kThrough), std::end(kThrough), node.category) != std::end(kThrough)) {
    for (const Element& input : node.children) {
      if (input.get("type") == "BSDF" && !input.get("nodename").empty())
        any = putFilm(below, input.get("nodename"), film, depth + 1) || any;
    }
  }
  below.put[&node] = any;
  return any;
}

void From38::thinFilms() {
  Layers layers;
  for (size_t i = first_; i < scope_.children.size(); ++i) {
    const Element& layer = scope_.children[i];
    const Element* top = layer.category == "layer" ? layer.child("input", "top") : nullptr;
    const Element* base = layer.category == "layer" ? layer.child("input", "base") : nullptr;
    const Element* film = top == nullptr ? nullptr : beside(top->get("nodename"));
    if (base == nullptr || film == nullptr || film->category != "thin_film_bsdf") continue;
    layers.emplace(layer.name(), *base);
    const std::string* graph = base->find("nodegraph");
    bool put = graph == nullptr && putFilm(belowOf(scope_), base->get("nodename"), *film, 0);
    const auto inside = graph == nullptr ? named_.end() : named_.find(*graph);
    const bool connected = std::any_of(film->children.begin(), film->children.end(), isConnected);
    if (inside != named_.end() && !connected) {
      for (const Element& output : inside->second->children) {
        if (output.category == "output" && output.get("type") == "BSDF")
          put = putFilm(belowOf(*inside->second), output.get("nodename"), *film, 0) || put;
      }
    }
    if (!put)
      warn(*film, fmt::format("the thin film {} lies on nothing that can have one", quote(film->name())),
           "it is left out: since 1.39 it is thinfilm_thickness and thinfilm_ior of a dielectric_bsdf, a "
           "conductor_bsdf or a generalized_schlick_bsdf");
  }
  if (layers.empty()) return;
  resolve(layers);
  redirect(layers);
}

/// A layer on a layer stands for what lies below both.
void From38::resolve(Layers& layers) const {
  std::set<const Element*> whole;
  for (auto& [name, base] : layers) {
    std::vector<Element*> path;
    Element* at = &base;
    while (whole.insert(at).second) {
      path.push_back(at);
      const auto next = layers.find(at->get("nodename"));
      if (next == layers.end() || at->find("nodename") == nullptr) break;
      at = &next->second;
    }
    const Element last = *at;
    for (Element* one : path) *one = last;
  }
}

/// What took such a layer takes what lies below its film. Films that nothing takes any more go.
void From38::redirect(const Layers& layers) {
  std::set<std::string, std::less<>> taken;
  const auto of = [&](Element& port) {
    const auto it = port.find("nodename") == nullptr ? layers.end() : layers.find(port.get("nodename"));
    if (it != layers.end()) {
      for (const std::string_view one : kConnections) eraseAttribute(port, one);
      for (const std::string_view one : kConnections) {
        if (const std::string* value = it->second.find(one)) port.set(one, *value);
      }
    }
    taken.emplace(port.get("nodename"));
  };
  for (Element& child : scope_.children) {
    if (layers.contains(child.name())) continue;
    if (child.category == "output") of(child);
    for (Element& port : child.children) {
      if (child.category != "nodegraph") of(port);
    }
  }
  places_.clear();
  std::erase_if(scope_.children, [&](const Element& child) {
    return layers.contains(child.name()) ||
           (child.category == "thin_film_bsdf" && !taken.contains(child.name()));
  });
}

}  // namespace

void upgrade(Element& root, size_t first, int minor, Diagnostics& said) {
  if (minor >= kPresentMinor) return;
  if (minor < kPresentMinor - 1) upgradeTo38(root, first, minor, said);
  Named named;
  for (Element& child : root.children) {
    if (child.category == "nodegraph" || child.category == "nodedef") named.emplace(child.name(), &child);
  }
  for (size_t i = first; i < root.children.size(); ++i) {
    Element& child = root.children[i];
    if (child.category == "nodegraph") From38(named, child, 0, said).run();
  }
  From38(named, root, first, said).run();
}

}  // namespace lacquer::materialx
