// `lacquer profile`: tables as files, and profiles in glTF files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "lacquer.h"
#include "support/answers.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char kRound[] =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 2 3 1 1 2 0 0 0\n1 1 10\n0 90 180\n0\n100 50 0\n";
constexpr const char kHalves[] =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 3 1 2 0 0 0\n1 1 10\n0 90 180\n0 90 180\n"
    "20 10 20\n20 20 20\n20 40 20\n";

uint64_t wordAt(const std::string& bytes, size_t at, int count = 4) {
  uint64_t number = 0;
  for (int i = 0; i < count; ++i) number |= uint64_t{static_cast<unsigned char>(bytes.at(at + i))} << (8 * i);
  return number;
}

class ProfileFiles : public testing::Test {
protected:
  ProfileFiles() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "lamps");
    put("round.ies", kRound);
    put("lamps/halves.ies", kHalves);
  }
  ~ProfileFiles() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  /// A glTF file with these lights.
  void putGltf(const std::string& name, const json& lights, const json& more = json::object()) const {
    json file = {{"asset", {{"version", "2.0"}}},
                 {"extensionsUsed", {"EXT_lights_ies"}},
                 {"extensions", {{"EXT_lights_ies", {{"lights", lights}}}}}};
    file.update(more);
    put(name, file.dump());
  }

  std::optional<LightProfiles> make(const ProfileTables& tables, const Strings& files) {
    messages_.clear();
    return lightProfiles(tables, files, {}, messages_);
  }
  /// The codes of what was wrong with a call that failed.
  std::string wrongWith(const ProfileTables& tables, const Strings& files) {
    EXPECT_FALSE(make(tables, files));
    std::string codes;
    for (const Message& message : messages_) codes += message.code + " ";
    return codes;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "lacquer_profiles";
  Messages messages_;
};

TEST_F(ProfileFiles, Ktx2HasALayerForEach) {
  const auto made = make({path("lamps.ktx2"), 16, 8}, {path("round.ies"), path("lamps/halves.ies")});
  ASSERT_TRUE(made);
  EXPECT_EQ(made->format, "R16_SFLOAT");
  ASSERT_EQ(made->layers.size(), 2U);
  const std::string bytes = readFile(path("lamps.ktx2"));
  const uint64_t head[] = {76, 2, 16, 8, 0, 2, 1, 1};  // format, type's size, sides, layers, faces, levels
  for (size_t i = 0; i < std::size(head); ++i) EXPECT_EQ(wordAt(bytes, 12 + 4 * i), head[i]) << i;
  const uint64_t begin = wordAt(bytes, 80, 8);
  ASSERT_EQ(wordAt(bytes, 88, 8), 2U * 2 * 16 * 8);
  ASSERT_EQ(bytes.size(), begin + 2 * 2 * 16 * 8);
  for (size_t layer = 0; layer < 2; ++layer) {
    for (size_t i = 0; i < 16 * 8; ++i) {
      const auto half = static_cast<uint32_t>(wordAt(bytes, begin + 2 * (layer * 16 * 8 + i), 2));
      const double value = std::ldexp(1024 + (half & 1023), static_cast<int>(half >> 10) - 25);
      EXPECT_NEAR(value, made->layers[layer].texels[i], 3e-4);
    }
  }
}

TEST_F(ProfileFiles, DdsAndPng) {
  const auto dds = make({path("lamps.dds"), 16, 8}, {path("round.ies"), path("lamps/halves.ies")});
  ASSERT_TRUE(dds);
  const std::string bytes = readFile(path("lamps.dds"));
  EXPECT_EQ(wordAt(bytes, 12), 8U);
  EXPECT_EQ(wordAt(bytes, 16), 16U);
  EXPECT_EQ(wordAt(bytes, 128), 56U);  // R16_UNORM
  EXPECT_EQ(wordAt(bytes, 140), 2U);   // layers
  ASSERT_EQ(bytes.size(), 148U + 2 * 2 * 16 * 8);
  EXPECT_EQ(wordAt(bytes, 148, 2), static_cast<uint64_t>(std::lround(dds->layers[0].texels[0] * 65535)));
  EXPECT_EQ(wordAt(bytes, 148 + 2 * 16 * 8, 2),
            static_cast<uint64_t>(std::lround(dds->layers[1].texels[0] * 65535)));

  ASSERT_TRUE(make({path("lamp.png"), 16, 8}, {path("round.ies")}));
  const std::string png = readFile(path("lamp.png"));
  EXPECT_EQ(png.substr(0, 4), "\x89PNG");
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\0\x10\0\0\0\x08", 8));
  EXPECT_EQ(wrongWith({path("two.png"), 16, 8}, {path("round.ies"), path("lamps/halves.ies")}),
            "table-format ");
  EXPECT_FALSE(fs::exists(path("two.png")));
}

/// The summary, and the height that fits.
TEST_F(ProfileFiles, SayWhatTheyHold) {
  const auto round = make({}, {path("round.ies")});
  ASSERT_TRUE(round);
  EXPECT_EQ(round->layers[0].height, 1U);
  EXPECT_EQ(round->layers[0].width, 256U);
  EXPECT_EQ(round->layers[0].peak, 200);
  const auto both = make({}, {path("round.ies"), path("lamps/halves.ies")});
  ASSERT_TRUE(both);
  const json answer = json::parse(jsonOf(both));
  EXPECT_FALSE(answer.contains("output"));
  EXPECT_EQ(answer["profiles"][0]["symmetry"], "round");
  EXPECT_EQ(answer["profiles"][0]["height"], 128);
  EXPECT_EQ(answer["profiles"][1]["symmetry"], "halves");
  EXPECT_EQ(answer["profiles"][1]["photometry"], "C");
  EXPECT_EQ(answer["profiles"][1]["peak"], 40.0);
  EXPECT_NEAR(answer["profiles"][1]["lumens"].get<double>(), 4 * M_PI * (20 + 2.5 * 2 / M_PI), 1e-9);
  EXPECT_LT(answer["profiles"][1]["error"], 0.01);
  EXPECT_LT(answer["profiles"][1]["mean_error"], answer["profiles"][1]["error"]);
  EXPECT_EQ(answer["profiles"][1].contains("light"), false);
}

TEST_F(ProfileFiles, OfGltfComeFromFilesDataAndViews) {
  std::string base64;
  const std::string data = kRound;
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < data.size(); i += 3) {
    const auto byte = [&](size_t k) { return k < data.size() ? static_cast<unsigned char>(data[k]) : 0U; };
    const unsigned bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (size_t k = 0; k < 4; ++k) base64 += i + k > data.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  put("lamps.bin", std::string("____") + kHalves);
  putGltf("lamps.gltf",
          {{{"uri", "lamps/halves.ies"}},
           {{"uri", "data:application/x-ies-lm-63;base64," + base64}},
           {{"bufferView", 0}, {"mimeType", "application/x-ies-lm-63"}}},
          {{"buffers", {{{"uri", "lamps.bin"}, {"byteLength", 4 + sizeof kHalves - 1}}}},
           {"bufferViews", {{{"buffer", 0}, {"byteOffset", 4}, {"byteLength", sizeof kHalves - 1}}}}});
  const auto made = make({}, {path("lamps.gltf"), path("round.ies")});
  ASSERT_TRUE(made) << messages_[0].text;
  ASSERT_EQ(made->layers.size(), 4U);
  EXPECT_EQ(made->layers[0].peak, 40);
  EXPECT_EQ(made->layers[1].peak, 200);
  EXPECT_EQ(made->layers[2].peak, 40);
  EXPECT_EQ(made->layers[2].light, 2);
  EXPECT_EQ(made->layers[2].file, path("lamps.gltf"));
  EXPECT_EQ(made->layers[3].light, -1);
  EXPECT_EQ(made->layers[1].texels, made->layers[3].texels);
}

TEST_F(ProfileFiles, OfGltfLieBelowItsFolder) {
  putGltf("lamps/out.gltf", {{{"uri", "../round.ies"}}});
  EXPECT_EQ(wrongWith({}, {path("lamps/out.gltf")}), "profile-outside ");
  Options options;
  options.allow = {folder_.string()};
  EXPECT_TRUE(lightProfiles({}, {path("lamps/out.gltf")}, options, messages_));
  for (const char* uri : {"none.ies", "https://example.org/lamp.ies", "data:,IESNA"}) {
    putGltf("missing.gltf", {{{"uri", uri}}});
    EXPECT_EQ(wrongWith({}, {path("missing.gltf")}), "profile-missing ") << uri;
  }
  putGltf("neither.gltf", json::array({json::object()}));
  EXPECT_EQ(wrongWith({}, {path("neither.gltf")}), "missing-property ");
  putGltf("null.gltf", json::array({nullptr}));
  EXPECT_EQ(wrongWith({}, {path("null.gltf")}), "wrong-type ");
  putGltf("view.gltf", {{{"bufferView", 0}, {"mimeType", "application/x-ies-lm-63"}}},
          {{"bufferViews", {{{"buffer", 1}, {"byteLength", 9}}}}});
  EXPECT_EQ(wrongWith({}, {path("view.gltf")}), "profile-missing ");
  putGltf("wrong.gltf", {{{"uri", "lamps/wrong.ies"}}});
  put("lamps/wrong.ies", "IESNA:LM-63-1995\nTILT=NONE\n1 -1 1 two");
  EXPECT_EQ(wrongWith({}, {path("wrong.gltf")}), "profile-unreadable ");
  EXPECT_NE(messages_[0].text.find("wrong.ies:3:8: error: the number of vertical angles is \"two\""),
            std::string::npos)
      << messages_[0].text;
  // An output is none of what is read.
  putGltf("lamp.gltf", {{{"uri", "lamps/halves.png"}}});
  put("lamps/halves.png", kHalves);
  EXPECT_EQ(wrongWith({path("lamps/halves.png")}, {path("lamp.gltf")}), "output-clash ");
}

/// What is wrong with the extension is said as by those who read the file as a scene.
TEST_F(ProfileFiles, OfGltfAreCheckedAsInScenes) {
  const json nodes = {{{"extensions", {{"EXT_lights_ies", {{"light", 0}, {"multiplier", -1}}}}}},
                      {{"extensions", {{"EXT_lights_ies", {{"light", 0}, {"color", {0, 2, 1}}}}}}},
                      {{"extensions", {{"EXT_lights_ies", {{"light", 1}}}}}},
                      {{"extensions", {{"EXT_lights_ies", 3}}}}};
  const std::pair<json, std::string> kWrong[] = {
      {{{"uri", "round.ies"}, {"bufferView", 0}, {"mimeType", "application/x-ies-lm-63"}},
       "excluded-property "},
      {{{"uri", "round.ies"}, {"mimeType", "image/png"}}, "unknown-value "},
      {{{"bufferView", 0}}, "missing-property "},
      {{{"bufferView", 1}, {"mimeType", "application/x-ies-lm-63"}}, "index-out-of-range "},
      {{{"uri", 3}}, "wrong-type "}};
  const json more = {{"buffers", {{{"uri", "round.ies"}, {"byteLength", sizeof kRound - 1}}}},
                     {"bufferViews", {{{"buffer", 0}, {"byteLength", sizeof kRound - 1}}}}};
  const auto inScene = [&] {
    messages_.clear();
    Scene::load(path("lamps.gltf"), {}, messages_);
    std::string texts;
    for (const Message& message : messages_) texts += message.text + '\n';
    return texts;
  };
  const auto inProfiles = [&] {
    EXPECT_FALSE(make({}, {path("lamps.gltf")}));
    std::string texts;
    for (const Message& message : messages_) texts += message.text + '\n';
    return texts;
  };
  for (const auto& [light, code] : kWrong) {
    putGltf("lamps.gltf", json::array({light}), more);
    EXPECT_EQ(wrongWith({}, {path("lamps.gltf")}), code);
    EXPECT_EQ(inProfiles(), inScene()) << light;
  }
  putGltf("lamps.gltf", {{{"uri", "round.ies"}}}, {{"nodes", nodes}});
  EXPECT_EQ(wrongWith({}, {path("lamps.gltf")}), "out-of-range out-of-range index-out-of-range wrong-type ");
  EXPECT_EQ(inProfiles(), inScene());
  putGltf("lamps.gltf", json::array());
  EXPECT_EQ(wrongWith({}, {path("lamps.gltf")}), "wrong-length ");
}

/// A file is not of those who read it: what is quoted of it is short, whatever it holds.
TEST_F(ProfileFiles, MessagesAreShort) {
  const std::string long_text(1 << 20, 'x');
  const std::string head = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 2 3 1 1 2 0 0 0\n1 1 10\n";
  const std::string kTexts[] = {"IES" + long_text,
                                long_text,
                                "TILT=" + long_text,
                                "TILT=NONE\n" + long_text,
                                head + "0 90 180 0 1 2 " + long_text,
                                head + "0 90 " + std::string(1 << 20, '9')};
  for (const std::string& text : kTexts) {
    messages_.clear();
    EXPECT_FALSE(lightProfile(text, "memory", {}, messages_));
    ASSERT_FALSE(messages_.empty());
    for (const Message& message : messages_) EXPECT_LT(message.text.size(), 1000U) << text.substr(0, 20);
  }
}

TEST_F(ProfileFiles, WrongArgumentsAreSaid) {
  EXPECT_EQ(wrongWith({}, {}), "no-profile ");
  EXPECT_EQ(wrongWith({{}, 1}, {path("round.ies")}), "out-of-range ");
  EXPECT_EQ(wrongWith({{}, 16, 4096}, {path("round.ies")}), "out-of-range ");
  EXPECT_EQ(wrongWith({path("lamps.exr")}, {path("round.ies")}), "table-format ");
  EXPECT_EQ(wrongWith({path("none/round.ies")}, {path("none/round.ies")}), "table-format ");
  EXPECT_EQ(wrongWith({}, {path("none.ies")}), "file-unreadable ");
  put("none.gltf", R"({"asset": {"version": "2.0"}})");
  EXPECT_EQ(wrongWith({}, {path("none.gltf")}), "no-profile ");
  EXPECT_FALSE(lightProfile(kRound, "memory", {{}, 1}, messages_));
  EXPECT_FALSE(lightProfile("nothing", "memory", {}, messages_));
  const auto made = lightProfile(kRound, "memory", {}, messages_);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->file, "memory");
  EXPECT_EQ(made->texels.size(), 256U);
}

}  // namespace
}  // namespace lacquer::test
