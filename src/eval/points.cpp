#include "eval/points.h"

#include "eval/evaluate.h"

namespace lacquer::eval {

namespace {

template <class Get>
Column column(std::span<const Point> points, int components, Get get) {
  std::vector<double> values;
  values.reserve(points.size() * static_cast<size_t>(components));
  for (const Point& point : points) {
    const auto value = get(point);
    values.insert(values.end(), value.begin(), value.end());
  }
  return Column::perPoint(components, std::move(values));
}

using Vec3 = std::array<double, 3>;

}  // namespace

void bindPoints(std::span<const Point> points, Bindings& bindings) {
  Columns& to = bindings.columns;
  const std::vector<double> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  for (const char* name : {"object.model", "object.normal_matrix", "frame.view_projection"}) {
    to[name] = Column::constant(identity);
  }
  to["frame.environment_intensity"] = Column::constant({1});
  to["frame.environment_max_lod"] = Column::constant({0});
  to["frame.light_count"] = Column::constant({1});
  to["frame.camera_position"] = column(points, 3, [](const Point& p) {
    return Vec3{p.position[0] + p.v[0], p.position[1] + p.v[1], p.position[2] + p.v[2]};
  });
  to["POSITION"] = column(points, 3, [](const Point& p) { return p.position; });
  to["NORMAL"] = column(points, 3, [](const Point& p) { return p.n; });
  to["TANGENT"] = column(points, 4, [](const Point& p) { return p.t; });
  to["TEXCOORD_0"] = column(points, 2, [](const Point& p) { return p.uv[0]; });
  to["TEXCOORD_1"] = column(points, 2, [](const Point& p) { return p.uv[1]; });
  to["TEXCOORD_2"] = column(points, 2, [](const Point& p) { return p.uv[2]; });
  to["TEXCOORD_3"] = column(points, 2, [](const Point& p) { return p.uv[3]; });
  to["COLOR_0"] = column(points, 4, [](const Point& p) { return p.color0; });
  to["VIEW"] = column(points, 3, [](const Point& p) { return p.v; });
  to["LIGHT"] = column(points, 3, [](const Point& p) { return p.l; });
  to["gl_FrontFacing"] =
      column(points, 1, [](const Point& p) { return std::array<double, 1>{p.front_facing ? 1.0 : 0.0}; });
  Columns light;
  light["light.position"] = column(points, 3, [](const Point& p) { return p.l; });
  light["light.positional"] = Column::constant({0});
  light["light.direction"] = Column::constant({0, 0, -1});
  light["light.inverse_range_4"] = Column::constant({0});
  light["light.radiance"] = column(points, 3, [](const Point& p) { return p.light; });
  light["light.spot_scale"] = Column::constant({0});
  light["light.spot_offset"] = Column::constant({1});
  bindings.lights = {std::move(light)};
}

Result<void> bindMaterialBlock(const ir::Module& module, Bindings& bindings) {
  std::vector<ir::ValueId> roots;
  for (const ir::PreshaderField& field : module.preshader) roots.push_back(field.value);
  const auto values = evaluate<double>(module, roots, bindings, 1);
  if (!values) return tl::make_unexpected(values.error());
  for (const ir::Block& block : module.blocks) {
    if (block.role != ir::BlockRole::Material) continue;
    for (size_t i = 0; i < roots.size(); ++i) {
      std::vector<double> rounded;
      for (const double x : (*values)[i]) rounded.push_back(static_cast<double>(static_cast<float>(x)));
      const ir::BlockField& field = block.fields[module.preshader[i].field];
      bindings.columns[block.instance + "." + field.name] = Column::constant(std::move(rounded));
    }
  }
  return {};
}

template <class T>
Result<void> bindVaryings(const ir::Module& module, size_t points, Bindings& bindings) {
  std::vector<ir::ValueId> roots;
  std::vector<const ir::Varying*> varyings;
  for (const ir::Varying& varying : module.varyings) {
    if (varying.source == ir::kNoValue) continue;
    roots.push_back(varying.source);
    varyings.push_back(&varying);
  }
  const auto values = evaluate<T>(module, roots, bindings, points);
  if (!values) return tl::make_unexpected(values.error());
  for (size_t i = 0; i < roots.size(); ++i) {
    const std::vector<T>& column = (*values)[i];
    bindings.columns[varyings[i]->name] =
        Column::perPoint(ir::componentCount(varyings[i]->type), {column.begin(), column.end()});
  }
  return {};
}

template Result<void> bindVaryings<float>(const ir::Module&, size_t, Bindings&);
template Result<void> bindVaryings<double>(const ir::Module&, size_t, Bindings&);

}  // namespace lacquer::eval
