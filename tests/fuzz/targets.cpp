#include "targets.h"

#include <algorithm>

#include "feeds.h"

namespace lacquer::fuzz {

namespace {

constexpr Target kTargets[] = {
    {"gltf", "gltf", Form::Gltf, feedGltf},
    {"gltf-oracle", "gltf", Form::Gltf, judgeGltf},
    {"glb", "glb", Form::Glb, feedGltf},
    {"mtlx", "mtlx", Form::Bytes, feedGltf},
    {"definitions", "mtlx", Form::Bytes, feedDefinitions},
    {"mtlx-out", "mtlx", Form::Bytes, feedDocumentOut},
    {"procedurals", "procedurals", Form::Gltf, feedGltf},
    {"procedurals-out", "procedurals", Form::Gltf, feedProceduralsOut},
    {"procedurals-of-mtlx", "mtlx", Form::Bytes, feedProceduralsOut},
    {"addresses", "gltf", Form::Gltf, feedAddresses},
    {"graph", "graph", Form::Graph, feedGraph},
    {"graph-oracle", "graph", Form::Graph, judgeGraph},
    {"edits", "edits", Form::Bytes, feedEdits},
    {"node", "node", Form::Bytes, feedNode},
    {"declaration", "declaration", Form::Bytes, feedDeclaration},
    {"parts", "parts", Form::Bytes, feedPart},
    {"image", "image", Form::Bytes, feedImage},
    {"panorama", "panorama", Form::Bytes, feedPanorama},
    {"ies", "ies", Form::Bytes, feedIes},
    {"texture", "texture", Form::Json, feedTexture},
    {"geometry", "geometry", Form::Json, feedGeometry},
    {"points", "points", Form::Json, feedPoints},
    {"case", "case", Form::Json, feedCase},
    {"manifest", "manifest", Form::Json, feedManifest},
    {"packed", "packed", Form::Bytes, feedPacked},
    {"cache", "cache", Form::Bytes, feedEntry},
    {"spirv", "spirv", Form::Bytes, feedSpirv},
};

}  // namespace

std::span<const Target> targets() { return kTargets; }

const Target* findTarget(std::string_view name) {
  const auto* const found =
      std::find_if(std::begin(kTargets), std::end(kTargets), [&](const Target& t) { return t.name == name; });
  return found == std::end(kTargets) ? nullptr : found;
}

}  // namespace lacquer::fuzz
