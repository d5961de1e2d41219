#include "setting/attributes.h"

#include <algorithm>
#include <iterator>

namespace lacquer {

Attributes toPublic(const gltf::VertexAttributes& a) {
  return {a.normal, a.tangent,   a.color0,    a.texCoord,   a.skin,
          a.morph,  a.instances, a.quantized, a.application};
}

gltf::VertexAttributes fromPublic(const Attributes& a) {
  return {a.normal, a.tangent,   a.color0,    a.texCoord,   a.skin,
          a.morph,  a.instances, a.quantized, a.application};
}

Attributes attributesOf(const Strings& names) {
  Attributes a;
  const auto has = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  a.normal = has("NORMAL");
  a.tangent = has("TANGENT");
  a.color0 = has("COLOR_0");
  for (size_t i = 0; i < a.texCoord.size(); ++i) a.texCoord[i] = has("TEXCOORD_" + std::to_string(i));
  for (size_t i = 0; i < a.skin.size(); ++i) a.skin[i] = has("JOINTS_" + std::to_string(i));
  a.morph = has("MORPH_VERTEX");
  a.instances = has("TRANSLATION");
  a.quantized = has("QUANTIZED");
  std::copy_if(names.begin(), names.end(), std::back_inserter(a.application), [](const std::string& name) {
    const auto beyond = [&](std::string_view set, char last) {
      return name.starts_with(set) && name.size() == set.size() + 1 && name.back() > last;
    };
    return name.starts_with('_') || beyond("COLOR_", '0') || beyond("TEXCOORD_", '3');
  });
  return a;
}

}  // namespace lacquer
