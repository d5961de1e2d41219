// The coat family on one footing: KHR_materials_coat and KHR_materials_clearcoat with its extensions say the
// same things in different words.
#pragma once

#include <optional>
#include <string>

#include "gltf/material.h"

namespace lacquer::graph {

struct CoatModel {
  double weight = 0;
  double roughness = 0;
  gltf::Texture weight_texture, roughness_texture, normal_texture;
  double ior = 1.5;
  bool has_color = false;     ///< a view-dependent colour
  bool has_tint = false;      ///< the ADOBE tint (reading 7)
  gltf::Vec3 color{1, 1, 1};  ///< of the colour or the tint
  gltf::Texture color_texture;
  bool has_darkening = false;
  double darkening = 0;
  gltf::Texture darkening_texture;
  double anisotropy_strength = 0, anisotropy_rotation = 0;
  gltf::Texture anisotropy_texture;
  bool on_emission = false;  ///< the coat lies over the emission (reading 4)
  std::string pointer;       ///< of the material's `extensions`
  // Where the properties stand, from `pointer` on: "KHR_materials_coat/coatFactor".
  std::string weight_name, roughness_name, color_name, darkening_name;
};

/// What the material's coat is, or nothing without one. KHR_materials_coat wins (reading 8).
std::optional<CoatModel> coatModel(const gltf::Material& material);

}  // namespace lacquer::graph
