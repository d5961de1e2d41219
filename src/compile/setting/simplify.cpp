#include "setting/simplify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "lang/suggest.h"
#include "setting/options.h"
#include "support/text.h"

namespace lacquer {

namespace {

/// A word taken apart.
struct Word {
  std::string_view kind, name, value;
};

Word partsOf(std::string_view word) {
  Word parts;
  const size_t colon = word.find(':');
  if (colon == std::string_view::npos) return parts;
  parts.kind = word.substr(0, colon);
  parts.name = word.substr(colon + 1);
  const size_t equals = parts.name.find('=');
  if (equals == std::string_view::npos) return parts;
  parts.value = parts.name.substr(equals + 1);
  parts.name = parts.name.substr(0, equals);
  return parts;
}

/// Numbers from 0 on with commas between; none where something else is written.
std::vector<double> numbersOf(std::string_view text) {
  std::istringstream stream{std::string(text)};
  stream.imbue(std::locale::classic());
  std::vector<double> numbers;
  for (double x = 0; stream >> x;) {
    if (!std::isfinite(x) || x < 0) return {};
    numbers.push_back(x);
    char comma = 0;
    if (!(stream >> comma)) return numbers;
    if (comma != ',') return {};
  }
  return {};
}

/// Reads one word into the simplification; false where it is none.
bool take(const Word& word, Simplification& to) {
  const std::string name(word.name);
  if (name.empty()) return false;
  const bool plain = word.value.empty();
  if (word.kind == "without") return plain && (to.without.insert(name), true);
  if (word.kind == "lod") return plain && (to.lods.insert(name), true);
  if (word.kind == "vertex") return plain && (to.vertices.insert(name), true);
  if (word.kind == "drop") return plain && (to.dropped.insert(name), true);
  if (word.kind == "variant") {
    to.variants[name] = word.value;
    return !plain;
  }
  if (word.kind == "switch") {
    to.switches[name] = word.value == "on";
    return word.value == "on" || word.value == "off";
  }
  const std::vector<double> numbers = numbersOf(word.value);
  if (word.kind == "texel") {
    if (numbers.size() != 4) return false;
    std::copy(numbers.begin(), numbers.end(), to.texels[name].begin());
    return true;
  }
  if (word.kind != "scale" || numbers.empty() || numbers.size() > 4) return false;
  to.scales[name] = numbers;
  return true;
}

/// The node of the library that scales a number of that type; empty where there is none.
std::string_view scalingNode(ir::Type type) {
  switch (type) {
    case ir::Type::Float: return "fitted";
    case ir::Type::Vec3: return "fitted_color";
    case ir::Type::Vec4: return "fitted_color_alpha";
    default: return {};
  }
}

void scale(graph::Graph& graph, const std::string& name, const std::vector<double>& by) {
  const std::optional<size_t> found = graph.findParameter(name);
  if (!found) return;
  const ir::Parameter& parameter = graph.parameters[*found];
  const std::string_view type = scalingNode(parameter.type);
  const bool unit = parameter.range.lo == 0 && parameter.range.hi == 1 && parameter.range.gap == 0;
  const auto count = static_cast<size_t>(ir::componentCount(parameter.type));
  if (type.empty() || !unit || by.size() != count) return;
  const std::string id = name + ".fitted";
  const graph::Source before{graph::ParameterRef{name}, {}};
  for (graph::Node& node : graph.nodes) {
    for (auto& [input, source] : node.inputs) {
      if (source.from == before.from) source.from = graph::NodeRef{id, {}};
    }
  }
  for (auto& [port, source] : graph.outputs) {
    if (source.from == before.from) source.from = graph::NodeRef{id, {}};
  }
  ir::Components factors{};
  std::copy(by.begin(), by.end(), factors.begin());
  graph.add(id, std::string(type),
            {{"value", before}, {"scale", {graph::Literal{parameter.type, factors}, {}}}});
  graph.nodes.back().term = id;
}

/// Every texel of a texture is one: the nodes that look it up are numbers.
void replaceTexel(graph::Graph& graph, const std::string& slot, const ir::Components& texel) {
  std::set<std::string, std::less<>> lookups;
  for (const graph::Node& node : graph.nodes) {
    const auto is = [&](const auto& input) {
      const auto* ref = std::get_if<graph::TextureRef>(&input.second.from);
      return ref != nullptr && ref->name == slot;
    };
    if (node.type == "texture_sample" && std::any_of(node.inputs.begin(), node.inputs.end(), is))
      lookups.insert(node.id);
  }
  const auto replace = [&](graph::Source& source) {
    const auto* ref = std::get_if<graph::NodeRef>(&source.from);
    if (ref != nullptr && lookups.contains(ref->node)) source.from = graph::Literal{ir::Type::Vec4, texel};
  };
  for (graph::Node& node : graph.nodes) {
    for (auto& [input, source] : node.inputs) replace(source);
  }
  for (auto& [port, source] : graph.outputs) replace(source);
  std::erase_if(graph.nodes, [&](const graph::Node& node) { return lookups.contains(node.id); });
}

/// A texture of the schema has that name in glTF.
bool isTexture(const material::Schema& schema, std::string_view name) {
  return std::any_of(schema.properties.begin(), schema.properties.end(), [&](const material::Property& p) {
    return p.decl->kind == material::Kind::Texture && p.decl->name == name;
  });
}

bool isTerm(const model::Model& model, std::string_view name) {
  return std::any_of(model.terms.begin(), model.terms.end(),
                     [&](const model::Term& term) { return term.name == name; });
}

/// The switches that are options by themselves, and what they are.
std::map<std::string, bool, std::less<>> switchesOf(const Language& language, const Options& options) {
  std::map<std::string, bool, std::less<>> all;
  for (const std::string_view name : language.names(lang::DeclKind::Switch)) {
    const Result<const lang::SwitchDecl*> decl = language.switch_(name);
    if (decl) all.emplace(name, (*decl)->value);
  }
  for (const auto& [name, value] : options.switches) all.insert_or_assign(name, value);
  all.insert_or_assign("ibl", options.ibl);
  all.insert_or_assign("multiple_scattering", options.multiple_scattering);
  all.insert_or_assign("dfg_table", options.dfg_table);
  return all;
}

}  // namespace

Result<Simplification> simplificationOf(const Strings& words) {
  Simplification result;
  for (const std::string& word : words) {
    if (take(partsOf(word), result)) continue;
    return fail("bad-simplification", {}, fmt::format("'{}' says nothing to make simpler", printable(word)),
                "write without:TERM, lod:NAME, switch:NAME=on, variant:NODE=NAME, drop:TEXTURE, "
                "texel:TEXTURE=r,g,b,a, vertex:NODE or scale:PARAMETER=x");
  }
  return result;
}

Diagnostics checkSimplification(const Strings& words, const Language& language) {
  const Result<Simplification> simpler = simplificationOf(words);
  if (!simpler) return simpler.error();
  const Result<const material::Schema*> schema = language.models.schema();
  if (!schema) return schema.error();
  const auto profiles = language.names(lang::DeclKind::Profile);
  const Result<const model::Model*> model = language.models.of(profiles.empty() ? "" : profiles[0]);
  if (!model) return model.error();
  Diagnostics wrong;
  const auto unknown = [&](std::string_view what, std::string_view name, std::string help) {
    wrong.push_back({fmt::format("unknown-{}", what),
                     Severity::Error,
                     {},
                     fmt::format("there is no {} '{}'", what, printable(std::string(name))),
                     std::move(help),
                     {}});
  };
  std::vector<std::string_view> terms;
  for (const model::Term& term : (*model)->terms) terms.push_back(term.name);
  for (const std::string& name : simpler->without) {
    if (!isTerm(**model, name)) unknown("term", name, lang::didYouMean(name, terms));
  }
  const std::vector<std::string_view> lods = language.names(lang::DeclKind::Lod);
  for (const std::string& name : simpler->lods) {
    if (!language.has(lang::DeclKind::Lod, name)) unknown("lod", name, lang::didYouMean(name, lods));
  }
  for (const auto& [name, ignored] : simpler->switches) {
    if (!language.has(lang::DeclKind::Switch, name))
      unknown("switch", name, lang::didYouMean(name, language.names(lang::DeclKind::Switch)));
  }
  std::set<std::string_view> textures(simpler->dropped.begin(), simpler->dropped.end());
  for (const auto& [name, ignored] : simpler->texels) textures.insert(name);
  for (const std::string_view name : textures) {
    if (!isTexture(**schema, name))
      unknown("texture", name, "write its name as glTF does: coatNormalTexture");
  }
  return wrong;
}

lower::LowerOptions loweringOf(const Options& options, bool evaluable) {
  return {parameterMode(options), evaluable, {}};
}

material::Material withoutTextures(material::Material material, const material::Schema& schema,
                                   const Simplification& simpler) {
  std::erase_if(material.textures, [&](const material::Material::Texture& texture) {
    return simpler.dropped.contains(schema.properties[texture.property].decl->name);
  });
  return material;
}

void simplify(graph::Graph& graph, const lang::Library& library, const Simplification& simpler) {
  for (graph::Node& node : graph.nodes) {
    if (simpler.vertices.contains(node.id)) node.at_vertices = true;
    const auto wanted = simpler.variants.find(node.id);
    if (wanted == simpler.variants.end()) continue;
    const Result<const lang::NodeDecl*> decl = library.node(node.type);
    if (decl && (*decl)->find(wanted->second) != nullptr) node.variant = wanted->second;
  }
  for (const auto& [name, by] : simpler.scales) scale(graph, name, by);
}

Diagnostics asksToBuild(const Options& options) {
  const std::pair<bool, const char*> asked[] = {{!options.template_name.empty(), "template"},
                                                {!options.profile.empty(), "profile"},
                                                {!options.switches.empty(), "switch"},
                                                {!options.live.empty(), "live"}};
  Diagnostics wrong;
  for (const auto& [is, name] : asked) {
    if (is)
      wrong.push_back({"graph-is-built",
                       Severity::Error,
                       {},
                       fmt::format("'{}' says how a graph is built, and this is one", name),
                       "leave it out, or take the glTF file",
                       {}});
  }
  return wrong;
}

Result<void> simplifyBuilt(graph::Graph& graph, const lang::Library& library, const Strings& words) {
  const Result<Simplification> simpler = simplificationOf(words);
  if (!simpler) return tl::make_unexpected(simpler.error());
  for (const std::string& word : words) {
    const std::string_view kind = partsOf(word).kind;
    if (kind == "variant" || kind == "vertex" || kind == "scale" || kind == "texel") continue;
    return fail("graph-is-built", {},
                fmt::format("'{}' says how a graph is built, and this is one", printable(word)),
                "of a graph there are variant:NODE=NAME, vertex:NODE, scale:PARAMETER=x and "
                "texel:TEXTURE=r,g,b,a");
  }
  simplify(graph, library, *simpler);
  for (const auto& [name, texel] : simpler->texels) {
    for (const graph::Texture& slot : graph.textures) {
      if (slot.name == name || slot.pointer.ends_with("/" + name)) replaceTexel(graph, slot.name, texel);
    }
  }
  return {};
}

/// Those of a graph's nodes.
static void addNodeWords(const graph::Graph& graph, const lang::Library& library, Strings& words) {
  for (const graph::Node& node : graph.nodes) {
    const Result<const lang::NodeDecl*> decl = library.node(node.type);
    if (!decl) continue;
    words.push_back(fmt::format("vertex:{}", node.id));
    if (!node.variant.empty()) continue;
    for (const lang::Variant& variant : (*decl)->variants)
      words.push_back(fmt::format("variant:{}={}", node.id, variant.name));
  }
}

Strings possibleWords(const graph::Graph& graph, const material::Material* material, const Language& language,
                      const Options& options) {
  Strings words;
  if (material == nullptr) {
    addNodeWords(graph, language, words);
    return words;
  }
  const Result<const model::Model*> model = language.models.of(options.profile);
  if (!model) return words;
  for (const model::Term& term : (*model)->terms) {
    // A part of no extension is what all materials are made of.
    const model::Part& part = (*model)->parts[term.part];
    if (term.parent == model::Line::kNone && part.of.empty()) continue;
    std::string word = fmt::format("without:{}", term.name);
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(std::move(word));
  }
  for (const std::string_view name : language.names(lang::DeclKind::Lod))
    words.push_back(fmt::format("lod:{}", name));
  for (const auto& [name, value] : switchesOf(language, options)) {
    // What is smaller than a pixel is in no picture of one sample for each, without neighbours to differ
    // from.
    if (name == kAntialiasing || name == "pixel_lobes") continue;
    words.push_back(fmt::format("switch:{}={}", name, value ? "off" : "on"));
  }
  addNodeWords(graph, language, words);
  for (const material::Material::Texture& texture : material->textures)
    words.push_back(fmt::format("drop:{}", (*model)->schema->properties[texture.property].decl->name));
  return words;
}

std::string subjectOf(std::string_view word) {
  const Word parts = partsOf(word);
  if (parts.kind == "drop" || parts.kind == "texel") return fmt::format("texture:{}", parts.name);
  if (parts.kind == "variant") return fmt::format("node:{}", parts.name);
  return std::string(word);
}

std::string described(std::string_view word, const lang::Library& library) {
  const Word parts = partsOf(word);
  if (parts.kind == "lod") {
    const Result<const lang::ProfileDecl*> decl = library.lod(parts.name);
    if (decl) return (*decl)->doc;
  }
  if (parts.kind == "without") return fmt::format("without {}", parts.name);
  if (parts.kind == "drop") return fmt::format("without {}", parts.name);
  if (parts.kind == "texel") return fmt::format("one colour for {}: {}", parts.name, parts.value);
  if (parts.kind == "variant") return fmt::format("{}: the variant {}", parts.name, parts.value);
  if (parts.kind == "switch") return fmt::format("{} {}", parts.name, parts.value);
  if (parts.kind == "vertex") return fmt::format("{} computed at the vertices", parts.name);
  if (parts.kind == "scale") return fmt::format("{} times {}", parts.name, parts.value);
  return std::string(word);
}

}  // namespace lacquer
