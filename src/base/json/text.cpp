#include "json/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>

namespace lacquer::json {

namespace {

/// Stands between items until it is known whether they get a line each. JSON text never holds it.
constexpr char kMarker = '\x01';
constexpr size_t kLongestLine = 110;

/// By character: what is not written as it is.
constexpr std::array<bool, 256> kSpecial = [] {
  std::array<bool, 256> special{};
  for (size_t c = 0; c < special.size(); ++c) special[c] = c < 0x20 || c >= 0x7F || c == '"' || c == '\\';
  return special;
}();

}  // namespace

void JsonText::item() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (open_.empty()) return;
  if (!open_.back().broken && out_.size() - open_.back().start > kLongestLine) breakLines();
  Open& in = open_.back();
  if (in.broken) {
    if (!in.empty) out_ += ',';
    newLine(depth());
  } else if (!in.empty) {
    out_ += kMarker;
  }
  in.empty = false;
}

void JsonText::newLine(size_t margin) {
  out_ += '\n';
  out_.append(2 * margin, ' ');
}

JsonText& JsonText::begin(char bracket) {
  item();
  out_ += bracket;
  open_.push_back({out_.size()});
  return *this;
}

JsonText& JsonText::end(char bracket) {
  Open& done = open_.back();
  if (!done.broken && out_.size() - done.start > kLongestLine) breakLines();
  if (done.broken) {
    newLine(depth() - 1);
  } else {
    separate(done.start);
  }
  open_.pop_back();
  out_ += bracket;
  return *this;
}

/// A blank behind each comma of a container on one line.
void JsonText::separate(size_t start) {
  for (size_t at = out_.find(kMarker, start); at != std::string::npos; at = out_.find(kMarker, at + 2))
    out_.replace(at, 1, ", ");
}

/// Gives each item of the open containers a line of its own. Those that were broken before are the outermost;
/// of the others there is no more than a line's length each, but for the last.
void JsonText::breakLines() {
  size_t first = open_.size();
  while (first > 0 && !open_[first - 1].broken) --first;
  const std::string tail = out_.substr(open_[first].start);
  const size_t begin = open_[first].start;
  out_.resize(begin);
  for (size_t i = first; i < open_.size(); ++i) {
    Open& in = open_[i];
    const size_t from = in.start - begin;
    const size_t to = i + 1 < open_.size() ? open_[i + 1].start - begin : tail.size();
    in.start = out_.size();
    in.broken = true;
    const size_t margin = depth_ + i + 1;
    if (!in.empty) newLine(margin);
    for (size_t at = from; at < to;) {
      const size_t next = std::min(tail.find(kMarker, at), to);
      out_.append(tail, at, next - at);
      at = next + 1;
      if (next == to) break;
      out_ += ',';
      newLine(margin);
    }
  }
}

void JsonText::reserve(size_t items, size_t written) {
  if (items > written) out_.reserve(out_.size() / written * items / 16 * 17);
}

void JsonText::quoted(std::string_view text) {
  const bool plain =
      std::none_of(text.begin(), text.end(), [](char c) { return kSpecial[static_cast<unsigned char>(c)]; });
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
  if (!open_.empty() && !open_.back().broken && text.find('\n') != std::string_view::npos) breakLines();
  item();
  out_ += text;
  return *this;
}

JsonText& JsonText::json(const Json& value) {
  switch (value.type()) {
    case Json::value_t::object:
      beginObject();
      for (const auto& [name, member] : value.items()) key(name).json(member);
      return endObject();
    case Json::value_t::array:
      beginArray();
      for (const Json& element : elements(value)) json(element);
      return endArray();
    case Json::value_t::string: return string(lacquer::json::text(value));
    case Json::value_t::boolean: return boolean(value.get<bool>());
    case Json::value_t::number_integer: return integer(value.get<int64_t>());
    case Json::value_t::number_unsigned: return raw(std::to_string(value.get<uint64_t>()));
    case Json::value_t::number_float: return number(value.get<double>());
    case Json::value_t::null:
    case Json::value_t::binary:
    case Json::value_t::discarded: break;
  }
  return raw("null");
}

}  // namespace lacquer::json
