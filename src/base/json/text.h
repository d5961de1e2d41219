// JSON as text, written front to back: no tree, so that a manifest of many materials costs a buffer.
//
// The layout follows from the content alone (a tree printed here has the bytes that were written piece by
// piece): a container is on one line when all that it holds is and the line is short, otherwise each item has
// a line.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "json/json.h"

namespace lacquer::json {

class JsonText {
public:
  /// `depth`: how deep the first container lies in the whole document.
  explicit JsonText(size_t depth = 0) : depth_(depth) {}

  JsonText& beginObject() { return begin('{'); }
  JsonText& endObject() { return end('}'); }
  JsonText& beginArray() { return begin('['); }
  JsonText& endArray() { return end(']'); }
  JsonText& key(std::string_view name);

  JsonText& string(std::string_view text);
  /// The shortest text that reads back as the same number; null when it is not finite.
  JsonText& number(double x);
  JsonText& integer(int64_t x);
  JsonText& boolean(bool b) { return raw(b ? "true" : "false"); }
  /// One number, or an array of them.
  JsonText& numbers(std::span<const double> numbers);
  JsonText& json(const Json& value);
  /// An item that has been written by a JsonText of this depth already.
  JsonText& raw(std::string_view text);
  /// Room for `items` items in all, of which `written` have been and the rest are about as long.
  void reserve(size_t items, size_t written);
  size_t depth() const { return depth_ + open_.size(); }

  std::string take() { return std::move(out_); }

private:
  JsonText& begin(char bracket);
  JsonText& end(char bracket);
  void item();
  void newLine(size_t margin);
  void separate(size_t start);
  void breakLines();
  void quoted(std::string_view text);

  struct Open {
    size_t start;  ///< of its content in `out_`
    bool empty = true;
    bool broken = false;  ///< its items have a line each; those of all around it, too
  };
  size_t depth_;
  std::string out_;  ///< of open containers on one line: items with a marker between
  std::vector<Open> open_;
  bool after_key_ = false;
};

}  // namespace lacquer::json
