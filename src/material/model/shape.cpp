#include "model/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "model/thresholds.h"

namespace lacquer::model {

using material::Kind;
using material::Material;

namespace {

template <class T>
void addBytes(const T& value, std::string& key) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  key.append(bytes, sizeof value);
}

void addSize(size_t size, std::string& key) { addBytes(static_cast<uint32_t>(size), key); }

constexpr std::array<double, 5> kIdentity{0, 0, 0, 1, 1};

/// The numbers of the coordinate's transform.
std::array<double, 5> transformOf(const gltf::TextureInfo& info) {
  const gltf::TextureTransform t = info.transform.value_or(gltf::TextureTransform{});
  return {t.offset[0], t.offset[1], t.rotation, t.scale[0], t.scale[1]};
}

/// Whether two textures have one coordinate, bit by bit: an animated one is like no other.
bool sameCoordinate(const gltf::TextureInfo& a, const gltf::TextureInfo& b) {
  const std::array<double, 5> x = transformOf(a), y = transformOf(b);
  const bool alone = &a != &b && (a.animated.transform() || b.animated.transform());
  return !alone && a.texCoord == b.texCoord && std::memcmp(x.data(), y.data(), sizeof x) == 0;
}

}  // namespace

Shapes::Shapes(const Model& model) {
  for (const material::Property& property : model.schema->properties) {
    numbers_.push_back(comparedOf(*property.decl));
    std::vector<Compared>& members = members_.emplace_back();
    for (const lang::PropertyDecl& member : property.decl->members) members.push_back(comparedOf(member));
  }
  for (const Threshold& threshold : thresholds(model)) {
    Compared& compared = threshold.member < 0
                             ? numbers_[threshold.property]
                             : members_[threshold.property][static_cast<size_t>(threshold.member)];
    compared.special.push_back(threshold.at);
  }
}

Shapes::Compared Shapes::comparedOf(const lang::PropertyDecl& decl) const {
  Compared compared;
  compared.raw = decl.kind == Kind::Bool || decl.kind == Kind::Choice;
  compared.components = static_cast<size_t>(std::max(1, ir::componentCount(decl.type)));
  compared.special.push_back(decl.default_value.value_or(ir::Components{}));
  if (decl.neutral) compared.special.push_back(*decl.neutral);
  return compared;
}

/// The place of the special number that a value is, and its bytes where they are others: -0.
void Shapes::add(const Compared& compared, const ir::Components& value, std::string& key) {
  constexpr char kOther = '\xff';
  const size_t bytes = compared.components * sizeof value[0];
  if (compared.raw) {
    key.append(reinterpret_cast<const char*>(value.data()), bytes);
    return;
  }
  const auto it = std::find_if(compared.special.begin(), compared.special.end(), [&](const auto& special) {
    return std::equal(special.begin(), special.begin() + static_cast<ptrdiff_t>(compared.components),
                      value.begin());
  });
  if (it == compared.special.end()) {
    key += kOther;
    return;
  }
  key += static_cast<char>(it - compared.special.begin());
  const bool same = std::memcmp(it->data(), value.data(), bytes) == 0;
  key += same ? '=' : '~';
  if (!same) key.append(reinterpret_cast<const char*>(value.data()), bytes);
}

std::string Shapes::keyOf(const Material& material, const gltf::VertexAttributes& attributes) const {
  std::string key;
  key.reserve(256);
  uint32_t bits = 0;
  const auto bit = [&](bool set) { bits = bits << 1 | (set ? 1U : 0U); };
  for (const bool set : {attributes.normal, attributes.tangent, attributes.color0, attributes.morph,
                         attributes.instances, attributes.quantized})
    bit(set);
  for (const bool set : attributes.texCoord) bit(set);
  for (const bool set : attributes.skin) bit(set);
  addBytes(bits, key);
  addSize(attributes.application.size(), key);
  for (const std::string& name : attributes.application) {
    addSize(name.size(), key);
    key += name;
  }
  addSize(material.extensions.size(), key);
  for (const uint16_t extension : material.extensions) addBytes(extension, key);
  addSize(material.animated.size(), key);
  for (const uint16_t property : material.animated) addBytes(property, key);
  addSize(material.numbers.size(), key);
  for (const Material::Number& number : material.numbers) {
    addBytes(number.property, key);
    add(numbers_[number.property], number.value, key);
  }
  addSize(material.textures.size(), key);
  for (const Material::Texture& texture : material.textures) {
    const gltf::TextureInfo& info = texture.info;
    addBytes(texture.property, key);
    addSize(static_cast<size_t>(info.texCoord), key);
    for (const int channel : info.channels) key += static_cast<char>(channel);
    const auto first = [&](const auto& same) {
      return std::find_if(material.textures.begin(), material.textures.end(), same) -
             material.textures.begin();
    };
    addSize(static_cast<size_t>(first([&](const auto& one) { return one.info.texture == info.texture; })),
            key);
    addSize(static_cast<size_t>(first([&](const auto& one) { return sameCoordinate(one.info, info); })), key);
    const std::array<double, 5> transform = transformOf(info);
    bits = 0;
    for (size_t i = 0; i < transform.size(); ++i) bit(transform[i] == kIdentity[i]);
    for (const bool set : {info.animated.offset, info.animated.rotation, info.animated.scale}) bit(set);
    addBytes(bits, key);
    addSize(info.animated.members.size(), key);
    for (const size_t member : info.animated.members) addSize(member, key);
    for (size_t i = 0; i < info.members.size(); ++i)
      add(members_[texture.property][i], {info.members[i]}, key);
  }
  return key;
}

ir::Components valueOf(const Origin& origin, const Material& material, const ir::Components& otherwise) {
  if (origin.kind == Origin::Kind::Number) {
    const ir::Components* number = material.number(origin.property);
    return number == nullptr ? otherwise : *number;
  }
  const gltf::TextureInfo& info = *material.texture(origin.property);
  const gltf::TextureTransform t = info.transform.value_or(gltf::TextureTransform{});
  switch (origin.kind) {
    case Origin::Kind::Number: break;
    case Origin::Kind::Member: return {info.members[static_cast<size_t>(origin.member)]};
    case Origin::Kind::Offset: return {t.offset[0], t.offset[1]};
    case Origin::Kind::Rotation: return {t.rotation};
    case Origin::Kind::Scale: return {t.scale[0], t.scale[1]};
  }
  return otherwise;
}

std::string pointerOf(const Origin& origin, const Material& material, const material::Schema& schema) {
  const material::Property& property = schema.properties[origin.property];
  if (origin.kind == Origin::Kind::Number)
    return fmt::format("/materials/{}/{}", material.index, property.path);
  const std::string& pointer = material.texture(origin.property)->pointer;
  switch (origin.kind) {
    case Origin::Kind::Number: break;
    case Origin::Kind::Member:
      return fmt::format("{}/{}", pointer, property.decl->members[static_cast<size_t>(origin.member)].name);
    case Origin::Kind::Offset: return pointer + "/extensions/KHR_texture_transform/offset";
    case Origin::Kind::Rotation: return pointer + "/extensions/KHR_texture_transform/rotation";
    case Origin::Kind::Scale: return pointer + "/extensions/KHR_texture_transform/scale";
  }
  return {};
}

}  // namespace lacquer::model
