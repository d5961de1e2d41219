// Formulas over the inputs of a standard_surface: what can be computed is, nodes stand for the rest.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mtlx/element.h"
#include "mtlx/models.h"
#include "mtlx/names.h"
#include "mtlx/values.h"
#include "support/diagnostic.h"
#include "support/text.h"

namespace lacquer::exchange::formulas {

using materialx::Element;

inline constexpr std::string_view kFrom = "standard_surface";

struct Given {
  std::string_view name, type;
  std::array<double, 3> by_default;
};

/// The inputs of MaterialX's standard_surface 1.0.1.
inline constexpr Given kInputs[] = {
    {"base", "float", {1}},
    {"base_color", "color3", {0.8, 0.8, 0.8}},
    {"diffuse_roughness", "float", {0}},
    {"metalness", "float", {0}},
    {"specular", "float", {1}},
    {"specular_color", "color3", {1, 1, 1}},
    {"specular_roughness", "float", {0.2}},
    {"specular_IOR", "float", {1.5}},
    {"specular_anisotropy", "float", {0}},
    {"specular_rotation", "float", {0}},
    {"transmission", "float", {0}},
    {"transmission_color", "color3", {1, 1, 1}},
    {"transmission_depth", "float", {0}},
    {"transmission_scatter", "color3", {0, 0, 0}},
    {"transmission_scatter_anisotropy", "float", {0}},
    {"transmission_dispersion", "float", {0}},
    {"transmission_extra_roughness", "float", {0}},
    {"subsurface", "float", {0}},
    {"subsurface_color", "color3", {1, 1, 1}},
    {"subsurface_radius", "color3", {1, 1, 1}},
    {"subsurface_scale", "float", {1}},
    {"subsurface_anisotropy", "float", {0}},
    {"sheen", "float", {0}},
    {"sheen_color", "color3", {1, 1, 1}},
    {"sheen_roughness", "float", {0.3}},
    {"coat", "float", {0}},
    {"coat_color", "color3", {1, 1, 1}},
    {"coat_roughness", "float", {0.1}},
    {"coat_anisotropy", "float", {0}},
    {"coat_rotation", "float", {0}},
    {"coat_IOR", "float", {1.5}},
    {"coat_normal", "vector3", {0}},
    {"coat_affect_color", "float", {0}},
    {"coat_affect_roughness", "float", {0}},
    {"thin_film_thickness", "float", {0}},
    {"thin_film_IOR", "float", {1.5}},
    {"emission", "float", {0}},
    {"emission_color", "color3", {1, 1, 1}},
    {"opacity", "color3", {1, 1, 1}},
    {"thin_walled", "boolean", {0}},
    {"normal", "vector3", {0}},
    {"tangent", "vector3", {0}},
};

inline constexpr std::string_view kLinks[] = {"nodename", "nodegraph", "output", "interfacename", "channels"};

/// A number or a colour of a formula: known, or what an input is connected to.
struct Term {
  std::string_view type = "float";
  std::array<double, 3> value{};
  std::vector<std::pair<std::string, std::string>> link{};

  bool known() const { return link.empty(); }
  bool is(double x) const {
    return known() && value[0] == x && (type != "color3" || (value[1] == x && value[2] == x));
  }
  double at(size_t i) const { return value[type == "color3" ? i : 0]; }
};

inline Term number(double x) { return {"float", {x}}; }
inline Term grey(double x) { return {"color3", {x, x, x}}; }

/// One surface: its inputs, and nodes for what cannot be computed.
class Formulas {
public:
  Formulas(const Element& surface, const materialx::Units& units, materialx::NameSet& names,
           std::vector<Element>& beside, Diagnostics& said)
      : surface_(surface), units_(units), names_(names), beside_(beside), said_(said) {}

  Term get(std::string_view name) {
    used_.insert(name);
    const Given& given = *std::find_if(std::begin(kInputs), std::end(kInputs),
                                       [&](const Given& one) { return one.name == name; });
    Term term{given.type, given.by_default};
    const Element* input = surface_.child("input", name);
    if (input == nullptr) return term;
    for (const std::string_view attribute : kLinks) {
      if (const std::string* text = input->find(attribute)) term.link.emplace_back(attribute, *text);
    }
    const std::optional<ir::Type> type = materialx::typeOf(given.type);
    if (!term.known() || input->find("value") == nullptr || !type) return term;
    const Result<ir::Components> read =
        materialx::valueOf(*input, *type, units_, materialx::portUnit(Element(), kFrom, name));
    if (!read) {
      said_.insert(said_.end(), read.error().begin(), read.error().end());
      return term;
    }
    std::copy_n(read->begin(), 3, term.value.begin());
    return term;
  }

  Term multiply(const Term& a, const Term& b) {
    if (a.is(1) && (a.type == b.type || b.type == "color3")) return b;
    if (b.is(1) && (a.type == b.type || a.type == "color3")) return a;
    if (a.is(0) || b.is(0)) return a.type == "color3" || b.type == "color3" ? grey(0) : number(0);
    const Term& first = a.type == "color3" || b.type != "color3" ? a : b;
    const Term& second = &first == &a ? b : a;
    return apply("multiply", first.type, {{"in1", first}, {"in2", second}},
                 [&](size_t i) { return a.at(i) * b.at(i); });
  }
  Term mix(const Term& fg, const Term& bg, const Term& by) {
    if (by.is(0)) return bg;
    if (by.is(1)) return fg;
    return apply("mix", fg.type, {{"fg", fg}, {"bg", bg}, {"mix", by}},
                 [&](size_t i) { return bg.at(i) + (fg.at(i) - bg.at(i)) * by.at(i); });
  }
  Term power(const Term& a, double exponent) {
    return apply("power", a.type, {{"in1", a}, {"in2", number(exponent)}},
                 [&](size_t i) { return std::pow(std::max(a.at(i), 0.0), exponent); });
  }
  Term root(const Term& a) {
    return apply("sqrt", a.type, {{"in", a}}, [&](size_t i) { return std::sqrt(std::max(a.at(i), 0.0)); });
  }
  Term minus(const Term& a, const Term& b) {
    return apply("subtract", a.type, {{"in1", a}, {"in2", b}}, [&](size_t i) { return a.at(i) - b.at(i); });
  }
  Term divide(const Term& a, const Term& b) {
    return apply("divide", a.type, {{"in1", a}, {"in2", b}},
                 [&](size_t i) { return b.at(i) == 0 ? 0 : a.at(i) / b.at(i); });
  }
  Term least(const Term& a, const Term& b) {
    return apply("min", a.type, {{"in1", a}, {"in2", b}},
                 [&](size_t i) { return std::min(a.at(i), b.at(i)); });
  }
  Term ifGreater(const Term& value1, const Term& value2, const Term& in1, const Term& in2) {
    if (value1.known() && value2.known()) return value1.value[0] > value2.value[0] ? in1 : in2;
    return choose("ifgreater", value1, value2, in1, in2);
  }
  Term ifEqual(const Term& value1, const Term& value2, const Term& in1, const Term& in2) {
    if (value1.known() && value2.known()) return value1.value[0] == value2.value[0] ? in1 : in2;
    return choose("ifequal", value1, value2, in1, in2);
  }
  /// Of a colour the product with a vector of three equal numbers.
  Term sum(const Term& color, double each) {
    if (color.known()) return number(each * (color.value[0] + color.value[1] + color.value[2]));
    const Term vector = add("convert", "vector3", {{"in", color}});
    return add("dotproduct", "float", {{"in1", vector}, {"in2", {"vector3", {each, each, each}}}});
  }
  Term channel(const Term& color, int index) {
    if (color.known()) return number(color.value[static_cast<size_t>(index)]);
    Term at{"integer", {static_cast<double>(index)}};
    return add("extract", "float", {{"in", color}, {"index", at}});
  }
  Term luminance(const Term& color) {
    const auto& c = color.value;
    if (color.known()) return number(0.2722287 * c[0] + 0.6740818 * c[1] + 0.0536895 * c[2]);
    return channel(add("luminance", "color3", {{"in", color}}), 0);
  }

  /// The opacity, which is a colour, for a surface that has one number: `shown` says which is taken.
  Term opacity(std::string_view shown) {
    const Term color = get("opacity");
    const Element* input = surface_.child("input", "opacity");
    const bool grey = color.known() && color.value[0] == color.value[1] && color.value[0] == color.value[2];
    if (input == nullptr || grey) return color;
    addBounded(said_, {"not-said",
                       Severity::Warning,
                       input->place,
                       fmt::format("opacity is a colour, and the new surface's is a number: {}",
                                   color.known() ? printable(std::string(input->get("value"))) + " is lost"
                                                 : "the colour of what it is connected to is lost"),
                       fmt::format("its {} is taken", shown),
                       {}});
    return color;
  }

  void put(std::string_view name, const Term& term, const std::optional<Term>& by_default = {}) {
    if (by_default) defaults_.emplace(name, inputOf(name, *by_default));
    if (by_default && term.known() && by_default->value == term.value) return;
    made_.push_back(inputOf(name, term));
  }
  void put(std::string_view name, const Term& term, double by_default) {
    put(name, term, term.type == "color3" ? grey(by_default) : number(by_default));
  }
  /// An input as it is where nothing is said of it; null where that is not known.
  const Element* byDefault(std::string_view name) const {
    const auto found = defaults_.find(name);
    return found == defaults_.end() ? nullptr : &found->second;
  }
  const std::map<std::string_view, Element>& defaults() const { return defaults_; }
  /// A normal or a tangent, where it is connected.
  void pass(std::string_view name, std::string_view as) {
    const Term term = get(name);
    if (!term.known()) made_.push_back(inputOf(as, term));
  }

  /// What nothing was made of, and is not as it is by default.
  std::vector<Element> finish(std::string_view as) {
    for (const Given& given : kInputs) {
      if (used_.contains(given.name) || isIdle(given.name)) continue;
      const Element* input = surface_.child("input", given.name);
      if (input == nullptr) continue;
      const Term term = get(given.name);
      if (term.known() && term.value == given.by_default) continue;
      const std::string shown = term.known() ? std::string(input->get("value")) : "what it is connected to";
      addBounded(said_,
                 {"not-said",
                  Severity::Warning,
                  input->place,
                  fmt::format("{} has no counterpart in {}: {} is lost", given.name, as, printable(shown)),
                  {},
                  {}});
    }
    for (const Element& input : surface_.children) {
      const bool known = std::any_of(std::begin(kInputs), std::end(kInputs),
                                     [&](const Given& one) { return one.name == input.name(); });
      if (known || input.category != "input") continue;
      addBounded(said_, {"unknown-input",
                         Severity::Warning,
                         input.place,
                         fmt::format("{} has no input {}", kFrom, quote(input.name())),
                         "it is lost",
                         {}});
    }
    return std::move(made_);
  }

private:
  using Inputs = std::vector<std::pair<std::string_view, Term>>;

  /// Whether its layer has no weight.
  bool isIdle(std::string_view name) {
    for (const std::string_view weight : {"coat", "sheen", "subsurface", "transmission"}) {
      if (name.size() > weight.size() && name.starts_with(weight) && name[weight.size()] == '_')
        return get(weight).is(0);
    }
    return false;
  }

  template <class Fold>
  Term apply(std::string_view category, std::string_view type, const Inputs& inputs, Fold fold) {
    const bool known =
        std::all_of(inputs.begin(), inputs.end(), [](const auto& one) { return one.second.known(); });
    if (!known) return add(category, type, inputs);
    Term made{type};
    for (size_t i = 0; i < (type == "color3" ? 3 : 1); ++i) made.value[i] = fold(i);
    return made;
  }

  Term choose(std::string_view category, const Term& value1, const Term& value2, const Term& in1,
              const Term& in2) {
    if (in1.known() && in2.known() && in1.value == in2.value) return in1;
    return add(category, in1.type, {{"value1", value1}, {"value2", value2}, {"in1", in1}, {"in2", in2}});
  }

  Term add(std::string_view category, std::string_view type, const Inputs& inputs) {
    Element node;
    node.category = category;
    const std::string name = names_.free(fmt::format("{}_{}", surface_.name(), category));
    node.attributes = {{"name", name}, {"type", std::string(type)}};
    for (const auto& [port, term] : inputs) node.children.push_back(inputOf(port, term));
    node.place = surface_.place;
    beside_.push_back(std::move(node));
    return {type, {}, {{"nodename", name}}};
  }

  static Element inputOf(std::string_view name, const Term& term) {
    Element input;
    input.category = "input";
    input.attributes = {{"name", std::string(name)}, {"type", std::string(term.type)}};
    for (const auto& [attribute, text] : term.link) input.set(attribute, text);
    if (!term.known()) return input;
    const bool three = term.type == "color3" || term.type == "vector3";
    input.set("value", term.type == "boolean" ? (term.value[0] != 0 ? "true" : "false")
                       : three ? fmt::format("{}, {}, {}", term.value[0], term.value[1], term.value[2])
                               : fmt::format("{}", term.value[0]));
    // Computed in linear Rec. 709, whatever the document's colours are in.
    if (term.type == "color3") input.set("colorspace", "lin_rec709");
    return input;
  }

  const Element& surface_;
  const materialx::Units& units_;
  materialx::NameSet& names_;
  std::vector<Element>& beside_;
  Diagnostics& said_;
  std::set<std::string_view> used_;
  std::vector<Element> made_;
  std::map<std::string_view, Element> defaults_;
};

}  // namespace lacquer::exchange::formulas
