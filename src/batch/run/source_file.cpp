#include "run/source_file.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <set>
#include <utility>

#include "cache/option_key.h"
#include "gltf/container.h"
#include "json/text.h"
#include "manifest/manifest.h"
#include "manifest/scene.h"
#include "run/programs.h"
#include "run/report_blob.h"
#include "setting/language.h"
#include "setting/options.h"
#include "setting/simplify.h"
#include "shader/module.h"
#include "support/relative.h"

namespace lacquer {

namespace {

constexpr size_t kFileDepth = 2;      ///< manifest, "files"
constexpr size_t kMaterialDepth = 4;  ///< the file, "materials"

/// So many materials' texts are held beside the file's: enough for every core.
constexpr size_t kMaterialsAtOnce = 4096;
/// A file's result that takes a larger part of the cache is not kept there: it would push out all the rest.
constexpr uint64_t kCachePart = 8;

gltf::VertexAttributes everything() {
  gltf::VertexAttributes a;
  a.normal = true;
  a.tangent = true;
  a.texCoord = {true, true, false, false};
  return a;
}

/// A material and the attribute sets that it is wanted for.
struct Wanted {
  const material::Material* material = nullptr;
  std::string name;
  int index = 0;
  std::vector<gltf::VertexAttributes> uses;
  std::string note;  ///< why there is no use
};

struct Done {
  std::string text;
  Diagnostics diagnostics;
  MaterialReport report;
  std::vector<Key> structures;
  std::vector<gltf::VertexAttributes> uses;  ///< those in the manifest
};

/// The entries of one material: use() for each use, then finish().
class MaterialText {
public:
  /// `material`: null for a graph that is the input.
  MaterialText(const std::string& file, const material::Material* material, const Setting& setting,
               Structures& structures)
      : file_(file),
        built_of_(material),
        material_(material == nullptr ? noMaterial() : *material),
        setting_(setting),
        structures_(structures),
        uses_(kMaterialDepth + 1) {
    uses_.beginArray();
  }

  /// `said`: what building the graph has reported.
  void use(graph::Graph& graph, const passes::LightFacts& lights, const gltf::VertexAttributes& attributes,
           const Diagnostics& said);
  Done finish(const Wanted& wanted);
  /// No graph could be built.
  void fail(const Diagnostics& why) { add(why); }

private:
  void add(const Diagnostics& found) {
    for (const Diagnostic& d : found) {
      // Several uses of one material usually say the same things.
      if (std::find(diagnostics_.begin(), diagnostics_.end(), d) == diagnostics_.end())
        diagnostics_.push_back(d);
    }
  }
  static const material::Material& noMaterial() {
    static const material::Material kNone;
    return kNone;
  }
  std::shared_ptr<const MaterialTerms> terms() const;
  void writeUnfilled(const graph::Graph& graph);
  void writeStandInAttributes(const Structure& structure, const gltf::VertexAttributes& attributes);

  const std::string& file_;
  const material::Material* built_of_;
  const material::Material& material_;
  const Setting& setting_;
  Structures& structures_;
  JsonText uses_;
  Diagnostics diagnostics_;
  std::vector<const Structure*> met_;
  std::vector<std::string> shaders_;
  std::vector<gltf::VertexAttributes> written_;
};

/// What is no constant though constants are asked for.
Diagnostics animated(const Structure& structure, const graph::Graph& graph) {
  Diagnostics notes;
  for (const uint32_t i : structure.parameters) {
    const ir::Parameter& p = graph.parameters[i];
    if (!p.animated) continue;
    notes.push_back({"animated-parameter",
                     Severity::Note,
                     {{}, 0, 0, p.pointer},
                     fmt::format("{} is animated: it stays in the Material block", p.name),
                     "what changes at run time is no constant",
                     {}});
  }
  return notes;
}

/// The template's ports that have their defaults.
void MaterialText::writeUnfilled(const graph::Graph& graph) {
  const Result<const lang::TemplateDecl*> decl = setting_.library.template_(graph.template_name);
  uses_.key("unfilled_ports").beginArray();
  for (size_t i = 0; decl && i < (*decl)->ports.size(); ++i) {
    const std::string_view name = (*decl)->ports[i].param.name;
    const bool filled = std::any_of(graph.outputs.begin(), graph.outputs.end(),
                                    [&](const auto& output) { return output.first == name; });
    if (!filled) uses_.string(name);
  }
  uses_.endArray();
}

/// Of a shader that materials share: what it reads of the vertices and this primitive does not have.
void MaterialText::writeStandInAttributes(const Structure& structure,
                                          const gltf::VertexAttributes& attributes) {
  const std::vector<std::string> own = attributes.names();
  uses_.key("stand_in_attributes").beginArray();
  for (const std::string& name : structure.inputs) {
    if (name != "POSITION" && std::find(own.begin(), own.end(), name) == own.end()) uses_.string(name);
  }
  uses_.endArray();
}

void MaterialText::use(graph::Graph& graph, const passes::LightFacts& lights,
                       const gltf::VertexAttributes& attributes, const Diagnostics& said) {
  if (setting_.examples != nullptr) {
    const Key structure = structureKey(graph, lights, setting_);
    if (built_of_ != nullptr)
      setting_.examples->note(structure, *built_of_, attributes);
    else
      setting_.examples->note(structure, graph);
  }
  const programs::Fill* fill =
      setting_.programs == nullptr ? nullptr : setting_.programs->bring(graph, built_of_, attributes, lights);
  const Structure& structure = structures_.of(graph, lights);
  met_.push_back(&structure);
  add(said);
  if (structure.shader.empty() || !withinLimits(structure, graph)) {
    const Diagnostics found = graph::check(graph, setting_.library);
    add(found);
    if (hasError(found)) return;
  }
  add(structure.diagnostics);
  if (structure.shader.empty()) return;
  if (setting_.options.parameters != Parameters::Uniform) add(animated(structure, graph));
  shaders_.push_back(structure.shader);
  uses_.beginObject().key("attributes");
  writeList(attributes.names(), uses_);
  uses_.key("shader").string(structure.shader);
  writeBindings(structure, graph, material_, fill, uses_);
  if (fill != nullptr) writeStandInAttributes(structure, attributes);
  uses_.key("absent_parameters").raw(structure.absent);
  writeUnfilled(graph);
  uses_.endObject();
  written_.push_back(attributes);
}

/// Of all uses, each once.
std::shared_ptr<const MaterialTerms> MaterialText::terms() const {
  if (met_.empty()) return std::make_shared<MaterialTerms>();
  if (std::all_of(met_.begin(), met_.end(), [&](const Structure* s) { return s->terms == met_[0]->terms; })) {
    return met_[0]->terms;
  }
  auto all = std::make_shared<MaterialTerms>();
  for (const Structure* structure : met_) {
    for (const std::string& term : structure->terms->terms) {
      if (std::find(all->terms.begin(), all->terms.end(), term) == all->terms.end())
        all->terms.push_back(term);
    }
    for (const auto& skipped : structure->terms->skipped) {
      const auto it = std::find_if(all->skipped.begin(), all->skipped.end(),
                                   [&](const auto& other) { return other.first == skipped.first; });
      if (it == all->skipped.end())
        all->skipped.push_back(skipped);
      else
        it->second = skipped.second;
    }
  }
  return all;
}

Done MaterialText::finish(const Wanted& wanted) {
  Done done;
  const Diagnostics of_uses = std::exchange(diagnostics_, material_.diagnostics);
  if (!wanted.note.empty()) {
    diagnostics_.push_back({"unused-material",
                            Severity::Note,
                            {file_, 0, 0, fmt::format("/materials/{}", wanted.index)},
                            wanted.note,
                            "--unused generates it all the same",
                            {}});
  }
  add(of_uses);
  done.diagnostics = std::move(diagnostics_);
  done.uses = std::move(written_);
  done.report = {file_,   wanted.name,         static_cast<size_t>(std::max(wanted.index, 0)),
                 terms(), std::move(shaders_), !hasError(done.diagnostics)};
  for (const Structure* structure : met_) {
    if (std::find(done.structures.begin(), done.structures.end(), structure->key) == done.structures.end()) {
      done.structures.push_back(structure->key);
    }
  }
  JsonText json(kMaterialDepth);
  json.beginObject().key("index").integer(wanted.index).key("name").string(wanted.name);
  if (built_of_ != nullptr) {  // no profile has made a graph
    json.key("profile").string(setting_.options.profile);
    if (const Result<const material::Schema*> schema = setting_.library.models.schema()) {
      writeSurface(material_, **schema, json);
      writeExtensions(material_, **schema, json);
    }
  }
  json.key("uses").raw(uses_.endArray().take());
  const bool shared = !met_.empty() && done.report.terms == met_[0]->terms;
  json.key("terms");
  if (shared)
    json.raw(met_[0]->terms_text);
  else
    writeList(done.report.terms->terms, json);
  json.key("skipped");
  if (shared)
    json.raw(met_[0]->skipped_text);
  else
    writeSkipped(done.report.terms->skipped, json);
  json.key("ignored");
  writeList(material_.ignored, json);
  json.key("diagnostics").beginArray();
  for (const Diagnostic& d : done.diagnostics) json.json(diagnosticJson(d));
  done.text = json.endArray().endObject().take();
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
  std::vector<Wanted> wanted(const material::Document& document, FileResult& result) const;
  Done make(const Wanted& wanted) const;

  const std::string& path_;
  const std::vector<std::string>& only_;
  const Setting& setting_;
  Structures& structures_;
  passes::LightFacts lights_;
};

std::vector<Wanted> SceneFile::wanted(const material::Document& document, FileResult& result) const {
  // A file of materials alone, without a primitive: every material is wanted.
  const bool no_primitives =
      document.defaultUses.empty() &&
      std::all_of(document.uses.begin(), document.uses.end(), [](const auto& uses) { return uses.empty(); });
  std::vector<Wanted> all;
  for (size_t i = 0; i < document.materials.size(); ++i) {
    const material::Material& material = document.materials[i];
    if (!only_.empty()) result.names.push_back(material.name);
    const bool named = std::find(only_.begin(), only_.end(), material.name) != only_.end();
    if (!only_.empty() && !named) continue;
    Wanted one{&material, material.name, static_cast<int>(i), document.uses[i], {}};
    if (one.uses.empty() && (no_primitives || named || setting_.options.unused))
      one.uses.push_back(everything());
    if (one.uses.empty()) one.note = "no primitive uses this material";
    all.push_back(std::move(one));
  }
  if (!document.defaultUses.empty() && only_.empty()) {
    static const material::Material kDefault;
    all.push_back({&kDefault, {}, -1, document.defaultUses, {}});
  }
  return all;
}

Done SceneFile::make(const Wanted& wanted) const {
  MaterialText text(path_, wanted.material, setting_, structures_);
  if (!hasError(wanted.material->diagnostics)) {
    for (const gltf::VertexAttributes& attributes : wanted.uses) {
      Diagnostics said;
      Result<graph::Graph> graph;
      {
        const StageTimer timer(setting_.times, StageOfRun::Graph);
        graph = buildGraph(*wanted.material, attributes, setting_.library, setting_.options, said);
      }
      if (graph)
        text.use(*graph, lights_, attributes, said);
      else
        text.fail(graph.error());
    }
  }
  return text.finish(wanted);
}

FileResult SceneFile::run(const material::Document& document) {
  FileResult result;
  lights_ = lightFacts(setting_.options, lightsOf(document));
  const std::vector<Wanted> all = wanted(document, result);
  result.diagnostics = document.diagnostics;
  result.ok = !hasError(result.diagnostics);
  JsonText json(kFileDepth);
  json.beginObject().key("source").string(relativeTo(setting_.folder, path_)).key("materials").beginArray();
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
  json.endArray();
  // It lies one level higher than those in the list.
  if (!default_text.empty()) json.key("default_material").json(json::reread(default_text));
  lacquer::writeScene(document, uses, json);
  json.key("diagnostics").beginArray();
  for (const Diagnostic& d : document.diagnostics) json.json(diagnosticJson(d));
  result.text = json.endArray().endObject().take();
  return result;
}

FileResult unreadable(const std::string& path, const Setting& setting, const Diagnostics& why) {
  FileResult result;
  result.diagnostics = why;
  result.ok = false;
  JsonText json(kFileDepth);
  json.beginObject()
      .key("source")
      .string(relativeTo(setting.folder, path))
      .key("materials")
      .beginArray()
      .endArray();
  json.key("diagnostics").beginArray();
  for (const Diagnostic& d : why) json.json(diagnosticJson(d));
  result.text = json.endArray().endObject().take();
  return result;
}

// -- whole files in the cache --

Key fileKey(const std::string& path, const std::string& bytes, const Setting& setting) {
  KeyBuilder key;
  key.text("file").key(setting.base).text(path).text(relativeTo(setting.folder, path)).key(keyOf(bytes));
  addOptions(setting.options, {Decides::Graph, Decides::Module}, key);
  if (setting.programs != nullptr) key.key(setting.programs->digest());
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
  const bool looking =
      setting.examples != nullptr || (setting.programs != nullptr && !setting.programs->closed());
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
  Result<graph::Graph> graph =
      text ? graph::fromJson(*text, path, setting.limits) : tl::make_unexpected(text.error());
  if (!graph) return unreadable(path, setting, graph.error());
  FileResult result;
  JsonText json(kFileDepth);
  json.beginObject().key("source").string(relativeTo(setting.folder, path)).key("materials").beginArray();
  if (!only.empty()) result.names.push_back(graph->name);
  if (only.empty() || std::find(only.begin(), only.end(), graph->name) != only.end()) {
    MaterialText material(path, nullptr, setting, structures);
    // Groups are gone when a structure is made: what is wrong in them is said before.
    const Diagnostics wrong = graph->groups.empty() && setting.options.simplify.empty()
                                  ? Diagnostics()
                                  : graph::check(*graph, setting.library, setting.limits.nodes);
    if (hasError(wrong)) {
      material.fail(wrong);
    } else {
      graph::Graph flat = graph::flattened(*graph, setting.library);
      if (const Result<void> simpler = simplifyBuilt(flat, setting.library, setting.options.simplify);
          simpler)
        material.use(flat, lightFacts(setting.options, {}), everything(), {});
      else
        material.fail(simpler.error());
    }
    Done done = material.finish({nullptr, graph->name, 0, {}, {}});
    result.diagnostics = std::move(done.diagnostics);
    result.structures = std::move(done.structures);
    result.ok = done.report.ok;
    if (result.ok) addDoubts(*graph, path, setting.library, result.diagnostics);
    result.materials.push_back(std::move(done.report));
    json.raw(done.text);
  }
  json.endArray().key("diagnostics").beginArray().endArray();
  result.text = json.endObject().take();
  return result;
}

}  // namespace

FileResult readInput(const std::string& path, InputKind kind, const std::vector<std::string>& only,
                     const Setting& setting, Structures& structures) {
  return kind == InputKind::Graph || isGraphFile(path) ? readGraph(path, only, setting, structures)
                                                       : readScene(path, only, setting, structures);
}

}  // namespace lacquer
