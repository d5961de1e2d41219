#include "eval/points_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "graph/graph.h"
#include "json/report.h"
#include "setting/messages.h"
#include "support/text.h"

namespace lacquer {

namespace {

using json::Json;
using json::Path;
using Vec3 = std::array<double, 3>;

constexpr std::string_view kKeys[] = {"n",
                                      "t",
                                      "v",
                                      "l",
                                      "uv0",
                                      "uv1",
                                      "uv2",
                                      "uv3",
                                      "color0",
                                      "light",
                                      "env",
                                      "position",
                                      "front_facing",
                                      "inside",
                                      "surrounding_ior",
                                      "channel",
                                      "random"};

double length(const Vec3& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

bool hasDirection(const Vec3& a) {
  return length(a) > eval::kShortestDirection && length(a) < eval::kLongestDirection;
}

Vec3 unit(const Vec3& a) {
  const double l = length(a);
  return {a[0] / l, a[1] / l, a[2] / l};
}

class PointReader {
public:
  PointReader(const std::string& file, Diagnostics& diagnostics) : report_(file, diagnostics) {}

  void read(const Json& json, const Path& path, EvalPoints& to) {
    eval::Point point;
    Vec3 environment{};
    if (!json.is_object()) return report_.wrongType(path, "the point", json, "an object");
    for (const auto& [key, value] : json.items()) {
      const Path here(path, key);
      if (std::find(std::begin(kKeys), std::end(kKeys), key) != std::end(kKeys)) continue;
      if (graph::isAttributeName(key)) {
        attribute(value, here, key, point, to);
        continue;
      }
      const std::string_view close = closest(key, kKeys);
      report_.error("unknown-property", here, fmt::format("a point has no {}", quote(key)),
                    close.empty() ? fmt::format("it has {}", listOf(kKeys))
                                  : fmt::format("did you mean \"{}\"?", close));
    }
    if (vector(json, path, "n", point.n) && !hasDirection(point.n)) {
      report_.error("zero-length", Path(path, "n"), "the normal has no length", "any length does, but for 0");
      point.n = {0, 0, 1};
    }
    point.n = unit(point.n);
    tangent(json, path, point);
    direction(json, path, "v", point.n, point.v);
    direction(json, path, "l", point.n, point.l);
    constexpr const char* kUv[] = {"uv0", "uv1", "uv2", "uv3"};
    for (size_t i = 0; i < 4; ++i) vector(json, path, kUv[i], point.uv[i]);
    color(json, path, point.color0);
    if (vector(json, path, "light", point.light)) notNegative(path, "light", point.light);
    if (vector(json, path, "env", environment)) {
      notNegative(path, "env", environment);
      to.has_environment = true;
    }
    vector(json, path, "position", point.position);
    flag(json, path, "front_facing", point.front_facing);
    flag(json, path, "inside", point.inside);
    number(json, path, "surrounding_ior", point.surrounding_ior);
    number(json, path, "channel", point.channel);
    vector(json, path, "random", point.random);
    points_.push_back(std::move(point));
    to.environment.push_back(environment);
  }

  std::span<const eval::Point> points() const { return points_; }

private:
  bool numbers(const Json& json, const Path& path, std::string_view name, std::span<double> to) {
    const std::string expected = fmt::format("an array of {} numbers", to.size());
    const bool fits = json.is_array() && json.size() == to.size() &&
                      std::all_of(json.begin(), json.end(), [](const Json& x) { return x.is_number(); });
    if (!fits) {
      report_.wrongType(path, name, json, expected);
      return false;
    }
    for (size_t i = 0; i < to.size(); ++i) {
      to[i] = json[i].get<double>();
      if (std::isfinite(to[i])) continue;
      report_.error("not-finite", Path(path, i), fmt::format("{} is not finite", name));
      return false;
    }
    return true;
  }

  /// True when the member is there and good.
  template <size_t N>
  bool vector(const Json& point, const Path& path, std::string_view name, std::array<double, N>& to) {
    const Json* json = json::member(point, name);
    std::array<double, N> value{};
    if (json == nullptr || !numbers(*json, Path(path, name), name, value)) return false;
    to = value;
    return true;
  }

  /// A number, two to four of them, or those of a matrix column by column.
  void attribute(const Json& json, const Path& path, const std::string& name, eval::Point& to,
                 EvalPoints& all) {
    constexpr std::string_view kExpected = "a number or an array of 2 to 4 numbers, of a matrix 9 or 16";
    if (json.is_boolean()) return report_.wrongType(path, name, json, kExpected);
    const Json list = json.is_array() ? json : Json::array({json});
    std::array<double, 16> value{0, 0, 0, 1};
    const size_t side = matrixSide(list.size());
    if (list.size() < 1 || (list.size() > 4 && side == 0))
      return report_.wrongType(path, name, json, kExpected);
    if (!numbers(list, path, name, {value.data(), list.size()})) return;
    const auto place = [&](const std::string& as, const double* from, size_t count) {
      std::array<double, 4>& column = to.attributes[as] = {0, 0, 0, 1};
      std::copy_n(from, count, column.begin());
      const auto [known, first] = all.attribute_components.emplace(as, static_cast<int>(count));
      if (first || known->second == static_cast<int>(count)) return;
      report_.error("wrong-type", path,
                    fmt::format("{} is given {} numbers, and {} before", as, count, known->second),
                    "an attribute has one type");
    };
    if (side == 0) return place(name, value.data(), list.size());
    all.matrices.insert(name);
    for (size_t c = 0; c < side; ++c)
      place(graph::columnName(name, static_cast<int>(c)), &value[c * side], side);
  }

  void flag(const Json& point, const Path& path, std::string_view name, bool& to) {
    const Json* json = json::member(point, name);
    if (json == nullptr) return;
    if (json->is_boolean())
      to = json->get<bool>();
    else
      report_.wrongType(Path(path, name), name, *json, "true or false");
  }

  void number(const Json& point, const Path& path, std::string_view name, double& to) {
    const Json* json = json::member(point, name);
    if (json == nullptr) return;
    if (!json->is_number()) return report_.wrongType(Path(path, name), name, *json, "a number");
    if (const double value = json->get<double>(); std::isfinite(value)) return void(to = value);
    report_.error("not-finite", Path(path, name), fmt::format("{} is not finite", name));
  }

  void direction(const Json& point, const Path& path, std::string_view name, const Vec3& missing, Vec3& to) {
    to = missing;
    if (!vector(point, path, name, to)) return;
    const double l = length(to);
    if (std::abs(l - 1) <= eval::kUnitTolerance) {
      to = unit(to);
      return;
    }
    report_.error("not-unit", Path(path, name), fmt::format("{} has the length {:.6g}", name, l),
                  "it must be a unit vector, to a thousandth");
    to = missing;
  }

  void tangent(const Json& point, const Path& path, eval::Point& to) {
    const Vec3 any = eval::across(to.n);
    to.t = {any[0], any[1], any[2], 1};
    std::array<double, 4> t{};
    if (!vector(point, path, "t", t)) return;
    const Path here(path, "t");
    if (!hasDirection({t[0], t[1], t[2]})) {
      return report_.error("zero-length", here, "the tangent has no length", "any length does, but for 0");
    }
    if (std::abs(t[3]) != 1) {
      return report_.error("out-of-range", Path(here, 3), fmt::format("the tangent's sign is {}", t[3]),
                           "it must be 1 or -1");
    }
    const Vec3 direction = unit({t[0], t[1], t[2]});
    to.t = {direction[0], direction[1], direction[2], t[3]};
  }

  /// Three or four numbers; alpha is 1 where it is not given.
  void color(const Json& point, const Path& path, std::array<double, 4>& to) {
    const Json* json = json::member(point, "color0");
    if (json == nullptr) return;
    const Path here(path, "color0");
    const size_t count = json->is_array() && json->size() == 3 ? 3 : 4;
    std::array<double, 4> value{1, 1, 1, 1};
    if (!numbers(*json, here, "color0", {value.data(), count})) return;
    for (size_t i = 0; i < count; ++i) {
      if (value[i] >= 0 && value[i] <= 1) continue;
      return report_.error("out-of-range", Path(here, i), fmt::format("color0 is {}", value[i]),
                           "it must be in [0, 1]");
    }
    to = value;
  }

  void notNegative(const Path& path, std::string_view name, Vec3& value) {
    const Path here(path, name);
    for (size_t i = 0; i < 3; ++i) {
      if (value[i] >= 0) continue;
      report_.error("out-of-range", Path(here, i), fmt::format("{} is {}", name, value[i]),
                    "it must not be negative");
      value[i] = 0;
    }
  }

  json::Report report_;
  std::vector<eval::Point> points_;
};

/// The object "uniforms" beside "points": a number, or an array of them, by field.
void readUniforms(const Json& root, json::Report& report, EvalPoints& to) {
  const Json* uniforms = json::member(root, "uniforms");
  if (uniforms == nullptr) return;
  const Path top;
  const Path path(top, "uniforms");
  if (!uniforms->is_object()) return report.wrongType(path, "uniforms", *uniforms, "an object");
  for (const auto& [name, value] : uniforms->items()) {
    const Json list = value.is_array() ? value : Json::array({value});
    for (const Json& x : json::elements(list)) {
      if (x.is_number() && std::isfinite(x.get<double>())) {
        to.uniforms[name].push_back(x.get<double>());
        continue;
      }
      report.wrongType(Path(path, name), name, value, "a number or an array of finite numbers");
      break;
    }
  }
}

}  // namespace

Result<EvalPoints> readPoints(std::string_view text, const std::string& file, const Limits& limits) {
  const Result<Json> root = json::parse(text, file, limits);
  if (!root) return tl::make_unexpected(root.error());
  Diagnostics wrong;
  json::Report report(file, wrong);
  const Path top;
  const Path inside(top, "points");
  const Json* member = json::member(*root, "points");
  const Json& points = member == nullptr ? *root : *member;
  const Path& path = member == nullptr ? top : inside;
  EvalPoints result;
  if (!points.is_array()) {
    report.wrongType(path, "the list of points", points, "an array, or an object with \"points\"");
  } else {
    PointReader reader(file, wrong);
    for (size_t i = 0; i < points.size(); ++i) reader.read(points[i], Path(path, i), result);
    result.points = eval::columnsOf(reader.points());
  }
  if (member != nullptr) readUniforms(*root, report, result);
  if (hasError(wrong)) return tl::make_unexpected(std::move(wrong));
  return result;
}

}  // namespace lacquer
