// Materials as files of other tools.
#include "lacquer/exchange.h"
#include "c/handles.h"
#include "c/rows.h"
#include "json/text.h"
#include "setting/messages.h"

using namespace lacquer::c;
using lacquer::Messages;
using lacquer::json::Json;

namespace {

bool alsoOf(const Json& value, lacquer::Bake& to) {
  lacquer::Strings forms;
  if (!readStrings(value, forms)) return false;
  to.also.clear();
  for (const std::string& form : forms) {
    if (form != "ktx2" && form != "exr") return false;
    to.also.push_back(form == "exr" ? lacquer::Texels::Exr : lacquer::Texels::Ktx2);
  }
  return true;
}

constexpr Row<lacquer::Bake> kBakeRows[] = {
    {"size", "a whole number",
     [](const Json& value, lacquer::Bake& to) { return wholeNumber(value, to.size); }},
    {"samples", "a whole number",
     [](const Json& value, lacquer::Bake& to) { return wholeNumber(value, to.samples); }},
    {"nodes", kTexts, [](const Json& value, lacquer::Bake& to) { return readStrings(value, to.nodes); }},
    {"also", "an array of \"ktx2\" and \"exr\"", alsoOf},
    {"bits", "a whole number",
     [](const Json& value, lacquer::Bake& to) { return wholeNumber(value, to.bits); }},
    {"levels", kTruth, [](const Json& value, lacquer::Bake& to) { return truth(value, to.levels); }},
    {"srgb", kTruth, [](const Json& value, lacquer::Bake& to) { return truth(value, to.srgb); }},
};

constexpr Row<lacquer::Conversion> kConversionRows[] = {
    {"surface", "a string",
     [](const Json& value, lacquer::Conversion& to) { return anyText(value, to.surface); }},
    {"measured", kTruth,
     [](const Json& value, lacquer::Conversion& to) { return truth(value, to.measured); }},
    {"picture", "a string",
     [](const Json& value, lacquer::Conversion& to) { return anyText(value, to.picture); }},
    {"size", "a whole number",
     [](const Json& value, lacquer::Conversion& to) { return wholeNumber(value, to.size); }},
};

lacquer_text* bakedText(const lacquer::Bake& how, const char* file, const char* const* materials,
                        size_t count, const lacquer_options* options, Messages& to) {
  const std::optional<lacquer::Baked> baked =
      lacquer::bake(how, textOf(file), stringsOf(materials, count), optionsOf(options).options, to);
  if (!baked) return nullptr;
  lacquer::json::JsonText json;
  json.beginObject();
  json.key("output").string(baked->output);
  json.key("images").beginArray();
  for (const std::string& image : baked->images) json.string(image);
  json.endArray();
  json.key("textures").integer(baked->textures);
  json.endObject();
  return textFrom(json.take());
}

}  // namespace

lacquer_text* lacquer_materialx(const char* file, const char* const* materials, size_t count,
                                const char* surface, const lacquer_options* options,
                                lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) -> lacquer_text* {
    const std::string text = lacquer::toMaterialX(textOf(file), stringsOf(materials, count), textOf(surface),
                                                  optionsOf(options).options, to);
    return text.empty() ? nullptr : textFrom(text);
  });
}

int lacquer_convert(const char* output, const char* file, const char* const* materials, size_t count,
                    const char* surface, const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, 0, [&](Messages& to) {
    const bool written = lacquer::writeMaterialX(textOf(output), textOf(file), stringsOf(materials, count),
                                                 textOf(surface), optionsOf(options).options, to);
    return written ? 1 : 0;
  });
}

lacquer_text* lacquer_bake(const char* output, const char* file, const char* const* materials, size_t count,
                           uint32_t size, const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) -> lacquer_text* {
    lacquer::Bake how;
    how.output = textOf(output);
    how.size = size;
    return bakedText(how, file, materials, count, options, to);
  });
}

lacquer_text* lacquer_bake_as(const char* output, const char* file, const char* const* materials,
                              size_t count, const char* how, const lacquer_options* options,
                              lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) -> lacquer_text* {
    lacquer::Bake bake;
    bake.output = textOf(output);
    if (const auto read = readRows(textOf(how), "bake", kBakeRows, bake); !read)
      return lacquer::report(read.error(), {}, to), nullptr;
    return bakedText(bake, file, materials, count, options, to);
  });
}

lacquer_text* lacquer_convert_as(const char* output, const char* file, const char* const* materials,
                                 size_t count, const char* how, const lacquer_options* options,
                                 lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) -> lacquer_text* {
    lacquer::Conversion conversion;
    conversion.output = textOf(output);
    if (const auto read = readRows(textOf(how), "convert", kConversionRows, conversion); !read)
      return lacquer::report(read.error(), {}, to), nullptr;
    const std::optional<lacquer::Converted> converted = lacquer::convert(
        conversion, textOf(file), stringsOf(materials, count), optionsOf(options).options, to);
    if (!converted) return nullptr;
    lacquer::json::JsonText json;
    json.beginObject().key("output").string(converted->output).key("picture").string(converted->picture);
    json.key("differences").beginArray();
    for (const lacquer::PreviewDifference& one : converted->differences) {
      json.beginObject().key("material").string(one.material).key("largest").number(one.largest);
      json.key("mean").number(one.mean).key("root_mean_square").number(one.root_mean_square).endObject();
    }
    json.endArray().endObject();
    return textFrom(json.take());
  });
}

lacquer_text* lacquer_gltf(const char* file, const char* const* materials, size_t count, uint32_t size,
                           const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) {
    return textFrom(
        lacquer::toGltf(textOf(file), stringsOf(materials, count), size, optionsOf(options).options, to));
  });
}
