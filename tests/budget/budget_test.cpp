// An error budget holds: what the variants that it allows do to colours, measured over random materials and
// points, is within it; and the table that they are picked from is the one that was measured.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "lacquer.h"
#include "physics/model.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

using nlohmann::json;
using physics::Random;

/// As docs/error.md has it.
constexpr double kDark = 1.0 / 256;

physics::Material material(Random& random) {
  physics::Material m = physics::randomMaterial(random);
  m.texels.clear();
  m.unlit = false;
  // The budget speaks of IORs from 1 to 4.
  if (m.ior) m.ior = physics::uniform(random, 1, 4);
  if (m.coat && physics::uniform(random) < 0.5) m.coat->ior = physics::uniform(random, 1, 4);
  if (m.coat && m.coat->ior == 0) m.coat->ior = 1.5;
  return m;
}

json points(Random& random) {
  json all = json::array();
  for (int i = 0; i < 120; ++i) {
    const physics::Sample s = physics::randomSample(random, true);
    json point = {{"n", s.n}, {"t", s.t}, {"v", s.v}, {"l", s.l}};
    // Light and environment apart: one must not hide what the other does.
    const bool sky = i % 2 == 0;
    point["light"] = sky ? physics::Vec3{0, 0, 0} : physics::Vec3{1, 1, 1};
    point["env"] = sky ? physics::Vec3{1, 1, 1} : physics::Vec3{0, 0, 0};
    all.push_back(point);
  }
  return all;
}

class Budget : public testing::Test {
protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / "lacquer_budget";
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const physics::Material& m) const {
    const std::string path = (folder_ / "m.gltf").string();
    std::ofstream(path) << physics::gltfOf(m);
    return path;
  }

  static std::vector<physics::Vec4> colors(const std::string& path, const json& points,
                                           const Options& options) {
    Messages messages;
    const std::string answer =
        evaluate(path, "", points.dump(), "points", Engine::Double, {}, options, messages);
    EXPECT_FALSE(hasError(messages)) << messages[0].text;
    return json::parse(answer)["rgba"].get<std::vector<physics::Vec4>>();
  }

  static Graph graph(const physics::Material& m, const Options& options) {
    Messages messages;
    const Scene scene = Scene::fromMemory(physics::gltfOf(m), "m.gltf", options, messages);
    Attributes attributes;
    attributes.tangent = true;
    attributes.texCoord = {true, true, true, true};
    return scene.graph(0, attributes, options, messages);
  }

  std::filesystem::path folder_;
};

double relative(double x, double exact) { return std::abs(x - exact) / std::max(exact, kDark); }

TEST_F(Budget, HoldsOverRandomMaterialsAndPoints) {
  Random random(21);
  size_t picked = 0;
  for (const double budget : {1e-3, 0.02, 0.1, 0.4, 1.0}) {
    double worst = 0;
    for (int k = 0; k < 60; ++k) {
      const physics::Material m = material(random);
      Options options;
      options.profile = k % 2 == 0 ? "khr" : "openpbr";
      Options cheaper = options;
      cheaper.error_budget = budget;
      const std::string with = graph(m, cheaper).toJson();
      if (with == graph(m, options).toJson()) continue;
      ++picked;
      const json at = points(random);
      const std::string path = file(m);
      const auto exact = colors(path, at, options);
      const auto colors_with = colors(path, at, cheaper);
      for (size_t i = 0; i < exact.size(); ++i) {
        for (size_t c = 0; c < 3; ++c) worst = std::max(worst, relative(colors_with[i][c], exact[i][c]));
      }
    }
    EXPECT_LE(worst, budget);
    fmt::print("budget {}: worst {:.3g}\n", budget, worst);
  }
  EXPECT_GT(picked, 10U) << "nothing was measured";
}

TEST_F(Budget, ATighterOneTakesTheReference) {
  Random random(3);
  bool loose = false;
  for (int k = 0; k < 40; ++k) {
    const physics::Material m = material(random);
    Options options;
    const std::string reference = graph(m, options).toJson();
    EXPECT_EQ(reference.find("\"variant\""), std::string::npos);
    options.error_budget = 1e-17;
    EXPECT_EQ(graph(m, options).toJson(), reference);
    options.error_budget = 1;
    loose |= graph(m, options).toJson() != reference;
  }
  EXPECT_TRUE(loose);
}

TEST_F(Budget, ManifestSaysWhatItTook) {
  physics::Material m;
  m.clearcoat = physics::Clearcoat{0.5, 0.3, {}, {}};
  const std::string path = file(m);
  Options options;
  options.targets = {Target::Spirv};
  options.unused = true;
  options.error_budget = 0.9;
  for (const std::string cache : {"", "cache", "cache"}) {
    options.cache = cache.empty() ? "" : (folder_ / cache).string();
    Messages messages;
    const Report report = generate({path}, {}, (folder_ / "out").string(), options, messages);
    ASSERT_TRUE(report.ok);
    const json manifest = json::parse(readFile(folder_ / "out/manifest.json"));
    const json& one = manifest["files"][0]["materials"][0];
    ASSERT_FALSE(one["variants"].empty());
    double error = 0;
    double saved = 0;
    for (const json& variant : one["variants"]) {
      error += (1 + error) * variant["error"].get<double>();
      saved += variant["saved"].get<double>();
      EXPECT_FALSE(variant["terms"].empty());
    }
    EXPECT_NEAR(one["expected_error"].get<double>(), error, 1e-12);
    EXPECT_LE(error, options.error_budget);
    EXPECT_GT(saved, 0);
    EXPECT_EQ(report.materials[0].terms->variants.size(), one["variants"].size());
  }
}

TEST_F(Budget, OutOfRangeIsAnError) {
  for (const double budget : {-1e-3, 1.5, std::nan("")}) {
    Options options;
    options.error_budget = budget;
    Messages messages;
    EXPECT_FALSE(generate({file({})}, {}, (folder_ / "out").string(), options, messages).ok);
    ASSERT_FALSE(messages.empty());
    EXPECT_EQ(messages[0].code, "bad-error-budget");
  }
}

/// The rows of src/shader/variants.def say what bench/error.json says, and each names a variant that is
/// there.
TEST_F(Budget, TableIsTheMeasuredOne) {
  const json measured = json::parse(readFile(sourceFolder() / "bench/error.json"));
  std::vector<std::string> rows;
  for (const auto& [node, bodies] : measured["nodes"].items()) {
    for (const auto& [variant, body] : bodies.items()) {
      if (variant == "reference" || !body.contains("in_material")) continue;
      const int64_t cycles = body["in_material"]["inverse_throughput"].get<int64_t>();
      if (cycles >= 0) continue;
      rows.push_back(fmt::format("{{\"{}\", \"{}\", {}, {}, {}}},", node, variant,
                                 body["color"]["any_ior"].get<std::string>(),
                                 body["color"]["ior_1.5"].get<std::string>(), -cycles));
    }
  }
  EXPECT_FALSE(rows.empty());
  std::ifstream file(sourceFolder() / "src/shader/variants.def");
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("//")) lines.push_back(line);
  }
  std::sort(rows.begin(), rows.end());
  std::sort(lines.begin(), lines.end());
  EXPECT_EQ(rows, lines) << "./dev bench error makes both";
}

}  // namespace
}  // namespace lacquer::test
