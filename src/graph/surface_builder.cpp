#include "graph/surface_builder.h"

#include <fmt/format.h>

#include "graph/coat_terms.h"

namespace lacquer::graph {

Source given(std::string name, std::string swizzle) {
  return {GivenRef{std::move(name)}, std::move(swizzle)};
}

Source ref(std::string node, std::string output, std::string swizzle) {
  return {NodeRef{std::move(node), std::move(output)}, std::move(swizzle)};
}

Source parameter(std::string name) { return {ParameterRef{std::move(name)}, {}}; }

Source number(double x) { return {Literal{ir::Type::Float, {x}}, {}}; }

namespace {

/// Texture transforms and UV sets are equal when the coordinates are.
std::string coordinateKey(const gltf::TextureInfo& info) {
  const gltf::TextureTransform t = info.transform.value_or(gltf::TextureTransform{});
  return fmt::format("{} {} {} {} {} {}", info.texCoord, t.offset[0], t.offset[1], t.rotation, t.scale[0],
                     t.scale[1]);
}

std::string_view propertyName(std::string_view pointer) { return pointer.substr(pointer.rfind('/') + 1); }

}  // namespace

void SurfaceBuilder::skip(std::string term, std::string reason) {
  graph_.skipped.push_back({std::move(term), std::move(reason)});
}

void SurfaceBuilder::warn(std::string code, std::string pointer, std::string message, std::string help) {
  warnings_.push_back({std::move(code),
                       Severity::Warning,
                       {{}, 0, 0, std::move(pointer)},
                       std::move(message),
                       std::move(help),
                       {}});
}

Source SurfaceBuilder::editable(std::string name, ir::Type type, ir::Components value, ir::Interval range,
                                std::string property) {
  graph_.parameters.push_back(
      {name, type, value, range, fmt::format("/materials/{}/{}", material_.index, property)});
  return parameter(std::move(name));
}

// -- textures --

Source SurfaceBuilder::textureCoordinate(const gltf::TextureInfo& info, const std::string& slot) {
  const std::string key = coordinateKey(info);
  for (const auto& [k, source] : coordinates_) {
    if (k == key) return source;
  }
  Source uv = given(fmt::format("uv{}", info.texCoord));
  if (!attributes_.texCoord[static_cast<size_t>(info.texCoord)]) {
    warn("texcoord-missing", info.pointer,
         fmt::format("the texture uses TEXCOORD_{}, which a primitive with this material does not have",
                     info.texCoord),
         "give the primitive that UV set, or another texCoord to the texture; (0, 0) is used");
    uv = {Literal{ir::Type::Vec2, {0, 0}}, {}};
  }
  const gltf::TextureTransform t = info.transform.value_or(gltf::TextureTransform{});
  if (!t.identity()) {
    const std::string id = slot + ".uv";
    Node& node = graph_.add(id, "uv_transform", {{"uv", uv}});
    const std::string name = slot + "_uv";
    const std::string at = fmt::format("/materials/{}/", material_.index);
    const std::string property = info.pointer.substr(at.size()) + "/extensions/KHR_texture_transform";
    if (t.offset != std::array<double, 2>{0, 0}) {
      Graph::connect(
          node, "offset",
          editable(name + "_offset", ir::Type::Vec2, {t.offset[0], t.offset[1]}, {}, property + "/offset"));
    }
    if (t.rotation != 0) {
      Graph::connect(node, "rotation",
                     editable(name + "_rotation", ir::Type::Float, {t.rotation}, {}, property + "/rotation"));
    }
    if (t.scale != std::array<double, 2>{1, 1}) {
      Graph::connect(
          node, "scale",
          editable(name + "_scale", ir::Type::Vec2, {t.scale[0], t.scale[1]}, {}, property + "/scale"));
    }
    uv = ref(id);
  }
  coordinates_.emplace_back(key, uv);
  return uv;
}

Source SurfaceBuilder::texel(const gltf::TextureInfo& info, const std::string& slot, bool color) {
  const std::string key = fmt::format("{} {} {}", info.texture, color, coordinateKey(info));
  for (const auto& [k, source] : sampled_) {
    if (k == key) return source;
  }
  const std::string name = slot + "_texture";
  ir::TextureSlot texture;
  texture.name = name;
  texture.srgb = color && !options_.decode_srgb;
  texture.texture = info.texture;
  texture.pointer = info.pointer;
  graph_.textures.push_back(texture);
  const Source uv = textureCoordinate(info, slot);
  graph_.add(slot + ".texel", "texture_sample", {{"image", {TextureRef{name}, {}}}, {"uv", uv}});
  Source result = ref(slot + ".texel");
  if (color && options_.decode_srgb) {
    graph_.add(slot + ".decoded", "srgb_decode", {{"encoded", result}});
    result = ref(slot + ".decoded");
  }
  sampled_.emplace_back(key, result);
  return result;
}

static Source pick(Source source, std::string swizzle) {
  source.swizzle = std::move(swizzle);
  return source;
}

// -- geometry --

Source SurfaceBuilder::geometricNormal() {
  if (!attributes_.normal) {
    graph_.add("normal.flat", "flat_normal", {{"position", given("position")}, {"V", given("view")}});
    return ref("normal.flat");
  }
  graph_.add("normal.unit", "unit_normal", {{"normal", given("normal")}});
  return ref("normal.unit");
}

std::optional<SurfaceBuilder::Frame> SurfaceBuilder::tangentFrame(const gltf::TextureInfo* info,
                                                                  const std::string& slot) {
  const std::string key = attributes_.tangent ? "vertex" : info == nullptr ? "" : coordinateKey(*info);
  for (const auto& [k, frame] : frames_) {
    if (k == key) return frame;
  }
  std::string id;
  if (attributes_.tangent) {
    id = "tangent.frame";
    graph_.add(id, "tangent_frame", {{"N", geometric_normal_}, {"tangent", given("tangent")}});
  } else {
    if (info == nullptr || !attributes_.texCoord[static_cast<size_t>(info->texCoord)]) return std::nullopt;
    id = slot + ".frame";
    const Source uv = textureCoordinate(*info, slot);
    graph_.add(id, "tangent_frame_from_derivatives",
               {{"N", geometric_normal_}, {"position", given("position")}, {"uv", uv}});
  }
  const Frame frame{ref(id, "T"), ref(id, "B"), geometric_normal_};
  frames_.emplace_back(key, frame);
  return frame;
}

/// The frame that a normal map's texels are decoded in. From the vertices it is as MikkTSpace encoded it:
/// nothing is normalized before the result is.
std::optional<SurfaceBuilder::Frame> SurfaceBuilder::mapFrame(const gltf::TextureInfo& info,
                                                              const std::string& slot) {
  if (!attributes_.tangent || !attributes_.normal) return tangentFrame(&info, slot);
  const std::string id = "normal.frame";
  if (graph_.find(id) == nullptr)
    graph_.add(id, "tangent_frame", {{"N", given("normal")}, {"tangent", given("tangent")}});
  return Frame{ref(id, "T"), ref(id, "B"), given("normal")};
}

Source SurfaceBuilder::facing(const Source& normal, const std::string& layer) {
  if (!material_.doubleSided) return normal;
  const std::string id = layer + ".facing";
  graph_.add(id, "double_sided_normal", {{"N", normal}, {"front_facing", given("front_facing")}});
  return ref(id);
}

Source SurfaceBuilder::mapped(const gltf::Texture& texture, const std::string& layer,
                              const std::string& scale_name) {
  const std::string slot = layer == "base" ? "normal" : layer + "_normal";
  const std::string term = layer + ".normal_map";
  if (!texture) {
    skip(term, "there is no normal texture");
    return geometric_normal_;
  }
  if (texture->scale == 0 && !live(term)) {
    skip(term, "the normal texture's scale is 0");
    return geometric_normal_;
  }
  const std::optional<Frame> frame = mapFrame(*texture, slot);
  if (!frame) {
    warn(
        "tangent-space-missing", texture->pointer,
        "the normal texture has no tangent space: the primitive has neither TANGENT nor the texture's UV set",
        "give the primitive TANGENT or the UV set; the texture is left out");
    skip(term, "the primitive has no tangent space");
    return geometric_normal_;
  }
  const Source image = texel(*texture, slot, false);
  Node& node = graph_.add(term, "normal_map",
                          {{"texel", pick(image, "rgb")}, {"T", frame->T}, {"B", frame->B}, {"N", frame->N}});
  if (texture->scale != 1 || live(term)) {
    const std::string property =
        texture->pointer.substr(fmt::format("/materials/{}/", material_.index).size());
    Graph::connect(node, "scale",
                   editable(scale_name, ir::Type::Float, {texture->scale}, {}, property + "/scale"));
  }
  return ref(term);
}

void SurfaceBuilder::geometry() {
  geometric_normal_ = geometricNormal();
  const bool shared = !material_.normalTexture;
  surface_.normal =
      facing(mapped(material_.normalTexture, "base", "normal_scale"), shared ? "normal" : "base");
}

// -- the base --

void SurfaceBuilder::baseColor() {
  const gltf::Vec4& f = material_.baseColorFactor;
  Inputs inputs;
  inputs.emplace_back("factor", editable("base_color_factor", ir::Type::Vec4, {f[0], f[1], f[2], f[3]},
                                         {0, 1}, "pbrMetallicRoughness/baseColorFactor"));
  if (material_.baseColorTexture) {
    inputs.emplace_back("texel", texel(*material_.baseColorTexture, "base_color", true));
  }
  if (attributes_.color0) inputs.emplace_back("vertex_color", given("color0"));
  surface_.textured_base = material_.baseColorTexture || attributes_.color0;
  graph_.add("base.color", "base_color", std::move(inputs));
  surface_.base_color = ref("base.color");
}

void SurfaceBuilder::metallicRoughness() {
  Inputs inputs;
  inputs.emplace_back("metallic_factor",
                      editable("metallic_factor", ir::Type::Float, {material_.metallicFactor}, {0, 1},
                               "pbrMetallicRoughness/metallicFactor"));
  inputs.emplace_back("roughness_factor",
                      editable("roughness_factor", ir::Type::Float, {material_.roughnessFactor}, {0, 1},
                               "pbrMetallicRoughness/roughnessFactor"));
  if (material_.metallicRoughnessTexture) {
    inputs.emplace_back("texel", texel(*material_.metallicRoughnessTexture, "metallic_roughness", false));
    surface_.textured_alpha = true;
    surface_.textured_base = true;
  }
  graph_.add("base.metallic_roughness", "metallic_roughness", std::move(inputs));
  surface_.metallic = ref("base.metallic_roughness", "metallic");
  surface_.roughness = ref("base.metallic_roughness", "roughness");
  if (options_.template_name == "surface") return;

  graph_.add("base.alpha", "alpha_from_roughness", {{"roughness", surface_.roughness}});
  surface_.alpha = ref("base.alpha");
  if (material_.ior != 1.5 || live("base.f0")) {
    graph_.add("base.f0", "f0_from_ior",
               {{"ior", editable("ior", ir::Type::Float, {material_.ior}, {0, 1e9},
                                 "extensions/KHR_materials_ior/ior")}});
    surface_.dielectric_f0 = ref("base.f0");
  } else {
    skip("base.f0", "the IOR is 1.5: F0 is 0.04");
  }
  Node& node =
      graph_.add("base.reflectance", "metallic_mix",
                 {{"base_color", pick(surface_.base_color, "rgb")}, {"metallic", surface_.metallic}});
  if (surface_.dielectric_f0) Graph::connect(node, "dielectric_f0", *surface_.dielectric_f0);
}

void SurfaceBuilder::occlusion() {
  if (!material_.occlusionTexture) return skip("occlusion", "there is no occlusion texture");
  if (material_.occlusionTexture->strength == 0 && !live("occlusion")) {
    return skip("occlusion", "the occlusion texture's strength is 0");
  }
  if (options_.template_name == "bsdf" || (options_.template_name == "forward" && !options_.ibl)) {
    return skip("occlusion", "there is no indirect light");
  }
  const Source image = texel(*material_.occlusionTexture, "occlusion", false);
  Node& node = graph_.add("occlusion", "occlusion", {{"texel", pick(image, "r")}});
  if (material_.occlusionTexture->strength != 1 || live("occlusion")) {
    Graph::connect(node, "strength",
                   editable("occlusion_strength", ir::Type::Float, {material_.occlusionTexture->strength},
                            {0, 1}, "occlusionTexture/strength"));
  }
  surface_.occlusion = ref("occlusion");
}

void SurfaceBuilder::emission() {
  const gltf::Vec3& f = material_.emissiveFactor;
  if (f == gltf::Vec3{0, 0, 0} && !live("emission")) return skip("emission", "emissiveFactor is black");
  if (material_.emissiveStrength == 0 && !live("emission")) return skip("emission", "emissiveStrength is 0");
  Inputs inputs;
  inputs.emplace_back(
      "factor", editable("emissive_factor", ir::Type::Vec3, {f[0], f[1], f[2]}, {0, 1}, "emissiveFactor"));
  if (material_.emissiveStrength != 1 || live("emission")) {
    inputs.emplace_back("strength",
                        editable("emissive_strength", ir::Type::Float, {material_.emissiveStrength},
                                 {0, std::numeric_limits<double>::infinity()},
                                 "extensions/KHR_materials_emissive_strength/emissiveStrength"));
  }
  if (material_.emissiveTexture) {
    inputs.emplace_back("texel", pick(texel(*material_.emissiveTexture, "emissive", true), "rgb"));
  }
  graph_.add("emission", "emission", std::move(inputs));
  surface_.emission = ref("emission");
}

void SurfaceBuilder::alpha() {
  const Source alpha = pick(surface_.base_color, "a");
  switch (material_.alphaMode) {
    case gltf::AlphaMode::Opaque: return skip("alpha", "alphaMode is OPAQUE");
    case gltf::AlphaMode::Blend: surface_.alpha_out = alpha; return;
    case gltf::AlphaMode::Mask: break;
  }
  graph_.add("alpha.mask", "alpha_mask",
             {{"alpha", alpha},
              {"cutoff", editable("alpha_cutoff", ir::Type::Float, {material_.alphaCutoff},
                                  {0, std::numeric_limits<double>::infinity()}, "alphaCutoff")}});
  surface_.hidden = ref("alpha.mask");
}

// -- the coat --

void SurfaceBuilder::coat() {
  const std::optional<CoatModel> model = coatModel(material_);
  if (!model) return;
  if (model->weight == 0 && !live("coat")) {
    return skip("coat", fmt::format("{} is 0", propertyName(model->weight_name)));
  }
  CoatSources coat;
  coatShape(*model, coat);
  coatColor(*model, coat);
  coatDarkening(*model, coat);
  coatAnisotropy(*model, coat);
  coatEmission(*model, coat);
  surface_.coat = coat;
}

void SurfaceBuilder::coatShape(const CoatModel& model, CoatSources& coat) {
  const bool lit = options_.template_name != "surface";
  Inputs inputs;
  const std::string at = "extensions/";
  inputs.emplace_back("weight_factor", editable("coat_factor", ir::Type::Float, {model.weight}, {0, 1},
                                                at + model.weight_name));
  inputs.emplace_back("roughness_factor", editable("coat_roughness_factor", ir::Type::Float,
                                                   {model.roughness}, {0, 1}, at + model.roughness_name));
  if (model.weight_texture) {
    inputs.emplace_back("weight_texel", pick(texel(*model.weight_texture, "coat", false), "r"));
  }
  if (model.roughness_texture) {
    inputs.emplace_back("roughness_texel",
                        pick(texel(*model.roughness_texture, "coat_roughness", false), "g"));
    coat.textured_alpha = true;
  }
  graph_.add("coat.surface", "coat_surface", std::move(inputs));
  coat.weight = ref("coat.surface", "weight");
  coat.roughness = ref("coat.surface", "roughness");

  // Reading 9: the coat follows the geometry unless it has a map of its own.
  const bool own = model.normal_texture.has_value();
  const bool shared = !own && !material_.normalTexture;
  const Source normal = mapped(model.normal_texture, "coat", "coat_normal_scale");
  coat.normal = shared ? surface_.normal : facing(normal, "coat");

  coatIor(model, coat);
  if (!lit) return;
  graph_.add("coat.alpha", "alpha_from_roughness", {{"roughness", coat.roughness}});
  coat.alpha = ref("coat.alpha");
  graph_.add("coat.view_cosine", "view_cosine", {{"N", coat.normal}, {"V", given("view")}});
  coat.cosine = ref("coat.view_cosine");
  coat.fresnel = CoatTerms(graph_, surface_, coat).term(options_.profile->fresnel);
}

void SurfaceBuilder::coatIor(const CoatModel& model, CoatSources& coat) {
  coat.ior = number(1.5);
  coat.F0 = number(0.04);
  if (model.ior == 1.5 && !live("coat.f0")) return skip("coat.f0", "the coat's IOR is 1.5: F0 is 0.04");
  coat.ior =
      editable("coat_ior", ir::Type::Float, {model.ior}, {0, 1e9}, "extensions/KHR_materials_coat/coatIor");
  if (options_.template_name != "surface" && options_.profile->fresnel_from != "F0") {
    return skip("coat.f0", fmt::format("the profile {} takes the IOR itself", options_.profile->name));
  }
  graph_.add("coat.f0", "f0_from_ior", {{"ior", coat.ior}});
  coat.F0 = ref("coat.f0");
}

void SurfaceBuilder::coatColor(const CoatModel& model, CoatSources& coat) {
  const std::string term = model.has_tint ? "coat.tint" : "coat.absorption";
  if (!model.has_color && !model.has_tint && !live(term)) {
    return skip("coat.absorption", "the material has neither EXT_materials_clearcoat_color nor a tint");
  }
  const bool white = model.color == gltf::Vec3{1, 1, 1};
  if (white && !model.color_texture && !live(term)) {
    return skip(term, fmt::format("{} is white and there is no texture", propertyName(model.color_name)));
  }
  const gltf::Vec3& c = model.color;
  const std::string pointer =
      "extensions/" + (model.color_name.empty()
                           ? std::string("KHR_materials_clearcoat/extensions/"
                                         "EXT_materials_clearcoat_color/clearcoatColorFactor")
                           : model.color_name);
  Inputs inputs;
  inputs.emplace_back("factor",
                      editable("coat_color_factor", ir::Type::Vec3, {c[0], c[1], c[2]}, {0, 1}, pointer));
  if (model.color_texture)
    inputs.emplace_back("texel", pick(texel(*model.color_texture, "coat_color", true), "rgb"));
  graph_.add("coat.color", "coat_color", std::move(inputs));
  coat.color = ref("coat.color");
  if (options_.template_name == "surface") return;
  if (model.has_tint) {
    graph_.add(term, "coat_tint", {{"tint", *coat.color}});
    coat.tint = ref(term);
    return;
  }
  coat.absorbs = true;
  // Where all light is absorbed alike, the term stands with the surface.
  const Profile& profile = *options_.profile;
  if (profile.absorption_direct.id == profile.absorption_ibl.id) {
    CoatTerms(graph_, surface_, coat).term(profile.absorption_direct);
  }
}

void SurfaceBuilder::coatDarkening(const CoatModel& model, CoatSources& coat) {
  const std::string term = "coat.darkening";
  if (!model.has_darkening && !live(term)) {
    return skip(term, "the material has no EXT_materials_clearcoat_darkening");
  }
  if (model.darkening == 0 && !live(term)) {
    return skip(term, fmt::format("{} is 0", propertyName(model.darkening_name)));
  }
  const std::string pointer =
      "extensions/" +
      (model.darkening_name.empty()
           ? std::string("KHR_materials_clearcoat/extensions/EXT_materials_clearcoat_darkening/"
                         "clearcoatDarkeningFactor")
           : model.darkening_name);
  Inputs inputs;
  inputs.emplace_back("factor",
                      editable("coat_darkening_factor", ir::Type::Float, {model.darkening}, {0, 1}, pointer));
  if (model.darkening_texture) {
    inputs.emplace_back("texel", pick(texel(*model.darkening_texture, "coat_darkening", false), "r"));
  }
  graph_.add("coat.darkening_amount", "coat_darkening_amount", std::move(inputs));
  coat.darkening = ref("coat.darkening_amount");
}

void SurfaceBuilder::coatAnisotropy(const CoatModel& model, CoatSources& coat) {
  const std::string term = "coat.anisotropy";
  if (model.weight_name.starts_with("KHR_materials_clearcoat")) return;
  if (model.anisotropy_strength == 0 && !live(term)) return skip(term, "coatAnisotropyStrength is 0");
  const gltf::Texture& map = model.anisotropy_texture;
  const gltf::TextureInfo uv0{};
  const gltf::TextureInfo* frame_uv = map ? &*map : model.normal_texture ? &*model.normal_texture : &uv0;
  const std::optional<Frame> frame =
      tangentFrame(frame_uv, map || !model.normal_texture ? "coat_anisotropy" : "coat_normal");
  if (!frame) {
    warn("tangent-space-missing", fmt::format("/materials/{}/extensions/KHR_materials_coat", material_.index),
         "the coat is anisotropic, but the primitive has neither TANGENT nor texture coordinates",
         "give the primitive TANGENT (the specification requires it); an isotropic coat is used");
    return skip(term, "the primitive has no tangent space");
  }
  Source strength = editable("coat_anisotropy_strength", ir::Type::Float, {model.anisotropy_strength}, {0, 1},
                             "extensions/KHR_materials_coat/coatAnisotropyStrength");
  if (options_.template_name == "surface" && !map) {
    coat.anisotropy = Anisotropy{{}, {}, {}, strength};
    return;
  }
  std::optional<Source> direction;
  if (model.anisotropy_rotation != 0 || live(term)) {
    graph_.add("coat.rotation", "rotation_direction",
               {{"angle", editable("coat_anisotropy_rotation", ir::Type::Float, {model.anisotropy_rotation},
                                   {}, "extensions/KHR_materials_coat/coatAnisotropyRotation")}});
    direction = ref("coat.rotation");
  }
  if (map) {
    graph_.add("coat.anisotropy_texel", "anisotropy_texel",
               {{"texel", pick(texel(*map, "coat_anisotropy", false), "rgb")}});
    graph_.add("coat.anisotropy_strength", "scaled",
               {{"value", ref("coat.anisotropy_texel", "strength")}, {"factor", strength}});
    strength = ref("coat.anisotropy_strength");
    const Source texel_direction = ref("coat.anisotropy_texel", "direction");
    if (direction) {
      graph_.add("coat.direction", "rotate_direction",
                 {{"direction", texel_direction}, {"rotation", *direction}});
      direction = ref("coat.direction");
    } else {
      direction = texel_direction;
    }
  }
  if (options_.template_name == "surface") {
    coat.anisotropy = Anisotropy{{}, {}, {}, strength};
    return;
  }
  Node& node = graph_.add("coat.anisotropy", "anisotropy_across",
                          {{"N", coat.normal}, {"T", frame->T}, {"B", frame->B}});
  if (direction) Graph::connect(node, "direction", *direction);
  graph_.add("coat.anisotropic_alpha", "anisotropic_alpha", {{"alpha", coat.alpha}, {"strength", strength}});
  coat.anisotropy = Anisotropy{ref("coat.anisotropy"), ref("coat.anisotropic_alpha", "alpha_t"),
                               ref("coat.anisotropic_alpha", "alpha_b"), strength};
}

void SurfaceBuilder::coatEmission(const CoatModel& model, const CoatSources& coat) {
  if (!surface_.emission || options_.template_name == "surface") return;
  if (!model.on_emission) return skip("emission.coated", "KHR_materials_coat leaves the emission untouched");
  std::optional<Source> absorption = coat.tint;
  const Profile& profile = *options_.profile;
  if (coat.absorbs) absorption = CoatTerms(graph_, surface_, coat).term(profile.absorption_emission);
  Node& through = graph_.add("emission.transmission",
                             absorption ? std::string(profile.transmission) : "coat_transmission_clear",
                             {{"weight", coat.weight}, {"fresnel", coat.fresnel}});
  if (absorption) Graph::connect(through, "absorption", *absorption);
  graph_.add("emission.coated", "coat_over_emission",
             {{"emission", *surface_.emission}, {"transmission", ref("emission.transmission")}});
  surface_.emission = ref("emission.coated");
}

Surface SurfaceBuilder::run() {
  baseColor();
  alpha();
  if (material_.unlit && options_.template_name != "surface") {
    surface_.unlit = true;
    surface_.emission = pick(surface_.base_color, "rgb");
    skip("lighting", "KHR_materials_unlit");
    return surface_;
  }
  geometry();
  metallicRoughness();
  occlusion();
  emission();
  coat();
  return surface_;
}

}  // namespace lacquer::graph
