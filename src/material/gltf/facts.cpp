#include "gltf/facts.h"

#include <fmt/format.h>

#include <algorithm>

namespace lacquer::gltf {

bool sampled(const Texture::Source& source) {
  return source.layer == 0 &&
         std::all_of(source.channels.begin(), source.channels.end(), [](int channel) { return channel < 4; });
}

Channels Texture::channels() const {
  if (!swizzled()) return kOwnChannels;
  Channels taken = swizzles[0].channels;
  for (int c = 0; !sampled(swizzles[0]) && c < 4; ++c) {
    if (taken[static_cast<size_t>(c)] != kUnused) taken[static_cast<size_t>(c)] = c;
  }
  return taken;
}

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
