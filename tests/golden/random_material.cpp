#include "random_material.h"

#include <array>

namespace lacquer::test {

using Json = RandomMaterial::Json;

double RandomMaterial::number(double lo, double hi) {
  switch (random_() % 4) {
    case 0: return lo;
    case 1: return hi;
    case 2: return (lo + hi) / 2;
    default: return std::uniform_real_distribution<double>(lo, hi)(random_);
  }
}

Json RandomMaterial::color(size_t components) {
  Json json = Json::array();
  for (size_t i = 0; i < components; ++i) json.push_back(number(0, 1));
  return json;
}

Json RandomMaterial::texture(const char* strength) {
  Json json = {{"index", below(3)}};
  maybe(json, "texCoord", below(4));
  if (strength != nullptr) maybe(json, strength, strength[1] == 'c' ? number(-2, 2) : number(0, 1));
  if (!yes(3)) return json;
  Json transform = Json::object();
  maybe(transform, "offset", {number(-4, 4), number(-4, 4)});
  maybe(transform, "rotation", number(-7, 7));
  maybe(transform, "scale", {number(-3, 3), number(0, 3)});
  maybe(transform, "texCoord", below(4));
  json["extensions"]["KHR_texture_transform"] = transform;
  return json;
}

Json RandomMaterial::metallicRoughness() {
  Json json = Json::object();
  maybe(json, "baseColorFactor", color(4));
  maybe(json, "metallicFactor", number(0, 1));
  maybe(json, "roughnessFactor", number(0, 1));
  if (yes(2)) json["baseColorTexture"] = texture();
  if (yes(2)) json["metallicRoughnessTexture"] = texture();
  return json;
}

Json RandomMaterial::coat() {
  Json json = Json::object();
  maybe(json, "coatFactor", number(0, 1));
  maybe(json, "coatRoughnessFactor", number(0, 1));
  maybe(json, "coatIor", yes(8) ? 0 : number(1, 4));
  maybe(json, "coatColorFactor", color(3));
  maybe(json, "coatDarkeningFactor", number(0, 1));
  maybe(json, "coatAnisotropyStrength", number(0, 1));
  maybe(json, "coatAnisotropyRotation", number(-7, 7));
  for (const char* name :
       {"coatTexture", "coatRoughnessTexture", "coatColorTexture", "coatAnisotropyTexture"}) {
    if (yes(3)) json[name] = texture();
  }
  if (yes(3)) json["coatNormalTexture"] = texture("scale");
  return json;
}

Json RandomMaterial::clearcoat() {
  Json json = Json::object();
  maybe(json, "clearcoatFactor", number(0, 1));
  maybe(json, "clearcoatRoughnessFactor", number(0, 1));
  for (const char* name : {"clearcoatTexture", "clearcoatRoughnessTexture"}) {
    if (yes(3)) json[name] = texture();
  }
  if (yes(3)) json["clearcoatNormalTexture"] = texture("scale");
  if (yes(2)) {
    Json color_extension = Json::object();
    maybe(color_extension, "clearcoatColorFactor", color(3));
    if (yes(2)) color_extension["clearcoatColorTexture"] = texture();
    json["extensions"]["EXT_materials_clearcoat_color"] = color_extension;
  }
  if (yes(2)) {
    Json darkening = Json::object();
    maybe(darkening, "clearcoatDarkeningFactor", number(0, 1));
    if (yes(2)) darkening["clearcoatDarkeningTexture"] = texture();
    json["extensions"]["EXT_materials_clearcoat_darkening"] = darkening;
  }
  return json;
}

Json RandomMaterial::material(size_t index) {
  Json json = {{"name", "material " + std::to_string(index)}};
  maybe(json, "pbrMetallicRoughness", metallicRoughness());
  if (yes(2)) json["normalTexture"] = texture("scale");
  if (yes(3)) json["occlusionTexture"] = texture("strength");
  if (yes(3)) json["emissiveTexture"] = texture();
  if (yes(2)) json["emissiveFactor"] = color(3);
  constexpr std::array<const char*, 3> kModes = {"OPAQUE", "MASK", "BLEND"};
  if (yes(2)) json["alphaMode"] = kModes[below(3)];
  if (json.value("alphaMode", "") == "MASK") maybe(json, "alphaCutoff", number(0, 2));
  maybe(json, "doubleSided", yes(2));
  Json extensions = Json::object();
  if (yes(3)) extensions["KHR_materials_ior"]["ior"] = yes(8) ? 0 : number(1, 4);
  if (yes(3)) extensions["KHR_materials_emissive_strength"]["emissiveStrength"] = number(0, 50);
  if (yes(8)) {
    extensions["KHR_materials_unlit"] = Json::object();
  } else {
    if (yes(2)) extensions["KHR_materials_coat"] = coat();
    if (yes(2)) {
      extensions["KHR_materials_clearcoat"] = clearcoat();
      if (yes(3)) {
        extensions["ADOBE_materials_clearcoat_tint"]["clearcoatTintFactor"] = color(3);
        if (yes(2)) extensions["ADOBE_materials_clearcoat_tint"]["clearcoatTintTexture"] = texture();
      }
    }
  }
  if (yes(6) && !extensions.contains("KHR_materials_unlit"))
    extensions["KHR_materials_sheen"]["sheenColorFactor"] = color(3);
  if (!extensions.empty()) json["extensions"] = extensions;
  return json;
}

Json RandomMaterial::valid(size_t materials) {
  Json gltf = {{"asset", {{"version", "2.0"}}}, {"images", Json::array({{{"uri", "a.png"}}})}};
  gltf["textures"] = Json::array({{{"source", 0}}, {{"source", 0}}, Json::object()});
  gltf["accessors"] = Json::array(
      {{{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"min", {0, 0, 0}}, {"max", {1, 1, 1}}},
       {{"componentType", 5126}, {"count", 3}, {"type", "VEC4"}},
       {{"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}});
  Json primitives = Json::array();
  for (size_t i = 0; i < materials; ++i) {
    gltf["materials"].push_back(material(i));
    const size_t uses = 1 + below(2);
    for (size_t use = 0; use < uses; ++use) {
      Json attributes = {{"POSITION", 0}};
      if (!yes(4)) attributes["NORMAL"] = 0;
      if (attributes.contains("NORMAL") && yes(2)) attributes["TANGENT"] = 1;
      if (yes(4)) attributes["COLOR_0"] = 1;
      for (int set = 0; set < 4; ++set) {
        if (!yes(4)) attributes["TEXCOORD_" + std::to_string(set)] = 2;
      }
      primitives.push_back({{"attributes", attributes}, {"material", i}});
    }
  }
  gltf["meshes"] = Json::array({{{"primitives", primitives}}});
  return gltf;
}

Json RandomMaterial::junk(int depth) {
  constexpr std::array<const char*, 7> kWords = {"",   "OPAQUE", "../../x",           "\xF0\x9F\x98\x80",
                                                 "-1", "/a~1b",  "KHR_materials_coat"};
  switch (random_() % 14) {
    case 0: return nullptr;
    case 1: return yes(2);
    case 2: return -1;
    case 3: return 1e300;
    case 4: return -0.0;
    case 5: return 5e-324;
    case 6: return INT64_MAX;
    case 7: return UINT64_MAX;
    case 8: return INT64_MIN;
    case 9: return kWords[below(kWords.size())];
    case 10: return Json::object();
    case 11: return Json::array();
    case 12: return depth > 3 ? Json(0.5) : Json::array({junk(depth + 1), junk(depth + 1)});
    default: return depth > 3 ? Json(2) : Json{{kWords[below(kWords.size())], junk(depth + 1)}};
  }
}

/// Walks down to some place and puts junk there, or takes it away.
void RandomMaterial::damage(Json& json) {
  Json* at = &json;
  while (at->is_structured() && !at->empty() && !yes(8)) {
    auto it = at->begin();
    std::advance(it, static_cast<std::ptrdiff_t>(below(at->size())));
    if (yes(12)) {
      at->erase(it);
      return;
    }
    at = &*it;
  }
  *at = junk();
}

/// Puts an extension where it does not belong.
void RandomMaterial::misplace(Json& gltf) {
  if (!gltf.contains("materials")) return;
  Json& materials = gltf["materials"];
  if (!materials.is_array() || materials.empty() || !materials[0].is_object()) return;
  constexpr std::array<const char*, 7> kNames = {"KHR_materials_coat",
                                                 "KHR_materials_clearcoat",
                                                 "EXT_materials_clearcoat_color",
                                                 "EXT_materials_clearcoat_darkening",
                                                 "ADOBE_materials_clearcoat_tint",
                                                 "KHR_materials_unlit",
                                                 "KHR_materials_pbrSpecularGlossiness"};
  Json& at = yes(2) ? materials[0] : materials[0]["pbrMetallicRoughness"];
  if (!at.is_null() && !at.is_object()) return;
  Json& extensions = at["extensions"];
  if (extensions.is_null() || extensions.is_object()) extensions[kNames[below(kNames.size())]] = junk();
}

std::string RandomMaterial::damaged() {
  Json gltf = valid(1 + below(3));
  const size_t times = below(4);
  for (size_t i = 0; i < times; ++i) damage(gltf.contains("materials") && yes(2) ? gltf["materials"] : gltf);
  if (yes(3) && gltf.is_object()) misplace(gltf);
  std::string text = gltf.dump();
  for (size_t i = yes(3) ? 1 + below(4) : 0; i > 0 && !text.empty(); --i) {
    const size_t at = below(text.size());
    switch (random_() % 4) {
      case 0: text[at] = static_cast<char>(random_()); break;
      case 1: text.erase(at, 1 + below(5)); break;
      case 2:
        text.insert(at, std::array<const char*, 5>{"NaN", "1e999", "[[[[", "\"", "\\u0000"}[below(5)]);
        break;
      case 3:
        if (yes(4)) text.resize(at);
        break;
    }
  }
  return text;
}

}  // namespace lacquer::test
