// What is wrong with a document before anything is computed: types that do not fit, definitions with flaws.
// And what inputs are connected to.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "lang/suggest.h"
#include "materialx/closures.h"
#include "materialx/patterns.h"
#include "materialx/surface.h"
#include "mtlx/looks.h"
#include "support/say_once.h"
#include "support/text.h"

namespace lacquer::materialx {

namespace {

/// Whether two types are said and are one in a graph: a color3 is a vector3.
bool isOneHere(std::string_view a, std::string_view b) {
  if (a == b || a.empty() || b.empty()) return true;
  return typeOf(a) && typeOf(a) == typeOf(b);
}

const std::vector<std::string_view> kTypes{
    "float",         "integer",      "boolean",      "color3",      "color4",
    "vector2",       "vector3",      "vector4",      "matrix33",    "matrix44",
    "string",        "filename",     "BSDF",         "EDF",         "VDF",
    "surfaceshader", "material",     "volumeshader", "lightshader", "displacementshader",
    "multioutput",   "integerarray", "floatarray",   "color3array", "color4array",
    "vector2array",  "vector3array", "vector4array", "stringarray", "geomnamearray",
    "geomname",      "none"};

bool isTypeName(std::string_view type) {
  return type.empty() || std::find(kTypes.begin(), kTypes.end(), type) != kTypes.end();
}

}  // namespace

/// What is wrong with the documents' own definitions; a library's has been said.
void Patterns::findFlaws() {
  for (const Element* document : documents_) {
    if (document == options_.definitions || document == options_.models) continue;
    for (Flaw& flaw : flawsOf(*document, nodedefs_, nodegraphs_)) {
      for (const std::string_view nodedef : flaw.nodedefs) flaws_of_[nodedef].push_back(flaws_.size());
      flaws_.push_back(std::move(flaw));
    }
  }
}

/// Something is a node of a definition: what is wrong with that is an error.
void Patterns::checkDefinition(const Element& nodedef) {
  const Definition* made = options_.definitions == nullptr ? nullptr : definition(nodedef);
  if (made != nullptr) used_files_.insert(nodedef.place.file);
  if (made != nullptr && made->graph != nullptr) used_files_.insert(made->graph->place.file);
  const auto of = flaws_of_.find(nodedef.name());
  if (of == flaws_of_.end()) return;
  if (now_ != nullptr) broken_.insert(now_->group_.name);
  for (const size_t flaw : of->second) {
    told_.insert(flaw);
    addBoundedOnce(wrong_, flaws_[flaw].said);
  }
}

/// Flaws of what nothing uses, and what a library's files say that are used.
void Patterns::tellWarnings() {
  for (size_t i = 0; i < flaws_.size(); ++i) {
    Diagnostic unused = flaws_[i].said;
    unused.severity = Severity::Warning;
    if (!told_.contains(i)) addBounded(wrong_, std::move(unused));
  }
  if (options_.definitions == nullptr) return;
  for (const Element& one : options_.definitions->children) {
    if (one.category == kWarning && used_files_.contains(one.place.file))
      warning(one, std::string(one.get("code")), std::string(one.get("message")),
              std::string(one.get("help")));
  }
}

/// Whether a definition is for other renderers alone (`target`): its node has none here.
bool Patterns::isOfTarget(const Element& nodedef) {
  if (nodedef.get("target").empty()) return false;
  const std::string_view node = withoutNamespace(nodedef.get("node"));
  of_targets_.try_emplace(node, &nodedef);
  for (const Element& port : nodedef.children) {
    if (port.category == "input") inputs_of_targets_.emplace(node, port.name());
  }
  return true;
}

/// Whether an input is one that other renderers' definitions of the node have: others leave it out.
bool Patterns::isOfTarget(const Element& node, const Element& input) const {
  return inputs_of_targets_.contains({withoutNamespace(node.category), input.name()});
}

/// A node of the library without such inputs, and without those of variants that it does not have.
const Element& Patterns::withoutTargets(const Element& node) {
  const std::vector<const lang::NodeDecl*> forms = library_.forms(libraryName(node));
  const auto is = [&](const Element& input) {
    return input.category == "input" && (isOfTarget(node, input) || input.find(kOfVariant) != nullptr) &&
           std::none_of(forms.begin(), forms.end(), [&](const lang::NodeDecl* form) {
             return std::any_of(form->params.begin(), form->params.end(),
                                [&](const lang::Param& param) { return param.name == input.name(); });
           });
  };
  if (std::none_of(node.children.begin(), node.children.end(), is)) return node;
  Element& own = made_.emplace_back(node);
  std::erase_if(own.children, is);
  return own;
}

/// Whether one version of a definition is the default of a node that asks for none.
void Patterns::checkVersion(const Element& node) {
  const std::vector<const Element*> all = definitionsOf(node);
  std::vector<const Element*> versions, defaults;
  for (const Element* one : all) {
    const std::string_view version = one->get("version");
    const bool known = std::any_of(versions.begin(), versions.end(), [&](const Element* other) {
      return isOneVersion(other->get("version"), version);
    });
    if (!known) versions.push_back(one);
    if (one->get("isdefaultversion") == "true") defaults.push_back(one);
  }
  if (!node.get("version").empty() || versions.size() < 2 || defaults.size() == 1) return;
  const Element& taken = *definitionOf(node);
  warning(node, "no-default-version",
          fmt::format(
              "{} has {} versions, and {}", quote(node.category), versions.size(),
              defaults.empty() ? "none is the default" : fmt::format("{} are the default", defaults.size())),
          fmt::format("{} in {}:{} is taken: \"version\" says which one is meant, and \"isdefaultversion\" "
                      "of one definition which is the default",
                      quote(taken.name()), taken.place.file, taken.place.line));
}

void Patterns::withoutGraph(const Element& at, const Element& nodedef) {
  std::string help = "code in a shading language is not read: give it a nodegraph, or a node file by --nodes";
  for (const Element* document : documents_) {
    if (!maySuggest()) break;
    for (const Element& body : document->children) {
      if (body.category != "nodegraph" && body.find("nodegraph") == nullptr) continue;
      const Element* of = body.get("nodedef").empty() ? nullptr : findNamed(nodedefs_, body.get("nodedef"));
      if (of != nullptr && of->name() == nodedef.name())
        help = fmt::format("{} is for the target {} alone: one without a target counts here",
                           quote(body.name()), quote(body.get("target")));
    }
  }
  error(at, "no-graph", fmt::format("the definition {} has no nodegraph", quote(nodedef.name())),
        std::move(help));
}

/// Whether an output of a definition's nodegraph is of the type that the definition says.
void Patterns::checkDeclared(const Element& nodedef, const Element& graph, std::string_view name) {
  const Element* port = nodedef.child("output", name);
  const Element* output = graph.child("output", name);
  if (port == nullptr || output == nullptr || isOneHere(port->get("type"), output->get("type"))) return;
  error(*output, "wrong-type",
        fmt::format("the output {} is of the type {}", quote(name), quote(output->get("type"))),
        fmt::format("its definition {} in {}:{} says {}", quote(nodedef.name()), port->place.file,
                    port->place.line, quote(port->get("type"))));
}

std::vector<std::string_view> outputsOf(const Element& interface) {
  std::vector<std::string_view> outputs;
  for (const Element& port : interface.children)
    if (port.category == "output" && port.find(kMadeOutput) == nullptr) outputs.push_back(port.name());
  return outputs;
}

Diagnostic unnamedOutput(const Element& at, std::string_view name,
                         std::span<const std::string_view> outputs) {
  return {"unknown-output",
          Severity::Error,
          at.place,
          fmt::format("{} has several outputs, and {} names none of them", quote(name), quote(at.name())),
          fmt::format("its attribute \"output\" does: {}", listOf(outputs, "or")),
          {}};
}

/// Whether an input names one of several outputs of what it is connected to.
bool Patterns::namesOutput(const Element& input, const Referred& referred,
                           std::span<const std::string_view> outputs) {
  if (!referred.output.empty() || referred.element == &input || outputs.size() < 2) return true;
  const Diagnostic one = unnamedOutput(input, referred.element->name(), outputs);
  error(input, one.code, one.message, one.help);
  return false;
}

/// The name of the output of a nodegraph or a definition that is meant: of one output that, whatever it is
/// called.
std::string_view Patterns::outputNameOf(const Element& interface, std::string_view name) {
  const Element* first = nullptr;
  size_t count = 0;
  for (const Element& port : interface.children) {
    if (port.category == "output" && ++count == 1) first = &port;
  }
  if (count == 1 || (count > 1 && name.empty())) return first->name();
  return name.empty() ? std::string_view("out") : name;
}

/// The type of what a port is connected to; empty where that is not said.
std::string_view Patterns::givenType(const Scope& scope, const Element& port) const {
  if (const std::string* interface = port.find("interfacename")) {
    const Element* input = scope.input(*interface);
    return input == nullptr ? std::string_view() : input->get("type");
  }
  const Element* node = upstream(scope, port);
  const Element* gives = nodegraph(scope, port);
  if (gives == nullptr && node != nullptr) gives = definitionOf(*node);
  if (gives == nullptr) {
    const std::string_view type = node == nullptr ? std::string_view() : node->get("type");
    return type == "multioutput" ? std::string_view() : type;
  }
  const Element* output = gives->child("output", outputNameOf(*gives, port.get("output")));
  return output == nullptr ? std::string_view() : output->get("type");
}

/// Whether an output or an input is of the type of what it is connected to.
void Patterns::checkPort(const Scope& scope, const Element& port) {
  const bool output = port.category == "output";
  const std::string_view type = port.get("type");
  if ((!output && (port.category != "input" || !typeOf(type))) || !port.get("channels").empty()) return;
  const std::string_view given = givenType(scope, port);
  if (isOneHere(type, given) || !isTypeName(given)) return;
  error(port, "wrong-type",
        fmt::format("the {} {} is of the type {}, and what it is connected to is {}", port.category,
                    quote(port.name()), quote(type), quote(given)),
        "a node \"convert\" or \"extract\" between them makes one of the other");
}

/// Whether a node's type is one of MaterialX's, or of a `typedef` of the documents.
bool Patterns::hasType(const Element& element) {
  const std::string_view type = element.get("type");
  if (isTypeName(type)) return true;
  for (const Element* document : documents_) {
    if (document->child("typedef", type) != nullptr) return true;
  }
  error(element, "wrong-type", fmt::format("there is no type {}", quote(type)),
        lang::didYouMean(type, kTypes, "MaterialX has " + listOf(kTypes)));
  return false;
}

const Element* Patterns::upstream(const Scope& scope, const Element& input) const {
  const std::string_view name = input.get("nodename");
  const auto it = scope.siblings_->find(name);
  return name.empty() || it == scope.siblings_->end() ? nullptr : it->second;
}

const Element* Patterns::nodegraph(const Scope& scope, const Element& input) const {
  const std::string* named = input.find("nodegraph");
  if (named == nullptr) {
    const Element* node = upstream(scope, input);
    return node != nullptr && node->category == "nodegraph" ? node : nullptr;
  }
  if (const auto it = scope.siblings_->find(*named); it != scope.siblings_->end()) return it->second;
  const auto it = nodegraphs_.find(*named);
  return it == nodegraphs_.end() ? nullptr : it->second;
}

const std::vector<const Element*>& Patterns::inputElements(const Element& owner) {
  const auto [it, fresh] = inputs_.try_emplace(&owner);
  if (!fresh) return it->second;
  for (const Element& child : owner.children) {
    if (child.category == "input") it->second.push_back(&child);
  }
  return it->second;
}

}  // namespace lacquer::materialx
