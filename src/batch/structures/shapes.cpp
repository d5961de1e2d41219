#include "structures/shapes.h"

namespace lacquer {

bool KnownShapes::usable(const Options& options) {
  return options.parameters != Parameters::Baked && options.simplify.empty();
}

std::string KnownShapes::keyOf(const material::Material& material, const gltf::VertexAttributes& attributes,
                               const passes::LightFacts& lights) const {
  std::string key = shapes_.keyOf(material, attributes);
  key += lights.any ? 'a' : 'f';
  for (const auto& [kind, count] : lights.counts) key += kind + '\0' + std::to_string(count) + '\0';
  return key;
}

const KnownShape* KnownShapes::find(const std::string& key) const {
  const std::lock_guard lock(mutex_);
  const auto it = known_.find(key);
  return it == known_.end() ? nullptr : it->second.get();
}

void KnownShapes::keep(const std::string& key, KnownShape shape) {
  auto kept = std::make_unique<const KnownShape>(std::move(shape));
  const std::lock_guard lock(mutex_);
  known_.emplace(key, std::move(kept));
}

Filling KnownShapes::fill(const KnownShape& shape, const material::Material& material) const {
  Filling filling;
  filling.numbers.reserve(shape.numbers.size());
  for (size_t i = 0; i < shape.numbers.size(); ++i) {
    const Filling::Number& first = shape.filling.numbers[i];
    const std::optional<model::Origin>& origin = shape.numbers[i];
    if (!origin) {
      filling.numbers.push_back(first);
      continue;
    }
    filling.numbers.push_back(
        {valueOf(*origin, material, first.value), pointerOf(*origin, material, schema_), first.animated});
  }
  filling.textures.reserve(shape.textures.size());
  for (size_t i = 0; i < shape.textures.size(); ++i) {
    Filling::Texture texture = shape.filling.textures[i];
    if (shape.textures[i]) {
      texture.info = material.texture(*shape.textures[i]);
      texture.texture = texture.info->texture;
      texture.pointer = texture.info->pointer;
    }
    filling.textures.push_back(std::move(texture));
  }
  return filling;
}

}  // namespace lacquer
