// The few types, rates and intervals that every later folder speaks of.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace lacquer::ir {

enum class Type : uint8_t {
  Bool,
  Int,
  Float,
  Vec2,
  Vec3,
  Vec4,
  Mat4,
  Texture2D,
  TextureCube,
  Texture2DShadow,  ///< a depth map with a sampler that compares
  Texture2DArray,
  Texture3D,
  UInt,
  IVec2,
  IVec3,
  IVec4,
  UVec2,
  UVec3,
  UVec4,
  BVec2,
  BVec3,
  BVec4,
  Mat3,
};

/// All of them, in the order of the enumeration.
inline constexpr std::array kTypes = {
    Type::Bool,           Type::Int,       Type::Float,     Type::Vec2,        Type::Vec3,
    Type::Vec4,           Type::Mat4,      Type::Texture2D, Type::TextureCube, Type::Texture2DShadow,
    Type::Texture2DArray, Type::Texture3D, Type::UInt,      Type::IVec2,       Type::IVec3,
    Type::IVec4,          Type::UVec2,     Type::UVec3,     Type::UVec4,       Type::BVec2,
    Type::BVec3,          Type::BVec4,     Type::Mat3};

/// GLSL's name: "bool", "int", "float", "vec2", …, "mat4", "sampler2D", "samplerCube", "sampler2DShadow", ….
std::string_view typeName(Type type);

/// Number of components: 1 for Float, Int, UInt and Bool, 2 to 4 for vectors, 9 and 16 for matrices, 0 for
/// textures.
constexpr int componentCount(Type type) {
  constexpr int kCounts[] = {1, 1, 1, 2, 3, 4, 16, 0, 0, 0, 0, 0, 1, 2, 3, 4, 2, 3, 4, 2, 3, 4, 9};
  return kCounts[static_cast<int>(type)];
}

inline bool isFloatVector(Type t) { return t == Type::Vec2 || t == Type::Vec3 || t == Type::Vec4; }
inline bool isFloating(Type t) { return t == Type::Float || isFloatVector(t); }
inline bool isTexture(Type t) { return t >= Type::Texture2D && t <= Type::Texture3D; }
/// A 32-bit integer.
inline bool isWhole(Type t) { return t == Type::Int || t == Type::UInt; }
inline bool isMatrix(Type t) { return t == Type::Mat3 || t == Type::Mat4; }
/// A matrix, or a vector of integers or Bools. The DAG has no operations on them: such a value is an input or
/// a Construct, and what is done with it is done with its columns or components.
inline bool isComposite(Type t) { return t >= Type::UInt ? t != Type::UInt : t == Type::Mat4; }
/// Of a vector, the type of a component; of a matrix, of a column; any other type itself.
Type partType(Type type);
/// The vector of so many components of a type; for 1, the type.
Type vectorType(Type component, int count);
/// What a lookup is given: u and v; a direction; u, v and the value to compare; u, v and the layer; u, v and
/// w.
inline Type coordinateType(Type texture) { return texture == Type::Texture2D ? Type::Vec2 : Type::Vec3; }

/// A derivative of that: layers have none.
inline Type derivativeType(Type texture) {
  return texture == Type::TextureCube || texture == Type::Texture3D ? Type::Vec3 : Type::Vec2;
}
/// How many numbers a texture's size has: width and height, and of an array the layers, of a volume the
/// depth.
inline int sizeCount(Type texture) {
  return texture == Type::Texture2DArray || texture == Type::Texture3D ? 3 : 2;
}

/// No target has textures with longer sides, or more layers.
inline constexpr int kLargestTexture = 32768;

/// Float, Vec2, Vec3 or Vec4 for 1 to 4 components.
Type floatType(int components);

/// How often a value can change, lowest first. A value has the highest rate among its operands, except that
/// Interpolate lifts Vertex to Fragment and SumOverLights lowers Light to Fragment.
enum class Rate : uint8_t { Constant, Material, Frame, Object, Vertex, Fragment, Light };

/// "constant", "material", …
std::string_view rateName(Rate rate);

/// A closed range of floats; the default is unbounded.
struct Interval {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
  bool operator==(const Interval&) const = default;
  bool bounded() const { return lo > -1e300 && hi < 1e300; }
};

/// The numbers that something may be given: an interval without those between 0 and `gap`. An index of
/// refraction is 0, which stands for an infinite one, or at least 1: [0, inf] with a gap of 1. What is
/// derived from a range takes the interval.
struct Range : Interval {
  double gap = 0;  ///< 0 for none; else `lo` is 0
  bool operator==(const Range&) const = default;
  bool contains(double x) const { return x >= lo && x <= hi && !(x > 0 && x < gap); }
};

/// "[0, 1]", or "[1, inf] or 0" where there is a gap.
std::string rangeText(const Range& range);

}  // namespace lacquer::ir
