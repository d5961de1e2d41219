#include "run/source_file.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <set>
#include <utility>

#include "gltf/container.h"
#include "manifest/values.h"
#include "run/report_blob.h"
#include "setting/option_key.h"
#include "setting/options.h"
#include "shader/module.h"
#include "structures/describe.h"
#include "support/relative.h"

namespace lacquer {

namespace {

/// So many materials' texts are held beside the file's: enough for every core.
constexpr size_t kMaterialsAtOnce = 4096;
/// A file's result that takes a larger part of the cache is not kept there: it would push out all the rest.
constexpr uint64_t kCachePart = 8;

/// A material's entry and what the run needs of it.
struct Done {
  std::string text;
  Diagnostics diagnostics;
  MaterialReport report;
  std::vector<Key> structures;
  std::vector<gltf::VertexAttributes> uses;  ///< those in the manifest
};

Done textOf(const Wanted& wanted, const std::string& file, const Setting& setting, Described described) {
  Done done;
  std::vector<UseEntry> entries;
  for (size_t i = 0; i < described.met.size(); ++i)
    entries.push_back({described.shaders[i], &described.met[i]->texts});
  done.text =
      materialText(described.values, entries, wanted.material == nullptr ? nullptr : &setting.options.profile,
                   described.terms_texts, described.diagnostics);
  done.report = {file,
                 wanted.name,
                 static_cast<size_t>(std::max(wanted.index, 0)),
                 std::move(described.values.terms),
                 std::move(described.shaders),
                 described.ok};
  done.diagnostics = std::move(described.diagnostics);
  done.structures = std::move(described.structures);
  done.uses = std::move(described.uses);
  return done;
}

// -- a file --

class SceneFile {
public:
  SceneFile(const std::string& path, const std::vector<std::string>& only, const Setting& setting,
            Structures& structures)
      : path_(path), only_(only), setting_(setting), structures_(structures) {}

  FileResult run(const material::Document& document);

private:
  Done make(const Wanted& wanted) const {
    return textOf(wanted, path_, setting_, describe(wanted, path_, lights_, setting_, structures_));
  }

  const std::string& path_;
  const std::vector<std::string>& only_;
  const Setting& setting_;
  Structures& structures_;
  passes::LightFacts lights_;
};

FileResult SceneFile::run(const material::Document& document) {
  FileResult result;
  lights_ = lightFacts(setting_.options, lightsOf(document));
  const std::vector<Wanted> all = wantedOf(document, only_, setting_.options);
  for (const material::Material& material : document.materials) {
    if (!only_.empty()) result.names.push_back(material.name);
  }
  result.diagnostics = document.diagnostics;
  result.ok = !hasError(result.diagnostics);
  JsonText json(kFileDepth);
  beginFile(relativeTo(setting_.folder, path_), json);
  std::set<Key> seen;
  UsesOf uses;
  std::string default_text;
  std::vector<Done> done;
  for (size_t first = 0; first < all.size(); first += done.size()) {
    done.assign(std::min(kMaterialsAtOnce, all.size() - first), {});
    // Each thread takes some at a time: a material is a few microseconds when its structure is known.
    tbb::parallel_for(tbb::blocked_range<size_t>(0, done.size(), 16),
                      [&](const tbb::blocked_range<size_t>& range) {
                        for (size_t i = range.begin(); i < range.end(); ++i) done[i] = make(all[first + i]);
                      });
    const StageTimer timer(setting_.times, StageOfRun::Manifest);
    for (size_t i = 0; i < done.size(); ++i) {
      if (all[first + i].index < 0)
        default_text = std::move(done[i].text);
      else
        json.raw(done[i].text);
      uses.emplace(all[first + i].index, std::move(done[i].uses));
      result.diagnostics.insert(result.diagnostics.end(), done[i].diagnostics.begin(),
                                done[i].diagnostics.end());
      result.ok &= done[i].report.ok;
      result.materials.push_back(std::move(done[i].report));
      for (const Key& key : done[i].structures) {
        if (seen.insert(key).second) result.structures.push_back(key);
      }
    }
    if (first == 0) json.reserve(all.size(), done.size());
  }
  const StageTimer timer(setting_.times, StageOfRun::Manifest);
  endFile({default_text, document.variants, primitivesOf(document, uses), texturesOf(document),
           imagesOf(document), document.diagnostics},
          json);
  result.text = json.take();
  return result;
}

/// An entry without anything but materials, which are texts.
std::string bareText(const std::string& path, const Setting& setting,
                     const std::vector<std::string>& materials, const Diagnostics& diagnostics) {
  JsonText json(kFileDepth);
  beginFile(relativeTo(setting.folder, path), json);
  for (const std::string& text : materials) json.raw(text);
  endFile({{}, {}, {}, {}, {}, diagnostics}, json);
  return json.take();
}

FileResult unreadable(const std::string& path, const Setting& setting, const Diagnostics& why) {
  FileResult result;
  result.diagnostics = why;
  result.ok = false;
  result.text = bareText(path, setting, {}, why);
  return result;
}

// -- whole files in the cache --

Key fileKey(const std::string& path, const std::string& bytes, const Setting& setting) {
  KeyBuilder key;
  key.text("file").key(setting.base).text(path).text(relativeTo(setting.folder, path)).key(keyOf(bytes));
  addOptions(setting.options, {Decides::Graph, Decides::Module}, key);
  if (setting.sharing != nullptr) key.key(setting.sharing->digest());
  return key.finish();
}

std::string toBlob(const FileResult& result) {
  BlobWriter blob;
  blob(result.text, result.diagnostics, result.structures);
  writeMaterials(result.materials, blob);
  return blob.take();
}

std::optional<FileResult> fromBlob(const std::string& path, std::string_view bytes) {
  BlobReader blob(bytes);
  FileResult result;
  blob(result.text, result.diagnostics, result.structures);
  readMaterials(path, blob, result.materials);
  if (!blob.complete()) return std::nullopt;
  return result;
}

std::optional<FileResult> cachedFile(const std::string& path, const Key& key, const Setting& setting,
                                     Structures& structures) {
  std::optional<FileResult> result;
  {
    const StageTimer timer(setting.times, StageOfRun::Cache);
    const std::optional<std::string> bytes = setting.cache->get(key);
    if (bytes) result = fromBlob(path, *bytes);
  }
  if (!result) return std::nullopt;
  const bool all = std::all_of(result->structures.begin(), result->structures.end(),
                               [&](const Key& one) { return structures.known(one) != nullptr; });
  return all ? std::move(result) : std::nullopt;
}

FileResult readScene(const std::string& path, const std::vector<std::string>& only, const Setting& setting,
                     Structures& structures) {
  Result<std::string> bytes;
  {
    const StageTimer timer(setting.times, StageOfRun::Read);
    bytes = readFile(path, setting.limits.file);
  }
  if (!bytes) return unreadable(path, setting, bytes.error());
  // While programs are looked for, results are of no use to another run.
  const bool looking = setting.sharing != nullptr && !setting.sharing->closed();
  const bool keep = setting.cache != nullptr && only.empty() && !looking;
  const Key key = keep ? fileKey(path, *bytes, setting) : Key{};
  if (keep) {
    if (std::optional<FileResult> cached = cachedFile(path, key, setting, structures))
      return std::move(*cached);
  }
  const Result<const material::Schema*> schema = setting.library.models.schema();
  if (!schema) return unreadable(path, setting, schema.error());
  Result<material::Document> document;
  {
    const StageTimer timer(setting.times, StageOfRun::Read);
    document = material::readText(*bytes, path, **schema, {setting.options.permissive, setting.limits});
    *bytes = {};
  }
  if (!document) return unreadable(path, setting, document.error());
  FileResult result = SceneFile(path, only, setting, structures).run(*document);
  if (keep && result.ok && result.text.size() <= setting.options.cache_size / kCachePart) {
    const StageTimer timer(setting.times, StageOfRun::Cache);
    setting.cache->put(key, toBlob(result));
  }
  return result;
}

/// For whoever wrote the graph, on the screen alone: a manifest would differ from that of the file which the
/// graph was made of.
void addDoubts(const graph::Graph& graph, const std::string& path, const lang::Library& library,
               Diagnostics& to) {
  for (Diagnostic& doubt : graph::doubts(graph, library)) {
    doubt.place.file = path;
    to.push_back(std::move(doubt));
  }
}

FileResult readGraph(const std::string& path, const std::vector<std::string>& only, const Setting& setting,
                     Structures& structures) {
  const Result<std::string> text = readFile(path, setting.limits.file);
  const Result<graph::Graph> graph =
      text ? graph::fromJson(*text, path, setting.limits) : tl::make_unexpected(text.error());
  if (!graph) return unreadable(path, setting, graph.error());
  FileResult result;
  std::vector<std::string> texts;
  if (!only.empty()) result.names.push_back(graph->name);
  if (only.empty() || std::find(only.begin(), only.end(), graph->name) != only.end()) {
    Done done = textOf({nullptr, graph->name, 0, {}, {}}, path, setting,
                       describeGraph(*graph, path, setting, structures));
    result.diagnostics = std::move(done.diagnostics);
    result.structures = std::move(done.structures);
    result.ok = done.report.ok;
    if (result.ok) addDoubts(*graph, path, setting.library, result.diagnostics);
    result.materials.push_back(std::move(done.report));
    texts.push_back(std::move(done.text));
  }
  result.text = bareText(path, setting, texts, {});
  return result;
}

}  // namespace

FileResult readInput(const std::string& path, InputKind kind, const std::vector<std::string>& only,
                     const Setting& setting, Structures& structures) {
  return kind == InputKind::Graph || isGraphFile(path) ? readGraph(path, only, setting, structures)
                                                       : readScene(path, only, setting, structures);
}

}  // namespace lacquer
