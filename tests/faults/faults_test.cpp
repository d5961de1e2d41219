// Every allocation, every call for a file and every start of a thread fails once, in turn, over a run that
// renews an output folder; and the program is killed at each of these places. Afterwards every output is the
// old file or the new one, whole, and the next run delivers what a run without a fault does.
//
// A step of the suite tries some of the places, evenly spread. LACQUER_FAULTS_ALL=1 tries all of them; =K
// every Kth; =K+N every Kth behind the Nth; =code, of the allocations, the first from each place in the code,
// and all of the rest.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "build/processes.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Two materials whose shaders differ, and that differ from the file before.
std::string materials(const char* before_or_after) {
  return fmt::format(R"({{"asset": {{"version": "2.0"}}, "materials": [
    {{"name": "{0}", "emissiveFactor": [0.5, 0, 0]}},
    {{"name": "two", "alphaMode": "MASK"{1}}}]}})",
                     before_or_after,
                     std::string_view(before_or_after) == "after" ? R"(, "doubleSided": true)" : "");
}

/// A run with or without a cache and with one thread or several, and what it starts from.
struct Variety {
  bool cache = false;
  int jobs = 1;
};

class Faults : public testing::Test {
protected:
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  void SetUp() override { GTEST_SKIP() << "a sanitizer's allocator cannot be stood before"; }
#else
  void SetUp() override {
    root_ = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directory(root_ / "start");
    writeText(root_ / "start/a.gltf", materials("before"));
  }
  void TearDown() override { fs::remove_all(root_.parent_path()); }
#endif

  /// `start` and `wanted` for a variety: what a run begins with, and what it is to end with.
  void prepare(const Variety& variety) {
    variety_ = variety;
    untouched_ = false;
    ASSERT_EQ(runProgram(command(), root_ / "start"), 0);
    writeText(root_ / "start/a.gltf", materials("after"));
    copy("wanted");
    ASSERT_EQ(runProgram(command(), root_ / "wanted"), 0);
    old_ = filesBelow(root_ / "start/out");
    new_ = filesBelow(root_ / "wanted/out");
    // The second run's shaders take the place of the first's.
    ASSERT_TRUE(
        std::any_of(new_.begin(), new_.end(), [&](const auto& file) { return !old_.contains(file.first); }));
  }

  Words command() const {
    Words words{LACQUER_PROGRAM,
                "gen",
                "a.gltf",
                "-o",
                "out",
                "-q",
                "--no-validate",
                "--target",
                "glsl",
                "--target",
                "spirv",
                "--template",
                "bsdf",
                "--depfile",
                "out/deps",
                "--jobs",
                std::to_string(variety_.jobs)};
    if (variety_.cache) words.insert(words.end(), {"--cache", "cache"});
    return words;
  }

  void copy(const std::string& name) const {
    fs::remove_all(root_ / name);
    fs::copy(root_ / "start", root_ / name, fs::copy_options::recursive);
  }

  /// The run in the folder `work` with these settings of the library before it; its exit status.
  int faulty(const Words& settings, std::string* said = nullptr) const {
    // Who hangs has failed: `timeout` ends him and says 124.
    Words words{"timeout", "60", "env", std::string("LD_PRELOAD=") + LACQUER_FAULTS};
    words.insert(words.end(), settings.begin(), settings.end());
    const Words own = command();
    words.insert(words.end(), own.begin(), own.end());
    std::string text;
    return runProgram(words, root_ / "work", said == nullptr ? &text : said);
  }

  /// How many calls of a kind the run makes.
  long countOf(const std::string& kind) const {
    copy("work");
    EXPECT_EQ(faulty({"LACQUER_FAULT_COUNTS=counts"}), 0);
    std::ifstream counts(root_ / "work/counts");
    std::string name;
    for (long n = 0; counts >> name >> n;) {
      if (name == kind) return n;
    }
    return 0;
  }

  /// What is wrong with what a run has left; empty when each output is old or new.
  std::string torn() const {
    std::string wrong;
    for (const auto& [name, state] : filesBelow(root_ / "work/out")) {
      if (name.starts_with(".lacquer-tmp/")) continue;
      const auto was = old_.find(name);
      const auto is = new_.find(name);
      // A manifest may say that the input could not be read. It is whole when its last bracket is there.
      const bool whole = (was != old_.end() && was->second.bytes == state.bytes) ||
                         (is != new_.end() && is->second.bytes == state.bytes) ||
                         (name == "manifest.json" && nlohmann::json::accept(state.bytes));
      if (!whole) wrong += name + " is neither the old file nor the new one\n";
    }
    return wrong;
  }

  /// What a run should have left and has not.
  ///
  /// `scratch`: what was made on the way has to be gone, too. `removed`: and what the run before it made,
  /// which stays where a call fails that was to remove it.
  std::string missed(bool scratch, bool removed) const {
    std::istringstream lines(differences(root_ / "wanted/out", root_ / "work/out"));
    std::string wrong, line;
    constexpr std::string_view kMore = "only in the second: ";
    while (std::getline(lines, line)) {
      if (!scratch && line.starts_with(std::string(kMore) + ".lacquer-tmp/")) continue;
      if (removed || !line.starts_with(kMore) || !old_.contains(line.substr(kMore.size())))
        wrong += line + "\n";
    }
    return wrong;
  }

  /// One place: the fault, what it left, the next run. `exits`: statuses that the faulty run may have.
  void at(const std::string& kind, long n, const std::string& action, const std::vector<int>& exits) {
    const std::string where =
        fmt::format("{}:{}:{}{}", kind, n, action, variety_.cache ? " with a cache" : "");
    if (!untouched_) copy("work");
    untouched_ = false;
    std::string said;
    const int status = faulty({fmt::format("LACQUER_FAULT={}:{}:{}", kind, n, action),
                               "LACQUER_FAULT_FOLDER=" + (root_ / "work/out").string()},
                              &said);
    // What frees JSON takes memory, and the program ends where there is none (docs/security.md): so it is at
    // few places, which others are in another folder.
    const bool freeing = kind == "alloc" && status == 128 + SIGABRT &&
                         said.find("instance of 'std::bad_alloc'") != std::string::npos;
    ended_ += freeing ? 1 : 0;
    EXPECT_TRUE(freeing || std::find(exits.begin(), exits.end(), status) != exits.end())
        << where << ": " << status << "\n"
        << said;
    EXPECT_EQ(torn(), "") << where;
    // Where a call for a file fails, that may be the one that was to remove what was made on the way: then it
    // is the next run's to remove.
    if (status == 0) {
      EXPECT_EQ(missed(kind != "file", false), "") << where;
    }
    // Of what failed somebody is told, on the one channel that -q leaves.
    if (status == 1) {
      EXPECT_NE(said.find("error"), std::string::npos) << where << ": " << said;
    }
    // From the same files the next run does what it has done for `wanted`.
    untouched_ = differences(root_ / "start", root_ / "work").empty();
    if (untouched_) return;
    EXPECT_EQ(runProgram(command(), root_ / "work", &said), 0) << where << "\n" << said;
    EXPECT_EQ(missed(true, action == "kill"), "") << where;
  }

  /// Which allocations are the first of their place in the code.
  std::vector<long> firsts() const {
    copy("work");
    EXPECT_EQ(faulty({"LACQUER_FAULT_PLACES=" + (root_ / "places").string()}), 0);
    std::ifstream places(root_ / "places");
    return {std::istream_iterator<long>(places), {}};
  }

  /// The places of a kind that are to be tried, from the first to the last.
  std::vector<long> chosen(const std::string& kind, long count, long most) const {
    const char* all = std::getenv("LACQUER_FAULTS_ALL");
    const std::string how = all == nullptr ? "" : all;
    if (how == "code" && kind == "alloc") return firsts();
    const double step = all == nullptr  ? static_cast<double>(count) / static_cast<double>(most)
                        : how == "code" ? 1
                                        : std::atof(all);
    const size_t plus = how.find('+');
    const double before = plus == std::string::npos ? 0 : std::atof(how.c_str() + plus + 1);
    std::vector<long> places;
    for (double n = 1 + before; n <= static_cast<double>(count); n += std::max(1.0, step))
      places.push_back(static_cast<long>(n));
    return places;
  }

  void sweep(const std::string& kind, const std::string& action, const std::vector<int>& exits, long most) {
    const long count = countOf(kind);
    ASSERT_GT(count, 0) << kind;
    const std::vector<long> places = chosen(kind, count, most);
    EXPECT_FALSE(places.empty());
    size_t tried = 0;
    for (; tried < places.size() && !HasFailure(); ++tried) at(kind, places[tried], action, exits);
    EXPECT_LE(ended_ * 20, places.size());
    std::cout << fmt::format("{} {}s, {} of {} places\n", kind, action, tried, count);
  }

  fs::path root_;
  Variety variety_;
  bool untouched_ = false;  ///< `work` is as `start`
  size_t ended_ = 0;        ///< places where the program ended for want of memory to free JSON
  std::map<std::string, FileState> old_, new_;
};

const std::vector<int> kGoodOrFailed{0, 1};
const std::vector<int> kKilled{128 + 9};

TEST_F(Faults, allocationsFail) {
  prepare({});
  sweep("alloc", "fail", kGoodOrFailed, 80);
}

TEST_F(Faults, allocationsFailWithACache) {
  prepare({true});
  sweep("alloc", "fail", kGoodOrFailed, 80);
}

/// oneTBB waits for ever where what it does once has failed once: of its own allocations every one is tried.
TEST_F(Faults, allocationsOfTheThreadLibraryFail) {
  prepare({});
  sweep("tbb", "fail", kGoodOrFailed, 1000);
}

TEST_F(Faults, fileCallsFail) {
  prepare({});
  sweep("file", "fail", kGoodOrFailed, 100);
}

TEST_F(Faults, fileCallsFailWithACache) {
  prepare({true});
  sweep("file", "fail", kGoodOrFailed, 100);
}

TEST_F(Faults, threadsDoNotStart) {
  prepare({false, 3});
  sweep("thread", "fail", kGoodOrFailed, 10);
}

TEST_F(Faults, threadsDoNotStartWithACache) {
  prepare({true, 3});
  sweep("thread", "fail", kGoodOrFailed, 10);
}

TEST_F(Faults, killedAtFileCalls) {
  prepare({});
  sweep("file", "kill", kKilled, 100);
}

TEST_F(Faults, killedAtFileCallsWithACache) {
  prepare({true});
  sweep("file", "kill", kKilled, 100);
}

/// What a killed run had made goes with the next one, though that needs other shaders and no list names
/// these.
TEST_F(Faults, killedBeforeAnotherRun) {
  prepare({});
  const long count = countOf("file");
  for (const long n : chosen("file", count, 30)) {
    copy("work");
    EXPECT_EQ(faulty({fmt::format("LACQUER_FAULT=file:{}:kill", n),
                      "LACQUER_FAULT_FOLDER=" + (root_ / "work/out").string()}),
              128 + 9);
    writeText(root_ / "work/a.gltf", materials("before"));
    EXPECT_EQ(runProgram(command(), root_ / "work"), 0) << n;
    EXPECT_EQ(differences(root_ / "start/out", root_ / "work/out"), "") << n;
  }
}

TEST_F(Faults, theDiskIsFull) {
  prepare({});
  sweep("space", "fail", kGoodOrFailed, 40);
}

TEST_F(Faults, theDiskIsFullWithACache) {
  prepare({true});
  sweep("space", "fail", kGoodOrFailed, 40);
}

/// The whole output folder is moved away by somebody else, at some moment: it is made again, or the run
/// fails.
TEST_F(Faults, theFolderVanishes) {
  prepare({});
  const long count = countOf("file");
  for (long n = 1; n <= count; n += std::max(1L, count / 40)) {
    copy("work");
    std::string said;
    const int status = faulty({fmt::format("LACQUER_FAULT=file:{}:vanish", n),
                               "LACQUER_FAULT_FOLDER=" + (root_ / "work/out").string()},
                              &said);
    EXPECT_TRUE(status == 0 || status == 1) << n << ": " << status << "\n" << said;
    EXPECT_EQ(torn(), "") << n;
    EXPECT_EQ(runProgram(command(), root_ / "work", &said), 0) << n << "\n" << said;
    for (const auto& [name, state] : new_) {
      const auto made = filesBelow(root_ / "work/out");
      // Shaders of the run before that this one does not need went with the folder.
      if (old_.contains(name) && old_[name].bytes == state.bytes && !made.contains(name)) continue;
      ASSERT_TRUE(made.contains(name)) << n << ": " << name;
      EXPECT_EQ(made.at(name).bytes, state.bytes) << n << ": " << name;
    }
  }
}

/// A folder that nobody may write to: one message, exit 1, nothing changed.
TEST_F(Faults, theDiskIsReadOnly) {
  prepare({true});
  copy("work");
  std::string said;
  EXPECT_EQ(faulty({"LACQUER_FAULT=space:1:fail"}, &said), 1);
  EXPECT_NE(said.find("file-unwritable"), std::string::npos) << said;
  EXPECT_EQ(differences(root_ / "start/out", root_ / "work/out"), "");
}

/// What gets its name is on the disk before: each rename follows an fsync of what it moves.
TEST_F(Faults, namesComeAfterTheBytes) {
  prepare({});
  copy("work");
  ASSERT_EQ(faulty({"LACQUER_FAULT_TRACE=" + (root_ / "trace").string()}), 0);
  std::ifstream trace(root_ / "trace");
  std::vector<fs::path> synced;
  size_t renames = 0;
  for (std::string line; std::getline(trace, line);) {
    std::istringstream words(line);
    std::string what, from, to;
    words >> what >> from >> to;
    const fs::path path = fs::path(from).is_absolute() ? fs::path(from) : root_ / "work" / from;
    if (what == "fsync") synced.push_back(path.lexically_normal());
    if (what != "rename") continue;
    ++renames;
    EXPECT_EQ(std::count(synced.begin(), synced.end(), path.lexically_normal()), 1) << line;
  }
  EXPECT_GE(renames, 3U);
}

}  // namespace
}  // namespace lacquer::test
