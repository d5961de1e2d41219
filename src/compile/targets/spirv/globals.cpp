#include "targets/spirv/globals.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "ir/whole.h"

namespace lacquer::targets::spirv {

namespace {

/// The number of 16 bits nearest to x, which one of them holds; what is too small to be normal is 0.
uint32_t halfBits(double x) {
  constexpr int kBias = 15, kBits = 10;
  const uint32_t sign = std::signbit(x) ? 0x8000U : 0;
  if (!(std::abs(x) >= 0x1p-14)) return sign;
  int exponent = 0;
  const double fraction = std::frexp(std::min(std::abs(x), 65504.0), &exponent);  // in [0.5, 1)
  const double whole = std::nearbyint(std::ldexp(fraction, kBits + 1));           // in [1024, 2048]
  // One that rounds up to 2048 goes on into the exponent.
  const auto bits = static_cast<uint32_t>(whole) - (1U << kBits);
  return sign | ((static_cast<uint32_t>(exponent - 1 + kBias) << kBits) + bits);
}

}  // namespace

Kind kindOf(ir::Type type) {
  switch (type) {
    case ir::Type::Bool: return Kind::Bool;
    case ir::Type::Int: return Kind::Int;
    case ir::Type::Float: return Kind::Float;
    case ir::Type::Vec2: return Kind::Vec2;
    case ir::Type::Vec3: return Kind::Vec3;
    case ir::Type::Vec4: return Kind::Vec4;
    case ir::Type::Mat4: return Kind::Mat4;
    case ir::Type::Texture2D: return Kind::Sampled2D;
    case ir::Type::TextureCube: return Kind::SampledCube;
    case ir::Type::Texture2DShadow: return Kind::SampledShadow;
    case ir::Type::Texture2DArray: return Kind::SampledArray;
    case ir::Type::Texture3D: return Kind::Sampled3D;
    case ir::Type::UInt: return Kind::UInt;
    case ir::Type::IVec2: return Kind::Int2;
    case ir::Type::IVec3: return Kind::Int3;
    case ir::Type::IVec4: return Kind::Int4;
    case ir::Type::UVec2: return Kind::UInt2;
    case ir::Type::UVec3: return Kind::UInt3;
    case ir::Type::UVec4: return Kind::UInt4;
    case ir::Type::BVec2:
    case ir::Type::BVec3:
    case ir::Type::BVec4:
    case ir::Type::Mat3: break;  // the DAG has none but as their parts
  }
  assert(false && "not a type");
  return Kind::Void;
}

Kind halfKindOf(ir::Type type) {
  constexpr std::array kByWidth = {Kind::Half, Kind::HalfVec2, Kind::HalfVec3, Kind::HalfVec4};
  assert(ir::componentCount(type) <= 4);
  return kByWidth[static_cast<size_t>(ir::componentCount(type) - 1)];
}

Kind imageKindOf(ir::Type texture) {
  switch (texture) {
    case ir::Type::TextureCube: return Kind::ImageCube;
    case ir::Type::Texture2DShadow: return Kind::ImageShadow;
    case ir::Type::Texture2DArray: return Kind::ImageArray;
    case ir::Type::Texture3D: return Kind::Image3D;
    default: assert(texture == ir::Type::Texture2D); return Kind::Image2D;
  }
}

Kind boolKind(ir::Type like) {
  constexpr std::array kByWidth = {Kind::Bool, Kind::Bool2, Kind::Bool3, Kind::Bool4};
  assert(ir::componentCount(like) <= 4);
  return kByWidth[static_cast<size_t>(ir::componentCount(like) - 1)];
}

Globals::Globals() : constants_(64) {
  names.reserve(512);
  decorations.reserve(256);
  declarations.reserve(768);
}

uint32_t Globals::type(Kind kind) {
  uint32_t& known = types_[static_cast<size_t>(kind)];
  if (known != 0) return known;
  // What a type is made of is declared before it.
  const auto vector = [&](Kind component, uint32_t width) {
    const uint32_t of = type(component);
    declarations.op(spv::OpTypeVector, known = newId(), of, width);
  };
  const auto image = [&](spv::Dim dim, bool depth = false, bool arrayed = false) {
    const uint32_t texel = type(Kind::Float);
    constexpr uint32_t kNo = 0;
    constexpr uint32_t kWithSampler = 1;
    declarations.op(spv::OpTypeImage, known = newId(), texel, dim, depth ? 1U : kNo, arrayed ? 1U : kNo, kNo,
                    kWithSampler, spv::ImageFormatUnknown);
  };
  const auto wrap = [&](spv::Op opcode, Kind inner) {
    const uint32_t of = type(inner);
    declarations.op(opcode, known = newId(), of);
  };
  switch (kind) {
    case Kind::Void: declarations.op(spv::OpTypeVoid, known = newId()); break;
    case Kind::Bool: declarations.op(spv::OpTypeBool, known = newId()); break;
    case Kind::Int: declarations.op(spv::OpTypeInt, known = newId(), 32, 1); break;
    case Kind::UInt: declarations.op(spv::OpTypeInt, known = newId(), 32, 0); break;
    case Kind::Int2: vector(Kind::Int, 2); break;
    case Kind::Int3: vector(Kind::Int, 3); break;
    case Kind::Int4: vector(Kind::Int, 4); break;
    case Kind::UInt2: vector(Kind::UInt, 2); break;
    case Kind::UInt3: vector(Kind::UInt, 3); break;
    case Kind::UInt4: vector(Kind::UInt, 4); break;
    case Kind::Float: declarations.op(spv::OpTypeFloat, known = newId(), 32); break;
    case Kind::Vec2: vector(Kind::Float, 2); break;
    case Kind::Vec3: vector(Kind::Float, 3); break;
    case Kind::Vec4: vector(Kind::Float, 4); break;
    case Kind::Half: declarations.op(spv::OpTypeFloat, known = newId(), 16); break;
    case Kind::HalfVec2: vector(Kind::Half, 2); break;
    case Kind::HalfVec3: vector(Kind::Half, 3); break;
    case Kind::HalfVec4: vector(Kind::Half, 4); break;
    case Kind::Bool2: vector(Kind::Bool, 2); break;
    case Kind::Bool3: vector(Kind::Bool, 3); break;
    case Kind::Bool4: vector(Kind::Bool, 4); break;
    case Kind::Mat4: {
      const uint32_t column = type(Kind::Vec4);
      declarations.op(spv::OpTypeMatrix, known = newId(), column, 4);
      break;
    }
    case Kind::Image2D: image(spv::Dim2D); break;
    case Kind::ImageCube: image(spv::DimCube); break;
    case Kind::ImageShadow: image(spv::Dim2D, true); break;
    case Kind::ImageArray: image(spv::Dim2D, false, true); break;
    case Kind::Image3D: image(spv::Dim3D); break;
    case Kind::SampledShadow: wrap(spv::OpTypeSampledImage, Kind::ImageShadow); break;
    case Kind::SampledArray: wrap(spv::OpTypeSampledImage, Kind::ImageArray); break;
    case Kind::Sampled3D: wrap(spv::OpTypeSampledImage, Kind::Image3D); break;
    case Kind::Sampled2D: wrap(spv::OpTypeSampledImage, Kind::Image2D); break;
    case Kind::SampledCube: wrap(spv::OpTypeSampledImage, Kind::ImageCube); break;
    case Kind::Main: wrap(spv::OpTypeFunction, Kind::Void); break;
  }
  return known;
}

uint32_t Globals::pointer(spv::StorageClass storage, Kind kind) {
  const auto own = static_cast<size_t>(storage);
  const size_t row = storage == spv::StorageClassStorageBuffer ? pointers_.size() - 1 : own;
  uint32_t& known = pointers_.at(row)[static_cast<size_t>(kind)];
  if (known != 0) return known;
  const uint32_t to = type(kind);
  declarations.op(spv::OpTypePointer, known = newId(), storage, to);
  return known;
}

uint32_t Globals::boolean(bool b) {
  uint32_t& known = booleans_[b ? 1 : 0];
  if (known != 0) return known;
  const uint32_t of = type(Kind::Bool);
  declarations.op(b ? spv::OpConstantTrue : spv::OpConstantFalse, of, known = newId());
  return known;
}

uint32_t Globals::integer(int32_t i) {
  return constant(spv::OpConstant, type(Kind::Int), {static_cast<uint32_t>(i)}, 1);
}

uint32_t Globals::uinteger(uint32_t i) { return constant(spv::OpConstant, type(Kind::UInt), {i}, 1); }

uint32_t Globals::number(double x) {
  assert(!std::isnan(x));
  constexpr double kLargest = std::numeric_limits<float>::max();
  const auto rounded = static_cast<float>(std::clamp(x, -kLargest, kLargest));
  return constant(spv::OpConstant, type(Kind::Float), {std::bit_cast<uint32_t>(rounded)}, 1);
}

uint32_t Globals::vector(ir::Type type, const double* components) {
  const auto count = static_cast<size_t>(ir::componentCount(type));
  std::array<uint32_t, 4> ids{};
  for (size_t i = 0; i < count; ++i) ids[i] = number(components[i]);
  return constant(spv::OpConstantComposite, this->type(type), ids, count);
}

uint32_t Globals::splat(ir::Type type, double x) {
  const std::array<double, 4> components = {x, x, x, x};
  return vector(type, components.data());
}

uint32_t Globals::half(ir::Type type, const double* components) {
  const auto count = static_cast<size_t>(ir::componentCount(type));
  std::array<uint32_t, 4> ids{};
  for (size_t i = 0; i < count; ++i)
    ids[i] = constant(spv::OpConstant, this->type(Kind::Half), {halfBits(components[i])}, 1);
  return count == 1 ? ids[0] : constant(spv::OpConstantComposite, this->type(halfKindOf(type)), ids, count);
}

uint32_t Globals::specNumber(uint32_t spec_id, double x) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  const auto rounded = static_cast<float>(std::clamp(x, -kLargest, kLargest));
  const uint32_t of = type(Kind::Float);
  const uint32_t id = newId();
  declarations.op(spv::OpSpecConstant, of, id, std::bit_cast<uint32_t>(rounded));
  decorations.op(spv::OpDecorate, id, spv::DecorationSpecId, spec_id);
  return id;
}

uint32_t Globals::specWhole(uint32_t spec_id, ir::Type whole, double x) {
  const uint32_t of = type(whole);
  const uint32_t id = newId();
  declarations.op(spv::OpSpecConstant, of, id, ir::bitsOf(x, whole == ir::Type::Int));
  decorations.op(spv::OpDecorate, id, spv::DecorationSpecId, spec_id);
  return id;
}

uint32_t Globals::specBoolean(uint32_t spec_id, bool b) {
  const uint32_t of = type(Kind::Bool);
  const uint32_t id = newId();
  declarations.op(b ? spv::OpSpecConstantTrue : spv::OpSpecConstantFalse, of, id);
  decorations.op(spv::OpDecorate, id, spv::DecorationSpecId, spec_id);
  return id;
}

uint32_t Globals::specVector(ir::Type type, const uint32_t* components) {
  const uint32_t of = this->type(type);
  const uint32_t id = newId();
  declarations.begin(spv::OpSpecConstantComposite);
  declarations.word(of);
  declarations.word(id);
  for (int i = 0; i < ir::componentCount(type); ++i) declarations.word(components[i]);
  declarations.end();
  return id;
}

uint32_t Globals::constant(spv::Op opcode, uint32_t type, const std::array<uint32_t, 4>& words,
                           size_t count) {
  if (constants_used_ * 2 >= constants_.size()) growConstants();
  Constant key{type, words, 0};
  const size_t slot = slotOf(key);
  if (constants_[slot].id != 0) return constants_[slot].id;
  key.id = newId();
  constants_[slot] = key;
  ++constants_used_;
  declarations.begin(opcode);
  declarations.word(type);
  declarations.word(key.id);
  for (size_t i = 0; i < count; ++i) declarations.word(words[i]);
  declarations.end();
  return key.id;
}

/// Where the constant stands, or the empty slot where it belongs.
size_t Globals::slotOf(const Constant& key) const {
  uint64_t hash = key.type;
  for (const uint32_t word : key.words) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 32;
  }
  size_t slot = hash & (constants_.size() - 1);
  while (constants_[slot].id != 0 && !constants_[slot].same(key)) slot = (slot + 1) & (constants_.size() - 1);
  return slot;
}

void Globals::growConstants() {
  std::vector<Constant> old(constants_.size() * 2);
  old.swap(constants_);
  for (const Constant& c : old) {
    if (c.id != 0) constants_[slotOf(c)] = c;
  }
}

uint32_t Globals::glslSet() {
  if (glsl_set_ == 0) glsl_set_ = newId();
  return glsl_set_;
}

uint32_t Globals::string(std::string_view text) {
  const uint32_t id = newId();
  strings.begin(spv::OpString);
  strings.word(id);
  strings.text(text);
  strings.end();
  return id;
}

void Globals::name(uint32_t id, std::string_view text) {
  names.begin(spv::OpName);
  names.word(id);
  names.text(text);
  names.end();
}

void Globals::memberName(uint32_t type, uint32_t member, std::string_view text) {
  names.begin(spv::OpMemberName);
  names.word(type);
  names.word(member);
  names.text(text);
  names.end();
}

}  // namespace lacquer::targets::spirv
