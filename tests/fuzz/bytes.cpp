// Inputs that no file need stand behind: images, geometry, points, SPIR-V.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "check/check.h"
#include "check/reflect.h"
#include "cost/cost.h"
#include "environment/panorama.h"
#include "eval/image.h"
#include "eval/points_file.h"
#include "feeds.h"
#include "gltf/geometry.h"
#include "vulkan/passthrough.h"

namespace lacquer::fuzz {

namespace {

/// Few, since an image of as many takes a hundredth of a second.
constexpr uint64_t kMostPixels = uint64_t{1} << 16;

bool isUnit(const std::array<double, 3>& a) {
  return std::abs(std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) - 1) < 1e-9;
}

template <size_t N>
bool allFinite(const std::array<float, N>& a) {
  return std::all_of(a.begin(), a.end(), [](float x) { return std::isfinite(x); });
}

/// What gltf/geometry.h says of a corner; empty when it is so.
std::string wrongWith(const gltf::Corner& corner) {
  for (const float x : corner.position) {
    if (!(std::abs(static_cast<double>(x)) <= 1e15)) return "a position is no number, or too far away";
  }
  const auto lengthOf = [](const auto& a) {
    return std::hypot(static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2]));
  };
  if (!(std::abs(lengthOf(corner.normal) - 1) < 1e-5)) return "a normal is no unit vector";
  if (!(std::abs(lengthOf(corner.tangent) - 1) < 1e-5)) return "a tangent is no unit vector";
  if (std::abs(corner.tangent[3]) != 1) return "a tangent's sign is none";
  if (!allFinite(corner.color)) return "a colour is not finite";
  for (const auto& uv : corner.uv) {
    if (!allFinite(uv)) return "a texture coordinate is not finite";
  }
  return {};
}

}  // namespace

std::string feedImage(std::string_view bytes) {
  Result<eval::Image> image = eval::decodeImage(bytes, kMostPixels, {"fuzz.png", 0, 0, {}});
  if (!image) return image.error().empty() ? "an image is refused without an error" : "";
  if (image->size() > kMostPixels) return "an image is larger than it may be";
  const auto shared = std::make_shared<const eval::Image>(std::move(*image));
  for (const eval::Wrap wrap : {eval::Wrap::Repeat, eval::Wrap::Clamp, eval::Wrap::Mirror}) {
    const eval::Sampler sampler = eval::makeSampler(shared, {wrap, wrap, false, true});
    for (const double at : {0.0, 0.999999, -1e9, 1e300}) {
      for (const double x : sampler(0, {at, -at, 0}, 0)) {
        if (!(x >= 0 && x <= 1)) return "a texel is not in [0, 1]";
      }
    }
  }
  return {};
}

std::string feedPanorama(std::string_view bytes) {
  Diagnostics warnings;
  const Result<environment::Panorama> panorama =
      environment::readPanorama(bytes, kMostPixels, {"fuzz.hdr", 0, 0, {}}, warnings);
  if (!panorama) return panorama.error().empty() ? "a picture is refused without an error" : "";
  if (panorama->texels.size() > kMostPixels) return "a picture is larger than it may be";
  if (panorama->texels.size() != size_t{panorama->width} * panorama->height) return "pixels are missing";
  for (const environment::Rgb& color : panorama->texels) {
    for (const float x : color) {
      if (!(x >= 0 && x <= 65408)) return "radiance is not finite, or negative";
    }
  }
  return {};
}

std::string feedGeometry(std::string_view bytes) {
  const auto file = gltf::TextureFile::fromMemory(bytes, "fuzz.gltf", {});
  if (!file) return file.error().empty() ? "a file is refused without an error" : "";
  for (size_t material = 0; material < 3; ++material) {
    const gltf::Geometry geometry = gltf::geometryOf(*file, material);
    const std::vector<uint32_t>& indices = geometry.triangles;
    if (geometry.corners.size() > gltf::kMostCorners || indices.size() > 3 * gltf::kMostTriangles)
      return "more is read than is read at most";
    if (indices.size() % 3 != 0) return "a triangle has not got three corners";
    for (const uint32_t index : indices) {
      if (index >= geometry.corners.size()) return "a triangle has a corner that is not there";
    }
    for (const gltf::Corner& corner : geometry.corners) {
      if (std::string wrong = wrongWith(corner); !wrong.empty()) return wrong;
    }
  }
  return {};
}

std::string feedPoints(std::string_view bytes) {
  const Result<EvalPoints> points = readPoints(bytes, "fuzz.json", {});
  if (!points) return points.error().empty() ? "points are refused without an error" : "";
  for (const eval::Point& p : points->points) {
    if (!isUnit(p.n) || !isUnit(p.v) || !isUnit(p.l)) return "a direction of a point is no unit vector";
    for (const double x : p.light) {
      if (!(std::isfinite(x) && x >= 0)) return "a point's light is not finite, or negative";
    }
  }
  return {};
}

/// What `cost` does with a module before a driver, in a process of its own, is given it.
std::string feedSpirv(std::string_view bytes) {
  std::vector<uint32_t> words(bytes.size() / 4);
  if (!words.empty()) std::memcpy(words.data(), bytes.data(), 4 * words.size());
  const size_t counted = cost::spirvInstructions(words);
  if (counted > words.size()) return "more instructions than words";
  (void)check::checkSlots(words, words.size() % 2 == 0, "fuzz.spv");
  (void)check::reflectBlocks(words);
  const Result<check::Interface> vertex = check::reflect(words, check::Stage::Vertex);
  if (!vertex && vertex.error().empty()) return "a module is refused without an error";
  const Result<check::Interface> fragment = check::reflect(words, check::Stage::Fragment);
  if (fragment) (void)vulkan::passthroughVertex(*fragment);
  // The validator is another's, and takes ten times as long.
  const bool sound = counted % 8 == 0 && check::validate(words, false, "fuzz.spv").empty();
  if (sound && !vertex && !fragment) return "a valid module has no stage that is read";
  return {};
}

}  // namespace lacquer::fuzz
