#include "json/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lacquer::json {

namespace {

/// Stands between items until it is known whether they get a line each. JSON text never holds it.
constexpr char kMarker = '\x01';
constexpr size_t kLongestLine = 110;

}  // namespace

void JsonText::item() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (open_.empty()) return;
  if (!open_.back().empty) out_ += kMarker;
  open_.back().empty = false;
}

JsonText& JsonText::begin(char bracket) {
  item();
  out_ += bracket;
  open_.push_back({out_.size()});
  return *this;
}

JsonText& JsonText::end(char bracket) {
  const Open done = open_.back();
  open_.pop_back();
  if (!done.empty) {
    const std::string content = out_.substr(done.start);
    out_.resize(done.start);
    const bool line = content.size() <= kLongestLine && content.find('\n') == std::string::npos;
    const std::string margin = "\n" + std::string(2 * (depth() + 1), ' ');
    if (!line) out_ += margin;
    for (size_t from = 0; from <= content.size();) {
      const size_t to = std::min(content.find(kMarker, from), content.size());
      out_.append(content, from, to - from);
      if (to < content.size()) out_ += line ? ", " : "," + margin;
      from = to + 1;
    }
    if (!line) out_.append(margin, 0, margin.size() - 2);
  }
  out_ += bracket;
  return *this;
}

void JsonText::quoted(std::string_view text) {
  const bool plain = std::all_of(text.begin(), text.end(),
                                 [](char c) { return c >= 0x20 && c < 0x7F && c != '"' && c != '\\'; });
  if (!plain) {
    // A name that is not UTF-8 must not cost the whole text.
    out_ += Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
    return;
  }
  out_ += '"';
  out_ += text;
  out_ += '"';
}

JsonText& JsonText::key(std::string_view name) {
  item();
  quoted(name);
  out_ += ": ";
  after_key_ = true;
  return *this;
}

JsonText& JsonText::string(std::string_view text) {
  item();
  quoted(text);
  return *this;
}

JsonText& JsonText::number(double x) {
  if (!std::isfinite(x)) return raw("null");
  item();
  fmt::format_to(std::back_inserter(out_), "{}", x == 0 ? 0.0 : x);
  return *this;
}

JsonText& JsonText::integer(int64_t x) {
  item();
  fmt::format_to(std::back_inserter(out_), "{}", x);
  return *this;
}

JsonText& JsonText::numbers(std::span<const double> numbers) {
  if (numbers.size() == 1) return number(numbers[0]);
  beginArray();
  for (const double x : numbers) number(x);
  return endArray();
}

JsonText& JsonText::raw(std::string_view text) {
  item();
  out_ += text;
  return *this;
}

JsonText& JsonText::json(const Json& value) {
  switch (value.type()) {
    case Json::value_t::object:
      beginObject();
      for (const auto& [name, member] : value.get_ref<const Json::object_t&>()) key(name).json(member);
      return endObject();
    case Json::value_t::array:
      beginArray();
      for (const Json& element : value) json(element);
      return endArray();
    case Json::value_t::string: return string(value.get_ref<const std::string&>());
    case Json::value_t::boolean: return boolean(value.get<bool>());
    case Json::value_t::number_integer:
    case Json::value_t::number_unsigned: return integer(value.get<int64_t>());
    case Json::value_t::number_float: return number(value.get<double>());
    case Json::value_t::null:
    case Json::value_t::binary:
    case Json::value_t::discarded: break;
  }
  return raw("null");
}

}  // namespace lacquer::json
