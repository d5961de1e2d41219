#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <spirv-tools/libspirv.hpp>

#include "docs/page.h"
#include "docs/sample.h"
#include "docs/tables.h"
#include "support/cases.h"

namespace lacquer::test {

namespace {

std::string fenced(std::string_view language, std::string_view text) {
  return fmt::format("```{}\n{}```\n", language, text);
}

/// "a, b c" is "a, b" and "c".
std::pair<std::string, std::string> lastWord(std::string_view text) {
  const size_t blank = text.rfind(' ');
  if (blank == std::string_view::npos) return {std::string(text), {}};
  return {std::string(text.substr(0, blank)), std::string(text.substr(blank + 1))};
}

/// The lines from one that begins with `first` (after blanks) up to an empty one, a brace or another comment.
std::vector<std::string> section(std::string_view text, const std::string& first) {
  std::vector<std::string> found;
  for (const std::string& line : split(text, "\n")) {
    const std::string bare = line.substr(std::min(line.find_first_not_of(' '), line.size()));
    if (found.empty() && !bare.starts_with(first)) continue;
    if (!found.empty() && (bare.empty() || bare == "}")) break;
    found.push_back(line);
  }
  if (found.empty()) ADD_FAILURE() << "the example's shader has no section " << first;
  return found;
}

}  // namespace

std::string glslSections(std::string_view of) {
  std::string out;
  for (const std::string& term : split(of, " ")) {
    if (!out.empty()) out += "\n";
    out += dedented(section(readmeExample().shader.fragmentText(Target::Glsl), "// " + term + ":"));
  }
  return fenced("glsl", out);
}

std::string dustyPart(std::string_view of) {
  const Made& made = dustyExample();
  if (of == "field") {
    for (const Json& block : made.interface["uniforms"]) {
      std::string rows;
      for (const char* list : {"values", "fields"}) {
        for (const Json& row : block.value(list, Json::array())) {
          const bool dusty = row.value("expression", "").find("dust_amount") != std::string::npos;
          if (dusty || row["name"] == "coat_dust") rows += row.dump() + "\n";
        }
      }
      if (!rows.empty()) return fenced("text", rows);
    }
  }
  const std::string& text = made.shader.fragmentText(Target::Glsl);
  const std::string term = "// coat_dust:";
  const size_t second = text.find(term, std::min(text.find(term), text.size() - 1) + 1);
  if (of != "field" && second != std::string::npos) {
    // A section may begin behind blanks: take its line whole.
    const size_t line = text.rfind('\n', second) + 1;
    return fenced("glsl", dedented(section(of == "pixel" ? text : text.substr(line), term)));
  }
  ADD_FAILURE() << "the dust does not come apart by rate";
  return {};
}

std::string vertexMain() {
  const std::string& text = readmeExample().shader.vertexText(Target::Glsl);
  return fenced("glsl", text.substr(std::min(text.find("void main"), text.size())));
}

std::string dumpSection(std::string_view of) {
  const auto [pass, term] = lastWord(of);
  Options options;
  Messages messages;
  Graph graph = make(readmeGltf(), options).graph;
  std::string out;
  bool inside = false;
  for (const std::string& line : split(graph.dump(options, pass, messages), "\n")) {
    if (line.starts_with(";")) inside = line.starts_with("; " + term + ":");
    if (line.starts_with("preshader") || line.find(" output ") != std::string::npos) inside = false;
    if (inside) out += line + "\n";
  }
  if (out.empty()) ADD_FAILURE() << "after " << pass << " there is no " << term;
  return fenced("text", out);
}

std::string graphNode(std::string_view of) {
  const std::string text = readmeExample().graph.toJson();
  const size_t at = text.find(fmt::format("      \"id\": \"{}\"", of));
  const size_t end = text.find("\n    }", std::min(at, text.size()));
  if (at == std::string::npos || end == std::string::npos) {
    ADD_FAILURE() << "the example has no node " << of;
    return {};
  }
  const std::string node = "    {\n" + text.substr(at, end - at) + "\n    }\n";
  return fenced("text", dedented(split(node, "\n")));
}

std::string spirvLines(std::string_view of) {
  const auto [instruction, number] = lastWord(of);
  const size_t count = std::stoul(number);
  std::string text;
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_1);
  tools.Disassemble(readmeExample().shader.fragmentSpirv(), &text,
                    SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES | SPV_BINARY_TO_TEXT_OPTION_NO_HEADER);
  const std::vector<std::string> lines = split(text, "\n");
  for (size_t i = count; i < lines.size(); ++i) {
    const bool found = lines[i].find("%v3float") != std::string::npos &&
                       lines[i].find(" " + instruction + " ") != std::string::npos;
    if (!found) continue;
    std::string out;
    for (size_t k = i + 1 - count; k <= i; ++k)
      out += lines[k].substr(lines[k].find_first_not_of(' ')) + "\n";
    return fenced("text", out);
  }
  ADD_FAILURE() << "the example's SPIR-V has no " << instruction;
  return {};
}

std::string sourceLines(std::string_view of) {
  const size_t blank = of.find(' ');
  const std::string file(of.substr(0, blank));
  if (blank == std::string_view::npos) return fenced("node", readFile(sourceFolder() / file));
  const std::string first(of.substr(blank + 1));
  std::vector<std::string> found;
  for (const std::string& line : split(readFile(sourceFolder() / file), "\n")) {
    if (found.empty() && !line.starts_with(first)) continue;
    found.push_back(line);
    if (line == "}" || line == "};") break;
  }
  if (found.empty()) ADD_FAILURE() << file << " has no line that begins with " << first;
  return fenced(file.ends_with(".cpp") ? "cpp" : "glsl", dedented(found));
}

}  // namespace lacquer::test
