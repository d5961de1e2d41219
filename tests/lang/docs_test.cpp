// The examples of the language reference are checked like any library.
#include <gtest/gtest.h>

#include "lang/builtins.h"
#include "lang/library.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

/// Each block becomes a file of its own, preceded by empty lines so that its lines are numbered as in the
/// document.
std::vector<lang::SourceFile> fencedBlocks(const std::string& name, const std::string& text) {
  std::vector<lang::SourceFile> files;
  std::string skipped;
  bool inside = false;
  size_t at = 0;
  while (at < text.size()) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    if (!inside && line == "```node") {
      inside = true;
      files.push_back({name, skipped + "\n"});
    } else if (inside && line == "```") {
      inside = false;
    } else if (inside) {
      files.back().text += line + "\n";
    }
    skipped += "\n";
  }
  return files;
}

TEST(LangDocs, ExamplesCheck) {
  const auto file = sourceFolder() / "docs/node-language.md";
  const std::vector<lang::SourceFile> blocks = fencedBlocks("docs/node-language.md", readFile(file));
  ASSERT_GE(blocks.size(), 5U);
  const auto library = lang::Library::fromFiles(blocks);
  ASSERT_TRUE(library) << format(library.error()[0]);
  for (const Diagnostic& diagnostic : library->checkAll()) ADD_FAILURE() << format(diagnostic);
}

TEST(LangDocs, EveryBuiltinIsListed) {
  const std::string text = readFile(sourceFolder() / "docs/node-language.md");
  for (const lang::Builtin& builtin : lang::builtins()) {
    const std::string name(builtin.name);
    const bool listed = builtin.is_operator ? text.find("`" + name + "`") != std::string::npos
                                            : text.find("`" + name + "(") != std::string::npos;
    EXPECT_TRUE(listed) << name;
  }
}

}  // namespace
}  // namespace lacquer::test
