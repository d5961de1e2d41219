// What lobes see of lights that have an area, against quadrature of the lobes: rectangles and discs in the
// mirror's direction and beside it, through the horizon, near and far.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "physics/cloth.h"
#include "physics/documented.h"
#include "physics/lobe.h"
#include "physics/node_values.h"

namespace lacquer::physics::area_light_test {
namespace {

/// A light of radiance 1: it shines against cross(x, y).
struct Area {
  Vec3 centre, x, y;
  bool disk = false;

  /// Whether a direction from the origin meets it from the front.
  bool hit(const Vec3& l) const {
    const Vec3 n = cross(x, y);
    const double along = dot(l, n);
    const double away = dot(centre, n);
    if (!(along > 0 && away > 0)) return false;
    const Vec3 p = sum({-centre[0], -centre[1], -centre[2]}, l, away / along);
    const double u = dot(p, x) / dot(x, x);
    const double v = dot(p, y) / dot(y, y);
    return disk ? u * u + v * v <= 1 : std::abs(u) <= 1 && std::abs(v) <= 1;
  }
};

/// One whose middle is there and that faces the origin, but for a turn about its own x.
Area facing(const Vec3& centre, double half_x, double half_y, bool disk, double spin = 0, double lean = 0) {
  const Vec3 w = normalized(centre);
  const Vec3 up = std::abs(w[1]) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
  const Vec3 right = normalized(cross(up, w));
  const Vec3 top = cross(w, right);
  const Vec3 x = sum({right[0] * std::cos(spin), right[1] * std::cos(spin), right[2] * std::cos(spin)}, top,
                     std::sin(spin));
  const Vec3 across = cross(w, x);
  const Vec3 y = sum({across[0] * std::cos(lean), across[1] * std::cos(lean), across[2] * std::cos(lean)}, w,
                     std::sin(lean));
  return {centre,
          {x[0] * half_x, x[1] * half_x, x[2] * half_x},
          {y[0] * half_y, y[1] * half_y, y[2] * half_y},
          disk};
}

enum class Of : uint8_t { Facets, Grooves, Fibres, Cosine };

/// What a lobe about z sees of a light; the cosine's is Lambert's.
struct Query {
  Lobe lobe;
  Of of = Of::Facets;
  Area area;
  double exact = 0, seen = 0;
  bool cut() const {  ///< the horizon cuts it
    const double reach =
        area.disk ? std::hypot(area.x[2], area.y[2]) : std::abs(area.x[2]) + std::abs(area.y[2]);
    return std::abs(area.centre[2]) < reach;
  }
};

std::vector<Area> areasAbout(const Vec3& mirror) {
  std::vector<Area> all;
  const Vec3 along = normalized(cross({0, 1, 0}, mirror));
  for (const double tilt : {-60.0, -25.0, 0.0, 25.0}) {
    for (const double side : {0.0, 20.0}) {
      const Vec3 to = normalized(
          sum(sum(mirror, along, std::tan(tilt * kPi / 180)), {0, 1, 0}, std::tan(side * kPi / 180)));
      for (const bool disk : {false, true}) {
        for (const double size : {0.1, 0.4, 1.5}) {
          all.push_back(facing(to, size, size, disk, 0.5));
          all.push_back(facing(to, size, disk ? size : 0.3 * size, disk, 1.2, 0.8));
        }
      }
    }
  }
  return all;
}

constexpr double kRoughnesses[] = {0.1, 0.2236, 0.35, 0.5, 0.7, 1};
constexpr double kViews[] = {1, 0.8, 0.5, 0.25, 0.1};

/// Of vectors of the queries, one parameter of a node.
eval::Column columnOf(const std::vector<Query>& queries, const std::function<Vec3(const Query&)>& of) {
  std::vector<double> values;
  for (const Query& q : queries) {
    const Vec3 v = of(q);
    values.insert(values.end(), v.begin(), v.end());
  }
  return eval::Column::perPoint(3, std::move(values));
}
eval::Column numbersOf(const std::vector<Query>& queries, const std::function<double(const Query&)>& of) {
  std::vector<double> values;
  for (const Query& q : queries) values.push_back(of(q));
  return eval::Column::perPoint(1, std::move(values));
}

/// The normals that stretched lobes are seen about, and those of the others.
template <class T>
std::vector<T> normalsOf(const std::vector<Query>& queries) {
  const auto normals = nodeValues<T>(
      "bent_normal", "",
      {{"N", eval::Column::constant({0, 0, 1})},
       {"B", eval::Column::constant({0, 1, 0})},
       {"V", columnOf(queries, [](const Query& q) { return q.lobe.v; })},
       {"strength", numbersOf(queries, [](const Query& q) { return q.lobe.strength; })},
       {"roughness", numbersOf(queries, [](const Query& q) { return std::min(q.lobe.roughness, 1.0); })}},
      queries.size());
  return normals.empty() ? std::vector<T>() : normals[0];
}

/// What the library's nodes see, in T.
template <class T>
std::vector<double> seenBy(const std::vector<Query>& queries) {
  const size_t n = queries.size();
  const auto column = [](int components, const std::vector<T>& values) {
    return eval::Column::perPoint(components, {values.begin(), values.end()});
  };
  const auto light =
      nodeValues<T>("area_light", "",
                    {{"surface", eval::Column::constant({0, 0, 0})},
                     {"position", columnOf(queries, [](const Query& q) { return q.area.centre; })},
                     {"half_x", columnOf(queries, [](const Query& q) { return q.area.x; })},
                     {"half_y", columnOf(queries, [](const Query& q) { return q.area.y; })},
                     {"radiance", eval::Column::constant({1, 1, 1})},
                     {"disk", numbersOf(queries, [](const Query& q) { return q.area.disk ? 1.0 : 0.0; })}},
                    n);
  const std::vector<T> normals = normalsOf<T>(queries);
  if (normals.empty()) return {};
  const auto frame = nodeValues<T>(
      "area_frame", "",
      {{"N", column(3, normals)}, {"V", columnOf(queries, [](const Query& q) { return q.lobe.v; })}}, n);
  if (light.empty() || frame.empty()) return {};
  const auto lobe =
      nodeValues<T>("area_lobe", "",
                    {{"cosine", column(1, frame[2])},
                     {"alpha", numbersOf(queries, [](const Query& q) { return q.lobe.alphaB(); })}},
                    n);
  if (lobe.empty()) return {};
  std::array<std::vector<T>, 3> shape = {lobe[0], lobe[1], lobe[2]};
  for (size_t i = 0; i < n; ++i) {
    if (queries[i].of != Of::Cosine) continue;
    shape[0][i] = 1;
    shape[1][i] = 0;
    shape[2][i] = 1;
  }
  const auto seen = nodeValues<T>("area_seen", "",
                                  {{"N", column(3, normals)},
                                   {"T", column(3, frame[0])},
                                   {"B", column(3, frame[1])},
                                   {"centre", column(3, light[0])},
                                   {"half_x", column(3, light[1])},
                                   {"half_y", column(3, light[2])},
                                   {"disk", column(1, light[4])},
                                   {"radiance", column(3, light[3])},
                                   {"along", column(1, shape[0])},
                                   {"lean", column(1, shape[1])},
                                   {"across", column(1, shape[2])}},
                                  n);
  std::vector<double> all;
  for (size_t i = 0; i < n && !seen.empty(); ++i) all.push_back(static_cast<double>(seen[0][3 * i]));
  return all;
}

/// The cosine's lobe by the same count of directions.
double cosineMean(const Area& area, int steps = 256, int turns = 384) {
  int hits = 0;
  for (int i = 0; i < steps; ++i) {
    const double c = std::sqrt(1 - (i + 0.5) / steps);
    for (int k = 0; k < turns; ++k) hits += area.hit(tilted(c, 2 * kPi * (k + 0.5) / turns)) ? 1 : 0;
  }
  return static_cast<double>(hits) / (steps * turns);
}

/// The lobe of the sheen's fibres as directions of light, and how much of it lies in each.
struct Fibres {
  std::vector<Vec3> lights;
  std::vector<double> weights;
  double whole = 0;

  explicit Fibres(const Lobe& lobe) {
    overHemisphere(
        [&](double cosine, double azimuth) {
          const Vec3 light = tilted(cosine, azimuth);
          // As overHemisphere() sums them: more of them towards grazing, which weigh less.
          lights.push_back(light);
          weights.push_back(static_cast<double>(charlie(lobe.v, light, lobe.roughness)) * cosine *
                            std::pow(cosine, 2.0 / 3));
          whole += weights.back();
          return 0.0;
        },
        192, 256);
  }
  double part(const Area& area) const {
    double seen = 0;
    for (size_t i = 0; i < lights.size(); ++i) seen += area.hit(lights[i]) ? weights[i] : 0;
    return seen / whole;
  }
};

constexpr double kStrengths[] = {0.3, 0.6, 1};

void addFibres(std::vector<Query>& all) {
  for (const double view : {1.0, 0.5, 0.1}) {
    const Vec3 v = tilted(view);
    for (const double roughness : {0.3, 0.5, 0.7, 1.0}) {
      const Lobe lobe{roughness, 0, v};
      const Fibres fibres(lobe);
      for (const Area& area : areasAbout(mirrored(v, {0, 0, 1})))
        all.push_back({lobe, Of::Fibres, area, fibres.part(area)});
    }
  }
}

/// Seen along the grooves, across them and between.
void addGrooves(std::vector<Query>& all) {
  for (const double azimuth : {0.0, 0.8, 1.57}) {
    for (const double view : {0.8, 0.25}) {
      const Vec3 v = tilted(view, azimuth);
      for (const double roughness : {0.1, 0.35, 0.6}) {
        for (const double strength : kStrengths) {
          const Lobe lobe{roughness, strength, v};
          const Quadrature quadrature(lobe, 128, 192);
          for (const Area& area : areasAbout(mirrored(v, {0, 0, 1}))) {
            const auto hit = [&](const Vec3& light) { return area.hit(light) ? 1.0 : 0.0; };
            all.push_back({lobe, Of::Grooves, area, quadrature.mean(hit)});
          }
        }
      }
    }
  }
}

const std::vector<Query>& queries() {
  static const std::vector<Query> kQueries = [] {
    std::vector<Query> all;
    addFibres(all);
    addGrooves(all);
    for (const double view : kViews) {
      const Vec3 v = tilted(view);
      const Vec3 mirror = mirrored(v, {0, 0, 1});
      const std::vector<Area> areas = areasAbout(mirror);
      for (const double roughness : kRoughnesses) {
        const Lobe lobe{roughness, 0, v};
        const Quadrature quadrature(lobe, 256, 384);
        for (const Area& area : areas) {
          all.push_back({lobe, Of::Facets, area,
                         quadrature.mean([&](const Vec3& l) { return area.hit(l) ? 1.0 : 0.0; })});
        }
      }
      for (const Area& area : areas) all.push_back({{1, 0, v}, Of::Cosine, area, cosineMean(area)});
    }
    const std::vector<double> seen = seenBy<double>(all);
    for (size_t i = 0; i < seen.size(); ++i) all[i].seen = seen[i];
    return all;
  }();
  return kQueries;
}

struct Errors {
  double rms = 0, mean = 0, largest = 0;
  size_t count = 0;
};
using Which = std::function<bool(const Query&)>;

Errors errorsOf(const Which& which) {
  Errors errors;
  for (const Query& q : queries()) {
    if (!which(q)) continue;
    const double error = std::abs(q.seen - q.exact);
    errors.rms += error * error;
    errors.mean += error;
    errors.largest = std::max(errors.largest, error);
    ++errors.count;
  }
  const auto count = static_cast<double>(errors.count);
  return {std::sqrt(errors.rms / count), errors.mean / count, errors.largest, errors.count};
}

std::string row(const std::string& name, const Which& which) {
  std::string text = fmt::format("| {} |", name);
  for (const bool disk : {false, true}) {
    const Errors e = errorsOf([&](const Query& q) { return q.area.disk == disk && which(q); });
    text += fmt::format(" {:.4f} | {:.4f} | {:.3f} |", e.rms, e.mean, e.largest);
  }
  return text + "\n";
}

std::string errorTable() {
  std::string text =
      "| lobe | rectangles: RMS | mean | largest | discs: RMS | mean | largest "
      "|\n|---|---|---|---|---|---|---|\n";
  text +=
      row("the cosine's, above the horizon", [](const Query& q) { return q.of == Of::Cosine && !q.cut(); });
  text +=
      row("the cosine's, cut by the horizon", [](const Query& q) { return q.of == Of::Cosine && q.cut(); });
  for (const double r : kRoughnesses) {
    text += row(fmt::format("roughness {}", r),
                [r](const Query& q) { return q.of == Of::Facets && q.lobe.roughness == r; });
  }
  for (const double v : kViews) {
    text += row(fmt::format("view's cosine {}", v),
                [v](const Query& q) { return q.of == Of::Facets && std::abs(q.lobe.v[2] - v) < 1e-9; });
  }
  text += row("all of GGX, above the horizon", [](const Query& q) { return q.of == Of::Facets && !q.cut(); });
  text += row("all of GGX, cut by the horizon", [](const Query& q) { return q.of == Of::Facets && q.cut(); });
  for (const double strength : kStrengths) {
    text += row(fmt::format("stretched, strength {}", strength),
                [strength](const Query& q) { return q.of == Of::Grooves && q.lobe.strength == strength; });
  }
  text += row("the sheen's fibres", [](const Query& q) { return q.of == Of::Fibres; });
  return text;
}

TEST(AreaLights, AreSeenAsQuadratureSeesThem) {
  fmt::print("{}", errorTable());
  const Errors flat = errorsOf([](const Query& q) { return q.of == Of::Cosine && !q.area.disk; });
  const Errors round = errorsOf([](const Query& q) { return q.of == Of::Cosine && q.area.disk && !q.cut(); });
  // Of the quadrature, whose directions hit or miss.
  EXPECT_LT(flat.largest, 2e-3);
  EXPECT_LT(round.largest, 2e-3);
  EXPECT_LT(errorsOf([](const Query& q) { return q.of == Of::Cosine && q.area.disk && q.cut(); }).largest,
            0.05);
  for (const bool disk : {false, true}) {
    const Errors all = errorsOf([&](const Query& q) { return q.of == Of::Facets && q.area.disk == disk; });
    EXPECT_LT(all.rms, 0.03) << disk;
    EXPECT_LT(all.mean, 0.015) << disk;
  }
}

/// A light that fills the hemisphere is seen as a whole, and never brighter than it is.
TEST(AreaLights, AWhiteCeilingIsWhite) {
  std::vector<Query> all;
  for (const double roughness : {0.0, 0.1, 0.3, 0.5, 0.8, 1.0}) {
    for (const double view : {1.0, 0.7, 0.3, 0.05, 0.001}) {
      for (const bool disk : {false, true}) {
        for (const Of of : {Of::Facets, Of::Cosine}) {
          all.push_back({{roughness, 0, tilted(view)}, of, facing({0, 0, 1e-3}, 1e3, 1e3, disk)});
        }
      }
    }
  }
  for (const std::vector<double>& seen : {seenBy<double>(all), seenBy<float>(all)}) {
    ASSERT_EQ(seen.size(), all.size());
    for (size_t i = 0; i < all.size(); ++i) {
      EXPECT_LE(seen[i], 1);
      EXPECT_GT(seen[i], all[i].lobe.v[2] < 0.01 && all[i].of == Of::Facets ? 0.99 : 0.999)
          << all[i].lobe.roughness << " " << all[i].lobe.v[2] << " " << all[i].area.disk;
    }
  }
}

/// Numbers at their ends: at the light's plane, its centre, its corner, of no size, behind, far and near.
std::vector<Query> hostile() {
  std::vector<Query> all;
  Random random(17);
  const auto between = [&](double lo, double hi) { return uniform(random, lo, hi); };
  for (int i = 0; i < 40000; ++i) {
    const double view = i % 7 == 0 ? between(0, 1e-3) : i % 7 == 1 ? 1 : between(0, 1);
    const double far = std::pow(10, between(-6, 6));
    const Vec3 to = unitVector(random);
    Area area = facing({to[0] * far, to[1] * far, to[2] * far}, std::pow(10, between(-6, 3)),
                       std::pow(10, between(-6, 3)), i % 2 == 0, between(0, 6), between(-1.5, 1.5));
    if (i % 11 == 1) area.centre = {0, 0, 0};
    if (i % 11 == 2) area.centre = sum(area.x, area.y, 1);
    if (i % 11 == 3) area.x = {0, 0, 0};
    if (i % 11 == 4) area.x = area.y = {0, 0, 0};
    if (i % 11 == 5) area.centre[2] = 0;
    if (i % 11 == 6) area.y = {-area.y[0], -area.y[1], -area.y[2]};
    if (i % 11 == 7) area.centre = sum(area.x, area.y, between(-2, 2));
    if (i % 11 == 8) area.centre = area.x = area.y = {0, 0, 0};
    all.push_back(
        {{i % 3 == 0 ? 0 : between(0, 1), 0, tilted(view)}, i % 5 == 0 ? Of::Cosine : Of::Facets, area});
  }
  return all;
}

TEST(AreaLights, AreFiniteAndNeverMoreThanThereIsWhateverTheyAre) {
  const std::vector<Query> all = hostile();
  const std::vector<double> seen = seenBy<float>(all);
  const std::vector<double> exact = seenBy<double>(all);
  ASSERT_EQ(seen.size(), all.size());
  size_t compared = 0;
  size_t apart = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    ASSERT_TRUE(seen[i] >= 0 && seen[i] <= 1) << i;
    ASSERT_TRUE(exact[i] >= 0 && exact[i] <= 1) << i;
    const bool dark = i % 11 == 3 || i % 11 == 4 || i % 11 == 6 || i % 11 == 8;  // of no size, or from behind
    EXPECT_TRUE(!dark || (exact[i] == 0 && seen[i] == 0)) << i;
    // From its own plane, or as near to it, a light is seen or not by a rounding.
    const Area& area = all[i].area;
    const double away = std::abs(dot(area.centre, normalized(cross(area.x, area.y))));
    if (dark || !(away > 1e-3 * std::sqrt(std::max(dot(area.x, area.x), dot(area.y, area.y))))) continue;
    ++compared;
    apart += std::abs(seen[i] - exact[i]) > 1e-3 ? 1 : 0;
  }
  EXPECT_GT(compared, all.size() / 4);
  EXPECT_LT(apart, compared / 500);
}

/// At AREA_MIN_SINE2 the frame changes, and what is seen does not.
TEST(AreaLights, TheFrameOfAViewAlongTheNormalIsAnyFrame) {
  for (const double roughness : {0.0, 0.3, 1.0}) {
    std::vector<Query> all;
    for (const double sine : {0.0, 0.99e-5, 1.01e-5}) {
      const Vec3 v = {0, sine, std::sqrt(1 - sine * sine)};
      all.push_back({{roughness, 0, v}, Of::Facets, facing({0.1, 0.2, 1}, 0.2, 0.5, false)});
    }
    const std::vector<double> seen = seenBy<double>(all);
    EXPECT_NEAR(seen[1], seen[0], 5e-3);
    EXPECT_NEAR(seen[2], seen[1], 5e-3);
  }
}

/// The lights of a work, and what they cost.
std::string costTable(std::string& driver) {
  const std::vector<std::pair<std::string, std::map<std::string, uint32_t, std::less<>>>> kinds = {
      {"forward", {{"point", 1}}}, {"forward_area", {{"rect", 1}}}, {"forward_area", {{"disk", 1}}}};
  std::vector<cost::Subject> subjects;
  for (const auto& [name, lights] : kinds) {
    for (const char* work : {"w0.gltf", "w1.gltf"}) {
      Options options = workOptions(lights);
      options.template_name = name;
      subjects.push_back(workOf(work, options));
    }
  }
  const cost::Measurement measured = cost::measure(subjects, "navi21", false);
  driver = measured.driver;
  std::string text = "| one light | W0 | W1 |\n|---|---|---|\n";
  for (size_t i = 0; i < kinds.size(); ++i) {
    text += fmt::format("| `{}` |", kinds[i].second.begin()->first);
    for (size_t k = 0; k < 2; ++k) {
      const cost::Outcome& outcome = measured.outcomes[2 * i + k];
      EXPECT_TRUE(outcome.statistics) << outcome.problem;
      if (outcome.statistics)
        text += fmt::format(" {} / {} |", outcome.statistics->instructions,
                            outcome.statistics->inverse_throughput);
    }
    text += "\n";
  }
  return text;
}

TEST(AreaLights, TheTableIsTheDocumentations) {
  if (const std::string reason = cost::unavailable(); !reason.empty()) GTEST_SKIP() << reason;
  std::string driver;
  const std::string costs = costTable(driver);
  expectOnPage("area", fmt::format("{}, navi21.\n\n{}\n{}", driver, errorTable(), costs), driver);
}

}  // namespace
}  // namespace lacquer::physics::area_light_test
