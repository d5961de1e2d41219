// Inputs of somebody who means harm: a message and a failure, and nothing read, written or run that the user
// did not name.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <fstream>

#include "command.h"
#include "support/base64.h"
#include "support/cases.h"

namespace lacquer::test::hostile_test {
namespace {

namespace fs = std::filesystem;

const std::string kPoint = R"([{"uv0": [0.5, 0.99]}])";

/// A material whose base colour is the image of that URI.
std::string textured(const std::string& uri) {
  return R"({"asset": {"version": "2.0"}, "images": [{"uri": ")" + uri + R"("}], "textures": [{"source": 0}],
"materials": [{"name": "M", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]})";
}

std::string dataUri(const std::string& bytes) { return "data:image/png;base64," + toBase64(bytes); }

std::string word(uint32_t x) {
  std::string bytes;
  for (int i = 3; i >= 0; --i) bytes += static_cast<char>(x >> (8 * i) & 0xFF);
  return bytes;
}

/// Deflate's bits, the first of a byte being its lowest.
class Bits {
public:
  void add(std::string_view bits) {
    for (const char bit : bits) {
      if (count_ % 8 == 0) bytes_ += '\0';
      if (bit == '1') bytes_.back() = static_cast<char>(bytes_.back() | 1 << count_ % 8);
      ++count_;
    }
  }
  const std::string& bytes() const { return bytes_; }

private:
  std::string bytes_;
  size_t count_ = 0;
};

/// So many zeros, rounded up, in zlib's format: a literal, then copies of 258 bytes, with the fixed codes.
std::string zeros(size_t count) {
  constexpr std::string_view kFixed = "110";  // the last block, its kind
  Bits bits;
  bits.add(kFixed);
  bits.add("00110000");
  for (size_t made = 1; made < count; made += 258) bits.add("1100010100000");
  bits.add("0000000");
  return "\x78\x01" + bits.bytes() + word(0);
}

/// A grey PNG whose data unpack to so many zeros.
std::string png(uint32_t width, uint32_t height, size_t unpacked) {
  const auto chunk = [](const std::string& type, const std::string& data) {
    return word(static_cast<uint32_t>(data.size())) + type + data +
           word(0);  // no reader here looks at the sum
  };
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", word(width) + word(height) + std::string("\x08\0\0\0\0", 5)) +
         chunk("IDAT", zeros(unpacked)) + chunk("IEND", "");
}

std::string grey2x2() { return png(2, 2, 6); }

Outcome evaluated(const Workplace& place, const std::string& gltf, std::vector<std::string> more = {}) {
  place.write("a/points.json", kPoint);
  place.write("a/a.gltf", gltf);
  std::vector<std::string> words = {"eval", "a/a.gltf", "--points", "a/points.json"};
  words.insert(words.end(), more.begin(), more.end());
  return place.run(words, std::chrono::seconds(60));
}

void expectRefused(const Outcome& outcome, const std::string& code) {
  EXPECT_EQ(outcome.status, 1) << outcome.all();
  EXPECT_NE(outcome.err.find("[" + code + "]"), std::string::npos) << outcome.err;
}

TEST(HostileImage, onlyPngAndJpegReachADecoder) {
  const Workplace place;
  EXPECT_EQ(evaluated(place, textured(dataUri(grey2x2()))).status, 0);
  for (const std::string& bytes :
       {std::string("P6 2000 2000 65535\nAB"), std::string("BM") + std::string(60, '\0'),
        std::string("GIF89a\1\0\1\0\0\0\0,\0\0\0\0\1\0\1\0\0\2\2L\1\0;", 26), std::string("8BPS\0\1", 6),
        std::string("#?RADIANCE\n\n-Y 1 +X 1\n")}) {
    const Outcome outcome = evaluated(place, textured(dataUri(bytes)));
    expectRefused(outcome, "image-unreadable");
    EXPECT_NE(outcome.err.find("neither a PNG nor a JPEG"), std::string::npos) << outcome.err;
  }
}

/// A JPEG's Huffman table says how many codes it has: more than the decoder has room for are refused before
/// it is asked. 0xC4 is the marker of such tables, behind a quantization table or in front.
TEST(HostileImage, huffmanTablesHaveTheirLength) {
  const Workplace place;
  const auto jpeg = [](int codes) {
    std::string counts(16, '\0');
    counts[15] = static_cast<char>(codes / 2), counts[14] = static_cast<char>(codes - codes / 2);
    const std::string table = '\0' + counts + std::string(static_cast<size_t>(codes), '\1');
    const size_t length = table.size() + 2;
    return std::string("\xff\xd8\xff\xc4", 4) + static_cast<char>(length / 256) +
           static_cast<char>(length % 256) + table + "\xff\xd9";
  };
  const auto said = [&](int codes) { return evaluated(place, textured(dataUri(jpeg(codes)))).err; };
  EXPECT_NE(said(257).find("bad Huffman table"), std::string::npos) << said(257);
  EXPECT_EQ(said(256).find("bad Huffman table"), std::string::npos) << said(256);
}

/// A JPEG of 8 by 8 without one table: the decoder takes what its memory holds for them, which must be zeros
/// and not what another left there.
TEST(HostileImage, missesTablesThatAreZero) {
  const Workplace place;
  const std::string jpeg(
      "\xff\xd8\xff\xc0\0\x0b\x08\0\x08\0\x08\1\1\x11\0"
      "\xff\xda\0\x08\1\1\0\0\x3f\0\x55\x55\x55\x55\xff\xd9",
      31);
  setenv("MALLOC_PERTURB_", "90", 1);  // rubbish in all memory that the C library gives away
  const Outcome rubbish = evaluated(place, textured(dataUri(jpeg)));
  unsetenv("MALLOC_PERTURB_");
  EXPECT_EQ(rubbish.status, 0) << rubbish.all();
  EXPECT_EQ(rubbish.out, evaluated(place, textured(dataUri(jpeg))).out);
}

/// 0xDA is the marker of a scan; its head says that it has no component, which the decoder would refuse.
TEST(HostileImage, hasAHundredScansAtMost) {
  const Workplace place;
  const auto said = [&](size_t scans) {
    std::string jpeg = "\xff\xd8";
    for (size_t i = 0; i < scans; ++i) jpeg += std::string("\xff\xda\0\x06\0\0\x3f\0", 8);
    return evaluated(place, textured(dataUri(jpeg + "\xff\xd9")));
  };
  expectRefused(said(101), "image-unreadable");
  EXPECT_NE(said(101).err.find("more than 100 scans"), std::string::npos) << said(101).err;
  EXPECT_EQ(said(100).err.find("more than 100 scans"), std::string::npos) << said(100).err;
}

TEST(HostileImage, takesNoMoreThanItsBudget) {
  const Workplace place;
  expectRefused(evaluated(place, textured(dataUri(png(16000, 16000, 10)))), "image-too-large");
  expectRefused(evaluated(place, textured(dataUri(png(70000, 1, 10)))), "image-too-large");
  expectRefused(evaluated(place, textured(dataUri(grey2x2())), {"--limit", "image=3"}), "image-too-large");
  expectRefused(evaluated(place, textured(dataUri(grey2x2())), {"--limit", "images=3"}), "image-too-large");
  EXPECT_EQ(evaluated(place, textured(dataUri(grey2x2())), {"--limit", "images=4"}).status, 0);
  // Four pixels, and a stream that unpacks to sixteen million.
  const Outcome bomb = evaluated(place, textured(dataUri(png(2, 2, 16'000'000))));
  expectRefused(bomb, "image-unreadable");
  EXPECT_EQ(bomb.err.find("mem"), std::string::npos) << bomb.err;
}

TEST(HostileImage, liesInTheFilesFolder) {
  const Workplace place;
  place.write("secret.png", grey2x2());
  place.write("a/inside.png", grey2x2());
  place.write("a/sub/inside.png", grey2x2());
  fs::create_symlink("../secret.png", place / "a/link.png");
  fs::create_symlink("../absent.png", place / "a/dangling.png");
  fs::create_symlink("..", place / "a/up");
  fs::create_symlink("sub", place / "a/down");
  for (const char* uri : {"inside.png", "sub/../inside.png", "down/inside.png", "./sub/%69nside.png"}) {
    EXPECT_EQ(evaluated(place, textured(uri)).status, 0) << uri;
  }
  for (const char* uri :
       {"../secret.png", "%2e%2e/secret.png", "..%2fsecret.png", "sub/../../secret.png", "link.png",
        "up/secret.png", "../absent.png", "up/absent.png", "dangling.png", "../../../../../etc/passwd"}) {
    const Outcome outcome = evaluated(place, textured(uri));
    expectRefused(outcome, "image-outside");
    EXPECT_NE(outcome.err.find("leads out of the file's folder"), std::string::npos) << uri << outcome.err;
  }
  EXPECT_EQ(evaluated(place, textured("../secret.png"), {"--allow", "."}).status, 0);
  expectRefused(evaluated(place, textured("../secret.png"), {"--allow", "a/sub"}), "image-outside");
  for (const char* uri : {"inside.png%00.jpg", "/etc/passwd", "file:///etc/passwd"})
    expectRefused(evaluated(place, textured(uri)), "image-missing");
  ASSERT_EQ(mkfifo((place / "a/pipe.png").c_str(), 0600), 0);
  const Outcome pipe = evaluated(place, textured("pipe.png"));
  expectRefused(pipe, "image-missing");
  EXPECT_NE(pipe.err.find("no regular file"), std::string::npos) << pipe.err;
}

TEST(HostileJson, isReadByOneReaderWithLimits) {
  const Workplace place;
  const std::string deep(100'000, '[');
  place.write("m.json", R"({"lacquer": "0.1.0", "shaders": {}, "files": )" + deep);
  expectRefused(place.run({"merge", "m.json", "-o", "out"}), "json-too-deep");
  place.write("cost/manifest.json", R"({"shaders": )" + deep);
  expectRefused(place.run({"cost", "cost"}), "json-too-deep");
  place.write("a.gltf", gltfOf({R"({"extras": [0, 0, 0, 0, 0, 0]})"}));
  EXPECT_EQ(place.run({"gen", "a.gltf", "-o", "out"}).status, 0);
  expectRefused(place.run({"gen", "a.gltf", "-o", "out", "--limit", "values=8"}), "json-too-many");
  expectRefused(place.run({"gen", "a.gltf", "-o", "out", "--limit", "json=20"}), "json-too-large");
  expectRefused(place.run({"gen", "a.gltf", "-o", "out", "--limit", "file=20"}), "file-too-large");
  expectRefused(place.run({"gen", "a.gltf", "-o", "out", "--limit", "depth=2"}), "json-too-deep");
}

TEST(HostileInput, isARegularFile) {
  const Workplace place;
  ASSERT_EQ(mkfifo((place / "pipe").c_str(), 0600), 0);
  for (const char* input : {"pipe", "/dev/zero"}) {
    place.write("a.gltf", gltfOf({"{}"}));
    expectRefused(place.run({"gen", input, "-o", "out"}), "file-unreadable");
    expectRefused(place.run({"gen", "--graph", input, "-o", "out"}), "file-unreadable");
    expectRefused(place.run({"merge", input, "-o", "out"}), "file-unreadable");
    expectRefused(place.run({"eval", "a.gltf", "--points", input}), "file-unreadable");
  }
}

TEST(HostileStreams, endInAStatus) {
  const Workplace place;
  const std::string gen = fmt::format("'{}' gen '{}' --no-validate --target glsl -o out", LACQUER_PROGRAM,
                                      example("clearcoat.gltf"));
  EXPECT_EQ(place.shell(gen + " >&- 2>&-").status, 1);
  EXPECT_EQ(place.shell(gen + " -q --time 2>&-").status, 0);
  EXPECT_EQ(place.shell(fmt::format("'{}' gen nowhere.gltf -o out 2>&-", LACQUER_PROGRAM)).status, 1);
  const Outcome small = place.shell("ulimit -f 1; rm -rf out; " + gen + " -q");
  EXPECT_EQ(small.status, 1) << small.all();
  EXPECT_NE(small.err.find("[file-unwritable]"), std::string::npos) << small.all();
}

TEST(HostileFolder, onlyOurOwnTemporariesGo) {
  const Workplace place;
  const std::vector<std::string> gen = {
      "gen", example("clearcoat.gltf"), "-q", "--no-validate", "--target", "glsl", "-o", "out"};
  const std::string ours = "lacquer-0123456789abcdef-0.tmp";
  place.write("victim/mine.tmp", "");
  place.write("victim/" + ours, "");
  fs::create_directories(place / "out");
  fs::create_symlink("../victim", place / "out/.lacquer-tmp");
  const Outcome link = place.run(gen);
  EXPECT_TRUE(place.has("victim/mine.tmp"));
  EXPECT_TRUE(place.has("victim/" + ours));
  expectRefused(link, "file-unwritable");
  fs::remove(place / "out/.lacquer-tmp");
  place.write("out/.lacquer-tmp/mine.tmp", "");
  place.write("out/.lacquer-tmp/" + ours, "");
  ASSERT_EQ(mkfifo((place / "out/.lacquer-tmp/lacquer-0123456789abcdef-1.tmp").c_str(), 0600), 0);
  fs::create_symlink(place / "victim/mine.tmp", place / "out/.lacquer-tmp/lacquer-0123456789abcdef-2.tmp");
  const Outcome rest = place.run(gen, std::chrono::seconds(20));
  EXPECT_EQ(rest.status, 0) << rest.all();
  EXPECT_TRUE(place.has("out/.lacquer-tmp/mine.tmp"));
  EXPECT_FALSE(place.has("out/.lacquer-tmp/" + ours));
  EXPECT_TRUE(place.has("victim/mine.tmp"));
}

TEST(HostileCache, linksAreNotFollowed) {
  const Workplace place;
  const std::vector<std::string> gen = {"gen",          example("clearcoat.gltf"),
                                        "-q",           "--no-validate",
                                        "--target",     "glsl",
                                        "-o",           "out",
                                        "--cache",      "c",
                                        "--cache-size", "1"};
  place.write("victim/mine.tmp", "");
  place.write("victim/ab0123456789abcdef0123456789abcdef", "entry");
  fs::create_directories(place / "c/v1");
  fs::create_symlink("../../victim", place / "c/v1/.lacquer-tmp");
  fs::create_symlink("../../victim", place / "c/v1/ab");
  const std::set<std::string> before = place.names("out");
  EXPECT_EQ(place.run(gen).status, 0);
  EXPECT_EQ(place.names("out"), before);
}

TEST(HostileCache, entriesOfOthersAreWorthNothingWithAKey) {
  const Workplace place;
  place.write("key", std::string(32, 'k'));
  place.write("other", std::string(32, 'o'));
  place.write("short", "k");
  const auto gen = [&](const std::string& key) {
    return place.run({"gen", example("clearcoat.gltf"), "-q", "--no-validate", "--target", "glsl", "-o",
                      "out", "--time", "--cache", "c", "--cache-key", key});
  };
  expectRefused(gen("short"), "bad-cache-key");
  expectRefused(gen("absent"), "file-unreadable");
  EXPECT_NE(gen("other").err.find(" 0 from the cache"), std::string::npos);
  EXPECT_NE(gen("key").err.find(" 0 from the cache"), std::string::npos);
  const Outcome again = gen("key");
  EXPECT_EQ(again.err.find(" 0 from the cache"), std::string::npos) << again.err;
}

TEST(Outputs, areNoInputs) {
  const Workplace place;
  const std::string gltf = readFile(example("clearcoat.gltf"));
  const auto fresh = [&] {
    place.write("a.gltf", gltf);
    place.write("manifest.json", gltf);
  };
  const std::vector<std::vector<std::string>> all = {
      {"gen", "a.gltf", "-o", "out", "--depfile", "a.gltf"},
      {"gen", "a.gltf", "-o", "out", "--shard", "./a.gltf"},
      {"gen", "a.gltf", "-o", "out", "--depfile", "out/manifest.json"},
      {"gen", "manifest.json", "-o", "."},
      {"plan", "a.gltf", "-o", "out", "--ninja", "a.gltf"},
      {"preview", "a.gltf", "-o", "a.gltf", "--size", "16"},
      {"lod", "manifest.json", "-o", "."},
  };
  for (const std::vector<std::string>& words : all) {
    fresh();
    const std::set<std::string> before = place.names();
    expectRefused(place.run(words), "output-clash");
    EXPECT_EQ(place.read("a.gltf"), gltf);
    EXPECT_EQ(place.read("manifest.json"), gltf);
    EXPECT_EQ(place.names(), before);
  }
  EXPECT_EQ(place.run({"gen", "a.gltf", "-q", "-o", "out", "--target", "glsl"}).status, 0);
  const std::string manifest = place.read("out/manifest.json");
  expectRefused(place.run({"merge", "out/manifest.json", "-o", "out"}), "output-clash");
  EXPECT_EQ(place.read("out/manifest.json"), manifest);
  // A hard link to what would be written.
  const size_t begin = manifest.find("glsl/");
  const std::string shader = manifest.substr(begin, manifest.find('"', begin) - begin);
  fs::remove(place / ("out/" + shader));
  fs::create_hard_link(place / "a.gltf", place / ("out/" + shader));
  expectRefused(place.run({"gen", "a.gltf", "-q", "-o", "out", "--target", "glsl"}), "output-clash");
  EXPECT_EQ(place.read("out/" + shader), gltf);
}

/// What is no file stays what it is, by whatever link it is named.
TEST(Outputs, areFiles) {
  const Workplace place;
  place.write("a.gltf", readFile(example("clearcoat.gltf")));
  ASSERT_EQ(mkfifo((place / "pipe").c_str(), 0600), 0);
  fs::create_directories(place / "folder");
  fs::create_symlink("pipe", place / "to_pipe");
  const std::set<std::string> before = place.names();
  for (const char* output : {"pipe", "to_pipe", "folder", "/dev/null"}) {
    const std::vector<std::vector<std::string>> all = {
        {"gen", "a.gltf", "-q", "-o", "out", "--depfile", output},
        {"gen", "a.gltf", "-q", "-o", "out", "--shard", output},
        {"plan", "a.gltf", "-q", "-o", "out", "--ninja", output},
        {"preview", "a.gltf", "-o", output, "--size", "16"},
    };
    for (const std::vector<std::string>& words : all) {
      expectRefused(place.run(words, std::chrono::seconds(20)), "file-unwritable");
      EXPECT_EQ(place.names(), before) << words[0] << " " << output;
    }
  }
  ASSERT_EQ(mkfifo((place / "pipe.dds").c_str(), 0600), 0);
  expectRefused(place.run({"dfg", "-o", "pipe.dds", "--size", "2"}), "file-unwritable");
  EXPECT_TRUE(fs::is_fifo(place / "pipe.dds"));
  EXPECT_TRUE(fs::is_fifo(place / "pipe"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  fs::create_directories(place / "out");
  fs::create_symlink("../pipe", place / "out/manifest.json");
  expectRefused(place.run({"gen", "a.gltf", "-q", "-o", "out"}), "file-unwritable");
  EXPECT_TRUE(fs::is_fifo(place / "pipe"));
  // A link to a file, or to nothing, is replaced.
  fs::create_symlink("nothing", place / "a.d");
  const std::string gltf = place.read("a.gltf");
  EXPECT_EQ(place.run({"gen", "a.gltf", "-q", "-o", "out2", "--target", "glsl", "--depfile", "a.d"}).status,
            0);
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(place / "a.d")));
  EXPECT_FALSE(place.has("nothing"));
  EXPECT_EQ(place.read("a.gltf"), gltf);
}

/// It is looked at before what takes a while.
TEST(Outputs, areFoldersFirst) {
  const Workplace place;
  place.write("a.gltf", readFile(example("coat.gltf")));
  place.write("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + std::string(8, '\x7f'));
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"gen", "a.gltf", "-o", "a.gltf"},
                                             {"lod", "a.gltf", "-o", "a.gltf"},
                                             {"environment", "sky.hdr", "-o", "a.gltf"}}) {
    const Outcome outcome = place.run(words);
    expectRefused(outcome, "file-unwritable");
    EXPECT_NE(outcome.err.find("the folder cannot be made"), std::string::npos) << outcome.err;
  }
}

TEST(Outputs, areNotTheCachesKey) {
  const Workplace place;
  const std::string key(32, 'k');
  place.write("key", key);
  place.write("a.gltf", readFile(example("clearcoat.gltf")));
  const std::vector<std::vector<std::string>> all = {
      {"gen", "a.gltf", "-q", "-o", "out", "--depfile", "key"},
      {"gen", "a.gltf", "-q", "-o", "out", "--shard", "key"},
      {"plan", "a.gltf", "-q", "-o", "out", "--ninja", "key"},
  };
  for (std::vector<std::string> words : all) {
    words.insert(words.end(), {"--cache", "c", "--cache-key", "key"});
    expectRefused(place.run(words), "output-clash");
    EXPECT_EQ(place.read("key"), key);
    EXPECT_FALSE(place.has("out"));
  }
}

/// However two names are spelled, and whether the files are there or not.
TEST(Outputs, areDifferentFiles) {
  const Workplace place;
  place.write("a.gltf", readFile(example("clearcoat.gltf")));
  place.write("sub/x", "");
  fs::create_directory_symlink("sub", place / "lnk");
  const auto refused = [&](const std::vector<std::string>& words) {
    SCOPED_TRACE(words.back());
    const std::set<std::string> before = place.names();
    expectRefused(place.run(words), "output-clash");
    EXPECT_EQ(place.names(), before);
  };
  const auto two = [&](const std::string& a, const std::string& b) {
    refused({"gen", "a.gltf", "-q", "-o", "out", "--shard", a, "--depfile", b});
    refused({"dfg", "--size", "2", "-o", a, "--sheen", b});
  };
  two("A.d", "./A.d");
  two("B.d", "sub/../B.d");
  two("sub/C.d", "lnk/C.d");
  two("D.d", (place / "D.d").string());
  for (const std::string name : {"out/manifest.json", "out/glsl/x", "./out/cpp/y/z", "sub/../out/spirv/x"}) {
    refused({"gen", "a.gltf", "-q", "-o", "out", "--depfile", name});
    refused({"gen", "a.gltf", "-q", "-o", "out", "--shard", name});
    refused({"plan", "a.gltf", "-q", "-o", "out", "--ninja", name});
  }
  EXPECT_EQ(
      place.run({"gen", "a.gltf", "-q", "-o", "out", "--target", "glsl", "--depfile", "out/a.d"}).status, 0);
}

TEST(BuildFiles, holdNoNameThatTheyCannot) {
  const Workplace place;
  const std::string gltf = readFile(example("clearcoat.gltf"));
  for (const char* name :
       {"all:;touch${IFS}PWNED\nq:.gltf", "a\nb.gltf", "a;touch PWNED.gltf", "SHELL=sh.gltf", "%.gltf"}) {
    place.write(name, gltf);
    expectRefused(place.run({"gen", name, "-q", "--no-validate", "-o", "out", "--depfile", "a.d"}),
                  "depfile-name");
    EXPECT_FALSE(place.has("a.d"));
    EXPECT_FALSE(place.has("out"));
  }
  for (const char* name : {"a\nb.gltf", "a|b.gltf"}) {
    place.write(name, gltf);
    const Outcome outcome = place.run({"plan", name, "-o", "out", "--ninja", "build.ninja"});
    expectRefused(outcome, "ninja-name");
    EXPECT_EQ(outcome.out.find("run ninja"), std::string::npos) << outcome.out;
    EXPECT_FALSE(place.has("build.ninja"));
  }
  place.write("a b$.gltf", gltf);
  expectRefused(place.run({"plan", "a b$.gltf", "-o", "o|ut", "--ninja", "build.ninja"}), "ninja-name");
  EXPECT_EQ(place.run({"plan", "a b$.gltf", "-q", "-o", "out", "--ninja", "build.ninja"}).status, 0);
}

std::string graphWithTexture(const std::string& name) {
  return R"({"lacquer_graph": 1, "name": "m", "template": "bsdf", "parameters": {},
"textures": {")" +
         name + R"(": {"type": "sampler2D", "srgb": false, "texture": 3}},
"nodes": [{"id": "t", "node": "texture_sample", "inputs": {"image": {"texture": ")" +
         name + R"("}, "uv": {"given": "uv0"}}}], "outputs": {"alpha": {"node": "t", "swizzle": "a"}}})";
}

TEST(GraphNames, ofTexturesFitEveryTarget) {
  const Workplace place;
  std::vector<std::string> words = {"gen", "-q", "-o", "out", "--target", "glsl,glsl-gl,essl,hlsl,spirv,cpp"};
  size_t count = 0;
  for (const std::string& name :
       {std::string("half"), std::string("main"), std::string("out_bsdf"), std::string("v_TEXCOORD_0"),
        std::string("gl_x"), std::string("float"), std::string("float4x4"), std::string("textureLod"),
        std::string("NULL"), std::string("M_PI"), std::string("Texture2D"), std::string("Material"),
        std::string("material"), std::string("i"), std::string("a_sampler"), std::string(1200, 'x')}) {
    const std::string file = fmt::format("{}.json", count++);
    place.write(file, graphWithTexture(name));
    words.insert(words.end(), {"--graph", file});
  }
  const Outcome outcome = place.run(words);
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  const nlohmann::json manifest = place.manifest("out");
  ASSERT_EQ(manifest["files"].size(), count);
  for (const auto& file : manifest["files"]) {
    const auto& textures = file["materials"][0]["uses"][0]["textures"];
    ASSERT_EQ(textures.size(), 1U) << file;
    EXPECT_EQ(textures.begin().value()["texture"], 3);
    EXPECT_LE(textures.begin().key().size(), 80U);
  }
  for (const auto& entry : fs::directory_iterator(place / "out/cpp")) {
    EXPECT_EQ(
        place.shell(fmt::format("c++ -std=c++11 -x c++ -fsyntax-only '{}'", entry.path().string())).status, 0)
        << entry.path() << place.read("sh.err");
  }
}

TEST(GraphSize, hasALimit) {
  const Workplace place;
  std::string nodes;
  for (int i = 0; i < 10'001; ++i)
    nodes += fmt::format(R"({}{{"id": "n{}", "node": "x", "inputs": {{}}}})", i == 0 ? "" : ",", i);
  place.write("g.json", R"({"lacquer_graph": 1, "name": "m", "template": "bsdf", "nodes": [)" + nodes +
                            R"(], "outputs": {}})");
  expectRefused(place.run({"gen", "--graph", "g.json", "-o", "out"}), "graph-too-large");
}

TEST(CacheSize, isAPlainNumber) {
  const Workplace place;
  for (const char* size : {"-1", "18446744073709551616", "99999999999T", "", "1e3"}) {
    const Outcome outcome =
        place.run({"gen", example("clearcoat.gltf"), "-o", "out", "--cache", "c", "--cache-size", size});
    EXPECT_EQ(outcome.status, 2) << size << outcome.all();
  }
}

/// Nothing that a terminal obeys, and no line that nobody wrote.
void expectHarmless(const Outcome& outcome) {
  for (const std::string* text : {&outcome.out, &outcome.err}) {
    for (const char* acting : {"\x1b", "\x7f", "\xc2\x9b", "\xd8\x9c", "\xe2\x80\x8f", "\xe2\x80\xae",
                               "\xe2\x80\xa8", "\xe2\x81\xa6", "\nFORGED", "\rFORGED"}) {
      EXPECT_EQ(text->find(acting), std::string::npos) << *text;
    }
  }
}

TEST(HostileNames, actOnNoTerminal) {
  const Workplace place;
  const std::string acting =
      "x\x1b[2J\x7f\xc2\x9b\xd8\x9c\xe2\x80\x8f\xe2\x80\xae\xe2\x80\xa8\xe2\x81\xa6\nFORGED\rFORGED\nFORGED";
  const std::string name = nlohmann::json(acting).dump();
  const std::string file = acting + ".gltf";
  place.write(
      file, gltfOf({R"({"name": )" + name + R"(, "alphaCutoff": -1})",
                    R"({"name": )" + name + R"(, "alphaMode": )" + name + "}", R"({"name": )" + name + "}"}));
  const Outcome generated = place.run({"gen", file, "-o", "out", "--target", "spirv"});
  EXPECT_NE(generated.out.find("FORGED"), std::string::npos) << generated.out;
  EXPECT_NE(generated.err.find("\\x1b[2J\\x7f\\x9b\\u061c\\u200f\\u202e\\u2028\\u2066\\nFORGED"),
            std::string::npos)
      << generated.err;
  expectHarmless(generated);
  place.write("one.gltf", gltfOf({R"({"name": )" + name + "}"}));
  const Outcome proved = place.run({"prove", "one.gltf"});
  EXPECT_NE(proved.out.find("FORGED"), std::string::npos) << proved.out;
  expectHarmless(proved);
  expectHarmless(place.run({"gen", acting, "-o", "out"}));
  expectHarmless(place.run({"prove", acting, "--material", acting}));
  expectHarmless(
      place.run({"preview", "one.gltf", "-o", "a.png", "--size", "16", "--compare", "float", "double"}));
  place.write("g.json", R"({"lacquer_graph": 1, "name": )" + name + R"(, "template": "bsdf", "nodes": [],
"outputs": {}, "skipped": {)" +
                            name + ": " + name + "}}");
  expectHarmless(place.run({"gen", "--graph", "g.json", "-o", "out", "--target", "glsl"}));
  place.write("h.json", R"({"lacquer_graph": 1, "template": )" + name + R"(, "nodes": [{"id": )" + name +
                            R"(, "node": )" + name + R"(, "inputs": {)" + name + R"(: {"given": )" + name +
                            R"(}}}], "outputs": {)" + name + R"(: {"parameter": )" + name + "}}}");
  expectHarmless(place.run({"gen", "--graph", "h.json", "-o", "out", "--target", "glsl"}));
  place.write("cost/manifest.json", R"({"lacquer": )" + name + R"(, "schema": 1, "files": [], "shaders": {)" +
                                        name + R"(: {"files": {"spirv": {"frag": )" + name + "}}}}}");
  expectHarmless(place.run({"cost", "cost"}));
  expectHarmless(place.run({"merge", "cost/manifest.json", "-o", "merged"}));
}

TEST(HostileStreams, aFullOutputIsAnErrorOfEveryVerb) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const Workplace place;
  place.write("a.gltf", gltfOf({"{}"}));
  place.write("p.json", kPoint);
  for (const char* words : {"nodes", "nodes --json", "nodes coat_absorption", "graph a.gltf",
                            "graph a.gltf --format dot", "dump a.gltf", "prove a.gltf --json",
                            "eval a.gltf --points p.json", "gen a.gltf -o out --target glsl"}) {
    const Outcome outcome = place.shell(fmt::format("'{}' {} >/dev/full", LACQUER_PROGRAM, words));
    expectRefused(outcome, "output-unwritable");
    EXPECT_EQ(outcome.err.find("[stopped]"), std::string::npos) << words << outcome.err;
  }
}

TEST(LongLines, areCut) {
  const Workplace place;
  place.write("nodes/a.node", "node a(float x) -> float { return " + std::string(1'000'000, 'y') + "; }\n");
  const Outcome outcome = place.run({"nodes", "--nodes", "nodes"});
  EXPECT_EQ(outcome.status, 1) << outcome.status;
  EXPECT_LT(outcome.err.size(), 3000U);
}

/// A stack that the deepest inputs do not fit in is told of, not overrun.
TEST(Hostile, smallStacksAreTold) {
  const Workplace place;
  std::string text = "x";
  for (int i = 0; i < 250; ++i) text = "(-" + text + ")";
  place.write("n/deep.node",
              "/// D.\n/// source: S\nnode deep(float x in [0, 1]) -> float { return " + text + "; }\n");
  place.write("m/deep.node", "/// D.\n/// source: S\nnode deep(float x in [0, 1]) -> float { return x; }\n");
  for (const char* verb : {"nodes", "gen a.gltf -o out -q"}) {
    for (const char* folder : {"n", "m"}) {
      for (const int kibibytes : {128, 512, 1023}) {
        const Outcome small =
            place.shell(fmt::format("cp {} a.gltf; ulimit -s {}; {} {} --nodes {}", example("coat.gltf"),
                                    kibibytes, LACQUER_PROGRAM, verb, folder));
        EXPECT_EQ(small.status, 1) << kibibytes << small.all();
        EXPECT_NE(small.err.find("[stack-too-small]"), std::string::npos) << small.all();
      }
    }
  }
  const Outcome enough = place.shell(fmt::format("ulimit -s 1536; {} nodes --nodes n", LACQUER_PROGRAM));
  EXPECT_LE(enough.status, 1) << enough.all();
  EXPECT_EQ(enough.err.find("[stack-too-small]"), std::string::npos) << enough.all();
}

}  // namespace
}  // namespace lacquer::test::hostile_test
