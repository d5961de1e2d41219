// `lacquer eval` through the public API: its answers are the evaluator's, its errors say what and where.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "lacquer.h"
#include "physics/model.h"
#include "support/answers.h"
#include "support/cases.h"

namespace lacquer::physics::eval_test {
namespace {

class Eval : public testing::Test {
protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("lacquer_eval_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }

  /// The answer; `text` gets the messages, one after the other.
  static std::string run(const std::string& file, const std::string& points, std::string& text,
                         bool in_float = false, const std::vector<std::string>& texels = {}) {
    Messages messages;
    const std::string answer = test::jsonOf(evaluate(
        file, "", points, "points.json", in_float ? Engine::Float : Engine::Double, texels, {}, messages));
    text.clear();
    for (const Message& m : messages) {
      if (m.level != Message::Level::Note) text += m.text + "\n";
    }
    return answer;
  }

  static std::string errorOf(const std::string& file, const std::string& points) {
    std::string text;
    EXPECT_EQ(run(file, points, text), "");
    return text;
  }

  std::filesystem::path folder_;
};

TEST_F(Eval, AnswersWhatTheReferenceSays) {
  Random random(21);
  for (int k = 0; k < 40; ++k) {
    const Material m = randomMaterial(random);
    const std::string file = write("m.gltf", gltfOf(m));
    nlohmann::json points = nlohmann::json::array();
    std::vector<Sample> samples;
    for (int i = 0; i < 10; ++i) {
      Sample s = randomSample(random, true);
      s.front_facing = true;
      samples.push_back(s);
      points.push_back(
          {{"n", s.n}, {"t", s.t}, {"v", s.v}, {"l", s.l}, {"light", s.light}, {"color0", s.color0}});
    }
    std::vector<std::string> texels;
    for (const auto& [slot, t] : m.texels) {
      const nlohmann::json numbers = t;
      const std::string list = numbers.dump();
      texels.push_back(slot + "=" + list.substr(1, list.size() - 2));
    }
    for (const bool in_float : {false, true}) {
      std::string text;
      const std::string answer = run(file, points.dump(), text, in_float, texels);
      ASSERT_NE(answer, "") << text;
      const nlohmann::json json = nlohmann::json::parse(answer);
      EXPECT_EQ(json["engine"], in_float ? "float" : "double");
      ASSERT_EQ(json["rgba"].size(), samples.size());
      for (size_t i = 0; i < samples.size(); ++i) {
        const Vec4 expected = reference(m, samples[i]);
        const double scale = std::max({expected[0], expected[1], expected[2]});
        // The light may be anywhere on the lobe's flank: float has what reference_test allows there.
        const double bound = in_float ? 1e-2 : 1e-8;
        for (size_t c = 0; c < 4; ++c) {
          EXPECT_NEAR(json["rgba"][i][c].get<double>(), expected[c], bound * (c < 3 ? scale : 1))
              << gltfOf(m);
        }
      }
    }
  }
}

TEST_F(Eval, DefaultsAndDigits) {
  Material m;
  m.base_color = {1, 1, 1, 0.25};
  m.roughness = 0.5;
  m.blend = true;
  const std::string file = write("m.gltf", gltfOf(m));
  std::string text;
  EXPECT_EQ(run(file, "[{}]", text),
            "{\n  \"material\": \"M\",\n  \"engine\": \"double\",\n  \"profile\": \"khr\",\n  \"rgba\": [\n"
            "    [1.2732395447351628, 1.2732395447351628, 1.2732395447351628, 0.25]\n  ]\n}\n");
  EXPECT_EQ(run(file, "{\"points\": []}", text),
            "{\n  \"material\": \"M\",\n  \"engine\": \"double\",\n  \"profile\": \"khr\",\n  \"rgba\": [\n  "
            "]\n}\n");
  EXPECT_EQ(text, "");
}

TEST_F(Eval, ErrorsOfPointsNameThePlace) {
  const std::string file = write("m.gltf", gltfOf(Material{}));
  EXPECT_EQ(errorOf(file, R"([{"v": [0, 0, 1.5]}])"),
            "points.json:/0/v: error: v has the length 1.5 [not-unit]\n  help: it must be a unit vector, to "
            "a thousandth\n");
  EXPECT_EQ(errorOf(file, R"({"points": [{}, {"l": [0, 1]}]})"),
            "points.json:/points/1/l: error: l is an array [wrong-type]\n  help: it must be an "
            "array of 3 "
            "numbers\n");
  EXPECT_EQ(errorOf(file, R"([{"n": [0, 0, 0]}])"),
            "points.json:/0/n: error: the normal has no length [zero-length]\n  help: any length does, but "
            "for 0\n");
  EXPECT_EQ(
      errorOf(file, R"([{"t": [1, 0, 0, 0.5]}])"),
      "points.json:/0/t/3: error: the tangent's sign is 0.5 [out-of-range]\n  help: it must be 1 or -1\n");
  EXPECT_EQ(errorOf(file, R"([{"light": [1, -1, 0]}])"),
            "points.json:/0/light/1: error: light is -1 [out-of-range]\n  help: it must not be negative\n");
  EXPECT_EQ(errorOf(file, R"([{"UV0": [1, 1]}])"),
            "points.json:/0/UV0: error: a point has no \"UV0\" [unknown-property]\n  help: did you mean "
            "\"uv0\"?\n");
  EXPECT_EQ(errorOf(file, "[1]"),
            "points.json:/0: error: the point is a number [wrong-type]\n  help: it must be an object\n");
  EXPECT_NE(errorOf(file, "[{").find("points.json:1:"), std::string::npos);
  EXPECT_NE(errorOf(file, "[{\"n\": [0, 0, 1e999]}]").find("points.json:"), std::string::npos);
  EXPECT_NE(errorOf(file, "{}").find("wrong-type"), std::string::npos);
}

/// A picture of 2 by 1 pixels, (255, 0, 128) and (0, 255, 0), as a PNG.
const std::string kPicture(
    "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x02"
    "\x00\x00\x00\x01\x08\x02\x00\x00\x00\x7b\x40\xe8\xdd\x00\x00\x00\x0f\x49\x44\x41"
    "\x54\x78\xda\x63\xf8\xcf\xd0\xc0\xf0\x9f\x01\x00\x09\xff\x02\x7f\xb9\xe0\x13\xd8"
    "\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82",
    72);

std::string unlitWith(const std::string& image, const std::string& sampler) {
  return R"({"asset":{"version":"2.0"},"materials":[{"name":"M","pbrMetallicRoughness":{"baseColorTexture":{"index":0}},
    "extensions":{"KHR_materials_unlit":{}}}],"textures":[{"source":0,"sampler":0}],"samplers":[)" +
         sampler + R"(],"images":[)" + image + "]}";
}

Vec3 colorAt(const std::string& answer, size_t point) {
  const nlohmann::json row = nlohmann::json::parse(answer)["rgba"][point];
  return {row[0], row[1], row[2]};
}

TEST_F(Eval, TexturesAreDecodedWrappedAndFiltered) {
  write("a picture.png", kPicture);
  const std::string image = R"({"uri": "a%20picture.png"})";
  std::string text;
  const std::string points =
      R"([{"uv0": [0.25, 0.5]}, {"uv0": [0.5, 0.5]}, {"uv0": [1.25, 9]}, {"uv0": [-0.25, 0]}])";
  const double half = std::pow((128 / 255.0 + 0.055) / 1.055, 2.4);

  std::string answer = run(write("m.gltf", unlitWith(image, "{}")), points, text);
  ASSERT_NE(answer, "") << text;
  EXPECT_NEAR(colorAt(answer, 0)[0], 1, 1e-7);
  EXPECT_NEAR(colorAt(answer, 0)[2], half, 1e-7);
  EXPECT_NEAR(colorAt(answer, 1)[0], 0.5, 1e-7);  // half way, in linear light
  EXPECT_NEAR(colorAt(answer, 1)[2], half / 2, 1e-7);
  EXPECT_NEAR(colorAt(answer, 2)[0], 1, 1e-7);  // repeated
  EXPECT_NEAR(colorAt(answer, 3)[0], 0, 1e-7);

  answer = run(write("c.gltf", unlitWith(image, R"({"wrapS": 33071, "wrapT": 33071})")), points, text);
  EXPECT_NEAR(colorAt(answer, 2)[0], 0, 1e-7);
  EXPECT_NEAR(colorAt(answer, 3)[0], 1, 1e-7);
  answer = run(write("n.gltf", unlitWith(image, R"({"wrapS": 33648, "magFilter": 9728})")), points, text);
  EXPECT_NEAR(colorAt(answer, 1)[0], 0, 1e-7);  // nearest
  EXPECT_NEAR(colorAt(answer, 2)[0], 0, 1e-7);  // mirrored
  EXPECT_NEAR(colorAt(answer, 3)[0], 1, 1e-7);

  // P6 2 1 255\n and the six bytes in base64.
  const std::string data =
      R"({"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR42mP4z9DA8J8BAAn/An+54BPYAAAAAElFTkSuQmCC"})";
  answer = run(write("d.gltf", unlitWith(data, "{}")), points, text);
  ASSERT_NE(answer, "") << text;
  EXPECT_NEAR(colorAt(answer, 0)[2], half, 1e-7);
}

TEST_F(Eval, MissingImagesNameTheSlot) {
  const std::string file = write("m.gltf", unlitWith(R"({"uri": "none.png"})", "{}"));
  EXPECT_NE(errorOf(file, "[{}]").find("baseColorTexture has no image"), std::string::npos);
  EXPECT_NE(errorOf(file, "[{}]").find(":/images/0: error:"), std::string::npos);
  write("none.png", "this is no picture");
  EXPECT_NE(errorOf(file, "[{}]").find("[image-unreadable]"), std::string::npos);
  for (const char* uri : {"/etc/hostname", "http://example.com/a.png", "data:image/png;base64,????", "."}) {
    const std::string other = write("o.gltf", unlitWith("{\"uri\": \"" + std::string(uri) + "\"}", "{}"));
    EXPECT_NE(errorOf(other, "[{}]").find("[image-missing]"), std::string::npos) << uri;
  }
  std::string text;
  for (const char* texel : {"baseColorTexture=0.1,0.2,0.3,1", "base_color_texture=0.1, 0.2, 0.3, 1"}) {
    const std::string answer = run(file, "[{}]", text, false, {texel});
    ASSERT_NE(answer, "") << text;
    EXPECT_EQ(colorAt(answer, 0), (Vec3{0.1, 0.2, 0.3}));
  }
  for (const char* texel :
       {"baseColourTexture=1,1,1,1", "baseColorTexture=1,1,1", "baseColorTexture=1,1,1,1,1",
        "baseColorTexture", "=1,1,1,1", "baseColorTexture=1,1,1,x", "baseColorTexture=1,1,1,inf"}) {
    EXPECT_EQ(run(file, "[{}]", text, false, {texel}), "") << texel;
    EXPECT_NE(text.find("error: "), std::string::npos) << texel;
  }
}

}  // namespace
}  // namespace lacquer::physics::eval_test
