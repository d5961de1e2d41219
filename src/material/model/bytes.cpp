#include "model/bytes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <concepts>
#include <cstring>
#include <map>
#include <type_traits>
#include <utility>
#include <vector>

#include "lang/embedded.h"
#include "model/connect.h"

namespace lacquer::model {

namespace {

/// The texts that names may stand in.
std::vector<lang::EmbeddedFile> texts() {
  std::vector<lang::EmbeddedFile> all = lang::embeddedNodes();
  for (const lang::EmbeddedFile& file : lang::embeddedTemplates()) all.push_back(file);
  return all;
}

// -- what a model is made of, for both directions --

template <class T, class U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

/// A number that is mostly -1, which is written as 0.
template <class T>
struct Next {
  T& value;
};
template <class T>
Next(T&) -> Next<T>;

/// What lines have in common with the line before: the difference is written.
enum class Common : uint8_t { Id, Part, Term, Order };
template <class T>
struct After {
  T& value;
  Common what;
  uint32_t step = 0;  ///< the difference that is 0
};
template <class T>
After(T&, Common) -> After<T>;
template <class T>
After(T&, Common, uint32_t) -> After<T>;

// Rare members stand behind the seventh, where the bits of all of them take one byte. What follows from the
// lines (model/connect.h) is not written.

void fields(auto& archive, Is<Value> auto& v) {
  archive(v.kind, v.index, v.path, v.args, v.absent, Next{v.member}, v.type, v.constant, v.coordinate,
          v.image, v.variant);
}

void fields(auto& archive, Is<Condition> auto& c) {
  archive(c.kind, c.index, c.values, c.conditions, c.constant, c.name, c.type);
}

void fields(auto& archive, Is<Alternative> auto& a) { archive(a.value, a.condition, a.unless); }

void fields(auto& archive, Is<Line> auto& l) {
  archive(l.alternatives, l.kind, After{l.id, Common::Id, 1}, After{l.order, Common::Order, 1},
          After{l.part, Common::Part}, After{l.term, Common::Term}, l.target, l.carried, l.shared, l.code,
          l.message, l.help, l.reason, l.place);
}

void fields(auto& archive, Is<Id> auto& i) { archive(i.name, i.overridden, i.light); }

void fields(auto& archive, Is<Term> auto& t) {
  archive(t.name, t.part, Next{t.parent}, t.when, t.unless, t.when_reason, t.unless_reason, t.has_unless);
}

void fields(auto& archive, Is<lang::Origin> auto& o) { archive(o.file, o.line, o.vendor, o.built_in); }

void fields(auto& archive, Is<Part> auto& p) { archive(p.name, p.origin, p.of, p.term); }

void fields(auto& archive, Is<Role> auto& r) { archive(r.name, r.providers); }

void fields(auto& archive, Is<Out> auto& o) { archive(o.name, o.dimmed); }

void fields(auto& archive, Is<std::pair<uint32_t, uint32_t>> auto& p) { archive(p.first, p.second); }

/// All but the nodes, which have names alone.
void fields(auto& archive, Is<Model> auto& m) {
  archive(m.profile, m.profile_origin, m.parts, m.unordered, m.terms, m.lines, m.ids, m.outs, m.roles,
          m.givens, m.switches, m.switch_defaults);
}

template <class T>
concept Whole = std::integral<T> || std::is_enum_v<T>;
template <class T>
concept Object = std::is_class_v<T>;

/// Small for small steps to both sides.
uint32_t zigzag(uint32_t step) { return (step << 1U) ^ ((step >> 31U) != 0 ? ~0U : 0U); }
uint32_t stepOf(uint32_t bits) { return (bits >> 1U) ^ ((bits & 1U) != 0 ? ~0U : 0U); }

/// How many components there are without the zeros at the end.
size_t lengthOf(const ir::Components& values) {
  size_t count = values.size();
  while (count > 0 && std::bit_cast<uint64_t>(values[count - 1]) == 0) --count;
  return count;
}

/// Behind the bits of an object's members that are not at their defaults stand these members alone.
class ByteWriter {
public:
  /// An object's members.
  void operator()(const auto&... members) {
    uint32_t bits = 0, bit = 1;
    ((bits |= isDefault(members) ? 0 : bit, bit <<= 1U), ...);
    number(bits);
    (((bits & 1U) != 0 ? write(members) : void(), bits >>= 1U), ...);
  }

  void write(Whole auto value) { number(static_cast<uint64_t>(value)); }
  template <class T>
  void write(const Next<T>& next) {
    number(static_cast<uint32_t>(next.value) + 1U);
  }
  template <class T>
  void write(const After<T>& after) {
    number(difference(after));
    last_[static_cast<size_t>(after.what)] = after.value;
  }
  /// Without the zeros at the end.
  void write(const ir::Components& values) {
    const size_t count = lengthOf(values);
    number(count);
    for (size_t i = 0; i < count; ++i) {
      const auto bits = std::bit_cast<std::array<char, sizeof(double)>>(values[i]);
      bytes_.append(bits.data(), bits.size());
    }
  }
  void write(std::string_view text) { strings_.emplace_back(bytes_.size(), text); }
  void write(const std::string& text) { write(std::string_view(text)); }
  template <class T>
  void write(const std::vector<T>& list) {
    number(list.size());
    for (const T& one : list) write(one);
  }
  template <Object T>
  void write(const T& object) {
    fields(*this, object);
  }

  std::string finish();

private:
  template <Whole T>
  bool isDefault(T value) const {
    return value == T{};
  }
  bool isDefault(ir::Type type) const { return type == ir::Type::Float; }
  bool isDefault(const ir::Components& values) const { return lengthOf(values) == 0; }
  bool isDefault(const Value& value) const { return value.kind == Value::Kind::None && !value.absent; }
  bool isDefault(const Condition& condition) const { return condition.kind == Condition::Kind::Always; }
  template <Object T>
  bool isDefault(const T& value) const {
    if constexpr (requires { value.empty(); }) return value.empty();
    return false;
  }
  template <class T>
  bool isDefault(const Next<T>& next) const {
    return static_cast<uint32_t>(next.value) + 1U == 0;
  }
  template <class T>
  uint32_t difference(const After<T>& after) const {
    return zigzag(after.value - last_[static_cast<size_t>(after.what)] - after.step);
  }
  /// Where it is skipped, the next one goes on from it all the same.
  template <class T>
  bool isDefault(const After<T>& after) {
    if (difference(after) != 0) return false;
    last_[static_cast<size_t>(after.what)] = after.value;
    return true;
  }
  void number(uint64_t value) { append(bytes_, value); }
  static void append(std::string& to, uint64_t value) {
    for (; value >= 0x80U; value >>= 7U) to.push_back(static_cast<char>(0x80U | (value & 0x7FU)));
    to.push_back(static_cast<char>(value));
  }

  std::string bytes_;
  std::array<uint32_t, 4> last_{};
  std::vector<std::pair<size_t, std::string_view>> strings_;  ///< with where their numbers go
};

/// Where the texts have a string's letters first; behind them all where they have them not.
struct TextPlace {
  size_t file = 0;
  size_t offset = 0;
};

TextPlace placeOf(std::string_view text, const std::vector<lang::EmbeddedFile>& files) {
  for (size_t i = 0; i < files.size(); ++i) {
    if (const size_t at = files[i].text.find(text); at != std::string_view::npos) return {i, at};
  }
  return {files.size(), 0};
}

/// In front stand the strings in the order in which they are first used, with their places in the texts or,
/// where they stand nowhere, their letters. A use says 0 of a string that is new, else which one it is.
std::string ByteWriter::finish() {
  const std::vector<lang::EmbeddedFile> files = texts();
  std::map<std::string_view, uint64_t> numbers;
  std::string table, uses;
  TextPlace last;
  size_t done = 0;
  for (const auto& [at, text] : strings_) {
    const auto [known, fresh] = numbers.try_emplace(text, numbers.size() + 1);
    uses.append(bytes_, done, at - done);
    append(uses, fresh ? 0 : known->second);
    done = at;
    if (!fresh) continue;
    const TextPlace place = placeOf(text, files);
    append(table, zigzag(static_cast<uint32_t>(place.file - last.file)));
    append(table, text.size());
    if (place.file == files.size()) {
      table += text;
    } else {
      append(table, zigzag(static_cast<uint32_t>(place.offset - last.offset)));
    }
    last = place;
  }
  uses.append(bytes_, done);
  std::string head;
  append(head, numbers.size());
  return head + table + uses;
}

class ByteReader {
public:
  explicit ByteReader(std::string_view bytes) : at_(bytes.data()) { readStrings(); }

  void operator()(auto&&... members) {
    uint32_t bits = number();
    ((((bits & 1U) != 0 ? read(members) : skip(members)), bits >>= 1U), ...);
  }

  template <Whole T>
  void read(T& value) {
    value = static_cast<T>(number());
  }
  template <class T>
  void read(Next<T>& next) {
    next.value = static_cast<T>(number() - 1U);
  }
  template <class T>
  void read(After<T>& after) {
    move(after, stepOf(number()));
  }
  void read(ir::Components& values) {
    const size_t size = number() * sizeof(double);
    std::memcpy(values.data(), at_, size);
    at_ += size;
  }
  void read(std::string_view& text) {
    const uint32_t known = number();
    text = strings_[known == 0 ? fresh_++ : known - 1];
  }
  void read(std::string& text) {
    std::string_view view;
    read(view);
    text = view;
  }
  template <class T>
  void read(std::vector<T>& list) {
    std::vector<T> made(number());  // takes less code than resize()
    for (T& one : made) read(one);
    list = std::move(made);
  }
  void read(std::vector<bool>& list) {
    list.resize(number());
    for (size_t i = 0; i < list.size(); ++i) list[i] = number() != 0;
  }
  template <Object T>
  void read(T& object) {
    fields(*this, object);
  }

private:
  void skip(const auto& /*at its default*/) {}
  template <class T>
  void skip(After<T>& after) {
    move(after, 0);
  }
  template <class T>
  void move(After<T>& after, uint32_t further) {
    uint32_t& last = last_[static_cast<size_t>(after.what)];
    last += after.step + further;
    after.value = last;
  }
  uint32_t number() {
    uint32_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
      const auto byte = static_cast<unsigned char>(*at_++);
      value |= static_cast<uint32_t>(byte & 0x7FU) << shift;
      if (byte < 0x80U) return value;
    }
  }
  void readStrings();

  const char* at_;
  std::array<uint32_t, 4> last_{};
  size_t fresh_ = 0;  ///< how many strings were used
  std::vector<std::string_view> strings_;
};

void ByteReader::readStrings() {
  const std::vector<lang::EmbeddedFile> files = texts();
  strings_.resize(number());
  uint32_t file = 0, offset = 0;
  for (std::string_view& text : strings_) {
    file += stepOf(number());
    const uint32_t length = number();
    if (file == files.size()) {
      text = {at_, length};
      at_ += length;
      offset = 0;
    } else {
      offset += stepOf(number());
      text = files[file].text.substr(offset, length);
    }
  }
}

}  // namespace

std::string toBytes(const Model& model) {
  ByteWriter writer;
  writer.write(model);
  std::vector<std::string_view> nodes;
  for (const Node& node : model.nodes) nodes.push_back(node.name());
  writer.write(nodes);
  return writer.finish();
}

Model fromBytes(std::string_view bytes, const lang::Library& library, const material::Schema& schema) {
  ByteReader reader(bytes);
  Model model;
  reader.read(model);
  model.library = &library;
  model.schema = &schema;
  std::vector<std::string_view> nodes;
  reader.read(nodes);
  model.nodes.reserve(nodes.size());
  for (const std::string_view name : nodes) model.nodes.emplace_back(name);
  connect(model);
  return model;
}

}  // namespace lacquer::model
