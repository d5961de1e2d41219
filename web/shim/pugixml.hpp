// pugixml's reader as far as the library asks for it: Debian has no sources of pugixml beside its compiled
// library, which is for another machine. The same documents are taken, the same offsets are told. Elements within
// elements take no stack.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace pugi {

enum xml_encoding { encoding_utf8 };
enum xml_node_type { node_null, node_document, node_element, node_pcdata, node_cdata, node_doctype };
// Not to be chosen here: all of them hold.
constexpr unsigned parse_cdata = 1;
constexpr unsigned parse_escapes = 2;
constexpr unsigned parse_eol = 4;
constexpr unsigned parse_doctype = 8;
constexpr unsigned parse_wconv_attribute = 16;
constexpr unsigned parse_fragment = 32;

struct xml_parse_result {
  const char* problem = nullptr;
  std::ptrdiff_t offset = 0;
  explicit operator bool() const { return problem == nullptr; }
  const char* description() const { return problem == nullptr ? "No error" : problem; }
};

class xml_attribute {
public:
  xml_attribute() = default;
  xml_attribute(std::string name, std::string value) : name_(std::move(name)), value_(std::move(value)) {}
  const char* name() const { return name_.c_str(); }
  const char* value() const { return value_.c_str(); }

private:
  std::string name_, value_;
};

class xml_node {
public:
  struct Data {
    xml_node_type type = node_null;
    std::string name;
    std::ptrdiff_t offset = 0;
    std::vector<xml_attribute> attributes;
    std::vector<xml_node> children;
  };

  xml_node() = default;
  explicit xml_node(const Data* data) : data_(data) {}
  explicit operator bool() const { return data_ != nullptr; }
  bool operator==(const xml_node& other) const { return data_ == other.data_; }
  xml_node_type type() const { return data_ == nullptr ? node_null : data_->type; }
  const char* name() const { return data_ == nullptr ? "" : data_->name.c_str(); }
  std::ptrdiff_t offset_debug() const { return data_ == nullptr ? -1 : data_->offset; }
  const std::vector<xml_node>& children() const { return data().children; }
  const std::vector<xml_attribute>& attributes() const { return data().attributes; }
  xml_attribute attribute(std::string_view name) const {
    for (const xml_attribute& one : attributes()) {
      if (name == one.name()) return one;
    }
    return {};
  }

private:
  const Data& data() const {
    static const Data kNone;
    return data_ == nullptr ? kNone : *data_;
  }
  const Data* data_ = nullptr;
};

class xml_document {
public:
  xml_parse_result load_buffer(const char* text, std::size_t size, unsigned, xml_encoding) {
    text_ = {text, size};
    at_ = text_.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0;
    nodes_.clear();
    top_ = &made(node_document, 0);
    open_.assign(1, top_);
    return parse();
  }

  xml_node document_element() const {
    return find_child([](const xml_node& node) { return node.type() == node_element; });
  }
  const std::vector<xml_node>& children() const { return top_->children; }
  template <class Predicate>
  xml_node find_child(Predicate fits) const {
    for (const xml_node& node : children()) {
      if (fits(node)) return node;
    }
    return {};
  }

private:
  using Data = xml_node::Data;

  Data& made(xml_node_type type, std::size_t offset) {
    Data& data = nodes_.emplace_back();
    data.type = type;
    data.offset = static_cast<std::ptrdiff_t>(offset);
    return data;
  }
  Data& add(xml_node_type type, std::size_t offset) {
    Data& data = made(type, offset);
    open_.back()->children.push_back(xml_node(&data));
    return data;
  }

  xml_parse_result wrong(const char* problem) const {
    return {problem, static_cast<std::ptrdiff_t>(at_ < text_.size() ? at_ : text_.size())};
  }
  char now() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool starts(std::string_view with) const { return text_.substr(at_).starts_with(with); }
  static bool space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
  static bool first(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' ||
           static_cast<unsigned char>(c) >= 0x80;
  }
  static bool symbol(char c) { return first(c) || (c >= '0' && c <= '9') || c == '-' || c == '.'; }
  void skipSpaces() {
    while (space(now())) ++at_;
  }
  std::string_view word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && symbol(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  /// To behind the next such text; false where there is none.
  bool skipTo(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
    return found != std::string_view::npos;
  }

  xml_parse_result parse() {
    while (true) {
      const std::size_t next = text_.find('<', at_);
      besideElements(text_.substr(at_, next == std::string_view::npos ? next : next - at_));
      if (next == std::string_view::npos) break;
      at_ = next + 1;
      if (first(now())) {
        if (const xml_parse_result made = element(); !made) return made;
      } else if (now() == '/') {
        if (const xml_parse_result made = end(); !made) return made;
      } else if (now() == '?') {
        if (!skipTo("?>")) return wrong("Error parsing document declaration/processing instruction");
      } else if (starts("!--")) {
        at_ += 3;
        if (!skipTo("-->")) return wrong("Error parsing comment");
      } else if (starts("![CDATA[")) {
        if (open_.size() == 1) add(node_cdata, at_ + 8);
        if (!skipTo("]]>")) return wrong("Error parsing CDATA section");
      } else if (starts("!DOCTYPE")) {
        if (open_.size() > 1 || !doctype()) return wrong("Error parsing document type declaration");
      } else {
        return wrong("Could not determine tag type");
      }
    }
    at_ = text_.size();
    if (open_.size() > 1) return wrong("Start-end tags mismatch");
    if (!document_element()) return {"No document element found", 0};
    return {};
  }

  /// Text in the document itself, but for white space.
  void besideElements(std::string_view text) {
    bool said = false;
    for (const char c : text) said = said || !space(c);
    if (said && open_.size() == 1) add(node_pcdata, at_);
  }

  xml_parse_result element() {
    Data& made = add(node_element, at_);
    made.name = word();
    while (true) {
      const bool apart = space(now());
      skipSpaces();
      if (now() == '>') {
        ++at_;
        open_.push_back(&made);
        return {};
      }
      if (now() == '/') {
        ++at_;
        if (now() != '>') return wrong("Error parsing start element tag");
        ++at_;
        return {};
      }
      if (!apart || !first(now())) return wrong("Error parsing start element tag");
      std::string name(word());
      skipSpaces();
      if (now() != '=') return wrong("Error parsing element attribute");
      ++at_;
      skipSpaces();
      const char quote = now();
      if (quote != '"' && quote != '\'') return wrong("Error parsing element attribute");
      const std::size_t begin = ++at_;
      const std::size_t close = text_.find(quote, begin);
      if (close == std::string_view::npos) {
        at_ = text_.size();
        return wrong("Error parsing element attribute");
      }
      made.attributes.emplace_back(std::move(name), decoded(text_.substr(begin, close - begin)));
      at_ = close + 1;
    }
  }

  xml_parse_result end() {
    ++at_;
    const std::string_view name = word();
    if (open_.size() == 1 || name != open_.back()->name) return wrong("Start-end tags mismatch");
    skipSpaces();
    if (now() != '>') return wrong("Error parsing end element tag");
    ++at_;
    open_.pop_back();
    return {};
  }

  /// Quotes, comments and brackets within brackets are stepped over; nothing in it is read.
  bool doctype() {
    add(node_doctype, at_);
    std::size_t depth = 0;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        at_ = text_.find(c, at_ + 1);
        if (at_ == std::string_view::npos) break;
      } else if (starts("<!--")) {
        if (!skipTo("-->")) break;
        --at_;
      } else if (c == '<') {
        ++depth;
      } else if (c == '>' && depth-- == 0) {
        ++at_;
        return true;
      }
    }
    at_ = text_.size();
    return false;
  }

  static void utf8(std::uint32_t code, std::string& to) {
    const auto byte = [&](std::uint32_t bits) { to += static_cast<char>(bits); };
    if (code < 0x80) {
      byte(code);
    } else if (code < 0x800) {
      byte(0xC0 | code >> 6U);
      byte(0x80 | (code & 0x3FU));
    } else if (code < 0x10000) {
      byte(0xE0 | code >> 12U);
      byte(0x80 | (code >> 6U & 0x3FU));
      byte(0x80 | (code & 0x3FU));
    } else {
      byte(0xF0 | (code >> 18U & 7U));
      byte(0x80 | (code >> 12U & 0x3FU));
      byte(0x80 | (code >> 6U & 0x3FU));
      byte(0x80 | (code & 0x3FU));
    }
  }

  /// XML's five entities and numbers of characters; what else begins with & stays. White space is a space, the
  /// two characters of a line's end one.
  static std::string decoded(std::string_view text) {
    struct Entity {
      std::string_view name;
      char is;
    };
    static constexpr Entity kEntities[] = {
        {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}};
    std::string made;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      if (space(c)) {
        if (c == '\r' && i + 1 < text.size() && text[i + 1] == '\n') ++i;
        made += ' ';
        continue;
      }
      const std::string_view rest = text.substr(i);
      bool known = false;
      for (const Entity& entity : kEntities) {
        if (c != '&' || !rest.starts_with(entity.name)) continue;
        made += entity.is;
        i += entity.name.size() - 1;
        known = true;
        break;
      }
      if (known) continue;
      if (c == '&' && rest.size() > 3 && rest[1] == '#') {
        const bool hex = rest[2] == 'x';
        std::uint32_t code = 0;
        std::size_t at = hex ? 3 : 2;
        const std::size_t begin = at;
        for (; at < rest.size() && rest[at] != ';'; ++at) {
          const char d = rest[at];
          const char low = static_cast<char>(d | 0x20);
          std::uint32_t digit = 16;
          if (d >= '0' && d <= '9') digit = static_cast<std::uint32_t>(d - '0');
          if (hex && low >= 'a' && low <= 'f') digit = static_cast<std::uint32_t>(low - 'a' + 10);
          if (digit >= (hex ? 16U : 10U)) break;
          code = code * (hex ? 16 : 10) + digit;
        }
        if (at > begin && at < rest.size() && rest[at] == ';') {
          utf8(code, made);
          i += at;
          continue;
        }
      }
      made += c;
    }
    return made;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::deque<Data> nodes_;
  Data* top_ = nullptr;
  std::vector<Data*> open_;
};

}  // namespace pugi
