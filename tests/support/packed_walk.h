// Reads all that is in a packed manifest, for tests of what is in one and of what damage does.
#pragma once

#include <cstring>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "lacquer/packed.h"

namespace lacquer::test {

/// A packed manifest in memory of its own, in which a sanitizer sees a byte read behind the last one.
class PackedFile {
public:
  explicit PackedFile(std::string_view bytes) : memory_(new char[bytes.size()]) {
    std::memcpy(memory_.get(), bytes.data(), bytes.size());
    top = lacquer_packed_open(&file, memory_.get(), bytes.size());
  }

  template <class T>
  std::vector<T> all(lacquer_packed_list list) const {
    std::vector<T> found;
    for (uint32_t i = 0; i < list.count; ++i) {
      const T* one = LACQUER_PACKED_AT(&file, list, T, i);
      if (one == nullptr) break;
      found.push_back(*one);
    }
    return found;
  }
  std::string_view text(lacquer_packed_text text) const { return lacquer_packed_string(&file, text); }
  std::vector<std::string_view> texts(lacquer_packed_list list) const {
    std::vector<std::string_view> found;
    for (const lacquer_packed_text one : all<lacquer_packed_text>(list)) found.push_back(text(one));
    return found;
  }
  std::string_view bytes(lacquer_packed_list list) const {
    const void* at = lacquer_packed_bytes(&file, list);
    return at == nullptr ? std::string_view() : std::string_view(static_cast<const char*>(at), list.count);
  }

  lacquer_packed file{};
  const lacquer_packed_header* top = nullptr;  ///< null for what is no packed manifest

private:
  std::unique_ptr<char[]> memory_;  ///< new aligns it for all types
};

/// Reads every byte that a packed manifest leads to, once at most for each list that names it, and no more
/// than `budget` of them; their sum, or nothing for what is no packed manifest.
class PackedWalk {
public:
  explicit PackedWalk(const PackedFile& of, size_t budget = size_t{1} << 20) : of_(of), budget_(budget) {}

  std::optional<uint64_t> sum() {
    if (of_.top == nullptr) return std::nullopt;
    take(of_.text(of_.top->lacquer));
    each<lacquer_packed_file>(of_.top->files, [&](const auto& one) { file(one); });
    each<lacquer_packed_shader>(of_.top->shaders, [&](const auto& one) { shader(one); });
    return sum_;
  }

private:
  void take(std::string_view bytes) {
    if (bytes.size() > budget_) return;
    budget_ -= bytes.size();
    for (const char c : bytes) sum_ = sum_ * 31 + static_cast<unsigned char>(c);
  }
  void text(lacquer_packed_text text) { take(of_.text(text)); }
  void texts(lacquer_packed_list list) {
    each<lacquer_packed_text>(list, [&](const auto& one) { text(one); });
  }
  template <class T, class Each>
  void each(lacquer_packed_list list, const Each& visit) {
    for (uint32_t i = 0; i < list.count && budget_ > sizeof(T); ++i) {
      const T* one = LACQUER_PACKED_AT(&of_.file, list, T, i);
      if (one == nullptr) return;
      take({reinterpret_cast<const char*>(one), sizeof(T)});
      visit(*one);
    }
  }
  void file(const lacquer_packed_file& of) {
    text(of.source), texts(of.variants);
    each<lacquer_packed_material>(of.materials, [&](const auto& one) {
      text(one.name);
      each<lacquer_packed_use>(one.uses, [&](const auto& use) { this->use(use); });
    });
    each<lacquer_packed_primitive>(of.primitives, [&](const auto& one) {
      each<lacquer_packed_attribute>(one.attributes, [&](const auto& attribute) {
        text(attribute.semantic), text(attribute.type), text(attribute.component_type);
      });
      each<lacquer_packed_list>(one.targets, [&](const auto& target) { texts(target); });
      each<lacquer_packed_variant>(
          one.variants, [&](const auto& variant) { each<uint32_t>(variant.variants, [](uint32_t) {}); });
    });
    each<lacquer_packed_file_texture>(of.textures, [&](const auto& one) {
      each<lacquer_packed_texture_image>(one.images, [&](const auto& image) { text(image.extension); });
    });
    each<lacquer_packed_image>(of.images, [&](const auto& one) { text(one.uri), text(one.mime_type); });
  }
  /// A fallback has none, but in what is damaged.
  void use(const lacquer_packed_use& of, bool own = true) {
    texts(of.attributes), texts(of.stand_in_attributes);
    take(of_.bytes(of.block));
    each<lacquer_packed_use_texture>(of.textures, [&](const auto& one) { text(one.file); });
    each<lacquer_packed_parameter>(of.parameters,
                                   [&](const auto& one) { text(one.name), text(one.pointer); });
    if (own) each<lacquer_packed_use>(of.fallback, [&](const auto& one) { use(one, false); });
  }
  void shader(const lacquer_packed_shader& of) {
    text(of.id), text(of.template_name), text(of.depth), texts(of.displaces);
    each<lacquer_packed_code>(of.codes, [&](const auto& one) {
      text(one.target), text(one.stage);
      take(of_.bytes(one.code));
    });
    each<lacquer_packed_block>(of.blocks, [&](const auto& one) {
      text(one.name), text(one.structure), text(one.list);
      each<lacquer_packed_field>(one.fields, [&](const auto& field) { text(field.name), text(field.type); });
    });
    each<lacquer_packed_texture>(of.textures, [&](const auto& one) {
      text(one.name), text(one.slot), text(one.type), text(one.sampler), text(one.array);
    });
    each<lacquer_packed_input>(of.inputs, [&](const auto& one) { text(one.name), text(one.type); });
    each<lacquer_packed_output>(of.outputs,
                                [&](const auto& one) { text(one.name), text(one.type), texts(one.holds); });
    each<lacquer_packed_spec_constant>(of.spec_constants,
                                       [&](const auto& one) { text(one.name), text(one.type); });
  }

  const PackedFile& of_;
  size_t budget_;
  uint64_t sum_ = 0;
};

}  // namespace lacquer::test
