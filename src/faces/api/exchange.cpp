#include "exchange/exchange.h"
#include "exchange/edited.h"
#include "exchange/graph_out.h"
#include "exchange/kept.h"
#include "exchange/translation.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "api/internal.h"
#include "bake/bake.h"
#include "eval/subject.h"
#include "lacquer/exchange.h"
#include "lacquer/graph.h"
#include "materialx/materialx.h"
#include "mtlx/element.h"
#include "preview/compared.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/file.h"
#include "support/jobs.h"
#include "support/outputs.h"
#include "support/relative.h"
#include "support/text.h"

namespace lacquer {

namespace {

/// Files are named as seen from another folder, and prefixes are in the names.
void moveFiles(materialx::Element& element, const Moved& moved) {
  std::erase_if(element.attributes,
                [](const auto& one) { return one.first == "fileprefix" || one.first == "geomprefix"; });
  if (element.get("type") == "filename" && !element.get("value").empty())
    element.set("value", moved(std::string(element.get("value"))));
  for (materialx::Element& child : element.children) moveFiles(child, moved);
}

/// A colour space that the elements around have is not said again.
void takeColorSpaces(materialx::Element& element, const std::string& around) {
  for (materialx::Element& child : element.children) {
    const std::string* own = child.find("colorspace");
    const std::string inside = own == nullptr ? around : *own;
    std::erase_if(child.attributes,
                  [&](const auto& one) { return one.first == "colorspace" && one.second == around; });
    takeColorSpaces(child, inside);
  }
}

/// A document as it was read, in one file, for that folder: whole, or of some materials.
std::string keptOf(materialx::Element root, const std::string& file, const std::string& folder,
                   const Strings& materials) {
  const std::string from = folderOf(file);
  moveFiles(root, Moved(from, folder.empty() ? from : folder));
  takeColorSpaces(root, std::string(root.get("colorspace")));
  if (!materials.empty()) exchange::keepMaterials(root, materials);
  return materialx::toXml(root);
}

/// A document whose surfaces are others, by MaterialX's own translation graphs. Nothing where there is none
/// for a surface that it has.
std::optional<std::string> translatedOf(const std::string& file, const std::string& folder,
                                        const std::string& surface, const Options& options,
                                        Messages& messages) {
  const Result<Limits> limits = limitsOf(options);
  if (surface.empty() || !limits) return std::nullopt;
  const Result<std::string> text = readFile(file, limits->file);
  if (!text || !materialx::isXml(*text)) return std::nullopt;
  Result<materialx::Document> document = materialx::readXml(*text, file, *limits);
  if (!document || !exchange::canTranslate(document->root, surface)) return std::nullopt;
  Diagnostics said;
  exchange::translateSurfaces(document->root, surface, said);
  report(said, file, messages);
  return keptOf(std::move(document->root), file, folder, {});
}

/// Whether a material may be written as that surface; false, and a message, where not.
bool isSurface(const std::string& file, const std::string& surface, Messages& messages) {
  const auto fits = [&](std::string_view one) { return one == surface; };
  if (!surface.empty() &&
      std::none_of(std::begin(exchange::kSurfaces), std::end(exchange::kSurfaces), fits)) {
    report(fail("unknown-surface", {}, fmt::format("no material is written as {}", quote(surface)),
                "there are " + listOf(exchange::kSurfaces))
               .value(),
           file, messages);
    return false;
  }
  return true;
}

/// Materials of these names, or all, without those that are wrong. None, and messages, where there are none.
std::vector<size_t> wantedOf(const material::Document& document, const Strings& materials,
                             Messages& messages) {
  const std::string& file = document.path;
  std::vector<size_t> wanted;
  for (const std::string& name : materials) {
    Diagnostics warnings;
    const Result<size_t> found = material::findMaterial(document, name, warnings);
    report(found ? warnings : found.error(), file, messages);
    if (!found) return {};
    wanted.push_back(*found);
  }
  for (size_t i = 0; materials.empty() && i < document.materials.size(); ++i) wanted.push_back(i);
  if (wanted.empty()) {
    report(fail("no-such-material", {}, "the file has no materials", "name one that has").value(), file,
           messages);
    return {};
  }
  for (const size_t i : wanted) report(document.materials[i].diagnostics, file, messages);
  std::erase_if(wanted, [&](size_t i) { return lacquer::hasError(document.materials[i].diagnostics); });
  return wanted;
}

/// The text of materials that were read: of the names, or all.
std::string textOf(const material::Document& document, const material::Schema& schema,
                   const std::string& folder, const Strings& materials, const std::string& surface,
                   const materialx::Element* read, Messages& messages) {
  const std::vector<size_t> wanted = wantedOf(document, materials, messages);
  if (wanted.empty()) return {};
  exchange::Written written = exchange::toMaterialX(document, wanted, schema, surface, folder, read);
  report(written.said, document.path, messages);
  return std::move(written.text);
}

/// An edited graph of a material by its number.
using EditedGraphs = std::vector<std::pair<size_t, const graph::Graph*>>;

/// The text of a MaterialX document: what was read, with the graphs' numbers.
std::string readOf(const SceneData& scene, const std::string& folder, const Strings& materials,
                   const EditedGraphs& edited, Messages& messages) {
  if (wantedOf(scene.document, materials, messages).empty()) return {};
  const std::string& file = scene.document.path;
  const Result<std::string> text = scene.text();
  const Result<Limits> limits = limitsOf(scene.options);
  if (!text || !limits) return report(text ? limits.error() : text.error(), file, messages), std::string();
  Result<materialx::Document> read = materialx::readXml(*text, file, *limits, scene.included());
  if (!read) return report(read.error(), file, messages), std::string();
  for (const auto& [ignored, graph] : edited) exchange::putNumbers(read->root, *graph);
  return keptOf(std::move(read->root), file, folder, materials);
}

/// Nobody edited the nodes of a document that is read by MaterialX's own formulas.
bool isAsRead(const SceneData& scene, const EditedGraphs& edited) {
  if (scene.hasOwnFormulas()) return true;
  if (!edited.empty() || translates(scene.options)) return false;
  const Result<std::string> text = scene.text();
  return text && materialx::isXml(*text);
}

/// The elements of a scene's MaterialX document; nothing of another file.
std::optional<materialx::Element> elementsOf(const SceneData& scene) {
  const Result<std::string> text = scene.text();
  const Result<Limits> limits = limitsOf(scene.options);
  if (!text || !limits || !materialx::isXml(*text)) return std::nullopt;
  Result<materialx::Document> read =
      materialx::readXml(*text, scene.document.path, *limits, scene.included());
  return read ? std::optional(std::move(read->root)) : std::nullopt;
}

/// A scene's text, for that folder.
std::string writtenOf(const SceneData& scene, const std::string& folder, const Strings& materials,
                      const std::string& surface, const EditedGraphs& edited, Messages& messages) {
  const std::string& file = scene.document.path;
  if (surface.empty() && isAsRead(scene, edited)) return readOf(scene, folder, materials, edited, messages);
  if (scene.hasOwnFormulas()) {
    const std::optional<SceneData> translated = scene.translated(messages);
    return translated ? writtenOf(*translated, folder, materials, surface, edited, messages) : std::string();
  }
  const Result<const material::Schema*> schema = scene.language->models.schema();
  if (!schema) return report(schema.error(), file, messages), std::string();
  // Looks may speak of the others, where some are wanted.
  const std::optional<materialx::Element> elements =
      materials.empty() ? elementsOf(scene) : std::optional<materialx::Element>();
  const materialx::Element* read = elements ? &*elements : nullptr;
  if (edited.empty()) return textOf(scene.document, **schema, folder, materials, surface, read, messages);
  material::Document document = scene.document;
  exchange::putGraphs(document, edited, **schema);
  return textOf(document, **schema, folder, materials, surface, read, messages);
}

/// The patterns of a graph of one's own.
std::string graphDocumentOf(const std::string& file, const std::string& folder, const std::string& surface,
                            const Options& options, Messages& messages) {
  if (!surface.empty()) {
    report(fail("graph-is-built", {}, "a graph is written without a surface: its ports are not MaterialX's",
                "name the material's file: .gltf, .glb or .mtlx")
               .value(),
           file, messages);
    return {};
  }
  const Result<std::shared_ptr<const Language>> language = libraryFor(options);
  if (!language) return report(language.error(), {}, messages), std::string();
  const Result<graph::Graph> graph = readGraphFile(file, options);
  if (!graph) return report(graph.error(), file, messages), std::string();
  const Diagnostics wrong = graph::check(*graph, **language, limitsOf(options).value_or(Limits{}).nodes);
  report(wrong, file, messages);
  if (lacquer::hasError(wrong)) return {};
  exchange::Written written = exchange::graphToMaterialX(*graph, **language, file, folder);
  report(written.said, file, messages);
  return std::move(written.text);
}

/// The document's text, for that folder.
std::string documentOf(const std::string& file, const std::string& folder, const Strings& materials,
                       const std::string& surface, const Options& options, Messages& messages) {
  if (!isSurface(file, surface, messages)) return {};
  if (isGraphFile(file)) return graphDocumentOf(file, folder, surface, options, messages);
  if (materials.empty()) {
    if (std::optional<std::string> text = translatedOf(file, folder, surface, options, messages))
      return std::move(*text);
  }
  const std::optional<SceneData> scene =
      SceneData::load(file, surface.empty() ? options : translating(options), messages);
  return scene ? writtenOf(*scene, folder, materials, surface, {}, messages) : std::string();
}

}  // namespace

std::string toMaterialX(const std::string& file, const Strings& materials, const std::string& surface,
                        const Options& options, Messages& messages) {
  return documentOf(file, {}, materials, surface, options, messages);
}

std::string toMaterialX(const Scene& scene, const Strings& materials, const std::string& surface,
                        const std::vector<EditedGraph>& edited, const Options&, Messages& messages) {
  if (!filled(scene.impl_.get(), "scene", messages)) return {};
  const Scene::Impl& of = scene.impl();
  if (!isSurface(of.document.path, surface, messages)) return {};
  const bool closures = surface.empty() && of.hasOwnFormulas();
  EditedGraphs graphs;
  for (const EditedGraph& one : edited) {
    if (one.graph == nullptr || !filled(one.graph->impl_.get(), "graph", messages)) return {};
    if (of.material(one.material, messages) == nullptr) return {};
    graphs.emplace_back(one.material, &one.graph->impl_->graph);
    report({{"not-said",
             Severity::Note,
             {{}, 0, 0, fmt::format("/materials/{}", one.material)},
             closures ? "of the edited graph the numbers are written"
                      : "of the edited graph what computes texels is written",
             closures ? "its nodes are the document's"
                      : "its other terms are what the material's properties say",
             {}}},
           of.document.path, messages);
  }
  return writtenOf(of, {}, materials, surface, graphs, messages);
}

std::string toGltf(const Scene& scene, const Strings& materials, uint32_t size, const Options& options,
                   Messages& messages) {
  if (!filled(scene.impl_.get(), "scene", messages)) return {};
  std::optional<SceneData> translated;
  if (scene.impl().hasOwnFormulas()) {
    translated = scene.impl().translated(messages);
    if (!translated) return {};
  }
  const SceneData& of = translated ? *translated : static_cast<const SceneData&>(scene.impl());
  return gltfOf({of.document, of.language, of.bytes}, materials, size, options, messages);
}

bool writeMaterialX(const std::string& output, const std::string& file, const Strings& materials,
                    const std::string& surface, const Options& options, Messages& messages) {
  if (const Diagnostics wrong = clashes({file}, {output}); !wrong.empty())
    return report(wrong, file, messages), false;
  if (const Result<void> place = hasPlace(folderOf(output), {file}); !place)
    return report(place.error(), output, messages), false;
  const std::string text = documentOf(file, folderOf(output), materials, surface, options, messages);
  if (text.empty()) return false;
  const Result<bool> written = writeFile(output, text, {nullptr, options.sync});
  if (!written) report(written.error(), output, messages);
  return written.has_value();
}

std::optional<Converted> convert(const Conversion& how, const std::string& file, const Strings& materials,
                                 const Options& options, Messages& messages) {
  if (isGraphFile(file)) {
    report(
        fail("graph-is-built", {}, "a graph is built of a material's terms, for which MaterialX has no nodes",
             "name the material's file: .gltf, .glb or .mtlx")
            .value(),
        file, messages);
    return std::nullopt;
  }
  const Options translated = translating(options);
  if (!writeMaterialX(how.output, file, materials, how.surface, translated, messages)) return std::nullopt;
  Converted converted;
  converted.output = how.output;
  if (!how.measured && how.picture.empty()) return converted;
  Result<std::vector<PreviewDifference>> differences;
  withJobs(options.jobs, [&] {
    differences = preview::compareFiles(file, how.output, how.picture, how.size, options, messages);
  });
  if (differences) {
    converted.differences = std::move(*differences);
    converted.picture = how.picture;
    return converted;
  }
  report(differences.error(), how.output, messages);
  return std::nullopt;
}

}  // namespace lacquer
