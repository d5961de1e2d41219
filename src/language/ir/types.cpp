#include "ir/types.h"

#include <fmt/format.h>

namespace lacquer::ir {

std::string_view typeName(Type type) {
  switch (type) {
    case Type::Bool: return "bool";
    case Type::Int: return "int";
    case Type::Float: return "float";
    case Type::Vec2: return "vec2";
    case Type::Vec3: return "vec3";
    case Type::Vec4: return "vec4";
    case Type::Mat4: return "mat4";
    case Type::Texture2D: return "sampler2D";
    case Type::TextureCube: return "samplerCube";
    case Type::Texture2DShadow: return "sampler2DShadow";
    case Type::Texture2DArray: return "sampler2DArray";
    case Type::Texture3D: return "sampler3D";
  }
  return "";
}

std::string rangeText(const Range& range) {
  if (range.gap > 0) return fmt::format("[{}, {}] or 0", range.gap, range.hi);
  return fmt::format("[{}, {}]", range.lo, range.hi);
}

Type floatType(int components) { return static_cast<Type>(static_cast<int>(Type::Float) + components - 1); }

std::string_view rateName(Rate rate) {
  switch (rate) {
    case Rate::Constant: return "constant";
    case Rate::Material: return "material";
    case Rate::Frame: return "frame";
    case Rate::Object: return "object";
    case Rate::Vertex: return "vertex";
    case Rate::Fragment: return "fragment";
    case Rate::Light: return "light";
  }
  return "";
}

}  // namespace lacquer::ir
