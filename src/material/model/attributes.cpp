#include "model/attributes.h"

#include <algorithm>
#include <array>

namespace lacquer::model {

namespace {

/// "TEXCOORD_0" for "TEXCOORD_".
bool isNumbered(std::string_view name, std::string_view what) {
  return name.starts_with(what) && name.size() == what.size() + 1;
}

/// Whether glTF, or an extension, says what an attribute is; all others are the application's.
bool isGltfs(std::string_view name) {
  constexpr std::array kNames = {"POSITION",    "NORMAL",   "TANGENT", "COLOR_0",  "MORPH_VERTEX",
                                 "TRANSLATION", "ROTATION", "SCALE",   "QUANTIZED"};
  constexpr std::array kSets = {"TEXCOORD_", "JOINTS_", "WEIGHTS_"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end() ||
         std::any_of(kSets.begin(), kSets.end(), [&](std::string_view set) { return isNumbered(name, set); });
}

}  // namespace

bool hasAttribute(const gltf::VertexAttributes& attributes, std::string_view name) {
  const auto numbered = [&](std::string_view what, const auto& sets, bool& has) {
    const auto set = static_cast<size_t>(name.back() - '0');
    if (!isNumbered(name, what) || set >= sets.size()) return false;
    has = sets[set];
    return true;
  };
  if (name == "NORMAL") return attributes.normal;
  if (name == "TANGENT") return attributes.tangent;
  if (name == "COLOR_0") return attributes.color0;
  if (name == "MORPH_VERTEX") return attributes.morph;
  if (name == "TRANSLATION" || name == "ROTATION" || name == "SCALE") return attributes.instances;
  if (name == "QUANTIZED") return attributes.quantized;
  bool has = true;
  if (numbered("TEXCOORD_", attributes.texCoord, has) || numbered("JOINTS_", attributes.skin, has) ||
      numbered("WEIGHTS_", attributes.skin, has))
    return has;
  if (name == "POSITION") return true;
  // glTF writes _WETNESS, a template may write WETNESS.
  name.remove_prefix(name.starts_with('_') ? 1 : 0);
  return std::any_of(attributes.application.begin(), attributes.application.end(), [&](std::string_view one) {
    one.remove_prefix(one.starts_with('_') ? 1 : 0);
    return one == name;
  });
}

bool needsAbsent(const lang::TemplateDecl& decl, const lang::GivenDecl& given,
                 const gltf::VertexAttributes& attributes) {
  return std::any_of(given.attributes.begin(), given.attributes.end(), [&](uint16_t place) {
    // An attribute that is not glTF's is the application's, which has it unless the template asks.
    const std::string_view name = decl.attributes[place].name;
    return isGltfs(name) && !hasAttribute(attributes, name);
  });
}

}  // namespace lacquer::model
