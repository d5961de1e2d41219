#include "json/value.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>

namespace lacquer::json {

namespace {

constinit const Json kNull{};
const Json::Members kNone;

[[noreturn]] void throwKind(const char* wanted) {
  throw std::logic_error(std::string("a JSON value is not ") + wanted);
}

/// The nearest whole number that the type has; 0 for NaN.
template <class To>
To nearest(double x) {
  using Limits = std::numeric_limits<To>;
  if (!(x > static_cast<double>(Limits::min()))) return std::isnan(x) ? To{0} : Limits::min();
  return x >= static_cast<double>(Limits::max()) ? Limits::max() : static_cast<To>(x);
}

}  // namespace

// -- making and unmaking --

Json::Json(std::string text) {
  value_.text = new std::string(std::move(text));
  kind_ = Kind::String;
}

Json Json::object() {
  Json json;
  json.value_.members = new Members;
  json.kind_ = Kind::Object;
  return json;
}

Json Json::array() {
  Json json;
  json.value_.elements = new Elements;
  json.kind_ = Kind::Array;
  return json;
}

Json Json::array(std::initializer_list<Part> parts) {
  Json json = array();
  json.value_.elements->reserve(parts.size());
  for (const Part& part : parts) json.value_.elements->push_back(part.take());
  return json;
}

Json::Json(std::initializer_list<Part> parts) : Json(array(parts)) {
  Elements& pairs = *value_.elements;
  const bool named = std::all_of(pairs.begin(), pairs.end(), [](const Json& pair) {
    return pair.is_array() && pair.size() == 2 && pair[0].is_string();
  });
  if (!named) return;
  Json members = object();
  for (const Json& pair : pairs) members[pair[0].text()] = std::move((*pair.value_.elements)[1]);
  *this = std::move(members);
}

Json::Json(const Json& other) {
  switch (other.kind_) {
    case Kind::String: value_.text = new std::string(*other.value_.text); break;
    case Kind::Array: value_.elements = new Elements(*other.value_.elements); break;
    case Kind::Object:
      if (other.indexed_)
        value_.indexed = new Indexed(*other.value_.indexed);
      else
        value_.members = new Members(*other.value_.members);
      break;
    default: value_ = other.value_; break;
  }
  kind_ = other.kind_;
  indexed_ = other.indexed_;
}

Json::~Json() {
  switch (kind_) {
    case Kind::String: delete value_.text; break;
    case Kind::Array: delete value_.elements; break;
    case Kind::Object:
      if (indexed_)
        delete value_.indexed;
      else
        delete value_.members;
      break;
    default: break;
  }
}

// -- reading --

size_t Json::size() const {
  switch (kind_) {
    case Kind::Null: return 0;
    case Kind::Array: return value_.elements->size();
    case Kind::Object: return members().size();
    default: return 1;
  }
}

template <>
bool Json::get<bool>() const {
  if (!is_boolean()) throwKind("a boolean");
  return value_.boolean;
}

template <>
double Json::get<double>() const {
  switch (kind_) {
    case Kind::Integer: return static_cast<double>(value_.integer);
    case Kind::Unsigned: return static_cast<double>(value_.whole);
    case Kind::Float: return value_.number;
    default: throwKind("a number");
  }
}

template <class To>
To Json::whole() const {
  using Ends = std::numeric_limits<To>;
  const auto fitted = [](auto x) {
    if (std::cmp_less(x, Ends::min())) return Ends::min();
    return std::cmp_greater(x, Ends::max()) ? Ends::max() : static_cast<To>(x);
  };
  switch (kind_) {
    case Kind::Integer: return fitted(value_.integer);
    case Kind::Unsigned: return fitted(value_.whole);
    case Kind::Float: return nearest<To>(value_.number);
    default: throwKind("a number");
  }
}

template <>
int Json::get<int>() const {
  return whole<int>();
}
template <>
int64_t Json::get<int64_t>() const {
  return whole<int64_t>();
}
template <>
uint32_t Json::get<uint32_t>() const {
  return whole<uint32_t>();
}
template <>
uint64_t Json::get<uint64_t>() const {
  return whole<uint64_t>();
}

template <>
std::string Json::get<std::string>() const {
  return text();
}

template <>
std::vector<std::string> Json::get<std::vector<std::string>>() const {
  if (!is_array()) throwKind("an array");
  std::vector<std::string> texts;
  texts.reserve(size());
  for (const Json& each : *this) texts.push_back(each.text());
  return texts;
}

const std::string& Json::text() const {
  if (!is_string()) throwKind("a string");
  return *value_.text;
}

const Json::Members& Json::items() const {
  if (is_null()) return kNone;
  if (!is_object()) throwKind("an object");
  return members();
}

Json::Members& Json::items() {
  if (is_null()) *this = object();
  if (!is_object()) throwKind("an object");
  if (!indexed_) return *value_.members;
  value_.indexed->order.clear();
  return value_.indexed->members;
}

const Json& Json::operator[](size_t index) const {
  return is_array() && index < value_.elements->size() ? (*value_.elements)[index] : kNull;
}

const Json* Json::find(std::string_view key) const {
  if (!is_object()) return nullptr;
  const Members& members = this->members();
  if (indexed_ && !value_.indexed->order.empty()) {
    const std::vector<uint32_t>& order = value_.indexed->order;
    const auto at = std::lower_bound(order.begin(), order.end(), key,
                                     [&](uint32_t i, std::string_view k) { return members[i].first < k; });
    return at != order.end() && members[*at].first == key ? &members[*at].second : nullptr;
  }
  for (const auto& [name, value] : members) {
    if (name == key) return &value;
  }
  return nullptr;
}

const Json& Json::operator[](std::string_view key) const {
  const Json* found = find(key);
  return found == nullptr ? kNull : *found;
}

// -- changing --

Json& Json::operator[](std::string_view key) {
  for (auto& [name, value] : items()) {
    if (name == key) return value;
  }
  return items().emplace_back(std::string(key), Json()).second;
}

void Json::push_back(Json value) {
  if (is_null()) *this = array();
  if (!is_array()) throwKind("an array");
  value_.elements->push_back(std::move(value));
}

void Json::erase(std::string_view key) {
  std::erase_if(items(), [&](const auto& member) { return member.first == key; });
}

void Json::index() {
  constexpr size_t kSmall = 32;  // fewer are looked through as fast
  if (!is_object() || size() <= kSmall || size() > std::numeric_limits<uint32_t>::max()) return;
  if (!indexed_) {
    auto indexed = std::make_unique<Indexed>();
    indexed->members = std::move(*value_.members);
    delete value_.members;
    value_.indexed = indexed.release();
    indexed_ = true;
  }
  const Members& members = value_.indexed->members;
  std::vector<uint32_t>& order = value_.indexed->order;
  order.resize(members.size());
  std::iota(order.begin(), order.end(), uint32_t{0});
  // Of members of one name the first is found, as without an index.
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const int compared = members[a].first.compare(members[b].first);
    return compared < 0 || (compared == 0 && a < b);
  });
}

void Json::update(const Json& other) {
  for (const auto& [name, value] : other.items()) (*this)[name] = value;
}

bool Json::equal(const Json& a, const Json& b) {
  if (a.is_number() && b.is_number()) {
    if (a.kind_ == Kind::Float || b.kind_ == Kind::Float) return a.get<double>() == b.get<double>();
    const auto negative = [](const Json& x) { return x.kind_ == Kind::Integer && x.value_.integer < 0; };
    if (negative(a) || negative(b)) return negative(a) && negative(b) && a.value_.integer == b.value_.integer;
    return a.whole<uint64_t>() == b.whole<uint64_t>();
  }
  if (a.kind_ != b.kind_ || a.size() != b.size()) return false;
  switch (a.kind_) {
    case Kind::Boolean: return a.value_.boolean == b.value_.boolean;
    case Kind::String: return *a.value_.text == *b.value_.text;
    case Kind::Array: return *a.value_.elements == *b.value_.elements;
    case Kind::Object:
      return std::all_of(a.items().begin(), a.items().end(), [&](const auto& member) {
        const Json* found = b.find(member.first);
        return found != nullptr && *found == member.second;
      });
    default: return true;
  }
}

// -- writing --

std::string quotedText(std::string_view text) {
  const bool plain = std::all_of(text.begin(), text.end(),
                                 [](char c) { return c >= 0x20 && c < 0x7F && c != '"' && c != '\\'; });
  if (!plain) return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string all;
  all.reserve(text.size() + 2);
  return all.append(1, '"').append(text).append(1, '"');
}

std::string numberText(double x) { return nlohmann::json(x).dump(); }

void Json::write(std::string& out, int indent, size_t margin) const {
  const size_t inner = margin + static_cast<size_t>(std::max(indent, 0));
  const auto line = [&](size_t spaces) {
    if (indent >= 0) out.append(1, '\n').append(spaces, ' ');
  };
  const auto all = [&](char open, char close, const auto& items, auto one) {
    out += open;
    for (size_t i = 0; i < items.size(); ++i) {
      if (i > 0) out += ',';
      line(inner);
      one(items[i]);
    }
    if (!items.empty()) line(margin);
    out += close;
  };
  switch (kind_) {
    case Kind::Null: out += "null"; break;
    case Kind::Boolean: out += value_.boolean ? "true" : "false"; break;
    case Kind::Integer: out += std::to_string(value_.integer); break;
    case Kind::Unsigned: out += std::to_string(value_.whole); break;
    case Kind::Float: out += numberText(value_.number); break;
    case Kind::String: out += quotedText(*value_.text); break;
    case Kind::Array:
      all('[', ']', *value_.elements, [&](const Json& element) { element.write(out, indent, inner); });
      break;
    case Kind::Object:
      all('{', '}', members(), [&](const auto& member) {
        out += quotedText(member.first) + (indent >= 0 ? ": " : ":");
        member.second.write(out, indent, inner);
      });
      break;
  }
}

std::string Json::dump(int indent) const {
  std::string out;
  write(out, indent, 0);
  return out;
}

}  // namespace lacquer::json
