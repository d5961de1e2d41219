// Tests that are files: a folder of small cases, each with its input and its expectations together.
//
// A case file is the input, then sections, each begun by a line `==== NAME`:
//
//     node twice(float a) -> float { return a + ; }
//     ==== errors
//     twice.node:1:43: error: expected an expression [syntax]
//
// A test program registers a folder of them, one GoogleTest test per file:
//
//     static const bool kRegistered = registerCases("Lang", sourceFolder() / "tests/lang", ".case", [](Case&
//     c) {
//       c.expect("errors", errorsOf(c.input()));
//     });
//
// A test's name is the file's path below the folder without its extension, every byte that is not a letter or
// a digit becoming `_`: `tests/lang/errors/no-body.case` is `Lang.errors_no_body`. With LACQUER_BLESS=1 in
// the environment, what the tests got is written into the files instead of being compared; `git diff` shows
// the rest.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacquer::test {

/// The root of the source tree.
std::filesystem::path sourceFolder();

/// True when expectations are to be rewritten: LACQUER_BLESS=1.
bool blessing();

/// All bytes of a file; a test failure and an empty text when it cannot be read.
std::string readFile(const std::filesystem::path& file);

/// Fails the test unless `actual` is what the file holds, and shows the difference by line.
/// When blessing, writes the file (and its folder) if it differs.
void expectFile(const std::filesystem::path& file, std::string_view actual);

/// The lines of both texts, `-` before those only in `expected` and `+` before those only in `actual`, with
/// three lines of context around each difference. Empty when the texts are equal.
std::string diffLines(std::string_view expected, std::string_view actual);

/// One case file.
class Case {
public:
  explicit Case(std::filesystem::path file);

  const std::filesystem::path& file() const { return file_; }

  /// The text above the first section.
  const std::string& input() const { return input_; }

  bool has(std::string_view section) const;

  /// The text of a section; a test failure and an empty text when there is none.
  std::string section(std::string_view name) const;

  /// Fails the test unless `actual` is the text of the section, give or take a newline at the end.
  /// When blessing, rewrites the section, or adds it.
  void expect(std::string_view section, std::string_view actual);

private:
  void write() const;

  std::filesystem::path file_;
  std::string input_;
  std::vector<std::pair<std::string, std::string>> sections_;  ///< in the file's order
};

/// The files below `folder` whose names end in `extension`, sorted by path.
std::vector<std::filesystem::path> findFiles(const std::filesystem::path& folder, std::string_view extension);

/// Registers one test per file of `findFiles`, before main() or in it. A folder without such files registers
/// a test that fails. Two files that would get the same name do, too. Always true, to initialize a static
/// with.
bool registerFiles(const std::string& suite, const std::filesystem::path& folder, std::string_view extension,
                   const std::function<void(const std::filesystem::path&)>& body);

/// The same for case files.
bool registerCases(const std::string& suite, const std::filesystem::path& folder, std::string_view extension,
                   const std::function<void(Case&)>& body);

}  // namespace lacquer::test
