// The lines that parts may read, replace or follow, as docs/lines.md lists them.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <lacquer.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "docs/tables.h"

namespace lacquer::test {

static std::string lineTypes(const nlohmann::json& line) {
  if (line.contains("type")) return line["type"].get<std::string>();
  std::string types;
  for (const nlohmann::json& output : line.value("outputs", nlohmann::json::array()))
    types += fmt::format("{}{} `.{}`", types.empty() ? "" : ", ", output["type"].get<std::string>(),
                         output["name"].get<std::string>());
  return types;
}

std::string linesTable() {
  Messages messages;
  const nlohmann::json all = nlohmann::json::parse(nodesJson({}, messages));
  std::map<std::string, std::string> docs;
  for (const nlohmann::json& part : all["parts"]) docs[part["name"]] = part["doc"];
  std::vector<std::string> order;
  std::map<std::string, std::string> tables;
  std::string below;
  for (const nlohmann::json& line : all["lines"]) {
    if (line.contains("below")) {
      below += fmt::format("| `{}` | {} |\n", line["name"].get<std::string>(), lineTypes(line));
      continue;
    }
    const std::string part = line.contains("part") ? line["part"] : line["profile"];
    if (!tables.contains(part)) order.push_back(part);
    std::string meaning = line.value("meaning", "");
    std::replace(meaning.begin(), meaning.end(), '\n', ' ');
    tables[part] += fmt::format("| `{}` | {} | {}{} |\n", line["name"].get<std::string>(), lineTypes(line),
                                meaning, line.contains("light") ? " (light of a lamp)" : "");
  }
  std::string out;
  for (const std::string& part : order) {
    std::string doc = docs[part];
    std::replace(doc.begin(), doc.end(), '\n', ' ');
    out += fmt::format("\n## {}\n\n{}\n\n| line | type | |\n|---|---|---|\n{}", part, doc, tables[part]);
  }
  return out + "\n## What lies below\n\n| name | type |\n|---|---|\n" + below;
}

}  // namespace lacquer::test
