#include "gltf/facts.h"

#include <fmt/format.h>

namespace lacquer::gltf {

std::vector<std::string> VertexAttributes::names() const {
  std::vector<std::string> out;
  if (normal) out.emplace_back("NORMAL");
  if (tangent) out.emplace_back("TANGENT");
  for (size_t i = 0; i < texCoord.size(); ++i) {
    if (texCoord[i]) out.push_back(fmt::format("TEXCOORD_{}", i));
  }
  if (color0) out.emplace_back("COLOR_0");
  for (size_t i = 0; i < skin.size(); ++i) {
    if (!skin[i]) continue;
    out.push_back(fmt::format("JOINTS_{}", i));
    out.push_back(fmt::format("WEIGHTS_{}", i));
  }
  if (morph) out.emplace_back("MORPH_VERTEX");
  if (instances) out.insert(out.end(), {"TRANSLATION", "ROTATION", "SCALE"});
  if (quantized) out.emplace_back("QUANTIZED");
  out.insert(out.end(), application.begin(), application.end());
  return out;
}

}  // namespace lacquer::gltf
