// White rooms: under surroundings and a frame behind of 1, without lamps, no material gives back more than 1,
// from wherever it is seen and whatever its textures hold.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "physics/subject.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::physics::white_room_test {
namespace {

/// The fits and tables are this far from their integrals, where they are above.
constexpr double kTolerance = 2e-3;

std::vector<Sample> views() {
  std::vector<Sample> samples;
  for (const double cosine : {1.0, 0.8, 0.5, 0.2, 0.05, 0.01}) {
    for (const double azimuth : {0.0, 1.3, 2.9}) {
      Sample s;
      s.v = tilted(cosine, azimuth);
      s.light = {0, 0, 0};
      samples.push_back(s);
    }
  }
  return samples;
}

/// What a material shows in a white room. Its own light is taken away.
void expectWhiteAtMost(const std::string& file, size_t material, const std::string& profile, bool table,
                       double texel) {
  Configuration setup;
  setup.profile = profile;
  setup.ibl = true;
  setup.dfg_table = table;
  // A normal map that leans nowhere: z is what the texel's blue says of it.
  setup.texel = Vec4{texel, texel, texel, 1};
  const Subject subject(file, material, {}, setup);
  if (!subject) return;
  const std::vector<Sample> samples = views();
  const std::vector<Vec4> own = subject.colors<double>(samples, {0, 0, 0});
  const std::vector<Vec4> shown = subject.colors<double>(samples, {1, 1, 1});
  for (size_t i = 0; i < samples.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const double reflected = shown[i][c] - own[i][c];
      EXPECT_GE(reflected, -1e-9) << "N.V " << samples[i].v[2];
      EXPECT_LE(reflected, 1 + kTolerance) << "N.V " << samples[i].v[2];
    }
  }
}

void expectWhiteRooms(const std::filesystem::path& path) {
  const std::string file = test::readFile(path);
  const Result<material::Document> document = test::materialsOf(file, path.string());
  ASSERT_TRUE(document);
  for (size_t i = 0; i < document->materials.size(); ++i) {
    const std::string& name = document->materials[i].name;
    SCOPED_TRACE(path.filename().string() + ": " + name);
    for (const char* const profile : {"khr", "openpbr", "physical"})
      expectWhiteAtMost(file, i, profile, true, 1);
    for (const double texel : {0.0, 0.5}) expectWhiteAtMost(file, i, "khr", true, texel);
    expectWhiteAtMost(file, i, "khr", false, 0.75);
  }
}

TEST(WhiteRoom, HasNoMaterialOfTheSamplesAboveOne) {
  size_t files = 0;
  for (const auto& path : test::findFiles(test::sourceFolder() / "examples", ".gltf")) {
    expectWhiteRooms(path);
    ++files;
  }
  EXPECT_GE(files, 11U);
}

TEST(WhiteRoom, HasNoMaterialOfEverythingTogetherAboveOne) {
  const char* set = std::getenv("LACQUER_ASSETS");
  const std::filesystem::path assets = set != nullptr ? set : test::sourceFolder() / "../shared/assets";
  const std::filesystem::path file = assets / "extensions/EverythingTogether.glb";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << "; set LACQUER_ASSETS";
  expectWhiteRooms(file);
}

}  // namespace
}  // namespace lacquer::physics::white_room_test
