#include "json/json.h"
#include "json/doubles.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "json/path.h"
#include "support/text.h"

template class nlohmann::basic_json<lacquer::json::Members>;

namespace lacquer::json {

namespace {

/// Offset of the bracket that opens one level too many, npos when there is none. No glTF nests deeper than a
/// dozen levels outside `extras`. The tree is copied and written recursively.
size_t tooDeep(std::string_view text, size_t deepest) {
  size_t depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > deepest) return i;
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return std::string_view::npos;
}

/// Bytes after which no more doubles are noted. A pointer may be as long as the text, so that those of all of
/// them could be its square.
constexpr size_t kMostNoted = 1U << 16U;

/// Builds the tree from the parser's events. The library's own builder looks for each new member among those
/// before it, which takes quadratic time in a large object; here doubles are dropped once, at the end. What
/// is in an open container waits beside the others, so that the container is made at its size: the library
/// copies an object's members where it grows.
class TreeBuilder : public nlohmann::json_sax<Json> {
public:
  explicit TreeBuilder(uint64_t most) : most_(most) {}

  /// Where a name stands twice in one object, by its name: the last one counts.
  std::vector<std::pair<std::string, std::string>> doubles;

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // no text holds it
  bool start_object(std::size_t) override { return open(true); }
  bool start_array(std::size_t) override { return open(false); }
  bool key(string_t& value) override {
    key_ = std::move(value);
    return true;
  }
  bool end_object() override {
    const std::span<Json> values = inside();
    const std::span<std::string> names = std::span(names_).subspan(open_.back().first_name);
    const std::vector<bool> dropped = doubled(names);
    Json object = Json::object();
    auto& made = object.get_ref<Json::object_t&>();
    made.reserve(values.size());
    for (size_t i = 0; i < values.size(); ++i) {
      if (dropped.empty() || !dropped[i]) made.emplace_back(std::move(names[i]), std::move(values[i]));
    }
    made.index();
    return close(std::move(object));
  }
  bool end_array() override {
    const std::span<Json> values = inside();
    Json array = Json::array();
    auto& made = array.get_ref<Json::array_t&>();
    made.reserve(values.size());
    for (Json& value : values) made.push_back(std::move(value));
    return close(std::move(array));
  }
  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& e) override {
    errorId = e.id;
    errorText = e.what();
    errorToken = token;
    errorPosition = position;
    return false;
  }

  bool full() const { return count_ > most_; }

  Json root;
  int errorId = 0;  ///< the library's number of the error
  std::string errorText;
  std::string errorToken;
  size_t errorPosition = 0;  ///< bytes read until then

private:
  struct Open {
    size_t first, first_name;  ///< places in `values_` and `names_` of what is in it
    bool object;
    std::string name;  ///< as a member
  };

  template <class T>
  bool add(T&& value) {
    if (!count()) return false;
    place(Json(std::forward<T>(value)));
    return true;
  }

  /// False when there is no room for one more value, which ends the reading.
  bool count() { return ++count_ <= most_; }

  bool open(bool object) {
    if (!count()) return false;
    open_.push_back({values_.size(), names_.size(), object, std::move(key_)});
    return true;
  }

  std::span<Json> inside() { return std::span(values_).subspan(open_.back().first); }

  bool close(Json made) {
    values_.resize(open_.back().first);
    names_.resize(open_.back().first_name);
    key_ = std::move(open_.back().name);
    open_.pop_back();
    place(std::move(made));
    return true;
  }

  /// Puts a value where the parser stands.
  void place(Json value) {
    if (open_.empty()) {
      root = std::move(value);
      return;
    }
    if (open_.back().object) names_.push_back(std::move(key_));
    values_.push_back(std::move(value));
  }

  /// The JSON pointer of the innermost open container.
  std::string pointer() const { return pointer(Path(), 0); }
  std::string pointer(const Path& path, size_t depth) const {
    if (depth + 1 >= open_.size()) return path.text();
    const Open& parent = open_[depth];
    const Open& child = open_[depth + 1];
    if (parent.object) return pointer(Path(path, child.name), depth + 1);
    return pointer(Path(path, child.first - parent.first), depth + 1);
  }

  /// By name whether the same follows; empty where none does. They are noted.
  std::vector<bool> doubled(std::span<const std::string> names) {
    if (names.size() < 2) return {};
    std::vector<size_t> order(names.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      const int compared = names[a].compare(names[b]);
      return compared < 0 || (compared == 0 && a < b);
    });
    std::vector<bool> dropped;
    for (size_t i = 1; i < order.size(); ++i) {
      if (names[order[i - 1]] != names[order[i]]) continue;
      dropped.resize(names.size());
      dropped[order[i - 1]] = true;
    }
    for (size_t i = 0; i < dropped.size() && noted_ < kMostNoted; ++i) {
      if (!dropped[i]) continue;
      doubles.emplace_back(pointer(), names[i]);
      noted_ += 1 + doubles.back().first.size() + doubles.back().second.size();
    }
    return dropped;
  }

  // What is complete in open containers, of the outer ones first; the names are those of members alone.
  std::vector<Json> values_;
  std::vector<std::string> names_;
  std::vector<Open> open_;
  std::string key_;
  uint64_t most_, count_ = 0;
  size_t noted_ = 0;  ///< bytes of doubles
};

/// As locate(), but shows only a window of a long line (files without line breaks are common) and nothing
/// that would upset a terminal.
void locateInWindow(Diagnostic& diagnostic, std::string_view text, size_t offset, size_t length) {
  constexpr size_t kBefore = 60;
  constexpr size_t kAfter = 60;
  offset = std::min(offset, text.size());
  const size_t before = offset == 0 ? std::string_view::npos : text.rfind('\n', offset - 1);
  const size_t begin = before == std::string_view::npos ? 0 : before + 1;
  const size_t end = std::min(text.find('\n', offset), text.size());
  size_t from = offset - begin > kBefore ? offset - kBefore : begin;
  size_t to = end - offset > kAfter ? offset + kAfter : end;
  const auto inSequence = [&](size_t at) {
    return at < end && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
  };
  while (from < offset && inSequence(from)) ++from;
  while (to > offset && inSequence(to)) --to;

  std::string shown(text.substr(from, to - from));
  if (to == end && offset < end && shown.ends_with('\r')) shown.pop_back();
  std::replace(shown.begin(), shown.end(), '\t', ' ');
  std::string window = from > begin ? "..." : "";
  const size_t lead = window.size() + (offset - from);
  window += printable(shown, shown.size());
  if (to < end) window += "...";
  locate(diagnostic, window, std::min(lead, window.size()), length);
  diagnostic.place.line =
      static_cast<uint32_t>(std::count(text.begin(), text.begin() + static_cast<ptrdiff_t>(begin), '\n') + 1);
  diagnostic.place.column = static_cast<uint32_t>(offset - begin + 1);
}

/// The parser's words without its prefix "[json.exception.…] parse error at line 1, column 2: ".
std::string parserMessage(const std::string& what) {
  constexpr std::string_view kColumn = ", column ";
  const size_t column = what.find(kColumn);
  const size_t colon = column == std::string::npos ? std::string::npos : what.find(": ", column);
  const size_t bracket = what.find("] ");
  std::string text = what.substr(colon != std::string::npos     ? colon + 2
                                 : bracket != std::string::npos ? bracket + 2
                                                                : 0);
  return printable(text, 200);
}

bool startsWithNoNumber(std::string_view text) {
  constexpr std::string_view kWords[] = {"NaN", "nan", "Infinity", "inf", "Inf"};
  return std::any_of(std::begin(kWords), std::end(kWords),
                     [&](std::string_view w) { return text.starts_with(w); });
}

Diagnostic syntaxError(const TreeBuilder& builder, std::string_view text, const std::string& file) {
  constexpr int kOutOfRange = 406;  // the library's number for a number that is too large for a double
  Diagnostic diagnostic{"json-syntax", Severity::Error, {file, 0, 0, {}}, {}, {}, {}};
  size_t offset = builder.errorPosition == 0 ? 0 : builder.errorPosition - 1;
  size_t length = 1;
  if (builder.errorId == kOutOfRange) {
    length = builder.errorToken.size();
    offset = builder.errorPosition >= length ? builder.errorPosition - length : 0;
    diagnostic.code = "json-number-range";
    diagnostic.message = fmt::format("the number {} is out of range", printable(builder.errorToken));
    diagnostic.help = "a number must fit a double: at most about 1.8e308";
  } else {
    diagnostic.message = "not valid JSON: " + parserMessage(builder.errorText);
    const size_t back = std::min<size_t>(offset, 1);
    if (offset < text.size() &&
        (startsWithNoNumber(text.substr(offset)) || startsWithNoNumber(text.substr(offset - back)))) {
      diagnostic.help = "JSON has no NaN and no infinity";
    }
  }
  locateInWindow(diagnostic, text, offset, length);
  return diagnostic;
}

}  // namespace

namespace {

using DoubledNames = std::vector<std::pair<std::string, std::string>>;  ///< the object's pointer, the name

Result<Json> build(std::string_view text, const std::string& file, const Limits& limits,
                   DoubledNames& doubles) {
  const Place place{file, 0, 0, {}};
  if (text.size() > limits.json) {
    return fail("json-too-large", place, fmt::format("its JSON has more than {} bytes", limits.json),
                raising("json"));
  }
  if (const size_t offset = tooDeep(text, limits.depth); offset != std::string_view::npos) {
    Diagnostic diagnostic{"json-too-deep", Severity::Error, place, {}, {}, {}};
    diagnostic.message = fmt::format("nested more than {} levels deep", limits.depth);
    diagnostic.help = "nothing needs that: the file is damaged or made to do harm";
    locateInWindow(diagnostic, text, offset, 1);
    return tl::make_unexpected(Diagnostics{diagnostic});
  }
  TreeBuilder builder(limits.values);
  if (Json::sax_parse(text.begin(), text.end(), &builder)) {
    // The parser ends at a NUL, by which some pad a GLB's chunk.
    const size_t end = text.find('\0');
    if (end != std::string_view::npos && text.find_first_not_of('\0', end) != std::string_view::npos) {
      Diagnostic diagnostic{
          "json-syntax", Severity::Error, place, "not valid JSON: more follows a NUL byte", {}, {}};
      locateInWindow(diagnostic, text, end, 1);
      return tl::make_unexpected(Diagnostics{diagnostic});
    }
    doubles = std::move(builder.doubles);
    return std::move(builder.root);
  }
  if (builder.full()) {
    return fail("json-too-many", place, fmt::format("its JSON has more than {} values", limits.values),
                raising("values"));
  }
  return tl::make_unexpected(Diagnostics{syntaxError(builder, text, file)});
}

Diagnostic doubled(const std::pair<std::string, std::string>& one, Severity severity,
                   const std::string& file) {
  return {"duplicate-key",
          severity,
          {file, 0, 0, one.first + Path(Path(), one.second).text()},
          fmt::format("{} stands twice in one object", quote(one.second)),
          severity == Severity::Error ? "remove one of the two"
                                      : "the last one counts here: remove one of the two",
          {}};
}

}  // namespace

Result<Json> parse(std::string_view text, const std::string& file, const Limits& limits, Doubles doubles) {
  DoubledNames names;
  Result<Json> json = build(text, file, limits, names);
  if (!json || doubles == Doubles::LastCounts || names.empty()) return json;
  Diagnostics wrong;
  for (const auto& one : names) wrong.push_back(doubled(one, Severity::Error, file));
  return tl::make_unexpected(std::move(wrong));
}

Result<Json> parseTelling(std::string_view text, const std::string& file, const Limits& limits,
                          Diagnostics& told) {
  constexpr size_t kMost = 20;
  DoubledNames names;
  Result<Json> json = build(text, file, limits, names);
  for (size_t i = 0; json && i < std::min(kMost, names.size()); ++i)
    told.push_back(doubled(names[i], Severity::Warning, file));
  return json;
}

Json reread(std::string_view text) {
  Limits none;
  none.json = none.values = std::numeric_limits<uint64_t>::max();
  DoubledNames names;
  Result<Json> json = build(text, {}, none, names);
  if (!json) throw std::logic_error("what was written does not read back");
  return std::move(*json);
}

void dismantle(Json& json) noexcept {
  if (!json.is_structured()) return;
  for (Json& each : json) dismantle(each);
  json.clear();
}

const Json* member(const Json& object, std::string_view key) {
  const auto* members = object.get_ptr<const Json::object_t*>();
  return members == nullptr ? nullptr : members->found(key);
}

const Json& at(const Json& object, std::string_view key) {
  static const Json kNull;
  const Json* found = member(object, key);
  return found == nullptr ? kNull : *found;
}

std::span<const Json> elements(const Json& array) {
  const auto* all = array.get_ptr<const Json::array_t*>();
  return all == nullptr ? std::span<const Json>() : std::span<const Json>(*all);
}

std::string_view describe(const Json& value) {
  switch (value.type()) {
    case Json::value_t::null: return "null";
    case Json::value_t::object: return "an object";
    case Json::value_t::array: return "an array";
    case Json::value_t::string: return "a string";
    case Json::value_t::boolean: return "a boolean";
    case Json::value_t::number_integer:
    case Json::value_t::number_unsigned:
    case Json::value_t::number_float: return "a number";
    case Json::value_t::binary:
    case Json::value_t::discarded: break;  // no text holds them
  }
  return "";
}

std::string dump(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string quotedText(std::string_view text) {
  const bool plain = std::all_of(text.begin(), text.end(),
                                 [](char c) { return c >= 0x20 && c < 0x7F && c != '"' && c != '\\'; });
  if (!plain) return dump(text);
  std::string all;
  all.reserve(text.size() + 2);
  return all.append(1, '"').append(text).append(1, '"');
}

std::string numberText(double x) { return dump(x); }

size_t arraySize(const Json& object, std::string_view key) {
  const Json* array = member(object, key);
  return array != nullptr && array->is_array() ? array->size() : 0;
}

}  // namespace lacquer::json
