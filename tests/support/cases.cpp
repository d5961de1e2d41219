#include "support/cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSectionMark = "==== ";

std::vector<std::string_view> linesOf(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

struct DiffLine {
  char mark;  ///< ' ', '-' or '+'
  std::string_view text;
};

using Lines = std::vector<std::string_view>;

/// The lines between the common head and tail, as the shortest edit, or as a block where that would cost too
/// much.
void diffMiddle(const Lines& left, const Lines& right, std::vector<DiffLine>& out) {
  constexpr size_t kMostCells = 4'000'000;
  const size_t rows = left.size();
  const size_t columns = right.size();
  if ((rows + 1) * (columns + 1) > kMostCells) {
    for (const auto line : left) out.push_back({'-', line});
    for (const auto line : right) out.push_back({'+', line});
    return;
  }
  // common[i][j]: the most lines that left from i on and right from j on have in common, in order.
  std::vector<std::vector<uint32_t>> common(rows + 1, std::vector<uint32_t>(columns + 1, 0));
  for (size_t i = rows; i-- > 0;) {
    for (size_t j = columns; j-- > 0;) {
      common[i][j] =
          left[i] == right[j] ? common[i + 1][j + 1] + 1 : std::max(common[i + 1][j], common[i][j + 1]);
    }
  }
  size_t i = 0;
  size_t j = 0;
  while (i < rows || j < columns) {
    if (i < rows && j < columns && left[i] == right[j]) {
      out.push_back({' ', left[i]});
      ++i, ++j;
    } else if (i < rows && (j == columns || common[i + 1][j] >= common[i][j + 1])) {
      out.push_back({'-', left[i++]});
    } else {
      out.push_back({'+', right[j++]});
    }
  }
}

std::string testName(const fs::path& relative) {
  std::string name = fs::path(relative).replace_extension().generic_string();
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

class FunctionTest : public testing::Test {
public:
  explicit FunctionTest(std::function<void()> body) : body_(std::move(body)) {}
  void TestBody() override { body_(); }

private:
  std::function<void()> body_;
};

void registerOne(const std::string& suite, const std::string& name, const std::string& file,
                 std::function<void()> body) {
  testing::RegisterTest(suite.c_str(), name.c_str(), nullptr, nullptr, file.c_str(), 1,
                        [body = std::move(body)]() -> testing::Test* { return new FunctionTest(body); });
}

void writeFile(const fs::path& file, std::string_view text) {
  std::error_code ignored;
  fs::create_directories(file.parent_path(), ignored);
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) ADD_FAILURE() << file.string() << " cannot be written";
}

bool readInto(const fs::path& file, std::string& text) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  text = bytes.str();
  return stream.is_open();
}

std::string withNewline(std::string_view text) {
  std::string result(text);
  if (!result.empty() && result.back() != '\n') result += '\n';
  return result;
}

}  // namespace

fs::path sourceFolder() { return LACQUER_SOURCE_FOLDER; }

bool blessing() {
  const char* value = std::getenv("LACQUER_BLESS");
  return value != nullptr && std::string_view(value) == "1";
}

std::string readFile(const fs::path& file) {
  std::string text;
  if (!readInto(file, text)) ADD_FAILURE() << file.string() << " cannot be read";
  return text;
}

void expectFile(const fs::path& file, std::string_view actual) {
  std::string expected;
  const bool there = readInto(file, expected);
  if (there && expected == actual) return;
  if (blessing()) return writeFile(file, actual);
  ADD_FAILURE() << file.string() << (there ? "" : " (which is not there)") << ": expected (-) and got (+):\n"
                << diffLines(expected, actual) << "`./dev bless` writes what the tests get.";
}

std::string diffLines(std::string_view expected, std::string_view actual) {
  if (expected == actual) return {};
  constexpr size_t kContext = 3;
  Lines left = linesOf(expected);
  Lines right = linesOf(actual);
  size_t head = 0;
  while (head < std::min(left.size(), right.size()) && left[head] == right[head]) ++head;
  size_t tail = 0;
  while (tail < std::min(left.size(), right.size()) - head &&
         left[left.size() - 1 - tail] == right[right.size() - 1 - tail]) {
    ++tail;
  }
  std::vector<DiffLine> lines;
  for (size_t i = 0; i < head; ++i) lines.push_back({' ', left[i]});
  const auto middle = [head, tail](const Lines& all) {
    return Lines(all.begin() + static_cast<ptrdiff_t>(head), all.end() - static_cast<ptrdiff_t>(tail));
  };
  diffMiddle(middle(left), middle(right), lines);
  for (size_t i = left.size() - tail; i < left.size(); ++i) lines.push_back({' ', left[i]});

  std::vector<bool> shown(lines.size(), false);
  bool differs = false;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].mark == ' ') continue;
    differs = true;
    for (size_t j = i - std::min(i, kContext); j <= std::min(i + kContext, lines.size() - 1); ++j)
      shown[j] = true;
  }
  if (!differs) return "(only the newline at the end of the file differs)\n";
  std::string text;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (shown[i]) {
      text += lines[i].mark;
      text += ' ';
      text.append(lines[i].text).append("\n");
    } else if (i == 0 || shown[i - 1]) {
      text += "  ...\n";
    }
  }
  return text;
}

Case::Case(fs::path file) : file_(std::move(file)) {
  const std::string text = readFile(file_);
  std::string* part = &input_;
  for (const std::string_view line : linesOf(text)) {
    if (line.starts_with(kSectionMark)) {
      part = &sections_.emplace_back(line.substr(kSectionMark.size()), "").second;
    } else {
      part->append(line).append("\n");
    }
  }
}

bool Case::has(std::string_view section) const {
  return std::any_of(sections_.begin(), sections_.end(), [&](const auto& s) { return s.first == section; });
}

std::string Case::section(std::string_view name) const {
  for (const auto& [section, text] : sections_) {
    if (section == name) return text;
  }
  ADD_FAILURE() << file_.string() << " has no section '" << name << "'";
  return {};
}

void Case::expect(std::string_view section, std::string_view actual) {
  const std::string text = withNewline(actual);
  if (blessing()) {
    const auto found =
        std::find_if(sections_.begin(), sections_.end(), [&](const auto& s) { return s.first == section; });
    if (found != sections_.end() && found->second == text) return;
    if (found == sections_.end()) {
      sections_.emplace_back(section, text);
    } else {
      found->second = text;
    }
    return write();
  }
  const std::string expected = has(section) ? this->section(section) : std::string();
  if (has(section) && expected == text) return;
  ADD_FAILURE() << file_.string() << ": section '" << section << "'"
                << (has(section) ? "" : ", which is not there") << ": expected (-) and got (+):\n"
                << diffLines(expected, text) << "`./dev bless` writes what the tests get.";
}

void Case::write() const {
  std::string text = input_;
  for (const auto& [name, section] : sections_) {
    text.append(kSectionMark).append(name).append("\n").append(section);
  }
  writeFile(file_, text);
}

std::vector<fs::path> findFiles(const fs::path& folder, std::string_view extension) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    if (entry.is_regular_file() && entry.path().filename().string().ends_with(extension)) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end(),
            [](const fs::path& a, const fs::path& b) { return a.generic_string() < b.generic_string(); });
  return files;
}

bool registerFiles(const std::string& suite, const fs::path& folder, std::string_view extension,
                   const std::function<void(const fs::path&)>& body) {
  std::set<std::string> names;
  for (const fs::path& file : findFiles(folder, extension)) {
    const std::string name = testName(file.lexically_relative(folder));
    if (names.insert(name).second) {
      registerOne(suite, name, file.string(), [body, file] { body(file); });
    } else {
      registerOne(suite, name + "_again", file.string(),
                  [file] { ADD_FAILURE() << file.string() << " gives the same test name as another file"; });
    }
  }
  if (names.empty()) {
    registerOne(suite, "no_files", folder.string(), [folder] { ADD_FAILURE() << "no cases in " << folder; });
  }
  return true;
}

bool registerCases(const std::string& suite, const fs::path& folder, std::string_view extension,
                   const std::function<void(Case&)>& body) {
  return registerFiles(suite, folder, extension, [body](const fs::path& file) {
    Case one(file);
    body(one);
  });
}

}  // namespace lacquer::test
