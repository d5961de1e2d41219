#include "graph/coat_model.h"

#include <fmt/format.h>

namespace lacquer::graph {

namespace {

CoatModel fromCoat(const gltf::Coat& coat, const std::string& extensions) {
  CoatModel model;
  model.pointer = extensions;
  model.weight = coat.coatFactor;
  model.weight_texture = coat.coatTexture;
  model.weight_name = "KHR_materials_coat/coatFactor";
  model.roughness = coat.coatRoughnessFactor;
  model.roughness_texture = coat.coatRoughnessTexture;
  model.roughness_name = "KHR_materials_coat/coatRoughnessFactor";
  model.normal_texture = coat.coatNormalTexture;
  model.ior = coat.coatIor;
  model.has_color = true;
  model.color = coat.coatColorFactor;
  model.color_texture = coat.coatColorTexture;
  model.color_name = "KHR_materials_coat/coatColorFactor";
  model.has_darkening = true;
  model.darkening = coat.coatDarkeningFactor;
  model.darkening_name = "KHR_materials_coat/coatDarkeningFactor";
  model.anisotropy_strength = coat.coatAnisotropyStrength;
  model.anisotropy_rotation = coat.coatAnisotropyRotation;
  model.anisotropy_texture = coat.coatAnisotropyTexture;
  return model;
}

CoatModel fromClearcoat(const gltf::Material& material, const std::string& extensions) {
  const gltf::Clearcoat& clearcoat = *material.clearcoat;
  CoatModel model;
  model.pointer = extensions;
  model.weight = clearcoat.clearcoatFactor;
  model.weight_texture = clearcoat.clearcoatTexture;
  model.weight_name = "KHR_materials_clearcoat/clearcoatFactor";
  model.roughness = clearcoat.clearcoatRoughnessFactor;
  model.roughness_texture = clearcoat.clearcoatRoughnessTexture;
  model.roughness_name = "KHR_materials_clearcoat/clearcoatRoughnessFactor";
  model.normal_texture = clearcoat.clearcoatNormalTexture;
  model.on_emission = true;
  if (clearcoat.color) {
    model.has_color = true;
    model.color = clearcoat.color->clearcoatColorFactor;
    model.color_texture = clearcoat.color->clearcoatColorTexture;
    model.color_name =
        "KHR_materials_clearcoat/extensions/EXT_materials_clearcoat_color/clearcoatColorFactor";
  } else if (material.clearcoatTint) {
    model.has_tint = true;
    model.color = material.clearcoatTint->clearcoatTintFactor;
    model.color_texture = material.clearcoatTint->clearcoatTintTexture;
    model.color_name = "ADOBE_materials_clearcoat_tint/clearcoatTintFactor";
  }
  if (clearcoat.darkening) {
    model.has_darkening = true;
    model.darkening = clearcoat.darkening->clearcoatDarkeningFactor;
    model.darkening_texture = clearcoat.darkening->clearcoatDarkeningTexture;
    model.darkening_name =
        "KHR_materials_clearcoat/extensions/EXT_materials_clearcoat_darkening/clearcoatDarkeningFactor";
  }
  return model;
}

}  // namespace

std::optional<CoatModel> coatModel(const gltf::Material& material) {
  const std::string extensions = fmt::format("/materials/{}/extensions", material.index);
  if (material.coat) return fromCoat(*material.coat, extensions);
  if (material.clearcoat) return fromClearcoat(material, extensions);
  return std::nullopt;
}

}  // namespace lacquer::graph
