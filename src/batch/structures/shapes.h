// Materials of a run whose graphs are one but for the numbers (model/shape.h): the first of them is built,
// the others fill their numbers into what it needs.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "model/shape.h"
#include "structures/structure.h"

namespace lacquer {

struct KnownShape {
  const Structure* structure = nullptr;
  Sharing::Share share;
  Filling filling;  ///< of the first material
  /// Where another has its numbers from; none for those that are not the material's.
  std::vector<std::optional<model::Origin>> numbers;
  std::vector<std::optional<uint16_t>> textures;  ///< likewise: properties
  std::shared_ptr<const KnownShape> fallback{};   ///< what stands beside it; null where nothing does
};

/// May be used from several threads at once.
class KnownShapes {
public:
  /// None where graphs depend on more than shapes: on numbers that are constants or that `simplify` sets.
  static bool usable(const Options& options);
  KnownShapes(const model::Model& model, const material::Schema& schema) : shapes_(model), schema_(schema) {}

  std::string keyOf(const material::Material& material, const gltf::VertexAttributes& attributes,
                    const passes::LightFacts& lights) const;
  /// Null for a shape that was not kept. It stays as long as this object.
  const KnownShape* find(const std::string& key) const;
  void keep(const std::string& key, KnownShape shape);
  /// What a material of the shape fills in.
  Filling fill(const KnownShape& shape, const material::Material& material) const;

private:
  model::Shapes shapes_;
  const material::Schema& schema_;
  mutable std::mutex mutex_;
  std::unordered_map<std::string, std::unique_ptr<const KnownShape>> known_;
};

}  // namespace lacquer
