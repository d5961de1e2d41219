// What animations change beside nodes: the pointers of KHR_animation_pointer.
#include <algorithm>

#include "gltf/reading.h"
#include "support/text.h"

namespace lacquer::gltf {

namespace {

constexpr std::string_view kPointer = "KHR_animation_pointer";

/// RFC 6901: every part behind a slash, and no tilde but in ~0 and ~1.
bool isPointer(std::string_view text) {
  if (!text.starts_with('/')) return false;
  for (size_t at = text.find('~'); at != std::string_view::npos; at = text.find('~', at + 1)) {
    if (at + 1 >= text.size() || (text[at + 1] != '0' && text[at + 1] != '1')) return false;
  }
  return true;
}

void readTarget(Reading& reading, const Json& target, const Path& path) {
  constexpr std::string_view kCode = "animation-pointer";
  const Json* way = member(target, "path");
  const bool by_pointer = way != nullptr && *way == "pointer";
  const Json* extension = extensionOf(target, kPointer);
  if (extension == nullptr) {
    if (by_pointer) {
      reading.report.warning(kCode, path, "the target's path is \"pointer\", but it has no pointer",
                             fmt::format("give it the extension {}", kPointer));
    }
    return;
  }
  const Path extensions(path, "extensions");
  const Path inside(extensions, kPointer);
  const Path here(inside, "pointer");
  const Json* pointer = member(*extension, "pointer");
  if (!by_pointer) {
    return reading.report.warning(kCode, Path(path, "path"),
                                  "the target has a pointer, but its path is not \"pointer\"",
                                  "the pointer is ignored");
  }
  if (pointer == nullptr || !pointer->is_string() || !isPointer(json::text(*pointer))) {
    return reading.report.warning(kCode, here, "the animation's target is no JSON pointer",
                                  "write it as \"/materials/0/emissiveFactor\"");
  }
  const auto& text = json::text(*pointer);
  const std::string_view root = std::string_view(text).substr(1, text.find('/', 1) - 1);
  if (member(reading.root, root) == nullptr) {
    return reading.report.warning(kCode, here, fmt::format("{} leads nowhere", quote(text)),
                                  fmt::format("the file has no {}", quote(root)));
  }
  if (reading.said.insert(text).second) reading.scene.animated.push_back({text, here.text()});
}

}  // namespace

void readAnimations(Reading& reading, const Json& animations, const Path& path) {
  if (!animations.is_array()) return;
  for (size_t i = 0; i < animations.size(); ++i) {
    const Json* channels = member(animations[i], "channels");
    if (channels == nullptr || !channels->is_array()) continue;
    const Path animation(path, i);
    const Path list(animation, "channels");
    for (size_t k = 0; k < channels->size(); ++k) {
      const Json* target = member((*channels)[k], "target");
      const Path channel(list, k);
      if (target != nullptr && target->is_object()) readTarget(reading, *target, Path(channel, "target"));
    }
  }
}

}  // namespace lacquer::gltf
