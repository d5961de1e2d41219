#include "gltf/table.h"

namespace lacquer::gltf {

namespace {

template <class Extensions>
void findPlace(const Extensions& extensions, std::string_view where, std::string_view name,
               ExtensionPlace& out) {
  const auto visit = [&](const ExtensionFacts& facts) {
    if (name == facts.name || (!facts.draft.empty() && name == facts.draft)) out = {where, facts.name};
  };
  std::apply([&](const auto&... row) { (visit(row.facts), ...); }, extensions);
}

template <class S>
void addRows(std::vector<TableRow>& out, std::string_view object, std::span<const Property<S>> rows) {
  for (const Property<S>& row : rows) {
    if (row.facts.kind == Kind::Object) {
      addRows(out, row.facts.name, row.nested);
    } else {
      out.push_back({object, row.facts});
    }
  }
}

template <class Extensions>
void addExtensions(std::vector<TableRow>& out, const Extensions& extensions) {
  std::apply([&](const auto&... row) { (addRows(out, row.facts.name, row.properties), ...); }, extensions);
}

}  // namespace

ExtensionPlace placeOf(std::string_view name) {
  ExtensionPlace place;
  findPlace(kMaterialExtensions, "the material's extensions", name, place);
  findPlace(kClearcoatExtensions, "KHR_materials_clearcoat.extensions", name, place);
  findPlace(kTextureInfoExtensions, "a textureInfo's extensions", name, place);
  return place;
}

std::span<const Property<TextureInfo>> textureInfoRows(Kind kind) {
  if (kind == Kind::NormalTexture) return kNormalTextureInfo;
  if (kind == Kind::OcclusionTexture) return kOcclusionTextureInfo;
  return kTextureInfo;
}

size_t elementCount(Kind kind) {
  switch (kind) {
    case Kind::Number: return 1;
    case Kind::Vec2: return 2;
    case Kind::Color3: return 3;
    case Kind::Color4: return 4;
    case Kind::Boolean:
    case Kind::String:
    case Kind::AlphaMode:
    case Kind::TextureIndex:
    case Kind::TexCoord:
    case Kind::Texture:
    case Kind::NormalTexture:
    case Kind::OcclusionTexture:
    case Kind::Object: return 0;
  }
  return 0;
}

std::vector<TableRow> tableRows() {
  std::vector<TableRow> rows;
  addRows<Material>(rows, "material", kMaterial);
  addRows<TextureInfo>(rows, "textureInfo", kTextureInfo);
  addRows<TextureInfo>(rows, "normalTextureInfo", kNormalTextureInfo);
  addRows<TextureInfo>(rows, "occlusionTextureInfo", kOcclusionTextureInfo);
  addExtensions(rows, kMaterialExtensions);
  addExtensions(rows, kClearcoatExtensions);
  addExtensions(rows, kTextureInfoExtensions);
  return rows;
}

}  // namespace lacquer::gltf
