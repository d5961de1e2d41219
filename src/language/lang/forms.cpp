#include "lang/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lang/lexer.h"
#include "lang/parser.h"

namespace lacquer::lang {

namespace {

constexpr size_t kMostForms = 256;

/// A place of the list: a variable with what it may be, or one type.
struct ListPlace {
  std::string_view variable;
  std::vector<ir::Type> types;
};

class Reader {
public:
  Reader(Reporter& reporter, uint32_t begin, uint32_t end)
      : reporter_(reporter), tokens_(tokenize(reporter, begin, end)) {}

  /// Nothing after an error.
  std::vector<ListPlace> run() {
    std::vector<ListPlace> places;
    do {
      ++at_;  // '<' or ';'
      ListPlace place;
      if (!this->place(place)) return {};
      places.push_back(std::move(place));
    } while (token().is(";"));
    if (token().is(">")) return places;
    wrong("expected '>' behind the types",
          "a list is `<T in float, vec2>`, `<T in vec2, vec3; float>` or `<vec3>`");
    return {};
  }

private:
  const Token& token(size_t ahead = 0) const { return tokens_[std::min(at_ + ahead, tokens_.size() - 1)]; }

  bool wrong(std::string message, std::string help) {
    reporter_.error("syntax", token().span, std::move(message), std::move(help));
    return false;
  }

  bool place(ListPlace& place) {
    if (token().kind == Token::Kind::Name && token(1).is("in")) {
      place.variable = token().text;
      if (findType(place.variable) || isReserved(place.variable))
        return wrong("expected the name of a type variable",
                     fmt::format("'{}' has a meaning", place.variable));
      at_ += 2;
      do {
        if (!type(place)) return false;
      } while (token().is(",") && ++at_ != 0);
      return true;
    }
    return type(place);
  }

  bool type(ListPlace& place) {
    const std::optional<ir::Type> found = findType(token().text);
    if (token().kind != Token::Kind::Name || !found)
      return wrong("expected a type", "such as float, vec3 or mat4");
    if (std::find(place.types.begin(), place.types.end(), *found) != place.types.end())
      return wrong(fmt::format("'{}' stands twice here", token().text), "");
    place.types.push_back(*found);
    ++at_;
    return true;
  }

  Reporter& reporter_;
  std::vector<Token> tokens_;
  size_t at_ = 0;
};

}  // namespace

std::vector<Form> formsOf(Reporter& reporter, std::string_view name, uint32_t after_name, uint32_t end) {
  const std::string_view text = reporter.text();
  while (after_name < end && isSpace(text[after_name])) ++after_name;
  if (after_name >= end || text[after_name] != '<') return {};
  const size_t close = text.find('>', after_name);
  const auto list_end =
      static_cast<uint32_t>(std::min<size_t>(close == std::string_view::npos ? end : close + 1, end));
  const std::vector<ListPlace> places = Reader(reporter, after_name, list_end).run();
  std::vector<Form> forms(places.empty() ? 0 : 1);
  for (const ListPlace& place : places) {
    std::vector<Form> wider;
    for (const Form& form : forms) {
      for (const ir::Type type : place.types) {
        Form& made = wider.emplace_back(form);
        made.key += fmt::format("{}{}", made.key.empty() ? "" : ", ", ir::typeName(type));
        if (!place.variable.empty()) made.bindings.emplace_back(place.variable, type);
      }
    }
    forms = std::move(wider);
    if (forms.size() <= kMostForms) continue;
    reporter.error("too-many-forms", {after_name, list_end - after_name},
                   fmt::format("'{}' has more than {} forms", name, kMostForms), "write several nodes");
    return {};
  }
  for (Form& form : forms) form.key = fmt::format("{}<{}>", name, form.key);
  return forms;
}

std::string formName(std::string_view name, const std::vector<ir::Type>& types) {
  std::string text(name);
  for (size_t i = 0; i < types.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? "<" : ", ", ir::typeName(types[i]));
  return types.empty() ? text : text + ">";
}

bool beginsForm(std::string_view form, std::string_view beginning) {
  if (!beginning.ends_with('>')) return false;
  beginning.remove_suffix(1);
  return form.size() > beginning.size() && form.starts_with(beginning) && form[beginning.size()] == ',';
}

}  // namespace lacquer::lang
