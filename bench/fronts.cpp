#include "bench/fronts.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bench/page.h"
#include "lacquer.h"
#include "lang/library.h"
#include "support/file.h"

namespace lacquer::bench {

namespace {

using Json = nlohmann::ordered_json;

const std::string kRoot = LACQUER_SOURCE_FOLDER;
constexpr double kCheap = 10;  // cycles at which nobody looks for a cheaper form

/// The variants that were written by hand, as bench/error.json has them.
std::string byHand(const Json& measured, const std::string& node) {
  std::string text;
  if (!measured.contains(node)) return text;
  for (const auto& [name, body] : measured[node].items()) {
    if (name == "reference" || !body.contains("e2") || !body.contains("alone")) continue;
    const uint64_t of = measured[node]["reference"]["alone"]["inverse_throughput"].get<uint64_t>();
    text += fmt::format("{}`{}` {} of {} at {}", text.empty() ? "" : ", ", name,
                        body["alone"]["inverse_throughput"].get<uint64_t>(), of,
                        body["e2"]["absolute"]["max"].get<std::string>());
  }
  return text;
}

std::string found(const Tuned& tuned) {
  std::string text;
  for (const TunedForm& form : tuned.forms) {
    if (form.cycles >= tuned.plain) continue;
    text += text.empty() ? "" : ", ";
    text += form.error > 0 ? fmt::format("{} at {:.2g}", form.cycles, form.error)
                           : fmt::format("{} exactly", form.cycles);
  }
  return text;
}

}  // namespace

int runFronts() {
  const Result<std::string> read = readFile(kRoot + "/bench/error.json");
  if (!read) {
    fmt::print(stderr, "bench fronts: bench/error.json is not there: ./dev bench error makes it\n");
    return 1;
  }
  const Json measured = Json::parse(*read)["nodes"];
  const lang::Library library = lang::Library::embedded();
  std::string rows, others;
  size_t count = 0;
  for (const std::string_view name : library.names(lang::DeclKind::Node)) {
    const auto node = library.node(name);
    if (!node || (*node)->origin.file.starts_with("nodes/standard/")) continue;
    Messages messages;
    const std::optional<Tuned> tuned = tune(std::string(name), {}, messages);
    if (!tuned || tuned->plain <= kCheap) continue;
    ++count;
    fmt::print(stderr, "{}\n", name);
    const std::string forms = found(*tuned);
    const std::string hand = byHand(measured, std::string(name));
    if (forms.empty() && hand.empty())
      others += fmt::format("{}`{}` {}", others.empty() ? "" : ", ", name, tuned->plain);
    else
      rows += fmt::format("| `{}` | {} | {} | {} |\n", name, tuned->plain, forms, hand);
  }
  const std::string text = fmt::format(
      "{} nodes.\n\n| node | as it is | found | by hand |\n|---|---|---|---|\n{}\nNothing cheaper was found "
      "of, with their "
      "cycles: {}.\n",
      count, rows, others);
  fmt::print("{}", text);
  if (renewPage(kRoot + "/docs/error.md", text, "fronts")) return 0;
  fmt::print(stderr, "bench fronts: docs/error.md could not be renewed\n");
  return 1;
}

}  // namespace lacquer::bench
