// The preshader of a module by itself: the values of the material block's fields from those of the
// parameters, without the module. Small enough to keep for every structure, and to write to a cache.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "ir/module.h"
#include "support/blob.h"

namespace lacquer {

template <>
struct LastEnumerator<ir::Op> {
  static constexpr ir::Op value = static_cast<ir::Op>(0
#define OP(e, name, arity, signature, glsl, hlsl, set, inst, fold, prose) +1
#include "ir/ops.def"
#undef OP
                                                      - 1);
};
template <>
struct LastEnumerator<ir::Type> {
  static constexpr ir::Type value = ir::Type::Vec4;
};

/// The number that a parameter is packed with where it is given `x` (docs/parameters.md): the nearest one of
/// its range that fits a float, and `otherwise` where `x` is no number. Of a bool 0 or 1.
double packedNumber(const ir::Parameter& parameter, double x, double otherwise);
/// The numbers that a parameter is packed with: "[0, 1]", "[1, 1e+09] or 0", "0 or 1".
std::string packedRangeText(const ir::Parameter& parameter);

class Preshader {
public:
  struct Field {
    std::string name;
    ir::Type type;
    uint32_t offset;  ///< bytes in the block
    uint32_t value;   ///< step that gives it
  };

  Preshader() = default;
  /// Of a placed module.
  explicit Preshader(const ir::Module& module);

  /// In the order of the module's Preshader list.
  const std::vector<Field>& fields() const { return fields_; }

  /// The fields' values, for the parameters' values in the order of Module::parameters. All of them fit a
  /// float: one beyond the largest becomes that, with its sign, and one that is no number becomes 0, as does
  /// -0. Every node's contract excludes both within its ranges.
  std::vector<ir::Components> evaluate(
      const std::function<const ir::Components&(uint32_t parameter)>& value) const;

  /// Bytes of the material's block; 0 where there is none.
  uint32_t blockSize() const { return size_; }
  /// Writes evaluate()'s values as floats into a block of so many bytes, and zeros between them.
  void write(std::span<const ir::Components> values, std::span<std::byte> block) const;

  /// True when it asks for no parameter but the first so many.
  bool uses(size_t parameters) const;

private:
  struct Step {
    ir::Op op;
    ir::Type type;
    uint8_t count;
    uint32_t payload;  ///< Constant: into constants_; Input: the parameter; Swizzle: as in the DAG
    std::array<uint32_t, 4> args;
  };

  template <class Archive>
  friend void fields(Archive& archive, Step& s) {
    archive(s.op, s.type, s.count, s.payload, s.args);
  }
  template <class Archive>
  friend void fields(Archive& archive, Field& f) {
    archive(f.name, f.type, f.offset, f.value);
  }
  /// For the cache.
  template <class Archive>
  friend void fields(Archive& archive, Preshader& p) {
    archive(p.steps_, p.constants_, p.fields_, p.size_);
    // A reader refuses what evaluate() could not take.
    if constexpr (requires { archive.refuse(); }) {
      if (!p.sound()) archive.refuse();
    }
  }
  bool sound() const;
  bool sound(const Step& step, size_t number) const;

  std::vector<Step> steps_;
  std::vector<ir::Components> constants_;
  std::vector<Field> fields_;
  uint32_t size_ = 0;
};

}  // namespace lacquer
