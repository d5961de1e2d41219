#include "manifest/entries.h"

#include <algorithm>

#include "manifest/manifest.h"
#include "setting/attributes.h"
#include "shader/print.h"

namespace lacquer {

namespace {

constexpr std::string_view kPasses[] = {"opaque", "masked", "looks_through", "blended"};
constexpr std::string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr std::string_view kFactors[] = {"zero", "one", "src-alpha", "one-minus-src-alpha"};
constexpr std::string_view kWraps[] = {"repeat", "clamp", "mirror"};
constexpr std::string_view kFilters[] = {"",
                                         "nearest",
                                         "linear",
                                         "nearest-mipmap-nearest",
                                         "linear-mipmap-nearest",
                                         "nearest-mipmap-linear",
                                         "linear-mipmap-linear"};

template <class Enum, size_t N>
std::string_view wordOf(Enum value, const std::string_view (&words)[N]) {
  const auto place = static_cast<size_t>(value);
  return place < N ? words[place] : std::string_view();
}

template <class List, class Write>
void writeAll(std::string_view name, const List& list, JsonText& json, Write write) {
  if (list.empty()) return;
  json.key(name).beginArray();
  for (const auto& one : list) write(one);
  json.endArray();
}

void writeSkipped(const std::vector<std::pair<std::string, std::string>>& skipped, JsonText& json) {
  json.beginObject();
  for (size_t i = 0; i < skipped.size(); ++i) {
    // A term that several uses skip is named once, with the last reason.
    const auto same = [&](const auto& other) { return other.first == skipped[i].first; };
    if (std::any_of(skipped.begin(), skipped.begin() + static_cast<ptrdiff_t>(i), same)) continue;
    const auto last = std::find_if(skipped.rbegin(), skipped.rend(), same);
    json.key(skipped[i].first).string(last->second);
  }
  json.endObject();
}

void writeState(const DrawState& state, JsonText& json) {
  json.key("alpha_mode").string(wordOf(state.alpha_mode, kAlphaModes));
  if (state.alpha_mode == AlphaMode::Mask) json.key("alpha_cutoff").number(state.alpha_cutoff);
  json.key("pass").string(passName(state.pass));
  json.key("depth_write").boolean(state.depth_write);
  if (state.blend) writeBlend(*state.blend, json.key("blend"));
  json.key("double_sided").boolean(state.double_sided);
}

void writeSampler(const TextureSampler& sampler, JsonText& json) {
  json.key("sampler").beginObject();
  json.key("wrap_s").string(wordOf(sampler.wrap_s, kWraps));
  json.key("wrap_t").string(wordOf(sampler.wrap_t, kWraps));
  if (sampler.mag_filter != Filter::Open) json.key("mag_filter").string(wordOf(sampler.mag_filter, kFilters));
  if (sampler.min_filter != Filter::Open) json.key("min_filter").string(wordOf(sampler.min_filter, kFilters));
  json.endObject();
}

void writeTextureOfUse(const UsedTexture& texture, JsonText& json) {
  json.key(texture.slot).beginObject().key("texture").integer(texture.texture);
  json.key("pointer").string(texture.pointer);
  if (!texture.file.empty()) {
    json.key("file").string(texture.file);
    writeSampler(texture.sampler, json);
  }
  if (texture.color) json.key("default").numbers(*texture.color);
  if (texture.texcoord) json.key("texcoord").integer(*texture.texcoord);
  if (texture.transform) {
    const TextureTransform& t = *texture.transform;
    json.key("transform").beginObject();
    json.key("offset").numbers(t.offset);
    json.key("rotation").number(t.rotation);
    json.key("scale").numbers(t.scale).endObject();
  }
  if (texture.stand_in) {
    json.key("stand_in").beginObject().key("texel").numbers(*texture.stand_in);
    json.key("color_space").string(texture.srgb ? "srgb" : "linear").endObject();
  }
  json.endObject();
}

void writeChosen(int material, const std::optional<size_t>& use, JsonText& json) {
  json.key("material").integer(material);
  if (use) json.key("use").integer(static_cast<int64_t>(*use));
}

void writePrimitive(const ContractPrimitive& primitive, JsonText& json) {
  json.beginObject().key("mesh").integer(static_cast<int64_t>(primitive.mesh));
  json.key("primitive").integer(static_cast<int64_t>(primitive.primitive));
  writeChosen(primitive.material, primitive.use, json);
  json.key("attributes").beginObject();
  for (const StoredAttribute& stored : primitive.attributes) {
    json.key(stored.semantic).beginObject();
    if (!stored.type.empty()) json.key("type").string(stored.type);
    if (!stored.component_type.empty()) json.key("component_type").string(stored.component_type);
    if (stored.normalized) json.key("normalized").boolean(true);
    json.endObject();
  }
  json.endObject();
  writeAll("targets", primitive.targets, json, [&](const Strings& target) { writeList(target, json); });
  writeAll("variants", primitive.variants, json, [&](const VariantUse& variant) {
    json.beginObject().key("variants").beginArray();
    for (const size_t one : variant.variants) json.integer(static_cast<int64_t>(one));
    json.endArray();
    writeChosen(variant.material, variant.use, json);
    json.endObject();
  });
  json.endObject();
}

void writeTexture(const ContractTexture& texture, JsonText& json) {
  json.beginObject().key("images").beginArray();
  for (const TextureImage& image : texture.images) {
    json.beginObject().key("image").integer(static_cast<int64_t>(image.image));
    if (!image.extension.empty()) json.key("extension").string(image.extension);
    json.endObject();
  }
  json.endArray();
  writeSampler(texture.sampler, json);
  json.endObject();
}

void writeImage(const ContractImage& image, JsonText& json) {
  json.beginObject();
  if (!image.uri.empty())
    json.key("uri").string(image.uri);
  else if (image.data_uri)
    json.key("data_uri").boolean(true);
  else
    json.key("buffer_view").integer(image.buffer_view);
  if (!image.mime_type.empty()) json.key("mime_type").string(image.mime_type);
  json.endObject();
}

void writeDiagnostics(const Diagnostics& diagnostics, JsonText& json) {
  json.key("diagnostics").beginArray();
  for (const Diagnostic& d : diagnostics) json.json(diagnosticJson(d));
  json.endArray();
}

}  // namespace

std::string_view passName(Pass pass) { return wordOf(pass, kPasses); }

void writeBlend(const Blend& blend, JsonText& json) {
  const auto factors = [&](std::string_view name, BlendFactor source, BlendFactor destination) {
    json.key(name).beginArray().string(wordOf(source, kFactors));
    json.string(wordOf(destination, kFactors)).endArray();
  };
  json.beginObject();
  factors("color", blend.source_color, blend.destination_color);
  factors("alpha", blend.source_alpha, blend.destination_alpha);
  json.endObject();
}

void writeList(const std::vector<std::string>& names, JsonText& json) {
  json.beginArray();
  for (const std::string& name : names) json.string(name);
  json.endArray();
}

StructureTexts textsOf(const MaterialTerms& terms, const StructureFacts& facts) {
  constexpr size_t kMember = kMaterialDepth + 1, kUseMember = kMaterialDepth + 3;
  JsonText list(kMember), skipped(kMember), absent(kUseMember), unfilled(kUseMember);
  writeList(terms.terms, list);
  writeSkipped(terms.skipped, skipped);
  absent.beginObject();
  for (const auto& [name, names] : facts.absent_parameters) {
    absent.key(name);
    writeList(names, absent);
  }
  absent.endObject();
  writeList(facts.unfilled_ports, unfilled);
  return {list.take(), skipped.take(), absent.take(), unfilled.take()};
}

static void writeUse(const ContractUse& use, const UseEntry& entry, JsonText& json) {
  json.beginObject().key("attributes");
  writeList(fromPublic(use.attributes).names(), json);
  json.key("shader").string(entry.shader).key("parameters").beginObject();
  for (const UsedParameter& p : use.parameters) {
    json.key(p.name).beginObject().key("value").numbers(p.value).key("pointer").string(p.pointer);
    if (p.animated) json.key("animated").boolean(true);
    if (p.stand_in) json.key("stand_in").boolean(true);
    json.endObject();
  }
  json.endObject().key("uniforms").beginObject();
  for (const auto& [name, value] : use.uniforms) json.key(name).numbers(value);
  json.endObject().key("textures").beginObject();
  for (const UsedTexture& texture : use.textures) writeTextureOfUse(texture, json);
  json.endObject();
  if (use.shares_program) {
    json.key("stand_in_attributes");
    writeList(use.stand_in_attributes, json);
  }
  StructureTexts own;
  if (entry.texts == nullptr) own = textsOf({}, *use.facts);
  const StructureTexts& of = entry.texts == nullptr ? own : *entry.texts;
  json.key("absent_parameters").raw(of.absent).key("unfilled_ports").raw(of.unfilled).endObject();
}

std::string materialText(const ContractMaterial& material, const std::vector<UseEntry>& uses,
                         const std::string* profile, const StructureTexts* texts,
                         const Diagnostics& diagnostics) {
  JsonText json(kMaterialDepth);
  json.beginObject().key("index").integer(material.index).key("name").string(material.name);
  if (profile != nullptr) {
    json.key("profile").string(*profile);
    writeState(material.state, json);
    if (!material.extensions.empty()) {
      json.key("extensions").beginObject();
      for (const auto& [name, status] : material.extensions) json.key(name).string(status);
      json.endObject();
    }
  }
  json.key("uses").beginArray();
  for (size_t i = 0; i < material.uses.size(); ++i) writeUse(material.uses[i], uses.at(i), json);
  json.endArray();
  StructureTexts own;
  if (texts == nullptr) own = textsOf(*material.terms, {});
  const StructureTexts& of = texts == nullptr ? own : *texts;
  json.key("terms").raw(of.terms).key("skipped").raw(of.skipped);
  json.key("ignored");
  writeList(material.ignored, json);
  writeDiagnostics(diagnostics, json);
  return json.endObject().take();
}

void writeCode(const std::string& id, bool has_vertex, const std::vector<std::pair<Target, bool>>& validated,
               JsonText& json) {
  json.key("files").beginObject();
  for (const auto& [target, good] : validated) {
    json.key(targetName(target)).beginObject();
    for (int stage = firstStage(target, has_vertex); stage < 2; ++stage)
      json.key(fileKind(target, stage)).string(shaderPath(target, id, stage));
    json.endObject();
  }
  json.endObject().key("validated").beginObject();
  for (const auto& [target, good] : validated) {
    if (isShader(target)) json.key(targetName(target)).boolean(good);
  }
  json.endObject();
}

void beginFile(const std::string& source, JsonText& json) {
  json.beginObject().key("source").string(source).key("materials").beginArray();
}

void endFile(const FileEntry& file, JsonText& json) {
  json.endArray();
  // It lies one level higher than those in the list.
  if (!file.default_material.empty()) json.key("default_material").json(json::reread(file.default_material));
  writeAll("variants", file.variants, json, [&](const std::string& name) { json.string(name); });
  writeAll("primitives", file.primitives, json,
           [&](const ContractPrimitive& primitive) { writePrimitive(primitive, json); });
  writeAll("textures", file.textures, json,
           [&](const ContractTexture& texture) { writeTexture(texture, json); });
  writeAll("images", file.images, json, [&](const ContractImage& image) { writeImage(image, json); });
  writeDiagnostics(file.diagnostics, json);
  json.endObject();
}

}  // namespace lacquer
