// Which of a node's forms a graph means, and what is wrong where it is none.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "graph/check_body.h"
#include "graph/text.h"
#include "support/text.h"

namespace lacquer::graph {

using ir::Type;

namespace {

/// How many types tell the form from others of its name.
size_t typeCount(const lang::NodeDecl& form) {
  return static_cast<size_t>(std::count(form.name.begin(), form.name.end(), ','));
}

const lang::Param* paramOf(const lang::NodeDecl& form, std::string_view name) {
  const auto param = std::find_if(form.params.begin(), form.params.end(),
                                  [&](const lang::Param& p) { return p.name == name; });
  return param == form.params.end() ? nullptr : &*param;
}

bool hasValue(const lang::Param& param, std::string_view choice) {
  return std::find(param.choices.begin(), param.choices.end(), choice) != param.choices.end();
}

/// How well what is connected fits a form.
struct Fit {
  size_t inexact = 0;                     ///< inputs that are widened or converted
  std::vector<const lang::Param*> wrong;  ///< that are given another type, or the name of no value of theirs
  std::vector<std::string_view> unknown;  ///< inputs that it has not
  std::vector<std::string_view> missing;  ///< inputs without a default that nothing is connected to

  size_t faults() const { return wrong.size() + unknown.size() + missing.size(); }
};

using Forms = std::vector<const lang::NodeDecl*>;

bool anyHas(const Forms& forms, std::string_view input) {
  return std::any_of(forms.begin(), forms.end(),
                     [&](const lang::NodeDecl* form) { return paramOf(*form, input) != nullptr; });
}

bool anyHas(const Forms& forms, std::string_view input, std::string_view choice) {
  return std::any_of(forms.begin(), forms.end(), [&](const lang::NodeDecl* form) {
    const lang::Param* param = paramOf(*form, input);
    return param != nullptr && hasValue(*param, choice);
  });
}

/// An input, or a name of a value, that none of `all` has tells nothing of the form: it is wrong by itself.
template <class OfferOf>
Fit fitOf(const lang::NodeDecl& form, const Forms& all, const Node& node, OfferOf offerOf) {
  Fit fit;
  for (const auto& [name, source] : node.inputs) {
    const lang::Param* param = paramOf(form, name);
    if (param == nullptr) {
      if (anyHas(all, name)) fit.unknown.push_back(name);
      continue;
    }
    if (const auto* choice = std::get_if<Choice>(&source.from)) {
      if (!hasValue(*param, choice->name) && anyHas(all, name, choice->name)) fit.wrong.push_back(param);
      continue;
    }
    const std::optional<Offer> offer = offerOf(source);
    if (!offer || offer->type == param->type) continue;  // nothing is known of what is wrong
    const auto* literal = source.swizzle.empty() ? std::get_if<Literal>(&source.from) : nullptr;
    if (literal != nullptr ? !fits(*literal, param->type) : !fits(offer->type, param->type))
      fit.wrong.push_back(param);
    else
      ++fit.inexact;
  }
  for (const lang::Param& param : form.params) {
    const bool given = std::any_of(node.inputs.begin(), node.inputs.end(),
                                   [&](const auto& input) { return input.first == param.name; });
    if (!given && !param.default_syntax && param.given.empty()) fit.missing.push_back(param.name);
  }
  return fit;
}

std::string signatureOf(const lang::NodeDecl& form) {
  std::string text = std::string(form.name) + '(';
  for (const lang::Param& param : form.params)
    text += fmt::format("{}{} {}", text.back() == '(' ? "" : ", ", ir::typeName(param.type), param.name);
  return text + ')';
}

/// "add<vec3> wants a vec3 for 'in2' and lacks 'in1'".
std::string faultsOf(const lang::NodeDecl& form, const Fit& fit) {
  std::vector<std::string> parts;
  for (const lang::Param* param : fit.wrong)
    parts.push_back(fmt::format("{}{} for {}", parts.empty() ? "wants " : "", article(param->type),
                                inQuotes(param->name)));
  if (!fit.unknown.empty()) parts.push_back("has no " + shortList(fit.unknown));
  if (!fit.missing.empty()) parts.push_back("needs " + shortList(fit.missing));
  return fmt::format("{} {}", form.name,
                     lacquer::listOf(std::vector<std::string_view>(parts.begin(), parts.end())));
}

constexpr size_t kShownForms = 8;

std::string shownForms(const std::vector<std::string>& forms, std::string_view between) {
  std::string text;
  for (size_t i = 0; i < std::min(forms.size(), kShownForms); ++i)
    text += fmt::format("{}{}", text.empty() ? "" : between, forms[i]);
  if (forms.size() > kShownForms)
    text += fmt::format("{}{} more", between == ", " ? " and " : between, forms.size() - kShownForms);
  return text;
}

}  // namespace

/// Of a node's forms, those that fit best; of those that fit equally well, those with the fewest types in
/// their names. So "floor" of a float is floor<float>, and not floor<float, int>, which a graph names.
std::vector<const lang::NodeDecl*> Contracts::candidates(const Node& node, const Body& body) const {
  Forms best;
  std::pair<size_t, size_t> least{std::numeric_limits<size_t>::max(), 0};
  const Forms all = library_.forms(node.type);
  for (const lang::NodeDecl* form : all) {
    const Fit fit = fitOf(*form, all, node, [&](const Source& source) { return offer(source, body); });
    if (fit.faults() != 0) continue;
    const std::pair<size_t, size_t> worth{fit.inexact, typeCount(*form)};
    if (worth > least) continue;
    if (worth < least) best.clear();
    least = worth;
    best.push_back(form);
  }
  return best;
}

/// What is connected, as a message says it: "'in1' is a vec3 and 'in2' is a mat3".
std::string Contracts::connectedText(const Node& node, const Body& body) const {
  std::vector<std::string> parts;
  for (const auto& [name, source] : node.inputs) {
    if (const auto* choice = std::get_if<Choice>(&source.from)) {
      parts.push_back(fmt::format("{} is \"{}\"", inQuotes(name), printable(choice->name)));
    } else if (const std::optional<Offer> given = offer(source, body)) {
      parts.push_back(fmt::format("{} is {}", inQuotes(name), article(given->type)));
    }
    constexpr size_t kMost = 8;
    if (parts.size() == kMost) break;
  }
  if (parts.empty()) return "nothing is connected";
  return lacquer::listOf(std::vector<std::string_view>(parts.begin(), parts.end()));
}

std::optional<NoForm> Contracts::whyNoForm(const Node& node, const Body& body) const {
  if (node.group || library_.has(lang::DeclKind::Node, node.type) || forms_.contains(&node))
    return std::nullopt;
  const Forms all = library_.forms(node.type);
  if (all.empty()) return std::nullopt;
  const Forms fitting = candidates(node, body);
  if (fitting.size() == 1) return NoForm{{}, {}, fitting[0]->name};
  if (!fitting.empty()) {
    // What is connected wrongly is said there, and of what comes from something wrong no type is known.
    const auto unknown = [&](const auto& input) {
      if (!anyHas(all, input.first)) return true;
      return !std::holds_alternative<Choice>(input.second.from) && !offer(input.second, body);
    };
    if (std::any_of(node.inputs.begin(), node.inputs.end(), unknown)) return std::nullopt;
    std::vector<std::string> texts;
    for (const lang::NodeDecl* form : fitting) texts.push_back(signatureOf(*form));
    return NoForm{fmt::format("several forms of {} fit the node {}: {}", inQuotes(node.type),
                              inQuotes(node.id), connectedText(node, body)),
                  "name one: " + shownForms(texts, ", "),
                  {}};
  }
  std::vector<std::pair<Fit, const lang::NodeDecl*>> nearest;
  for (const lang::NodeDecl* form : all)
    nearest.emplace_back(fitOf(*form, all, node, [&](const Source& source) { return offer(source, body); }),
                         form);
  std::stable_sort(nearest.begin(), nearest.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first.faults(), typeCount(*a.second)) <
           std::pair(b.first.faults(), typeCount(*b.second));
  });
  std::vector<std::string> texts;
  for (const auto& [fit, form] : nearest) texts.push_back(faultsOf(*form, fit));
  return NoForm{fmt::format("no form of {} fits the node {}: {}", inQuotes(node.type), inQuotes(node.id),
                            connectedText(node, body)),
                shownForms(texts, "; "),
                {}};
}

}  // namespace lacquer::graph
