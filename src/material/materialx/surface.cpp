#include "materialx/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "graph/contracts.h"
#include "graph/text.h"
#include "lang/suggest.h"
#include "mtlx/looks.h"
#include "support/text.h"

namespace lacquer::materialx {

using graph::Source;
using json::Json;

namespace {

constexpr std::string_view kTangentSpace = "_tangent_space";

/// A number for each component of a colour.
Source spread(Source source) { return graph::widened(std::move(source), ir::Type::Vec3); }

/// The only output of a nodegraph, or the one of that name.
const Element* outputOf(const Element& nodegraph, std::string_view name) {
  for (const Element& child : nodegraph.children) {
    if (child.category == "output" && (name.empty() || child.name() == name)) return &child;
  }
  return nullptr;
}

}  // namespace

bool Value::isConstant(double x) const {
  if (source) return false;
  return std::all_of(constant.begin(), constant.begin() + size, [&](double c) { return c == x; });
}

void addTangentSpace(Element& document) {
  for (Element& graph : document.children) {
    if (graph.category != "nodegraph") continue;
    std::vector<Element> more;
    std::unordered_map<std::string_view, const Element*> maps;
    for (const Element& node : graph.children) {
      if (node.category == "normalmap") maps.emplace(node.name(), &node);
    }
    for (const Element& output : graph.children) {
      const auto map = maps.find(output.get("nodename"));
      if (output.category != "output" || map == maps.end()) continue;
      const Element* in = map->second->child("input", "in");
      if (in == nullptr) continue;
      Element& made = more.emplace_back(*in);
      made.category = "output";
      made.set("name", std::string(output.name()) + std::string(kTangentSpace));
      made.set(kMadeOutput, "true");
    }
    for (Element& one : more) graph.children.push_back(std::move(one));
  }
}

// -- inputs --

const Element* Surface::input(std::string_view name) {
  known_.emplace(name);
  return shader_.child("input", name);
}

void Surface::warn(std::string_view name, std::string message, std::string help) {
  const Element* at = shader_.child("input", name);
  addBounded(said_, {"not-translated",
                     Severity::Warning,
                     at == nullptr ? shader_.place : at->place,
                     std::move(message),
                     std::move(help),
                     {}});
}

/// A `multiply` beside the surface by numbers from 0 to 1 is glTF's factor in front of a texture.
bool Surface::takeFactor(const Element& in, Value& value) {
  const Element* node = patterns_.upstream(scope_, in);
  if (node == nullptr || node->category != "multiply" || patterns_.definitionOf(*node) != nullptr ||
      node->get("type") != in.get("type"))
    return false;
  const Element* first = node->child("input", "in1");
  const Element* second = node->child("input", "in2");
  if (first == nullptr || second == nullptr || !isConnected(*first) || isConnected(*second) ||
      first->get("type") != in.get("type"))
    return false;
  const std::optional<ir::Type> type = typeOf(second->get("type"));
  if (!type || ir::isMatrix(*type) || ir::isTexture(*type)) return false;
  const Result<ir::Components> read = valueOf(*second, *type, patterns_.units());
  const int count = ir::componentCount(*type);
  const bool fits =
      read && std::all_of(read->begin(), read->begin() + count, [](double x) { return x > 0 && x <= 1; });
  if (!fits || (count != 1 && count != value.size)) return false;
  value.source = patterns_.connected(scope_, *first);
  value.constant = *read;
  if (count == 1) value.constant.fill((*read)[0]);
  return true;
}

Value Surface::value(std::string_view name, int size, ir::Components by_default, bool factored) {
  Value value{size, by_default, {}};
  const Element* in = input(name);
  if (in == nullptr) return value;
  const ir::Type wanted = size == 1 ? ir::Type::Float : ir::Type::Vec3;
  if (isConnected(*in)) {
    if (factored && takeFactor(*in, value)) return value;
    value.constant = {1, 1, 1, 1};
    value.source = patterns_.connected(scope_, *in);
    return value;
  }
  if (in->find("value") == nullptr) return value;
  const ir::Type type = typeOf(in->get("type")).value_or(wanted);
  const Result<ir::Components> read = valueOf(*in, type, patterns_.units(), patterns_.unitOf(shader_, name));
  if (!read) {
    said_.insert(said_.end(), read.error().begin(), read.error().end());
    return value;
  }
  value.constant = *read;
  if (size == 3 && ir::componentCount(type) == 1) value.constant[1] = value.constant[2] = value.constant[0];
  return value;
}

Value Surface::get(std::string_view name, double by_default) { return value(name, 1, {by_default}, true); }
Value Surface::get(std::string_view name, std::array<double, 3> by_default) {
  return value(name, 3, {by_default[0], by_default[1], by_default[2]}, true);
}
Value Surface::whole(std::string_view name, double by_default) { return value(name, 1, {by_default}, false); }
Value Surface::whole(std::string_view name, std::array<double, 3> by_default) {
  return value(name, 3, {by_default[0], by_default[1], by_default[2]}, false);
}

double Surface::number(std::string_view name, double by_default) {
  const Element* in = input(name);
  if (in != nullptr && isConnected(*in)) {
    warn(name, fmt::format("{} is connected, and glTF has a number there", name),
         fmt::format("its default {} is taken", by_default));
    return by_default;
  }
  return get(name, by_default).constant[0];
}

std::array<double, 3> Surface::color(std::string_view name, std::array<double, 3> by_default) {
  const Element* in = input(name);
  if (in != nullptr && isConnected(*in)) {
    warn(name, fmt::format("{} is connected, and glTF has a colour there", name), "its default is taken");
    return by_default;
  }
  const Value value = get(name, by_default);
  return {value.constant[0], value.constant[1], value.constant[2]};
}

void Surface::leave(std::string_view name, double by_default) {
  const Element* in = input(name);
  if (in == nullptr) return;
  if (!isConnected(*in) && get(name, by_default).isConstant(by_default)) return;
  warn(name, fmt::format("{} has no counterpart in glTF", name), "it is left out");
}

void Surface::leave(std::string_view name, std::array<double, 3> by_default) {
  const Element* in = input(name);
  if (in == nullptr) return;
  if (!isConnected(*in)) {
    const Value value = get(name, by_default);
    if (std::equal(by_default.begin(), by_default.end(), value.constant.begin())) return;
  }
  warn(name, fmt::format("{} has no counterpart in glTF", name), "it is left out");
}

Product Surface::product(const std::vector<Value>& values) {
  Product product;
  for (const Value& value : values) {
    for (size_t i = 0; i < 3; ++i) product.factor[i] *= value.constant[value.size == 1 ? 0 : i];
  }
  if (product.factor[0] == 0 && product.factor[1] == 0 && product.factor[2] == 0) return product;
  for (const Value& value : values) {
    if (!value.source) continue;
    Source source = *value.source;
    const bool color = value.size == 3;
    if (!product.texel) {
      product.texel = std::move(source);
      product.color = color;
      continue;
    }
    if (color != product.color) (color ? *product.texel : source) = spread(color ? *product.texel : source);
    product.color = product.color || color;
    product.texel =
        patterns_.add(scope_, "product", product.color ? "texel_product<vec3>" : "texel_product<float>",
                      {{"a", *product.texel}, {"b", source}});
  }
  return product;
}

Value Surface::scaled(Value value, double by) {
  if (!value.source) {
    for (double& x : value.constant) x *= by;
    return value;
  }
  const graph::Literal factor{ir::Type::Float, {by}};
  const bool color = value.size == 3;
  Source number{factor, color ? "xxx" : ""};
  value.source = patterns_.add(scope_, "scaled", color ? "texel_product<vec3>" : "texel_product<float>",
                               {{"a", *value.source}, {"b", std::move(number)}});
  return value;
}

Product Surface::scaled(Product product, double by) {
  if (!product.texel) return product;
  product.texel = scaled(Value{product.color ? 3 : 1, {}, product.texel}, by).source;
  return product;
}

Value Surface::luminance(const Value& color) {
  Source source = *color.source;
  return {1, {1}, patterns_.add(scope_, "luminance", "texel_luminance", {{"color", std::move(source)}})};
}

// -- the material --

void Surface::set(const std::string& path, Json value) {
  Json* at = &material_;
  size_t begin = 0;
  while (true) {
    const size_t slash = path.find('/', begin);
    at = &(*at)[std::string_view(path).substr(begin, slash == std::string::npos ? slash : slash - begin)];
    if (slash == std::string::npos) break;
    begin = slash + 1;
  }
  *at = std::move(value);
}

double Surface::inRange(std::string_view property, double x, bool open) {
  constexpr double kRounding = 1e-6;  // a color that is brought to its brightest part and back
  const double most = open ? 3.4e38 : 1.0;
  if ((x < -kRounding || x > most + kRounding) && clamped_.emplace(property).second) {
    warn({}, fmt::format("{} of {} would be {}", property, quote(shader_.name()), x),
         fmt::format("glTF has numbers from 0{}: the nearest one is taken", open ? "" : " to 1"));
  }
  return std::clamp(x, 0.0, most);
}

void Surface::scalar(const std::string& factor, const std::string& texture, char channel,
                     const Product& product, bool open) {
  set(factor, inRange(factor, product.factor[0], open));
  if (!product.texel) return;
  constexpr std::string_view kChannels = "rgba";
  texels_[texture].channels[kChannels.find(channel)] = *product.texel;
}

void Surface::color(const std::string& factor, const std::string& texture, const Product& product,
                    bool open) {
  Json numbers = Json::array();
  for (size_t i = 0; i < 3; ++i) numbers.push_back(inRange(factor, product.factor[i], open));
  set(factor, std::move(numbers));
  if (product.texel) texels_[texture].color = product.color ? *product.texel : spread(*product.texel);
}

void Surface::baseColor(const Product& color, const Product& alpha) {
  const std::string factor = "pbrMetallicRoughness/baseColorFactor";
  Json numbers = Json::array();
  for (size_t i = 0; i < 3; ++i) numbers.push_back(inRange(factor, color.factor[i], false));
  numbers.push_back(inRange(factor, alpha.factor[0], false));
  set(factor, std::move(numbers));
  const std::string texture = "pbrMetallicRoughness/baseColorTexture";
  if (color.texel) texels_[texture].color = color.color ? *color.texel : spread(*color.texel);
  if (alpha.texel) texels_[texture].channels[3] = *alpha.texel;
}

void Surface::emission(const Product& product, double strength) {
  const double most = std::max({product.factor[0], product.factor[1], product.factor[2]});
  if (most <= 0 || strength <= 0) return;
  const double scale = most > 1 ? most : 1;
  Json numbers = Json::array();
  for (size_t i = 0; i < 3; ++i)
    numbers.push_back(inRange("emissiveFactor", product.factor[i] / scale, false));
  set("emissiveFactor", std::move(numbers));
  if (scale * strength != 1)
    set("extensions/KHR_materials_emissive_strength/emissiveStrength",
        inRange("emissiveStrength", scale * strength, true));
  if (product.texel)
    texels_["emissiveTexture"].color = product.color ? *product.texel : spread(*product.texel);
}

void Surface::normalTexel(const Source& encoded, const std::string& texture, double scale) {
  texels_[texture].color = encoded;
  if (scale != 1) set(texture + "/scale", scale);
}

void Surface::normal(std::string_view name, const std::string& texture) {
  const Element* in = input(name);
  if (in == nullptr || !isConnected(*in)) return;
  const auto scaleOf = [&](const Element& map) {
    const Element* scale = map.child("input", "scale");
    if (scale == nullptr || scale->find("value") == nullptr) return 1.0;
    const std::optional<std::vector<double>> numbers = numbersOf(scale->get("value"));
    return numbers ? (*numbers)[0] : 1.0;
  };
  const auto other = [&](std::string_view category) {
    if (category == "normal" || category == "geompropvalue") return;  // the surface's own
    warn(name, fmt::format("{} is connected to {}, which is no normal map", name, quote(category)),
         "glTF has normals in tangent space: connect a \"normalmap\"");
  };
  if (const Element* node = patterns_.upstream(scope_, *in);
      node != nullptr && in->find("nodegraph") == nullptr && node->category != "nodegraph") {
    if (node->category == "gltf_normalmap") {
      Element image = *node;
      image.category = "gltf_image";
      image.set("type", "vector3");
      if (image.child("input", "default") == nullptr) {
        Element& flat = image.children.emplace_back();
        flat.category = "input";
        flat.attributes = {{"name", "default"}, {"type", "vector3"}, {"value", "0.5, 0.5, 1"}};
        flat.place = image.place;
      }
      if (const std::optional<Source> texel = patterns_.insert(scope_, std::move(image)))
        normalTexel(*texel, texture, scaleOf(*node));
      return;
    }
    if (node->category != "normalmap") return other(node->category);
    const Element* encoded = node->child("input", "in");
    if (encoded == nullptr || !isConnected(*encoded)) return;
    if (const std::optional<Source> texel = patterns_.connected(scope_, *encoded))
      normalTexel(*texel, texture, scaleOf(*node));
    return;
  }
  const Element* graph = patterns_.nodegraph(scope_, *in);
  const Element* output = graph == nullptr ? nullptr : outputOf(*graph, in->get("output"));
  if (output == nullptr) return;  // said where it is connected
  const Element* node = patterns_.nodeOf(*graph, output->get("nodename"));
  if (node == nullptr || node->category != "normalmap")
    return other(node == nullptr ? "a value" : std::string_view(node->category));
  Element& link = made_.emplace_back(*in);
  link.set("output", std::string(output->name()) + std::string(kTangentSpace));
  if (const std::optional<Source> texel = patterns_.connected(scope_, link))
    normalTexel(*texel, texture, scaleOf(*node));
}

void Surface::tangentSpaceNormal(std::string_view name, const std::string& texture) {
  const Element* in = input(name);
  if (in == nullptr || !isConnected(*in)) return;
  const std::optional<Source> unit = patterns_.connected(scope_, *in);
  if (unit)
    normalTexel(patterns_.add(scope_, "encoded_normal", "texel_normal", {{"normal", *unit}}), texture, 1);
}

Json Surface::finish(std::string_view name, size_t procedural) {
  std::vector<std::string_view> names(known_.begin(), known_.end());
  for (const Element& child : shader_.children) {
    if (child.category != "input" || known_.contains(child.name()) || child.find(kOfVariant) != nullptr)
      continue;
    addBounded(said_, {"unknown-input",
                       Severity::Warning,
                       child.place,
                       fmt::format("{} has no input {}", quote(shader_.category), quote(child.name())),
                       lang::didYouMean(child.name(), names),
                       {}});
  }
  for (auto& [path, texel] : texels_) {
    graph::Inputs inputs;
    constexpr std::string_view kChannels = "rgba";
    if (texel.color) inputs.emplace_back("color", *texel.color);
    for (size_t i = texel.color ? 3 : 0; i < 4; ++i) {
      if (texel.channels[i]) inputs.emplace_back(std::string(1, kChannels[i]), *texel.channels[i]);
    }
    const std::string property = path.substr(path.rfind('/') + 1);
    const Source packed = patterns_.add(
        scope_, property, texel.color ? "texel_of_color" : "texel_of_channels", std::move(inputs));
    scope_.group().outputs.emplace_back(property, packed);
    outputs_.emplace_back(property, property);
    set(path + "/extensions/KHR_texture_procedurals/index", procedural);
    set(path + "/extensions/KHR_texture_procedurals/output", property);
  }
  Json material = Json::object();
  material["name"] = Json(name);
  material.update(material_);
  return material;
}

}  // namespace lacquer::materialx
