#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "bake/bake.h"
#include "bake/image.h"
#include "bake/nodes.h"
#include "eval/material.h"
#include "exchange/procedurals_out.h"
#include "gltf/uri.h"
#include "graph/graph.h"
#include "json/json.h"
#include "lacquer/exchange.h"
#include "lacquer/graph.h"
#include "preview/studio.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/base64.h"
#include "support/file.h"
#include "support/jobs.h"
#include "support/outputs.h"
#include "support/plain_name.h"
#include "support/say_once.h"
#include "support/text.h"

namespace lacquer {

using json::Json;

namespace {

namespace fs = std::filesystem;

constexpr uint32_t kMostTexels = 8192;
constexpr std::string_view kProcedurals = "KHR_texture_procedurals";

/// A path as the beginning of a URI.
std::string uriOf(const std::string& path) {
  std::string uri;
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("/._-~").find(c) != std::string_view::npos;
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

/// The member that a path leads to, made where it is not there.
Json& at(Json& from, std::string_view path) {
  Json* found = &from;
  while (!path.empty()) {
    const size_t slash = path.find('/');
    const std::string_view key = path.substr(0, slash);
    const bool number = found->is_array() && key.find_first_not_of("0123456789") == std::string_view::npos;
    if (number) {
      const size_t index = std::stoul(std::string(key));
      found = &(*found)[std::min(index, found->size() - 1)];
    } else {
      found = &(*found)[key];
    }
    path = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  }
  return *found;
}

std::string_view endingOf(Texels format) {
  switch (format) {
    case Texels::Png: return ".png";
    case Texels::Ktx2: return ".ktx2";
    case Texels::Exr: return ".exr";
  }
  return {};
}

std::optional<Texels> texelsOf(std::string_view path) {
  for (const Texels format : {Texels::Png, Texels::Ktx2, Texels::Exr}) {
    if (path.ends_with(endingOf(format))) return format;
  }
  return std::nullopt;
}

/// An image to be made: of a texture's pattern, or of a node.
struct Item {
  const material::Material* material = nullptr;  ///< null for the graph
  const gltf::TextureInfo* pattern = nullptr;
  std::string node;
  std::string stem;  ///< the file without its ending
  bool srgb = false;
  size_t image = 0;  ///< of the glTF file
};

/// Textures without what computes them.
void withoutProcedurals(Json& json) {
  if (json.is_object()) {
    const Json* extensions = json::member(json, "extensions");
    if (extensions != nullptr && extensions->is_object() && extensions->contains(kProcedurals)) {
      json["extensions"].erase(kProcedurals);
      if (json["extensions"].empty()) json.erase("extensions");
    }
  }
  if (json.is_structured()) {
    for (Json& each : json) withoutProcedurals(each);
  }
}

class Baking {
public:
  Baking(const Bake& how, const Options& options, Messages& messages, const Progress& progress)
      : how_(how), options_(translating(options)), messages_(messages), progress_(progress) {}

  Result<Baked> make(const std::string& file, const Strings& materials);
  /// The glTF file, with the images in it.
  Result<std::string> text(const std::string& file, const Strings& materials);
  /// Takes what is in memory in the place of the file.
  void take(const InMemoryFile& of);

private:
  struct Computed {
    preview::Shading shading;
    int components = 4;
  };

  Result<void> checkHow();
  Result<void> open(const std::string& file);
  Result<void> choose(const Strings& materials);
  Result<Computed> ofPattern(const Item& item, FileImages& images);
  Result<Computed> ofNode(const Item& item, FileImages& images);
  Result<Computed> bound(EvalMaterial& evaluated, FileImages& images);
  void warnOfView(const ir::Module& module, const std::string& node);
  Result<void> planNodes(const std::string& file, const Strings& materials);
  Result<void> planTextures(const std::string& file);
  Result<void> leaveClosures(const std::string& file);
  std::vector<std::pair<Texels, Strings>> outputsOf(const Item& item) const;
  Result<void> plan(const std::string& file, const Strings& materials);
  Result<std::vector<baking::Image>> compute(const Item& item, size_t number, FileImages& sources,
                                             const Strings& outputs);
  Result<void> store(const Item& item, const std::vector<baking::Image>& levels);
  FileImages sources() const;
  std::optional<uint64_t> textureFor(const graph::Texture& texture);
  void putProcedurals();
  void name(std::string_view extension);
  Result<void> write(const std::string& path, std::string_view bytes);
  Result<Json> frame(const std::string& file);
  Json materialJson(const material::Material& material) const;
  size_t textureOf(const std::string& uri, const Json& sampler = {});

  const Bake& how_;
  const Options options_;  ///< translating()
  Messages& messages_;
  const Progress& progress_;
  std::shared_ptr<const Language> language_;
  std::shared_ptr<const std::string> bytes_;  ///< the file's, where it was read from memory
  bool is_open_ = false;
  const material::Schema* schema_ = nullptr;
  material::Document document_;
  std::vector<size_t> wanted_;
  std::optional<graph::Graph> graph_;
  std::optional<Texels> alone_;  ///< the form of the image that is written without a glTF file
  std::vector<Item> items_;
  preview::Studio studio_;
  Json gltf_;
  bool embed_ = false;  ///< images are in the file
  std::string way_;     ///< from the file that is written to the folder of the one that is read
  std::optional<exchange::ProceduralsOut> procedurals_;
  Diagnostics said_;
  Strings inputs_;                          ///< files that are read, or that the written file goes on to name
  std::map<std::string, size_t> textures_;  ///< of the file that is written, by the image
  Baked baked_;
};

Result<void> Baking::choose(const Strings& materials) {
  for (const std::string& name : materials) {
    Diagnostics warnings;
    const Result<size_t> found = material::findMaterial(document_, name, warnings);
    if (!found) return tl::make_unexpected(found.error());
    report(warnings, document_.path, messages_);
    wanted_.push_back(*found);
  }
  for (size_t i = 0; materials.empty() && i < document_.materials.size(); ++i) wanted_.push_back(i);
  std::erase_if(wanted_, [&](size_t i) {
    report(document_.materials[i].diagnostics, document_.path, messages_);
    return lacquer::hasError(document_.materials[i].diagnostics);
  });
  return {};
}

/// The texel of a pattern's output as a colour: a graph that has the group alone.
Result<Baking::Computed> Baking::ofPattern(const Item& item, FileImages& images) {
  const gltf::TextureInfo& info = *item.pattern;
  graph::Graph graph = *item.material->patterns;
  const Result<std::string> name = language_->defaultTemplate();
  if (!name) return tl::make_unexpected(name.error());
  graph.template_name = *name;
  graph::Node& node = graph.nodes.emplace_back();
  node.id = "baked";
  node.type = info.group;
  node.group = true;
  const size_t group = *graph.findGroup(info.group);
  const bool several = graph.groups[group].outputs.size() > 1;
  graph.outputs.emplace_back("emission",
                             graph::Source{graph::NodeRef{"baked", several ? info.output : ""}, "xyz"});
  EvalMaterial evaluated(images, options_);
  Trial trial;
  trial.node = several ? "baked." + info.output : "baked";
  evaluated.setTrial(trial);
  Messages repeated;
  if (Result<void> lowered = evaluated.lower(graph, *language_, false, {}, repeated); !lowered)
    return tl::make_unexpected(std::move(lowered.error()));
  warnOfView(evaluated.module(), info.group);
  return bound(evaluated, images);
}

Result<Baking::Computed> Baking::ofNode(const Item& item, FileImages& images) {
  const EvalSubject subject = graph_ ? EvalSubject(*graph_) : EvalSubject(*item.material);
  EvalMaterial evaluated(images, options_);
  Trial trial;
  trial.node = item.node;
  evaluated.setTrial(trial);
  Messages repeated;
  Messages& to = &item == items_.data() ? messages_ : repeated;
  if (Result<void> lowered = evaluated.lower(subject, *language_, false, {}, to); !lowered)
    return tl::make_unexpected(std::move(lowered.error()));
  warnOfView(evaluated.module(), item.node);
  const int components = ir::componentCount(evaluated.shown()->type);
  Result<Computed> computed = bound(evaluated, images);
  if (computed) computed->components = components;
  return computed;
}

Result<Baking::Computed> Baking::bound(EvalMaterial& evaluated, FileImages& images) {
  evaluated.place({false, {}});
  preview::Look look;
  const auto neutral = [&](const ir::TextureSlot& slot, const Diagnostics& why) {
    for (Diagnostic one : why) {
      one.severity = Severity::Warning;
      report({one}, images.file(), messages_);
    }
    return neutralTexel(slot);
  };
  const Result<void> textures = evaluated.bindTextures(neutral, look.textures);
  report(images.takeNotes(), images.file(), messages_);
  if (!textures) return tl::make_unexpected(textures.error());
  look.module = evaluated.module();
  look.quads = true;
  Result<preview::Shading> made = preview::Shading::make(std::move(look), studio_);
  if (!made) return tl::make_unexpected(std::move(made.error()));
  return Computed{std::move(*made), 4};
}

/// An image knows neither the eye nor the lights: both are straight above it.
void Baking::warnOfView(const ir::Module& module, const std::string& node) {
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module.outputs) roots.push_back(output.value);
  for (const ir::ValueId id : ir::reachable(module.dag, roots)) {
    bool depends = module.dag[id].rate == ir::Rate::Light;
    if (module.dag[id].op == ir::Op::Input) {
      const std::string_view name = module.dag.inputOf(id).name;
      depends = depends || name == "VIEW" || name.ends_with("camera_position");
    }
    if (!depends) continue;
    report({{"depends-on-view",
             Severity::Warning,
             {},
             fmt::format("the output of {} depends on the view or the light", quote(node)),
             "the image has it as it is seen and lit from straight above",
             {}}},
           document_.path, messages_);
    return;
  }
}

/// A material of a document as glTF has it, without its textures.
Json Baking::materialJson(const material::Material& material) const {
  Json made = Json::object();
  made["name"] = material.name;
  for (const auto& number : material.numbers) {
    const material::Property& property = schema_->properties[number.property];
    const int count = ir::componentCount(property.decl->type);
    Json value;
    if (property.decl->kind == material::Kind::Choice) {
      value = Json(property.decl->choices[static_cast<size_t>(number.value[0])]);
    } else if (property.decl->kind == material::Kind::Bool) {
      value = Json(number.value[0] != 0);
    } else if (count == 1) {
      value = Json(number.value[0]);
    } else {
      for (int i = 0; i < count; ++i) value.push_back(Json(number.value[static_cast<size_t>(i)]));
    }
    at(made, property.path) = std::move(value);
  }
  for (const uint16_t extension : material.extensions) {
    Json& own = at(made, schema_->pathOf(extension));
    if (own.is_null()) own = Json::object();
  }
  return made;
}

/// The file without baked textures: a copy of glTF's, with the paths of what lies beside it, or one of
/// materials alone.
Result<Json> Baking::frame(const std::string& file) {
  Json gltf = Json::object();
  const fs::path from = (embed_ ? fs::path(file) : fs::absolute(fs::path(file))).parent_path();
  const fs::path to = embed_ ? from : fs::absolute(fs::path(how_.output)).parent_path();
  way_ = from == to ? "" : uriOf(from.lexically_relative(to).generic_string() + "/");
  if (document_.path.ends_with(".mtlx")) {
    gltf["asset"]["version"] = "2.0";
    gltf["asset"]["generator"] = "lacquer";
    std::set<std::string> used;
    for (const size_t i : wanted_) {
      const material::Material& material = document_.materials[i];
      for (const uint16_t extension : material.extensions) used.emplace(schema_->extensions[extension]->name);
      gltf["materials"].push_back(materialJson(material));
    }
    if (!used.empty()) gltf["extensionsUsed"] = Json(used);
    return gltf;
  }
  const Result<std::string> text = bytes_ != nullptr ? Result<std::string>(*bytes_) : readFile(file);
  if (!text) return tl::make_unexpected(text.error());
  if (text->starts_with("glTF"))
    return fail("not-gltf", {file, 0, 0, {}}, "the file is a .glb, which holds its buffers itself",
                "bake a .gltf file");
  Result<Json> parsed = json::parse(*text, file);
  if (!parsed) return tl::make_unexpected(parsed.error());
  gltf = std::move(*parsed);
  for (const char* list : {"images", "buffers", "textures"}) {
    if (!gltf.contains(list)) continue;
    if (!gltf[list].is_array()) {
      return fail("wrong-type", {file, 0, 0, fmt::format("/{}", list)},
                  fmt::format("\"{}\" is no array", list), "glTF has a list of objects there");
    }
    for (size_t i = 0; i < gltf[list].size(); ++i) {
      Json& each = gltf[list][i];
      if (!each.is_object() || !each.contains("uri") || !each["uri"].is_string()) continue;
      const std::string uri = json::text(each["uri"]);
      if (gltf::hasScheme(uri)) continue;
      const Result<std::string> relative =
          gltf::relativePath(uri, {file, 0, 0, fmt::format("/{}/{}/uri", list, i)});
      if (!relative) return tl::make_unexpected(relative.error());
      inputs_.push_back((from / *relative).string());
      each["uri"] = way_ + uri;
    }
  }
  return gltf;
}

/// The texture of an image beside the file.
size_t Baking::textureOf(const std::string& uri, const Json& sampler) {
  const auto [it, fresh] = textures_.try_emplace(uri + json::dump(sampler), 0);
  if (!fresh) return it->second;
  const uint64_t image = gltf_["images"].size();
  it->second = gltf_["textures"].size();
  gltf_["images"].push_back(Json{{"uri", uri}});
  Json texture{{"source", image}};
  if (!sampler.is_null()) {
    texture["sampler"] = static_cast<uint64_t>(gltf_["samplers"].size());
    gltf_["samplers"].push_back(sampler);
  }
  gltf_["textures"].push_back(std::move(texture));
  return it->second;
}

/// The texture of an image that a pattern looks into.
std::optional<uint64_t> Baking::textureFor(const graph::Texture& texture) {
  if (texture.texture >= 0) return static_cast<uint64_t>(texture.texture);
  if (texture.file.empty()) return std::nullopt;
  constexpr int kModes[] = {10497, 33071, 33648};
  constexpr int kNearest = 9728;
  constexpr int kLinear = 9729;
  Json sampler = Json::object();
  const char* const wraps[] = {"wrapS", "wrapT"};
  for (size_t i = 0; i < 2; ++i) sampler[wraps[i]] = kModes[static_cast<size_t>(texture.wrap[i])];
  sampler["magFilter"] = texture.nearest ? kNearest : kLinear;
  const bool whole = gltf::hasScheme(texture.file);
  return textureOf(whole ? texture.file : way_ + texture.file, sampler);
}

/// Adds an extension to those that are used.
void Baking::name(std::string_view extension) {
  Json& used = gltf_["extensionsUsed"];
  if (!used.is_array()) used = Json::array();
  for (const Json& one : used) {
    if (one == Json(extension)) return;
  }
  used.push_back(Json(extension));
}

void Baking::putProcedurals() {
  if (!procedurals_ || procedurals_->empty()) return;
  gltf_["extensions"][kProcedurals] = procedurals_->extension();
  name(kProcedurals);
  name("EXT_texture_procedurals_mx_1_39");
}

Result<void> Baking::write(const std::string& path, std::string_view bytes) {
  const Result<bool> written = writeFile(path, bytes, {nullptr, options_.sync});
  if (!written) return tl::make_unexpected(written.error());
  return {};
}

Result<void> Baking::checkHow() {
  if (!embed_) {
    if (Result<void> path = hasPath("the file to write", how_.output); !path) return path;
  }
  if (Result<void> size = inRange("the size of an image", how_.size, 1, kMostTexels, "texels"); !size)
    return size;
  constexpr uint32_t kSamples[] = {2, 4, 6, 8, 16};
  if (std::find(std::begin(kSamples), std::end(kSamples), how_.samples) == std::end(kSamples))
    return fail("out-of-range", {}, fmt::format("{} places along a texel's side", how_.samples),
                "there may be 2, 4, 6, 8 or 16");
  const bool gltf = embed_ || how_.output.ends_with(".gltf");
  if (!gltf) alone_ = texelsOf(how_.output);
  if (!gltf && !alone_)
    return fail("unknown-format", {how_.output, 0, 0, {}}, "the name does not say what is to be written",
                "it ends in .gltf, .png, .ktx2 or .exr");
  if (alone_ && !how_.also.empty())
    return fail("unknown-format", {how_.output, 0, 0, {}}, "one image has one form",
                "other forms are written beside a .gltf file");
  std::vector<Texels> forms = how_.also;
  forms.push_back(alone_.value_or(Texels::Png));
  const auto has = [&](Texels one) { return std::find(forms.begin(), forms.end(), one) != forms.end(); };
  if (how_.srgb && alone_ && (*alone_ == Texels::Exr || how_.bits > 8))
    return fail("unknown-format", {how_.output, 0, 0, {}}, "only an image of 8 bits is encoded by sRGB",
                "write .png, or .ktx2 with 8 bits, or leave `srgb` away: other images are linear");
  const uint32_t bits = how_.bits;
  const bool fits = bits == 0 || (bits == 8 && !has(Texels::Exr)) ||
                    (bits == 16 && (has(Texels::Ktx2) || has(Texels::Exr))) ||
                    (bits == 32 && has(Texels::Exr) && !has(Texels::Ktx2));
  if (fits) return {};
  return fail("unknown-format", {how_.output, 0, 0, {}},
              fmt::format("there is no such image of {} bits", bits),
              "PNG has 8 bits, KTX2 8 or 16, OpenEXR 16 or 32");
}

void Baking::take(const InMemoryFile& of) {
  document_ = of.document;
  language_ = of.language;
  bytes_ = of.bytes;
  is_open_ = true;
}

Result<void> Baking::open(const std::string& file) {
  if (is_open_) {
    const Result<const material::Schema*> known = language_->models.schema();
    if (!known) return tl::make_unexpected(known.error());
    schema_ = *known;
    report(document_.diagnostics, file, messages_);
    return {};
  }
  Result<std::shared_ptr<const Language>> language = libraryFor(options_);
  if (!language) return tl::make_unexpected(language.error());
  language_ = std::move(*language);
  const Result<const material::Schema*> schema = language_->models.schema();
  if (!schema) return tl::make_unexpected(schema.error());
  schema_ = *schema;
  if (isGraphFile(file)) {
    Result<graph::Graph> graph = readGraphFile(file, options_);
    if (!graph) return tl::make_unexpected(graph.error());
    graph_ = std::move(*graph);
    document_.path = file;
    return {};
  }
  Result<material::Document> document = readMaterials(file, *language_, options_);
  if (!document) return tl::make_unexpected(document.error());
  document_ = std::move(*document);
  report(document_.diagnostics, file, messages_);
  return {};
}

Result<void> Baking::planNodes(const std::string& file, const Strings& materials) {
  const material::Material* material = nullptr;
  if (!graph_) {
    Diagnostics warnings;
    const Result<size_t> found = material::findMaterial(
        document_, materials.empty() ? std::nullopt : std::optional(materials[0]), warnings);
    if (!found) return tl::make_unexpected(found.error());
    report(warnings, file, messages_);
    material = &document_.materials[*found];
    report(material->diagnostics, file, messages_);
    if (lacquer::hasError(material->diagnostics)) return tl::make_unexpected(Diagnostics{});
  }
  const EvalSubject subject = graph_ ? EvalSubject(*graph_) : EvalSubject(*material);
  const Result<baking::Nodes> nodes = baking::nodesOf(subject, how_.nodes, embed_, *language_, options_);
  if (!nodes) return tl::make_unexpected(nodes.error());
  if (nodes->names.empty())
    return fail("nothing-to-bake", {file, 0, 0, {}},
                "no node of the graph depends on texture coordinates alone",
                "--node bakes the output of any node");
  const fs::path output(how_.output);
  const std::string before = alone_ ? output.stem().string() + "_" : std::string();
  std::set<std::string> taken;
  gltf_ = Json::object();
  gltf_["asset"]["version"] = "2.0";
  gltf_["asset"]["generator"] = "lacquer";
  name("KHR_materials_unlit");
  for (const std::string& node : nodes->names) {
    const std::string stem =
        alone_ && nodes->names.size() == 1 ? output.stem().string() : before + plainName(node);
    std::string name = stem;
    for (size_t n = 2; !taken.insert(name).second; ++n) name = fmt::format("{}_{}", stem, n);
    items_.push_back({material, nullptr, node, name, how_.srgb || !alone_});
    if (alone_) continue;
    Json made = Json::object();
    made["name"] = node;
    made["extensions"]["KHR_materials_unlit"] = Json::object();
    const size_t number = textureOf(uriOf(name + ".png"));
    items_.back().image = static_cast<size_t>(gltf_["textures"][number]["source"].get<uint64_t>());
    Json& info = made["pbrMetallicRoughness"]["baseColorTexture"];
    info["index"] = static_cast<uint64_t>(number);
    const Result<graph::Source> source = graph::outputAt(nodes->outputs, node);
    if (source && baking::isMaterialX(nodes->flat, *source, *language_)) {
      const std::string port = "out";
      const auto written = procedurals_->ofSources(nodes->flat, node, {{port, *source}});
      if (written.outputs.contains(port))
        info["extensions"][kProcedurals] =
            Json{{"index", static_cast<uint64_t>(written.number)}, {"output", port}};
    }
    gltf_["materials"].push_back(std::move(made));
    ++baked_.textures;
  }
  return {};
}

/// Materials that glTF has no properties for are left out, with an error each.
Result<void> Baking::leaveClosures(const std::string& file) {
  const auto isOfClosures = [&](size_t i) {
    const material::Material& material = document_.materials[i];
    if (material.closures.empty()) return false;
    report(fail("closures-not-baked", {file, 0, 0, {}},
                fmt::format("the material {} is made of closures", quote(material.name)),
                "glTF has no properties for them, and it is left out")
               .value(),
           file, messages_);
    return true;
  };
  const bool left = std::erase_if(wanted_, isOfClosures) > 0;
  if (left && wanted_.empty()) return tl::make_unexpected(Diagnostics());  // reported
  return {};
}

Result<void> Baking::planTextures(const std::string& file) {
  if (Result<void> left = leaveClosures(file); !left) return left;
  if (!alone_) {
    Result<Json> gltf = frame(file);
    if (!gltf) return tl::make_unexpected(gltf.error());
    gltf_ = std::move(*gltf);
  }
  const bool own = document_.path.ends_with(".mtlx");
  // Animations point into the file's own procedurals.
  const bool rewritten =
      own || (embed_ && std::none_of(document_.animated.begin(), document_.animated.end(),
                                     [](const gltf::AnimatedPointer& p) {
                                       return p.target.find("/procedurals/") != std::string::npos;
                                     }));
  if (rewritten && !own && !alone_ && gltf_.contains("materials")) withoutProcedurals(gltf_["materials"]);
  std::map<std::string, size_t> names;  // of items by what they show
  std::map<std::string, exchange::ProceduralsOut::Written> groups;
  std::set<std::string> taken;
  const std::string before = alone_ ? fs::path(how_.output).stem().string() + "_" : std::string();
  for (size_t k = 0; k < wanted_.size(); ++k) {
    const material::Material& material = document_.materials[wanted_[k]];
    for (const auto& texture : material.textures) {
      if (texture.info.group.empty()) continue;
      const material::Property& property = schema_->properties[texture.property];
      const std::string key =
          fmt::format("{} {} {}", texture.info.group, texture.info.output, property.decl->srgb);
      const auto [it, fresh] = names.try_emplace(key);
      if (fresh) {
        const std::string stem = before + plainName(fmt::format("{}_{}", material.name, property.decl->name));
        std::string name = stem;
        for (size_t n = 2; !taken.insert(name).second; ++n) name = fmt::format("{}_{}", stem, n);
        it->second = items_.size();
        items_.push_back({&material, &texture.info, {}, name, property.decl->srgb});
      }
      if (alone_) continue;
      Item& item = items_[it->second];
      const size_t number = textureOf(item.stem + ".png");  // may move what is in the file
      item.image = static_cast<size_t>(gltf_["textures"][number]["source"].get<uint64_t>());
      const auto [group, unknown] = groups.try_emplace(texture.info.group);
      if (unknown && rewritten) group->second = procedurals_->ofGroup(*material.patterns, texture.info.group);
      Json& info = own ? at(gltf_["materials"][k], property.path)
                       : at(gltf_, std::string_view(texture.info.pointer).substr(1));
      info["index"] = static_cast<uint64_t>(number);
      if (rewritten && group->second.outputs.contains(texture.info.output))
        info["extensions"][kProcedurals] =
            Json{{"index", static_cast<uint64_t>(group->second.number)}, {"output", texture.info.output}};
      for (size_t m = 0; own && m < property.decl->members.size() && m < texture.info.members.size(); ++m)
        info[property.decl->members[m].name] = texture.info.members[m];
      ++baked_.textures;
    }
  }
  if (items_.empty() && !embed_)
    return fail("nothing-to-bake", {file, 0, 0, {}}, "no material has a procedural texture",
                fmt::format("they are patterns of a .mtlx file, or {}; --node bakes the output of any node",
                            kProcedurals));
  // One image has the name that was asked for.
  if (alone_ && items_.size() == 1) items_[0].stem = fs::path(how_.output).stem().string();
  return {};
}

/// The files of an item, one for each format.
std::vector<std::pair<Texels, Strings>> Baking::outputsOf(const Item& item) const {
  std::vector<Texels> forms{alone_.value_or(Texels::Png)};
  for (const Texels form : how_.also) {
    if (std::find(forms.begin(), forms.end(), form) == forms.end()) forms.push_back(form);
  }
  const fs::path folder = fs::path(how_.output).parent_path();
  std::vector<std::pair<Texels, Strings>> outputs;
  for (const Texels form : forms) {
    const std::string first = (folder / item.stem).string();
    Strings files{first + std::string(endingOf(form))};
    uint32_t size = how_.size;
    for (size_t n = 1; form == Texels::Png && how_.levels && size > 1; ++n) {
      size /= 2;
      files.push_back(fmt::format("{}_{}.png", first, n));
    }
    outputs.emplace_back(form, std::move(files));
  }
  return outputs;
}

Result<std::vector<baking::Image>> Baking::compute(const Item& item, size_t number, FileImages& sources,
                                                   const Strings& outputs) {
  Result<Computed> computed = item.pattern != nullptr ? ofPattern(item, sources) : ofNode(item, sources);
  if (!computed) return tl::make_unexpected(std::move(computed.error()));
  if (Diagnostics wrong = clashes(sources.read(), outputs); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  size_t done = number * how_.size;
  const size_t known = items_.size() * size_t{how_.size};
  const auto rows = [&](size_t more) {
    done += more;
    if (progress_) progress_(done, known);
  };
  // Pixels of 8 bits are the same in every format.
  const bool clamp = item.pattern != nullptr || alone_.value_or(Texels::Png) == Texels::Png;
  baking::Image image =
      baking::imageOf(computed->shading, {how_.size, how_.samples, clamp, computed->components}, rows);
  if (how_.levels) return baking::withLevels(std::move(image));
  std::vector<baking::Image> levels;
  levels.push_back(std::move(image));
  return levels;
}

Result<void> Baking::store(const Item& item, const std::vector<baking::Image>& levels) {
  for (const auto& [form, files] : outputsOf(item)) {
    const uint32_t least = form == Texels::Exr ? 16 : 8;
    const uint32_t bits = form == Texels::Png ? 8 : how_.bits == 0 ? least : std::max(how_.bits, least);
    const Result<Strings> made = baking::filesOf(levels, form, bits, item.srgb);
    if (!made) return tl::make_unexpected(made.error());
    for (size_t i = 0; i < made->size(); ++i) {
      if (Result<void> written = write(files[i], (*made)[i]); !written) return written;
      baked_.images.push_back(files[i]);
    }
  }
  return {};
}

FileImages Baking::sources() const {
  return graph_ ? FileImages::ofGraph(document_.path, options_)
                : FileImages(document_.path, options_, bytes_);
}

Result<void> Baking::plan(const std::string& file, const Strings& materials) {
  if (Result<void> good = checkHow(); !good) return good;
  if (Result<void> opened = open(file); !opened) return opened;
  const auto number = [this](const graph::Texture& texture) { return textureFor(texture); };
  procedurals_.emplace(*schema_, document_, number, said_);
  const bool nodes = graph_ || !how_.nodes.empty();
  if (!nodes) {
    if (Result<void> chosen = choose(materials); !chosen) return chosen;
  }
  if (Result<void> planned = nodes ? planNodes(file, materials) : planTextures(file); !planned)
    return planned;
  report(said_, file, messages_);
  putProcedurals();
  return {};
}

Result<Baked> Baking::make(const std::string& file, const Strings& materials) {
  if (Result<void> planned = plan(file, materials); !planned)
    return tl::make_unexpected(std::move(planned.error()));
  Strings outputs;
  if (!alone_) outputs.push_back(how_.output);
  for (const Item& item : items_) {
    for (const auto& [form, files] : outputsOf(item))
      outputs.insert(outputs.end(), files.begin(), files.end());
  }
  inputs_.push_back(file);
  inputs_.insert(inputs_.end(), document_.included.begin(), document_.included.end());
  if (Diagnostics wrong = clashes(inputs_, outputs); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  FileImages images = sources();
  for (size_t i = 0; i < items_.size(); ++i) {
    const Result<std::vector<baking::Image>> levels = compute(items_[i], i, images, outputs);
    if (!levels) return tl::make_unexpected(levels.error());
    if (Result<void> stored = store(items_[i], *levels); !stored)
      return tl::make_unexpected(std::move(stored.error()));
  }
  if (alone_) return std::move(baked_);
  if (Result<void> written = write(how_.output, json::dump(gltf_, 2) + "\n"); !written)
    return tl::make_unexpected(std::move(written.error()));
  baked_.output = how_.output;
  return std::move(baked_);
}

Result<std::string> Baking::text(const std::string& file, const Strings& materials) {
  embed_ = true;
  if (!materials.empty() && !isGraphFile(file) && !file.ends_with(".mtlx"))
    return fail("whole-file", {file, 0, 0, {}}, "a glTF file is written whole, not one of its materials",
                "leave --material away");
  if (Result<void> planned = plan(file, materials); !planned)
    return tl::make_unexpected(std::move(planned.error()));
  FileImages images = sources();
  for (size_t i = 0; i < items_.size(); ++i) {
    const Result<std::vector<baking::Image>> levels = compute(items_[i], i, images, {});
    if (!levels) return tl::make_unexpected(levels.error());
    const Result<Strings> made = baking::filesOf(*levels, Texels::Png, 8, items_[i].srgb);
    if (!made) return tl::make_unexpected(made.error());
    Json& image = gltf_["images"][items_[i].image];
    image["uri"] = "data:image/png;base64," + toBase64((*made)[0]);
  }
  return json::dump(gltf_, 2) + "\n";
}

}  // namespace

std::optional<Baked> bake(const Bake& how, const std::string& file, const Strings& materials,
                          const Options& options, Messages& messages, const Progress& progress) {
  Result<Baked> made;
  withJobs(options.jobs, [&] { made = Baking(how, options, messages, progress).make(file, materials); });
  return valueOf(std::move(made), file, messages);
}

std::string gltfOf(const InMemoryFile& of, const Strings& materials, uint32_t size, const Options& options,
                   Messages& messages) {
  Result<std::string> made;
  Bake how;
  how.size = size;
  const Progress none;
  withJobs(options.jobs, [&] {
    Baking baking(how, options, messages, none);
    baking.take(of);
    made = baking.text(of.document.path, materials);
  });
  return valueOf(std::move(made), of.document.path, messages).value_or(std::string());
}

std::string toGltf(const std::string& file, const Strings& materials, uint32_t size, const Options& options,
                   Messages& messages) {
  Result<std::string> made;
  Bake how;
  how.size = size;
  const Progress none;
  withJobs(options.jobs, [&] { made = Baking(how, options, messages, none).text(file, materials); });
  return valueOf(std::move(made), file, messages).value_or(std::string());
}

}  // namespace lacquer
