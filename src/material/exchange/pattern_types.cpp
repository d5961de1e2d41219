#include <fmt/format.h>

#include "exchange/pattern_out.h"
#include "ir/types.h"
#include "mtlx/values.h"

namespace lacquer::exchange {

using ir::Components;
using ir::Type;

std::string typeName(Typed type) {
  if (type.color && type.type == Type::Vec3) return "color3";
  if (type.color && type.type == Type::Vec4) return "color4";
  return std::string(materialx::nameOf(type.type));
}

std::optional<Typed> typedOf(std::string_view name) {
  const std::optional<Type> type = materialx::typeOf(name);
  if (!type) return std::nullopt;
  return Typed{*type, name.starts_with("color")};
}

std::string valueText(Type type, const Components& value) {
  if (type == Type::Bool) return value[0] != 0 ? "true" : "false";
  std::string text;
  for (int i = 0; i < ir::componentCount(type); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : ", ", value[static_cast<size_t>(i)]);
  return text;
}

}  // namespace lacquer::exchange
