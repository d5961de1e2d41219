#include "lod/store.h"

#include "support/blob.h"

namespace lacquer {

template <class Archive>
static void fields(Archive& archive, SeenDifference& seen) {
  archive(seen.delta_e, seen.delta_e_95, seen.flip, seen.flip_95);
}

template <class Archive>
static void fields(Archive& archive, LevelFigures& figures) {
  bool on_geometry = figures.error_on_geometry.has_value();
  SeenDifference of_geometry = figures.error_on_geometry.value_or(SeenDifference());
  archive(figures.instructions, figures.cycles, figures.quarter_cycles, figures.vertex_cycles, figures.cost,
          figures.error, on_geometry, of_geometry);
  if (on_geometry) figures.error_on_geometry = of_geometry;
}

namespace lod {

Key Memory::keyOf(std::string_view what, const Words& words) const {
  KeyBuilder key;
  key.text(what).key(material_);
  for (const std::string& word : words) key.text(word);
  return key.finish();
}

std::optional<std::string> Memory::load(std::string_view what, const Words& words) const {
  return store_ == nullptr ? std::nullopt : store_->load(keyOf(what, words));
}

std::optional<Found> Memory::foundAs(std::string_view what, const Words& words) const {
  const std::optional<std::string> bytes = load(what, words);
  if (!bytes) return std::nullopt;
  BlobReader blob(*bytes);
  Found found;
  blob(found.shader, found.figures);
  return blob.complete() ? std::optional(std::move(found)) : std::nullopt;
}

void Memory::keepAs(std::string_view what, const Words& words, const Found& found) const {
  if (store_ == nullptr) return;
  BlobWriter blob;
  blob(found.shader, found.figures);
  store_->save(keyOf(what, words), blob.take());
}

std::optional<Found> Memory::found(const Words& words) const { return foundAs("level", words); }

void Memory::keep(const Words& words, const Found& found) const { keepAs("level", words, found); }

std::optional<Found> Memory::undrawn(const Words& words) const { return foundAs("cost", words); }

void Memory::keepUndrawn(const Words& words, const Found& found) const { keepAs("cost", words, found); }

std::optional<std::string> Memory::shader(const Words& words) const { return load("shader", words); }

void Memory::keepShader(const Words& words, const std::string& shader) const {
  if (store_ != nullptr) store_->save(keyOf("shader", words), shader);
}

std::optional<Found> Memory::seen(const Words& words, bool flip) const {
  return foundAs(flip ? "seen-flip" : "seen", words);
}

void Memory::keepSeen(const Words& words, bool flip, const Found& seen) const {
  keepAs(flip ? "seen-flip" : "seen", words, seen);
}

std::optional<std::optional<Words>> Memory::fitted(const Words& words) const {
  const std::optional<std::string> bytes = load("fitted", words);
  if (!bytes) return std::nullopt;
  BlobReader blob(*bytes);
  bool some = false;
  Words fitted;
  blob(some, fitted);
  if (!blob.complete()) return std::nullopt;
  return some ? std::optional(std::move(fitted)) : std::optional<Words>();
}

void Memory::keepFitted(const Words& words, const std::optional<Words>& fitted) const {
  if (store_ == nullptr) return;
  BlobWriter blob;
  blob(fitted.has_value(), fitted.value_or(Words()));
  store_->save(keyOf("fitted", words), blob.take());
}

}  // namespace lod

}  // namespace lacquer
