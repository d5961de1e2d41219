#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "accuracy/grid.h"
#include "support/cases.h"

namespace lacquer::accuracy {

namespace {

/// A step of 8 bits: what is darker is not looked at more closely.
constexpr double kStep = 1.0 / 256;
constexpr const char* kProfiles[] = {"khr", "openpbr", "physical"};

/// Calls with each number of both.
void eachNumber(Seen& seen, const std::function<void(double&)>& call) {
  for (auto& view : seen.lamps) {
    for (Vec3& lamp : view) std::for_each(lamp.begin(), lamp.end(), call);
  }
  for (Vec3& view : seen.sky) std::for_each(view.begin(), view.end(), call);
}

struct Squares {
  double error = 0, noise = 0;
  size_t count = 0;
  void add(const Vec3& model, const Vec3& walk, const Vec3& deviation) {
    for (size_t c = 0; c < 3; ++c) {
      const double unit = std::max(walk[c], kStep);
      error += std::pow((model[c] - walk[c]) / unit, 2);
      noise += std::pow(deviation[c] / unit, 2);
      ++count;
    }
  }
  double rms() const { return std::sqrt(std::max(error - noise, 0.0) / static_cast<double>(count)); }
  double deviation() const { return std::sqrt(noise / static_cast<double>(count)); }
};

std::vector<bool> allOf(const std::function<bool(const GridMaterial&)>& counts) {
  std::vector<bool> result;
  for (const GridMaterial& m : gridMaterials()) result.push_back(counts(m));
  return result;
}

}  // namespace

std::filesystem::path walksFile() {
  return std::filesystem::path(LACQUER_SOURCE_FOLDER) / "tests/accuracy/walks.txt";
}

std::string walksText() {
  std::string text;
  const std::vector<GridMaterial>& materials = gridMaterials();
  for (size_t i = 0; i < materials.size(); ++i) {
    WalkedSeen walked = walkGrid(materials[i], {}, 1 + 8 * i);
    std::string line;
    eachNumber(walked.mean, [&](double& x) { line += fmt::format("{:.4g} ", x); });
    eachNumber(walked.deviation, [&](double& x) { line += fmt::format("{:.1g} ", x); });
    line.back() = '\n';
    text += line;
  }
  return text;
}

std::vector<WalkedSeen> readWalks() {
  std::istringstream in(test::readFile(walksFile()));
  std::vector<WalkedSeen> result(gridMaterials().size());
  for (WalkedSeen& walked : result) {
    eachNumber(walked.mean, [&](double& x) { in >> x; });
    eachNumber(walked.deviation, [&](double& x) { in >> x; });
  }
  EXPECT_TRUE(in) << walksFile() << " has too few numbers";
  return result;
}

GridErrors gridErrors(const std::vector<Seen>& model, const std::vector<WalkedSeen>& walks,
                      const std::vector<bool>& counts) {
  Squares lamps;
  Squares sky;
  for (size_t i = 0; i < model.size(); ++i) {
    if (!counts[i]) continue;
    const auto& [mean, deviation] = walks[i];
    for (size_t v = 0; v < kViews; ++v) {
      for (size_t k = 0; k < kLamps; ++k)
        lamps.add(model[i].lamps[v][k], mean.lamps[v][k], deviation.lamps[v][k]);
      sky.add(model[i].sky[v], mean.sky[v], deviation.sky[v]);
    }
  }
  return {lamps.rms(), sky.rms(), lamps.deviation(), sky.deviation()};
}

std::string gridTable() {
  const std::vector<WalkedSeen> walks = readWalks();
  std::vector<std::vector<Seen>> models;
  for (const char* profile : kProfiles) models.push_back(gridOf(profile, gridMaterials()));
  std::string text =
      "| materials | | lamps: khr | openpbr | physical | walks ± | sky: khr | openpbr | physical | walks ± "
      "|\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  const auto row = [&](const std::string& name, const std::function<bool(const GridMaterial&)>& of) {
    const std::vector<bool> counts = allOf(of);
    std::string lamps;
    std::string sky;
    GridErrors errors;
    for (const std::vector<Seen>& model : models) {
      errors = gridErrors(model, walks, counts);
      lamps += fmt::format(" {:.3f} |", errors.lamps);
      sky += fmt::format(" {:.3f} |", errors.sky);
    }
    text += fmt::format("| {} | {} |{} {:.3f} |{} {:.3f} |\n", name,
                        std::count(counts.begin(), counts.end(), true), lamps, errors.lamps_noise, sky,
                        errors.sky_noise);
  };
  row("all", [](const GridMaterial&) { return true; });
  for (const char* tint : {"clear", "tinted"})
    row(tint, [&](const GridMaterial& m) { return m.tinted == (std::string_view(tint) == "tinted"); });
  for (const char* base : {"diffuse", "dielectric", "metal"}) {
    for (const char* coat : {"smooth", "rough", "anisotropic"}) {
      row(fmt::format("{} coat, {}", coat, base),
          [&](const GridMaterial& m) { return m.coat == coat && m.base == base; });
    }
  }
  return text;
}

}  // namespace lacquer::accuracy
