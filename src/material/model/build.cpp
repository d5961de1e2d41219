#include "model/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "model/attributes.h"
#include "model/closures.h"
#include "model/resolve.h"
#include "support/text.h"

namespace lacquer::model {

using graph::Graph;
using graph::Source;

namespace {

/// Where a texture is looked up: equal where the coordinates are, and stay so. An animated transform is like
/// no other.
struct Place {
  int uv_set;
  gltf::TextureTransform transform;
  std::string_view pointer;  ///< of an animated one
  bool operator==(const Place&) const = default;
};

Place placeOf(const gltf::TextureInfo& info) {
  return {info.texCoord, info.transform.value_or(gltf::TextureTransform{}),
          info.animated.transform() ? std::string_view(info.pointer) : std::string_view()};
}

/// A texel: of a texture at a place, or of a group that computes it.
struct Texel {
  std::string group;
  int texture = -1;
  bool srgb = false;
  Place place{};
  bool operator==(const Texel&) const = default;
};

/// Puts out what the ports of the template reach: nodes, and before them the parameters and textures that
/// they need.
class Writer {
public:
  Writer(const Model& model, Resolver& resolver, const lang::TemplateDecl& template_decl,
         const material::Material& material, const gltf::VertexAttributes& attributes,
         const BuildOptions& options, Graph& graph, Diagnostics& warnings, Origins& origins)
      : model_(model),
        resolver_(resolver),
        template_(template_decl),
        material_(material),
        attributes_(attributes),
        options_(options),
        graph_(graph),
        warnings_(warnings),
        origins_(origins),
        marked_(model.ids.size()),
        written_(model.ids.size()) {}

  void run();

private:
  void mark(const Found& value);
  bool decodedByFormat(const gltf::TextureInfo& info) const;
  Texel texelOf(uint16_t property) const;
  void write(uint32_t id);
  void ask(const lang::Param& param);
  void writeOrdered();
  void notTaken();
  void displace();
  Source source(const Found& value);
  Source from(const Found& value);
  Source number(const Found& value);
  Source texel(uint16_t wanted);
  void alsoOf(uint16_t property, const std::string& pointer);
  Source image(uint16_t property);
  Source computed(const gltf::TextureInfo& info, const std::string& id);
  void bring(const std::string& group);
  const std::string* closurePort(std::string_view port) const;
  Source coordinate(uint16_t property);
  Source editable(std::string name, ir::Type type, const ir::Range& range, const Origin& origin,
                  const ir::Components& otherwise, const ir::Components& neutral, bool animated);

  const Model& model_;
  Resolver& resolver_;
  const lang::TemplateDecl& template_;
  const material::Material& material_;
  const gltf::VertexAttributes& attributes_;
  const BuildOptions& options_;
  Graph& graph_;
  Diagnostics& warnings_;
  Origins& origins_;
  std::vector<uint8_t> marked_;
  std::vector<std::string> written_;  ///< the node's id in the graph, once it is there
  std::vector<std::pair<Texel, Source>> texels_;
  /// Of the properties that the ports reach the first of the library that has a texel: the texture is called
  /// by that one, in whichever order parts ask for it.
  std::vector<std::pair<Texel, uint16_t>> sharers_;
  std::vector<std::pair<Place, Source>> coordinates_;
  /// Of the file's patterns those that are not in the graph yet, by name: looked up, never walked.
  std::unordered_map<std::string_view, size_t> pattern_parameters_;
  bool brought_ = false;
};

/// Whether a colour's texture may have a format that decodes it: such a format leaves alpha as it is, which
/// has to be what is alpha in the texture, too.
bool Writer::decodedByFormat(const gltf::TextureInfo& info) const {
  constexpr int kAlpha = 3;
  const bool alpha_stays = info.channels[kAlpha] == kAlpha || info.channels[kAlpha] == gltf::kUnused;
  return !options_.decode_srgb && alpha_stays &&
         std::find(info.channels.begin(), info.channels.begin() + kAlpha, kAlpha) ==
             info.channels.begin() + kAlpha;
}

/// Equal for properties whose texels are.
Texel Writer::texelOf(uint16_t property) const {
  const gltf::TextureInfo& info = *material_.texture(property);
  return {{}, info.texture, model_.schema->properties[property].decl->srgb, placeOf(info)};
}

void Writer::mark(const Found& value) {
  if (value.kind == Found::Kind::Texel && material_.texture(value.property)->group.empty()) {
    const Texel texel = texelOf(value.property);
    const auto known =
        std::find_if(sharers_.begin(), sharers_.end(), [&](const auto& one) { return one.first == texel; });
    if (known == sharers_.end())
      sharers_.emplace_back(texel, value.property);
    else
      known->second = std::min(known->second, value.property);
  }
  if (value.kind != Found::Kind::Node || marked_[value.index]) return;
  marked_[value.index] = true;
  for (const Found& input : resolver_.node(value.index)->inputs) mark(input);
}

// -- sources --

Source Writer::editable(std::string name, ir::Type type, const ir::Range& range, const Origin& origin,
                        const ir::Components& otherwise, const ir::Components& neutral, bool animated) {
  if (!graph_.findParameter(name)) {
    graph::Parameter& parameter = graph_.parameters.emplace_back();
    parameter.name = name;
    parameter.type = type;
    parameter.value = valueOf(origin, material_, otherwise);
    parameter.range = range;
    parameter.pointer = pointerOf(origin, material_, *model_.schema);
    parameter.neutral = neutral;
    parameter.animated = animated;
    origins_.parameters.push_back(origin);
  }
  return {graph::ParameterRef{std::move(name)}, {}};
}

Source Writer::number(const Found& value) {
  const material::Property& property = model_.schema->properties[value.property];
  const lang::PropertyDecl* decl = property.decl;
  std::string name = property.parameter_name;
  Origin origin{Origin::Kind::Number, value.property, value.member};
  if (value.kind == Found::Kind::Member) {
    origin.kind = Origin::Kind::Member;
    decl = &decl->members[static_cast<size_t>(value.member)];
    name += "_" + material::parameterName(decl->name);
  }
  return editable(std::move(name), decl->type, decl->range, origin, value.constant,
                  decl->default_value.value_or(ir::Components{}), value.animated);
}

Source Writer::coordinate(uint16_t property) {
  const gltf::TextureInfo& info = *material_.texture(property);
  const std::string& slot = model_.schema->properties[property].parameter_name;
  const Place key = placeOf(info);
  for (const auto& [known, source] : coordinates_) {
    if (known == key) return source;
  }
  Source uv{graph::GivenRef{fmt::format("uv{}", info.texCoord)}, {}};
  if (!attributes_.texCoord[static_cast<size_t>(info.texCoord)]) {
    warnings_.push_back(
        {"texcoord-missing",
         Severity::Warning,
         {{}, 0, 0, info.pointer},
         fmt::format("the texture uses TEXCOORD_{}, which a primitive with this material does not have",
                     info.texCoord),
         "give the primitive that UV set, or another texCoord to the texture; (0, 0) is used",
         {}});
    uv = {graph::Literal{ir::Type::Vec2, {0, 0}}, {}};
  }
  const gltf::TextureTransform t = info.transform.value_or(gltf::TextureTransform{});
  if (!t.identity() || info.animated.transform()) {
    graph::Inputs inputs{{"uv", uv}};
    const auto add = [&](const char* input, ir::Type type, Origin::Kind kind, bool animated, bool given) {
      if (!animated && !given) return;
      inputs.emplace_back(
          input, editable(fmt::format("{}_uv_{}", slot, input), type, {}, {kind, property, -1}, {},
                          kind == Origin::Kind::Scale ? ir::Components{1, 1} : ir::Components{}, animated));
    };
    add("offset", ir::Type::Vec2, Origin::Kind::Offset, info.animated.offset,
        t.offset != std::array<double, 2>{0, 0});
    add("rotation", ir::Type::Float, Origin::Kind::Rotation, info.animated.rotation, t.rotation != 0);
    add("scale", ir::Type::Vec2, Origin::Kind::Scale, info.animated.scale,
        t.scale != std::array<double, 2>{1, 1});
    graph_.add(slot + ".uv", "uv_transform", std::move(inputs));
    uv = {graph::NodeRef{slot + ".uv", {}}, {}};
  }
  coordinates_.emplace_back(key, uv);
  return uv;
}

/// Attributes are spelled as the primitive has them. In the place of one that it lacks stands what the node
/// has for that.
void chooseAttributes(graph::Node& node, const gltf::VertexAttributes& attributes, const Graph& patterns) {
  for (auto& [name, source] : node.inputs) {
    auto* ref = std::get_if<graph::AttributeRef>(&source.from);
    if (ref == nullptr) continue;
    const auto& own = attributes.application;
    const auto spelled = std::find_if(
        own.begin(), own.end(), [&](const std::string& one) { return graph::sameAttribute(one, ref->name); });
    if (spelled != own.end()) ref->name = *spelled;
    if (hasAttribute(attributes, ref->name) || patterns.hasAttribute(ref->name)) continue;
    const auto other = std::find_if(node.inputs.begin(), node.inputs.end(), [](const auto& input) {
      return input.first == "default" || input.first == "fallback";
    });
    const ir::Type type = ref->type == ir::Type::Int ? ir::Type::Float : ref->type;  // a whole number
    source = other != node.inputs.end() ? other->second : Source{graph::Literal{type, {}}, {}};
  }
}

/// A group of the file's, with the groups, parameters and textures that it has.
void Writer::bring(const std::string& group) {
  const Graph& patterns = *material_.patterns;
  for (size_t i = 0; !brought_ && i < patterns.parameters.size(); ++i)
    pattern_parameters_.emplace(patterns.parameters[i].name, i);
  brought_ = true;
  std::vector<std::string> wanted{group};
  const auto take = [&](const Source& source) {
    if (const auto* parameter = std::get_if<graph::ParameterRef>(&source.from)) {
      const auto own = pattern_parameters_.find(parameter->name);
      if (own == pattern_parameters_.end()) return;
      graph_.parameters.push_back(patterns.parameters[own->second]);
      pattern_parameters_.erase(own);
    } else if (const auto* texture = std::get_if<graph::TextureRef>(&source.from)) {
      const auto own = patterns.findTexture(texture->name);  // else it is the template's
      if (own && !graph_.findTexture(texture->name)) graph_.textures.push_back(patterns.textures[*own]);
    }
  };
  while (!wanted.empty()) {
    const std::string name = std::move(wanted.back());
    wanted.pop_back();
    if (graph_.findGroup(name)) continue;
    const graph::Group& found = patterns.groups[*patterns.findGroup(name)];
    graph_.groups.push_back(found);
    for (graph::Node& node : graph_.groups.back().nodes) chooseAttributes(node, attributes_, patterns);
    if (!material_.closures.empty()) placeSurroundings(graph_.groups.back(), template_, options_);
    for (const graph::GroupInput& input : found.inputs) {
      if (input.by_default) take(*input.by_default);
    }
    for (const graph::Node& node : graph_.groups.back().nodes) {
      if (node.group) wanted.push_back(node.type);
      for (const auto& [input, source] : node.inputs) take(source);
    }
    for (const auto& [output, source] : found.outputs) take(source);
  }
}

/// The texel that a group computes; one instance for all of its outputs.
Source Writer::computed(const gltf::TextureInfo& info, const std::string& id) {
  const Texel key{info.group};
  for (const auto& [known, source] : texels_) {
    if (known == key) return {graph::NodeRef{std::get<graph::NodeRef>(source.from).node, info.output}, {}};
  }
  bring(info.group);
  graph_.nodes[graph_.add(id, info.group)].group = true;
  texels_.emplace_back(key, Source{graph::NodeRef{id, {}}, {}});
  return {graph::NodeRef{id, info.output}, {}};
}

/// The texture of a slot, one for all that sample it.
Source Writer::image(uint16_t property) {
  const gltf::TextureInfo& info = *material_.texture(property);
  const material::Property& row = model_.schema->properties[property];
  const std::string name = row.parameter_name + "_texture";
  if (!graph_.findTexture(name)) {
    graph::Texture texture;
    texture.name = name;
    texture.srgb = row.decl->srgb && decodedByFormat(info);
    texture.texture = info.texture;
    texture.pointer = info.pointer;
    graph_.textures.push_back(texture);
    origins_.textures.push_back(property);
  }
  return {graph::TextureRef{name}, {}};
}

/// The texel of a texture as a vec4; textures used twice in the same way are sampled once.
Source Writer::texel(uint16_t wanted) {
  const gltf::TextureInfo& info = *material_.texture(wanted);
  if (!info.group.empty()) return computed(info, model_.schema->properties[wanted].parameter_name + ".texel");
  const Texel key = texelOf(wanted);
  const auto sharer =
      std::find_if(sharers_.begin(), sharers_.end(), [&](const auto& one) { return one.first == key; });
  const uint16_t property = sharer == sharers_.end() ? wanted : sharer->second;
  for (const auto& [known, source] : texels_) {
    if (known != key) continue;
    if (wanted != property) alsoOf(property, info.pointer);
    return source;
  }
  const material::Property& row = model_.schema->properties[property];
  const std::string& slot = row.parameter_name;
  const Source sampled = image(property);
  const Source uv = coordinate(property);
  graph_.add(slot + ".texel", "texture_sample", graph::Inputs{{"image", sampled}, {"uv", uv}});
  Source result{graph::NodeRef{slot + ".texel", {}}, {}};
  if (info.channels != gltf::kOwnChannels) {
    graph::Literal channels{ir::Type::Vec4, {}};
    std::copy(info.channels.begin(), info.channels.end(), channels.value.begin());
    graph_.add(slot + ".channels", "texel_channels",
               graph::Inputs{{"texel", result}, {"channels", Source{channels, {}}}});
    result = {graph::NodeRef{slot + ".channels", {}}, {}};
  }
  if (row.decl->srgb && !decodedByFormat(info)) {
    graph_.add(slot + ".decoded", "srgb_decode", graph::Inputs{{"encoded", result}});
    result = {graph::NodeRef{slot + ".decoded", {}}, {}};
  }
  texels_.emplace_back(key, result);
  if (wanted != property) alsoOf(property, info.pointer);
  return result;
}

/// Another property has the texel of this one.
void Writer::alsoOf(uint16_t property, const std::string& pointer) {
  const std::string name = model_.schema->properties[property].parameter_name + "_texture";
  std::vector<std::string>& also = graph_.textures[*graph_.findTexture(name)].also;
  const auto at = std::lower_bound(also.begin(), also.end(), pointer);
  if (at == also.end() || *at != pointer) also.insert(at, pointer);
}

Source Writer::from(const Found& value) {
  switch (value.kind) {
    case Found::Kind::Nothing:
    case Found::Kind::Void: break;
    case Found::Kind::Constant: return {graph::Literal{value.type, value.constant}, {}};
    case Found::Kind::Number:
    case Found::Kind::Member: return number(value);
    case Found::Kind::Texel: return texel(value.property);
    case Found::Kind::Uv: return coordinate(value.property);
    case Found::Kind::Image: return image(value.property);
    case Found::Kind::Given: return {graph::GivenRef{model_.givens[value.index]}, {}};
    case Found::Kind::Texture: return {graph::TextureRef{model_.givens[value.index]}, {}};
    case Found::Kind::Node:
      write(value.index);
      return {graph::NodeRef{written_[value.index], std::string(value.output)}, {}};
  }
  return {};
}

Source Writer::source(const Found& value) {
  Source source = from(value);
  source.swizzle = value.swizzle.view();
  return source;
}

// -- nodes --

/// Notes an attribute that a node asks for by `given _NAME` and the primitive has.
void Writer::ask(const lang::Param& param) {
  if (graph::isAttributeName(param.given) && hasAttribute(attributes_, param.given) &&
      !graph_.hasAttribute(param.given))
    graph_.attributes.emplace_back(param.given);
}

void Writer::write(uint32_t id) {
  if (!written_[id].empty()) return;
  const Resolver::Node& node = *resolver_.node(id);
  for (const Found& input : node.inputs) {
    if (input.kind == Found::Kind::Node) write(input.index);
  }
  graph::Inputs inputs;
  inputs.reserve(node.inputs.size());
  for (size_t i = 0; i < node.inputs.size(); ++i) {
    const Found& input = node.inputs[i];
    const lang::Param& param = node.decl->params[i];
    // A number that is the default is not worth a connection.
    const bool same = input.kind == Found::Kind::Constant && param.default_value &&
                      input.type == param.type && *param.default_value == input.constant;
    if (input && !same) inputs.emplace_back(param.name, source(input));
    if (!input) ask(param);
  }
  if (node.shared) {
    for (const graph::Node& other : graph_.nodes) {
      if (other.type != node.decl->name || other.variant != node.variant || other.inputs != inputs) continue;
      written_[id] = other.id;
      return;
    }
  }
  written_[id] = std::string(model_.ids[id].name);
  graph_.add(written_[id], std::string(node.decl->name), std::move(inputs));
  graph_.nodes.back().variant = std::string(node.variant);
}

void Writer::writeOrdered() {
  for (const uint32_t index : model_.ordered) {
    const Line& line = model_.lines[index];
    // Of lines with one id, the one that the node is of says where it stands.
    if (marked_[line.id] && resolver_.node(line.id)->order == line.order) write(line.id);
  }
}

/// Terms that the material has, whose values no port of the template takes.
void Writer::notTaken() {
  std::vector<uint8_t> used(model_.terms.size());
  for (const Line& line : model_.lines) {
    const bool value = line.kind == lang::LineDecl::Kind::Value;
    if (line.term == Line::kNone || (!value && line.kind != lang::LineDecl::Kind::Out)) continue;
    const bool taken = value ? marked_[line.id] : resolver_.taken(line);
    if (!taken) continue;
    for (uint32_t term = line.term; term != Line::kNone && !used[term]; term = model_.terms[term].parent)
      used[term] = true;
  }
  for (uint32_t i = 0; i < model_.terms.size(); ++i) {
    if (!model_.terms[i].valued || used[i] || !resolver_.alive(i)) continue;
    const uint32_t parent = model_.terms[i].parent;
    if (parent != Line::kNone && !used[parent]) continue;
    if (!resolver_.gives(i)) {
      // An extension that the material has does not go without a word.
      std::string why = parent == Line::kNone && !model_.parts[model_.terms[i].part].of.empty()
                            ? resolver_.missing(i)
                            : std::string();
      if (!why.empty()) graph_.skip(model_.terms[i].name, std::move(why));
      continue;
    }
    graph_.skip(model_.terms[i].name, "nothing that the template takes needs it");
  }
  // Lines of the library's own that need what is not there are its terms' to tell.
  const auto built_in = [](const auto& part) { return part.origin.built_in; };
  if (std::all_of(model_.parts.begin(), model_.parts.end(), built_in)) return;
  for (const Line& line : model_.lines) {
    if (line.term == Line::kNone || line.part >= model_.parts.size()) continue;
    if (model_.parts[line.part].origin.built_in || !used[line.term] || !resolver_.alive(line.term)) continue;
    if (std::string why = resolver_.unmade(line); !why.empty())
      graph_.skip(model_.ids[line.id].name, std::move(why));
  }
}

/// What the group of a surface of closures calls a port; null where it has nothing for it.
const std::string* Writer::closurePort(std::string_view port) const {
  for (const auto& [name, output] : material_.ports) {
    if (name == port) return &output;
  }
  return nullptr;
}

/// What a document says of its vertices, for a template that takes it.
void Writer::displace() {
  constexpr std::string_view kPort = "displacement";
  const bool takes =
      std::any_of(template_.ports.begin(), template_.ports.end(), [&](const lang::PortDecl& port) {
        return port.param.name == kPort && port.param.type == ir::Type::Vec3;
      });
  const bool given = std::any_of(graph_.outputs.begin(), graph_.outputs.end(),
                                 [&](const auto& output) { return output.first == kPort; });
  if (!takes || given) {
    graph_.skip(kPort, fmt::format("the template '{}' moves no vertices by it", template_.name));
    warnings_.push_back(
        {"displacement-left-out",
         Severity::Warning,
         {{}, 0, 0, fmt::format("/materials/{}", material_.index)},
         fmt::format("the template {} does not take the material's displacement", quote(template_.name)),
         "one with a port vec3 displacement, and an output that moves object_position by it, does",
         {}});
    return;
  }
  bring(material_.displacement);
  graph_.nodes[graph_.add(std::string(kPort), material_.displacement)].group = true;
  graph_.outputs.emplace_back(kPort, Source{graph::NodeRef{std::string(kPort), {}}, {}});
}

void Writer::run() {
  std::vector<std::pair<std::string_view, Found>> ports;
  for (const lang::PortDecl& port : template_.ports) {
    // Of properties a surface of closures has none but how it is shown.
    if (!material_.closures.empty() && port.param.name != "hidden" && port.param.name != "surface_normal")
      continue;
    if (closurePort(port.param.name) != nullptr) continue;
    const Found value = resolver_.port(port.param.name);
    if (!value) continue;
    mark(value);
    ports.emplace_back(port.param.name, value);
  }
  if (material_.closures.empty()) {
    for (graph::Skipped& skipped : resolver_.skipped()) graph_.skip(skipped.term, std::move(skipped.reason));
  }
  if (!resolver_.wrong().empty()) return;
  writeOrdered();
  for (const auto& [name, value] : ports) graph_.outputs.emplace_back(name, source(value));
  for (const lang::PortDecl& port : template_.ports) {
    const std::string* output = closurePort(port.param.name);
    if (output == nullptr) continue;
    gltf::TextureInfo computed_by;
    computed_by.group = material_.closures;
    computed_by.output = *output;
    graph_.outputs.emplace_back(port.param.name, computed(computed_by, "closures"));
  }
  if (!material_.displacement.empty()) displace();
  if (!material_.surface_pointer.empty()) nameNumbers(graph_, material_.surface_pointer);
  // A line is a term, which the code tells, in the order of the layers.
  for (size_t i = 0; i < graph_.nodes.size(); ++i) {
    graph_.nodes[i].term = graph_.nodes[i].id;
    graph_.nodes[i].place = static_cast<uint32_t>(i);
  }
  if (material_.closures.empty()) notTaken();
}

/// Whether a run takes what not every primitive has: by the file, or by its switches where they are set.
struct Choice {
  bool taken = false;
  std::string_view off;  ///< the switch that keeps it out
};

Choice chosen(const lang::AttributeDecl& attribute, bool there, const BuildOptions& options) {
  Choice choice{there, {}};
  for (const std::string_view name : attribute.by) {
    const auto set = options.switches.find(name);
    if (set == options.switches.end()) continue;
    if (!set->second) return {false, name};
    if (name == attribute.by.back()) choice.taken = true;
  }
  return choice;
}

/// What primitives have and the shader does not read, by the reason.
class LeftOut {
public:
  explicit LeftOut(Graph& graph) : graph_(graph) {}

  void add(std::string_view name, const std::string& why) {
    graph_.skip(name, why);
    if (reasons_.empty() || reasons_.back().first != why) reasons_.emplace_back(why, "");
    std::string& names = reasons_.back().second;
    names += (names.empty() ? "" : ", ") + std::string(name);
  }

  void report(int material, Diagnostics& warnings) const {
    for (const auto& [why, names] : reasons_) {
      warnings.push_back(
          {"attribute-left-out",
           Severity::Note,
           {{}, 0, 0, material < 0 ? std::string() : fmt::format("/materials/{}", material)},
           fmt::format("a primitive with this material has {}, which its shader does not read: {}", names,
                       why),
           "the vertices are the application's to place",
           {}});
    }
  }

private:
  Graph& graph_;
  std::vector<std::pair<std::string, std::string>> reasons_;  ///< why, and the names in order
};

/// Of the attributes that not every primitive has.
LeftOut optionalAttributes(const lang::TemplateDecl& template_decl, const gltf::VertexAttributes& attributes,
                           const BuildOptions& options, Graph& graph) {
  LeftOut left_out(graph);
  gltf::VertexAttributes common = attributes;
  common.skin = {};
  common.morph = common.instances = common.quantized = false;
  for (const lang::AttributeDecl& attribute : template_decl.attributes) {
    if (!attribute.optional) continue;
    // Of the facts that a template speaks of, files know that of stored integers; others are the switches'
    // alone.
    const bool known = !attribute.fact || attribute.name == "QUANTIZED";
    const bool there = known && hasAttribute(attributes, attribute.name);
    const Choice choice = chosen(attribute, there, options);
    if (choice.taken)
      graph.attributes.emplace_back(attribute.name);
    else if (there)
      left_out.add(attribute.name, fmt::format("it is left out (--switch {}=off)", choice.off));
  }
  for (const std::string& name : attributes.names()) {
    // Those that are read by name alone. Of its own the application knows what it has them for.
    if (std::binary_search(attributes.application.begin(), attributes.application.end(), name)) continue;
    const bool taken = hasAttribute(common, name) ||
                       std::any_of(template_decl.attributes.begin(), template_decl.attributes.end(),
                                   [&](const lang::AttributeDecl& one) { return one.name == name; });
    if (!taken) left_out.add(name, fmt::format("the template '{}' does not take it", template_decl.name));
  }
  return left_out;
}

}  // namespace

Result<Graph> build(const Model& model, const lang::TemplateDecl& template_decl,
                    const material::Material& material, const gltf::VertexAttributes& attributes,
                    const BuildOptions& options, Diagnostics& warnings, Origins* origins) {
  Graph graph;
  Origins unwanted;
  graph.name = material.name;
  graph.template_name = options.template_name;
  // Room for a coat with all of its terms.
  graph.nodes.reserve(64);
  graph.parameters.reserve(48);
  optionalAttributes(template_decl, attributes, options, graph).report(material.index, warnings);
  if (!material.closures.empty()) {
    if (const Result<void> taken = takesClosures(template_decl, material); !taken)
      return tl::make_unexpected(taken.error());
  }
  Resolver resolver(model, template_decl, material, attributes, options, warnings);
  Writer(model, resolver, template_decl, material, attributes, options, graph, warnings,
         origins == nullptr ? unwanted : *origins)
      .run();
  const Diagnostics unordered = resolver.unordered();
  if (!resolver.wrong().empty()) return tl::make_unexpected(resolver.wrong());
  warnings.insert(warnings.end(), unordered.begin(), unordered.end());
  return graph;
}

}  // namespace lacquer::model
