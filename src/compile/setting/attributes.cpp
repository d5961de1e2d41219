#include "setting/attributes.h"

namespace lacquer {

Attributes toPublic(const gltf::VertexAttributes& a) {
  return {a.normal, a.tangent,   a.color0,    a.texCoord,   a.skin,
          a.morph,  a.instances, a.quantized, a.application};
}

gltf::VertexAttributes fromPublic(const Attributes& a) {
  return {a.normal, a.tangent,   a.color0,    a.texCoord,   a.skin,
          a.morph,  a.instances, a.quantized, a.application};
}

}  // namespace lacquer
