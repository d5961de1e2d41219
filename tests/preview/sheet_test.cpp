// Contact sheets of real and of small files, as the public function makes them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "eval/image.h"
#include "lacquer.h"
#include "preview/canvas.h"
#include "preview/sheet.h"
#include "support/answers.h"
#include "support/cases.h"
#include "support/limits.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path scratch() {
  const fs::path folder = fs::path(testing::TempDir()) / "lacquer_preview";
  fs::create_directories(folder);
  return folder;
}

std::string write(const std::string& name, const json& gltf) {
  const fs::path path = scratch() / name;
  std::ofstream(path) << gltf.dump();
  return path.string();
}

json fileOf(json materials) { return {{"asset", {{"version", "2.0"}}}, {"materials", std::move(materials)}}; }

struct Made {
  std::string answer, png;
  Messages messages;
  eval::Image image;
};

Made make(const std::vector<std::string>& files, Preview preview, const std::vector<std::string>& only = {},
          const Options& options = Options()) {
  Made made;
  preview.output = (scratch() / "sheet.png").string();
  fs::remove(preview.output);
  made.answer = jsonOf(drawPreview(preview, files, only, options, made.messages));
  if (!fs::exists(preview.output)) return made;
  made.png = readFile(preview.output);
  if (auto image = eval::decodeImage(made.png, Limits{}.image, {})) made.image = std::move(*image);
  return made;
}

/// The codes of a pixel.
std::array<int, 3> pixel(const eval::Image& image, int x, int y) {
  std::array<int, 3> result{};
  for (size_t c = 0; c < 3; ++c)
    result[c] = static_cast<int>(std::lround(image.at(static_cast<size_t>(y * image.width + x))[c] * 255));
  return result;
}

// Of a sheet's first ball of 32 pixels: the margin and half of the gap before it, then its middle.
constexpr int kFirst = 24;
constexpr int kTop = 16;
Preview small() {
  Preview preview;
  preview.size = 32;
  return preview;
}

TEST(Sheet, IsTheSameForEveryNumberOfThreads) {
  const std::string file = (sourceFolder() / "examples/car_paint.gltf").string();
  Options one;
  one.jobs = 1;
  Options four;
  four.jobs = 4;
  Preview preview = small();
  preview.compare = {"float", "double"};
  const Made a = make({file}, preview, {}, one);
  const Made b = make({file}, preview, {}, four);
  ASSERT_FALSE(a.png.empty());
  EXPECT_EQ(a.png, b.png);
  EXPECT_EQ(a.answer, b.answer);
}

TEST(Sheet, ShowsAnUnlitColourAsItIs) {
  const std::string file =
      write("unlit.gltf", fileOf({{{"name", "Flat"},
                                   {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.3, 0.2, 1}}}},
                                   {"extensions", {{"KHR_materials_unlit", json::object()}}}}}));
  const Made made = make({file}, small());
  ASSERT_FALSE(made.png.empty());
  const auto shown = pixel(made.image, kFirst + 16, kTop + 16);
  const std::array<double, 3> mapped = preview::toneMap({0.5, 0.3, 0.2});
  for (size_t c = 0; c < 3; ++c) EXPECT_EQ(shown[c], preview::encodeSrgb(mapped[c])) << c;
  const auto corner = pixel(made.image, kFirst, kTop);
  for (size_t c = 0; c < 3; ++c) EXPECT_EQ(corner[c], preview::kBackground[c]);
}

/// The ball lies in space: a pattern by the position has many values on it.
TEST(Sheet, PositionsAreThoseOfABall) {
  const std::string file = write(
      "place.gltf", fileOf({{{"name", "Place"}, {"extensions", {{"EXAMPLE_place", {{"placeFactor", 1}}}}}}}));
  const fs::path nodes = scratch() / "place";
  fs::create_directories(nodes);
  std::ofstream(nodes / "place.node") << R"(
/// E.
/// source: E
extension EXAMPLE_place { float placeFactor in [0, 1] = 0; }

/// E.
part place of EXAMPLE_place over base unless placeFactor == 0 {
surface:
    place.color = color_of_place(position);
    out base_color = place.color;
    out emission = place.color.rgb;
}

/// The position as a colour.
/// source: E
node color_of_place(vec3 place) -> vec4 in [0, 1] {
    return vec4(clamp(place * 0.5 + vec3(0.5), vec3(0), vec3(1)), 1);
}
)";
  Options options;
  options.node_directories = {nodes.string()};
  const Made made = make({file}, small(), {}, options);
  ASSERT_FALSE(made.png.empty()) << (made.messages.empty() ? "" : made.messages[0].text);
  const auto left = pixel(made.image, kFirst + 3, kTop + 16),
             right = pixel(made.image, kFirst + 28, kTop + 16);
  const auto top = pixel(made.image, kFirst + 16, kTop + 3),
             bottom = pixel(made.image, kFirst + 16, kTop + 28);
  EXPECT_GT(right[0], left[0] + 20);
  EXPECT_GT(top[1], bottom[1] + 20);
}

/// What comes from the vertices of an attribute has its name, and fewer components.
TEST(Sheet, ATangentInTheObjectIsDrawn) {
  const std::string file = (scratch() / "tangent.mtlx").string();
  std::ofstream(file) << R"(<materialx version="1.39">
  <nodegraph name="G">
    <tangent name="t" type="vector3"/>
    <absval name="a" type="vector3"><input name="in" type="vector3" nodename="t"/></absval>
    <convert name="c" type="color3"><input name="in" type="vector3" nodename="a"/></convert>
    <output name="out" type="color3" nodename="c"/>
  </nodegraph>
</materialx>)";
  const Made made = make({file}, small());
  ASSERT_FALSE(made.png.empty()) << (made.messages.empty() ? "" : made.messages[0].text);
  // Straight ahead it points along x, at the sides more and more along z.
  const auto middle = pixel(made.image, kFirst + 16, kTop + 16),
             right = pixel(made.image, kFirst + 27, kTop + 16);
  EXPECT_GT(middle[0], middle[2] + 50);
  EXPECT_GT(right[2], middle[2] + 50);
}

TEST(Sheet, EdgesAreShadesBetweenBallAndBackground) {
  const std::string file =
      write("white.gltf", fileOf({{{"extensions", {{"KHR_materials_unlit", json::object()}}}}}));
  const Made made = make({file}, small());
  ASSERT_FALSE(made.png.empty());
  std::set<int> shades;
  for (int i = 0; i < 32; ++i) {
    for (int j = 0; j < 32; ++j) shades.insert(pixel(made.image, kFirst + i, kTop + j)[0]);
  }
  EXPECT_GE(shades.size(), 8U);
}

TEST(Sheet, TransparentBallsShowTheBoardBehind) {
  const auto material = [](const char* mode, double alpha) {
    return fileOf({{{"alphaMode", mode},
                    {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, alpha}}}},
                    {"extensions", {{"KHR_materials_unlit", json::object()}}}}});
  };
  const int left = preview::encodeSrgb(0.18);
  const int right = preview::encodeSrgb(0.36);
  for (const auto& [mode, alpha, seen] : {std::tuple{"BLEND", 0.0, true},
                                          {"MASK", 0.25, true},
                                          {"MASK", 0.75, false},
                                          {"OPAQUE", 0.0, false}}) {
    SCOPED_TRACE(mode);
    const Made made = make({write("alpha.gltf", material(mode, alpha))}, small());
    ASSERT_FALSE(made.png.empty());
    const int a = pixel(made.image, kFirst + 17, kTop + 17)[0];
    const int b = pixel(made.image, kFirst + 21, kTop + 17)[0];
    EXPECT_EQ(a, seen ? left : 0);
    EXPECT_EQ(b, seen ? right : 0);
  }
}

TEST(Sheet, ComparesTwoSettings) {
  const std::string file = (sourceFolder() / "examples/coat.gltf").string();
  Preview preview = small();
  const auto measured = [&](const std::string& a, const std::string& b) {
    preview.compare = {a, b};
    const Made made = make({file}, preview, {"Absorption"});
    EXPECT_FALSE(made.answer.empty()) << (made.messages.empty() ? "" : made.messages[0].text);
    return made.answer.empty() ? json() : json::parse(made.answer)["differences"][0];
  };
  EXPECT_EQ(measured("float", "as-given")["max"], 0.0);
  const json rounding = measured("float", "double");
  EXPECT_GT(rounding["mean"], 1e-10);
  EXPECT_LT(rounding["mean"], 1e-4);
  EXPECT_LE(rounding["mean"], rounding["rms"]);
  EXPECT_LE(rounding["rms"], rounding["max"]);
  EXPECT_GT(measured("float", "no-multiple-scattering")["mean"], 3e-6);
  EXPECT_GT(measured("baked+no-ibl", "baked")["mean"], 1e-2);
  EXPECT_LT(measured("uniform", "baked")["mean"], 1e-5);
}

TEST(Sheet, AbsentImagesAreNeutralAndNoted) {
  const json texture = {{"index", 0}};
  json gltf = fileOf({{{"name", "Bare"},
                       {"normalTexture", texture},
                       {"pbrMetallicRoughness", {{"baseColorTexture", texture}}}},
                      {{"name", "Plain"}}});
  gltf["textures"] = {{{"source", 0}}};
  gltf["images"] = {{{"uri", "absent.png"}}};
  const Made made = make({write("absent.gltf", gltf)}, small());
  ASSERT_FALSE(made.png.empty());
  ASSERT_EQ(made.messages.size(), 1U);
  EXPECT_EQ(made.messages[0].level, Message::Level::Note);
  EXPECT_EQ(made.messages[0].code, "image-missing");
  EXPECT_EQ(made.messages[0].pointer, "/materials/0");
  for (const int x : {10, 16, 22}) {
    EXPECT_EQ(pixel(made.image, kFirst + x, kTop + 14), pixel(made.image, kFirst + 32 + 16 + x, kTop + 14));
  }
  Preview tinted = small();
  tinted.texels = {"baseColorTexture=1,0,0,1"};
  const Made red = make({write("absent.gltf", gltf)}, tinted, {"Bare"});
  ASSERT_FALSE(red.png.empty());
  EXPECT_LT(pixel(red.image, kFirst + 16, kTop + 16)[1] + 40, pixel(red.image, kFirst + 16, kTop + 16)[0]);
}

TEST(Sheet, SaysWhatIsWrong) {
  const std::string file = (sourceFolder() / "examples/clearcoat.gltf").string();
  const auto code = [&](Preview preview, const std::vector<std::string>& files,
                        const std::vector<std::string>& only = {}) {
    const Made made = make(files, preview, only);
    EXPECT_TRUE(made.answer.empty());
    EXPECT_TRUE(made.png.empty());
    return made.messages.empty() ? std::string() : made.messages[0].code;
  };
  Preview unknown = small();
  unknown.compare = {"float", "doubl"};
  EXPECT_EQ(code(unknown, {file}), "unknown-setting");
  unknown.compare = {"float", ""};
  EXPECT_EQ(code(unknown, {file}), "unknown-setting");
  unknown.compare = {"as-given", "baked+vertex:base.indirect"};
  EXPECT_EQ(code(unknown, {file}), "no-triangles");
  EXPECT_EQ(code(small(), {file}, {"Nothing"}), "no-such-material");
  EXPECT_EQ(code(small(), {(scratch() / "nowhere.gltf").string()}), "file-unreadable");
  EXPECT_EQ(code(small(), {write("empty.gltf", fileOf(json::array()))}), "nothing-to-show");
  Preview tiny = small();
  tiny.size = 2;
  EXPECT_EQ(code(tiny, {file}), "out-of-range");
  Preview texel = small();
  texel.texels = {"baseColorTexture=1"};
  EXPECT_EQ(code(texel, {file}), "bad-texel");
}

TEST(Sheet, AFileThatFailsDoesNotStopTheOthers) {
  const std::string good = (sourceFolder() / "examples/clearcoat_tint.gltf").string();
  const Made made = make({(scratch() / "nowhere.gltf").string(), good}, small());
  EXPECT_FALSE(made.png.empty());
  EXPECT_TRUE(hasError(made.messages));
  EXPECT_EQ(json::parse(made.answer)["materials"], 2);
}

TEST(Sheet, LayoutLeavesFewPlacesEmpty) {
  using preview::Cell;
  using preview::Picture;
  for (const size_t cells : {1U, 3U, 8U, 24U, 56U, 97U}) {
    preview::Section section{"", {}};
    for (size_t i = 0; i < cells; ++i) section.cells.push_back({"x", {}, {Picture(16, 16, {255, 0, 0})}});
    const auto sheet = preview::layOut({section}, "", 16, 0);
    ASSERT_TRUE(sheet);
    const size_t columns = (sheet->width() - 32) / 32;
    EXPECT_LE(columns, 10U);
    size_t red = 0;
    for (uint32_t y = 0; y < sheet->height(); ++y) {
      for (uint32_t x = 0; x < sheet->width(); ++x)
        red += sheet->at(x, y) == preview::Color{255, 0, 0} ? 1 : 0;
    }
    EXPECT_EQ(red, cells * 256) << "pictures overlap or are cut";
    if (cells == 24 || cells == 56) {
      EXPECT_EQ(cells % columns, 0U) << columns;
    }
  }
  preview::Section huge{"", std::vector<Cell>(100000, Cell{"x", {}, {}})};
  const auto sheet = preview::layOut({huge}, "", 2048, 1);
  ASSERT_FALSE(sheet);
  EXPECT_EQ(sheet.error()[0].code, "sheet-too-large");
}

}  // namespace
}  // namespace lacquer::test
