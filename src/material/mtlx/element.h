// A MaterialX document as a tree of elements, whether it was written as XML or as the JSON of
// KHR_texture_procedurals. Names and values are as they were written; nothing is looked up here.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "json/json.h"
#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer::materialx {

struct Element {
  std::string category;  ///< "nodegraph", "input", "add"
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<Element> children;
  Place place;
  std::vector<uint32_t> sorted = {};  ///< of many children, by their names; made by index()

  /// Null where there is no such attribute.
  const std::string* find(std::string_view attribute) const;
  /// Empty where there is none.
  std::string_view get(std::string_view attribute) const;
  std::string_view name() const { return get("name"); }
  void set(std::string_view attribute, std::string value);
  /// A child of that category and name; null where there is none.
  const Element* child(std::string_view category, std::string_view name) const;
  /// Makes child() fast here and in all that is below. No child of them is renamed afterwards; more may come,
  /// which makes it slow again.
  void index();
};

/// Whether an element beside others may be a node: it is no port, no definition and nothing of geometry.
bool isNodeElement(const Element& element);

/// Whether an input or output takes its value from a node, a nodegraph or an input of the interface.
bool isConnected(const Element& input);

/// A name without the namespaces in front of it.
inline std::string_view withoutNamespace(std::string_view name) { return name.substr(name.rfind(':') + 1); }

/// How many elements there are: this one, its children, theirs and so on.
size_t countOfElements(const Element& element);

/// "UTF-16" or "UTF-32" for a text that begins like XML in it; empty for all others.
std::string_view wideEncoding(std::string_view text);
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  ///< of UTF-8

/// A document, and what it was made of.
struct Document {
  Element root;
  std::vector<std::string> files;  ///< included ones, in their order
  Diagnostics said;                ///< warnings
};

/// Reads the XML of a `.mtlx` file: no entities but XML's own, no document type, UTF-8. What older versions
/// say otherwise has been brought to 1.39. Included files
/// (`xi:include`) lie in the file's folder or below it. `colorspace`, `fileprefix` and `geomprefix` of the
/// elements around have been handed down to what they are for. Errors: "xml-syntax", "xml-encoding",
/// "duplicate-name", "xml-too-deep", "xml-too-many", "not-materialx", "unsupported-version", "include-…".
/// With `included` no file is read: what is included is there, by its path as seen from the document.
Result<Document> readXml(std::string_view text, const std::string& path, const Limits& limits,
                         const std::vector<std::pair<std::string, std::string>>* included = nullptr);
/// The same of a text that stands for itself: what it includes is left out.
Result<Document> readXmlAlone(std::string_view text, const std::string& path, const Limits& limits);

/// The extension KHR_texture_procedurals as elements.
struct ProceduralElements {
  std::vector<Element> list;         ///< of `procedurals` a `nodegraph` each, in their order
  std::vector<Element> definitions;  ///< of `procedural_definitions` a `nodedef` or a `nodegraph` each
};
/// Places have JSON pointers. What is wrong with one goes to `wrong`, with its pointer, and its element is
/// empty then. `textures`: how many the file has.
ProceduralElements readProcedurals(const json::Json& extension, const std::string& path, const Limits& limits,
                                   size_t textures, Diagnostics& wrong);

/// A document as XML, two spaces of indent, a final newline. Categories and names of attributes are names;
/// values may be any text.
std::string toXml(const Element& root);

/// The numbers of a value such as "1, 0.5": without a locale. Nothing for what is no list of finite numbers.
std::optional<std::vector<double>> numbersOf(std::string_view value);

}  // namespace lacquer::materialx
