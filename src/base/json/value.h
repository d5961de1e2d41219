// A JSON value: null, a truth, a number, a text, or a list or object of such, which keeps its members in
// order.
//
// Its destructor asks for no memory, so that what runs out of memory can still be cleaned up. That of
// nlohmann::json does, and ends the program where there is none; that library reads and writes the text
// alone.
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <ranges>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacquer::json {

// Functions have the names that nlohmann::json and the containers of the standard library have for the same.
// NOLINTBEGIN(readability-identifier-naming)
class Json {
public:
  enum class Kind : uint8_t { Null, Object, Array, String, Boolean, Integer, Unsigned, Float };
  using Members = std::vector<std::pair<std::string, Json>>;
  using Elements = std::vector<Json>;
  class Part;

  Json() = default;  ///< null
  Json(std::nullptr_t) {}
  template <std::same_as<bool> T>
  Json(T value) : kind_(Kind::Boolean) {
    value_.boolean = value;
  }
  template <std::signed_integral T>
  Json(T value) : kind_(Kind::Integer) {
    value_.integer = value;
  }
  template <std::unsigned_integral T>
  requires(!std::same_as<T, bool>) Json(T value) : kind_(Kind::Unsigned) { value_.whole = value; }
  template <std::floating_point T>
  Json(T value) : kind_(Kind::Float) {
    value_.number = value;
  }
  Json(std::string text);
  Json(std::string_view text) : Json(std::string(text)) {}
  Json(const char* text) : Json(std::string(text)) {}
  /// A list of what a container holds.
  template <class Range>
  requires(!std::same_as<Range, Json>) && std::ranges::input_range<const Range> &&
      (!std::convertible_to<const Range&, std::string_view>)&&std::convertible_to<
          std::ranges::range_reference_t<const Range>, Json> Json(const Range& range)
      : Json(array()) {
    for (const auto& each : range) push_back(Json(each));
  }
  /// In braces: an object when each part is a pair that begins with a text, else a list.
  Json(std::initializer_list<Part> parts);
  static Json object();
  static Json array();
  static Json array(std::initializer_list<Part> parts);

  Json(const Json& other);
  Json(Json&& other) noexcept : kind_(other.kind_), indexed_(other.indexed_), value_(other.value_) {
    other.kind_ = Kind::Null;
  }
  Json& operator=(Json other) noexcept {
    std::swap(kind_, other.kind_);
    std::swap(indexed_, other.indexed_);
    std::swap(value_, other.value_);
    return *this;
  }
  ~Json();

  Kind kind() const { return kind_; }
  bool is_null() const { return kind_ == Kind::Null; }
  bool is_object() const { return kind_ == Kind::Object; }
  bool is_array() const { return kind_ == Kind::Array; }
  bool is_string() const { return kind_ == Kind::String; }
  bool is_boolean() const { return kind_ == Kind::Boolean; }
  bool is_number() const { return is_number_integer() || kind_ == Kind::Float; }
  bool is_number_integer() const { return kind_ == Kind::Integer || is_number_unsigned(); }
  /// What was written without sign and fraction, or comes from an unsigned number.
  bool is_number_unsigned() const { return kind_ == Kind::Unsigned; }

  /// Of elements or members; 0 of null, 1 of what holds nothing else.
  size_t size() const;
  bool empty() const { return size() == 0; }

  /// A boolean, a number (double, int, int64_t, uint32_t, uint64_t), a std::string, or a vector of them.
  /// Numbers become each other, at the type's ends where they do not fit. Throws std::logic_error where the
  /// value is of another kind: who asks has looked.
  template <class T>
  T get() const;
  /// A string's; throws likewise.
  const std::string& text() const;
  /// An object's members, in their order; throws likewise. Null has none.
  const Members& items() const;
  Members& items();

  /// The elements of a list; nothing where it is none.
  const Json* begin() const { return is_array() ? value_.elements->data() : nullptr; }
  const Json* end() const { return begin() + (is_array() ? value_.elements->size() : 0); }
  Json* begin() { return is_array() ? value_.elements->data() : nullptr; }
  Json* end() { return begin() + (is_array() ? value_.elements->size() : 0); }

  /// An element of a list, a member of an object; null where it is not there.
  const Json& operator[](size_t index) const;
  const Json& operator[](std::string_view key) const;
  /// The member, null and at the end when it is new. Null becomes an object.
  Json& operator[](std::string_view key);
  const Json* find(std::string_view key) const;
  bool contains(std::string_view key) const { return find(key) != nullptr; }

  /// At the end of a list. Null becomes one.
  void push_back(Json value);
  void erase(std::string_view key);
  /// A member of a large object is found in logarithmic time from here on, until the object is changed.
  void index();
  /// The other object's members, in place of those of the same name.
  void update(const Json& other);

  /// As text: on one line, or with a line for each value, indented by so many spaces a level. What is not
  /// UTF-8 becomes U+FFFD, a number that is not finite null.
  std::string dump(int indent = -1) const;

  /// Numbers by their values; objects whatever the order of their members.
  friend bool operator==(const Json& a, const Json& b) { return equal(a, b); }

private:
  static bool equal(const Json& a, const Json& b);
  template <class To>
  To whole() const;
  void write(std::string& out, int indent, size_t margin) const;

  /// Members, and their places by name; none where they were changed.
  struct Indexed {
    Members members;
    std::vector<uint32_t> order;
  };
  const Members& members() const { return indexed_ ? value_.indexed->members : *value_.members; }

  union Value {
    bool boolean;
    int64_t integer;
    uint64_t whole;
    double number;
    std::string* text;
    Elements* elements;
    Members* members;
    Indexed* indexed;
  };
  Kind kind_ = Kind::Null;
  bool indexed_ = false;  ///< an object that is large; small ones are many
  Value value_{};
};
// NOLINTEND(readability-identifier-naming)

/// What stands in braces: a value, or braces again.
class Json::Part {
public:
  template <std::convertible_to<Json> T>
  Part(T&& value) : value_(std::forward<T>(value)) {}
  Part(std::initializer_list<Part> parts) : value_(parts) {}
  const Json& value() const { return value_; }
  /// The list is there for one reading: what it holds goes on.
  Json take() const { return std::move(value_); }

private:
  mutable Json value_;
};

template <>
bool Json::get<bool>() const;
template <>
double Json::get<double>() const;
template <>
int Json::get<int>() const;
template <>
int64_t Json::get<int64_t>() const;
template <>
uint32_t Json::get<uint32_t>() const;
template <>
uint64_t Json::get<uint64_t>() const;
template <>
std::string Json::get<std::string>() const;
template <>
std::vector<std::string> Json::get<std::vector<std::string>>() const;

/// A text with its quotes and escapes; what is not UTF-8 becomes U+FFFD, since JSON has no place for it.
std::string quotedText(std::string_view text);
/// The shortest text that reads back as the same number, with a point or an exponent; null when it is not
/// finite.
std::string numberText(double x);

}  // namespace lacquer::json
