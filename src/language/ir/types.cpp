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
    case Type::UInt: return "uint";
    case Type::IVec2: return "ivec2";
    case Type::IVec3: return "ivec3";
    case Type::IVec4: return "ivec4";
    case Type::UVec2: return "uvec2";
    case Type::UVec3: return "uvec3";
    case Type::UVec4: return "uvec4";
    case Type::BVec2: return "bvec2";
    case Type::BVec3: return "bvec3";
    case Type::BVec4: return "bvec4";
    case Type::Mat3: return "mat3";
  }
  return "";
}

std::string rangeText(const Range& range) {
  if (range.gap > 0) return fmt::format("[{}, {}] or 0", range.gap, range.hi);
  return fmt::format("[{}, {}]", range.lo, range.hi);
}

Type partType(Type type) {
  if (type == Type::Mat3) return Type::Vec3;
  if (type == Type::Mat4) return Type::Vec4;
  if (type >= Type::BVec2) return Type::Bool;
  if (type >= Type::UVec2) return Type::UInt;
  if (type >= Type::IVec2) return Type::Int;
  return isFloatVector(type) ? Type::Float : type;
}

Type vectorType(Type component, int count) {
  if (count == 1) return component;
  const auto from = [&](Type two) { return static_cast<Type>(static_cast<int>(two) + count - 2); };
  if (component == Type::Int) return from(Type::IVec2);
  if (component == Type::UInt) return from(Type::UVec2);
  if (component == Type::Bool) return from(Type::BVec2);
  return from(Type::Vec2);
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
