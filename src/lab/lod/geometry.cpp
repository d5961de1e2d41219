#include "lod/geometry.h"

#include <fmt/format.h>

#include <algorithm>

#include "setting/messages.h"

namespace lacquer::lod {

preview::Mesh meshOf(const material::Material& material, FileImages& images, const Language& language,
                     Messages& messages) {
  const gltf::Geometry geometry = images.geometry(static_cast<size_t>(material.index));
  if (!geometry.left_out.empty()) {
    report({{"geometry-left-out",
             Severity::Note,
             {{}, 0, 0, fmt::format("/materials/{}", material.index)},
             fmt::format("pictures are made {} of the file's own geometry: {}",
                         geometry.triangles.empty() ? "without any" : "with a part", geometry.left_out),
             "the ball is among the pictures in any case",
             {}}},
           images.file(), messages);
  }
  preview::Mesh mesh;
  mesh.triangles = geometry.triangles;
  for (const gltf::Corner& corner : geometry.corners) {
    eval::Point& point = mesh.vertices.emplace_back();
    std::copy(corner.position.begin(), corner.position.end(), point.position.begin());
    std::copy(corner.normal.begin(), corner.normal.end(), point.n.begin());
    std::copy(corner.tangent.begin(), corner.tangent.end(), point.t.begin());
    std::copy(corner.color.begin(), corner.color.end(), point.color0.begin());
    for (size_t set = 0; set < 4; ++set)
      std::copy(corner.uv[set].begin(), corner.uv[set].end(), point.uv[set].begin());
  }
  const Result<const material::Schema*> schema = language.models.schema();
  for (const material::Material::Number& number : material.numbers) {
    if (schema && (*schema)->properties[number.property].decl->name == "doubleSided")
      mesh.double_sided = number.value[0] != 0;
  }
  return mesh;
}

}  // namespace lacquer::lod
