#include "mtlx/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "support/text.h"

namespace lacquer::materialx {

namespace {

struct TypeRow {
  std::string_view name;
  ir::Type type;
};
/// The first of equal types is the one that messages say.
constexpr TypeRow kTypes[] = {
    {"float", ir::Type::Float},   {"integer", ir::Type::Int},       {"boolean", ir::Type::Bool},
    {"vector2", ir::Type::Vec2},  {"vector3", ir::Type::Vec3},      {"vector4", ir::Type::Vec4},
    {"color3", ir::Type::Vec3},   {"color4", ir::Type::Vec4},       {"matrix33", ir::Type::Mat3},
    {"matrix44", ir::Type::Mat4}, {"filename", ir::Type::Texture2D}};

using Matrix = std::array<double, 9>;  // rows; colours are rows, too, and stand in front
// MaterialX, libraries/cmlib: acescg_to_lin_rec709, lin_adobergb_to_lin_rec709, lin_displayp3_to_lin_rec709.
constexpr Matrix kAp1{1.705050992658,  -0.130256417507, -0.024003356805, -0.621792120657, 1.140804736575,
                      -0.128968976065, -0.083258872001, -0.010548319068, 1.15297233287};
constexpr Matrix kAdobe{1.39835574, 0, 0, -0.398355744, 1, -0.0429289893, 0, 0, 1.04292899};
constexpr Matrix kDisplayP3{1.22493029,  -0.04205868, -0.01964128, -0.22492968, 1.04205894,
                            -0.07864794, 0.00000006,  -0.00000001, 1.09828925};

enum class Curve : uint8_t { None, Power, Srgb };
struct Space {
  std::string_view name;
  Curve curve = Curve::None;
  double power = 1;
  const Matrix* matrix = nullptr;
};
/// MaterialX 1.39, "Color Spaces", and libraries/cmlib.
constexpr Space kSpaces[] = {{"lin_rec709"},
                             {"lin_rec709_scene"},
                             {"lin_srgb"},
                             {"raw"},
                             {"none"},
                             {""},
                             {"srgb_texture", Curve::Srgb},
                             {"srgb_rec709_scene", Curve::Srgb},
                             {"g18_rec709", Curve::Power, 1.8},
                             {"g18_rec709_scene", Curve::Power, 1.8},
                             {"g22_rec709", Curve::Power, 2.2},
                             {"g22_rec709_scene", Curve::Power, 2.2},
                             {"rec709_display", Curve::Power, 2.4},
                             {"gamma18", Curve::Power, 1.8},  // as MaterialX called them before 1.39
                             {"gamma22", Curve::Power, 2.2},
                             {"gamma24", Curve::Power, 2.4},
                             {"acescg", Curve::None, 1, &kAp1},
                             {"lin_ap1", Curve::None, 1, &kAp1},
                             {"lin_ap1_scene", Curve::None, 1, &kAp1},
                             {"g22_ap1", Curve::Power, 2.2, &kAp1},
                             {"g22_ap1_scene", Curve::Power, 2.2, &kAp1},
                             {"lin_adobergb", Curve::None, 1, &kAdobe},
                             {"lin_adobergb_scene", Curve::None, 1, &kAdobe},
                             {"adobergb", Curve::Power, 563.0 / 256.0, &kAdobe},
                             {"lin_displayp3", Curve::None, 1, &kDisplayP3},
                             {"lin_p3d65_scene", Curve::None, 1, &kDisplayP3},
                             {"srgb_displayp3", Curve::Srgb, 1, &kDisplayP3},
                             {"srgb_p3d65_scene", Curve::Srgb, 1, &kDisplayP3}};

const Space* spaceOf(std::string_view name) {
  const auto* found =
      std::find_if(std::begin(kSpaces), std::end(kSpaces), [&](const Space& s) { return s.name == name; });
  return found == std::end(kSpaces) ? nullptr : found;
}

double decoded(const Space& space, double x) {
  switch (space.curve) {
    case Curve::None: return x;
    case Curve::Power: return std::pow(std::max(x, 0.0), space.power);
    case Curve::Srgb: return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  }
  return x;
}

/// MaterialX 1.39, "Units": of distances in metres, of angles in degrees, of times in seconds.
std::span<const Unit> standardUnits() {
  static const Unit kUnits[] = {{"distance", "nanometer", 1e-9},
                                {"distance", "micron", 1e-6},
                                {"distance", "micrometer", 1e-6},  // as nodes of the library say it
                                {"distance", "millimeter", 1e-3},
                                {"distance", "centimeter", 1e-2},
                                {"distance", "inch", 0.0254},
                                {"distance", "foot", 0.3048},
                                {"distance", "yard", 0.9144},
                                {"distance", "meter", 1},
                                {"distance", "kilometer", 1000},
                                {"distance", "mile", 1609.344},
                                {"angle", "degree", 1},
                                {"angle", "radian", 57.295779513082323},
                                {"time", "second", 1},
                                {"time", "minute", 60},
                                {"time", "hour", 3600}};
  return kUnits;
}

const Unit* unitIn(std::span<const Unit> units, std::string_view type, std::string_view name) {
  for (const Unit& row : units) {
    if (row.name == name && (type.empty() || row.type == type)) return &row;
  }
  return nullptr;
}

}  // namespace

std::optional<ir::Type> typeOf(std::string_view type) {
  for (const TypeRow& row : kTypes) {
    if (row.name == type) return row.type;
  }
  return std::nullopt;
}

std::string_view nameOf(ir::Type type) {
  for (const TypeRow& row : kTypes) {
    if (row.type == type) return row.name;
  }
  return ir::typeName(type);
}

bool isColorSpace(std::string_view space) { return spaceOf(space) != nullptr; }

bool isLinear(std::string_view space) {
  const Space* found = spaceOf(space);
  return found != nullptr && found->curve == Curve::None && found->matrix == nullptr;
}

bool isConverted(std::string_view space) {
  return !space.empty() && !isLinear(space) && space != "srgb_texture" && space != "srgb_rec709_scene";
}

ir::Components toLinear(std::string_view name, ir::Components color) {
  const Space& space = *spaceOf(name);
  std::array<double, 3> in{};
  for (size_t i = 0; i < 3; ++i) in[i] = decoded(space, color[i]);
  for (size_t i = 0; i < 3; ++i) {
    color[i] = in[i];
    if (space.matrix == nullptr) continue;
    const Matrix& m = *space.matrix;
    color[i] = in[0] * m[i] + in[1] * m[3 + i] + in[2] * m[6 + i];
  }
  return color;
}

void Units::add(const Element& document, Diagnostics& said) {
  for (const Element& of : document.children) {
    if (of.category != "unitdef") continue;
    for (const Element& one : of.children) {
      if (one.category != "unit") continue;
      const std::optional<std::vector<double>> scale = numbersOf(one.get("scale"));
      if (!scale || scale->size() != 1 || !((*scale)[0] > 0)) {
        addBounded(said,
                   {"wrong-value",
                    Severity::Warning,
                    one.place,
                    fmt::format("the scale of the unit {} is {}", quote(one.name()), quote(one.get("scale"))),
                    "it is a number above 0: the unit is left out",
                    {}});
        continue;
      }
      // MaterialX's own text has fewer digits of a radian.
      constexpr double kSame = 1e-8;
      const Unit* standard = unitIn(standardUnits(), of.get("unittype"), one.name());
      if (standard != nullptr && std::abs(standard->scale / (*scale)[0] - 1) < kSame) continue;
      own_[std::string(one.name())].push_back(
          {std::string(of.get("unittype")), std::string(one.name()), (*scale)[0]});
    }
  }
}

const Unit* Units::find(std::string_view type, std::string_view name) const {
  const auto own = own_.find(name);
  const Unit* found = own == own_.end() ? nullptr : unitIn(own->second, type, name);
  return found != nullptr ? found : unitIn(standardUnits(), type, name);
}

Diagnostic Units::unknown(const Element& said) {
  return {
      "unknown-unit",
      Severity::Error,
      said.place,
      said.get("unittype").empty() ? fmt::format("{} is in {}", quote(said.name()), quote(said.get("unit")))
                                   : fmt::format("{} is in {}, which is no unit of {}", quote(said.name()),
                                                 quote(said.get("unit")), quote(said.get("unittype"))),
      "units are those of MaterialX's unit types \"distance\", \"angle\" and \"time\", and of a \"unitdef\"",
      {}};
}

Result<ir::Components> valueOf(const Element& input, ir::Type type, const Units& units,
                               std::string_view port_unit) {
  const std::string_view value = trimmed(input.get("value"));
  const auto wrong = [&](std::string message, std::string help) {
    return fail("wrong-value", input.place, std::move(message), std::move(help));
  };
  const auto what = [&] { return fmt::format("the value of {} is {}", quote(input.name()), quote(value)); };
  if (type == ir::Type::Bool) {
    if (value == "true" || value == "1") return ir::Components{1};
    if (value == "false" || value == "0") return ir::Components{0};
    return wrong(what(), "a boolean is true or false");
  }
  const auto count = static_cast<size_t>(ir::componentCount(type));
  const std::optional<std::vector<double>> numbers = numbersOf(value);
  if (!numbers || numbers->size() != count)
    return wrong(what(), count == 1
                             ? fmt::format("it must be {} number", type == ir::Type::Int ? "a whole" : "a")
                             : fmt::format("it must be {} numbers, with commas between", count));
  ir::Components components{};
  std::copy(numbers->begin(), numbers->end(), components.begin());
  for (size_t i = 0; i < count; ++i) {
    if (std::abs(components[i]) > static_cast<double>(std::numeric_limits<float>::max()))
      return wrong(what(), "it must fit a 32-bit float: at most about 3.4e38");
  }
  if (type == ir::Type::Int && components[0] != std::trunc(components[0]))
    return wrong(what(), "an integer is a whole number");
  if (const std::string* unit = input.find("unit"); unit != nullptr && !unit->empty()) {
    const Unit* given = units.find(input.get("unittype"), *unit);
    const Unit* wanted = units.find({}, port_unit);
    if (given == nullptr) return tl::make_unexpected(Diagnostics{Units::unknown(input)});
    if (wanted != nullptr && wanted->type != given->type)
      return fail("unknown-unit", input.place, fmt::format("{} is in {}", quote(input.name()), quote(*unit)),
                  fmt::format("it is a number of {}s", port_unit));
    const double scale = wanted == nullptr ? given->scale : given->scale / wanted->scale;
    // A micron is 1000 nanometres: the quotient of the scales is less by a last bit, the reverse is exact.
    const bool larger = wanted != nullptr && scale > 1;
    for (size_t i = 0; i < count && given != wanted; ++i)
      components[i] = larger ? components[i] / (wanted->scale / given->scale) : components[i] * scale;
  }
  const std::string_view written = input.get("type");
  const std::string_view space = input.get("colorspace");
  if ((written == "color3" || written == "color4") && !space.empty()) {
    if (!isColorSpace(space))
      return fail("unknown-colorspace", input.place,
                  fmt::format("{} is of the colour space {}", quote(input.name()), quote(space)),
                  "those of MaterialX's library are known: lin_rec709, srgb_texture, acescg, g22_rec709, …");
    components = toLinear(space, components);
  }
  return components;
}

}  // namespace lacquer::materialx
