// Materials as files of other tools.
#include "lacquer/exchange.h"
#include "c/handles.h"
#include "json/text.h"

using namespace lacquer::c;
using lacquer::Messages;

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
  });
}
