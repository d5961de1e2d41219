// docs/layering.md: its layer works, is sampled as it scatters, gains nothing, and mistakes in it are told in
// the words of mistakes.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "eval/evaluate.h"
#include "eval/points.h"
#include "graph/graph.h"
#include "lower/lower.h"
#include "model/build.h"
#include "passes/pipeline.h"
#include "support/cases.h"
#include "support/chi_squared.h"

namespace lacquer::test {
namespace {

constexpr double kPi = 3.14159265358979323846;
using Direction = std::array<double, 3>;

std::filesystem::path pagePath() { return sourceFolder() / "docs/layering.md"; }
std::filesystem::path mistakesPath() { return sourceFolder() / "tests/layering/mistakes.md"; }

/// The page's file.
std::string layer() {
  const std::string page = readFile(pagePath());
  constexpr std::string_view kOpen = "```node\n";
  const size_t begin = page.find(kOpen) + kOpen.size();
  return page.substr(begin, page.find("```\n", begin) - begin);
}

void replaceAll(std::string& text, std::string_view what, std::string_view with) {
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
}

std::string fileOf(const std::string& material) {
  return R"({"asset": {"version": "2.0"}, "materials": [{)" + material + "}]}";
}

const std::string kFrosted =
    R"("extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}, "ACME_materials_frost": {"frostFactor": 0.5}})";

/// What comes of a material in a library with a text of one's own.
struct Outcome {
  Diagnostics found;  ///< errors of the first step that has some, else warnings
  std::optional<ir::Module> module;
};

Outcome outcomeOf(const std::string& text, const std::string& gltf, const std::string& name,
                  const gltf::VertexAttributes& attributes = {
                      true, true, false, {true, false, false, false}}) {
  lang::Library library = lang::Library::embedded();
  if (const auto added = library.add({{"frost.node", text}}); !added) return {added.error(), {}};
  if (Diagnostics all = library.checkAll(); !all.empty()) return {std::move(all), {}};
  const model::Models models(library);
  const auto model = models.of("khr");
  if (!model) return {model.error(), {}};
  const auto document = material::readText(gltf, "frost.gltf", **models.schema(), {});
  if (!document) return {document.error(), {}};
  const material::Material& material = document->materials[0];
  Diagnostics warnings = material.diagnostics;
  if (hasError(warnings)) return {warnings, {}};
  const auto decl = library.template_(name);
  model::BuildOptions options;
  options.template_name = name;
  const auto graph = model::build(**model, **decl, material, attributes, options, warnings);
  if (!graph) return {graph.error(), {}};
  auto module = lower::lower(*graph, library, {.evaluable = true});
  if (!module) return {module.error(), {}};
  return {warnings, std::move(*module)};
}

/// A row of the table in mistakes.md: its cells, and where the last one stands.
struct Mistake {
  std::string place, written, said;
  size_t begin = 0, length = 0;
};

std::string code(std::string cell) {
  const size_t begin = cell.find('`'), end = cell.rfind('`');
  if (begin == std::string::npos) return {};
  cell = cell.substr(begin + 1, end - begin - 1);
  replaceAll(cell, "⏎", "\n");
  return cell;
}

std::vector<Mistake> mistakes(const std::string& page) {
  std::vector<Mistake> rows;
  size_t at = page.find("| | in place of |");
  for (at = page.find("\n| 1 |", at); at != std::string::npos && page.compare(at, 3, "\n| ") == 0;) {
    const size_t end = page.find('\n', at + 1);
    std::vector<size_t> bars;
    for (size_t i = at; i < end; ++i) {
      if (page[i] == '|') bars.push_back(i);
    }
    if (bars.size() != 5) {
      ADD_FAILURE() << page.substr(at + 1, end - at - 1);
      break;
    }
    const auto cell = [&](size_t k) { return page.substr(bars[k] + 1, bars[k + 1] - bars[k] - 1); };
    rows.push_back({code(cell(1)), code(cell(2)), cell(3), bars[3] + 1, bars[4] - bars[3] - 1});
    at = end;
  }
  return rows;
}

TEST(Layering, MistakesAreToldInTheseWords) {
  std::string page = readFile(mistakesPath());
  const std::vector<Mistake> rows = mistakes(page);
  EXPECT_GE(rows.size(), 20U);
  const char* bless = std::getenv("LACQUER_BLESS");
  const bool blesses = bless != nullptr && std::string_view(bless) == "1";
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    std::string text = layer();
    const size_t at = text.find(row->place);
    ASSERT_NE(at, std::string::npos) << row->place;
    EXPECT_EQ(text.find(row->place, at + 1), std::string::npos) << row->place << ": stands there twice";
    text.replace(at, row->place.size(), row->written);
    const Outcome outcome = outcomeOf(text, fileOf(kFrosted), "forward");
    ASSERT_FALSE(outcome.found.empty()) << row->written << ": nothing is said";
    const Diagnostic& first = outcome.found[0];
    EXPECT_EQ(first.place.file, "frost.node") << row->written;
    const std::string said =
        fmt::format(" {} `[{}]`{}{} ", first.message, first.code, first.help.empty() ? "" : "; ", first.help);
    EXPECT_EQ(said.find('|'), std::string::npos) << said;
    if (blesses) {
      page.replace(row->begin, row->length, said);
    } else {
      EXPECT_EQ(row->said, said) << row->written << "\n`./dev bless` writes what is said";
    }
  }
  if (blesses) std::ofstream(mistakesPath(), std::ios::binary) << page;
}

TEST(Layering, ThePagesLayerIsRight) {
  for (const char* name : {"forward", "bsdf", "surface"}) {
    const Outcome outcome = outcomeOf(layer(), fileOf(kFrosted), name);
    EXPECT_TRUE(outcome.module) << name;
    for (const Diagnostic& one : outcome.found) ADD_FAILURE() << format(one);
  }
}

/// An attribute of the application's reaches a line by its name, as a value between the stages; a field of
/// the object's block, as no value.
TEST(Layering, AttributesAndFieldsOfObjectsReachALayer) {
  const std::string text = R"(
/// An engine's own.
template masked extends forward {
    extend block object {
        float wetness in [0, 1] = 0;
    }
    optional attribute vec2 _MASK;
    given vec2 mask in [0, 1] = has_MASK ? clamp(interpolate(_MASK), 0, 1) : vec2(1);
    given float wetness in [0, 1] = object.wetness;
}
/// E.
/// source: ACME_wet
extension ACME_wet {
    float amount in [0, 1] = 0;
}
/// P.
/// source: ACME_wet
part wet of ACME_wet over coat unless amount == 0 {
direct:
    out direct = wetted(below.direct, amount, mask, wetness);
}
/// N.
/// source: ACME_wet
node wetted(vec3 below in [0, inf], float amount in [0, 1], vec2 mask in [0, 1], float wetness in [0, 1]) -> vec3 in [0, inf] {
    return below * (1 - amount * mask.x * mask.y * wetness);
}
)";
  const auto varyings = [&](const std::string& of, const gltf::VertexAttributes& attributes) {
    Outcome outcome =
        outcomeOf(of, fileOf(R"("extensions": {"ACME_wet": {"amount": 0.5}})"), "masked", attributes);
    EXPECT_TRUE(outcome.module) << (outcome.found.empty() ? "" : format(outcome.found[0]));
    if (!outcome.module) return std::string();
    passes::runPipeline(*outcome.module, {});
    std::string names;
    for (const ir::Varying& one : outcome.module->varyings) names += one.name + " ";
    return names;
  };
  gltf::VertexAttributes plain{true, false, false, {true, false, false, false}}, masked = plain;
  masked.application = {"_MASK"};
  std::string dry = text;
  replaceAll(dry, " * wetness)", " * 0.5)");
  EXPECT_EQ(varyings(text, plain), varyings(dry, plain)) << "a field of the object's costs no varying";
  EXPECT_EQ(varyings(text, plain).find("MASK"), std::string::npos);
  EXPECT_NE(varyings(text, masked).find("MASK"), std::string::npos) << varyings(text, masked);
}

/// The layer over a base, under the template bsdf.
class Frosted {
public:
  explicit Frosted(const std::string& material) {
    Outcome outcome = outcomeOf(layer(), fileOf(material), "bsdf");
    EXPECT_TRUE(outcome.module) << (outcome.found.empty() ? "" : format(outcome.found[0]));
    if (outcome.module) module_ = std::move(*outcome.module);
  }

  struct Scattering {
    double f = 0;  ///< times the light's cosine, the channels' mean
    Direction direction{};
    double pdf = 0;
    bool lost() const { return direction == Direction{}; }
  };

  std::vector<Scattering> operator()(std::span<const eval::Point> points) const {
    eval::Bindings bindings;
    eval::bindPoints(module_, points, bindings);
    std::vector<ir::ValueId> roots;
    for (const ir::Output& output : module_.outputs) {
      if (output.location == 0 || output.location == 2) roots.push_back(output.value);
    }
    std::vector<Scattering> result(points.size());
    const auto values = eval::evaluate<double>(module_, roots, bindings, points.size());
    EXPECT_TRUE(values && roots.size() == 2);
    if (!values || roots.size() != 2) return result;
    for (size_t i = 0; i < points.size(); ++i) {
      const double* f = &(*values)[0][4 * i];
      const double* sample = &(*values)[1][4 * i];
      result[i] = {(f[0] + f[1] + f[2]) / 3, {sample[0], sample[1], sample[2]}, sample[3]};
    }
    return result;
  }

private:
  ir::Module module_;
};

Direction tilted(double cosine, double azimuth) {
  const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

/// The sphere in cells of equal area, each looked at in a finer grid.
constexpr size_t kRings = 24, kSectors = 36, kFine = 6, kCells = kRings * kSectors;

size_t cellOf(const Direction& d) {
  const auto at = [](double x, size_t n) {
    return std::min(static_cast<size_t>(std::max(x, 0.0) * static_cast<double>(n)), n - 1);
  };
  return at((d[2] + 1) / 2, kRings) * kSectors + at(std::atan2(d[1], d[0]) / (2 * kPi) + 0.5, kSectors);
}

struct Quadrature {
  std::vector<double> pdf = std::vector<double>(kCells);
  double f = 0;
};

Quadrature integrate(const Frosted& surface, const eval::Point& at) {
  constexpr size_t kHigh = kRings * kFine, kWide = kSectors * kFine;
  std::vector<eval::Point> points(kHigh * kWide, at);
  for (size_t i = 0; i < points.size(); ++i) {
    const double z = -1 + 2 * (static_cast<double>(i / kWide) + 0.5) / kHigh;
    points[i].l = tilted(z, 2 * kPi * ((static_cast<double>(i % kWide) + 0.5) / kWide - 0.5));
  }
  const std::vector<Frosted::Scattering> values = surface(points);
  constexpr double kArea = 4 * kPi / (kHigh * kWide);
  Quadrature sum;
  for (size_t i = 0; i < values.size(); ++i) {
    sum.pdf[i / kWide / kFine * kSectors + i % kWide / kFine] += values[i].pdf * kArea;
    sum.f += values[i].f * kArea;
  }
  return sum;
}

std::string stack(double frost, double exponent, const std::string& color, const std::string& below) {
  return fmt::format(R"("pbrMetallicRoughness": {{"metallicFactor": 0, "roughnessFactor": 0.7}},
      "extensions": {{"ACME_materials_frost": {{"frostFactor": {}, "frostExponent": {}, "frostColorFactor": {}}}{}}})",
                     frost, exponent, color, below);
}

const std::string kCoat = R"(, "KHR_materials_coat": {"coatFactor": 0.9, "coatRoughnessFactor": 0.5})";

/// Of deviations that chance alone makes, this is passed once in thirty thousand times; the seeds are fixed.
constexpr double kSignificance = 4;

TEST(Layering, DirectionsComeAsOftenAsTheirDensitySays) {
  constexpr size_t kCount = 1 << 16;
  unsigned seed = 1;
  for (const std::string& material :
       {stack(0.5, 4, "[0.9, 0.8, 0.7]", ""), stack(0.7, 20, "[0.5, 0.5, 0.5]", kCoat),
        stack(1, 1, "[1, 1, 1]", "")}) {
    const Frosted surface(material);
    for (const double cosine : {0.9, 0.35}) {
      eval::Point at;
      at.v = tilted(cosine, 0.4);
      const Quadrature exact = integrate(surface, at);
      std::vector<eval::Point> points(kCount, at);
      std::mt19937_64 random(++seed);
      const auto draw = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
      for (eval::Point& point : points) {
        point.random[0] = draw();
        point.random[1] = draw();
        point.random[2] = draw();
      }
      std::vector<double> counts(kCells + 1), expected(kCells + 1);
      const std::vector<Frosted::Scattering> samples = surface(points);
      double whole = 0;
      for (const Frosted::Scattering& s : samples) counts[s.lost() ? kCells : cellOf(s.direction)] += 1;
      for (size_t i = 0; i < kCells; ++i) {
        expected[i] = exact.pdf[i] * kCount;
        whole += exact.pdf[i];
      }
      expected[kCells] = std::max(1 - whole, 0.0) * kCount;
      EXPECT_LT(whole, 1.001) << material << cosine;
      EXPECT_LT(goodnessOfFit(counts, expected), kSignificance) << material << " " << cosine << ": " << whole;
      // Light over density has the mean that light has over the sphere.
      for (size_t i = 0; i < kCount; ++i) points[i].l = samples[i].lost() ? at.v : samples[i].direction;
      const std::vector<Frosted::Scattering> lit = surface(points);
      double sum = 0, squares = 0;
      for (size_t i = 0; i < kCount; ++i) {
        if (samples[i].lost()) continue;
        const double weight = lit[i].f / lit[i].pdf;
        sum += weight;
        squares += weight * weight;
      }
      const double mean = sum / kCount;
      const double error = std::sqrt((squares / kCount - mean * mean) / kCount);
      EXPECT_NEAR(mean, exact.f, kSignificance * error + 0.002 * exact.f) << material << " " << cosine;
    }
  }
}

/// In a white furnace nothing is gained, and white frost that hides all loses nothing.
TEST(Layering, AWhiteFurnaceStaysWhite) {
  for (const double cosine : {1.0, 0.4}) {
    eval::Point at;
    at.v = tilted(cosine, 0.4);
    const double bare = integrate(Frosted(stack(0, 4, "[1, 1, 1]", "")), at).f;
    const double half = integrate(Frosted(stack(0.5, 4, "[1, 1, 1]", "")), at).f;
    EXPECT_NEAR(half, 0.5 * bare + 0.5, 0.002) << cosine;
    for (const double exponent : {1.0, 8.0}) {
      EXPECT_NEAR(integrate(Frosted(stack(1, exponent, "[1, 1, 1]", kCoat)), at).f, 1, 0.002)
          << cosine << " " << exponent;
      EXPECT_LT(integrate(Frosted(stack(0.5, exponent, "[1, 1, 1]", kCoat)), at).f, 1.001) << cosine;
    }
  }
}

}  // namespace
}  // namespace lacquer::test
