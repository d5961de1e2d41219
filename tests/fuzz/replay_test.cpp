// Every input that a fuzzer has found worth keeping, through the function that it was found with, and each of
// them changed a little, so that the mutations are run by every compiler and sanitizer, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include "mutate.h"
#include "support/packed_walk.h"
#include "targets.h"

namespace lacquer::fuzz {
namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::vector<fs::path> inputsOf(const Target& target) {
  std::vector<fs::path> files;
  const fs::path folder = fs::path(LACQUER_SOURCE_FOLDER) / "tests/fuzz/corpus" / target.corpus;
  for (const auto& file : fs::directory_iterator(folder)) files.push_back(file.path());
  std::sort(files.begin(), files.end());
  return files;
}

class Replay : public testing::TestWithParam<Target> {};

TEST_P(Replay, corpus) {
  const std::vector<fs::path> files = inputsOf(GetParam());
  EXPECT_GE(files.size(), 5U);
  for (const fs::path& file : files) EXPECT_EQ(GetParam().feed(textOf(file)), "") << file;
}

/// Deterministic, and mostly of the form that they are changed in.
TEST_P(Replay, changed) {
  const Form form = GetParam().form;
  if (form == Form::Bytes) return;
  size_t changed = 0;
  const std::vector<fs::path> files = inputsOf(GetParam());
  for (size_t i = 0; i < files.size(); i += 1 + files.size() / 16) {
    const std::string text = textOf(files[i]);
    const std::string once = mutated(text, form, i);
    EXPECT_EQ(once, mutated(text, form, i)) << files[i];
    changed += !once.empty() && once != text ? 1 : 0;
    EXPECT_EQ(GetParam().feed(once), "") << files[i] << " as changed by " << i << ":\n" << once;
    const std::string both = crossed(text, textOf(files[0]), form, i);
    EXPECT_EQ(GetParam().feed(both), "") << files[i] << " crossed by " << i << ":\n" << both;
  }
  EXPECT_GE(changed, 3U);
}

/// A seed of an older version is refused at its head, and the fuzzer finds nothing behind it.
TEST(ReplayPacked, aSeedIsOfThisVersion) {
  const fs::path file = fs::path(LACQUER_SOURCE_FOLDER) / "tests/fuzz/corpus/packed/0";
  EXPECT_NE(test::PackedFile(textOf(file)).top, nullptr);
}

INSTANTIATE_TEST_SUITE_P(Targets, Replay, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& about) {
                           std::string name(about.param.name);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

/// Parts are written from any bytes: these are tried by every compiler.
TEST(Parts, ofRandomBytesHold) {
  const Target* parts = findTarget("parts");
  ASSERT_NE(parts, nullptr);
  std::mt19937 random(1);
  for (int i = 0; i < 250; ++i) {
    std::string bytes(8 + random() % 40, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    EXPECT_EQ(parts->feed(bytes), "") << i;
  }
}

/// Edits are, too.
TEST(Edits, ofRandomBytesHold) {
  const Target* edits = findTarget("edits");
  ASSERT_NE(edits, nullptr);
  std::mt19937 random(2);
  for (int i = 0; i < 400; ++i) {
    std::string bytes(20 + random() % 400, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    ASSERT_EQ(edits->feed(bytes), "") << i;
  }
}

/// The folder holds nothing that no target replays.
TEST(Corpus, everyFolderHasATarget) {
  std::set<std::string> known;
  for (const Target& target : targets()) known.emplace(target.corpus);
  uintmax_t bytes = 0;
  for (const auto& folder : fs::directory_iterator(fs::path(LACQUER_SOURCE_FOLDER) / "tests/fuzz/corpus")) {
    EXPECT_TRUE(known.contains(folder.path().filename().string())) << folder.path();
    for (const auto& file : fs::directory_iterator(folder)) bytes += file.file_size();
  }
  EXPECT_LE(bytes, uintmax_t{1} << 20) << "merge it: ./dev fuzz --merge TARGET";
}

}  // namespace
}  // namespace lacquer::fuzz
