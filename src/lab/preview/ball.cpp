#include "preview/ball.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "eval/image.h"
#include "preview/camera.h"
#include "support/jobs.h"

namespace lacquer::preview {

namespace {

using Rgba = std::array<double, 4>;

/// Samples of a pixel along each side.
constexpr uint32_t kGrid = 4;
constexpr uint32_t kSamples = kGrid * kGrid;
constexpr double kBoard[] = {0.18, 0.36};

/// The point of the ball at a place of the picture, both in [-1, 1]; false beside the ball.
bool onBall(double x, double y, eval::Point& point) {
  // From the eye at (0, 0, kEye) through (x, y, 0) kHalf.
  const Vec3 way{x * kHalf, y * kHalf, -kEye};
  const double a = dot(way, way);
  const double half_b = kEye * way[2];
  const double inside = half_b * half_b - a * (kEye * kEye - 1);
  if (inside <= 0) return false;
  const double along = (-half_b - std::sqrt(inside)) / a;
  const Vec3 n{way[0] * along, way[1] * along, kEye + way[2] * along};
  const double length = std::sqrt(a);
  // Longitude, 0 towards the eye, and latitude. The front half shows the whole of a texture once.
  const double longitude = std::atan2(n[0], n[2]);
  const double latitude = std::acos(std::clamp(n[1], -1.0, 1.0));
  const std::array<double, 2> uv{longitude / std::numbers::pi + 0.5, latitude / std::numbers::pi};
  point.position = n;  // a ball of radius 1 about the origin
  point.n = n;
  point.t = {std::cos(longitude), 0, -std::sin(longitude), 1};
  point.v = {-way[0] / length, -way[1] / length, -way[2] / length};
  point.uv.fill(uv);
  return true;
}

/// The samples of one row of pixels that hit the ball.
struct Row {
  std::vector<eval::Point> points;
  std::vector<uint32_t> sample;  ///< of each point: pixel times kSamples plus the sample's number
};

Row rowOf(uint32_t y, uint32_t size) {
  Row row;
  for (uint32_t i = 0; i < size * kSamples; ++i) {
    const uint32_t x = i / kSamples;
    const uint32_t k = i % kSamples;
    // Each row and each column of the grid's cells has its sample elsewhere: edges along an axis get all
    // shades.
    const uint32_t column = k % kGrid;
    const uint32_t line = k / kGrid;
    const double dx = (column + (line + 0.5) / kGrid) / kGrid;
    const double dy = (line + (column + 0.5) / kGrid) / kGrid;
    eval::Point point;
    if (!onBall((x + dx) * 2 / size - 1, 1 - (y + dy) * 2 / size, point)) continue;
    row.points.push_back(point);
    row.sample.push_back(i);
  }
  return row;
}

/// Display light of a sample: tone mapped, before a board where it is not opaque.
Vec3 shown(const Rgba& linear, uint32_t x, uint32_t y, uint32_t size) {
  const Vec3 mapped = toneMap({linear[0], linear[1], linear[2]});
  const double alpha = std::clamp(linear[3], 0.0, 1.0);
  const auto square = static_cast<uint32_t>(x * kSquares / size) + static_cast<uint32_t>(y * kSquares / size);
  const double board = kBoard[square % 2];
  Vec3 result{};
  for (size_t i = 0; i < 3; ++i) {
    const double c = std::isfinite(mapped[i]) ? std::clamp(mapped[i], 0.0, 1.0) : 0;
    result[i] = c * alpha + board * (1 - alpha);
  }
  return result;
}

/// Display light of a value. What is no number has a colour that nothing else has.
Vec3 shown(const Rgba& value, const ValueLook& look) {
  Vec3 result{};
  for (size_t i = 0; i < 3; ++i) {
    const double x = value[look.as == ValueLook::As::Grey ? 0 : i] * look.scale;
    if (!std::isfinite(x)) return {1, 0, 1};
    if (look.as == ValueLook::As::Color)
      result[i] = std::clamp(x, 0.0, 1.0);
    else
      result[i] = eval::decodeSrgb(std::clamp(look.as == ValueLook::As::Vector ? x / 2 + 0.5 : x, 0.0, 1.0));
  }
  return result;
}

void drawRow(const Row& row, const std::vector<Rgba>& colors, const std::optional<ValueLook>& value,
             uint32_t y, Color background, Picture& to) {
  const uint32_t size = to.width();
  Vec3 back{};
  for (size_t i = 0; i < 3; ++i) back[i] = eval::decodeSrgb(background[i] / 255.0);
  std::vector<Vec3> sums(size, Vec3{});
  std::vector<uint32_t> hits(size, 0);
  for (size_t i = 0; i < row.points.size(); ++i) {
    const uint32_t x = row.sample[i] / kSamples;
    const Vec3 light = value ? shown(colors[i], *value) : shown(colors[i], x, y, size);
    for (size_t c = 0; c < 3; ++c) sums[x][c] += light[c];
    ++hits[x];
  }
  for (uint32_t x = 0; x < size; ++x) {
    for (size_t c = 0; c < 3; ++c) {
      to.at(x, y)[c] = encodeSrgb((sums[x][c] + back[c] * (kSamples - hits[x])) / kSamples);
    }
  }
}

}  // namespace

namespace {

/// A cube map is looked up in a direction of any length; in none it has some texel.
Vec3 unitOf(const Vec3& direction) {
  const double length = std::hypot(direction[0], direction[1], direction[2]);
  if (!(length > 0)) return {0, 0, 1};
  return {direction[0] / length, direction[1] / length, direction[2] / length};
}

}  // namespace

Result<Shading> Shading::make(Look look, const Studio& studio) {
  Shading shading;
  shading.look_ = std::make_shared<const Look>(std::move(look));
  const Look& of = *shading.look_;
  shading.base_ = of.textures;
  shading.base_.quads = of.quads;
  shading.base_.lights = studio.lights(of.module);
  shading.base_.columns["frame.light_count"] =
      eval::Column::constant({static_cast<double>(shading.base_.lights.size())});
  for (const std::string& name : of.specular) {
    shading.base_.textures[name] = [&studio](size_t, const Vec3& direction, double lod) -> Rgba {
      const Vec3 c = studio.radiance(unitOf(direction), lod);
      return {c[0], c[1], c[2], 1};
    };
  }
  for (const std::string& name : of.fibres) {
    shading.base_.textures[name] = [&studio](size_t, const Vec3& direction, double lod) -> Rgba {
      const Vec3 c = studio.fibreRadiance(unitOf(direction), lod);
      return {c[0], c[1], c[2], 1};
    };
  }
  for (const std::string& name : of.irradiance) {
    shading.base_.textures[name] = [&studio](size_t, const Vec3& direction, double) -> Rgba {
      const Vec3 c = studio.irradiance(unitOf(direction));
      return {c[0], c[1], c[2], 1};
    };
  }
  // One point stands for all: a program holds for every number of them.
  const eval::Point any;
  shading.bind({&any, 1}, shading.base_);
  if (Result<void> block = eval::bindMaterialBlock(of.module, shading.base_); !block)
    return tl::make_unexpected(std::move(block.error()));
  std::vector<ir::ValueId> sources;
  for (const ir::Varying& varying : of.module.varyings) {
    if (varying.source == ir::kNoValue) continue;
    sources.push_back(varying.source);
    shading.varyings_.push_back(&varying);
  }
  std::vector<ir::ValueId> roots;
  for (const ir::OutputKind kind : {ir::OutputKind::Color, ir::OutputKind::Discard}) {
    for (const ir::Output& output : of.module.outputs) {
      if (output.kind == kind && output.location == 0) roots.push_back(output.value);
    }
  }
  Result<eval::Program> vertex = eval::compile(of.module, sources, shading.base_, 1);
  if (!vertex) return tl::make_unexpected(std::move(vertex.error()));
  // From here on a name that is an attribute's and a varying's is the varying's.
  if (Result<void> varyings = eval::bindVaryings<float>(of.module, 1, shading.base_); !varyings)
    return tl::make_unexpected(std::move(varyings.error()));
  Result<eval::Program> fragment = eval::compile(of.module, roots, shading.base_, 1);
  if (!fragment) return tl::make_unexpected(std::move(fragment.error()));
  shading.vertex_ = std::move(*vertex);
  shading.fragment_ = std::move(*fragment);
  shading.noteNeeds();
  return shading;
}

Result<Shading> Shading::with(const std::map<std::string, std::vector<double>>& parameters) const {
  Shading made = *this;
  for (const auto& [name, value] : parameters) made.base_.columns[name] = eval::Column::constant(value);
  if (Result<void> block = eval::bindMaterialBlock(look_->module, made.base_); !block)
    return tl::make_unexpected(std::move(block.error()));
  return made;
}

namespace {

/// The columns of points that have members of their own for them.
constexpr std::array<std::string_view, 14> kMembers = {
    "POSITION",   "VIEW",    "NORMAL", "TANGENT",        "TEXCOORD_0", "TEXCOORD_1",      "TEXCOORD_2",
    "TEXCOORD_3", "COLOR_0", "LIGHT",  "gl_FrontFacing", "INSIDE",     "SURROUNDING_IOR", "CHANNEL"};

template <class PointAt>
eval::Column columnOf(std::string_view name, size_t count, const PointAt& at) {
  const auto of = [&](auto get) {
    const size_t components = get(eval::Point()).size();
    std::vector<double> values(count * components);
    double* to = values.data();
    for (size_t i = 0; i < count; ++i) {
      for (const double x : get(at(i))) *to++ = x;
    }
    return eval::Column::perPoint(static_cast<int>(components), std::move(values));
  };
  using Point = eval::Point;
  const auto one = [](double x) { return std::array<double, 1>{x}; };
  if (name == "POSITION") return of([](const Point& p) { return p.position; });
  if (name == "VIEW") return of([](const Point& p) { return p.v; });
  if (name == "NORMAL") return of([](const Point& p) { return p.n; });
  if (name == "TANGENT") return of([](const Point& p) { return p.t; });
  if (name.starts_with("TEXCOORD_")) {
    const auto set = static_cast<size_t>(name[9] - '0');
    return of([set](const Point& p) { return p.uv[set]; });
  }
  if (name == "COLOR_0") return of([](const Point& p) { return p.color0; });
  if (name == "LIGHT") return of([](const Point& p) { return p.l; });
  if (name == "gl_FrontFacing") return of([&](const Point& p) { return one(p.front_facing ? 1 : 0); });
  if (name == "INSIDE") return of([&](const Point& p) { return one(p.inside ? 1 : 0); });
  if (name == "SURROUNDING_IOR") return of([&](const Point& p) { return one(p.surrounding_ior); });
  if (name == "CHANNEL") return of([&](const Point& p) { return one(p.channel); });
  return of([](const Point& p) { return p.random; });
}

}  // namespace

/// Most programs read a few columns: the others need not be made.
void Shading::noteNeeds() {
  for (const auto& entry : base_.columns) {
    const std::string& name = entry.first;
    const auto read = [&](const eval::Program& program) {
      return std::find(program.columns.begin(), program.columns.end(), name) != program.columns.end();
    };
    if (!entry.second.per_point || !(read(vertex_) || read(fragment_))) continue;
    if (name == "RANDOM" || std::find(kMembers.begin(), kMembers.end(), name) != kMembers.end())
      needs_.push_back(name);
    else if (name.ends_with(".camera_position"))
      cameras_.push_back(name);
  }
}

/// What points are to the programs: the base, with the columns that differ from point to point.
template <class PointAt>
eval::Bindings Shading::bound(size_t count, const PointAt& at) const {
  eval::Bindings bindings = base_;
  for (const std::string& name : needs_) bindings.columns[name] = columnOf(name, count, at);
  for (const std::string& name : cameras_) {
    const auto sum = [](const double* p, const double* v, double* out) {
      for (size_t c = 0; c < 3; ++c) out[c] = p[c] + v[c];
    };
    bindings.columns[name] =
        eval::combined(columnOf("POSITION", count, at), columnOf("VIEW", count, at), count, 3, sum);
  }
  return bindings;
}

eval::Bindings Shading::bound(std::span<const eval::Point> points) const {
  const bool more =
      std::any_of(points.begin(), points.end(), [](const eval::Point& p) { return !p.attributes.empty(); });
  if (!more) return bound(points.size(), [&](size_t i) -> const eval::Point& { return points[i]; });
  eval::Bindings bindings = base_;
  bind(points, bindings);
  return bindings;
}

void Shading::bind(std::span<const eval::Point> points, eval::Bindings& bindings) const {
  // These bindings may be the base itself, and points bring a light of their own.
  eval::Column count = base_.columns.find("frame.light_count")->second;
  std::vector<eval::Columns> lights = base_.lights;
  eval::bindPoints(look_->module, points, bindings);
  bindings.columns["frame.light_count"] = std::move(count);
  bindings.columns["frame.environment_max_lod"] = eval::Column::constant({1});  // the level is the roughness
  bindings.lights = std::move(lights);
  eval::bindClock(look_->time, look_->frame, bindings);
}

/// Makes bindings those of points of an object that stands somewhere, seen by one eye.
void Shading::stand(size_t points, const Standing& standing, eval::Bindings& bindings) const {
  const auto set = [&](const char* name, const double* values, size_t count) {
    const auto found = bindings.columns.find(name);
    if (found == bindings.columns.end()) return;
    eval::Column& column = found->second;
    column.values.assign(values, values + count);
    // As it was when the program was compiled: for each point, or for all.
    if (column.per_point) column.values.reserve(points * count);
    for (size_t i = 1; column.per_point && i < points; ++i)
      column.values.insert(column.values.end(), values, values + count);
  };
  set("object.model", standing.model.data(), 16);
  set("object.normal_matrix", standing.normal_matrix.data(), 16);
  set("frame.camera_position", standing.eye.data(), 3);
}

template <class T>
Shading::Vertices Shading::vertexStage(const eval::Bindings& bindings, size_t points) const {
  Vertices result;
  for (const std::vector<T>& column : eval::run<T>(vertex_, bindings, points))
    result.emplace_back(column.begin(), column.end());
  return result;
}

template <class T>
std::vector<Rgba> Shading::fragmentStage(const eval::Bindings& bindings, size_t points) const {
  const std::vector<std::vector<T>> values = eval::run<T>(fragment_, bindings, points);
  std::vector<Rgba> result(points);
  for (size_t i = 0; i < points; ++i) {
    for (size_t c = 0; c < 4; ++c) result[i][c] = static_cast<double>(values[0][4 * i + c]);
    if (values.size() > 1 && values[1][i] != 0) result[i][3] = 0;
  }
  return result;
}

template <class T>
std::vector<Rgba> Shading::run(std::span<const eval::Point> points) const {
  eval::Bindings bindings = bound(points);
  Vertices varyings = vertexStage<T>(bindings, points.size());
  for (size_t i = 0; i < varyings.size(); ++i) {
    bindings.columns[varyings_[i]->name] =
        eval::Column::perPoint(ir::componentCount(varyings_[i]->type), std::move(varyings[i]));
  }
  return fragmentStage<T>(bindings, points.size());
}

std::vector<Rgba> Shading::operator()(std::span<const eval::Point> points) const {
  if (points.empty()) return {};
  return look_->in_float ? run<float>(points) : run<double>(points);
}

Shading::Vertices Shading::vertices(std::span<const eval::Point> points, const Standing& standing) const {
  if (points.empty() || varyings_.empty()) return Vertices(varyings_.size());
  eval::Bindings bindings = bound(points);
  stand(points.size(), standing, bindings);
  return look_->in_float ? vertexStage<float>(bindings, points.size())
                         : vertexStage<double>(bindings, points.size());
}

std::vector<Rgba> Shading::samples(std::span<const Coverage::Sample> samples, const Vertices& vertices,
                                   const Standing& standing) const {
  if (samples.empty()) return {};
  std::array<eval::Point, 2> any;  // from behind, from in front
  any[0].front_facing = false;
  eval::Bindings bindings =
      bound(samples.size(), [&](size_t i) -> const eval::Point& { return any[samples[i].front ? 1 : 0]; });
  stand(samples.size(), standing, bindings);
  for (size_t v = 0; v < varyings_.size(); ++v) {
    const auto width = static_cast<size_t>(ir::componentCount(varyings_[v]->type));
    std::vector<double> values(samples.size() * width, 0.0);
    for (size_t i = 0; i < samples.size(); ++i) {
      if (!ir::isFloating(varyings_[v]->type)) {  // the first corner's, as Vulkan has it
        std::copy_n(&vertices[v][samples[i].corners[0] * width], width, &values[i * width]);
        continue;
      }
      for (size_t k = 0; k < 3; ++k) {
        const double* corner = &vertices[v][samples[i].corners[k] * width];
        for (size_t c = 0; c < width; ++c)
          values[i * width + c] += static_cast<double>(samples[i].weights[k]) * corner[c];
      }
    }
    bindings.columns[varyings_[v]->name] = eval::Column::perPoint(static_cast<int>(width), std::move(values));
  }
  return look_->in_float ? fragmentStage<float>(bindings, samples.size())
                         : fragmentStage<double>(bindings, samples.size());
}

Picture drawBall(const Shading& shading, uint32_t size, Color background) {
  Picture picture(size, size, background);
  inParallel(size, [&](size_t at) {
    const auto y = static_cast<uint32_t>(at);
    const Row row = rowOf(y, size);
    drawRow(row, shading(row.points), shading.value(), y, background, picture);
  });
  return picture;
}

namespace {

struct Sums {
  double largest = 0, sum = 0, squares = 0;
  size_t samples = 0;
};

using Pixels = std::vector<std::array<float, 3>>;

/// What one row adds to the pixels' mean differences and to the measures.
Sums addRow(const Row& row, const std::vector<Rgba>& a, const std::vector<Rgba>& b,
            std::span<std::array<float, 3>> pixels) {
  Sums sums;
  for (size_t i = 0; i < row.points.size(); ++i) {
    std::array<float, 3>& pixel = pixels[row.sample[i] / kSamples];
    for (size_t c = 0; c < 3; ++c) {
      const double d = std::abs(a[i][c] * a[i][3] - b[i][c] * b[i][3]);
      // A NaN on either side is as different as can be.
      sums.largest = std::isnan(d) ? std::numeric_limits<double>::infinity() : std::max(sums.largest, d);
      sums.sum += d;
      sums.squares += d * d;
      pixel[c] += static_cast<float>(d / kSamples);
    }
  }
  sums.samples = 3 * row.points.size();
  return sums;
}

double gainFor(const Pixels& pixels) {
  std::vector<float> levels;
  for (const std::array<float, 3>& pixel : pixels) {
    const float level = std::max({pixel[0], pixel[1], pixel[2]});
    if (std::isfinite(level) && level > 0) levels.push_back(level);
  }
  if (levels.empty()) return 1;
  const auto high = levels.begin() + static_cast<ptrdiff_t>(levels.size() - 1 - levels.size() / 100);
  std::nth_element(levels.begin(), high, levels.end());
  return std::pow(10.0, std::floor(-std::log10(static_cast<double>(*high))));
}

}  // namespace

Comparison compareBalls(const Shading& a, const Shading& b, uint32_t size, Color background) {
  Comparison result{
      Picture(size, size, background), Picture(size, size, background), Picture(size, size, {}), 1, {}};
  Pixels pixels(size_t{size} * size);
  std::vector<Sums> rows(size);  // added up in their order: the sums do not depend on the threads
  inParallel(size, [&](size_t at) {
    const auto y = static_cast<uint32_t>(at);
    const Row row = rowOf(y, size);
    const std::vector<Rgba> of_a = a(row.points);
    const std::vector<Rgba> of_b = b(row.points);
    drawRow(row, of_a, std::nullopt, y, background, result.a);
    drawRow(row, of_b, std::nullopt, y, background, result.b);
    rows[y] = addRow(row, of_a, of_b, std::span(pixels).subspan(size_t{y} * size, size));
  });
  Sums all;
  for (const Sums& sums : rows) {
    all.largest = std::max(all.largest, sums.largest);
    all.sum += sums.sum;
    all.squares += sums.squares;
    all.samples += sums.samples;
  }
  const auto count = static_cast<double>(std::max<size_t>(all.samples, 1));
  result.measured = {all.largest, all.sum / count, std::sqrt(all.squares / count)};
  result.gain = gainFor(pixels);
  for (uint32_t i = 0; i < size * size; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      // A NaN shows at its brightest.
      const double x = std::isnan(pixels[i][c]) ? 1 : static_cast<double>(pixels[i][c]) * result.gain;
      result.difference.at(i % size, i / size)[c] = encodeSrgb(x);
    }
  }
  return result;
}

}  // namespace lacquer::preview
