// The part of a graph that does not depend on light: what the material's textures and factors say of the
// surface.
#pragma once

#include <optional>

#include "graph/build.h"
#include "graph/coat_model.h"

namespace lacquer::graph {

/// Shorthands for sources.
Source given(std::string name, std::string swizzle = {});
Source ref(std::string node, std::string output = {}, std::string swizzle = {});
Source parameter(std::string name);
Source number(double x);

struct Anisotropy {
  Source B, alpha_t, alpha_b, strength;
};

/// The coat as wired; absent members are terms that are skipped.
struct CoatSources {
  Source weight, roughness, alpha, normal, cosine, ior, F0, fresnel;
  bool textured_alpha = false;
  std::optional<Source> color;      ///< what the tint is at normal incidence
  bool absorbs = false;             ///< the colour is one that the profile's absorption takes
  std::optional<Source> tint;       ///< the ADOBE tint, whatever the light is
  std::optional<Source> darkening;  ///< how much of it
  std::optional<Anisotropy> anisotropy;
};

struct Surface {
  bool unlit = false;
  bool textured_alpha = false;
  bool textured_base = false;  ///< colour or metalness change from pixel to pixel
  Source base_color, metallic, roughness, alpha, normal;
  std::optional<Source> dielectric_f0, occlusion, emission, hidden, alpha_out;
  std::optional<CoatSources> coat;
};

class SurfaceBuilder {
public:
  SurfaceBuilder(Graph& graph, const gltf::Material& material, const gltf::VertexAttributes& attributes,
                 const BuildOptions& options, Diagnostics& warnings)
      : graph_(graph), material_(material), attributes_(attributes), options_(options), warnings_(warnings) {}

  Surface run();

private:
  struct Frame {
    Source T, B, N;
  };

  void skip(std::string term, std::string reason);
  bool live(std::string_view term) const { return options_.live.contains(std::string(term)); }

  /// An editable parameter; its source.
  Source editable(std::string name, ir::Type type, ir::Components value, ir::Interval range,
                  std::string property);
  /// The texel of a texture slot as a vec4 source; textures used twice in the same way are sampled once.
  Source texel(const gltf::TextureInfo& info, const std::string& slot, bool color);
  Source textureCoordinate(const gltf::TextureInfo& info, const std::string& slot);
  void warn(std::string code, std::string pointer, std::string message, std::string help);

  void geometry();
  Source geometricNormal();
  std::optional<Frame> tangentFrame(const gltf::TextureInfo* info, const std::string& slot);
  std::optional<Frame> mapFrame(const gltf::TextureInfo& info, const std::string& slot);
  Source facing(const Source& normal, const std::string& layer);
  Source mapped(const gltf::Texture& texture, const std::string& layer, const std::string& scale_name);

  void baseColor();
  void metallicRoughness();
  void emission();
  void occlusion();
  void alpha();
  void coat();
  void coatShape(const CoatModel& model, CoatSources& coat);
  void coatIor(const CoatModel& model, CoatSources& coat);
  void coatColor(const CoatModel& model, CoatSources& coat);
  void coatDarkening(const CoatModel& model, CoatSources& coat);
  void coatAnisotropy(const CoatModel& model, CoatSources& coat);
  void coatEmission(const CoatModel& model, const CoatSources& coat);

  Graph& graph_;
  const gltf::Material& material_;
  const gltf::VertexAttributes& attributes_;
  const BuildOptions& options_;
  Diagnostics& warnings_;
  Surface surface_;
  Source geometric_normal_;
  std::vector<std::pair<std::string, Source>> sampled_;      ///< texture, UV and colour space -> texel
  std::vector<std::pair<std::string, Source>> coordinates_;  ///< UV set and transform -> coordinate
  std::vector<std::pair<std::string, Frame>> frames_;  ///< UV set and transform -> frame from derivatives
};

}  // namespace lacquer::graph
