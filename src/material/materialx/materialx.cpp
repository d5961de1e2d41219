#include "materialx/materialx.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <optional>
#include <tuple>

#include "materialx/closures.h"
#include "materialx/surface.h"
#include "mtlx/element.h"
#include "mtlx/looks.h"
#include "mtlx/models.h"
#include "support/text.h"

namespace lacquer::materialx {

using graph::Source;
using json::Json;

bool isXml(std::string_view text) {
  if (!wideEncoding(text).empty()) return true;
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '<';
}

std::string_view Procedural::output(std::string_view name) const {
  for (const auto& [in_file, in_group] : outputs) {
    if (name.empty() || in_file == name) return in_group;
  }
  return {};
}

namespace {

/// The form of the node for a type; any, where the document does not say it.
std::string texelOf(std::optional<ir::Type> type) {
  if (!type || ir::isMatrix(*type) || ir::isTexture(*type)) return "texel_of";
  return fmt::format("texel_of<{}>", ir::typeName(*type));
}

class MaterialsReader {
public:
  MaterialsReader(Document& document, const lang::Library& library, bool translates, PatternOptions options)
      : document_(document),
        translates_(translates),
        most_(options.most),
        patterns_({&document.root}, library, std::move(options)) {}

  /// `said`: what was wrong with variants.
  Result<Materials> read(const VariantMaterials& variants, Diagnostics said);

private:
  struct Made {
    std::string name;
    std::string surface;  ///< its category
    std::string pointer;  ///< of its surface of closures
    double error = 0;     ///< of its translation
    std::string element;  ///< its element's name; of a pattern's output none
    Place place;
    Place surface_place;
    Scope* scope = nullptr;
    Diagnostics said;
    Json json;
    std::vector<std::pair<std::string, std::string>> outputs;
    std::vector<std::pair<std::string, std::string>> closures;
    Scope* displacement = nullptr;
  };
  struct Found {
    const Element* shader = nullptr;
    const Element* owner = nullptr;
    std::optional<Diagnostic> wrong = {};
  };

  Found shaderOf(const Element& material);
  void closures(Made& made, const Found& found);
  void material(const Element& at, std::string_view name, const Found& found, Diagnostics said);
  void displacement(const Element& at);
  void refuse(const Element& at, std::string_view name);
  Result<void> patternsAlone();
  void pattern(const Element& owner, const Element& output, const std::string& name, bool instance = false);
  void tellRange(const Element& owner, const Element& output, Diagnostics& said);
  static bool isSurface(const Element& element) {
    const std::vector<std::string_view> names = translated();
    return element.get("type") == "surfaceshader" ||
           std::find(names.begin(), names.end(), element.category) != names.end();
  }

  Document& document_;
  bool translates_;
  uint64_t most_;  ///< patterns
  Patterns patterns_;
  std::vector<Made> made_;
  std::deque<Element> uses_;  ///< inputs that take a nodegraph's output, for patterns
};

/// The surface of a material, and what it stands in.
MaterialsReader::Found MaterialsReader::shaderOf(const Element& material) {
  const Element& root = document_.root;
  const Element* in = material.child("input", "surfaceshader");
  if (in == nullptr) return {};
  const auto node = [&](const Element& owner, std::string_view name) {
    return patterns_.nodeOf(owner, name);
  };
  const std::string* nodegraph = in->find("nodegraph");
  const Element* graph = nodegraph == nullptr ? nullptr : root.child("nodegraph", *nodegraph);
  const Element* found = nodegraph == nullptr ? node(root, in->get("nodename")) : nullptr;
  if (found != nullptr && found->category == "nodegraph") graph = std::exchange(found, nullptr);
  if (graph == nullptr) return {found, &root};
  if (const auto outputs = outputsOf(*graph); outputs.size() > 1 && in->get("output").empty())
    return {nullptr, &root, unnamedOutput(*in, graph->name(), outputs)};
  for (const Element& output : graph->children) {
    const bool wanted =
        output.category == "output" && (in->get("output").empty() || output.name() == in->get("output"));
    if (wanted) return {node(*graph, output.get("nodename")), graph};
  }
  return {};
}

void MaterialsReader::material(const Element& at, std::string_view name, const Found& found,
                               Diagnostics said) {
  Made made;
  made.name = name;
  made.element = at.name();
  made.place = at.place;
  made.said = std::move(said);
  if (found.shader != nullptr) made.surface = found.shader->category;
  made.surface_place = found.shader != nullptr ? found.shader->place : at.place;
  const auto wrong = [&](const Element& where, std::string code, std::string message, std::string help) {
    made.said.push_back(
        {std::move(code), Severity::Error, where.place, std::move(message), std::move(help), {}});
  };
  made.json = Json::object();
  made.json["name"] = Json(name);
  if (found.wrong) {
    made.said.push_back(*found.wrong);
  } else if (found.shader == nullptr) {
    wrong(at, "no-such-node", fmt::format("the material {} has no surface", quote(name)),
          "its input surfaceshader names one");
  } else if (const std::string_view type = found.shader->get("type");
             type != "surfaceshader" && (typeOf(type) || !closureParts(type).empty())) {
    const Element* in = at.child("input", "surfaceshader");
    wrong(in == nullptr ? at : *in, "wrong-type",
          fmt::format("the input \"surfaceshader\" is of the type \"surfaceshader\", and {} is {}",
                      quote(found.shader->name()), quote(type)),
          "a node \"surface\" makes a surfaceshader of a BSDF and an EDF");
  } else {
    made.scope = &patterns_.body(*found.owner, fmt::format("{}_material", name));
    const Element* unlit = translates_ ? patterns_.unlit(*found.owner, *found.shader) : nullptr;
    const Element& shader = unlit != nullptr ? *unlit : *found.shader;
    Surface surface(patterns_, *made.scope, shader, made.said);
    const Element* model = patterns_.modelOf(*found.shader);
    const bool own = model != nullptr || patterns_.givesClosure(*found.shader);
    for (const Element& input : found.shader->children) {
      const Element* port = model == nullptr || !translates_ || input.category != "input"
                                ? nullptr
                                : model->child("input", input.name());
      std::optional<Diagnostic> is = port == nullptr ? std::nullopt : Patterns::wrongType(input, *port);
      if (is) made.said.push_back(std::move(*is));
    }
    if ((translates_ || !own) && translate(surface, shader.category)) {
      made.json = surface.finish(name, made_.size());
      made.outputs = surface.outputs();
      made.error = translationError(made.surface);
    } else if (patterns_.givesClosure(*found.shader)) {
      closures(made, found);
    } else {
      wrong(*found.shader, "unsupported-surface",
            fmt::format("the surface {} is not translated", quote(found.shader->category)),
            "there are " + listOf(translated()) + ", and those that are made of closures");
    }
  }
  made_.push_back(std::move(made));
}

/// A surface of closures: what its group computes goes to the template's ports as it is.
void MaterialsReader::closures(Made& made, const Found& found) {
  const Element& shader = *found.shader;
  made.scope->nameSurface(shader);
  if (found.owner->category == "nodegraph") made.pointer = fmt::format("/{}", found.owner->name());
  made.pointer += fmt::format("/{}", shader.name());
  const Alpha alpha = patterns_.alphaOf(shader);
  for (const ClosurePart& part : closureParts("surfaceshader")) {
    const std::string port(part.name);
    if (port == "alpha" && alpha == Alpha::Opaque) continue;
    std::optional<Source> source = patterns_.closure(*made.scope, shader, port);
    if (!source) continue;
    std::string name = port;
    if (port == "alpha" && alpha == Alpha::Mask) {
      name = "hidden";
      source = patterns_.add(*made.scope, "hidden", "closure_hidden", {{"alpha", *source}});
    }
    made.scope->group().outputs.emplace_back(name, *source);
    made.closures.emplace_back(name, name);
  }
  // MaterialX's closures are alike on both sides.
  made.json["doubleSided"] = true;
  if (alpha == Alpha::Blend) made.json["alphaMode"] = "BLEND";
  if (alpha == Alpha::Mask) made.json["alphaMode"] = "MASK";
}

/// What moves the vertices, of the material that was made last.
void MaterialsReader::displacement(const Element& at) {
  const Element* in = at.child("input", "displacementshader");
  if (in == nullptr || !isConnected(*in)) return;
  Scope& scope = patterns_.body(document_.root, fmt::format("{}_displacement", at.name()));
  made_.back().displacement = &scope;
  if (const std::optional<Source> source = patterns_.connected(scope, *in))
    scope.group().outputs.emplace_back("displacement", *source);
}

/// What is no surface: a material with an error.
void MaterialsReader::refuse(const Element& at, std::string_view name) {
  const std::optional<Refusal> why = refused(at);
  if (!why) return;
  Made made;
  made.name = name;
  made.element = at.name();
  made.place = at.place;
  made.said.push_back({"unsupported-closure",
                       Severity::Error,
                       at.place,
                       fmt::format("{} is not drawn: {}", quote(at.category), why->why),
                       why->help,
                       {}});
  made_.push_back(std::move(made));
}

/// A pattern's output, as a colour without light. `instance`: what stands beside the nodegraph is connected
/// to its inputs, and so reaches an instance of it alone.
void MaterialsReader::pattern(const Element& owner, const Element& output, const std::string& name,
                              bool instance) {
  const std::optional<ir::Type> type = typeOf(output.get("type"));
  if (!type || ir::isMatrix(*type) || ir::isTexture(*type)) return;
  Made made;
  made.name = name;
  Element use{"input",
              {{"name", std::string(output.name())}, {"type", std::string(output.get("type"))}},
              {},
              output.place};
  use.set("nodegraph", std::string(owner.name()));
  use.set("output", std::string(output.name()));
  made.scope = &patterns_.body(instance ? document_.root : owner, fmt::format("{}_pattern", name));
  const std::string property = "baseColorTexture";
  made.place = made.surface_place = output.place;
  tellRange(owner, output, made.said);
  const Element& from = instance ? uses_.emplace_back(std::move(use)) : output;
  std::optional<Source> source = patterns_.connected(*made.scope, from);
  made.json = Json::object();
  made.json["name"] = name;
  made.json["extensions"]["KHR_materials_unlit"] = Json::object();
  if (source) {
    const Source texel = patterns_.add(*made.scope, "texel", texelOf(type), {{"value", *source}});
    made.scope->group().outputs.emplace_back(property, texel);
    made.outputs.emplace_back(property, property);
    Json& own = made.json["pbrMetallicRoughness"][property]["extensions"]["KHR_texture_procedurals"];
    own["index"] = static_cast<uint64_t>(made_.size());
    own["output"] = property;
  }
  made_.push_back(std::move(made));
}

/// Says where a pattern is a number that no colour without light has here.
void MaterialsReader::tellRange(const Element& owner, const Element& output, Diagnostics& said) {
  const Element* node = patterns_.nodeOf(owner, output.get("nodename"));
  const bool constant = node != nullptr && node->category == "constant";
  const Element* number = constant ? node->child("input", "value") : nullptr;
  if (number == nullptr || isConnected(*number) || number->find("value") == nullptr) return;
  const std::optional<ir::Type> type = typeOf(number->get("type"));
  if (!type || (*type != ir::Type::Float && !ir::isFloatVector(*type))) return;
  const Result<ir::Components> read = valueOf(*number, *type, patterns_.units());
  if (!read || std::all_of(read->begin(), read->end(), [](double x) { return x >= 0 && x <= 1; })) return;
  const std::string_view space = number->get("colorspace");
  const bool other = ir::isFloatVector(*type) && !space.empty() && space != "lin_rec709";
  const std::string linear = other ? fmt::format(" of {}, in lin_rec709 {:.4g}, {:.4g}, {:.4g}", space,
                                                 (*read)[0], (*read)[1], (*read)[2])
                                   : std::string();
  said.push_back(
      {"out-of-range",
       Severity::Warning,
       number->place,
       fmt::format("the pattern {} is {}{}", quote(output.name()), quote(number->get("value")), linear),
       "its colour is drawn from 0 to 1, and the nearest numbers are taken: a surface_unlit has others",
       {}});
}

Result<void> MaterialsReader::patternsAlone() {
  const Element& root = document_.root;
  uint64_t outputs_of_all = 0;
  for (const Element& child : root.children) {
    if (child.category != "nodegraph") continue;
    outputs_of_all +=
        static_cast<uint64_t>(std::count_if(child.children.begin(), child.children.end(),
                                            [](const Element& e) { return e.category == "output"; }));
  }
  if (outputs_of_all > most_)
    return fail("too-many", root.place,
                fmt::format("the nodegraphs have {} outputs, more than {}", outputs_of_all, most_),
                raising("nodes"));
  std::set<std::string_view> bodies;  // of definitions
  for (const Element& child : root.children)
    if (child.category == "implementation") bodies.insert(child.get("nodegraph"));
  for (const Element& child : root.children) {
    if (bodies.contains(child.name()) && child.category == "nodegraph") continue;
    if (child.category == "output") pattern(root, child, std::string(child.name()));
    if (child.category != "nodegraph" || !child.get("nodedef").empty()) continue;
    const auto outputs = std::count_if(child.children.begin(), child.children.end(),
                                       [](const Element& e) { return e.category == "output"; });
    const bool instance = std::any_of(child.children.begin(), child.children.end(), [](const Element& e) {
      return e.category == "input" && isConnected(e);
    });
    for (const Element& output : child.children) {
      if (output.category != "output" || !isConnected(output)) continue;
      pattern(child, output,
              outputs == 1 ? std::string(child.name()) : fmt::format("{}/{}", child.name(), output.name()),
              instance);
    }
  }
  return {};
}

Result<Materials> MaterialsReader::read(const VariantMaterials& variants, Diagnostics said) {
  const Element& root = document_.root;
  for (const Element& child : root.children) {
    const Element* volume = child.child("input", "volumeshader");
    if (child.category == "volumematerial" && volume != nullptr && isConnected(*volume))
      refuse(child, child.name());
    if (child.category != "surfacematerial") continue;
    Diagnostics left_out;
    if (const Element* in = child.child("input", "backsurfaceshader"); in != nullptr && isConnected(*in))
      left_out.push_back({"not-translated",
                          Severity::Warning,
                          in->place,
                          "backsurfaceshader has no counterpart in glTF",
                          "it is left out",
                          {}});
    const std::string_view shown = child.get("uiname");
    material(child, shown.empty() ? child.name() : shown, shaderOf(child), std::move(left_out));
    displacement(child);
  }
  if (made_.empty()) {
    for (const Element& child : root.children) {
      if (isSurface(child) && child.category != "nodedef" && child.category != "output" &&
          child.category != "input")
        material(child, child.name(), {&child, &root}, {});
    }
  }
  if (made_.empty()) {
    if (Result<void> read = patternsAlone(); !read) return tl::make_unexpected(std::move(read.error()));
  }
  for (size_t i = 0, any = made_.size(); any == 0 && i < root.children.size(); ++i) {
    if (root.children[i].category != "nodedef") refuse(root.children[i], root.children[i].name());
  }
  if (made_.empty())
    return fail("no-materials", root.place,
                "the document has no material, no surface and no pattern's output",
                "a surfacematerial, a surface, or a nodegraph with an output is drawn");
  patterns_.finish();
  Materials result;
  result.files = document_.files;
  for (const Diagnostic& one : patterns_.wrong()) addBounded(result.diagnostics, one);
  std::vector<std::string> names;
  for (const Made& made : made_) names.push_back(made.element);
  result.looks = readLooks(root, names, variants, said);
  std::stable_sort(said.begin(), said.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.place.file, a.place.line, a.place.column) <
           std::tie(b.place.file, b.place.line, b.place.column);
  });
  for (Diagnostic& one : said) addBounded(result.diagnostics, std::move(one));
  for (Made& made : made_) {
    const auto isWrong = [&](Scope* scope) {
      return scope != nullptr && patterns_.isWrong(scope->group().name);
    };
    const bool wrong = isWrong(made.scope) || isWrong(made.displacement);
    if (wrong) {
      made.said.push_back({"wrong-pattern",
                           Severity::Error,
                           made.place,
                           fmt::format("a pattern of the material {} is wrong", quote(made.name)),
                           "the errors of the file say where",
                           {}});
    }
    if (hasError(made.said)) {
      made.json = Json::object();
      made.json["name"] = made.name;
    }
    result.materials.push_back(std::move(made.json));
    result.of_materials.push_back(std::move(made.said));
    result.closures.push_back(std::move(made.closures));
    result.surfaces.push_back(
        {std::move(made.surface), made.error, std::move(made.pointer), std::move(made.surface_place)});
    const bool moved = !wrong && made.displacement != nullptr && !made.displacement->group().outputs.empty();
    result.displacements.push_back(moved ? made.displacement->group().name : std::string());
    result.procedurals.list.push_back(
        {made.scope == nullptr ? std::string() : made.scope->group().name, std::move(made.outputs), wrong});
  }
  result.procedurals.patterns = std::make_shared<const graph::Graph>(std::move(patterns_.graph()));
  return result;
}

}  // namespace

Result<Materials> readMaterials(std::string_view text, const std::string& path, const lang::Library& library,
                                MaterialOptions options) {
  Result<Document> document = readXml(text, path, options.limits, options.included);
  if (!document) return tl::make_unexpected(document.error());
  Diagnostics said = std::move(document->said);
  const VariantMaterials variants = addVariants(document->root, said);
  takeDisabled(document->root);
  makeConversionsUnlit(document->root);
  addTangentSpace(document->root);
  document->root.index();
  return MaterialsReader(*document, library, options.translate,
                         {true,
                          options.limits.nodes,
                          {},
                          std::move(options.reserved),
                          true,
                          &surfaceModels(),
                          options.definitions.get()})
      .read(variants, std::move(said));
}

Procedurals readProcedurals(const Json& extension, const std::string& path, const lang::Library& library,
                            const ProceduralOptions& options, Diagnostics& diagnostics) {
  Diagnostics wrong;
  Element root;
  root.category = "materialx";
  ProceduralElements read = readProcedurals(extension, path, options.limits, options.textures, wrong);
  const size_t count = read.list.size();
  root.children = std::move(read.list);
  std::move(read.definitions.begin(), read.definitions.end(), std::back_inserter(root.children));
  root.index();
  Patterns patterns({&root}, library,
                    {false, options.limits.nodes, options.animated, options.reserved, false, nullptr,
                     options.definitions.get()});
  Procedurals made;
  made.required = options.required;
  std::vector<Scope*> scopes;
  for (size_t i = 0; i < count; ++i) {
    const Element& graph = root.children[i];
    Procedural& one = made.list.emplace_back();
    Scope*& scope = scopes.emplace_back(nullptr);
    one.wrong = graph.children.empty();
    if (one.wrong) continue;
    scope = &patterns.body(graph, graph.name().empty() ? "procedural" : graph.name());
    one.group = scope->group().name;
    for (const Element& output : graph.children) {
      if (output.category != "output") continue;
      const std::optional<Source> source = patterns.connected(*scope, output);
      if (!source) continue;
      const Source texel = patterns.add(*scope, fmt::format("{}_texel", output.name()),
                                        texelOf(typeOf(output.get("type"))), {{"value", *source}});
      scope->group().outputs.emplace_back(graphName(output.name()), texel);
      one.outputs.emplace_back(output.name(), graphName(output.name()));
    }
  }
  patterns.finish();
  for (size_t i = 0; i < made.list.size(); ++i) {
    if (scopes[i] != nullptr) made.list[i].wrong = patterns.isWrong(made.list[i].group);
  }
  for (const Diagnostics* list : {&std::as_const(wrong), &patterns.wrong()}) {
    for (Diagnostic one : *list) {
      if (!options.required && one.severity == Severity::Error) one.severity = Severity::Warning;
      addBounded(diagnostics, std::move(one));
    }
  }
  made.patterns = std::make_shared<const graph::Graph>(std::move(patterns.graph()));
  return made;
}

}  // namespace lacquer::materialx
