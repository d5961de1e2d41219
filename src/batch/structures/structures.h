// The structures of a run, each made once, and the distinct shaders they need.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>

#include "structures/shapes.h"
#include "structures/structure.h"

namespace lacquer {

/// A shader that the run must deliver.
struct Distinct {
  const Structure* structure = nullptr;  ///< of those that need it the one with the smallest key
  std::optional<ir::Module> module;      ///< absent when the structure came from the cache
};

/// May be used from several threads at once.
class Structures {
public:
  explicit Structures(const Setting& setting) : setting_(setting) { forgetShapes(); }

  /// The structure of a graph, found or made. It lives as long as this object. `other`: as of structureKey().
  const Structure& of(const graph::Graph& graph, const passes::LightFacts& lights,
                      const passes::OtherLayout& other = {});
  /// A structure that this run has met or that the cache holds; null when there is none.
  const Structure* known(const Key& key);
  /// What was met so far was to look at: its shaders need not be made unless they are met again. Not beside
  /// of() and known().
  void lookAgain();

  /// The shapes of the materials so far; null where a graph depends on more than its material's shape.
  KnownShapes* shapes() { return shapes_.get(); }
  /// From here on materials are built anew: they have other graphs. Not beside of().
  void forgetShapes();

  /// By id, those that are needed. Not beside of() and known().
  std::map<std::string, Distinct>& shaders();
  size_t shaderCount() const;

private:
  struct Entry {
    std::mutex mutex;
    bool ready = false;
    Structure structure;
  };
  Entry& entryOf(const Key& key);
  bool load(const Key& key, Entry& entry);
  bool need(const Structure& structure, std::optional<ir::Module> module);
  const Structure& met(const Structure& structure);
  /// The search's result for the structure of that key at its own places: the fallback's places need it once
  /// more.
  passes::Searched takeSearched(const Key& key);

  const Setting& setting_;
  mutable std::mutex mutex_;
  std::unordered_map<Key, std::unique_ptr<Entry>, KeyHash> entries_;
  std::map<std::string, Distinct> shaders_;
  std::unordered_map<Key, passes::Searched, KeyHash> searched_;
  std::set<std::string> met_again_;
  bool looks_again_ = false;
  std::unique_ptr<KnownShapes> shapes_;
};

}  // namespace lacquer
