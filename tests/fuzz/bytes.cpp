// Inputs that no file need stand behind: images, geometry, points, SPIR-V.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "check/check.h"
#include "check/reflect.h"
#include "cost/cost.h"
#include "environment/surroundings.h"
#include "eval/image.h"
#include "eval/point_arrays.h"
#include "eval/points_file.h"
#include "feeds.h"
#include "gltf/geometry.h"
#include "photometry/distribution.h"
#include "support/packed_walk.h"
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
  Limits limits;
  limits.image = kMostPixels;
  // A text is the JSON of a .gltf.
  const std::string name = bytes.starts_with('{') ? "fuzz.gltf" : "fuzz.hdr";
  const Result<environment::Surroundings> surroundings =
      environment::readSurroundings(bytes, name, true, {limits, {}, -1}, warnings);
  if (!surroundings) return surroundings.error().empty() ? "a picture is refused without an error" : "";
  const auto* panorama = std::get_if<environment::Panorama>(&surroundings->picture);
  const auto* cube = std::get_if<texture::CubeLevel>(&surroundings->picture);
  const auto& texels = panorama != nullptr ? panorama->texels : cube->texels;
  if (texels.size() > kMostPixels) return "a picture is larger than it may be";
  const size_t pixels =
      panorama != nullptr ? size_t{panorama->width} * panorama->height : size_t{6} * cube->size * cube->size;
  if (texels.size() != pixels) return "pixels are missing";
  for (const environment::Rgb& color : texels) {
    for (const float x : color) {
      if (!(x >= 0 && x <= 65408)) return "radiance is not finite, or negative";
    }
  }
  return {};
}

std::string feedIes(std::string_view bytes) {
  Diagnostics warnings;
  const auto measured = photometry::readLm63(bytes, {"fuzz.ies", 0, 0, {}}, warnings);
  if (!measured) return measured.error().empty() ? "a profile is refused without an error" : "";
  if (measured->candela.size() != measured->vertical.size() * measured->horizontal.size())
    return "values are missing";
  const photometry::Distribution distribution(*measured);
  const double peak = distribution.peak(), lumens = distribution.lumens();
  if (!(peak >= 0 && peak <= photometry::kMostCandela)) return "the peak is not in its range";
  if (!(lumens >= -1e-6 * peak && lumens <= 4 * M_PI * 1.000001 * peak))
    return "there is more light than the peak gives";
  for (size_t i = 0; i < std::min<size_t>(distribution.nodes(), 1000); ++i) {
    const double at = distribution.at(distribution.node(i));
    if (!(at >= 0 && at <= peak * 1.000001)) return "the light is not between 0 and the peak";
  }
  const photometry::Table table = photometry::tableOf(distribution, 16, 8);
  for (const float x : table.texels) {
    if (!(x >= 0 && x <= 1)) return "a texel is not in [0, 1]";
  }
  const double error = photometry::errorsOf(table, distribution).most;
  return error >= 0 && error <= 1.000001 ? "" : "the table's error is none";
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

namespace {

std::string checkPoints(const Result<EvalPoints>& points) {
  if (!points) return points.error().empty() ? "points are refused without an error" : "";
  const size_t count = points->points.count;
  for (const auto& [name, column] : points->points.columns) {
    const auto components = static_cast<size_t>(column.components);
    if (column.values.size() != (column.per_point ? count : 1) * components)
      return "a column has another length than the points";
    for (size_t i = 0; i < column.values.size(); i += components) {
      const double* x = &column.values[i];
      const bool direction = name == "n" || name == "v" || name == "l";
      if (direction && !isUnit({x[0], x[1], x[2]})) return "a direction of a point is no unit vector";
      if (name == "light" && !std::all_of(x, x + 3, [](double y) { return std::isfinite(y) && y >= 0; }))
        return "a point's light is not finite, or negative";
    }
  }
  return {};
}

}  // namespace

/// As a text, and as arrays that lie anywhere in the bytes.
std::string feedPoints(std::string_view bytes) {
  if (std::string wrong = checkPoints(readPoints(bytes, "fuzz.json", {})); !wrong.empty()) return wrong;
  constexpr const char* kNames[] = {
      "n",   "t",      "v",        "l",       "uv1",  "color0",           "light",
      "env", "inside", "position", "COLOR_1", "_OWN", "frame.brightness", "coat_factor",
      "",    "channel"};
  constexpr size_t kMost = 5 * sizeof(double);
  PointArrays arrays;
  for (size_t at = 0; at + 3 + kMost <= bytes.size() && arrays.arrays.size() < 6; at += 3) {
    const auto byte = [&](size_t k) { return static_cast<unsigned char>(bytes[at + k]); };
    arrays.arrays.push_back({kNames[byte(0) % 16], bytes.data() + at + 3, byte(1) % 2 != 0, byte(1) / 2 % 6U,
                             static_cast<ptrdiff_t>(byte(2) % 48)});
  }
  for (const PointArray& array : arrays.arrays) {
    const size_t room =
        bytes.size() - static_cast<size_t>(static_cast<const char*>(array.numbers) - bytes.data());
    const size_t fits = array.stride == 0 ? room : (room - kMost) / static_cast<size_t>(array.stride) + 1;
    arrays.count = arrays.count == 0 ? fits : std::min(arrays.count, fits);
  }
  return checkPoints(pointsOf(arrays, 0, arrays.count));
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

/// Two walks read the same: what is outside of the bytes would differ between their copies.
std::string feedPacked(std::string_view bytes) {
  const test::PackedFile one(bytes);
  const test::PackedFile other(bytes);
  return test::PackedWalk(one).sum() == test::PackedWalk(other).sum() ? "" : "two walks read something else";
}

}  // namespace lacquer::fuzz
