#include "cli/table.h"
#include "cli/search.h"
#include "cli/streams.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <map>

#include "json/json.h"
#include "support/text.h"

#if defined(__unix__) || defined(__APPLE__)
#include <sys/ioctl.h>
#include <unistd.h>
#endif

namespace lacquer::cli {

int terminalWidth() {
#if defined(__unix__) || defined(__APPLE__)
  winsize size{};
  if (isatty(STDERR_FILENO) != 0 && ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0) return size.ws_col;
#endif
  return 0;
}

std::string printable(std::string_view text, std::string_view kept) {
  std::string result;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find_first_of(kept, at), text.size());
    result += lacquer::printable(text.substr(at, end - at), std::string_view::npos);
    if (end < text.size()) result += text[end];
    at = end + 1;
  }
  return result;
}

namespace {

constexpr size_t kLineWidth = 110;
/// More materials than this are counted, not listed: nobody reads them.
constexpr size_t kMostMaterials = 60;

/// Words after a label, wrapped under each other.
void printWrapped(const std::string& label, const std::vector<std::string>& words) {
  std::string line = label;
  const std::string indent(label.size(), ' ');
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string word = words[i] + (i + 1 < words.size() ? "," : "");
    if (line.size() + word.size() + 1 > kLineWidth && line.size() > indent.size()) {
      fmt::print("{}\n", printable(line));
      line = indent;
    }
    line += (line.size() > indent.size() ? " " : "") + word;
  }
  if (!words.empty()) fmt::print("{}\n", printable(line));
}

/// "coat: fresnel absorption", one entry for each group of terms.
std::vector<std::string> grouped(const std::vector<std::string>& terms) {
  std::vector<std::string> order;
  std::map<std::string, std::string> groups;
  for (const std::string& term : terms) {
    const size_t dot = term.find('.');
    const std::string group = term.substr(0, dot);
    if (!groups.contains(group)) order.push_back(group);
    groups[group] += dot == std::string::npos ? "" : " " + term.substr(dot + 1);
  }
  std::vector<std::string> result;
  for (const std::string& group : order) {
    result.push_back(groups[group].empty() ? group : fmt::format("{} ({})", group, groups[group].substr(1)));
  }
  return result;
}

std::string range(const json::Json& item) {
  if (!item.contains("range")) return {};
  const auto end = [](const json::Json& x, const char* infinite) {
    return x.is_null() ? std::string(infinite) : fmt::format("{}", x.get<double>());
  };
  const json::Json& ends = json::at(item, "range");
  return fmt::format(" in [{}, {}]{}", end(ends[0], "-inf"), end(ends[1], "inf"),
                     item.contains("or_zero") ? " or 0" : "");
}

/// A number as the node language writes it: whole ones without a fraction, truths as words.
std::string number(const json::Json& value, std::string_view type) {
  if (!value.is_number()) return json::dump(value);
  if (type.starts_with('b')) return value.get<double>() != 0 ? "true" : "false";
  return fmt::format("{}", value.get<double>());
}

/// What an input is where nothing is connected: " = given uv0 or [0, 0]", " = euclidean".
std::string byDefault(const json::Json& input) {
  std::string text =
      input.contains("given") ? "given " + json::text(json::at(input, "given")) : std::string();
  if (input.contains("default")) {
    const json::Json& value = json::at(input, "default");
    const auto type = json::text(json::at(input, "type"));
    std::string constant;
    if (input.contains("choices") && value.is_number()) {
      const auto place = static_cast<size_t>(std::max(value.get<double>(), 0.0));
      const json::Json& choices = json::at(input, "choices");
      constant = json::text(choices[std::min(place, choices.size() - 1)]);
    } else if (value.is_array()) {
      for (const json::Json& one : json::elements(value))
        constant += (constant.empty() ? "[" : ", ") + number(one, type);
      constant += ']';
    } else {
      constant = number(value, type);
    }
    text += (text.empty() ? "" : " or ") + constant;
  }
  return text.empty() ? text : " = " + text;
}

/// The names of an input's values: " of linear, smooth, step".
std::string choices(const json::Json& input) {
  if (!input.contains("choices")) return {};
  std::string text;
  for (const json::Json& one : json::elements(json::at(input, "choices")))
    text += (text.empty() ? " of " : ", ") + json::text(one);
  return text;
}

void printNode(const json::Json& node) {
  fmt::print("{}\n", json::text(json::at(node, "name")));
  fmt::print("    {}\n    source: {}\n", json::text(json::at(node, "doc")),
             json::text(json::at(node, "source")));
  for (const auto& input : json::elements(json::at(node, "inputs"))) {
    const std::string values = choices(input);
    std::string line = fmt::format("    in   {:<10} {}{}{}", json::text(json::at(input, "type")),
                                   json::text(json::at(input, "name")),
                                   values.empty() ? range(input) : values, byDefault(input));
    if (input.contains("meaning")) line += "  // " + json::text(json::at(input, "meaning"));
    fmt::print("{}\n", line);
  }
  for (const auto& output : json::elements(json::at(node, "outputs"))) {
    const std::string line = fmt::format("    out  {:<10} {}{}", json::text(json::at(output, "type")),
                                         json::text(json::at(output, "name")), range(output));
    fmt::print("{}\n", line);
  }
  for (const auto& variant : json::elements(json::at(node, "variants"))) {
    fmt::print("    variant {}  {}\n", json::text(json::at(variant, "name")),
               json::text(json::at(variant, "doc")));
  }
}

}  // namespace

void printReport(const Report& report, const Options& options) {
  std::string file;
  size_t listed = 0;
  for (const MaterialReport& material : report.materials) {
    if (material.file != file) {
      file = material.file;
      fmt::print("\n{}\n", printable(file));
    }
    if (++listed > kMostMaterials) continue;
    std::string ids;
    for (const std::string& id : material.shaders) {
      if (ids.find(id) == std::string::npos) ids += " " + id;
    }
    const std::string state = !material.ok ? " failed" : ids.empty() ? " nothing to generate" : ids;
    fmt::print(
        "  {}{}\n",
        material.name.empty() ? fmt::format("(material {})", material.index) : printable(material.name),
        state);
    printWrapped("      terms    ", grouped(material.terms->terms));
    std::vector<std::string> skipped;
    for (const auto& [term, reason] : material.terms->skipped)
      skipped.push_back(fmt::format("{} ({})", term, reason));
    printWrapped("      skipped  ", skipped);
  }
  if (listed > kMostMaterials)
    fmt::print("  … and {} more materials, in manifest.json\n", listed - kMostMaterials);

  if (!report.shaders.empty()) fmt::print("\nshaders\n");
  for (const ShaderReport& shader : report.shaders) {
    if (report.shaders.size() > kMostMaterials) break;
    fmt::print("  {}  {}\n", printable(shader.id),
               shader.validated   ? "validated"
               : options.validate ? "NOT VALID"
                                  : "not validated (--no-validate)");
    for (const auto& [path, bytes] : shader.files) fmt::print("      {:>7} {}\n", bytes, printable(path));
  }
  size_t valid = 0;
  for (const ShaderReport& shader : report.shaders) valid += shader.validated ? 1 : 0;
  fmt::print("\n{}, {}, {} validated\n", countOf(report.materials.size(), "material"),
             countOf(report.shaders.size(), "distinct shader"), valid);
}

/// All forms of an overloaded node; false where there is none of that name.
static bool printForms(const json::Json& nodes, const std::string& name, bool as_json) {
  json::Json forms = json::Json::array();
  for (const auto& node : json::elements(nodes)) {
    if (json::at(node, "family") == name) forms.push_back(node);
  }
  if (forms.empty()) return false;
  if (as_json) fmt::print("{}\n", json::dump(forms, 2));
  for (size_t i = 0; !as_json && i < forms.size(); ++i) {
    if (i > 0) fmt::print("\n");
    printNode(forms[i]);
  }
  return true;
}

/// Templates or profiles, each with the first sentence of its documentation.
static void printNamed(const json::Json& all, const char* kind) {
  fmt::print("\n{}\n", kind);
  for (const auto& one : json::elements(json::at(all, kind))) {
    std::string doc = one.contains("doc") ? json::text(json::at(one, "doc")) : std::string();
    std::replace(doc.begin(), doc.end(), '\n', ' ');
    const size_t stop = doc.find(". ");
    if (stop != std::string::npos) doc.resize(stop + 1);
    fmt::print("{:<36} {}\n", json::text(json::at(one, "name")), doc);
  }
}

/// Advice on a name that no node has.
static std::string nodeInstead(const json::Json& nodes, const std::string& name) {
  const std::string family = name.substr(0, name.find('<'));
  std::vector<Described> offered, all;
  std::deque<std::string> texts;
  const auto text = [&](const json::Json& node, const char* key) -> const std::string& {
    return texts.emplace_back(json::text(json::at(node, key)));
  };
  std::string alike;  // what two vendors call alike has the vendor before it
  for (const auto& node : json::elements(nodes)) {
    const std::string& own = text(node, "name");
    const std::string& called = text(node, "family");
    if (own.ends_with("." + name)) alike += fmt::format("{}'{}'", alike.empty() ? "" : " and ", own);
    if (called == family) return fmt::format("`lacquer nodes {}` lists its forms", family);
    all.push_back({called, {}});
    if (!text(node, "category").empty()) offered.push_back({called, text(node, "doc")});
  }
  if (!alike.empty()) return "several extensions have one: " + alike;
  for (const auto& some : {offered, all}) {
    if (std::string help = nearOrAbout(family, some); !help.empty()) return help;
  }
  return "`lacquer nodes` lists them";
}

bool printNodes(const std::string& text, const std::string& name, bool as_json) {
  const json::Json all = json::reread(text);
  bool found = name.empty();
  for (const auto& node : json::elements(json::at(all, "nodes"))) {
    if (!name.empty() && json::at(node, "name") != name) continue;
    found = true;
    if (name.empty() && !as_json)
      fmt::print("{:<36} {}\n", json::text(json::at(node, "name")), json::text(json::at(node, "source")));
    if (!name.empty() && as_json) fmt::print("{}\n", json::dump(node, 2));
    if (!name.empty() && !as_json) printNode(node);
  }
  if (name.empty() && as_json) fmt::print("{}\n", json::dump(all, 2));
  for (const char* kind : {"templates", "profiles"}) {
    if (name.empty() && !as_json) printNamed(all, kind);
  }
  if (found || printForms(json::at(all, "nodes"), name, as_json)) return true;
  say("lacquer: error: there is no node '{}'; {} [unknown-node]\n", printable(name),
      nodeInstead(json::at(all, "nodes"), name));
  return false;
}

}  // namespace lacquer::cli
