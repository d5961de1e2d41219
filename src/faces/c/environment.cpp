// Image-based light from a picture, in memory.
#include "c/handles.h"
#include "c/rows.h"
#include "setting/messages.h"

using namespace lacquer::c;
using lacquer::Environment;
using lacquer::Messages;
using lacquer::json::Json;

struct lacquer_environment {
  lacquer::EnvironmentFiles of;
};

static constexpr Row<Environment> kEnvironmentRows[] = {
    {"size", "a whole number",
     [](const Json& value, Environment& to) { return wholeNumber(value, to.size); }},
    {"samples", "a whole number",
     [](const Json& value, Environment& to) { return wholeNumber(value, to.samples); }},
    {"scene", "a whole number",
     [](const Json& value, Environment& to) {
       uint32_t scene = 0;
       const bool good = wholeNumber(value, scene) && scene < 0x80000000U;
       if (good) to.scene = static_cast<int>(scene);
       return good;
     }},
    {"dds", kTruth, [](const Json& value, Environment& to) { return truth(value, to.dds); }},
    {"shared_exponents", kTruth,
     [](const Json& value, Environment& to) { return truth(value, to.shared_exponents); }},
    {"draft", kTruth, [](const Json& value, Environment& to) { return truth(value, to.draft); }},
};

lacquer_environment* lacquer_environment_filter(const char* picture, size_t size, const char* name,
                                                const char* how, const lacquer_options* options,
                                                lacquer_messages* messages) {
  return guarded(
      messages, static_cast<lacquer_environment*>(nullptr), [&](Messages& to) -> lacquer_environment* {
        Environment wanted;
        if (const auto read = readRows(textOf(how), "environment", kEnvironmentRows, wanted); !read)
          return lacquer::report(read.error(), {}, to), nullptr;
        std::optional<lacquer::EnvironmentFiles> files = lacquer::filterEnvironment(
            wanted, std::string(bytesOf(picture, size)), textOf(name), optionsOf(options).options, to);
        return files ? new lacquer_environment{std::move(*files)} : nullptr;
      });
}

void lacquer_environment_free(lacquer_environment* environment) { delete environment; }

const char* lacquer_environment_description(const lacquer_environment* environment, size_t* size) {
  static const std::string kNone;
  return give(environment == nullptr ? kNone : environment->of.description, size);
}

const char* lacquer_environment_file(const lacquer_environment* environment, const char* slot, size_t* size) {
  if (size != nullptr) *size = 0;
  if (environment == nullptr || slot == nullptr) return nullptr;
  const auto& textures = environment->of.maps.textures;
  for (size_t i = 0; i < textures.size(); ++i) {
    if (textures[i].slot == slot) return give(environment->of.files[i], size);
  }
  return nullptr;
}
