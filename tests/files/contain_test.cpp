// Files that a file names: below its folder, whatever is exchanged for a link meanwhile.
#include "support/contain.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "support/file.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

class Contain : public testing::TestWithParam<bool> {
protected:
  void SetUp() override {
    root_ = fs::canonical(fs::temp_directory_path()) /
            ("lacquer-contain-" + std::to_string(::getpid()) + (GetParam() ? "-kernel" : "-walk"));
    fs::remove_all(root_);
    fs::create_directories(root_ / "in/deep");
    write("in/a.bin", "inside");
    write("in/deep/b.bin", "inside");
    write("secret", "outside");
    fs::create_directory_symlink(root_, root_ / "in/up");
    fs::create_symlink(root_ / "secret", root_ / "in/link.bin");
    fs::create_symlink("deep/b.bin", root_ / "in/good.bin");
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(root_ / name) << text; }

  /// Its bytes, or the reason why it is not opened.
  static std::string opened(const fs::path& path) {
    errno = 0;
    const int fd = openWithoutLinks(path.string(), O_RDONLY | O_CLOEXEC, GetParam());
    if (fd < 0) return errno == ELOOP ? "link" : errno == ENOENT ? "none" : std::to_string(errno);
    char bytes[64];
    const ssize_t got = ::read(fd, bytes, sizeof bytes);
    ::close(fd);
    return got < 0 ? "unreadable" : std::string(bytes, static_cast<size_t>(got));
  }

  fs::path root_;
};

TEST_P(Contain, OpensNoLink) {
  EXPECT_EQ(opened(root_ / "in/a.bin"), "inside");
  EXPECT_EQ(opened(root_ / "in/deep/b.bin"), "inside");
  EXPECT_EQ(opened(root_ / "in/deep//b.bin"), "inside");
  EXPECT_EQ(opened(root_ / "in/link.bin"), "link");
  EXPECT_EQ(opened(root_ / "in/good.bin"), "link");
  EXPECT_EQ(opened(root_ / "in/up/secret"), "link");
  EXPECT_EQ(opened(root_ / "in/missing.bin"), "none");
}

TEST_P(Contain, LinksThatStayInsideAreFollowedFirst) {
  const auto inside = resolveBelow((root_ / "in").string(), "good.bin", {});
  ASSERT_TRUE(inside);
  EXPECT_EQ(opened(*inside), "inside");
  EXPECT_FALSE(resolveBelow((root_ / "in").string(), "link.bin", {}));
  EXPECT_FALSE(resolveBelow((root_ / "in").string(), "up/secret", {}));
}

/// One thread exchanges a file and a folder for links that lead out, again and again, another reads. Without
/// Links::None this reads "outside" within some hundred rounds.
TEST_P(Contain, ARaceReadsNothingOutside) {
  std::atomic<bool> stop = false;
  std::thread swaps([&] {
    const fs::path file = root_ / "in/a.bin", other = root_ / "in/other";
    const fs::path folder = root_ / "in/deep", aside = root_ / "in/aside";
    fs::create_directories(root_ / "far");
    write("far/b.bin", "outside");
    std::error_code ignored;
    while (!stop) {
      fs::create_symlink(root_ / "secret", other, ignored);
      fs::rename(other, file, ignored);
      write("in/other", "inside");
      fs::rename(other, file, ignored);
      fs::rename(folder, aside, ignored);
      fs::create_directory_symlink(root_ / "far", folder, ignored);
      fs::remove(folder, ignored);
      fs::rename(aside, folder, ignored);
    }
  });
  size_t read = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto path = resolveBelow((root_ / "in").string(), i % 2 == 0 ? "a.bin" : "deep/b.bin", {});
    if (!path) continue;
    const std::string bytes = opened(*path);
    EXPECT_NE(bytes, "outside");
    read += bytes == "inside" ? 1 : 0;
  }
  stop = true;
  swaps.join();
  EXPECT_GT(read, 100U);
}

INSTANTIATE_TEST_SUITE_P(Both, Contain, testing::Bool(),
                         [](const auto& info) { return info.param ? "ByTheKernel" : "FolderByFolder"; });

TEST(ReadFile, WithoutLinksSaysSo) {
  const fs::path root =
      fs::canonical(fs::temp_directory_path()) / ("lacquer-links-" + std::to_string(::getpid()));
  fs::create_directories(root);
  std::ofstream(root / "a") << "text";
  fs::create_symlink("a", root / "b");
  EXPECT_EQ(*readFile((root / "a").string(), 100, Links::None), "text");
  EXPECT_EQ(*readFile((root / "b").string(), 100), "text");
  const Result<std::string> refused = readFile((root / "b").string(), 100, Links::None);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error()[0].code, "file-unreadable");
  fs::remove_all(root);
}

}  // namespace
}  // namespace lacquer::test
