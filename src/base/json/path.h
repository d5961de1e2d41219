// Where in the JSON a reader stands: a chain on the stack, turned into a JSON pointer only when one is
// needed, so that reading a correct file builds no strings for it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace lacquer::json {

/// A member or an element below another one. The parent and the key must outlive it.
class Path {
public:
  Path() = default;  ///< the root of the file
  Path(const Path& parent, std::string_view key) : parent_(&parent), key_(key) {}
  Path(const Path& parent, size_t index) : parent_(&parent), index_(index), element_(true) {}
  // A copy would point to the same parent, but `Path(parent)` reads as if it were a child.
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;

  /// The JSON pointer (RFC 6901); empty for the root. Behind a thousand bytes it is cut, with "..." there.
  std::string text() const;

private:
  void append(std::string& out) const;

  const Path* parent_ = nullptr;
  std::string_view key_;
  size_t index_ = 0;
  bool element_ = false;
};

}  // namespace lacquer::json
