// Parts of extensions over the real library: whatever they say, they are refused with a place, or make graphs
// that hold, in which no line of the library has become another's.
#include <fmt/format.h>

#include <array>

#include "choices.h"
#include "feeds.h"
#include "graph/graph.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "setting/language.h"
#include "shader/module.h"

namespace lacquer::fuzz {

namespace {

constexpr std::string_view kExtension = R"(/// E.
/// source: E
extension ODD_layer {
    float oddFactor in [0, 1] = 0;
    vec3 oddColor in [0, 1] = vec3(1);
    texture oddTexture srgb .rgb;
}

/// N.
/// source: E
node odd_color(vec3 x in [0, inf], float factor in [0, 1] = 1) -> vec3 in [0, inf] { return x * factor; }

/// N.
/// source: E
node odd_rgba(vec4 x in [0, 1], float factor in [0, 1] = 1) -> vec4 in [0, 1] { return x * factor; }

/// N.
/// source: E
node odd_scale(float x in [0, 1], float y in [0, 1] = 1) -> float in [0, 1] { return x * y; }

/// N.
/// source: E
node odd_pair(float x in [0, 1]) -> (float one in [0, 1], vec3 three in [0, 1]) { return (x, vec3(x)); }
)";

constexpr std::array kColors = {"below.direct",   "below.indirect",  "oddColor",      "oddTexture",
                                "base.color.rgb", "vec3(0.5)",       "odd.a",         "odd.b",
                                "below.emission", "base.irradiance", "odd.pair.three"};
constexpr std::array kFloats = {"oddFactor",          "0.5",           "base.roughness",
                                "base.cosines.NdotL", "base.light",    "odd.c",
                                "odd.pair.one",       "base.metallic", "behind.light"};
constexpr std::array kPorts = {"direct",    "indirect",       "emission",    "base_color",
                               "roughness", "surface_normal", "coat_weight", "alpha"};
constexpr std::array kTargets = {"base.color",  "base.roughness", "base.light",
                                 "base.normal", "behind.light",   "coat.light",
                                 "normal.unit", "base.metallic",  "odd.a"};
constexpr std::array kParts = {"base", "coat", "base",  "coat",   "sheen",       "base, coat", "volume",
                               "base", "coat", "sheen", "volume", "base, sheen", "odd",        "nothing"};
constexpr std::array kIds = {"odd.a",      "odd.b",      "odd.c",       "odd.pair",
                             "odd.direct", "base.color", "odd.emission"};
constexpr std::array kConditions = {"oddFactor == 0",
                                    "oddColor == vec3(1)",
                                    "oddTexture",
                                    "KHR_materials_coat",
                                    "dimmable(direct)",
                                    "takes(direct)",
                                    "replaced(base.color)",
                                    "odd.is",
                                    "uniform(oddFactor)",
                                    "odd.a",
                                    "coat.clear",
                                    "odd",
                                    "!odd.is"};
constexpr std::array kSections = {"surface", "lobes", "direct", "indirect"};

/// Text that an input's bytes choose, well-formed for the most part.
class Writer : Choices {
public:
  explicit Writer(std::string_view bytes) : Choices(bytes) {}

  std::string run() {
    std::string text = fmt::format("\n/// P.\npart odd of ODD_layer over {}", pick(kParts));
    if (one(4)) text += fmt::format(" when {}", pick(kConditions));
    if (!one(4)) text += " unless oddFactor == 0";
    text += " {\n";
    if (!one(16)) {
      text +=
          "surface:\n    odd.a = odd_color(oddColor, oddFactor);\n    odd.b = oddTexture;\n    odd.c = "
          "odd_scale(oddFactor);\n    odd.pair = odd_pair(oddFactor);\n    bool odd.is = oddTexture;\n";
    }
    while (!done() && text.size() < 4096) text += line(0);
    return text + "}\n";
  }

private:
  template <size_t N>
  const char* pick(const std::array<const char*, N>& list) {
    return list[next() % N];
  }

  /// New for the most part.
  std::string id() { return one(8) ? pick(kIds) : fmt::format("odd.n{}", ++lines_); }

  std::string color() { return pick(kColors); }
  std::string value() {
    switch (next() % 8) {
      case 0: return fmt::format("odd_color({}, {})", color(), pick(kFloats));
      case 1: return fmt::format("odd_rgba(base.color, {})", pick(kFloats));
      case 2: return fmt::format("odd_scale({}, y = {})", pick(kFloats), pick(kFloats));
      case 3: return fmt::format("odd_pair({})", pick(kFloats));
      case 4: return pick(kFloats);
      case 5: return pick(kIds);
      case 6: return "none";
      default: return color();
    }
  }
  std::string alternatives() {
    std::string text = value();
    if (one(3)) text += fmt::format(" {} {}", one(2) ? "when" : "unless", pick(kConditions));
    if (one(4)) text += " or " + value();
    return text + ";\n";
  }
  std::string line(int depth) {
    switch (next() % 10) {
      case 0: return fmt::format("{}:\n", pick(kSections));
      case 1:
      case 2: return fmt::format("    out {} = {}", pick(kPorts), alternatives());
      case 3: return fmt::format("    replace {} with {}", pick(kTargets), alternatives());
      case 4: return fmt::format("    bool {} = {};\n", id(), pick(kConditions));
      case 5: return fmt::format("    light {} = {}", id(), alternatives());
      case 6: return fmt::format("    shared {} = {}", id(), alternatives());
      case 7:
        if (depth > 2) return {};
        return fmt::format("    term odd.t{} when {} {{\n{}{}    }}\n", ++lines_, pick(kConditions),
                           line(depth + 1), line(depth + 1));
      default: return fmt::format("    {} = {}", id(), alternatives());
    }
  }

  int lines_ = 0;
};

constexpr std::string_view kMaterials = R"({"asset": {"version": "2.0"}, "textures": [{}, {}], "materials": [
  {"name": "without", "normalTexture": {"index": 1}, "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}}},
  {"name": "alone", "normalTexture": {"index": 1}, "extensions": {"ODD_layer": {"oddFactor": 0.5}}},
  {"name": "under a clear coat", "extensions": {"ODD_layer": {"oddFactor": 0.5, "oddColor": [0.5, 1, 0.25]},
    "KHR_materials_clearcoat": {"clearcoatFactor": 1}}},
  {"name": "under much", "normalTexture": {"index": 1}, "extensions": {
    "ODD_layer": {"oddFactor": 1, "oddTexture": {"index": 0}}, "KHR_materials_coat": {"coatFactor": 0.5, "coatColorFactor": [1, 0.5, 0]},
    "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]}, "KHR_materials_anisotropy": {"anisotropyStrength": 0.5}}}]})";

/// Errors that a user could not place or look up.
std::string unplaced(const Diagnostics& found) {
  if (found.empty()) return "it is refused without a word";
  for (const Diagnostic& one : found) {
    if (one.severity == Severity::Error &&
        (one.code.empty() || one.place.file.empty() || one.message.empty()))
      return "an error has no code, no place or no words: " + format(one);
  }
  return {};
}

/// The part's nodes have ids of the part, the library's those of the library.
std::string mixed(const graph::Graph& graph) {
  for (const graph::Node& node : graph.nodes) {
    if (node.type.starts_with("odd_") && !node.id.starts_with("odd"))
      return fmt::format("'{}' has become a {}", node.id, node.type);
  }
  return {};
}

class Judge {
public:
  Judge(const Language& language, const Language& plain, const Options& options)
      : language_(language), plain_(plain), options_(options) {}

  std::string run(const material::Document& with, const material::Document& without) {
    for (const material::Material& material : with.materials) {
      const Result<graph::Graph> graph = graphOf(material, language_);
      if (!graph) {
        if (std::string wrong = unplaced(graph.error()); !wrong.empty()) return wrong;
        if (&material == with.materials.data()) return "a material without the extension has no graph";
        continue;
      }
      const Result<graph::Graph> again = graphOf(material, language_);
      if (!again || graph::toJson(*graph) != graph::toJson(*again)) return "one material has two graphs";
      if (std::string wrong = mixed(*graph); !wrong.empty()) return wrong;
      if (std::string wrong = lowered(*graph); !wrong.empty()) return wrong;
    }
    const Result<graph::Graph> changed = graphOf(with.materials[0], language_);
    const Result<graph::Graph> plain = graphOf(without.materials[0], plain_);
    return changed && plain && graph::toJson(*changed) == graph::toJson(*plain)
               ? std::string()
               : "a material without the extension has another graph";
  }

private:
  Result<graph::Graph> graphOf(const material::Material& material, const Language& language) const {
    Diagnostics said;
    return buildGraph(material, {true, true, false, {true, false, false, false}}, language, options_, said);
  }

  std::string lowered(graph::Graph graph) const {
    // A line may have values of several types, and a light's rate is the graph's to find: that is refused
    // here.
    const Diagnostics found = graph::check(graph, language_);
    if (lacquer::hasError(found)) {
      for (const Diagnostic& one : found) {
        if (one.code.empty() || one.message.empty() || one.place.pointer.empty())
          return "an error of the graph has no place: " + format(one);
      }
      return {};
    }
    const Result<ir::Module> module = toModule(graph, language_, options_, {});
    if (!module) return "an accepted part makes no module: " + format(module.error()[0]);
    const std::vector<std::string> unsound = ir::verify(*module);
    return unsound.empty() ? std::string() : "a module does not hold: " + unsound[0];
  }

  const Language& language_;
  const Language& plain_;
  const Options& options_;
};

}  // namespace

/// A text that begins with `///` is the part itself.
std::string feedPart(std::string_view bytes) {
  const std::string part = bytes.starts_with("///") ? std::string(bytes) : Writer(bytes).run();
  lang::Library library = lang::Library::embedded();
  if (const Result<void> added = library.add({{"odd.node", std::string(kExtension) + part}}); !added)
    return unplaced(added.error());
  const Language language(std::move(library));
  static const Language kPlain(lang::Library::embedded());
  Options options = optionsOf(bytes);
  options.simplify.clear();
  if (!resolveNames(language, options)) return {};
  const Diagnostics found = language.checkAll();
  if (lacquer::hasError(found)) return unplaced(found);
  if (const Result<const model::Model*> model = language.models.of(options.profile); !model)
    return unplaced(model.error());
  const Result<const material::Schema*> schema = language.models.schema();
  const Result<const material::Schema*> plain_schema = kPlain.models.schema();
  if (!schema || !plain_schema) return "the extension's schema is refused";
  const auto with = material::readText(std::string(kMaterials), "odd.gltf", **schema, {});
  const auto without = material::readText(std::string(kMaterials), "odd.gltf", **plain_schema, {});
  if (!with || !without) return "the materials are refused";
  const std::string wrong = Judge(language, kPlain, options).run(*with, *without);
  return wrong.empty() ? wrong : fmt::format("{}\nof{}", wrong, part);
}

}  // namespace lacquer::fuzz
