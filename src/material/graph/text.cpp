#include "graph/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "support/letters.h"

namespace lacquer::graph {

namespace {

using ir::Type;

bool beginsName(char c) { return isLetter(c) || c == '_'; }

std::optional<Type> oneOf(std::string_view name, std::initializer_list<Type> types) {
  const auto* const it =
      std::find_if(types.begin(), types.end(), [&](Type type) { return ir::typeName(type) == name; });
  return it == types.end() ? std::nullopt : std::optional(*it);
}

}  // namespace

bool fitsFloat(double x) { return std::abs(x) <= static_cast<double>(std::numeric_limits<float>::max()); }

std::optional<Type> valueType(std::string_view name) {
  return oneOf(name, {Type::Float, Type::Vec2, Type::Vec3, Type::Vec4, Type::Bool, Type::BVec2, Type::BVec3,
                      Type::BVec4, Type::Int, Type::IVec2, Type::IVec3, Type::IVec4, Type::UInt, Type::UVec2,
                      Type::UVec3, Type::UVec4, Type::Mat3, Type::Mat4});
}

std::optional<Type> textureType(std::string_view name) {
  return oneOf(name, {Type::Texture2D, Type::TextureCube, Type::Texture2DArray});
}

std::optional<Type> inputType(std::string_view name) {
  for (const Type type : ir::kTypes) {
    if (ir::typeName(type) == name) return type;
  }
  return std::nullopt;
}

std::string article(Type type) {
  const std::string_view name = ir::typeName(type);
  return (name[0] == 'i' ? "an " : "a ") + std::string(name);
}

bool isName(std::string_view text) {
  return !text.empty() && beginsName(text[0]) &&
         std::all_of(text.begin(), text.end(), [](char c) { return beginsName(c) || isDigit(c); });
}

bool isDottedName(std::string_view text) {
  bool begins = true;
  for (const char c : text) {
    if (c == '.' ? begins : !beginsName(c) && (begins || !isDigit(c))) return false;
    begins = c == '.';
  }
  return !begins;
}

std::string swizzleComponents(std::string_view swizzle) {
  if (swizzle.empty() || swizzle.size() > 4) return {};
  for (const std::string_view set : {"xyzw", "rgba", "stpq"}) {
    std::string components;
    for (const char c : swizzle) {
      const size_t at = set.find(c);
      if (at == std::string_view::npos) break;
      components += static_cast<char>(at);
    }
    if (components.size() == swizzle.size()) return components;
  }
  return {};
}

void shorten(Diagnostics& diagnostics, size_t left_out) {
  constexpr size_t kMost = 100;
  if (diagnostics.size() <= kMost) return;
  const size_t more = diagnostics.size() - kMost + left_out;
  const bool errors = std::any_of(diagnostics.begin() + kMost, diagnostics.end(),
                                  [](const Diagnostic& d) { return d.severity == Severity::Error; });
  diagnostics.resize(kMost);
  diagnostics.push_back({"more-errors",
                         Severity::Note,
                         diagnostics[0].place,
                         fmt::format("{} more {} are not shown", more, errors ? "errors" : "warnings"),
                         {},
                         {}});
  diagnostics.back().place.pointer.clear();
  diagnostics.back().place.line = diagnostics.back().place.column = 0;
}

}  // namespace lacquer::graph
