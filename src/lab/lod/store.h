// What is known of a material's candidates from an earlier run.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "lacquer/results.h"
#include "lod/search.h"
#include "support/key.h"

namespace lacquer {

/// Bytes by key, wherever they lie. Called from one thread at a time.
struct LevelStore {
  Key base;  ///< the build and the node files
  std::function<std::optional<std::string>(const Key&)> load{};
  std::function<void(const Key&, std::string_view)> save{};
};

namespace lod {

/// What was found of a set of words.
struct Found {
  std::string shader;  ///< its id; empty where the set makes none that may be a level
  LevelFigures figures;
};

/// What a store has of one material. A search that is given its own results makes the same steps again, up to
/// where it was ended.
class Memory {
public:
  Memory() = default;
  /// `material`: everything that the results depend on, the words excepted.
  Memory(const LevelStore& store, const Key& material) : store_(&store), material_(material) {}

  std::optional<Found> found(const Words& words) const;
  void keep(const Words& words, const Found& found) const;
  /// What is known of a set that costs too much to be drawn.
  std::optional<Found> undrawn(const Words& words) const;
  void keepUndrawn(const Words& words, const Found& found) const;
  /// The shader that a set makes, empty where it makes none.
  std::optional<std::string> shader(const Words& words) const;
  void keepShader(const Words& words, const std::string& shader) const;
  /// By pictures of the whole size; with FLIP or without.
  std::optional<Found> seen(const Words& words, bool flip) const;
  void keepSeen(const Words& words, bool flip, const Found& seen) const;
  /// The outer one is nothing where it is not known whether numbers can be fitted.
  std::optional<std::optional<Words>> fitted(const Words& words) const;
  void keepFitted(const Words& words, const std::optional<Words>& fitted) const;

private:
  std::optional<Found> foundAs(std::string_view what, const Words& words) const;
  void keepAs(std::string_view what, const Words& words, const Found& found) const;
  std::optional<std::string> load(std::string_view what, const Words& words) const;
  Key keyOf(std::string_view what, const Words& words) const;

  const LevelStore* store_ = nullptr;
  Key material_;
};

}  // namespace lod

}  // namespace lacquer
