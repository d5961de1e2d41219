#include "json/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
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
    const std::string_view content = std::string_view(out_).substr(done.start);
    const bool line = content.size() <= kLongestLine && content.find('\n') == std::string::npos;
    const std::string margin = line ? "" : "\n" + std::string(2 * (depth() + 1), ' ');
    separate(done.start, margin, line ? ", " : "," + margin);
    if (!line) out_.append(margin, 0, margin.size() - 2);
  }
  out_ += bracket;
  return *this;
}

/// Puts `first` before what stands from `start` on, and `between` in place of each marker there. In place,
/// from the back: what is printed may be hundreds of megabytes.
void JsonText::separate(size_t start, std::string_view first, std::string_view between) {
  size_t from = out_.size();
  const auto begin = out_.begin() + static_cast<ptrdiff_t>(start);
  const auto markers = static_cast<size_t>(std::count(begin, out_.end(), kMarker));
  out_.resize(from + markers * (between.size() - 1) + first.size());
  char* const text = out_.data();
  size_t to = out_.size();
  while (from > start) {
    const size_t found = std::string_view(text + start, from - start).rfind(kMarker);
    const size_t run = found == std::string_view::npos ? start : start + found + 1;
    to -= from - run;
    std::memmove(text + to, text + run, from - run);
    from = run;
    if (run == start) break;
    to -= between.size();
    between.copy(text + to, between.size());
    --from;
  }
  first.copy(text + start, first.size());
}

void JsonText::reserve(size_t items, size_t written) {
  if (items > written) out_.reserve(out_.size() / written * items / 16 * 17);
}

void JsonText::quoted(std::string_view text) {
  const bool plain = std::all_of(text.begin(), text.end(),
                                 [](char c) { return c >= 0x20 && c < 0x7F && c != '"' && c != '\\'; });
  if (!plain) {
    // A name that is not UTF-8 must not cost the whole text.
    out_ += json::quotedText(text);
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
  switch (value.kind()) {
    case Json::Kind::Object:
      beginObject();
      for (const auto& [name, member] : value.items()) key(name).json(member);
      return endObject();
    case Json::Kind::Array:
      beginArray();
      for (const Json& element : value) json(element);
      return endArray();
    case Json::Kind::String: return string(value.text());
    case Json::Kind::Boolean: return boolean(value.get<bool>());
    case Json::Kind::Integer: return integer(value.get<int64_t>());
    case Json::Kind::Unsigned: return raw(std::to_string(value.get<uint64_t>()));
    case Json::Kind::Float: return number(value.get<double>());
    case Json::Kind::Null: break;
  }
  return raw("null");
}

}  // namespace lacquer::json
