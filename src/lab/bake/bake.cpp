#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "bake/image.h"
#include "eval/material.h"
#include "gltf/uri.h"
#include "graph/graph.h"
#include "json/json.h"
#include "lacquer/exchange.h"
#include "lacquer/graph.h"
#include "preview/studio.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/file.h"
#include "support/jobs.h"
#include "support/outputs.h"
#include "support/plain_name.h"
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
      found = found->begin() + std::min(index, found->size() - 1);
    } else {
      found = &(*found)[key];
    }
    path = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  }
  return *found;
}

class Baking {
public:
  Baking(const Bake& how, const Options& options, Messages& messages, const Progress& progress)
      : how_(how), options_(options), messages_(messages), progress_(progress) {}

  Result<Baked> make(const std::string& file, const Strings& materials);

private:
  Result<void> choose(const Strings& materials);
  Result<preview::Shading> shadingOf(const material::Material& material, const gltf::TextureInfo& info,
                                     FileImages& images);
  Result<void> write(const std::string& path, std::string_view bytes);
  Result<Json> frame(const std::string& file);
  Json materialJson(const material::Material& material) const;
  size_t textureOf(const std::string& uri);

  const Bake& how_;
  const Options& options_;
  Messages& messages_;
  const Progress& progress_;
  std::shared_ptr<const Language> language_;
  const material::Schema* schema_ = nullptr;
  material::Document document_;
  std::vector<size_t> wanted_;
  preview::Studio studio_;
  Json gltf_;
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
Result<preview::Shading> Baking::shadingOf(const material::Material& material, const gltf::TextureInfo& info,
                                           FileImages& images) {
  graph::Graph graph = *material.patterns;
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
  evaluated.place({false, {}});
  preview::Look look;
  const auto neutral = [&](const ir::TextureSlot& slot, const Diagnostics& why) {
    for (Diagnostic one : why) {
      one.severity = Severity::Warning;
      report({one}, images.file(), messages_);
    }
    return neutralTexel(slot);
  };
  const Result<void> bound = evaluated.bindTextures(neutral, look.textures);
  report(images.takeNotes(), images.file(), messages_);
  if (!bound) return tl::make_unexpected(bound.error());
  look.module = evaluated.module();
  return preview::Shading::make(std::move(look), studio_);
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
  const Result<std::string> text = readFile(file);
  if (!text) return tl::make_unexpected(text.error());
  if (text->starts_with("glTF"))
    return fail("not-gltf", {file, 0, 0, {}}, "the file is a .glb, which holds its buffers itself",
                "bake a .gltf file");
  Result<Json> parsed = json::parse(*text, file);
  if (!parsed) return tl::make_unexpected(parsed.error());
  gltf = std::move(*parsed);
  const fs::path from = fs::absolute(fs::path(file)).parent_path();
  const fs::path to = fs::absolute(fs::path(how_.output)).parent_path();
  const std::string way = from == to ? "" : uriOf(from.lexically_relative(to).generic_string() + "/");
  for (const char* list : {"images", "buffers", "textures"}) {
    if (!gltf.contains(list)) continue;
    if (!gltf[list].is_array()) {
      return fail("wrong-type", {file, 0, 0, fmt::format("/{}", list)},
                  fmt::format("\"{}\" is no array", list), "glTF has a list of objects there");
    }
    for (Json& each : gltf[list]) {
      if (!each.is_object() || !each.contains("uri") || !each["uri"].is_string()) continue;
      const std::string uri = each["uri"].text();
      if (gltf::hasScheme(uri)) continue;
      const Result<std::string> relative =
          gltf::relativePath(uri, {file, 0, 0, fmt::format("/{}/{}/uri", list, &each - gltf[list].begin())});
      if (!relative) return tl::make_unexpected(relative.error());
      inputs_.push_back((from / *relative).string());
      each["uri"] = way + uri;
    }
  }
  return gltf;
}

/// The texture of an image beside the file.
size_t Baking::textureOf(const std::string& uri) {
  const auto [it, fresh] = textures_.try_emplace(uri, 0);
  if (!fresh) return it->second;
  const uint64_t image = gltf_["images"].size();
  it->second = gltf_["textures"].size();
  gltf_["images"].push_back(Json{{"uri", uri}});
  gltf_["textures"].push_back(Json{{"source", image}});
  return it->second;
}

Result<void> Baking::write(const std::string& path, std::string_view bytes) {
  const Result<bool> written = writeFile(path, bytes, {nullptr, options_.sync});
  if (!written) return tl::make_unexpected(written.error());
  return {};
}

Result<Baked> Baking::make(const std::string& file, const Strings& materials) {
  if (Result<void> path = hasPath("the glTF file", how_.output); !path)
    return tl::make_unexpected(std::move(path.error()));
  if (Result<void> size = inRange("the size of an image", how_.size, 1, kMostTexels, "texels"); !size)
    return tl::make_unexpected(std::move(size.error()));
  if (isGraphFile(file))
    return fail("graph-is-built", {file, 0, 0, {}},
                "a graph is built of a material's terms: it has no procedural textures to bake",
                "name the material's file: .gltf or .mtlx");
  Result<std::shared_ptr<const Language>> language = libraryFor(options_);
  if (!language) return tl::make_unexpected(language.error());
  language_ = std::move(*language);
  const Result<const material::Schema*> schema = language_->models.schema();
  if (!schema) return tl::make_unexpected(schema.error());
  schema_ = *schema;
  Result<material::Document> document = readMaterials(file, *language_, options_);
  if (!document) return tl::make_unexpected(document.error());
  document_ = std::move(*document);
  report(document_.diagnostics, file, messages_);
  if (Result<void> chosen = choose(materials); !chosen) return tl::make_unexpected(std::move(chosen.error()));
  Result<Json> gltf = frame(file);
  if (!gltf) return tl::make_unexpected(gltf.error());
  gltf_ = std::move(*gltf);

  struct Image {
    const material::Material* material;
    const material::Material::Texture* texture;
    std::string name;
  };
  std::vector<Image> images;
  std::map<std::string, std::string> names;  // of images by what they show
  std::set<std::string> taken;
  const fs::path folder = fs::path(how_.output).parent_path();
  for (size_t k = 0; k < wanted_.size(); ++k) {
    const material::Material& material = document_.materials[wanted_[k]];
    for (const auto& texture : material.textures) {
      if (texture.info.group.empty()) continue;
      const material::Property& property = schema_->properties[texture.property];
      const std::string key =
          fmt::format("{} {} {}", texture.info.group, texture.info.output, property.decl->srgb);
      const auto [it, fresh] = names.try_emplace(key);
      if (fresh) {
        const std::string stem = plainName(fmt::format("{}_{}", material.name, property.decl->name));
        std::string name = stem + ".png";
        for (size_t n = 2; !taken.insert(name).second; ++n) name = fmt::format("{}_{}.png", stem, n);
        it->second = name;
        images.push_back({&material, &texture, name});
      }
      const bool own = document_.path.ends_with(".mtlx");
      const size_t number = textureOf(it->second);  // may move what is in the file
      Json& info = own ? at(gltf_["materials"].begin()[k], property.path)
                       : at(gltf_, std::string_view(texture.info.pointer).substr(1));
      info["index"] = static_cast<uint64_t>(number);
      for (size_t m = 0; own && m < property.decl->members.size() && m < texture.info.members.size(); ++m)
        info[property.decl->members[m].name] = texture.info.members[m];
      ++baked_.textures;
    }
  }
  if (images.empty())
    return fail("nothing-to-bake", {file, 0, 0, {}}, "no material has a procedural texture",
                fmt::format("they are patterns of a .mtlx file, or {}", kProcedurals));
  Strings outputs{how_.output};
  for (const Image& image : images) outputs.push_back((folder / image.name).string());
  inputs_.push_back(file);
  inputs_.insert(inputs_.end(), document_.included.begin(), document_.included.end());
  if (Diagnostics wrong = clashes(inputs_, outputs); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  FileImages sources(document_.path, options_);
  for (size_t i = 0; i < images.size(); ++i) {
    const Image& image = images[i];
    const Result<preview::Shading> shading = shadingOf(*image.material, image.texture->info, sources);
    if (!shading) return tl::make_unexpected(shading.error());
    const bool srgb = schema_->properties[image.texture->property].decl->srgb;
    if (Diagnostics wrong = clashes(sources.read(), outputs); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    if (Result<void> written = write(outputs[i + 1], baking::imageOf(*shading, how_.size, srgb)); !written)
      return tl::make_unexpected(std::move(written.error()));
    baked_.images.push_back(outputs[i + 1]);
    if (progress_) progress_(i + 1, images.size());
  }
  if (Result<void> written = write(how_.output, gltf_.dump(2) + "\n"); !written)
    return tl::make_unexpected(std::move(written.error()));
  baked_.output = how_.output;
  return std::move(baked_);
}

}  // namespace

std::optional<Baked> bake(const Bake& how, const std::string& file, const Strings& materials,
                          const Options& options, Messages& messages, const Progress& progress) {
  Result<Baked> made;
  withJobs(options.jobs, [&] { made = Baking(how, options, messages, progress).make(file, materials); });
  return valueOf(std::move(made), file, messages);
}

}  // namespace lacquer
