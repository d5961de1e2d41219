#include "structures/structures.h"

#include <fmt/format.h>

namespace lacquer {

Structures::Entry& Structures::entryOf(const Key& key) {
  const std::lock_guard lock(mutex_);
  std::unique_ptr<Entry>& entry = entries_[key];
  if (!entry) entry = std::make_unique<Entry>();
  return *entry;
}

bool Structures::load(const Key& key, Entry& entry) {
  if (setting_.cache == nullptr) return false;
  const StageTimer timer(setting_.times, StageOfRun::Cache);
  const std::optional<std::string> bytes = setting_.cache->get(key);
  if (!bytes) return false;
  Structure structure;
  if (!fromBlob(*bytes, structure) || !setting_.keys->take(key, structure.content)) return false;
  structure.key = key;
  structure.content.clear();
  entry.structure = std::move(structure);
  entry.ready = need(entry.structure, std::nullopt);
  return entry.ready;
}

/// False where another shader has its id.
bool Structures::need(const Structure& structure, std::optional<ir::Module> module) {
  if (structure.shader.empty()) return true;
  const std::lock_guard lock(mutex_);
  Distinct& shader = shaders_[structure.shader];
  if (shader.structure != nullptr && shader.structure->module != structure.module) return false;
  if (shader.structure == nullptr || structure.key < shader.structure->key) shader.structure = &structure;
  if (module && !shader.module) shader.module = std::move(module);
  return true;
}

namespace {

Diagnostic sameId(const std::string& id) {
  return {"same-id",
          Severity::Error,
          {},
          fmt::format("another shader of this run has the identifier '{}'", id),
          "128 bits of their digests are equal: please report both materials",
          {}};
}

}  // namespace

const Structure& Structures::of(const graph::Graph& graph, const passes::LightFacts& lights,
                                const passes::OtherLayout& other) {
  const Key key = structureKey(graph, lights, setting_, other);
  Entry& entry = entryOf(key);
  const std::lock_guard lock(entry.mutex);
  if ((entry.ready || load(key, entry)) && fits(entry.structure, graph)) return met(entry.structure);
  entry.structure = {};
  entry.structure.key = key;
  const bool twice = setting_.options.optimize > 0 && setting_.options.fallback;
  passes::Searched searched;
  if (twice && !other.empty()) searched = takeSearched(structureKey(graph, lights, setting_));
  std::optional<ir::Module> module =
      makeStructure(graph, lights, other, setting_, entry.structure, twice ? &searched : nullptr);
  if (twice && other.empty()) {
    const std::lock_guard held(mutex_);
    searched_[key] = std::move(searched);
  }
  entry.ready = true;
  if (module && setting_.cache != nullptr) {
    const StageTimer timer(setting_.times, StageOfRun::Cache);
    entry.structure.content = setting_.keys->contentOf(key);
    setting_.cache->put(key, toBlob(entry.structure));
    entry.structure.content.clear();
  }
  if (!need(entry.structure, std::move(module))) {
    entry.structure.diagnostics.push_back(sameId(entry.structure.shader));
    entry.structure.shader.clear();
  }
  return met(entry.structure);
}

passes::Searched Structures::takeSearched(const Key& key) {
  const std::lock_guard lock(mutex_);
  const auto found = searched_.find(key);
  if (found == searched_.end()) return {};
  passes::Searched taken = std::move(found->second);
  searched_.erase(found);
  return taken;
}

const Structure& Structures::met(const Structure& structure) {
  if (!looks_again_) return structure;
  const std::lock_guard lock(mutex_);
  met_again_.insert(structure.shader);
  return structure;
}

void Structures::lookAgain() {
  looks_again_ = true;
  forgetShapes();
}

void Structures::forgetShapes() {
  shapes_.reset();
  const auto model = setting_.library.models.of(setting_.options.profile);
  const auto schema = setting_.library.models.schema();
  if (KnownShapes::usable(setting_.options) && model && schema)
    shapes_ = std::make_unique<KnownShapes>(**model, **schema);
}

std::map<std::string, Distinct>& Structures::shaders() {
  if (looks_again_) std::erase_if(shaders_, [&](const auto& one) { return !met_again_.contains(one.first); });
  return shaders_;
}

const Structure* Structures::known(const Key& key) {
  Entry& entry = entryOf(key);
  const std::lock_guard lock(entry.mutex);
  return entry.ready || load(key, entry) ? &met(entry.structure) : nullptr;
}

size_t Structures::shaderCount() const {
  const std::lock_guard lock(mutex_);
  return shaders_.size();
}

}  // namespace lacquer
