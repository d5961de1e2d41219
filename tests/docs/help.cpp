// What the program says of its own options.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "docs/page.h"
#include "docs/tables.h"

namespace lacquer::test {

namespace {

struct HelpRow {
  std::string flags, argument, meaning;
  bool operator==(const HelpRow&) const = default;
};

std::string helpOf(const std::string& verb) {
  static std::map<std::string, std::string> kept;
  const auto [it, fresh] = kept.emplace(verb, "");
  if (!fresh) return it->second;
#ifdef _WIN32
  FILE* pipe = _popen(fmt::format("\"\"{}\" {} --help\"", LACQUER_PROGRAM, verb).c_str(), "r");
#else
  FILE* pipe = popen(fmt::format("'{}' {} --help", LACQUER_PROGRAM, verb).c_str(), "r");
#endif
  if (pipe == nullptr) return {};
  char buffer[4096];
  for (size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) it->second.append(buffer, n);
#ifdef _WIN32
  const int status = _pclose(pipe);
#else
  const int status = pclose(pipe);
#endif
  EXPECT_EQ(status, 0) << verb << " --help";
  return it->second;
}

/// "--target TEXT ..." is its flags and its argument.
HelpRow rowOf(const std::string& left) {
  const std::string bare = left.substr(left.find_first_not_of(' '));
  const size_t blank = std::min(bare.find(' '), bare.size());
  HelpRow row{bare.substr(0, blank), bare.substr(std::min(blank + 1, bare.size())), {}};
  row.argument = row.argument.substr(0, row.argument.find(" Excludes:"));
  const size_t comma = row.flags.find(',');
  if (comma != std::string::npos)
    row.flags = row.flags.substr(0, comma) + "`, `" + row.flags.substr(comma + 1);
  return row;
}

bool isEverywhere(const HelpRow& row) {
  return row.flags.find("--help") != std::string::npos || row.flags == "--version";
}

/// The rows below "Positionals:" and "Options:": flags to the left, the meaning from column 30 on or on the
/// next line.
std::vector<HelpRow> rowsOf(const std::string& verb) {
  constexpr size_t kColumn = 30;
  std::vector<HelpRow> rows;
  bool inside = false;
  for (const std::string& line : split(helpOf(verb), "\n")) {
    if (line.empty() || line[0] != ' ') {
      inside = line == "Positionals:" || line == "Options:";
      continue;
    }
    if (!inside) continue;
    const size_t first = line.find_first_not_of(' ');
    if (first >= kColumn && !rows.empty()) {
      rows.back().meaning = line.substr(first);
      continue;
    }
    const size_t gap = line.find("  ", first);
    rows.push_back(rowOf(line.substr(0, gap)));
    if (gap != std::string::npos) rows.back().meaning = line.substr(line.find_first_not_of(' ', gap));
  }
  rows.erase(std::remove_if(rows.begin(), rows.end(), isEverywhere), rows.end());
  return rows;
}

std::vector<HelpRow> common(const std::vector<HelpRow>& a, const std::vector<HelpRow>& b) {
  std::vector<HelpRow> both;
  std::copy_if(a.begin(), a.end(), std::back_inserter(both),
               [&](const HelpRow& row) { return std::find(b.begin(), b.end(), row) != b.end(); });
  return both;
}

std::vector<HelpRow> without(const std::vector<HelpRow>& a, const std::vector<HelpRow>& b) {
  std::vector<HelpRow> rest;
  std::copy_if(a.begin(), a.end(), std::back_inserter(rest),
               [&](const HelpRow& row) { return std::find(b.begin(), b.end(), row) == b.end(); });
  return rest;
}

std::vector<HelpRow> sharedRows() { return common(common(rowsOf("gen"), rowsOf("graph")), rowsOf("dump")); }

/// Whether a verb has all options that several share, or others of their names.
bool takesShared(const std::vector<HelpRow>& rows) {
  const std::vector<HelpRow> shared = sharedRows();
  return std::all_of(shared.begin(), shared.end(), [&](const HelpRow& row) {
    return std::any_of(rows.begin(), rows.end(), [&](const HelpRow& own) { return own.flags == row.flags; });
  });
}

/// What the program's help has of its verbs.
std::vector<HelpRow> verbRows() {
  std::vector<HelpRow> rows;
  bool inside = false;
  for (const std::string& line : split(helpOf(""), "\n")) {
    if (inside && line.starts_with("  ")) rows.push_back(rowOf(line));
    inside |= line == "Subcommands:";
  }
  return rows;
}

}  // namespace

std::string optionsTable(std::string_view of) {
  const std::vector<HelpRow> shared = sharedRows();
  const std::vector<HelpRow> generation = without(common(rowsOf("gen"), rowsOf("plan")), shared);
  const std::vector<HelpRow> all = rowsOf(of == "shared" || of == "generation" ? "gen" : std::string(of));
  // What stands in the tables above.
  std::vector<HelpRow> known;
  if (of != "gen" && of != "plan") known = common(all, generation);
  if (!takesShared(all)) {
    const std::vector<HelpRow> some = common(all, shared);
    known.insert(known.end(), some.begin(), some.end());
  }
  for (const HelpRow& row : without(without(rowsOf("eval"), shared), known)) {
    const bool trial = of != "eval" && row.flags.starts_with("--") && row.flags != "--material";
    if (trial && std::find(all.begin(), all.end(), row) != all.end()) known.push_back(row);
  }
  std::vector<HelpRow> rows = without(without(without(all, shared), generation), known);
  if (of == "shared") rows = shared;
  if (of == "generation") rows = generation;
  if (rows.empty()) ADD_FAILURE() << of << " has no options of its own";
  std::string out = "| option | argument | meaning |\n|---|---|---|\n";
  for (const HelpRow& row : rows) {
    out += fmt::format("| `{}` | {} | {} |\n", row.flags, row.argument, row.meaning);
  }
  if (known.empty() || of == "shared" || of == "generation") return out;
  std::string flags;
  for (const HelpRow& row : known) flags += (flags.empty() ? "`" : "`, `") + row.flags;
  return out + fmt::format("| {}` | | as above |\n", flags);
}

std::string takersLine() {
  std::vector<std::string> verbs;
  for (const HelpRow& row : verbRows()) {
    if (takesShared(rowsOf(row.flags))) verbs.push_back(fmt::format("`{}`", row.flags));
  }
  if (verbs.size() < 2) return {};
  const std::string last = verbs.back();
  verbs.pop_back();
  return fmt::format("Every verb that looks at a material takes them: {} and {}.\n", fmt::join(verbs, ", "),
                     last);
}

std::string verbsTable() {
  std::string out = "| verb | what it gives |\n|---|---|\n";
  for (const HelpRow& row : verbRows()) {
    out += fmt::format("| [`{0}`](#{0}) | {1} |\n", row.flags,
                       row.argument.substr(row.argument.find_first_not_of(' ')));
  }
  return out;
}

}  // namespace lacquer::test
