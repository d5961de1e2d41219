// Closures of MaterialX's physically based library: which there are, and what the library calls their nodes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "mtlx/element.h"

namespace lacquer::materialx {

/// What a surface may be made of.
inline constexpr std::string_view kClosures[] = {"oren_nayar_diffuse_bsdf",
                                                 "burley_diffuse_bsdf",
                                                 "translucent_bsdf",
                                                 "dielectric_bsdf",
                                                 "conductor_bsdf",
                                                 "generalized_schlick_bsdf",
                                                 "subsurface_bsdf",
                                                 "sheen_bsdf",
                                                 "uniform_edf",
                                                 "conical_edf",
                                                 "generalized_schlick_edf",
                                                 "absorption_vdf",
                                                 "anisotropic_vdf",
                                                 "layer",
                                                 "mix",
                                                 "add",
                                                 "multiply",
                                                 "surface",
                                                 "surface_unlit"};

/// What the library calls the node of an element: combinators have a name for each kind of closure.
std::string libraryName(const Element& element);

/// What an element that combines closures takes and gives; empty for all others.
std::string_view combines(const Element& element);

/// Why an element is not drawn, and what is instead.
struct Refusal {
  std::string why, help;
};

/// Of hair, volumes, lights and what combines media; nothing for all others.
std::optional<Refusal> refused(const Element& element);

}  // namespace lacquer::materialx
