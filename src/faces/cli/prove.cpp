#include "cli/prove.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/streams.h"
#include "cli/table.h"
#include "json/json.h"

namespace lacquer::cli {

namespace {

using json::Json;

/// A member that is a text, as a terminal may show it: names come from the file.
std::string textOf(const Json& json, const char* key) { return printable(json[key].get<std::string>()); }

std::string rangeText(const Json& range) {
  const auto end = [](const Json& x) {
    return x.is_string() ? x.get<std::string>() : fmt::format("{:.7g}", x.get<double>());
  };
  return fmt::format("[{}, {}]{}", end(range[0]), end(range[1]), range.size() > 2 ? " or no number" : "");
}

void printClaims(const Json& claims, const std::string& where) {
  for (const Json& claim : claims) {
    if (claim["proved"].get<bool>()) continue;
    fmt::print("  {}{}: must be {}, may be {}\n", where, textOf(claim, "what"), textOf(claim, "need"),
               rangeText(claim["reached"]));
  }
}

size_t proved(const Json& claims) {
  return static_cast<size_t>(
      std::count_if(claims.begin(), claims.end(), [](const Json& c) { return c["proved"].get<bool>(); }));
}

void printShader(const Json& json) {
  const Json& operations = json["operations"];
  size_t safe = 0;
  for (const Json& row : operations) safe += row["safe"].get<bool>() ? 1 : 0;
  const Json& contracts = json["contracts"];
  fmt::print("{} ({}): {} of {} operations safe, {} of {} arguments within their nodes' contracts\n",
             textOf(json, "material"), textOf(json, "shader"), safe, operations.size(), proved(contracts),
             contracts.size());
  for (const Json& row : operations) {
    if (row["safe"].get<bool>()) continue;
    fmt::print("  {}{}: {} of {}: must be {}, may be {}\n", textOf(row, "term"),
               row.contains("name") ? "." + textOf(row, "name") : "", textOf(row, "operation"),
               textOf(row, "operand"), textOf(row, "need"), rangeText(row["reached"]));
  }
  printClaims(contracts, "argument ");
  for (const Json& output : json["outputs"]) {
    fmt::print("  output {} is in {}\n", textOf(output, "name"), rangeText(output["reached"]));
  }
}

bool proveNodes(const ProveFlags& flags, const Options& options, Messages& messages) {
  const std::string text = proveNodesJson(options, messages, flags.precision);
  if (text.empty()) return false;
  const Json json = json::reread(text);
  size_t good = 0;
  size_t all = 0;
  for (const Json& node : json["nodes"]) {
    for (const char* kind : {"operations", "results", "calls"}) {
      good += proved(node[kind]);
      all += node[kind].size();
      const std::string variant = node.contains("variant") ? "." + textOf(node, "variant") : "";
      if (!flags.json) printClaims(node[kind], textOf(node, "name") + variant + ", ");
    }
  }
  if (flags.json)
    fmt::print("{}\n", text);
  else
    fmt::print("{} nodes: {} of {} claims proved\n", json["nodes"].size(), good, all);
  return good == all;
}

bool proveGraph(Graph graph, const ProveFlags& flags, const Options& options, Messages& messages) {
  const std::string text = graph ? graph.prove(options, messages, flags.precision) : std::string();
  if (text.empty()) return false;
  if (flags.json)
    fmt::print("{}\n", text);
  else
    printShader(json::reread(text));
  return true;
}

bool proveMaterial(const Scene& scene, size_t material, const ProveFlags& flags, const Options& options,
                   Messages& messages) {
  std::vector<Attributes> uses = scene.uses(material);
  if (uses.empty()) uses.push_back(kUnusedAttributes);
  bool good = true;
  for (const Attributes& attributes : uses) {
    good &= proveGraph(scene.graph(material, attributes, options, messages), flags, options, messages);
  }
  return good;
}

}  // namespace

bool prove(const std::vector<std::string>& files, const std::vector<std::string>& materials,
           const ProveFlags& flags, const Options& options, Messages& messages) {
  if (files.empty()) return proveNodes(flags, options, messages);
  bool good = true;
  size_t found = 0;
  for (const std::string& file : files) {
    if (isGraphFile(file)) {
      ++found;
      good &= proveGraph(Graph::load(file, options, messages), flags, options, messages);
      continue;
    }
    const Scene scene = Scene::load(file, options, messages);
    good &= static_cast<bool>(scene);
    for (size_t i = 0; scene && i < scene.materialCount(); ++i) {
      const bool named =
          std::find(materials.begin(), materials.end(), scene.materialName(i)) != materials.end();
      if (!materials.empty() && !named) continue;
      ++found;
      good &= proveMaterial(scene, i, flags, options, messages);
    }
  }
  if (found == 0 && good) {
    say("{}: error: no material of that name [no-such-material]\n", printable(files[0]));
    return false;
  }
  return good;
}

}  // namespace lacquer::cli
