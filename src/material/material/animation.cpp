// What animations change of materials: the pointers of KHR_animation_pointer, by the schema's properties.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "material/reader.h"
#include "support/text.h"

namespace lacquer::material {

namespace {

constexpr std::string_view kTransformPath = "extensions/KHR_texture_transform/";

Diagnostic problem(const std::string& file, const gltf::AnimatedPointer& pointer, std::string_view code,
                   std::string message, std::string help) {
  return {std::string(code),  Severity::Warning, {file, 0, 0, pointer.place},
          std::move(message), std::move(help),   {}};
}

/// The pointer behind the material with the drafts' names as the extensions' own.
std::string canonical(const Schema& schema, std::string_view tail) {
  std::string out;
  for (size_t at = 0; at <= tail.size();) {
    const size_t end = std::min(tail.find('/', at), tail.size());
    const std::string_view part = tail.substr(at, end - at);
    const std::optional<uint16_t> extension = schema.find(part);
    if (at > 0) out += '/';
    out += extension && *extension != 0 ? schema.extensions[*extension]->name : part;
    at = end + 1;
  }
  return out;
}

class AnimatedReader {
public:
  AnimatedReader(const Schema& schema, const std::string& file, Material& material)
      : schema_(schema), file_(file), material_(material) {}

  void read(std::string_view tail, const gltf::AnimatedPointer& pointer) {
    pointer_ = &pointer;
    const std::string target = canonical(schema_, tail);
    // What applications keep in `extras` is theirs.
    if (target == "extras" || target.starts_with("extras/") || target.find("/extras/") != std::string::npos)
      return;
    for (uint16_t i = 0; i < schema_.properties.size(); ++i) {
      const Property& property = schema_.properties[i];
      if (target == property.path && property.decl->kind != Kind::Texture) return number(i);
      const bool inside = target.size() > property.path.size() && target.starts_with(property.path) &&
                          target[property.path.size()] == '/';
      if (inside && property.decl->kind == Kind::Texture)
        return texture(i, std::string_view(target).substr(property.path.size() + 1));
    }
    unknown(target);
  }

  /// After the last pointer.
  void finish() {
    if (unknown_ <= kMostUnknown) return;
    warn("animation-pointer", fmt::format("{} more pointers aim at no property", unknown_ - kMostUnknown),
         {});
  }

private:
  /// Beyond that a list helps nobody.
  static constexpr size_t kMostUnknown = 16;

  void warn(std::string_view code, std::string message, std::string help) {
    addBounded(material_.diagnostics, problem(file_, *pointer_, code, std::move(message), std::move(help)));
  }

  void unknown(std::string_view target) {
    if (unknown_++ >= kMostUnknown) return;
    std::vector<std::string_view> known;
    for (const Property& property : schema_.properties) {
      if (property.decl->kind == Kind::Number) known.push_back(property.path);
    }
    const bool ignored =
        std::any_of(material_.ignored.begin(), material_.ignored.end(), [&](const std::string& extension) {
          return std::string_view(pointer_->target).starts_with(extension + "/");
        });
    const std::string_view meant = closest(target, known);
    warn("animation-pointer",
         fmt::format("{} is no property that an animation can change", quote(pointer_->target)),
         ignored         ? "Lacquer does not implement its extension"
         : meant.empty() ? "a factor, a texture's scale or strength, or one of its KHR_texture_transform is"
                         : fmt::format("did you mean {}?", quote(meant)));
  }

  /// Whether the material has the property's extension; if not, that is said.
  bool there(const Property& property) {
    if (material_.has(property.extension)) return true;
    const std::string_view name = schema_.extensions[property.extension]->name;
    warn("animation-pointer", fmt::format("the animation of {} has no effect", property.decl->name),
         fmt::format("the material has no {}, or another extension stands in its place", name));
    return false;
  }

  void number(uint16_t index) {
    const Property& property = schema_.properties[index];
    if (!there(property)) return;
    if (property.decl->kind != Kind::Number) {
      return warn("animation-pointer",
                  fmt::format("{} decides which shader there is and cannot be animated", property.decl->name),
                  "make a material for each value");
    }
    const ir::Components* given = material_.number(index);
    const ir::Components now =
        given != nullptr ? *given : property.decl->default_value.value_or(ir::Components{});
    if (given == nullptr && !property.decl->default_value) {
      return warn("animation-pointer", fmt::format("the animation of {} has no effect", property.decl->name),
                  "the material does not say what it is, and it has no default");
    }
    // KHR_materials_ior: "Setting IOR to zero permanently switches the material into a special […] mode".
    if (property.decl->range.gap > 0 && now[0] == 0) {
      return warn(
          "animation-ignored",
          fmt::format("{} is 0, a mode of its own for good: its animation is ignored", property.decl->name),
          fmt::format("begin at {} or above", property.decl->range.gap));
    }
    const auto at = std::lower_bound(material_.animated.begin(), material_.animated.end(), index);
    if (at == material_.animated.end() || *at != index) material_.animated.insert(at, index);
  }

  void texture(uint16_t index, std::string_view tail) {
    const Property& property = schema_.properties[index];
    if (!there(property)) return;
    const auto found = std::find_if(material_.textures.begin(), material_.textures.end(),
                                    [&](const Material::Texture& t) { return t.property == index; });
    if (found == material_.textures.end()) {
      return warn("animation-pointer", fmt::format("the animation of {} has no effect", property.decl->name),
                  "the material has no such texture");
    }
    if (!member(found->info, *property.decl, tail)) unknown(tail);
  }

  bool member(gltf::TextureInfo& info, const lang::PropertyDecl& decl, std::string_view tail) {
    gltf::TextureInfo::Animated& animated = info.animated;
    for (size_t i = 0; i < decl.members.size(); ++i) {
      if (decl.members[i].name != tail) continue;
      if (std::find(animated.members.begin(), animated.members.end(), i) == animated.members.end())
        animated.members.push_back(i);
      return true;
    }
    if (!tail.starts_with(kTransformPath)) return false;
    tail.remove_prefix(kTransformPath.size());
    bool* const to = tail == "offset"     ? &animated.offset
                     : tail == "rotation" ? &animated.rotation
                     : tail == "scale"    ? &animated.scale
                                          : nullptr;
    if (to == nullptr) return false;
    *to = info.transform.has_value();
    if (!*to) {
      warn("animation-pointer", fmt::format("the animation of {}'s transform has no effect", decl.name),
           "give the texture a KHR_texture_transform, which may be empty");
    }
    return true;
  }

  const Schema& schema_;
  const std::string& file_;
  Material& material_;
  const gltf::AnimatedPointer* pointer_ = nullptr;
  size_t unknown_ = 0;
};

}  // namespace

std::map<size_t, AnimatedOf> animatedMaterials(const gltf::Scene& scene, size_t materials,
                                               Diagnostics& diagnostics) {
  constexpr std::string_view kMaterials = "/materials/";
  std::map<size_t, AnimatedOf> out;
  for (const gltf::AnimatedPointer& pointer : scene.animated) {
    const std::string_view target = pointer.target;
    if (!target.starts_with(kMaterials)) continue;
    const std::string_view rest = target.substr(kMaterials.size());
    const std::string_view digits = rest.substr(0, rest.find('/'));
    size_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    const bool whole = error == std::errc() && end == digits.data() + digits.size() &&
                       (digits == "0" || !digits.starts_with('0'));
    if (!whole || index >= materials || digits.size() == rest.size()) {
      addBounded(diagnostics, problem(scene.path, pointer, "animation-pointer",
                                      fmt::format("{} leads nowhere", quote(target)),
                                      fmt::format("the file has {}", countOf(materials, "material"))));
      continue;
    }
    out[index].emplace_back(rest.substr(digits.size() + 1), &pointer);
  }
  return out;
}

void readAnimated(const AnimatedOf& pointers, const Schema& schema, const std::string& file,
                  Material& material) {
  AnimatedReader reader(schema, file, material);
  for (const auto& [tail, pointer] : pointers) reader.read(tail, *pointer);
  reader.finish();
}

}  // namespace lacquer::material
