#include "bench/fronts.h"

#include <fmt/format.h>

#include "bench/page.h"
#include "lacquer.h"
#include "lang/library.h"

namespace lacquer::bench {

namespace {

const std::string kRoot = LACQUER_SOURCE_FOLDER;
constexpr double kCheap = 10;   // cycles at which nobody looks for a cheaper form
constexpr double kWorth = 0.8;  // a form that has more of the cycles is not listed

std::string found(const Tuned& tuned) {
  std::string text;
  for (const TunedForm& form : tuned.forms) {
    if (form.cycles > kWorth * tuned.plain) continue;
    text += text.empty() ? "" : ", ";
    text += form.error > 0 ? fmt::format("{} at {:.2g}", form.cycles, form.error)
                           : fmt::format("{} exactly", form.cycles);
  }
  return text;
}

}  // namespace

int runFronts() {
  const lang::Library library = lang::Library::embedded();
  std::string rows;
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
    if (!forms.empty()) rows += fmt::format("| `{}` | {} | {} |\n", name, tuned->plain, forms);
  }
  const std::string text = fmt::format(
      "Of {} nodes, those of which a form saves a fifth:\n\n| node | as it is | found |\n|---|---|---|\n{}",
      count, rows);
  fmt::print("{}", text);
  if (renewPage(kRoot + "/docs/error.md", text, "fronts")) return 0;
  fmt::print(stderr, "bench fronts: docs/error.md could not be renewed\n");
  return 1;
}

}  // namespace lacquer::bench
