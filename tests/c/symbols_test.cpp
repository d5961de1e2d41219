// The shared library exports what the headers declare, and nothing else.
#include <cxxabi.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "support/cases.h"

namespace lacquer::test::symbols_test {
namespace {

std::set<std::string> exported() {
  std::set<std::string> names;
  const std::string command = "nm -D --defined-only '" LACQUER_SHARED_FILE "'";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return names;
  std::string text;
  char block[4096];
  while (const size_t got = std::fread(block, 1, sizeof block, pipe)) text.append(block, got);
  EXPECT_EQ(::pclose(pipe), 0);
  std::istringstream lines(text);
  for (std::string address, kind, name; lines >> address >> kind >> name;) names.insert(name);
  return names;
}

std::set<std::string> declaredInC() {
  const std::string text = readFile(sourceFolder() / "src/lacquer_c.h");
  const std::regex declaration("\nLACQUER_C(?:_NATIVE)? [^(;]*?(lacquer_[a-z0-9_]+)\\(");
  std::set<std::string> names;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), declaration); it != std::sregex_iterator();
       ++it)
    names.insert((*it)[1]);
  return names;
}

std::set<std::string> listedForCpp() {
  std::istringstream lines(readFile(sourceFolder() / "cmake/exports.txt"));
  std::set<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] != '#') names.insert("lacquer::" + line.substr(0, line.find(' ')));
  }
  return names;
}

/// "lacquer::Scene::load", or the name as it is where it is none of C++.
std::string plainName(const std::string& name) {
  int status = 0;
  char* text = abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status);
  std::string plain = text == nullptr ? name : text;
  std::free(text);
  const size_t end = plain.find_first_of("([");
  return plain.substr(0, end);
}

TEST(Symbols, areThoseOfTheHeadersAndNoOthers) {
  std::set<std::string> of_c, of_cpp;
  for (const std::string& name : exported())
    (name.starts_with("_Z") ? of_cpp : of_c).insert(name.starts_with("_Z") ? plainName(name) : name);
  EXPECT_EQ(of_c, declaredInC());
  EXPECT_EQ(of_cpp, listedForCpp());
  EXPECT_GT(of_c.size(), 40u);
}

/// Functions of the C++ headers that the library has, without their classes.
std::set<std::string> declaredInCpp() {
  const std::regex declaration(
      R"(^(?:  )?(?:static )?(?!friend |return |explicit )[A-Za-z][\w:<>, ]* [&*]?([a-z]\w+)\()");
  std::set<std::string> names;
  for (const auto& header : std::filesystem::directory_iterator(sourceFolder() / "src/lacquer")) {
    if (header.path().filename() == "vulkan.h") continue;  // a header alone: all of it is inline
    std::istringstream lines(readFile(header.path()));
    for (std::string line; std::getline(lines, line);) {
      std::smatch match;
      if (std::regex_search(line, match, declaration)) names.insert(match[1]);
    }
  }
  return names;
}

TEST(Symbols, everyFunctionOfTheCppHeadersIsListed) {
  std::set<std::string> listed;
  for (const std::string& name : listedForCpp()) listed.insert(name.substr(name.rfind(':') + 1));
  const std::set<std::string> declared = declaredInCpp();
  EXPECT_GT(declared.size(), 50u);
  for (const std::string& name : declared) EXPECT_TRUE(listed.contains(name)) << name;
}

}  // namespace
}  // namespace lacquer::test::symbols_test
