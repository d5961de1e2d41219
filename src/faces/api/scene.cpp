#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "api/internal.h"
#include "eval/in_memory.h"
#include "manifest/values.h"
#include "setting/attributes.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "setting/watched.h"
#include "shader/module.h"
#include "support/file.h"

namespace lacquer {

namespace {

/// Kept by the library, which the options' folders name; the built-in one's stays.
struct SchemaOf {
  std::shared_ptr<const Language> language;
  const material::Schema* schema = nullptr;
};

Result<SchemaOf> schemaFor(const Options& options) {
  const Result<std::shared_ptr<const Language>> language = libraryFor(options);
  if (!language) return tl::make_unexpected(language.error());
  const Result<const material::Schema*> schema = (*language)->models.schema();
  if (!schema) return tl::make_unexpected(schema.error());
  return SchemaOf{*language, *schema};
}

}  // namespace

const Scene::Impl& Scene::impl() const {
  static const Impl kNone;
  return impl_ ? *impl_ : kNone;
}

const material::Material* Scene::Impl::material(size_t index, Messages& messages) const {
  if (index < document.materials.size()) return &document.materials[index];
  report(fail("no-such-material", {}, fmt::format("there is no material {}", index),
              fmt::format("the file has {}, counted from 0", document.materials.size()))
             .value(),
         document.path, messages);
  return nullptr;
}

bool SceneData::hasOwnFormulas() const {
  return !translates(options) &&
         std::any_of(document.materials.begin(), document.materials.end(),
                     [](const material::Material& one) { return !one.closures.empty(); });
}

Result<std::string> SceneData::text() const {
  if (bytes) return *bytes;
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return tl::make_unexpected(limits.error());
  return readFile(document.path, limits->file);
}

const std::vector<std::pair<std::string, std::string>>* SceneData::included() const {
  return options.document_texts.empty() ? nullptr : &options.document_texts;
}

Result<void> SceneData::read(const std::string& of, const std::string& name) {
  const Result<const material::Schema*> schema = language->models.schema();
  if (!schema) return tl::make_unexpected(schema.error());
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return tl::make_unexpected(limits.error());
  Result<material::Document> made =
      material::readText(of, name, **schema, {options.permissive, *limits, included(), translates(options)});
  if (!made) return tl::make_unexpected(std::move(made.error()));
  document = std::move(*made);
  return {};
}

std::optional<SceneData> SceneData::translated(Messages& messages) const {
  SceneData made{{}, language, bytes, translating(options)};
  const Result<std::string> of = text();
  const Result<void> read = of ? made.read(*of, document.path) : tl::make_unexpected(of.error());
  if (read) return made;
  report(read.error(), document.path, messages);
  return std::nullopt;
}

std::optional<SceneData> SceneData::load(const std::string& path, const Options& options,
                                         Messages& messages) {
  const Result<SchemaOf> schema = schemaFor(options);
  if (!schema) return report(schema.error(), path, messages), std::nullopt;
  Result<material::Document> document = readMaterials(path, *schema->language, options);
  if (!document) return report(document.error(), path, messages), std::nullopt;
  report(document->diagnostics, path, messages);
  return SceneData{std::move(*document), schema->language, {}, options};
}

Scene Scene::load(const std::string& path, const Options& options, Messages& messages) {
  Scene scene;
  std::optional<SceneData> data = SceneData::load(path, options, messages);
  if (data) scene.impl_ = std::make_shared<Impl>(std::move(*data));
  return scene;
}

Scene Scene::fromMemory(const std::string& bytes, const std::string& name, const Options& options,
                        Messages& messages) {
  Scene scene;
  const Result<SchemaOf> schema = schemaFor(options);
  if (!schema) return report(schema.error(), name, messages), scene;
  SceneData data{{}, schema->language, std::make_shared<const std::string>(bytes), options};
  if (const Result<void> read = data.read(bytes, name); !read)
    return report(read.error(), name, messages), scene;
  if (const Diagnostics wrong = checkWatched(options, data.document.materials.size()); !wrong.empty())
    return report(wrong, name, messages), scene;
  report(data.document.diagnostics, name, messages);
  scene.impl_ = std::make_shared<Impl>(std::move(data));
  return scene;
}

size_t Scene::materialCount() const { return impl().document.materials.size(); }

const std::string& Scene::materialName(size_t material) const {
  static const std::string kNone;
  return material < materialCount() ? impl().document.materials[material].name : kNone;
}

std::optional<size_t> Scene::findMaterial(const std::optional<std::string>& name, Messages& messages) const {
  if (!filled(impl_.get(), "scene", messages)) return std::nullopt;
  Diagnostics warnings;
  const Result<size_t> found = material::findMaterial(impl().document, name, warnings);
  report(warnings, {}, messages);
  if (found) return *found;
  report(found.error(), {}, messages);
  return std::nullopt;
}

std::vector<Attributes> Scene::uses(size_t material) const {
  std::vector<Attributes> uses;
  if (material >= materialCount()) return uses;
  for (const gltf::VertexAttributes& a : impl().document.uses[material]) uses.push_back(toPublic(a));
  return uses;
}

Graph Scene::graph(size_t material, const Attributes& attributes, const Options& options,
                   Messages& messages) const {
  Graph result;
  if (!filled(impl_.get(), "scene", messages)) return result;
  const material::Document& document = impl_->document;
  const material::Material* found = impl_->material(material, messages);
  if (found == nullptr) return result;
  const material::Material& m = *found;
  report(m.diagnostics, document.path, messages);
  if (lacquer::hasError(m.diagnostics)) return result;
  Diagnostics wrong = checkReading(options);
  if (wrong.empty()) wrong = checkWatched(options, document.materials.size());
  if (!wrong.empty()) {
    report(wrong, {}, messages);
    return result;
  }
  const auto language = libraryFor(options);
  if (!language) return report(language.error(), {}, messages), result;
  Diagnostics warnings;
  Options named = options;
  if (const Result<void> resolved = resolveNames(**language, named); !resolved)
    return report(resolved.error(), document.path, messages), result;
  Result<graph::Graph> graph = buildGraph(m, fromPublic(attributes), **language, named, warnings);
  report(warnings, document.path, messages);
  if (!graph) return report(graph.error(), {}, messages), result;
  result.impl_ = std::make_shared<Graph::Impl>(Graph::Impl{std::move(*graph), document.path, *language,
                                                           *limitsOf(options), lightsOf(document),
                                                           ImagesOf::Gltf, impl_->bytes, options.simplify});
  return result;
}

std::vector<PropertyUse> Scene::properties(size_t material, const Attributes& attributes,
                                           const Options& options, Messages& messages) const {
  std::vector<PropertyUse> uses;
  const Graph built = graph(material, attributes, options, messages);
  if (!built) return uses;
  for (const Parameter& parameter : built.parameters()) {
    if (!parameter.pointer.empty()) uses.push_back({parameter.pointer, Change::Numbers, parameter.name});
  }
  for (const TextureUse& texture : built.textures()) {
    if (!texture.pointer.empty()) uses.push_back({texture.pointer, Change::Textures, texture.name});
  }
  // The rest is not in the graph: the term that would have it is left out.
  const Language& language = *built.impl_->language;
  Options named = options;
  const Result<const material::Schema*> schema = language.models.schema();
  if (!resolveNames(language, named) || !schema) return uses;
  const Result<const model::Model*> model = language.models.of(named.profile);
  if (!model) return uses;
  std::set<std::string, std::less<>> skipped;
  for (const graph::Skipped& term : built.impl_->graph.skipped) skipped.insert(term.term);
  addProgramProperties(impl_->document.materials[material], **schema, (*model)->absent(skipped), uses);
  return uses;
}

namespace {

/// `Impl` is Scene::Impl, which friends alone may name.
template <class Impl>
std::optional<Evaluation> evaluatedScene(const Impl* impl, size_t material, const GivenPoints& points,
                                         Engine engine, const Strings& texels, const Options& options,
                                         Messages& messages, const Trial& trial) {
  if (!filled(impl, "scene", messages)) return std::nullopt;
  const material::Material* found = impl->material(material, messages);
  if (found == nullptr) return std::nullopt;
  return evaluateOf({*found, *impl->language, impl->document.path, impl->bytes}, points, engine, texels,
                    options, messages, trial);
}

/// `Impl` is Graph::Impl.
template <class Impl>
std::optional<Evaluation> evaluatedGraph(const Impl* impl, const GivenPoints& points, Engine engine,
                                         const Strings& texels, const Options& options, Messages& messages,
                                         const Trial& trial) {
  if (!filled(impl, "graph", messages)) return std::nullopt;
  const auto language = libraryFor(options);
  if (!language) return report(language.error(), {}, messages), std::nullopt;
  return evaluateOf({impl->graph, **language, impl->file, impl->bytes, impl->images}, points, engine, texels,
                    options, messages, trial);
}

}  // namespace

std::optional<Evaluation> evaluate(const Scene& scene, size_t material, const std::string& points,
                                   Engine engine, const Strings& texels, const Options& options,
                                   Messages& messages, const Trial& trial) {
  return evaluatedScene(scene.impl_.get(), material, &points, engine, texels, options, messages, trial);
}

std::optional<Evaluation> evaluate(const Scene& scene, size_t material, const PointArrays& points,
                                   Engine engine, const Strings& texels, const Options& options,
                                   Messages& messages, const Trial& trial) {
  return evaluatedScene(scene.impl_.get(), material, &points, engine, texels, options, messages, trial);
}

std::optional<Evaluation> evaluate(const Graph& graph, const std::string& points, Engine engine,
                                   const Strings& texels, const Options& options, Messages& messages,
                                   const Trial& trial) {
  return evaluatedGraph(graph.impl_.get(), &points, engine, texels, options, messages, trial);
}

std::optional<Evaluation> evaluate(const Graph& graph, const PointArrays& points, Engine engine,
                                   const Strings& texels, const Options& options, Messages& messages,
                                   const Trial& trial) {
  return evaluatedGraph(graph.impl_.get(), &points, engine, texels, options, messages, trial);
}

std::vector<uint8_t> drawBall(const Graph& graph, uint32_t size, const Strings& texels,
                              const Options& options, Messages& messages, const Trial& trial,
                              const ValueLook& look) {
  if (!filled(graph.impl_.get(), "graph", messages)) return {};
  const auto language = libraryFor(options);
  if (!language) return report(language.error(), {}, messages), std::vector<uint8_t>();
  const Graph::Impl& impl = *graph.impl_;
  return drawBallOf({impl.graph, **language, impl.file, impl.bytes, impl.images}, size, texels, options,
                    messages, trial, look);
}

std::vector<uint8_t> drawBall(const Scene& scene, size_t material, uint32_t size, const Strings& texels,
                              const Options& options, Messages& messages, const Trial& trial,
                              const ValueLook& look) {
  if (!filled(scene.impl_.get(), "scene", messages)) return {};
  const Scene::Impl& impl = scene.impl();
  const material::Material* found = impl.material(material, messages);
  if (found == nullptr) return {};
  return drawBallOf({*found, *impl.language, impl.document.path, impl.bytes}, size, texels, options, messages,
                    trial, look);
}

}  // namespace lacquer
