// Texts of a document: they decide what the graph is, and which image a texture has.
#include <fmt/format.h>

#include <utility>

#include "graph/text.h"
#include "materialx/patterns.h"
#include "support/text.h"

namespace lacquer::materialx {

using graph::Source;

namespace {

constexpr size_t kMostNodesOfTexts = 64;
constexpr size_t kDeepestDefinitions = 64;           ///< that a file is handed down through
constexpr uint64_t kMostCopied = uint64_t{1} << 20;  ///< elements of nodegraphs that are made again

bool isText(const Element& element) {
  return element.get("type") == "string" || element.get("type") == "filename";
}

}  // namespace

/// What a `geomprop` of the documents says of a property: of no geometry in particular, so only where all say
/// the same. Null where none says anything.
const Element* Patterns::propertyOf(const Element& node, std::string_view name) {
  const Element* found = nullptr;
  for (const Element* document : documents_) {
    for (const Element& info : document->children) {
      const Element* property = info.category == "geominfo" ? info.child("geomprop", name) : nullptr;
      if (property == nullptr || !isText(*property)) continue;
      if (found != nullptr && found->get("value") != property->get("value")) {
        warning(node, "texts-differ", fmt::format("{} differs from geometry to geometry", quote(name)),
                "a material has one text: the default is taken");
        return nullptr;
      }
      found = property;
    }
  }
  return found;
}

/// The element that has the text of an input as its value: itself, the interface's input, or that of a node
/// which gives texts. Null, and an error, where the text is not known.
const Element* Patterns::text(Scope& within, const Element& input) {
  Scope* scope = &within;
  const Element* at = &input;
  const auto outside = [&](const Element& port) -> std::optional<Referred> {
    Referred referred{nullptr, std::string(port.get("output")), {}};
    const std::string_view name = port.get(port.find("nodegraph") != nullptr ? "nodegraph" : "nodename");
    for (const Element* document : documents_) {
      if (referred.element == nullptr) referred.element = nodeOf(*document, name);
    }
    if (referred.element != nullptr) return referred;
    error(port, "no-such-node",
          fmt::format("{} is connected to {}, which is not there", quote(port.name()), quote(name)));
    return std::nullopt;
  };
  for (size_t steps = 0; steps < kMostNodesOfTexts; ++steps) {
    if (const std::string* name = at->find("interfacename")) {
      const Element* next = scope->input(*name);
      if (next == nullptr && scope->interface_ == nullptr) next = scope->owner_->child("input", *name);
      if (next == nullptr || next == at) {
        error(*at, "unknown-input", fmt::format("there is no interface input {}", quote(*name)));
        return nullptr;
      }
      at = next;
      continue;
    }
    if (!isConnected(*at)) return at;
    // Inputs of a nodegraph are connected to what stands beside it.
    const bool own = scope->interface_ == nullptr || scope->input(at->name()) != at;
    const std::optional<Referred> referred = own ? find(*scope, *at) : outside(*at);
    if (!referred) return nullptr;
    const Element& node = *referred->element;
    const Element* next = nullptr;
    if (node.category == "output") {
      next = &node;
    } else if (node.category == "nodegraph") {
      (void)group(node);
      scope = groups_.at(&node);
      for (const Element& port : node.children) {
        const bool wanted = referred->output.empty() || referred->output == port.name();
        if (port.category == "output" && wanted && next == nullptr) next = &port;
      }
    } else if (node.category == "constant" && isText(node)) {
      next = node.child("input", "value");
    } else if (node.category == "dot" && isText(node)) {
      next = node.child("input", "in");
    } else if (isText(node) &&
               (node.category == "geompropvalueuniform" || node.category == "UsdPrimvarReader")) {
      const bool usd = node.category == "UsdPrimvarReader";
      const Element* property = node.child("input", usd ? "varname" : "geomprop");
      const Element* name = property == nullptr ? nullptr : text(*scope, *property);
      next = name == nullptr ? nullptr : propertyOf(node, name->get("value"));
      if (next == nullptr) next = node.child("input", usd ? "fallback" : "default");
    } else {
      error(*at, "no-text",
            fmt::format("{} takes a text, and {} gives none", quote(input.name()), quote(node.category)),
            "constant, dot and geompropvalueuniform give texts, which are known before anything is computed");
      return nullptr;
    }
    // A node's own default is no text.
    static const Element kEmpty{"input", {}, {}, {}};
    if (next == nullptr) return &kEmpty;
    at = next;
  }
  error(input, "too-deep",
        fmt::format("{} nodes of texts stand behind each other, or in a circle", kMostNodesOfTexts));
  return nullptr;
}

/// The element that has the value of a token: itself, or that of the interface. Null, and an error, where the
/// interface has none of the name.
const Element* Patterns::tokenOf(const Scope& scope, const Element& token) {
  const std::string* name = token.find("interfacename");
  if (name == nullptr) return &token;
  const Element& interface = scope.interface_ == nullptr ? *scope.owner_ : *scope.interface_;
  const Element* found = interface.child("token", *name);
  if (found != nullptr && found->find("interfacename") == nullptr) return found;
  error(token, "unknown-token", fmt::format("there is no interface token {}", quote(*name)));
  return nullptr;
}

/// The definition of a node that the document defines, with the texts that this one is given: they decide
/// what the graph is, so that each choice of them is a definition of its own. Null for other nodes.
const Element* Patterns::definitionFor(Scope& scope, const Element& element) {
  const Element* nodedef = definitionOf(element);
  if (nodedef == nullptr) return nullptr;
  checkDefinition(*nodedef);
  Given given;
  for (const Element& input : element.children) {
    const bool token = input.category == "token";
    const Element* port =
        token || input.category == "input" ? nodedef->child(input.category, input.name()) : nullptr;
    if (port == nullptr) continue;
    if (port->get("type") == "filename" && isConverted(input.get("colorspace")))
      given.files.push_back({port->name(), "colorspace", input.get("colorspace")});
    if (port->get("type") == "filename" && !input.get("unit").empty())
      given.files.push_back({port->name(), "unit", input.get("unit")});
    if (!token && port->get("type") != "string") continue;
    const Element* said = token ? tokenOf(scope, input) : text(scope, input);
    if (said == nullptr || said->get("value") == port->get("value")) continue;
    given.texts.emplace_back(port, said->get("value"));
  }
  return definitionWith(*nodedef, given, element);
}

/// The definition with these texts and what is said of files, which the nodes in its graph convert. `at`: who
/// asks for it.
const Element* Patterns::definitionWith(const Element& nodedef, const Given& given, const Element& at) {
  const Definition of = *definition(nodedef);
  const bool first = of.graph == nullptr || by_graph_.at(of.graph) == by_nodedef_.at(&nodedef);
  if ((given.texts.empty() && given.files.empty() && first) || of.graph == nullptr) return &nodedef;
  std::string key = fmt::format("{} {}", nodedef.get("node"), nodedef.name());
  for (const Given::OfFile& one : given.files)
    key += fmt::format("\n{} {} {}", one.input, one.attribute, one.value);
  for (const auto& [port, value] : given.texts)
    key += fmt::format("\n{} {}\n{}", port->category, port->name(), value);
  const auto [it, fresh] = with_texts_.try_emplace(std::move(key), &nodedef);
  if (!fresh) return it->second;
  copied_ += countOfElements(*of.graph);
  if (copied_ > kMostCopied) {
    error(at, "too-many",
          fmt::format("definitions with other texts, or that share a nodegraph, are more than {} elements",
                      kMostCopied),
          "a nodegraph is made for each choice of the texts of its definition");
    return &nodedef;
  }
  Element& made = made_.emplace_back(nodedef);
  for (Element& port : made.children) {
    for (const auto& [text_of, value] : given.texts) {
      if (port.category == text_of->category && port.name() == text_of->name()) port.set("value", value);
    }
  }
  Element& body = made_.emplace_back(*of.graph);
  for (Element& node : body.children) {
    for (Element& input : node.children) {
      for (const Given::OfFile& one : given.files)
        if (input.get("interfacename") == one.input) input.set(one.attribute, std::string(one.value));
    }
  }
  by_nodedef_.emplace(&made, definitions_.size());
  by_graph_.emplace(&body, definitions_.size());
  definitions_.push_back({&made, &body, of.model});
  return it->second = &made;
}

/// An attribute of the vertices by the text that names it. glTF begins the application's names with an
/// underscore. A definition that names none by default has what stands for a missing one.
std::optional<Source> Patterns::attribute(Scope& scope, const Element& element, const Element& input,
                                          const lang::Param& param) {
  const ir::Type type = param.type;
  const Element* from = text(scope, input);
  if (from == nullptr) return std::nullopt;
  const std::string_view said = from->get("value");
  if (said.empty() && from != &input) {
    const Element* otherwise =
        element.child("input", element.category == "geompropvalue" ? "default" : "fallback");
    if (otherwise != nullptr && isConnected(*otherwise)) return connected(scope, *otherwise);
    if (otherwise != nullptr && otherwise->find("value") != nullptr)
      return literal(scope, element, *otherwise, param);
    return Source{graph::Literal{type == ir::Type::Int ? ir::Type::Float : type, {}}, {}};
  }
  std::string name(said);
  if (!graph::isAttributeName(name)) name = "_" + graphName(said);
  if (said.empty() || !graph::isAttributeName(name)) {
    error(input, "wrong-name", fmt::format("{} is {}", quote(input.name()), quote(said)),
          "it names an attribute of the vertices: wetness for glTF's _WETNESS or _wetness, COLOR_1");
    return std::nullopt;
  }
  if (options_.has_attributes && !graph_.hasAttribute(name)) graph_.attributes.push_back(name);
  return Source{graph::AttributeRef{std::move(name), type}, {}};
}

/// What names of files have in the place of "<kind>": what all geometry says alike of a token, else its
/// default.
void Patterns::defineTokens() {
  std::set<std::string_view> differing;
  std::map<std::string_view, std::string_view> defaults;
  for (const Element* document : documents_) {
    for (const Element& one : document->children) {
      if (one.category == "tokendefault") defaults.try_emplace(one.name(), one.get("value"));
      if (one.category != "geominfo") continue;
      for (const Element& token : one.children) {
        if (token.category != "token") continue;
        const auto [it, fresh] = geometry_tokens_.try_emplace(token.name(), token.get("value"));
        if (!fresh && it->second != token.get("value")) differing.insert(token.name());
      }
    }
  }
  for (const std::string_view name : differing) geometry_tokens_.erase(name);
  geometry_tokens_.insert(defaults.begin(), defaults.end());
}

std::string Patterns::withGeometryTokens(std::string_view file) const {
  std::string made;
  while (true) {
    const size_t begin = file.find('<');
    const size_t end = begin == std::string_view::npos ? begin : file.find('>', begin);
    made += file.substr(0, begin);
    if (begin == std::string_view::npos) return made;
    if (end == std::string_view::npos) return made += file.substr(begin);
    const auto token = geometry_tokens_.find(file.substr(begin + 1, end - begin - 1));
    made += token == geometry_tokens_.end() ? file.substr(begin, end - begin + 1) : token->second;
    file.remove_prefix(end + 1);
  }
}

/// The file's name with tokens in place of their names: of what takes it, the node first, and of what that is
/// in.
std::string Patterns::fileOf(const Scope& scope, std::vector<const Element*> owners, const Element& input) {
  std::string file(trimmed(input.get("value")));
  // A definition's tokens, as its instances say them.
  if (scope.interface_ != nullptr && scope.interface_ != scope.owner_) owners.push_back(scope.interface_);
  owners.push_back(scope.owner_);
  owners.insert(owners.end(), documents_.begin(), documents_.end());
  for (const Element* owner : owners) {
    for (const Element& token : owner->children) {
      if (token.category != "token") continue;
      const std::string name = fmt::format("[{}]", token.name());
      const size_t at = file.find(name);
      const Element* said = at == std::string::npos ? nullptr : tokenOf(scope, token);
      if (said != nullptr) file.replace(at, name.size(), said->get("value"));
    }
  }
  file = withGeometryTokens(file);
  // A document names files, a graph has URIs.
  for (size_t at = file.find('%'); at != std::string::npos; at = file.find('%', at + 3))
    file.replace(at, 1, "%25");
  return file;
}

/// Says which names of tokens are left in a file's name.
void Patterns::checkTokens(const Element& input, std::string_view file) {
  for (size_t at = 0; (at = file.find_first_of("[<", at)) != std::string_view::npos; ++at) {
    const size_t end = file.find(file[at] == '[' ? ']' : '>', at);
    const std::string_view name = file.substr(at, end - at + 1);
    if (end == std::string_view::npos || name == graph::tileToken(file)) continue;
    warning(input, "unknown-token", fmt::format("there is no token {}", quote(name)),
            name[0] == '[' ? "its name stays: a \"token\" of the nodegraph or of its definition says it"
                           : "its name stays: a \"token\" of a geominfo or a \"tokendefault\" says it");
  }
}

/// Whether a group's interface, and not the node itself, says which image an input of type filename has.
bool Patterns::isOfInstances(const Scope& scope, const Element& input) const {
  const std::string* name = input.find("interfacename");
  return name != nullptr && scope.interface_ != nullptr && scope.interface_ != scope.owner_ &&
         scope.input(*name) != nullptr;
}

/// Whether an input of type filename is an image for each tile.
bool Patterns::hasTiles(Scope& scope, const Element& node, const Element& input) {
  if (isOfInstances(scope, input)) {
    const std::string name = graphName(input.get("interfacename"));
    const auto& inputs = scope.group_.inputs;
    return std::any_of(inputs.begin(), inputs.end(), [&](const graph::GroupInput& one) {
      return one.name == name && one.type == ir::Type::Texture2DArray;
    });
  }
  const Element* from = text(scope, input);
  return from != nullptr && from->find("texture") == nullptr &&
         !graph::tileToken(fileOf(scope, {&node}, *from)).empty();
}

/// Whether all that an interface's input goes to takes images of tiles.
bool Patterns::goesToTiles(const Element& owner, std::string_view name) const {
  for (const Element& node : owner.children) {
    for (const Element& input : node.children) {
      if (input.category == "input" && input.get("interfacename") == name &&
          (definitionOf(node) != nullptr || !takesTiles(node.category)))
        return false;
    }
  }
  return true;
}

/// Along which axes an image ends at its edge, in the words of the nodes: "none", "u", "v" or "both".
std::string_view Patterns::endsOf(Scope& scope, const Element& element) {
  const auto ends = [&](std::string_view name, std::string_view usd) {
    const Element* mode = element.child("input", name);
    if (mode == nullptr) mode = element.child("input", usd);
    const Element* said = mode == nullptr ? nullptr : text(scope, *mode);
    return said != nullptr && (said->get("value") == "constant" || said->get("value") == "black");
  };
  const bool u = ends("uaddressmode", "wrapS"), v = ends("vaddressmode", "wrapT");
  return u ? (v ? "both" : "u") : (v ? "v" : "none");
}

/// MaterialX's own, where a document says none.
static ir::Components defaultColor(std::string_view category) {
  if (category.ends_with("normalmap")) return {0.5, 0.5, 1, 1};
  return {0, 0, 0, category == "UsdUVTexture" ? 1.0 : 0.0};
}

/// One of a few words, which an input says; empty where it says none.
std::string_view Patterns::choice(Scope& scope, const Element& element, std::string_view name,
                                  std::span<const std::string_view> words) {
  const Element* input = element.child("input", name);
  const Element* said = input == nullptr ? nullptr : text(scope, *input);
  const std::string_view value = said == nullptr ? std::string_view() : said->get("value");
  if (!value.empty() && std::find(words.begin(), words.end(), value) == words.end())
    error(*said, "wrong-value", fmt::format("the value of {} is {}", quote(name), quote(value)),
          "it must be " + listOf(words, "or"));
  return value;
}

/// The node that samples the file of a body's input: the first one there, or in the definition that the input
/// goes to. Without such a node the input itself.
Patterns::Sampling Patterns::samplingOf(Scope& body, const Element& input) {
  for (const Element& node : body.owner_->children) {
    const auto takes = std::find_if(node.children.begin(), node.children.end(), [&](const Element& one) {
      return one.category == "input" && one.get("interfacename") == input.name();
    });
    if (takes == node.children.end()) continue;
    Scope* const outer = std::exchange(now_, &body);
    const Element* nodedef = definitionFor(body, node);
    now_ = outer;
    const Element* graph = nodedef == nullptr ? nullptr : definition(*nodedef)->graph;
    if (graph == nullptr) return {&body, &node};
    if (samplings_ == kDeepestDefinitions) break;
    ++samplings_;
    (void)group(*graph);
    const Sampling found = samplingOf(*groups_.at(graph), *takes);
    --samplings_;
    return found;
  }
  return {&body, &input};
}

/// An image. `tiles`: what takes it has a place for an image of each tile. `holders`: what has the tokens of
/// its name, before those of the body.
std::optional<Source> Patterns::image(Scope& scope, const Sampling& by, const Element& input, bool tiles,
                                      std::vector<const Element*> holders) {
  const Element& element = *by.node;
  if (isOfInstances(scope, input)) return connected(scope, input);
  const Element* from = text(scope, input);
  if (from == nullptr) return std::nullopt;
  graph::Texture texture;
  const std::string_view type = element.get("type");
  const bool color = type == "color3" || type == "color4" || type == "multioutput";
  const std::string_view space = from->get("colorspace");
  texture.srgb = color && (space == "srgb_texture" || space == "srgb_rec709_scene");
  if (const std::string* number = from->find("texture")) {
    const std::optional<std::vector<double>> index = numbersOf(*number);
    texture.texture = index && (*index)[0] >= 0 && (*index)[0] < 1e9 ? static_cast<int>((*index)[0]) : -1;
    texture.own_sampler = true;
  } else {
    texture.file = fileOf(scope, std::move(holders), *from);
    checkTokens(*from, texture.file);
  }
  const bool tiled = !graph::tileToken(texture.file).empty();
  if (tiled && tiles) {
    texture.type = ir::Type::Texture2DArray;
  } else if (tiled) {
    warning(input, "first-tile", fmt::format("{} is an image for each tile", quote(from->get("value"))),
            "this node takes the first one for all");
    texture.file = graph::tileFile(texture.file, 0);
  }
  const auto wrapOf = [&](std::string_view name, std::string_view usd) {
    constexpr std::string_view kModes[] = {"periodic", "clamp", "mirror",     "constant",
                                           "repeat",   "black", "useMetadata"};
    const bool own = element.child("input", name) != nullptr;
    const std::string_view value = choice(*by.scope, element, own ? name : usd, kModes);
    if (texture.type == ir::Type::Texture2DArray) return graph::Wrap::Clamp;  // at the edges of tiles
    return value == "clamp" || value == "constant" || value == "black" ? graph::Wrap::Clamp
           : value == "mirror"                                         ? graph::Wrap::Mirror
                                                                       : graph::Wrap::Repeat;
  };
  texture.wrap = {wrapOf("uaddressmode", "wrapS"), wrapOf("vaddressmode", "wrapT")};
  constexpr std::string_view kFilters[] = {"linear", "closest", "cubic"};
  texture.nearest = choice(*by.scope, element, "filtertype", kFilters) == "closest";
  const Element* fallback = element.child("input", "default");
  if (fallback == nullptr) fallback = element.child("input", "fallback");
  ir::Components color_of = defaultColor(element.category);
  if (fallback != nullptr && fallback->find("value") != nullptr) {
    const std::optional<ir::Type> of = typeOf(fallback->get("type"));
    const Result<ir::Components> value =
        of ? valueOf(*fallback, *of, units_) : Result<ir::Components>(ir::Components{});
    if (value) color_of = *value;
    if (of == ir::Type::Float) color_of = {color_of[0], color_of[0], color_of[0], 1};
    if (of == ir::Type::Vec3) color_of[3] = 1;
  }
  texture.color = color_of;
  texture.place = from->place;
  texture.pointer = from->place.pointer.empty() ? fmt::format("/{}/{}", scope.group_.name, element.name())
                                                : from->place.pointer;
  // A texture of the glTF file is one, whatever each node has where it cannot be read: the first one's
  // counts.
  std::string key = fmt::format(
      "{} {} {} {} {} {} {}", texture.file, texture.texture, texture.srgb, static_cast<int>(texture.wrap[0]),
      static_cast<int>(texture.wrap[1]), texture.nearest,
      texture.texture < 0 ? fmt::format("{} {} {} {}", color_of[0], color_of[1], color_of[2], color_of[3])
                          : std::string());
  const auto [it, fresh] = textures_.try_emplace(std::move(key));
  if (fresh) {
    texture.name = it->second =
        texture_names_.free(graphName(element.name().empty() ? input.name() : element.name()) + "_image");
    graph_.textures.push_back(std::move(texture));
  }
  return Source{graph::TextureRef{it->second}, {}};
}

/// The geometric property of a name, by a `geompropdef` of the documents or MaterialX's own. Nothing where
/// the name is neither, or an attribute of the application.
std::optional<Patterns::OfGeometry> Patterns::geometryOf(std::string_view name) const {
  constexpr std::pair<std::string_view, std::string_view> kNodes[] = {
      {"P", "position"}, {"N", "normal"}, {"T", "tangent"}, {"B", "bitangent"}, {"V", "viewdirection"}};
  constexpr std::string_view kSpaces[] = {"object", "model", "world"};
  OfGeometry made;
  if (const Element* found = propertyNamed(name)) {
    const std::string_view space = found->get("space");
    made.node = found->get("geomprop");
    made.space = space.empty() ? std::string_view("object") : space;
    made.index = found->get("index");
  }
  for (const auto& [letter, node] : kNodes) {
    if (!made.node.empty() || !name.starts_with(letter)) continue;
    const auto space = std::find(std::begin(kSpaces), std::end(kSpaces), name.substr(1));
    if (space != std::end(kSpaces)) made.node = node, made.space = *space;
  }
  if (made.node.empty() && (name == "UV0" || name == "UV1"))
    made.node = "texcoord", made.index = name.substr(2);
  const bool known = std::any_of(std::begin(kNodes), std::end(kNodes),
                                 [&](const auto& one) { return one.second == made.node; }) &&
                     std::find(std::begin(kSpaces), std::end(kSpaces), made.space) != std::end(kSpaces);
  if (made.node == "texcoord") {
    made.given = fmt::format("uv{}", made.index.empty() ? std::string_view("0") : made.index);
    if (made.given.size() == 3 && made.given[2] >= '0' && made.given[2] <= '3') return made;
  } else if (known) {
    if (made.space == "world" && made.node != "bitangent" && made.node != "viewdirection")
      made.given = made.node;
    return made;
  }
  return std::nullopt;
}

/// The `geompropdef` of a name, which may stand behind a namespace; null for none.
const Element* Patterns::propertyNamed(std::string_view name) const {
  auto found = geomprops_.find(name);
  if (found == geomprops_.end()) found = geomprops_.find(name.substr(name.rfind(':') + 1));
  return found == geomprops_.end() ? nullptr : found->second;
}

/// The geometric property that is an input's default. Nothing, and an error, for an unknown name.
std::optional<Patterns::OfGeometry> Patterns::ofGeometry(const Element& input) {
  const std::string_view name = input.get("defaultgeomprop");
  if (name.empty()) return std::nullopt;
  std::optional<OfGeometry> made = geometryOf(name);
  if (!made)
    error(
        input, "unknown-geomprop", fmt::format("there is no geometric property {}", quote(name)),
        "it must be Pobject, Nobject, Tobject, Bobject, Pworld, Nworld, Tworld, Bworld, Vworld, UV0 or UV1, "
        "or a geompropdef of position, normal, tangent, bitangent, viewdirection or texcoord");
  return made;
}

/// The node that a `geompropvalue` stands for, which asks for a standard property by the name of one; the
/// element itself where it asks for an attribute.
const Element& Patterns::standardProperty(Scope& scope, const Element& element) {
  const Element* asked = element.category == "geompropvalue" ? element.child("input", "geomprop") : nullptr;
  const Element* said = asked == nullptr ? nullptr : text(scope, *asked);
  std::optional<OfGeometry> of = said == nullptr ? std::nullopt : geometryOf(said->get("value"));
  const Element* own = said == nullptr ? nullptr : propertyNamed(said->get("value"));
  if (own != nullptr && own->get("geomprop") == "geomcolor")
    of = OfGeometry{"geomcolor", {}, std::string(own->get("index")), {}};
  if (!of) return element;
  Element& made = made_.emplace_back();
  made.category = of->node;
  made.place = element.place;
  made.attributes = element.attributes;
  const auto give = [&](std::string_view name, std::string_view type, std::string_view value) {
    if (value.empty()) return;
    Element& input = made.children.emplace_back();
    input.category = "input";
    input.place = asked->place;
    input.set("name", std::string(name));
    input.set("type", std::string(type));
    input.set("value", std::string(value));
  };
  give("space", "string", of->index.empty() ? std::string_view(of->space) : std::string_view());
  give("index", "integer", of->index);
  return made;
}

}  // namespace lacquer::materialx
