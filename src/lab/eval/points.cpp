#include "eval/points.h"

#include <algorithm>
#include <cassert>
#include <cmath>

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

constexpr std::array kUvNames = {"uv0", "uv1", "uv2", "uv3"};
constexpr std::array kUvAttributes = {"TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"};

/// Whether a point has a member of its own for the attribute.
bool isMember(std::string_view name) {
  constexpr std::array<std::string_view, 15> kMembers = {
      "POSITION",       "VIEW",       "NORMAL",          "TANGENT", "TEXCOORD_0",
      "TEXCOORD_1",     "TEXCOORD_2", "TEXCOORD_3",      "COLOR_0", "LIGHT",
      "gl_FrontFacing", "INSIDE",     "SURROUNDING_IOR", "CHANNEL", "RANDOM"};
  return std::find(kMembers.begin(), kMembers.end(), name) != kMembers.end();
}

/// What vertices have beyond the template's attributes. Bound anew where other points have been bound before.
void bindNamed(std::string_view name, ir::Type type, const Columns& points, Columns& to) {
  if (isMember(name)) return;
  const double otherwise = name.starts_with("COLOR_") ? 1 : 0;
  const auto components = static_cast<size_t>(ir::componentCount(type));
  const auto found = points.find(name);
  if (found == points.end()) {
    to[std::string(name)] = Column::constant(std::vector<double>(components, otherwise));
    return;
  }
  // What is missing of an attribute is 0, and of four components the last is 1, as at a device.
  const Column& from = found->second;
  const auto there = static_cast<size_t>(from.components);
  std::vector<double> values;
  values.reserve(from.values.size() / there * components);
  for (size_t at = 0; at < from.values.size(); at += there) {
    for (size_t i = 0; i < components; ++i)
      values.push_back(i < there ? from.values[at + i] : i == 3 ? 1 : 0);
  }
  to[std::string(name)] = {static_cast<int>(components), from.per_point, std::move(values)};
}

Column taken(Columns& points, std::string_view name, std::vector<double> otherwise) {
  const auto found = points.find(name);
  return found == points.end() ? Column::constant(std::move(otherwise)) : std::move(found->second);
}

}  // namespace

std::array<double, 3> across(const std::array<double, 3>& n) {
  const Vec3 axis = std::abs(n[0]) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const double along = axis[0] * n[0] + axis[1] * n[1] + axis[2] * n[2];
  const Vec3 side{axis[0] - n[0] * along, axis[1] - n[1] * along, axis[2] - n[2] * along};
  const double length = std::sqrt(side[0] * side[0] + side[1] * side[1] + side[2] * side[2]);
  return {side[0] / length, side[1] / length, side[2] / length};
}

PointColumns columnsOf(std::span<const Point> points) {
  PointColumns result{points.size(), {}};
  Columns& to = result.columns;
  to["position"] = column(points, 3, [](const Point& p) { return p.position; });
  to["n"] = column(points, 3, [](const Point& p) { return p.n; });
  to["t"] = column(points, 4, [](const Point& p) { return p.t; });
  for (size_t i = 0; i < kUvNames.size(); ++i)
    to[kUvNames[i]] = column(points, 2, [&](const Point& p) { return p.uv[i]; });
  to["color0"] = column(points, 4, [](const Point& p) { return p.color0; });
  to["v"] = column(points, 3, [](const Point& p) { return p.v; });
  to["l"] = column(points, 3, [](const Point& p) { return p.l; });
  to["light"] = column(points, 3, [](const Point& p) { return p.light; });
  to["inside"] = numbers(points, [](const Point& p) { return p.inside ? 1.0 : 0.0; });
  to["surrounding_ior"] = numbers(points, [](const Point& p) { return p.surrounding_ior; });
  to["channel"] = numbers(points, [](const Point& p) { return p.channel; });
  to["random"] = column(points, 3, [](const Point& p) { return p.random; });
  to["front_facing"] = numbers(points, [](const Point& p) { return p.front_facing ? 1.0 : 0.0; });
  for (const Point& point : points) {
    for (const auto& [name, value] : point.attributes) {
      if (to.contains(name)) continue;
      const double otherwise = name.starts_with("COLOR_") ? 1 : 0;
      to[name] = column(points, 4, [&, &of = name](const Point& p) {
        const auto found = p.attributes.find(of);
        return found == p.attributes.end() ? std::array<double, 4>{otherwise, otherwise, otherwise, otherwise}
                                           : found->second;
      });
    }
  }
  return result;
}

void bindPoints(const ir::Module& module, PointColumns points, Bindings& bindings) {
  Columns& given = points.columns;
  Columns& to = bindings.columns;
  to["POSITION"] = taken(given, "position", {0, 0, 0});
  to["VIEW"] = taken(given, "v", {0, 0, 1});
  for (const ir::Block& block : module.blocks) {
    if (block.role != ir::BlockRole::Frame && block.role != ir::BlockRole::Object) continue;
    bindDefaults(block, to);
    for (const ir::BlockField& field : block.fields) {
      if (field.name != "camera_position" || field.type != ir::Type::Vec3) continue;
      const auto sum = [](const double* p, const double* v, double* out) {
        for (size_t c = 0; c < 3; ++c) out[c] = p[c] + v[c];
      };
      to[block.instance + "." + field.name] = combined(to["POSITION"], to["VIEW"], points.count, 3, sum);
    }
  }
  to["NORMAL"] = taken(given, "n", {0, 0, 1});
  to["TANGENT"] = taken(given, "t", {1, 0, 0, 1});
  for (size_t i = 0; i < kUvNames.size(); ++i) to[kUvAttributes[i]] = taken(given, kUvNames[i], {0, 0});
  to["COLOR_0"] = taken(given, "color0", {1, 1, 1, 1});
  to["LIGHT"] = taken(given, "l", {0, 0, 1});
  to["INSIDE"] = taken(given, "inside", {0});
  to["SURROUNDING_IOR"] = taken(given, "surrounding_ior", {1});
  to["CHANNEL"] = taken(given, "channel", {-1});
  to["RANDOM"] = taken(given, "random", {0.5, 0.5, 0.5});
  to["gl_FrontFacing"] = taken(given, "front_facing", {1});
  for (const ir::Attribute& attribute : module.attributes)
    bindNamed(attribute.name, attribute.type, given, to);
  for (const ir::Varying& varying : module.varyings) {
    if (varying.source == ir::kNoValue) bindNamed(varying.name, varying.type, given, to);
  }
  Columns light;
  light["direction"] = to["LIGHT"];
  for (double& x : light["direction"].values) x = -x;
  light["color"] = taken(given, "light", {1, 1, 1});
  light["intensity"] = Column::constant({1});
  bindings.lights = {lightOf(module, "directional", std::move(light), points.count)};
}

void bindClock(double time, double frame, Bindings& bindings) {
  for (const auto& [name, value] : {std::pair("clock.time", time), std::pair("clock.frame", frame)}) {
    const auto found = bindings.columns.find(name);
    if (found != bindings.columns.end()) found->second = Column::constant({value});
  }
}

Result<void> bindMaterialBlock(const ir::Module& module, Bindings& bindings, size_t points) {
  std::vector<ir::ValueId> roots;
  for (const ir::PreshaderField& field : module.preshader) roots.push_back(field.value);
  const bool per_point =
      std::any_of(module.parameters.begin(), module.parameters.end(), [&](const ir::Parameter& parameter) {
        const auto found = bindings.columns.find(parameter.name);
        return found != bindings.columns.end() && found->second.per_point;
      });
  const auto values = evaluate<double>(module, roots, bindings, per_point ? points : 1);
  if (!values) return tl::make_unexpected(values.error());
  for (const ir::Block& block : module.blocks) {
    if (block.role != ir::BlockRole::Material) continue;
    for (size_t i = 0; i < roots.size(); ++i) {
      const ir::BlockField& field = block.fields[module.preshader[i].field];
      // An integer is in the block as it is.
      const bool whole = ir::isWhole(ir::partType(field.type));
      std::vector<double> rounded;
      for (const double x : (*values)[i])
        rounded.push_back(whole ? x : static_cast<double>(static_cast<float>(x)));
      bindings.columns[block.instance + "." + field.name] = {ir::componentCount(field.type), per_point,
                                                             std::move(rounded)};
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
  std::vector<Column> columns;
  for (size_t i = 0; i < roots.size(); ++i) {
    const std::vector<T>& column = (*values)[i];
    columns.push_back(
        Column::perPoint(ir::componentCount(varyings[i]->type), {column.begin(), column.end()}));
    // Floats do not hold every integer.
    if (!ir::isWhole(ir::partType(varyings[i]->type))) continue;
    const auto exact = evaluate<double>(module, {&roots[i], 1}, bindings, points);
    if (!exact) return tl::make_unexpected(exact.error());
    columns[i].values = (*exact)[0];
  }
  // A varying may have the name of an attribute that others are computed of.
  for (size_t i = 0; i < roots.size(); ++i) bindings.columns[varyings[i]->name] = std::move(columns[i]);
  return {};
}

template Result<void> bindVaryings<float>(const ir::Module&, size_t, Bindings&);
template Result<void> bindVaryings<double>(const ir::Module&, size_t, Bindings&);

}  // namespace lacquer::eval
