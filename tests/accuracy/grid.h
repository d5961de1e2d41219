// Coated materials of all kinds under lamps and under a white sky: what the profiles make of them, and what
// walks through the layers do.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy/layers.h"

namespace lacquer::accuracy {

/// Of a material: views, and lamps for each of them.
inline constexpr size_t kViews = 2, kLamps = 3;

struct GridMaterial {
  std::string_view coat, base;  ///< its classes
  bool tinted = false;
  double ior = 1.5, roughness = 0, strength = 0;  ///< of the coat
  double base_roughness = 1;
  Vec3 tint{1, 1, 1};
  Base under;
  std::array<Vec3, kViews> views{};
  std::array<std::array<Vec3, kLamps>, kViews> lamps{};
};

/// The same 500 always.
const std::vector<GridMaterial>& gridMaterials();

/// What is seen of a material: by view the lamps, each of the radiance pi, and the sky, of radiance 1.
struct Seen {
  std::array<std::array<Vec3, kLamps>, kViews> lamps{};
  std::array<Vec3, kViews> sky{};
};

/// By walks from the eye, and the standard deviations of their means.
struct WalkedSeen {
  Seen mean, deviation;
};
/// Walks for each view with its lamps, and for each view of the sky, which are as cheap as they are noisy.
struct Paths {
  size_t lamps = 20000, sky = 64000;
};
WalkedSeen walkGrid(const GridMaterial& material, Paths paths, uint64_t seed);

/// The walks of all materials, as tests/accuracy/walks.txt has them, which `walksText()` makes in minutes.
std::vector<WalkedSeen> readWalks();
std::string walksText();
std::filesystem::path walksFile();

/// By a profile, of each material.
std::vector<Seen> gridOf(const std::string& profile, const std::vector<GridMaterial>& materials);

/// Root mean squares of relative errors: (model - walk) / max(walk, 1/256), over views, lamps and channels,
/// less what the walks' own noise adds to it, which `noise` is.
struct GridErrors {
  double lamps = 0, sky = 0;
  double lamps_noise = 0, sky_noise = 0;
};
/// Over the materials that `counts`, by index, is true of.
GridErrors gridErrors(const std::vector<Seen>& model, const std::vector<WalkedSeen>& walks,
                      const std::vector<bool>& counts);

/// By class of material.
std::string gridTable();

}  // namespace lacquer::accuracy
