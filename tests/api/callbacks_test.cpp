// What callbacks may do: throw, which ends the call, and call Lacquer themselves.
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "inputs.h"

namespace lacquer::test {
namespace {

struct Enough : std::runtime_error {
  Enough() : std::runtime_error("enough") {}
};

/// Throws in its `count`th call.
Progress throwing(size_t count) {
  return [count, calls = std::make_shared<std::atomic<size_t>>(0)](size_t, size_t) {
    if (++*calls == count) throw Enough();
  };
}

Options everything(const std::filesystem::path& folder) {
  Options options;
  options.jobs = 4;
  options.cache = (folder / "cache").string();
  return options;
}

TEST(Throwing, endsARunAndLeavesWholeFiles) {
  const std::filesystem::path folder = emptyFolder();
  const std::filesystem::path out = folder / "out";
  Messages messages;
  EXPECT_THROW((void)generate(examples(), {}, out.string(), everything(folder), messages, throwing(1)),
               Enough);
  EXPECT_FALSE(std::filesystem::exists(out / "manifest.json"));
  // The next run finishes what is left.
  const Report report = generate(examples(), {}, out.string(), everything(folder), messages);
  EXPECT_TRUE(report.ok);
  EXPECT_EQ(errorsOf(messages), "");
  size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out))
    files += entry.is_regular_file();
  size_t expected = 1;  // the manifest
  for (const ShaderReport& shader : report.shaders) {
    expected += shader.files.size();
    for (const auto& [path, bytes] : shader.files)
      EXPECT_EQ(std::filesystem::file_size(out / path), bytes) << path;
  }
  EXPECT_EQ(files, expected);
}

/// The last call comes when all is made but the manifest.
TEST(Throwing, inTheLastCall) {
  const std::filesystem::path folder = emptyFolder();
  const std::string out = (folder / "out").string();
  const auto at_end = [](size_t done, size_t known) {
    if (known > 0 && done == known) throw Enough();
  };
  Messages messages;
  EXPECT_THROW((void)generate(examples(), {}, out, quick(), messages, at_end), Enough);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/manifest.json"));
}

TEST(Throwing, endsAPreview) {
  const std::filesystem::path folder = emptyFolder();
  Preview preview;
  preview.output = (folder / "out.png").string();
  preview.size = 16;
  Messages messages;
  EXPECT_THROW((void)drawPreview(preview, examples(), {}, {}, messages, throwing(2)), Enough);
  EXPECT_FALSE(std::filesystem::exists(preview.output));
}

TEST(Throwing, endsAnAttack) {
  Stress stress;
  stress.samples = 10;
  Messages messages;
  EXPECT_THROW((void)stressNodes(stress, {}, {}, messages, throwing(2)), Enough);
}

TEST(Throwing, leavesTheBlockAsItWas) {
  Messages messages;
  const Shader shader = paintGraph().generate(quick(), messages);
  std::vector<std::byte> block(shader.uniformSize(), std::byte{7});
  const auto values = [](std::string_view, std::span<double>) -> bool { throw Enough(); };
  EXPECT_THROW((void)shader.pack(values, block), Enough);
  for (const std::byte b : block) EXPECT_EQ(b, std::byte{7});
}

/// Another run within each call, from whichever thread: it may do pieces of the outer one while it waits.
TEST(CallingBack, fromARun) {
  const std::filesystem::path folder = emptyFolder();
  Messages messages;
  std::atomic<int> inside{0};
  size_t calls = 0;
  const Progress progress = [&](size_t, size_t) {
    EXPECT_EQ(++inside, 1) << "calls come one at a time";
    Messages own;
    Options options = quick();
    options.jobs = 2;
    const Report report =
        generate(examples(), {}, (folder / ("inner" + std::to_string(calls++ % 2))).string(), options, own);
    EXPECT_TRUE(report.ok) << errorsOf(own);
    EXPECT_TRUE(paintGraph().generate(quick(), own));
    --inside;
  };
  const Report report =
      generate(examples(), {}, (folder / "outer").string(), everything(folder), messages, progress);
  EXPECT_TRUE(report.ok) << errorsOf(messages);
  EXPECT_GT(calls, 0U);
}

}  // namespace
}  // namespace lacquer::test
