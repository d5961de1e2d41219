#include "eval/points.h"

#include <algorithm>
#include <cassert>

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

/// A column of one number for each point.
template <class Get>
Column numbers(std::span<const Point> points, Get get) {
  return column(points, 1, [&](const Point& p) { return std::array<double, 1>{get(p)}; });
}

/// Each field's own value; of a matrix the identity.
void bindDefaults(const ir::Block& block, Columns& to) {
  for (const ir::BlockField& field : block.fields) {
    std::vector<double> value(field.value.begin(),
                              field.value.begin() + std::min(ir::componentCount(field.type), 4));
    if (field.type == ir::Type::Mat4) value = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (uint32_t i = 0; i < field.elements(); ++i)
      to[block.instance + "." + field.elementName(i)] = Column::constant(value);
  }
}

}  // namespace

Columns lightOf(const ir::Module& module, std::string_view kind, Columns properties, size_t points) {
  Columns columns;
  for (const ir::Block& block : module.blocks) {
    if (block.role != ir::BlockRole::Lights) continue;
    bindDefaults(block, columns);
    for (const ir::LightKind& known : module.light_kinds) {
      if (known.name != kind) continue;
      assert(known.fill && "lowered for evaluations");
      const bool per_point = std::any_of(properties.begin(), properties.end(),
                                         [](const auto& property) { return property.second.per_point; });
      if (per_point && points == 0) return columns;  // nobody looks at the light
      Bindings bindings;
      bindings.columns = std::move(properties);
      std::vector<ir::ValueId> roots;
      for (const ir::Output& output : known.fill->outputs) roots.push_back(output.value);
      const auto values = evaluate<double>(*known.fill, roots, bindings, per_point ? points : 1);
      assert(values && "its inputs are parameters");
      for (size_t i = 0; i < roots.size(); ++i) {
        const ir::Output& output = known.fill->outputs[i];
        const int components = ir::componentCount(known.fill->dag[output.value].type);
        Column& column = columns[block.instance + "." + output.name];
        column = Column::perPoint(components, (*values)[i]);
        const bool same = !per_point || known.fill->dag.isConstant(output.value);
        if (same) column = Column::constant({column.values.begin(), column.values.begin() + components});
      }
      return columns;
    }
  }
  return columns;
}

namespace {

/// What vertices have beyond the template's attributes.
void bindNamed(std::string_view name, ir::Type type, std::span<const Point> points, Columns& to) {
  if (to.contains(std::string(name))) return;
  const double otherwise = name.starts_with("COLOR_") ? 1 : 0;
  const auto components = static_cast<size_t>(ir::componentCount(type));
  std::vector<double> values;
  values.reserve(points.size() * components);
  for (const Point& point : points) {
    const auto found = point.attributes.find(name);
    for (size_t i = 0; i < components; ++i)
      values.push_back(found == point.attributes.end() ? otherwise : found->second[i]);
  }
  to[std::string(name)] = Column::perPoint(static_cast<int>(components), std::move(values));
}

}  // namespace

void bindPoints(const ir::Module& module, std::span<const Point> points, Bindings& bindings) {
  Columns& to = bindings.columns;
  for (const ir::Block& block : module.blocks) {
    if (block.role != ir::BlockRole::Frame && block.role != ir::BlockRole::Object) continue;
    bindDefaults(block, to);
    for (const ir::BlockField& field : block.fields) {
      if (field.name != "camera_position" || field.type != ir::Type::Vec3) continue;
      to[block.instance + "." + field.name] = column(points, 3, [](const Point& p) {
        return Vec3{p.position[0] + p.v[0], p.position[1] + p.v[1], p.position[2] + p.v[2]};
      });
    }
  }
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
  to["INSIDE"] = numbers(points, [](const Point& p) { return p.inside ? 1.0 : 0.0; });
  to["SURROUNDING_IOR"] = numbers(points, [](const Point& p) { return p.surrounding_ior; });
  to["CHANNEL"] = numbers(points, [](const Point& p) { return p.channel; });
  to["RANDOM"] = column(points, 3, [](const Point& p) { return p.random; });
  to["gl_FrontFacing"] = numbers(points, [](const Point& p) { return p.front_facing ? 1.0 : 0.0; });
  for (const ir::Attribute& attribute : module.attributes)
    bindNamed(attribute.name, attribute.type, points, to);
  for (const ir::Varying& varying : module.varyings) {
    if (varying.source == ir::kNoValue) bindNamed(varying.name, varying.type, points, to);
  }
  Columns light;
  light["direction"] = column(points, 3, [](const Point& p) { return Vec3{-p.l[0], -p.l[1], -p.l[2]}; });
  light["color"] = column(points, 3, [](const Point& p) { return p.light; });
  light["intensity"] = Column::constant({1});
  bindings.lights = {lightOf(module, "directional", std::move(light), points.size())};
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
