// What stands before the function of a module: ids, names, decorations, and each type and each constant once.
#pragma once

#include <array>
#include <vector>

#include "ir/types.h"
#include "targets/spirv/words.h"

namespace lacquer::targets::spirv {

/// The types that a shader of ours can have, besides the blocks' structures.
enum class Kind : uint8_t {
  Void,
  Bool,
  Int,
  UInt,
  Int2,
  Int3,
  Int4,
  UInt2,
  UInt3,
  UInt4,
  Float,
  Vec2,
  Vec3,
  Vec4,
  Half,
  HalfVec2,
  HalfVec3,
  HalfVec4,
  Bool2,
  Bool3,
  Bool4,
  Mat4,
  Image2D,
  ImageCube,
  ImageShadow,
  ImageArray,
  Image3D,
  Sampled2D,
  SampledCube,
  SampledShadow,
  SampledArray,
  Sampled3D,
  Main,  ///< of the entry point: void()
};
inline constexpr size_t kKinds = static_cast<size_t>(Kind::Main) + 1;

Kind kindOf(ir::Type type);

/// Of 16 bits, beside a Float or a vector of them.
Kind halfKindOf(ir::Type type);

/// The image that a texture's type has beside a sampler.
Kind imageKindOf(ir::Type texture);

/// The Bool type with as many components as a float type has.
Kind boolKind(ir::Type like);

class Globals {
public:
  // The sections of a module, in the order that the specification prescribes.
  Words strings, names, decorations, declarations;

  Globals();

  uint32_t newId() { return next_id_++; }
  uint32_t bound() const { return next_id_; }

  uint32_t type(Kind kind);
  uint32_t type(ir::Type type) { return this->type(kindOf(type)); }
  uint32_t pointer(spv::StorageClass storage, Kind kind);

  uint32_t boolean(bool b);
  uint32_t integer(int32_t i);
  uint32_t uinteger(uint32_t i);
  /// The float nearest to x; beyond the range of float, the largest.
  uint32_t number(double x);
  /// `components` holds at least as many as the type has.
  uint32_t vector(ir::Type type, const double* components);
  uint32_t splat(ir::Type type, double x);

  /// The same of 16 bits.
  uint32_t half(ir::Type type, const double* components);
  bool halvesUsed() const { return types_[static_cast<size_t>(Kind::Half)] != 0; }

  /// A specialization constant of its own, with what it is until the pipeline says otherwise.
  uint32_t specNumber(uint32_t spec_id, double x);
  uint32_t specWhole(uint32_t spec_id, ir::Type whole, double x);
  uint32_t specBoolean(uint32_t spec_id, bool b);
  uint32_t specVector(ir::Type type, const uint32_t* components);

  /// The GLSL.std.450 instruction set; imported when it is first asked for.
  uint32_t glslSet();
  bool importsGlsl() const { return glsl_set_ != 0; }

  /// The module asks for the sizes of images, which is a capability.
  void asksForSizes() { sizes_ = true; }
  bool sizesAsked() const { return sizes_; }

  /// It has arrays of textures from which each fragment may take another one; `endless`: of any length.
  void asksForArrays(bool endless) { arrays_ = true, endless_ = endless; }
  bool arraysAsked() const { return arrays_; }
  bool endlessAsked() const { return endless_; }

  /// A string for OpLine.
  uint32_t string(std::string_view text);
  void name(uint32_t id, std::string_view text);
  void memberName(uint32_t type, uint32_t member, std::string_view text);

private:
  struct Constant {
    uint32_t type = 0;
    std::array<uint32_t, 4> words{};
    uint32_t id = 0;
    bool same(const Constant& other) const { return type == other.type && words == other.words; }
  };

  uint32_t constant(spv::Op opcode, uint32_t type, const std::array<uint32_t, 4>& words, size_t count);
  size_t slotOf(const Constant& key) const;
  void growConstants();

  uint32_t next_id_ = 1;
  uint32_t glsl_set_ = 0;
  bool sizes_ = false, arrays_ = false, endless_ = false;
  std::array<uint32_t, kKinds> types_{};
  /// The storage classes in use are 0 to 3, and that of storage buffers, which is put at 4.
  std::array<std::array<uint32_t, kKinds>, 5> pointers_{};
  std::array<uint32_t, 2> booleans_{};
  std::vector<Constant> constants_;  ///< open addressing; a power of two
  size_t constants_used_ = 0;
};

}  // namespace lacquer::targets::spirv
