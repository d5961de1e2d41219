#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <unordered_map>

#include <pugixml.hpp>

#include "lang/suggest.h"
#include "mtlx/element.h"
#include "mtlx/inheritance.h"
#include "mtlx/looks.h"
#include "mtlx/namespaces.h"
#include "mtlx/upgrade.h"
#include "mtlx/well_formed.h"
#include "support/contain.h"
#include "support/file.h"
#include "support/text.h"

namespace lacquer::materialx {

namespace {

/// Elements within elements: a document has nodes in graphs in a root, and documentation in these.
constexpr size_t kDeepestElement = 32;
/// Elements of a document with all that it includes.
constexpr uint64_t kMostElements = uint64_t{1} << 20;
/// More than anyone writes: each is compared with those before it.
constexpr size_t kMostAttributes = 1024;
/// Files that a file includes, theirs included.
constexpr size_t kMostFiles = 256;

/// The encoding that a text shows or declares; empty for UTF-8 and ASCII.
std::string foreignEncoding(std::string_view text) {
  if (const std::string_view wide = wideEncoding(text); !wide.empty()) return std::string(wide);
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (!text.starts_with("<?xml")) return {};
  text = text.substr(0, text.find("?>"));
  const size_t at = text.find("encoding");
  const size_t quoted = at == std::string_view::npos ? at : text.find_first_of("\"'", at);
  if (quoted == std::string_view::npos) return {};
  const std::string declared(text.substr(quoted + 1, text.find(text[quoted], quoted + 1) - quoted - 1));
  std::string low = declared;
  for (char& c : low) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  const bool known = low == "utf-8" || low == "utf8" || low == "us-ascii" || low == "ascii";
  return known ? std::string() : declared;
}

/// A second element beside the root, or text there; null for none.
pugi::xml_node besideRoot(const pugi::xml_document& xml) {
  for (const pugi::xml_node& node : xml.children()) {
    const bool text = node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
    if (text || (node.type() == pugi::node_element && node != xml.document_element())) return node;
  }
  return {};
}

/// The output of a nodegraph or a definition that has one alone; null for others.
const Element* onlyOutput(const Element& owner) {
  const Element* only = nullptr;
  for (const Element& child : owner.children) {
    if (child.category != "output") continue;
    if (only != nullptr) return nullptr;
    only = &child;
  }
  return only;
}

/// A connection to a nodegraph of one output takes that, whatever it calls it.
void nameOnlyOutputs(Element& root) {
  std::unordered_map<std::string_view, const Element*> graphs;
  for (const Element& child : root.children)
    if (child.category == "nodegraph") graphs.try_emplace(child.name(), onlyOutput(child));
  const auto connect = [&](Element& port) {
    const std::string* name =
        port.find("nodegraph") != nullptr ? port.find("nodegraph") : port.find("nodename");
    if (name == nullptr || port.find("output") == nullptr) return;
    const auto graph = graphs.find(*name);
    if (graph != graphs.end() && graph->second != nullptr)
      port.set("output", std::string(graph->second->name()));
  };
  for (Element& child : root.children) {
    connect(child);
    for (Element& port : child.children) connect(port);
  }
}

/// Says which children of nodes and of definitions are none that these have: nobody reads them.
void tellUnknown(const Element& scope, Diagnostics& said) {
  constexpr std::string_view kPorts[] = {"input", "output", "token"};
  for (const Element& node : scope.children) {
    if (node.category == "nodegraph") {
      tellUnknown(node, said);
      continue;
    }
    // What is for other applications may have any children; it has no type.
    const bool definition = node.category == "nodedef";
    if (!definition && (!isNodeElement(node) || node.get("type").empty())) continue;
    for (const Element& child : node.children) {
      if (child.category == "comment" ||
          std::find(std::begin(kPorts), std::end(kPorts), child.category) != std::end(kPorts))
        continue;
      const std::string known = fmt::format("it has {}", listOf(kPorts));
      addBounded(said,
                 {"unknown-element",
                  Severity::Warning,
                  child.place,
                  fmt::format("the {} {} has no {}, which is left out", node.category, quote(node.name()),
                              quote(child.category)),
                  child.category == "parameter" ? std::string("since MaterialX 1.38 it is called 'input'")
                                                : lang::didYouMean(child.category, kPorts, known),
                  {}});
    }
  }
}

/// What inputs have of the elements around them.
struct Inherited {
  std::string colorspace, fileprefix, geomprefix;
  bool without_space = false;  ///< an element says that it has none, within one that has

  /// What an element says itself.
  void take(const Element& own) {
    if (const std::string* space = own.find("colorspace")) {
      without_space = space->empty() && (without_space || !colorspace.empty());
      colorspace = *space;
    }
    if (const std::string* prefix = own.find("fileprefix")) fileprefix = *prefix;
    if (const std::string* prefix = own.find("geomprefix")) geomprefix = *prefix;
  }
};

class XmlReader {
public:
  using Texts = std::vector<std::pair<std::string, std::string>>;
  XmlReader(const std::string& path, const Limits& limits, const Texts* included, bool includes = true)
      : top_(path), limits_(limits), included_(included), includes_(includes) {}

  Result<Document> read(std::string_view text) {
    Document document;
    document.root.category = "materialx";
    file(text, top_, document.root, {});
    if (!hasError(wrong_) && includes_) qualifyNames(document.root);
    if (!hasError(wrong_)) namesAlike(document.root, true);
    if (!hasError(wrong_) && includes_) inheritNodes(document.root, wrong_);
    if (hasError(wrong_)) return tl::make_unexpected(std::move(wrong_));
    nameOnlyOutputs(document.root);
    tellUnknown(document.root, wrong_);
    document.files = std::move(files_);
    document.said = std::move(wrong_);
    return document;
  }

private:
  void file(std::string_view text, const std::string& path, Element& into, const Inherited& around);
  void namesAlike(Element& scope, bool top);
  void elements(pugi::xml_node parent, Element& into, const Inherited& around, size_t depth);
  void include(pugi::xml_node node, Element& into, const Inherited& around);
  std::optional<std::string> inMemory(const std::string& folder, const std::string& href) const;
  Result<std::string> textInMemory(const std::string& path) const;
  void handDown(Element& element, const Inherited& around) const;
  void attributes(const pugi::xml_node& from, Element& to);
  int version(const Element& root);

  Diagnostic& error(std::string code, ptrdiff_t offset, std::string message, std::string help = {}) {
    Diagnostic& one = wrong_.emplace_back();
    one.code = std::move(code);
    one.place.file = path_;
    one.message = std::move(message);
    one.help = std::move(help);
    const auto at = static_cast<size_t>(std::max<ptrdiff_t>(offset, 0));
    locate(one, text_, std::min(at, text_.size()));
    return one;
  }

  /// Lines and columns of offsets that never go back far: elements come in the order of the text.
  Place placeOf(ptrdiff_t offset) {
    const auto at = std::min(static_cast<size_t>(std::max<ptrdiff_t>(offset, 0)), text_.size());
    if (at < counted_) counted_ = 0, line_ = 1, start_ = 0;
    for (; counted_ < at; ++counted_) {
      if (text_[counted_] != '\n') continue;
      ++line_;
      start_ = counted_ + 1;
    }
    return {path_, line_, static_cast<uint32_t>(at - start_ + 1), {}};
  }

  const std::string& top_;
  const Limits& limits_;
  const Texts* included_;  ///< null: files are read
  bool includes_;
  Diagnostics wrong_;
  std::vector<std::string> files_;
  std::vector<std::string> open_;  ///< files that are being read, to see a circle
  uint64_t count_ = 0;
  // Of the file that is being read.
  std::string path_;
  std::string_view text_;
  size_t counted_ = 0, start_ = 0;
  uint32_t line_ = 1;
};

void XmlReader::file(std::string_view text, const std::string& path, Element& into, const Inherited& around) {
  const std::string outer_path = std::exchange(path_, path);
  const std::string_view outer_text = std::exchange(text_, text);
  const size_t outer_counted = std::exchange(counted_, 0);
  const size_t outer_start = std::exchange(start_, 0);
  const uint32_t outer_line = std::exchange(line_, 1);
  const std::string encoding = foreignEncoding(text);
  pugi::xml_document xml;
  // No entities beyond XML's own five are known to the parser, and a document type is an error below.
  constexpr unsigned kFlags = pugi::parse_cdata | pugi::parse_escapes | pugi::parse_eol |
                              pugi::parse_doctype | pugi::parse_wconv_attribute | pugi::parse_fragment;
  const pugi::xml_parse_result parsed =
      xml.load_buffer(text.data(), text.size(), kFlags, pugi::encoding_utf8);
  const pugi::xml_node root = xml.document_element();
  if (!encoding.empty()) {
    error("xml-encoding", 0, fmt::format("the document is in the encoding {}", quote(encoding)),
          "a document is UTF-8: convert it, or take the declaration away if it is UTF-8 nonetheless");
  } else if (!parsed) {
    error("xml-syntax", parsed.offset, fmt::format("this is no XML: {}", parsed.description()));
  } else if (const pugi::xml_node type =
                 xml.find_child([](pugi::xml_node n) { return n.type() == pugi::node_doctype; })) {
    error("xml-syntax", 0, "the file has a document type",
          "MaterialX has none, and entities are not read: take the line away");
  } else if (const std::optional<Malformed> bad = malformed(text)) {
    error("xml-syntax", static_cast<ptrdiff_t>(bad->at), "this is no XML: " + bad->what, bad->help);
  } else if (const pugi::xml_node more = besideRoot(xml)) {
    error("xml-syntax", more.offset_debug(), "this is no XML: it stands beside the root element",
          "a document has one element, which has all others");
  } else if (!root) {
    error("xml-syntax", 0, "this is no XML: No document element found");
  } else if (std::strcmp(root.name(), "materialx") != 0) {
    error("not-materialx", root.offset_debug(), fmt::format("the root element is {}", quote(root.name())),
          "a MaterialX document has <materialx version=\"1.39\">");
  } else {
    Element own;
    own.place = placeOf(root.offset_debug());
    attributes(root, own);
    const int minor = version(own);
    Inherited inside = around;
    inside.take(own);
    if (into.attributes.empty()) {
      into.attributes = own.attributes;
      into.place = own.place;
    }
    open_.push_back(path);
    const size_t first = into.children.size();
    if (!hasError(wrong_)) elements(root, into, inside, 1);
    open_.pop_back();
    if (!hasError(wrong_) && minor < kPresentMinor) {
      upgrade(into, first, minor, wrong_);
      into.set("version", fmt::format("1.{}", kPresentMinor));
    }
    if (const std::string* space = own.find("namespace"))
      for (size_t i = first; i < into.children.size(); ++i) {
        Element& child = into.children[i];
        if (child.get("namespace").empty()) child.set("namespace", *space);
      }
  }
  path_ = outer_path;
  text_ = outer_text;
  counted_ = outer_counted;
  start_ = outer_start;
  line_ = outer_line;
}

/// Takes over an element's attributes. The parser passes one that is there twice, which XML does not.
void XmlReader::attributes(const pugi::xml_node& from, Element& to) {
  for (const pugi::xml_attribute& a : from.attributes()) {
    if (to.attributes.size() == kMostAttributes)
      return void(error(
          "xml-too-many", from.offset_debug(),
          fmt::format("the element {} has more than {} attributes", quote(from.name()), kMostAttributes)));
    if (to.find(a.name()) != nullptr) {
      error("xml-syntax", from.offset_debug(),
            fmt::format("the attribute {} of {} is there twice", quote(a.name()), quote(from.name())));
    }
    to.attributes.emplace_back(a.name(), a.value());
  }
}

/// The second number of the version; what Lacquer does not know is said.
int XmlReader::version(const Element& root) {
  const std::string_view text = root.get("version");
  const size_t dot = text.find('.');
  const auto number = [](std::string_view digits) {
    return digits.empty() || digits.size() > 4 ||
                   digits.find_first_not_of("0123456789") != std::string_view::npos
               ? -1
               : std::stoi(std::string(digits));
  };
  const int major = number(text.substr(0, dot));
  const int minor = dot == std::string_view::npos ? -1 : number(text.substr(dot + 1));
  if (major == 1 && minor >= kLeastMinor) {
    if (minor > kPresentMinor) {
      wrong_.push_back(
          {"unsupported-version",
           Severity::Warning,
           root.place,
           fmt::format("the version is {}", quote(text)),
           fmt::format("the document is read as one of 1.{}, the latest that Lacquer knows", kPresentMinor),
           {}});
    }
    return minor;
  }
  const bool later = major > 1;
  Diagnostic one{"unsupported-version",
                 Severity::Error,
                 root.place,
                 text.empty() ? "the document has no version" : fmt::format("the version is {}", quote(text)),
                 later ? fmt::format("Lacquer reads MaterialX from 1.{} to 1.{}", kLeastMinor, kPresentMinor)
                       : fmt::format("Lacquer reads MaterialX 1.{} and later; MaterialX's own library brings "
                                     "older documents to it",
                                     kLeastMinor),
                 {}};
  wrong_.push_back(std::move(one));
  return minor;
}

/// Colours, files and geometry are said on the way down what space and folder they are of.
void XmlReader::handDown(Element& element, const Inherited& around) const {
  const std::string_view type = element.get("type");
  const bool file = type == "filename";
  if ((file || type == "color3" || type == "color4") &&
      (!around.colorspace.empty() || around.without_space) && element.find("colorspace") == nullptr)
    element.set("colorspace", around.colorspace);
  const std::string* value = element.find("value");
  if (file && value != nullptr && !value->empty() && !around.fileprefix.empty() && !value->starts_with('/'))
    element.set("value", around.fileprefix + *value);
  if (around.geomprefix.empty()) return;
  for (const std::string_view attribute : {"geom", "includegeom", "excludegeom", "viewergeom"}) {
    const std::string* names = element.find(attribute);
    if (names == nullptr) continue;
    std::string prefixed;
    for (const std::string& name : geometryNames(*names))
      prefixed += (prefixed.empty() ? "" : ", ") + around.geomprefix + name;
    element.set(attribute, std::move(prefixed));
  }
}

/// Elements of one kind and one name in one scope: the second of them is an error, but for a file that is
/// included twice, of which the first counts. `top`: definitions are compared by who reads them alone.
void XmlReader::namesAlike(Element& scope, bool top) {
  std::map<std::pair<std::string_view, std::string_view>, const Element*> known;
  std::vector<bool> again(scope.children.size());
  for (size_t i = 0; i < scope.children.size(); ++i) {
    Element& child = scope.children[i];
    if (!child.children.empty()) namesAlike(child, false);
    if (child.name().empty() || (top && !includes_)) continue;
    const std::string_view kind = isNodeElement(child) ? std::string_view("node") : child.category;
    const auto [it, fresh] = known.try_emplace({kind, child.name()}, &child);
    if (fresh) continue;
    again[i] = it->second->place == child.place;
    if (again[i]) continue;
    addBounded(wrong_, {"duplicate-name",
                        Severity::Error,
                        child.place,
                        fmt::format("the {} {} is there already", it->second->category, quote(child.name())),
                        fmt::format("it stands in {}:{}: names are given once", it->second->place.file,
                                    it->second->place.line),
                        {}});
  }
  size_t i = 0;
  std::erase_if(scope.children, [&](const Element&) { return again[i++]; });
}

void XmlReader::elements(pugi::xml_node parent, Element& into, const Inherited& around, size_t depth) {
  for (const pugi::xml_node& node : parent.children()) {
    if (node.type() != pugi::node_element) continue;
    if (hasError(wrong_)) return;
    if (depth > kDeepestElement) {
      error("xml-too-deep", node.offset_debug(),
            fmt::format("elements lie in each other more than {} deep", kDeepestElement));
      return;
    }
    if (++count_ > kMostElements || count_ > limits_.values) {
      error("xml-too-many", node.offset_debug(),
            fmt::format("the document has more than {} elements", std::min(kMostElements, limits_.values)),
            raising("values"));
      return;
    }
    const std::string_view name = node.name();
    if (name == "xi:include" || name == "include") {
      if (includes_) include(node, into, around);
      continue;
    }
    Element& element = into.children.emplace_back();
    element.category = name;
    element.place = placeOf(node.offset_debug());
    attributes(node, element);
    Inherited inside = around;
    inside.take(element);
    handDown(element, inside);
    elements(node, element, inside, depth + 1);
  }
}

/// A path as seen from the folder that the name of the document would have; nothing for one outside.
std::optional<std::string> XmlReader::inMemory(const std::string& folder, const std::string& href) const {
  const std::filesystem::path path = (std::filesystem::path(folder) / href).lexically_normal();
  const std::filesystem::path first = std::filesystem::path(top_).parent_path().lexically_normal();
  const std::filesystem::path below = first.empty() ? path : path.lexically_relative(first);
  if (below.empty() || below.is_absolute() || *below.begin() == "..") return std::nullopt;
  return path.generic_string();
}

Result<std::string> XmlReader::textInMemory(const std::string& path) const {
  const std::filesystem::path first = std::filesystem::path(top_).parent_path().lexically_normal();
  const std::filesystem::path whole(path);
  const std::string name = (first.empty() ? whole : whole.lexically_relative(first)).generic_string();
  for (const auto& [known, text] : *included_) {
    if (known == name) return text;
  }
  return fail("include-missing", {}, "it is not among the texts that are there");
}

void XmlReader::include(pugi::xml_node node, Element& into, const Inherited& around) {
  const ptrdiff_t offset = node.offset_debug();
  const std::string href = node.attribute("href").value();
  if (href.empty()) return void(error("include-missing", offset, "the include has no \"href\""));
  const std::string folder = std::filesystem::path(path_).parent_path().string();
  const std::string first = std::filesystem::path(top_).parent_path().string();
  const std::filesystem::path relative(href);
  if (relative.is_absolute() || href.find(':') != std::string::npos) {
    error("include-outside", offset, fmt::format("{} is no relative path", quote(href)),
          "included files lie beside the document or below it");
    return;
  }
  const std::optional<std::string> path = included_ != nullptr
                                              ? inMemory(folder, href)
                                              : resolveBelow(folder, href, {first.empty() ? "." : first});
  if (!path) {
    error("include-outside", offset, fmt::format("{} leads out of the document's folder", quote(href)),
          "included files lie beside the document or below it");
    return;
  }
  if (std::find(open_.begin(), open_.end(), *path) != open_.end()) {
    error("include-cycle", offset, fmt::format("{} includes itself", quote(href)));
    return;
  }
  const bool again = std::find(files_.begin(), files_.end(), *path) != files_.end();
  if (!again && files_.size() >= kMostFiles) {
    error("include-too-many", offset, fmt::format("more than {} files are included", kMostFiles));
    return;
  }
  const Result<std::string> text =
      included_ != nullptr ? textInMemory(*path) : readFile(*path, limits_.file, Links::None);
  if (!text) {
    error("include-missing", offset,
          fmt::format("{} cannot be read: {}", quote(href), text.error()[0].message));
    return;
  }
  if (!again) files_.push_back(*path);
  // It may stand in any folder: what is shown of it is its path, so that its errors are found.
  file(*text, *path, into, around);
}

}  // namespace

static Result<void> checkSize(std::string_view text, const std::string& path, const Limits& limits) {
  if (text.size() <= limits.json) return {};
  return fail("xml-too-large", {path, 0, 0, {}}, fmt::format("the file has more than {} bytes", limits.json),
              raising("json"));
}

Result<Document> readXml(std::string_view text, const std::string& path, const Limits& limits,
                         const std::vector<std::pair<std::string, std::string>>* included) {
  if (const Result<void> fits = checkSize(text, path, limits); !fits)
    return tl::make_unexpected(fits.error());
  return XmlReader(path, limits, included).read(text);
}

Result<Document> readXmlAlone(std::string_view text, const std::string& path, const Limits& limits) {
  if (const Result<void> fits = checkSize(text, path, limits); !fits)
    return tl::make_unexpected(fits.error());
  return XmlReader(path, limits, nullptr, false).read(text);
}

}  // namespace lacquer::materialx
