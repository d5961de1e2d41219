// The base's lobe of OpenPBR 1.2 under one lamp: its haze, its retroreflectivity and its specular weight, as
// Adobe's openpbr-bsdf has the lobe, written from what its formulas say; and what Lacquer makes of the same
// document.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace lacquer::accuracy {

/// Inputs of an open_pbr_surface, whose body is black or which is a metal.
struct OpenPbr {
  std::string name;
  bool metal = false;
  double weight = 1, roughness = 0.3, anisotropy = 0, haze = 0, spread = 0.3, retroreflectivity = 0;
  std::array<double, 3> base{0, 0, 0}, color{1, 1, 1};
  double coat = 0;  ///< of roughness 0.4, which darkens nothing
};

/// A lamp of radiance 1 about the normal z, with a tangent along x.
struct Lamp {
  std::array<double, 3> v, l;
};
std::vector<Lamp> lamps(size_t count);

enum class Masking {
  Separable,   ///< openpbr-bsdf's
  Correlated,  ///< height-correlated, as glTF and MaterialX have it
};
/// BSDF times the light's cosine, without what bounces more than once.
std::array<double, 3> openPbrLobe(const OpenPbr& surface, const Lamp& lamp, Masking masking);

/// Colours by MaterialX's formulas (`materialx`), or translated to glTF's properties, by that profile; with
/// `white`, of white surroundings and no lamp.
std::vector<std::array<double, 3>> openPbrDrawn(const OpenPbr& surface, const std::vector<Lamp>& lamps,
                                                const char* profile, bool white = false);

std::string openPbrTable();

}  // namespace lacquer::accuracy
