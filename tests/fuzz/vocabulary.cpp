#include "vocabulary.h"

#include <algorithm>
#include <cmath>

#include "setting/language.h"

namespace lacquer::fuzz {

namespace {

using Random = std::mt19937_64;

size_t below(Random& random, size_t n) { return n == 0 ? 0 : random() % n; }
bool yes(Random& random, unsigned one_in) { return random() % one_in == 0; }

const Language& library() {
  static const std::shared_ptr<const Language> kLibrary = *libraryFor({});
  return *kLibrary;
}

/// A number of the range, often one of its ends, now and then one outside.
double numberOf(const ir::Range& range, Random& random) {
  const double low = std::isfinite(range.lo) ? range.lo : -10;
  const double high = std::isfinite(range.hi) ? range.hi : std::max(low, 0.0) + 10;
  switch (below(random, 16)) {
    case 0: return high + 1;
    case 1: return low - 1;
    case 2:
    case 3: return low;
    case 4:
    case 5: return high;
    case 6: return range.gap > 0 ? 0 : low;
    case 7: return low + (high - low) * 1e-6;
    default: return low + (high - low) * static_cast<double>(random() % 1024) / 1024;
  }
}

Json valueOf(ir::Type type, const ir::Range& range, Random& random) {
  if (type == ir::Type::Bool) return yes(random, 2);
  const int n = ir::componentCount(type);
  if (n == 1) return numberOf(range, random);
  Json list = Json::array();
  for (int i = 0; i < n; ++i) list.push_back(numberOf(range, random));
  return list;
}

// -- materials --

Json textureOf(const lang::PropertyDecl& decl, size_t textures, Random& random) {
  Json info = {{"index", below(random, textures)}};
  if (yes(random, 3)) info["texCoord"] = below(random, 5);
  if (yes(random, 4)) {
    info["extensions"]["KHR_texture_transform"] = {{"rotation", static_cast<double>(random() % 7)},
                                                   {"scale", {2, yes(random, 4) ? 0.0 : 0.5}}};
  }
  for (const lang::PropertyDecl& member : decl.members) {
    if (yes(random, 2)) info[std::string(member.name)] = valueOf(member.type, member.range, random);
  }
  return info;
}

Json* walk(Json& material, const std::string& path, std::string& last) {
  Json* at = &material;
  size_t from = 0;
  for (size_t slash = path.find('/'); slash != std::string::npos; slash = path.find('/', from)) {
    at = &(*at)[path.substr(from, slash - from)];
    if (!at->is_object() && !at->is_null()) return nullptr;
    from = slash + 1;
  }
  last = path.substr(from);
  return at;
}

}  // namespace

void changeMaterial(Json& gltf, Random& random) {
  if (!gltf.is_object()) return;
  // All of the file's own lists first: a new one moves the others.
  for (const char* list : {"textures", "materials"}) {
    if (!gltf[list].is_array()) gltf[list] = Json::array();
  }
  while (gltf["textures"].size() < 2) gltf["textures"].push_back(Json::object());
  const size_t textures = gltf["textures"].size();
  Json& materials = gltf["materials"];
  if (materials.empty() || (materials.size() < 3 && yes(random, 16))) materials.push_back(Json::object());
  Json& material = materials[below(random, materials.size())];
  if (!material.is_object()) material = Json::object();
  if (yes(random, 6) && material.contains("extensions") && material["extensions"].is_object()) {
    Json& extensions = material["extensions"];
    if (!extensions.empty())
      extensions.erase(
          std::next(extensions.begin(), static_cast<ptrdiff_t>(below(random, extensions.size()))));
    return;
  }
  const material::Schema& schema = **library().models.schema();
  if (yes(random, 6)) {
    std::string last;
    const auto extension = static_cast<uint16_t>(below(random, schema.extensions.size()));
    Json* at = extension == 0 ? nullptr : walk(material, schema.pathOf(extension), last);
    if (at != nullptr && !at->contains(last)) (*at)[last] = Json::object();
    return;
  }
  const material::Property& property = schema.properties[below(random, schema.properties.size())];
  const lang::PropertyDecl& decl = *property.decl;
  std::string last;
  Json* at = walk(material, property.path, last);
  if (at == nullptr) return;
  switch (decl.kind) {
    case material::Kind::Number: (*at)[last] = valueOf(decl.type, decl.range, random); break;
    case material::Kind::Bool: (*at)[last] = yes(random, 2); break;
    case material::Kind::Choice: (*at)[last] = decl.choices[below(random, decl.choices.size())]; break;
    case material::Kind::Texture: (*at)[last] = textureOf(decl, textures, random); break;
    case material::Kind::Object: break;
  }
}

// -- graphs --

namespace {

class GraphChange {
public:
  GraphChange(Json& graph, Random& random) : graph_(graph), random_(random) {
    for (const char* list : {"parameters", "textures", "outputs"}) {
      if (!graph_[list].is_object()) graph_[list] = Json::object();
    }
    if (!graph_["nodes"].is_array()) graph_["nodes"] = Json::array();
    const Json& name = graph_["template"];
    const auto found = library().template_(name.is_string() ? name.get<std::string>() : "");
    if (found) template_ = *found;
  }

  void run() {
    if (yes(random_, 2)) add();
    if (yes(random_, 3)) reconnect();
    if (template_ != nullptr) connectPort();
  }

private:
  void add() {
    const std::vector<std::string_view> names = library().names(lang::DeclKind::Node);
    const Result<const lang::NodeDecl*> decl = library().node(names[below(random_, names.size())]);
    Json& nodes = graph_["nodes"];
    if (!decl || nodes.size() > 40) return;
    Json node = {{"id", "n" + std::to_string(random_() % 1000)}, {"node", (*decl)->name}};
    if (!(*decl)->variants.empty() && yes(random_, 3))
      node["variant"] = (*decl)->variants[below(random_, (*decl)->variants.size())].name;
    for (const lang::Param& param : (*decl)->params) {
      if (!param.default_value || yes(random_, 2))
        node["inputs"][std::string(param.name)] = sourceOf(param.type, param.range);
    }
    nodes.push_back(std::move(node));
  }

  void reconnect() {
    Json& nodes = graph_["nodes"];
    if (nodes.empty()) return;
    Json& node = nodes[below(random_, nodes.size())];
    const lang::NodeDecl* decl = declOf(node);
    if (decl == nullptr || decl->params.empty()) return;
    const lang::Param& param = decl->params[below(random_, decl->params.size())];
    Json& inputs = node["inputs"];
    if (inputs.is_object() || inputs.is_null())
      inputs[std::string(param.name)] = sourceOf(param.type, param.range);
  }

  void connectPort() {
    const auto& ports = template_->ports;
    if (ports.empty()) return;
    const lang::Param& param = ports[below(random_, ports.size())].param;
    graph_["outputs"][std::string(param.name)] = sourceOf(param.type, param.range);
  }

  const lang::NodeDecl* declOf(const Json& node) const {
    if (!node.is_object() || !node.contains("node") || !node["node"].is_string()) return nullptr;
    const auto found = library().node(node["node"].get<std::string>());
    return found ? *found : nullptr;
  }

  Json sourceOf(ir::Type type, const ir::Range& range) {
    if (const Json node = nodeOf(type); !node.is_null() && !yes(random_, 4)) return node;
    if (ir::componentCount(type) == 0 || type == ir::Type::Texture2D) return textureOf(type);
    if (yes(random_, 3)) return parameterOf(type, range);
    return valueOf(type, range, random_);
  }

  /// An output of that type, or of a longer one, by a swizzle.
  Json nodeOf(ir::Type type) {
    const Json& nodes = graph_["nodes"];
    const int wanted = ir::componentCount(type);
    for (int attempt = 0; attempt < 8 && !nodes.empty() && wanted > 0; ++attempt) {
      const Json& node = nodes[below(random_, nodes.size())];
      const lang::NodeDecl* decl = declOf(node);
      if (decl == nullptr || !node.contains("id")) continue;
      const lang::Param& result = decl->results[below(random_, decl->results.size())];
      if (result.type == ir::Type::Bool ? type != result.type : type == ir::Type::Bool) continue;
      const int has = ir::componentCount(result.type);
      if (has < wanted || result.type == ir::Type::Texture2D) continue;
      Json source = {{"node", node["id"]}};
      if (!result.name.empty() && decl->results.size() > 1) source["output"] = result.name;
      if (has > wanted) source["swizzle"] = std::string("rgba").substr(0, static_cast<size_t>(wanted));
      return source;
    }
    return nullptr;
  }

  Json textureOf(ir::Type type) {
    Json& textures = graph_["textures"];
    const std::string name = "t" + std::to_string(below(random_, 4));
    textures[name] = {{"type", ir::typeName(type)}, {"srgb", yes(random_, 2)}, {"texture", 0}};
    return {{"texture", name}};
  }

  Json parameterOf(ir::Type type, const ir::Range& range) {
    const auto end = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
    const std::string name = "p" + std::to_string(below(random_, 8));
    Json parameter = {{"type", ir::typeName(type)}, {"value", valueOf(type, range, random_)}};
    if (type != ir::Type::Bool) {
      parameter["range"] = {end(range.gap > 0 ? range.gap : range.lo), end(range.hi)};
      if (range.gap > 0) parameter["or_zero"] = true;
    }
    graph_["parameters"][name] = std::move(parameter);
    return {{"parameter", name}};
  }

  Json& graph_;
  Random& random_;
  const lang::TemplateDecl* template_ = nullptr;
};

}  // namespace

void changeGraph(Json& graph, Random& random) {
  if (graph.is_object()) GraphChange(graph, random).run();
}

}  // namespace lacquer::fuzz
