#include "run/source_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "gltf/container.h"
#include "lang/suggest.h"
#include "manifest/text.h"
#include "manifest/values.h"
#include "run/report_blob.h"
#include "setting/messages.h"
#include "setting/option_key.h"
#include "setting/options.h"
#include "setting/watched.h"
#include "shader/module.h"
#include "structures/describe.h"
#include "structures/reflection_blob.h"
#include "support/jobs.h"
#include "support/relative.h"
#include "support/text.h"

namespace lacquer {

template <class Archive>
static void fields(Archive& archive, PipelineInput& of) {
  archive(of.name, of.location, of.kind, of.component, of.count, of.normalized, of.stand_in);
}

template <class Archive>
static void fields(Archive& archive, Blend& of) {
  archive(of.source_color, of.destination_color, of.source_alpha, of.destination_alpha);
}
template <>
struct LastEnumerator<BlendFactor> {
  static constexpr BlendFactor value = BlendFactor::OneMinusSourceAlpha;
};

template <class Archive>
static void fields(Archive& archive, Pipeline& of) {
  Blend blend = of.blend.value_or(Blend());
  bool blends = of.blend.has_value();
  archive(of.shader, of.has_vertex, of.inputs, blends, blend, of.double_sided, of.depth_write, of.outputs,
          of.specialization, of.uses, of.source, of.mesh, of.primitive, of.material);
  if (blends) of.blend = blend;
}

namespace {

/// So many materials' texts are held beside the file's: enough for every core.
constexpr size_t kMaterialsAtOnce = 4096;
/// A file's result that takes a larger part of the cache is not kept there: it would push out all the rest.
constexpr uint64_t kCachePart = 8;

/// What a use of a material says of its pipelines.
struct PipelineUse {
  const Structure* structure = nullptr;
  const Structure* fallback = nullptr;  ///< null where there is none beside it
  std::vector<UsedParameter>
      parameters;  ///< where there are specialization constants and pipelines are asked for
};

/// A material's entry and what the run needs of it.
struct Done {
  std::string text;
  std::optional<ContractMaterial> by_default;  ///< of the default material, in place of the text
  Diagnostics diagnostics;
  MaterialReport report;
  std::vector<Key> structures;
  std::vector<gltf::VertexAttributes> uses;  ///< those in the manifest
  DrawState state;
  std::vector<PipelineUse> pipelines;
};

Done textOf(const Wanted& wanted, const std::string& file, const Setting& setting, Described described) {
  Done done;
  report(described.diagnostics, file, described.values.messages);
  if (wanted.index >= 0) {
    json::JsonText json(manifest::kMaterialDepth);
    manifest::write(described.values, json);
    done.text = json.take();
  } else {
    done.by_default = described.values;
  }
  const bool listed = !setting.options.pipelines.empty();
  done.state = described.values.state;
  for (size_t i = 0; i < described.met.size(); ++i) {
    PipelineUse& use = done.pipelines.emplace_back();
    use.structure = described.met[i];
    use.fallback = described.fallbacks[i];
    if (listed && use.structure->reflection.has_spec_constants)
      use.parameters = std::move(described.values.uses[i].parameters);
  }
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
    const StageTimer timer(setting_.times, StageOfRun::Manifest);
    return textOf(wanted, path_, setting_, describe(wanted, path_, lights_, setting_, structures_));
  }

  const std::string& path_;
  const std::vector<std::string>& only_;
  const Setting& setting_;
  Structures& structures_;
  passes::LightFacts lights_;
};

/// The pipelines of a file's materials and primitives.
class FilePipelines {
public:
  FilePipelines(const std::string& path, const material::Document& document, const Setting& setting)
      : wanted_(!setting.options.pipelines.empty()), drawn_(!document.primitives.empty()) {
    if (wanted_) first_.source = relativeTo(setting.folder, path);
  }

  /// Keeps of a material what primitives need of it; materials that nothing draws have pipelines at once.
  void material(int index, Done& done) {
    if (!wanted_) return;
    if (drawn_) {
      materials_.emplace(index, Material{done.state, std::move(done.pipelines)});
      return;
    }
    Pipeline first = first_;
    first.material = index;
    for (const PipelineUse& use : done.pipelines) add(done.state, use, nullptr, first);
  }

  std::vector<Pipeline> finish(const std::vector<ContractPrimitive>& primitives) {
    for (const ContractPrimitive& primitive : primitives) {
      primitiveOf(primitive, primitive.material, primitive.use);
      for (const VariantUse& variant : primitive.variants)
        primitiveOf(primitive, variant.material, variant.use);
    }
    return all_.all();
  }

private:
  struct Material {
    DrawState state;
    std::vector<PipelineUse> uses;
  };

  void add(const DrawState& state, const PipelineUse& use, const std::vector<StoredAttribute>* attributes,
           const Pipeline& first) {
    // What is drawn with first comes first.
    for (const Structure* one : {use.fallback, use.structure}) {
      if (one == nullptr) continue;
      all_.add(state, one->shader, use.parameters, one->reflection, one->has_vertex, attributes, first);
    }
  }

  void primitiveOf(const ContractPrimitive& primitive, int material, std::optional<size_t> use) {
    const auto it = materials_.find(material);
    if (it == materials_.end() || !use) return;
    Pipeline first = first_;
    first.mesh = static_cast<int32_t>(primitive.mesh);
    first.primitive = static_cast<int32_t>(primitive.primitive);
    add(it->second.state, it->second.uses[*use], &primitive.attributes, first);
  }

  bool wanted_, drawn_;
  Pipeline first_;
  std::map<int, Material> materials_;
  Pipelines all_;
};

/// Attributes of the application's that primitives store otherwise than their shaders read them.
class AttributeShapes {
public:
  AttributeShapes(const std::string& path, Diagnostics& to) : path_(path), to_(to) {}

  void material(int index, const std::vector<PipelineUse>& uses) {
    std::vector<const Structure*>& structures = structures_[index];
    for (const PipelineUse& use : uses) structures.push_back(use.structure);
  }

  void check(const std::vector<ContractPrimitive>& primitives) {
    for (const ContractPrimitive& primitive : primitives) {
      drawn(primitive, primitive.material, primitive.use);
      for (const VariantUse& variant : primitive.variants) drawn(primitive, variant.material, variant.use);
    }
  }

private:
  void drawn(const ContractPrimitive& primitive, int material, std::optional<size_t> use) {
    const auto it = structures_.find(material);
    if (it == structures_.end() || !use || *use >= it->second.size()) return;
    for (const ShaderInput& input : it->second[*use]->reflection.inputs) {
      if (const StoredAttribute* stored = storedFor(primitive.attributes, input.name))
        compare(primitive, input, *stored);
    }
  }

  void compare(const ContractPrimitive& primitive, const ShaderInput& input, const StoredAttribute& stored) {
    // Those that templates and graphs declare a type for.
    const bool color =
        input.name.starts_with("COLOR_") && input.name.back() > '0';  // alpha need not be there
    const bool coordinate = input.name.starts_with("TEXCOORD_") && input.name.back() > '3';
    if (!input.name.starts_with('_') && !color && !coordinate) return;
    if (stored.type.empty() || stored.component_type.empty()) return;
    const bool vector = input.type.back() >= '2' && input.type.back() <= '4';
    const std::string wanted = vector ? std::string("VEC") + input.type.back() : "SCALAR";
    const bool column = stored.semantic != input.name && stored.type.back() == wanted.back();
    const bool count =
        stored.type == wanted || column || (color && stored.type == "VEC3" && wanted == "VEC4");
    const bool whole = input.type[0] == 'i' || input.type[0] == 'u';
    const bool kind = !whole || (stored.component_type != "FLOAT" && !stored.normalized);
    if (count && kind) return;
    const std::string how =
        fmt::format("{}{} {}", stored.normalized ? "normalized " : "", stored.component_type, stored.type);
    if (!said_.insert(fmt::format("{} {} {}", input.name, input.type, how)).second) return;
    addBounded(to_, {"attribute-format",
                     Severity::Warning,
                     {path_, 0, 0,
                      fmt::format("/meshes/{}/primitives/{}/attributes/{}", primitive.mesh,
                                  primitive.primitive, input.name)},
                     fmt::format("{} is stored as {}, and the shader reads {} {}", input.name, how,
                                 input.type[0] == 'i' ? "an" : "a", input.type),
                     fmt::format("the accessor's type is to be {}{}", wanted,
                                 whole ? ", of integers that are not normalized" : ""),
                     {}});
  }

  const std::string& path_;
  Diagnostics& to_;
  std::map<int, std::vector<const Structure*>> structures_;
  std::set<std::string> said_;
};

/// Extensions of the materials that no node file declares, each once: one that is misspelt does nothing,
/// which is hard to see in a picture.
Diagnostics undeclared(const material::Document& document, const std::string& path,
                       const material::Schema& schema) {
  std::map<std::string, std::string> places;  // of the first of each
  for (const material::Material& material : document.materials) {
    for (const std::string& pointer : material.ignored)
      places.emplace(pointer.substr(pointer.rfind('/') + 1), pointer);
  }
  std::vector<std::string_view> known;
  for (const lang::ExtensionDecl* decl : schema.extensions) {
    if (!decl->core) known.push_back(decl->name);
  }
  Diagnostics warnings;
  for (const auto& [name, pointer] : places) {
    addBounded(warnings, {"undeclared-extension",
                          Severity::Warning,
                          {path, 0, 0, pointer},
                          fmt::format("no node file declares {}: it does nothing", printable(name)),
                          lang::didYouMean(name, known),
                          {}});
  }
  return warnings;
}

FileResult SceneFile::run(const material::Document& document) {
  FileResult result;
  lights_ = lightFacts(setting_.options, lightsOf(document));
  const std::vector<Wanted> all = wantedOf(document, only_, setting_.options);
  for (const material::Material& material : document.materials) {
    if (!only_.empty()) result.names.push_back(material.name);
  }
  result.diagnostics = document.diagnostics;
  for (Diagnostic& absent : checkWatched(setting_.options, document.materials.size())) {
    absent.place.file = path_;
    if (setting_.several) absent.severity = Severity::Warning;  // another file may have it
    result.diagnostics.push_back(std::move(absent));
  }
  result.ok = !hasError(result.diagnostics);
  if (const auto schema = setting_.library.models.schema()) {
    const Diagnostics warnings = undeclared(document, path_, **schema);
    result.diagnostics.insert(result.diagnostics.end(), warnings.begin(), warnings.end());
  }
  json::JsonText json(manifest::kEntryDepth);
  manifest::beginFile(relativeTo(setting_.folder, path_), json);
  FilePipelines pipelines(path_, document, setting_);
  Diagnostics misshapen;
  AttributeShapes shapes(path_, misshapen);
  std::set<Key> seen;
  UsesOf uses;
  FileContract behind;
  std::vector<Done> done;
  for (size_t first = 0; first < all.size(); first += done.size()) {
    done.clear();
    done.resize(std::min(kMaterialsAtOnce, all.size() - first));
    inParallel(
        done.size(), [&](size_t i) { done[i] = make(all[first + i]); }, kMaterialsTogether);
    const StageTimer timer(setting_.times, StageOfRun::Manifest);
    for (size_t i = 0; i < done.size(); ++i) {
      shapes.material(all[first + i].index, done[i].pipelines);
      pipelines.material(all[first + i].index, done[i]);
      if (all[first + i].index < 0)
        behind.default_material = std::move(done[i].by_default);
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
  addScene(document, uses, behind);
  behind.looks = document.looks;
  report(document.diagnostics, path_, behind.messages);
  shapes.check(behind.primitives);
  report(misshapen, path_, behind.messages);
  result.diagnostics.insert(result.diagnostics.end(), misshapen.begin(), misshapen.end());
  manifest::endFile(behind, json);
  result.pipelines = pipelines.finish(behind.primitives);
  result.text = json.take();
  return result;
}

/// An entry without anything but materials, which are texts.
std::string bareText(const std::string& path, const Setting& setting,
                     const std::vector<std::string>& materials, const Diagnostics& diagnostics) {
  json::JsonText json(manifest::kEntryDepth);
  manifest::beginFile(relativeTo(setting.folder, path), json);
  for (const std::string& text : materials) json.raw(text);
  FileContract behind;
  report(diagnostics, path, behind.messages);
  manifest::endFile(behind, json);
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

Key fileKey(const std::string& path, const Key& content, const Setting& setting) {
  KeyBuilder key;
  key.text("file").key(setting.base).text(path).text(relativeTo(setting.folder, path)).key(content);
  addOptions(setting.options, {Decides::Graph, Decides::Module}, key);
  if (setting.sharing != nullptr) key.key(setting.sharing->digest());
  key.number(setting.options.pipelines.empty()).number(setting.several);
  return key.finish();
}

std::string toBlob(const FileResult& result) {
  BlobWriter blob;
  blob(result.text, result.diagnostics, result.structures, result.pipelines);
  writeMaterials(result.materials, blob);
  return blob.take();
}

std::optional<FileResult> fromBlob(const std::string& path, std::string_view bytes) {
  BlobReader blob(bytes);
  FileResult result;
  blob(result.text, result.diagnostics, result.structures, result.pipelines);
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

Result<std::string> bytesOf(const std::string& path, const Setting& setting) {
  const StageTimer timer(setting.times, StageOfRun::Read);
  return readFile(path, setting.limits.file);
}

Input parsed(const std::string& path, const Key& content, std::string& bytes, const Setting& setting) {
  Input input{path, false, content, {}, {}};
  const Result<const material::Schema*> schema = setting.library.models.schema();
  if (!schema) return input.document = tl::make_unexpected(schema.error()), input;
  const StageTimer timer(setting.times, StageOfRun::Read);
  input.document =
      material::readText(bytes, path, **schema,
                         {setting.options.permissive, setting.limits, nullptr, translates(setting.options)});
  bytes = {};
  return input;
}

/// An included file, which lies below the input's folder, named as that is: relative where the input is.
std::string besideInput(const std::string& included, const std::string& input) {
  namespace fs = std::filesystem;
  std::error_code wrong;
  const fs::path folder = fs::path(input).parent_path();
  const fs::path whole = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, wrong);
  const fs::path below = fs::path(included).lexically_relative(whole);
  return wrong || below.empty() ? included : (folder / below).generic_string();
}

FileResult makeScene(const Input& input, const Key* key, const std::vector<std::string>& only,
                     const Setting& setting, Structures& structures) {
  if (!input.document) return unreadable(input.path, setting, input.document.error());
  FileResult result = SceneFile(input.path, only, setting, structures).run(*input.document);
  for (const std::string& included : input.document->included)
    result.included.push_back(besideInput(included, input.path));
  // What a file includes may change without it.
  if (key != nullptr && result.ok && input.document->included.empty() &&
      result.text.size() <= setting.options.cache_size / kCachePart) {
    const StageTimer timer(setting.times, StageOfRun::Cache);
    setting.cache->put(*key, toBlob(result));
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

FileResult makeGraph(const Input& input, const std::vector<std::string>& only, const Setting& setting,
                     Structures& structures) {
  if (!input.graph) return unreadable(input.path, setting, input.graph.error());
  const graph::Graph& graph = *input.graph;
  FileResult result;
  std::vector<std::string> texts;
  if (!only.empty()) result.names.push_back(graph.name);
  if (only.empty() || std::find(only.begin(), only.end(), graph.name) != only.end()) {
    Done done = textOf({nullptr, graph.name, 0, {}, {}}, input.path, setting,
                       describeGraph(graph, input.path, setting, structures));
    result.diagnostics = std::move(done.diagnostics);
    result.structures = std::move(done.structures);
    result.ok = done.report.ok;
    if (result.ok) addDoubts(graph, input.path, setting.library, result.diagnostics);
    Pipeline first;
    first.source = relativeTo(setting.folder, input.path);
    first.material = 0;
    Pipelines pipelines;
    for (const PipelineUse& use : done.pipelines) {
      for (const Structure* one : {use.fallback, use.structure}) {
        if (one == nullptr) continue;
        pipelines.add(done.state, one->shader, use.parameters, one->reflection, one->has_vertex, nullptr,
                      first);
      }
    }
    result.pipelines = pipelines.all();
    result.materials.push_back(std::move(done.report));
    texts.push_back(std::move(done.text));
  }
  result.text = bareText(input.path, setting, texts, {});
  return result;
}

bool isGraph(const std::string& path, InputKind kind) {
  return kind == InputKind::Graph || isGraphFile(path);
}

}  // namespace

Input readInput(const std::string& path, InputKind kind, const Setting& setting) {
  Result<std::string> bytes = bytesOf(path, setting);
  if (isGraph(path, kind)) {
    Input input{path, true, {}, {}, {}};
    input.graph = bytes ? graph::fromJson(*bytes, path, setting.limits) : tl::make_unexpected(bytes.error());
    return input;
  }
  if (!bytes) return {path, false, {}, tl::make_unexpected(bytes.error()), {}};
  return parsed(path, setting.cache == nullptr ? Key{} : keyOf(*bytes), *bytes, setting);
}

FileResult makeInput(const Input& input, const std::vector<std::string>& only, const Setting& setting,
                     Structures& structures) {
  if (input.is_graph) return makeGraph(input, only, setting, structures);
  // While programs are looked for, results are of no use to another run.
  const bool looking = setting.sharing != nullptr && !setting.sharing->closed();
  const bool keep = setting.cache != nullptr && only.empty() && !looking;
  const Key key = keep ? fileKey(input.path, input.content, setting) : Key{};
  if (keep) {
    if (std::optional<FileResult> cached = cachedFile(input.path, key, setting, structures))
      return std::move(*cached);
  }
  return makeScene(input, keep ? &key : nullptr, only, setting, structures);
}

FileResult makeInput(const std::string& path, InputKind kind, const std::vector<std::string>& only,
                     const Setting& setting, Structures& structures) {
  if (isGraph(path, kind)) return makeGraph(readInput(path, kind, setting), only, setting, structures);
  Result<std::string> bytes = bytesOf(path, setting);
  if (!bytes) return unreadable(path, setting, bytes.error());
  const bool looking = setting.sharing != nullptr && !setting.sharing->closed();
  if (setting.cache == nullptr || !only.empty() || looking)
    return makeScene(parsed(path, {}, *bytes, setting), nullptr, only, setting, structures);
  const Key content = keyOf(*bytes);
  const Key key = fileKey(path, content, setting);
  if (std::optional<FileResult> cached = cachedFile(path, key, setting, structures))
    return std::move(*cached);
  return makeScene(parsed(path, content, *bytes, setting), &key, only, setting, structures);
}

}  // namespace lacquer
