#include "header_cases.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <sstream>

#include "../build/processes.h"

namespace lacquer::test {

namespace {

std::string identifier(std::string text) {
  for (char& c : text) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return text;
}

std::string functionText(const HeaderCase& one, size_t index) {
  const std::string space = "lacquer_shaders::" + identifier(one.id);
  std::string text = fmt::format("static void run{}() {{\n  {}::Parameters p;\n", index, space);
  for (const Member& m : membersOf(one.text)) {
    for (size_t i = 0; i < m.width; ++i) {
      const std::string place = m.width == 1 ? m.name : fmt::format("{}[{}]", m.name, i);
      text += fmt::format("  p.{} = next(){};\n", place, m.boolean ? " != 0" : "");
    }
  }
  text += fmt::format("  unsigned char bytes[{}::kBlockSize + 1];\n  bytes[{}::kBlockSize] = 0x5a;\n", space,
                      space);
  text += fmt::format(
      "  (void){0}::outside(p);\n  {0}::pack(p, bytes);\n  show(bytes, {0}::kBlockSize);\n}}\n", space);
  return text;
}

std::string programText(const std::vector<HeaderCase>& cases) {
  std::string text;
  for (const HeaderCase& one : cases) text += fmt::format("#include \"{0}.h\"\n#include \"{0}.h\"\n", one.id);
  text +=
      "#include <cstdio>\n#include <cstdlib>\n"
      "inline double next() { double x = 0; if (std::scanf(\"%lf\", &x) != 1) std::exit(3); return x; }\n"
      "static void show(const unsigned char* bytes, std::size_t size) {\n"
      "  for (std::size_t i = 0; i < size; ++i) std::printf(\"%02x\", static_cast<unsigned>(bytes[i]));\n"
      "  std::printf(bytes[size] == 0x5a ? \"\\n\" : \" written too far\\n\");\n}\n";
  for (size_t i = 0; i < cases.size(); ++i) text += functionText(cases[i], i);
  text +=
      "int main() {\n  int which = 0;\n  while (std::scanf(\"%d\", &which) == 1) {\n    switch (which) {\n";
  for (size_t i = 0; i < cases.size(); ++i) text += fmt::format("      case {0}: run{0}(); break;\n", i);
  return text + "      default: return 4;\n    }\n  }\n  return 0;\n}\n";
}

std::string inputText(const std::vector<HeaderCase>& cases) {
  std::string text;
  for (size_t i = 0; i < cases.size(); ++i) {
    const std::vector<Member> members = membersOf(cases[i].text);
    for (const Numbers& row : cases[i].rows) {
      text += std::to_string(i);
      for (const Member& m : members) {
        for (size_t c = 0; c < m.width; ++c) text += fmt::format(" {:a}", row.at(m.name).at(c));
      }
      text += '\n';
    }
  }
  return text;
}

}  // namespace

std::vector<Member> membersOf(const std::string& header) {
  const size_t begin = header.find("struct Parameters {");
  const std::string body = header.substr(begin, header.find("\n};\n", begin) - begin);
  std::vector<Member> members;
  std::istringstream lines(body);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string type, name, equals;
    words >> type >> name >> equals;
    if ((type != "double" && type != "bool") || equals != "=") continue;
    const size_t bracket = name.find('[');
    const bool array = bracket != std::string::npos;
    members.push_back({name.substr(0, bracket), array ? static_cast<size_t>(name.at(bracket + 1) - '0') : 1,
                       type == "bool"});
  }
  return members;
}

std::vector<std::vector<std::string>> packedByCompiler(const std::vector<HeaderCase>& cases) {
  const auto folder = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
  for (const HeaderCase& one : cases) writeText(folder / (one.id + ".h"), one.text);
  writeText(folder / "main.cpp", programText(cases));
  writeText(folder / "numbers", inputText(cases));
  std::string said;
  const int compiled =
      runProgram({LACQUER_COMPILER, "-std=c++11", "-O1", "-ffp-contract=off", "-Wall", "-Wextra",
                  "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror", "main.cpp", "-o", "main"},
                 folder, &said);
  EXPECT_EQ(compiled, 0) << said.substr(0, 4000);
  if (compiled != 0) return {};
  const int ran = runProgram({"sh", "-c", "./main < numbers"}, folder, &said);
  EXPECT_EQ(ran, 0) << said.substr(0, 1000);
  if (ran != 0) return {};
  std::istringstream lines(said);
  std::vector<std::vector<std::string>> all;
  for (const HeaderCase& one : cases) {
    all.emplace_back();
    for (size_t row = 0; row < one.rows.size(); ++row) {
      std::string line;
      std::getline(lines, line);
      all.back().push_back(line);
    }
  }
  std::filesystem::remove_all(folder.parent_path());
  return all;
}

}  // namespace lacquer::test
