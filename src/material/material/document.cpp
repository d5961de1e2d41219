#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "gltf/container.h"
#include "gltf/scene.h"
#include "gltf/version.h"
#include "json/doubles.h"
#include "json/json.h"
#include "json/path.h"
#include "json/report.h"
#include "material/beside.h"
#include "material/material.h"
#include "material/reader.h"
#include "materialx/materialx.h"
#include "support/file.h"
#include "support/text.h"

namespace lacquer::material {

using json::Json;
using json::Path;
using json::Report;

namespace {

/// Checks one of the asset's two versions. `newest` is the newest minor version that can be read.
void checkVersion(const Json& version, std::string_view name, int newest, const Path& path, Report& report) {
  if (!version.is_string()) return report.wrongType(path, name, version, "a string such as \"2.0\"");
  const auto& text = json::text(version);
  const std::optional<std::pair<int, int>> number = gltf::versionOf(text);
  if (number && number->first == 2 && number->second <= newest) return;
  report.error("unsupported-version", path, fmt::format("{} is {}", name, quote(text)),
               "Lacquer reads glTF 2.0 and 2.1");
}

/// What makes the file as a whole unusable.
void checkRoot(const Json& root, Report& report) {
  const Path path;
  if (!root.is_object()) return report.wrongType(path, "the file", root, "a JSON object");
  const Path assetPath(path, "asset");
  const Json* asset = json::member(root, "asset");
  if (asset == nullptr) {
    return report.error("missing-property", path, "the file has no \"asset\"",
                        "every glTF has one: \"asset\": { \"version\": \"2.0\" }");
  }
  if (!asset->is_object()) return report.wrongType(assetPath, "asset", *asset, "an object");
  if (const Json* version = json::member(*asset, "version")) {
    // Any 2.x can be read as a 2.0, unless it says otherwise in minVersion.
    checkVersion(*version, "version", 9999, Path(assetPath, "version"), report);
  } else {
    report.error("missing-property", assetPath, "the asset has no \"version\"",
                 "Lacquer reads glTF 2.0 and 2.1");
  }
  if (const Json* least = json::member(*asset, "minVersion")) {
    checkVersion(*least, "minVersion", 1, Path(assetPath, "minVersion"), report);
  }
  if (const Json* materials = json::member(root, "materials");
      materials != nullptr && !materials->is_array()) {
    report.wrongType(Path(path, "materials"), "materials", *materials, "an array");
  }
}

/// What the file says of the material extensions as a whole: those it cannot do without, and those at its
/// root.
void checkExtensions(const Json& root, const Schema& schema, Report& report) {
  const Path path;
  const Path requiredPath(path, "extensionsRequired");
  const Json* required = json::member(root, "extensionsRequired");
  for (size_t i = 0; required != nullptr && required->is_array() && i < required->size(); ++i) {
    if (!(*required)[i].is_string()) continue;
    const auto& name = json::text((*required)[i]);
    if (schema.find(name) || !besideMaterials(name).empty()) continue;
    // What nobody here knows may change materials, whatever its name is.
    const bool of_materials = name.find("_materials_") != std::string::npos;
    report.warning("required-extension", Path(requiredPath, i),
                   fmt::format("{} is required, but Lacquer does not implement it", printable(name)),
                   of_materials ? "materials that use it will look different"
                                : "if it changes materials, they will look different");
  }
  const Path extensionsPath(path, "extensions");
  const Json* extensions = json::member(root, "extensions");
  if (extensions == nullptr || !extensions->is_object()) return;
  for (const auto& [name, ignored] : extensions->items()) {
    const std::optional<uint16_t> index = schema.find(name);
    if ((!index || *index == 0) && name != "KHR_texture_transform") continue;
    const std::string place = name == "KHR_texture_transform" ? "a textureInfo's extensions"
                              : schema.extensions[*index]->inside.empty()
                                  ? "the material's extensions"
                                  : fmt::format("{}.extensions", schema.extensions[*index]->inside);
    report.error("misplaced-extension", Path(extensionsPath, name), fmt::format("{} has no place here", name),
                 fmt::format("move it to {}", place));
  }
}

/// The names that parameters of properties have.
materialx::Names namesOf(const Schema& schema) {
  materialx::Names names;
  for (const Property& property : schema.properties) {
    names.insert(property.parameter_name);
    for (const lang::PropertyDecl& member : property.decl->members)
      names.insert(fmt::format("{}_{}", property.parameter_name, parameterName(member.name)));
  }
  return names;
}

constexpr std::string_view kOfProcedurals = "/extensions/KHR_texture_procedurals/procedurals/";

/// Where an animation points to. The text of KHR_texture_procedurals leaves its own name out of the pointers.
std::string wholePointer(const gltf::AnimatedPointer& pointer) {
  constexpr std::string_view kShort = "/extensions/procedurals/";
  if (!pointer.target.starts_with(kShort)) return pointer.target;
  return std::string(kOfProcedurals) + pointer.target.substr(kShort.size());
}

/// Says which animations point into procedural textures, and change no number there.
void checkAnimated(const materialx::Procedurals& procedurals, Document& document) {
  std::set<std::string_view> changed;
  for (const graph::Parameter& parameter : procedurals.patterns->parameters)
    if (parameter.animated) changed.insert(parameter.pointer);
  for (const gltf::AnimatedPointer& pointer : document.animated) {
    const std::string whole = wholePointer(pointer);
    std::string_view number = whole;
    if (!number.starts_with(kOfProcedurals)) continue;
    constexpr std::string_view kValue = "/value";
    if (!changed.contains(number) && number.ends_with(kValue)) number.remove_suffix(kValue.size());
    if (changed.contains(number)) continue;
    addBounded(document.diagnostics,
               {"animation-pointer",
                Severity::Warning,
                {document.path, 0, 0, pointer.place},
                fmt::format("the animation of {} has no effect", quote(pointer.target)),
                "no number of a procedural texture that one of its outputs takes stands there",
                {}});
  }
}

/// What computes texels in the place of textures, where the file has such a thing.
materialx::Procedurals proceduralsOf(const Json& root, const Schema& schema, const ReadOptions& options,
                                     Document& document) {
  const Json* extensions = json::member(root, "extensions");
  const Json* found = extensions == nullptr ? nullptr : json::member(*extensions, "KHR_texture_procedurals");
  const Json* required = json::member(root, "extensionsRequired");
  bool needed = false;
  for (size_t i = 0; required != nullptr && required->is_array() && i < required->size(); ++i)
    needed = needed || (*required)[i] == Json("KHR_texture_procedurals");
  if (found == nullptr) return {{}, needed, {}};
  materialx::ProceduralOptions how{options.limits, needed, {}, namesOf(schema), schema.definitions};
  if (const Json* textures = json::member(root, "textures"); textures != nullptr && textures->is_array())
    how.textures = textures->size();
  for (const gltf::AnimatedPointer& pointer : document.animated) how.animated.insert(wholePointer(pointer));
  materialx::Procedurals made =
      materialx::readProcedurals(*found, document.path, *schema.library, how, document.diagnostics);
  checkAnimated(made, document);
  return made;
}

/// Patterns look into images as they are, whatever a texture says of their channels.
void checkSwizzles(const materialx::Procedurals& procedurals, Document& document) {
  if (!procedurals.patterns) return;
  for (const graph::Texture& slot : procedurals.patterns->textures) {
    const auto number = static_cast<size_t>(slot.texture);
    if (slot.texture < 0 || number >= document.textures.size()) continue;
    if (document.textures[number].channels() == gltf::kOwnChannels) continue;
    addBounded(
        document.diagnostics,
        {"swizzle-unread",
         Severity::Warning,
         {document.path, 0, 0, slot.pointer},
         fmt::format("a procedural texture reads texture {}, whose channels are in another order", number),
         "procedural textures read an image's channels as they are: `extract` and `combine3` order them",
         {}});
  }
}

/// A MaterialX document: its surfaces as materials of a glTF file without a scene.
Result<Document> readMaterialX(std::string_view text, const std::string& name, const Schema& schema,
                               const ReadOptions& options) {
  Result<materialx::Materials> read = materialx::readMaterials(
      text, name, *schema.library,
      {options.limits, namesOf(schema), options.included, options.translate, schema.definitions});
  if (!read) return tl::make_unexpected(read.error());
  Document document;
  document.path = name;
  document.diagnostics = std::move(read->diagnostics);
  document.included = std::move(read->files);
  document.looks = std::move(read->looks);
  document.uses.resize(read->materials.size());
  const FileFacts facts{name, document, options.permissive, &read->procedurals};
  for (size_t i = 0; i < read->materials.size(); ++i) {
    Material& material = document.materials.emplace_back(readMaterial(read->materials[i], i, schema, facts));
    material.patterns = read->procedurals.patterns;
    material.ports = std::move(read->closures[i]);
    if (!material.ports.empty()) material.closures = read->procedurals.list[i].group;
    material.surface = std::move(read->surfaces[i].category);
    material.translation_error = read->surfaces[i].error;
    material.surface_pointer = std::move(read->surfaces[i].pointer);
    material.surface_place = std::move(read->surfaces[i].place);
    material.displacement = std::move(read->displacements[i]);
    Diagnostics& own = read->of_materials[i];
    own.insert(own.end(), material.diagnostics.begin(), material.diagnostics.end());
    material.diagnostics = std::move(own);
  }
  return document;
}

Result<Document> readDocument(std::string_view bytes, const std::string& name, const Schema& schema,
                              const ReadOptions& options) {
  // What is called a document, and is neither JSON nor a GLB, is one that does not begin as it should.
  const size_t start = bytes.find_first_not_of(" \t\r\n");
  const bool named = name.ends_with(".mtlx") && start != std::string_view::npos && bytes[start] != '{' &&
                     !gltf::isGlb(bytes);
  if (materialx::isXml(bytes) || named) return readMaterialX(bytes, name, schema, options);
  const Result<std::string_view> text = gltf::jsonText(bytes, name);
  if (!text) return tl::make_unexpected(text.error());
  Document document;
  Result<Json> root = json::parseTelling(*text, name, options.limits, document.diagnostics);
  if (!root) {
    if (text->data() != bytes.data()) {
      for (Diagnostic& one : root.error()) one.message += " (in the GLB's JSON chunk)";
    }
    return tl::make_unexpected(std::move(root.error()));
  }
  Diagnostics fatal;
  Report report(name, fatal);
  checkRoot(*root, report);
  if (hasError(fatal)) return tl::make_unexpected(std::move(fatal));

  document.path = name;
  gltf::readScene(*root, document);
  const materialx::Procedurals procedurals = proceduralsOf(*root, schema, options, document);
  checkSwizzles(procedurals, document);
  const FileFacts facts{name, document, options.permissive, &procedurals};
  Report of_scene(name, document.diagnostics);
  checkExtensions(*root, schema, of_scene);
  if (const Json* materials = json::member(*root, "materials")) {
    const std::map<size_t, AnimatedOf> animated =
        animatedMaterials(document, json::arraySize(*root, "materials"), document.diagnostics);
    document.materials.reserve(materials->size());
    for (size_t i = 0; i < json::arraySize(*root, "materials"); ++i) {
      document.materials.push_back(readMaterial((*materials)[i], i, schema, facts));
      document.materials.back().patterns = procedurals.patterns;
      if (const auto it = animated.find(i); it != animated.end())
        readAnimated(it->second, schema, name, document.materials.back());
    }
  }
  return document;
}

/// Turns what the libraries (or the lack of memory) may throw into an error, so that nothing passes the API.
template <class Read>
Result<Document> guarded(const std::string& name, Read read) {
  try {
    return read();
  } catch (const std::exception& exception) {
    return fail("cannot-read", {name, 0, 0, {}},
                "the file cannot be read: " + printable(exception.what(), 400));
  }
}

constexpr size_t kMostNames = 20;  ///< so many materials are named when the one asked for is not there

/// "'Paint', 'Trim', …"
std::string listed(const std::vector<Material>& materials) {
  std::vector<std::string> names;
  for (size_t i = 0; i < materials.size() && i < kMostNames; ++i)
    names.push_back("'" + printable(materials[i].name) + "'");
  std::string text = fmt::format("there are {}", fmt::join(names, ", "));
  if (materials.size() > kMostNames) text += fmt::format(", … ({} in all)", materials.size());
  return text;
}

}  // namespace

Result<Document> read(const std::string& path, const Schema& schema, const ReadOptions& options) {
  return guarded(path, [&]() -> Result<Document> {
    const Result<std::string> bytes = readFile(path, options.limits.file);
    if (!bytes) return tl::make_unexpected(bytes.error());
    return readDocument(*bytes, path, schema, options);
  });
}

Result<Document> readText(const std::string& bytes, const std::string& name, const Schema& schema,
                          const ReadOptions& options) {
  return guarded(name, [&] { return readDocument(bytes, name, schema, options); });
}

Result<size_t> findMaterial(const Document& document, const std::optional<std::string>& name,
                            Diagnostics& warnings) {
  const std::vector<Material>& materials = document.materials;
  const Place place{document.path, 0, 0, {}};
  std::vector<size_t> found;
  for (size_t i = 0; i < materials.size(); ++i) {
    if (!name || materials[i].name == *name) found.push_back(i);
  }
  if (materials.empty()) return fail("no-such-material", place, "the file has no materials");
  if (found.empty()) {
    return fail("no-such-material", place, fmt::format("no material is named '{}'", printable(*name)),
                listed(materials));
  }
  if (found.size() > 1 && !name) {
    return fail("no-such-material", place, "the file has several materials, and none is named",
                listed(materials));
  }
  if (found.size() > 1) {
    warnings.push_back({"duplicate-name",
                        Severity::Warning,
                        place,
                        fmt::format("{} materials are named '{}': this is /materials/{}", found.size(),
                                    printable(*name), found[0]),
                        {},
                        {}});
  }
  return found[0];
}

bool Material::has(uint16_t extension) const {
  return extension == 0 || std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

const ir::Components* Material::number(uint16_t property) const {
  const auto it =
      std::find_if(numbers.begin(), numbers.end(), [&](const Number& n) { return n.property == property; });
  return it == numbers.end() ? nullptr : &it->value;
}

bool Material::isAnimated(uint16_t property) const {
  return std::binary_search(animated.begin(), animated.end(), property);
}

const gltf::TextureInfo* Material::texture(uint16_t property) const {
  const auto it = std::find_if(textures.begin(), textures.end(),
                               [&](const Texture& t) { return t.property == property; });
  return it == textures.end() ? nullptr : &it->info;
}

}  // namespace lacquer::material
