// Nodes of the library, and what they are given: numbers, texts, images.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "graph/contracts.h"
#include "graph/text.h"
#include "lang/suggest.h"
#include "materialx/closures.h"
#include "materialx/patterns.h"
#include "support/text.h"

namespace lacquer::materialx {

using graph::Source;

namespace {

/// What no node is given: how an image is read becomes the texture's sampler, and a note is for people.
bool isBeside(std::string_view input) {
  constexpr std::string_view kNames[] = {
      "filtertype", "uaddressmode", "vaddressmode", "wrapS",       "wrapT",          "layer", "layerx",
      "layery",     "layerz",       "framerange",   "frameoffset", "frameendaction", "note"};
  return std::find(std::begin(kNames), std::end(kNames), input) != std::end(kNames);
}

/// Along which axes an image is there once: a node's word for MaterialX's address mode `constant`.
constexpr std::string_view kEnds = "ends";

/// What stands for an image that is not there.
bool isFallback(std::string_view input) { return input == "default" || input == "fallback"; }

/// An input of MaterialX's that its shaders do nothing with either.
bool isIgnored(const Element& node, std::string_view input) {
  return node.category == "surface" && input == "thin_walled";
}

bool samplesFile(const Element& node) {
  return std::any_of(node.children.begin(), node.children.end(), [](const Element& child) {
    return child.category == "input" && child.get("type") == "filename";
  });
}

bool samples(const lang::NodeDecl& form) {
  return std::any_of(form.params.begin(), form.params.end(),
                     [](const lang::Param& param) { return ir::isTexture(param.type); });
}

const lang::Param* paramOf(const lang::NodeDecl& form, std::string_view name) {
  const auto it = std::find_if(form.params.begin(), form.params.end(),
                               [&](const lang::Param& p) { return p.name == name; });
  return it == form.params.end() ? nullptr : &*it;
}

/// Whether the form gives the node's type and has its inputs with their types.
bool gives(const lang::NodeDecl& form, const Element& node) {
  const std::optional<ir::Type> type = typeOf(node.get("type"));
  return form.results.size() > 1 || !type || form.results[0].type == *type;
}

bool takes(const lang::NodeDecl& form, const Element& node, bool types) {
  return std::all_of(node.children.begin(), node.children.end(), [&](const Element& input) {
    if (input.category != "input") return true;
    if (const auto parts = closureParts(input.get("type")); !parts.empty())
      return std::any_of(parts.begin(), parts.end(), [&](const ClosurePart& part) {
        return paramOf(form, fmt::format("{}_{}", input.name(), part.name)) != nullptr;
      });
    const lang::Param* param = paramOf(form, input.name());
    if (param == nullptr)
      return isBeside(input.name()) || isIgnored(node, input.name()) ||
             (isFallback(input.name()) && samples(form));
    const std::optional<ir::Type> type = typeOf(input.get("type"));
    // Channels of MaterialX 1.38 make another type of what is connected.
    const bool image = type && ir::isTexture(*type) && ir::isTexture(param->type);
    return !types || !type || image || param->type == *type || !param->choices.empty();
  });
}

bool isOfTiles(const lang::NodeDecl& form) {
  return std::any_of(form.params.begin(), form.params.end(),
                     [](const lang::Param& p) { return p.type == ir::Type::Texture2DArray; });
}

}  // namespace

/// Whether nodes of that name have a form for images of tiles.
bool Patterns::takesTiles(std::string_view category) const {
  const std::vector<const lang::NodeDecl*> forms = library_.forms(category);
  return std::any_of(forms.begin(), forms.end(), [](const lang::NodeDecl* form) { return isOfTiles(*form); });
}

namespace {

/// Which input of a node a definition has not, or has of another type; empty where it is none.
std::string unlikeIn(const Element& node, const Element& nodedef) {
  for (const Element& input : node.children) {
    if (input.category != "input" || input.find(kOfVariant) != nullptr) continue;
    const Element* port = nodedef.child("input", input.name());
    if (port == nullptr) return fmt::format(": it has no input {}", quote(input.name()));
    if (!input.get("type").empty() && port->get("type") != input.get("type"))
      return fmt::format(": its input {} is of the type {}", quote(input.name()), quote(port->get("type")));
  }
  return {};
}

}  // namespace

void Patterns::unknownNode(const Element& element) {
  if (const std::optional<Refusal> why = refused(element))
    return error(element, "unsupported-closure",
                 fmt::format("{} is not drawn: {}", quote(element.category), why->why), why->help);
  if (const std::vector<size_t> of = definitionsCalled(element); !of.empty()) {
    const Definition& one = definitions_[of[0]];
    return error(
        element, "no-such-definition",
        fmt::format("no definition of {} has this type, version and these inputs", quote(element.category)),
        fmt::format("{}{} stands in {}:{}{}", quote(one.nodedef->name()), of.size() > 1 ? ", the first," : "",
                    one.nodedef->place.file,
                    one.nodedef->place.line > 0 ? std::to_string(one.nodedef->place.line)
                                                : one.nodedef->place.pointer,
                    unlikeIn(element, *one.nodedef)));
  }
  if (const auto only = of_targets_.find(withoutNamespace(element.category)); only != of_targets_.end())
    return error(element, "unknown-node", fmt::format("there is no node {}", quote(element.category)),
                 fmt::format("{} in {}:{} is for the target {} alone: one without a target counts here",
                             quote(only->second->name()), only->second->place.file, only->second->place.line,
                             quote(only->second->get("target"))));
  std::string help = "the library has no such node, and the document does not define it";
  if (maySuggest()) {
    std::vector<std::string> whole;
    std::string alike;  // the same node of other namespaces
    for (const Definition& one : definitions_) {
      const std::string_view name = one.nodedef->get("node");
      const std::string_view space = one.nodedef->get("namespace");
      const bool named = space.empty() || space == element.get("namespace") || name.find(':') != name.npos;
      whole.push_back(named ? std::string(name) : fmt::format("{}:{}", space, name));
      if (withoutNamespace(name) != withoutNamespace(element.category) || whole.back() == element.category)
        continue;
      if (const std::string other = quote(whole.back()); alike.find(other) == alike.npos)
        alike += (alike.empty() ? "" : ", ") + other;
    }
    if (!alike.empty()) help = fmt::format("other namespaces have {}: their nodes are named so", alike);
    std::vector<std::string_view> names(whole.begin(), whole.end());
    for (const std::string_view name : library_.names(lang::DeclKind::Node))
      names.push_back(name.substr(0, name.find('<')));
    if (alike.empty()) help = lang::didYouMean(element.category, names, std::move(help));
  }
  error(element, "unknown-node", fmt::format("there is no node {}", quote(element.category)),
        std::move(help));
}

/// The form of a node of the library that the element means, by the types that it says.
const lang::NodeDecl* Patterns::formOf(Scope& scope, const Element& element) {
  std::vector<const lang::NodeDecl*> forms = library_.forms(libraryName(element));
  if (takesTiles(libraryName(element))) {
    // Those for images of tiles take such, and no others.
    const bool tiles =
        std::any_of(element.children.begin(), element.children.end(), [&](const Element& input) {
          return input.category == "input" && input.get("type") == "filename" &&
                 hasTiles(scope, element, input);
        });
    std::erase_if(forms, [&](const lang::NodeDecl* form) { return isOfTiles(*form) != tiles; });
  }
  if (forms.empty() || refused(element)) return unknownNode(element), nullptr;
  const lang::NodeDecl* found = nullptr;
  const lang::NodeDecl* near = nullptr;
  bool gives_any = false;
  for (const lang::NodeDecl* form : forms) {
    if (!gives(*form, element)) continue;
    gives_any = true;
    if (near == nullptr && takes(*form, element, false)) near = form;
    if (found == nullptr && takes(*form, element, true)) found = form;
  }
  if (found != nullptr || near != nullptr) {
    const Result<const lang::NodeDecl*> whole = library_.node((found != nullptr ? found : near)->name);
    if (whole) return *whole;
    error(element, "unknown-node",
          fmt::format("the node {} is wrong: {}", quote(element.category), whole.error()[0].message));
    return nullptr;
  }
  if (!gives_any) {
    std::vector<std::string_view> types;
    for (const lang::NodeDecl* form : forms) {
      const std::string_view type = nameOf(form->results[0].type);
      if (std::find(types.begin(), types.end(), type) == types.end()) types.push_back(type);
    }
    error(element, "wrong-type",
          fmt::format("the node {} gives no {}", quote(element.category), quote(element.get("type"))),
          "it gives " + listOf(types, "or"));
    return nullptr;
  }
  bool unknown = false;
  for (const Element& input : element.children) {
    if (input.category != "input") continue;
    std::vector<std::string_view> names;
    for (const lang::NodeDecl* form : forms) {
      for (const lang::Param& param : form->params) {
        if (std::find(names.begin(), names.end(), param.name) == names.end()) names.push_back(param.name);
      }
    }
    if (!closureParts(input.get("type")).empty()) continue;
    if (std::find(names.begin(), names.end(), input.name()) != names.end() || isBeside(input.name()))
      continue;
    error(input, "unknown-input",
          fmt::format("the node {} has no input {}", quote(element.category), quote(input.name())),
          input.name() == "disable" ? "it is read as a value, of a node with one output"
                                    : lang::didYouMean(input.name(), names));
    unknown = true;
  }
  if (unknown) return nullptr;
  error(element, "wrong-type",
        fmt::format("the node {} takes no inputs of these types", quote(element.category)),
        std::string(combines(element)));
  return nullptr;
}

void Patterns::libraryNode(Scope& scope, const Element& element, graph::Node& made) {
  if (!hasType(element)) return;
  const lang::NodeDecl* form = formOf(scope, withoutTargets(element));
  if (form == nullptr) return;
  made.type = form->name;
  std::string_view space;
  const bool may_end = paramOf(*form, kEnds) != nullptr;
  const std::string_view ends = may_end ? endsOf(scope, element) : "none";
  for (const Element& input : element.children) {
    if (input.category != "input") continue;
    for (const ClosurePart& part : closureParts(input.get("type"))) {
      std::string name = fmt::format("{}_{}", input.name(), part.name);
      if (!isConnected(input) || paramOf(*form, name) == nullptr) continue;
      if (std::optional<Source> one = connected(scope, input, part.name))
        made.inputs.emplace_back(std::move(name), std::move(*one));
    }
    const lang::Param* param = paramOf(*form, input.name());
    if (param == nullptr) continue;  // a sampler's
    std::optional<Source> source;
    if (ir::isTexture(param->type)) {
      source = image(scope, {&scope, &element}, input, param->type == ir::Type::Texture2DArray, {&element});
      space = input.get("colorspace");
    } else if (may_end && ends == "none" && isFallback(input.name())) {
      continue;  // the texture's alone
    } else if (isFallback(input.name()) && samplesFile(element) && !isConnected(input)) {
      // The texture's, too, and so no parameter.
      const Result<ir::Components> value = valueOf(input, param->type, units_, param->hints.unit);
      if (value) source = Source{graph::Literal{param->type, *value}, {}};
    } else if (input.get("type") == "string") {
      // MaterialX's own default is an empty text.
      const Element* said = text(scope, input);
      const bool empty = said == nullptr || (said->get("value").empty() && !param->choices.empty());
      if (!empty)
        source = param->choices.empty() ? attribute(scope, element, input, *param)
                                        : literal(scope, element, input, *param);
    } else if (isConnected(input)) {
      source = connected(scope, input);
    } else if (input.find("value") != nullptr) {
      source = ir::isMatrix(param->type) ? matrix(scope, element, input, param->type)
                                         : literal(scope, element, input, *param);
    }
    if (source) made.inputs.emplace_back(std::string(input.name()), std::move(*source));
  }
  withoutFiles(scope, element, *form, made);
  if (ends != "none")
    made.inputs.emplace_back(std::string(kEnds), Source{graph::Choice{std::string(ends)}, {}});
  for (const lang::Param& param : form->params) {
    if (options_.has_attributes && graph::isAttributeName(param.given) && !graph_.hasAttribute(param.given))
      graph_.attributes.emplace_back(param.given);
  }
  surroundings(scope, element, *form, made);
  const std::string_view type = element.get("type");
  const bool color = type == "color3" || type == "color4";
  if (color && isConverted(space)) {
    // What a texture's format does not decode.
    std::string converter = fmt::format("{}_to_lin_rec709", space == "lin_ap1" ? "acescg" : space);
    if (!isColorSpace(space) || library_.forms(converter).empty())
      return error(element, "unknown-colorspace",
                   fmt::format("the image is of the colour space {}", quote(space)),
                   "those of MaterialX's library are known: lin_rec709, srgb_texture, acescg, g22_rec709, …");
    putBehind(scope, element, made, std::move(converter), {{"in", {}}});
  }
  const std::optional<ir::Type> number = typeOf(type);
  if (const double scale = unitsOf(scope, element);
      scale != 1 && number && (*number == ir::Type::Float || ir::isFloatVector(*number))) {
    putBehind(scope, element, made, fmt::format("multiply<{}>", ir::typeName(*number)),
              {{"in1", {}}, {"in2", Source{graph::Literal{*number, {scale, scale, scale, scale}}, {}}}});
  }
  scope.group_.nodes.push_back(std::move(made));
  scope.elements_.push_back(&element);
}

/// Another node in the place of one, whose first input that one is.
void Patterns::putBehind(Scope& scope, const Element& element, graph::Node& made, std::string type,
                         graph::Inputs inputs) {
  graph::Node behind;
  behind.id = std::exchange(made.id, scope.taken_.free(made.id + "_texel"));
  behind.type = std::move(type);
  behind.inputs = std::move(inputs);
  behind.inputs[0].second = Source{graph::NodeRef{made.id, {}}, {}};
  scope.group_.nodes.push_back(std::exchange(made, std::move(behind)));
  scope.elements_.push_back(&element);
}

/// What brings the numbers of an image's file, or of a geometric property, from their unit to the scene's.
double Patterns::unitsOf(Scope& scope, const Element& element) {
  const auto scaleOf = [&](const Element& said) {
    if (said.get("unit").empty()) return 1.0;
    const Unit* unit = units_.find(said.get("unittype"), said.get("unit"));
    if (unit != nullptr) return unit->scale;
    const Diagnostic wrong = Units::unknown(said);
    error(said, wrong.code, wrong.message, wrong.help);
    return 1.0;
  };
  for (const Element& input : element.children) {
    if (input.category == "input" && input.get("type") == "filename") return scaleOf(input);
  }
  const Element* property =
      element.category == "geompropvalue" ? element.child("input", "geomprop") : nullptr;
  const Element* name = property == nullptr ? nullptr : text(scope, *property);
  const Element* found = name == nullptr ? nullptr : propertyNamed(name->get("value"));
  return found == nullptr ? 1.0 : scaleOf(*found);
}

/// Where no file is named the default colour stands for the image.
void Patterns::withoutFiles(Scope& scope, const Element& element, const lang::NodeDecl& form,
                            graph::Node& made) {
  for (const lang::Param& param : form.params) {
    if (!ir::isTexture(param.type) || element.child("input", param.name) != nullptr) continue;
    Element& none = made_.emplace_back();
    none.category = "input";
    none.set("name", std::string(param.name));
    none.set("type", "filename");
    none.place = element.place;
    if (std::optional<Source> source = image(scope, {&scope, &element}, none, false, {&element}))
      made.inputs.emplace_back(std::string(param.name), std::move(*source));
  }
}

// -- values --

/// Whether an animation changes the number of an input.
bool Patterns::isAnimated(const Element& input) const {
  const std::string& pointer = input.place.pointer;
  return !pointer.empty() &&
         (options_.animated.contains(pointer) || options_.animated.contains(pointer + "/value"));
}

/// A free name, of a matrix one whose columns' names are free, too.
std::string Patterns::parameterName(const std::string& wish, ir::Type type) {
  const int columns = ir::isMatrix(type) ? ir::componentCount(ir::partType(type)) : 0;
  const auto taken = [&](const std::string& name) {
    for (int i = 0; i < columns; ++i) {
      if (parameter_names_.has(graph::columnName(name, i))) return true;
    }
    return false;
  };
  std::string name = parameter_names_.free(wish);
  while (taken(name)) name = parameter_names_.free(wish);
  for (int i = 0; i < columns; ++i) parameter_names_.take(graph::columnName(name, i));
  return name;
}

/// A parameter for a number of the document, named as there: "NG/noise/amplitude", "noise/amplitude" beside
/// the graphs.
graph::Parameter& Patterns::parameter(const Scope& scope, const Element& element, const Element& input,
                                      ir::Type type) {
  std::vector<std::string_view> path;
  if (scope.owner_->category == "nodegraph") path.push_back(scope.owner_->name());
  if (&element != scope.owner_) path.push_back(element.name());
  path.push_back(input.name());
  std::string name;
  std::string pointer;
  for (const std::string_view part : path) {
    name += (name.empty() ? "" : "_") + graphName(part);
    pointer += fmt::format("/{}", part);
  }
  graph::Parameter& made = graph_.parameters.emplace_back();
  made.name = parameterName(name, type);
  made.type = type;
  made.animated = isAnimated(input);
  made.pointer = input.place.pointer.empty() ? pointer : input.place.pointer;
  return made;
}

std::optional<Source> Patterns::literal(Scope& scope, const Element& element, const Element& input,
                                        const lang::Param& param) {
  // A text, its own or that of the interface.
  if (!param.choices.empty() && input.get("type") != "integer") {
    const Element* from = text(scope, input);
    if (from == nullptr) return std::nullopt;
    const std::string value(from->get("value"));
    if (std::find(param.choices.begin(), param.choices.end(), value) != param.choices.end())
      return Source{graph::Choice{value}, {}};
    error(input, "unknown-value", fmt::format("{} is {}", quote(input.name()), quote(value)),
          fmt::format("it must be {}", listOf(param.choices, "or")));
    return std::nullopt;
  }
  if (!typeOf(input.get("type")) && !input.get("type").empty()) {
    if (input.get("value").empty()) return std::nullopt;
    error(input, "wrong-type",
          fmt::format("{} is of the type {}", quote(input.name()), quote(input.get("type"))),
          fmt::format("it must be {}", quote(nameOf(param.type))));
    return std::nullopt;
  }
  const ir::Type type = typeOf(input.get("type")).value_or(param.type);
  if (ir::isMatrix(type)) return matrix(scope, element, input, type);
  const Result<ir::Components> value = valueOf(input, type, units_, param.hints.unit);
  if (!value) {
    for (const Diagnostic& one : value.error()) error(input, one.code, one.message, one.help);
    return std::nullopt;
  }
  const bool number = type == ir::Type::Float || ir::isFloatVector(type);
  if (!number || scope.model_ || (!options_.editable && !isAnimated(input)))
    return Source{graph::Literal{type == ir::Type::Int ? ir::Type::Float : type, *value}, {}};
  for (int i = 0; param.has_range && i < ir::componentCount(type); ++i) {
    const double x = (*value)[static_cast<size_t>(i)];
    if (param.range.contains(x)) continue;
    error(input, "out-of-range", fmt::format("{} is {}", quote(input.name()), x),
          fmt::format("the range is {}", ir::rangeText(param.range)));
    return std::nullopt;
  }
  ir::Range range;
  if (param.has_range) range = param.range;
  graph::Parameter& made = parameter(scope, element, input, type);
  made.value = made.neutral = *value;
  made.range = range;
  return Source{graph::ParameterRef{made.name}, {}};
}

/// A matrix of numbers: a parameter, or by its rows, which the node `creatematrix` takes. Its rows are the
/// columns of a mat3.
std::optional<Source> Patterns::matrix(Scope& scope, const Element& element, const Element& input,
                                       ir::Type type) {
  const size_t side = type == ir::Type::Mat3 ? 3 : 4;
  const std::optional<std::vector<double>> numbers = numbersOf(input.get("value"));
  if (!numbers || numbers->size() != side * side) {
    error(input, "wrong-value",
          fmt::format("the value of {} is {}", quote(input.name()), quote(input.get("value"))),
          fmt::format("it must be {} numbers, with commas between", side * side));
    return std::nullopt;
  }
  if (options_.editable || isAnimated(input)) {
    graph::Parameter& made = parameter(scope, element, input, type);
    made.setNumbers(*numbers);
    made.setNeutralNumbers(*numbers);
    return Source{graph::ParameterRef{made.name}, {}};
  }
  graph::Inputs rows;
  for (size_t row = 0; row < side; ++row) {
    ir::Components components{};
    std::copy_n(numbers->begin() + static_cast<ptrdiff_t>(row * side), side, components.begin());
    rows.emplace_back(fmt::format("in{}", row + 1),
                      Source{graph::Literal{side == 3 ? ir::Type::Vec3 : ir::Type::Vec4, components}, {}});
  }
  return add(scope, fmt::format("{}_{}", element.name(), input.name()), "creatematrix", std::move(rows));
}

}  // namespace lacquer::materialx
