// What looks into images, and what bends normals, against MaterialX's own GLSL on a Vulkan device.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <ostream>
#include <random>
#include <regex>

#include "eval/image.h"
#include "patterns/peer.h"
#include "patterns/run.h"
#include "vulkan/run.h"

namespace lacquer::test::peer_image_test {
namespace {

constexpr size_t kPlaces = 20000;
constexpr size_t kSide = 64;

const vulkan::Device* deviceOfImages() {
  static const Result<vulkan::Device> kDevice = vulkan::Device::open();
  return kDevice ? &*kDevice : nullptr;
}

/// A smooth picture that repeats: neighbours differ by little more than what a filter's weights are off by.
std::vector<vulkan::Texel> smoothTexels() {
  std::vector<vulkan::Texel> texels;
  constexpr double kTurn = 6.283185307179586 / kSide;
  for (size_t y = 0; y < kSide; ++y) {
    for (size_t x = 0; x < kSide; ++x) {
      const double u = kTurn * static_cast<double>(x);
      const double v = kTurn * static_cast<double>(y);
      texels.push_back(
          {static_cast<float>(0.5 + 0.4 * std::sin(u + v)), static_cast<float>(0.5 + 0.4 * std::cos(v)),
           static_cast<float>(0.6 + 0.3 * std::sin(u - v)), static_cast<float>(0.5 + 0.3 * std::cos(u))});
    }
  }
  return texels;
}

eval::Sampler smoothSampler() {
  auto image = std::make_shared<eval::Image>();
  image->width = image->height = kSide;
  image->texels = smoothTexels();
  return eval::makeSampler(image, {});
}

/// Where a vertex value of theirs goes to.
struct Feed {
  const char* theirs;
  const char* ours;
  int components;
  double size;  ///< components are in [-size, size]
  bool unit = false;
};

struct ImageNode {
  const char* name;  ///< of the test
  std::string form;  ///< ours
  std::string xml;   ///< theirs; the node is called n
  const char* type;  ///< theirs
  std::vector<Feed> feeds;
  Arguments arguments;  ///< ours beside those
  bool quads = false;
  const char* height = nullptr;  ///< ours: what is given the sum of the squares of texture coordinates
};

const std::string kFile = "<input name='file' type='filename' value='a.png'/>";
const std::string kPlace =
    "<position name='p' type='vector3'><input name='space' type='string' value='object'/></position>";
const std::string kHeight =
    "<texcoord name='t' type='vector2'/><dotproduct name='h' type='float'><input name='in1' type='vector2' "
    "nodename='t'/><input name='in2' type='vector2' nodename='t'/></dotproduct>";
const Feed kUv{"texcoord_0", "texcoord", 2, 6};
const std::vector<Feed> kFrame = {{"normalWorld", "normal", 3, 1, true},
                                  {"tangentWorld", "tangent", 3, 1, true},
                                  {"bitangentWorld", "bitangent", 3, 1, true}};

std::vector<Feed> with(std::vector<Feed> more) {
  more.insert(more.end(), kFrame.begin(), kFrame.end());
  return more;
}

ImageNode imageNode(const char* name, const std::string& form, const char* type,
                    const std::string& inputs = {}, const Arguments& arguments = {}) {
  const std::string category = form.substr(0, form.find('<'));
  return {name, form,  fmt::format("<{0} name='n' type='{1}'>{2}{3}</{0}>", category, type, kFile, inputs),
          type, {kUv}, arguments};
}

std::vector<ImageNode> imageNodes() {
  const std::string tiling =
      "<input name='uvtiling' type='vector2' value='2, 3'/><input name='uvoffset' type='vector2' value='0.5, "
      "0.25'/><input name='realworldimagesize' type='vector2' value='2, 4'/><input name='realworldtilesize' "
      "type='vector2' value='3, 5'/>";
  const Arguments tiled{{"uvtiling", {2, 3}},
                        {"uvoffset", {0.5, 0.25}},
                        {"realworldimagesize", {2, 4}},
                        {"realworldtilesize", {3, 5}}};
  const auto triplanar = [](const char* name, int up, const char* blend) {
    return ImageNode{
        name,
        "triplanarprojection<vec4>",
        fmt::format("{}<triplanarprojection name='n' type='color4'><input name='filex' type='filename' "
                    "value='a.png'/><input name='filey' type='filename' value='a.png'/><input "
                    "name='filez' type='filename' value='a.png'/><input name='position' type='vector3' "
                    "nodename='p'/><input name='upaxis' type='integer' value='{}'/><input name='blend' "
                    "type='float' value='{}'/></triplanarprojection>",
                    kPlace, up, blend),
        "color4",
        {{"positionObject", "position", 3, 4}, {"normalObject", "normal", 3, 1, true}},
        {{"upaxis", {double(up)}}, {"blend", {std::stod(blend)}}}};
  };
  const std::string from_height = "<input name='in' type='float' nodename='h'/>";
  std::vector<ImageNode> nodes = {
      imageNode("image_float", "image<float>", "float"),
      imageNode("image_vector2", "image<vec2>", "vector2"),
      imageNode("image_color3", "image<vec3>", "color3"),
      imageNode("image_color4", "image<vec4>", "color4"),
      imageNode("tiledimage_float", "tiledimage<float>", "float"),
      imageNode("tiledimage_color3", "tiledimage<vec3>", "color3", tiling, tiled),
      imageNode("tiledimage_vector4", "tiledimage<vec4>", "vector4", tiling, tiled),
      {"latlongimage",
       "latlongimage",
       kPlace + "<latlongimage name='n' type='color3'>" + kFile +
           "<input name='viewdir' type='vector3' nodename='p'/><input name='rotation' type='float' "
           "value='75'/></latlongimage>",
       "color3",
       {{"positionObject", "viewdir", 3, 1, true}},
       {{"rotation", {75}}}},
      triplanar("triplanar_x", 0, "1"),
      triplanar("triplanar_y", 1, "0.4"),
      triplanar("triplanar_z", 2, "0.1"),
      imageNode("hextiledimage_color3", "hextiledimage<vec3>", "color3"),
      imageNode("hextiledimage_color4", "hextiledimage<vec4>", "color4",
                "<input name='tiling' type='vector2' value='1.5, 0.75'/><input name='rotation' type='float' "
                "value='0.5'/><input name='falloff' type='float' value='0.7'/>",
                {{"tiling", {1.5, 0.75}}, {"rotation", {0.5}}, {"falloff", {0.7}}}),
      {"heighttonormal",
       "heighttonormal",
       kHeight + "<heighttonormal name='n' type='vector3'>" + from_height +
           "<input name='scale' type='float' value='3'/></heighttonormal>",
       "vector3",
       {kUv},
       {{"scale", {3}}},
       true,
       "in"},
      {"normalmap",
       "normalmap<float>",
       kPlace + "<normalmap name='n' type='vector3'><input name='in' type='vector3' nodename='p'/><input "
                "name='scale' "
                "type='float' value='0.75'/></normalmap>",
       "vector3",
       with({{"positionObject", "in", 3, 1}}),
       {{"scale", {0.75}}}},
      {"normalmap_vector2",
       "normalmap<vec2>",
       kPlace + "<normalmap name='n' type='vector3'><input name='in' type='vector3' nodename='p'/><input "
                "name='scale' "
                "type='vector2' value='0.5, 2'/></normalmap>",
       "vector3",
       with({{"positionObject", "in", 3, 1}}),
       {{"scale", {0.5, 2}}}},
      {"bump",
       "bump",
       kHeight + "<bump name='n' type='vector3'><input name='height' type='float' nodename='h'/><input "
                 "name='scale' "
                 "type='float' value='0.8'/></bump>",
       "vector3",
       with({kUv}),
       {{"scale", {0.8}}},
       true,
       "height"},
      {"blur",
       "blur<float>",
       kHeight + "<blur name='n' type='float'>" + from_height +
           "<input name='size' type='float' value='0.5'/></blur>",
       "float",
       {kUv},
       {{"size", {0.5}}},
       false,
       "in"},
  };
  return nodes;
}

void PrintTo(const ImageNode& node, std::ostream* out) { *out << node.name; }

class ImagesAsMaterialX : public testing::TestWithParam<ImageNode> {};
INSTANTIATE_TEST_SUITE_P(Peer, ImagesAsMaterialX, testing::ValuesIn(imageNodes()),
                         [](const auto& info) { return std::string(info.param.name); });

/// Vertex values by their names. Quads are steps of a hundredth along both axes; what is a unit vector stays
/// as it is within one.
std::map<std::string, std::vector<float>, std::less<>> someValues(const ImageNode& node) {
  std::mt19937_64 engine(29);
  const auto unit = [&] { return static_cast<double>(engine() >> 11U) * 0x1p-53; };
  std::map<std::string, std::vector<float>, std::less<>> values;
  for (size_t i = 0; i < kPlaces; ++i) {
    for (const Feed& feed : node.feeds) {
      std::vector<float>& all = values[feed.theirs];
      const auto n = static_cast<size_t>(feed.components);
      const bool first = !node.quads || i % 4 == 0;
      std::array<double, 3> made{};
      double length = 0;
      for (size_t c = 0; c < n && first; ++c) {
        made[c] = (2 * unit() - 1) * feed.size;
        length += made[c] * made[c];
      }
      for (size_t c = 0; c < n; ++c) {
        if (first) {
          all.push_back(static_cast<float>(feed.unit ? made[c] / std::sqrt(length) : made[c]));
          continue;
        }
        // Powers of two, so that the difference between neighbours is exact.
        const bool along = (i & (c == 0 ? 1U : 2U)) != 0;
        all.push_back(all[(i - i % 4) * n + c] + (feed.unit || !along ? 0.0F : 0x1p-6F));
      }
    }
  }
  return values;
}

/// Every sampler of a shader of theirs, as the smooth picture.
std::vector<vulkan::Texture> texturesOf(const std::string& glsl) {
  const auto texels = std::make_shared<const std::vector<vulkan::Texel>>(smoothTexels());
  std::vector<vulkan::Texture> textures;
  const std::regex sampler(R"(layout \(binding ?= ?(\d+)\) uniform sampler2D)");
  for (std::sregex_iterator it(glsl.begin(), glsl.end(), sampler), end; it != end; ++it) {
    vulkan::Texture texture;
    texture.image = texture.sampler = {0, static_cast<uint32_t>(std::stoul((*it)[1]))};
    texture.width = texture.height = kSide;
    texture.texels = texels;
    textures.push_back(texture);
  }
  return textures;
}

TEST_P(ImagesAsMaterialX, GiveTheSameNumbers) {
  if (!peerFolder()) GTEST_SKIP() << "NOT TESTED: there is no MaterialX (LACQUER_MATERIALX), or no node.js";
  if (deviceOfImages() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const ImageNode& node = GetParam();
  const PeerShader peer = peerShader(node.xml, node.type, false);
  const auto values = someValues(node);
  vulkan::Work work;
  work.fragment = peerWords(peer.glsl);
  work.points = kPlaces;
  work.quads = node.quads;
  work.textures = texturesOf(peer.glsl);
  for (const std::string& input : peer.inputs) {
    const auto found = values.find(input);
    ASSERT_NE(found, values.end()) << input << " is no feed";
    work.inputs.push_back({static_cast<uint32_t>(found->second.size() / kPlaces), found->second});
  }
  const auto outcome = deviceOfImages()->run(work);
  ASSERT_TRUE(outcome) << format(outcome.error().at(0));
  Arguments arguments = node.arguments;
  const auto uv = values.find("texcoord_0");
  for (const Feed& feed : node.feeds) {
    const std::vector<float>& all = values.find(feed.theirs)->second;
    const bool asked = std::string_view(feed.theirs) != kUv.theirs || node.height == nullptr || node.quads;
    if (asked) arguments[feed.ours] = {all.begin(), all.end()};
  }
  if (node.height != nullptr) {
    std::vector<double>& heights = arguments[node.height];
    for (size_t i = 0; i < kPlaces; ++i) {
      const float u = uv->second[2 * i];
      const float v = uv->second[2 * i + 1];
      heights.push_back(u * u + v * v);
    }
  }
  const std::vector<float> ours =
      runNode<float>(node.form, arguments, kPlaces, {}, node.quads, smoothSampler())[0];
  const size_t channels = ours.size() / kPlaces;
  double farthest = 0;
  for (size_t i = 0; i < ours.size(); ++i) {
    const double off = std::abs(ours[i] - outcome->outputs[0][i / channels * 4 + i % channels]);
    farthest = std::isnan(off) ? std::numeric_limits<double>::infinity() : std::max(farthest, off);
  }
  std::cout << node.name << ": within " << farthest << " at " << kPlaces << " places\n";
  // A filter's weights have the device's bits.
  EXPECT_LT(farthest, 5e-4);
}

}  // namespace
}  // namespace lacquer::test::peer_image_test
