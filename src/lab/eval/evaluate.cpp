#include "eval/evaluate.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <type_traits>

#include "eval/rough.h"
#include "ir/whole.h"

namespace lacquer::eval {

namespace {

// ops.def's fold column calls these.
using ir::bits;
using ir::int_below;
using ir::int_number;
using ir::int_of;
using ir::int_quotient;
using ir::int_shifted;
using ir::Op;
using ir::uint_number;
using ir::uint_of;
using ir::uint_quotient;
using ir::whole;

/// To the nearest half-precision number, ties to even: 11 bits, subnormal numbers below 2^-14, infinite from
/// 65520.
float roundedToHalf(float x) {
  const float magnitude = std::abs(x);
  if (!(magnitude < 65520.0F)) return std::isnan(x) ? x : std::copysign(INFINITY, x);
  if (magnitude < 0x1p-14F) return std::rint(x * 0x1p24F) * 0x1p-24F;
  auto bits = std::bit_cast<uint32_t>(x);
  bits += 0xFFFU + ((bits >> 13) & 1U);
  return std::bit_cast<float>(bits & ~0x1FFFU);
}

/// What becomes of a number from outside, and of an operation's result.
struct Exactly {
  template <class T>
  T input(T x) const {
    return x;
  }
  template <class T>
  T operator()(Op, T, T, T x) const {
    return x;
  }
};

/// Float operations rounded to half are the half operations: float has more than twice the bits (Figueroa
/// 1995).
struct ToHalf {
  float input(float x) const { return roundedToHalf(x); }
  float operator()(Op, float, float, float x) const { return roundedToHalf(x); }
};

/// Half precision for what is relaxed, nothing else rounded.
struct WhereRelaxed {
  Halves halves;
  bool half = false;  ///< of the instruction at work
  double input(double x) const { return x; }
  double operator()(Op, double, double, double x) { return half ? halves(x) : x; }
};

/// One component-wise op over the lanes. `b` and `c` are any readable array where the op has fewer operands.
/// `out` may be one of the operands.
template <class T, class Rounding>
void mapLanes(Op op, const T* pa, const T* pb, const T* pc, T* out, size_t lanes, Rounding& rounding) {
  switch (op) {
#define OP(e, name, arity, signature, glsl, hlsl, set, inst, fold, prose) \
  case Op::e:                                                             \
    for (size_t i = 0; i < lanes; ++i) {                                  \
      [[maybe_unused]] const T a = pa[i];                                 \
      [[maybe_unused]] const T b = pb[i];                                 \
      [[maybe_unused]] const T c = pc[i];                                 \
      out[i] = rounding(Op::e, a, b, static_cast<T>(fold));               \
    }                                                                     \
    return;
#include "ir/ops.def"
#undef OP
  }
}

template <class T, class Rounding = Exactly>
class Machine {
public:
  Machine(const Program& program, const Bindings& bindings, size_t points, Rounding rounding = Rounding())
      : program_(program),
        bindings_(bindings),
        points_(points),
        rounding_(rounding),
        registers_(program.registers * kBatch) {
    for (const std::string& name : program.columns) columns_.push_back(column(name));
    for (const std::string& name : program.textures)
      samplers_.push_back(&bindings.textures.find(name)->second);
    for (const Columns& light : bindings.lights) {
      for (const std::string& name : program.light_fields) {
        const auto it = light.find(name);
        light_columns_.push_back(it == light.end() ? nullptr : &it->second);
      }
    }
  }

  std::vector<std::vector<T>> run() {
    std::vector<std::vector<T>> results;
    for (const auto& components : program_.results) results.emplace_back(points_ * components.size());
    lanes_ = std::min(points_, kBatch);
    for (const Instruction& instruction : program_.uniform) execute(instruction);
    for (first_ = 0; first_ < points_; first_ += kBatch) {
      lanes_ = std::min(points_ - first_, kBatch);
      body();
      for (size_t r = 0; r < results.size(); ++r) store(program_.results[r], program_.types[r], results[r]);
    }
    return results;
  }

private:
  const Column* column(const std::string& name) const {
    const auto it = bindings_.columns.find(name);
    if (it != bindings_.columns.end()) return &it->second;
    for (const auto& [known, value] : program_.defaults) {
      if (known == name) return &value;
    }
    assert(false && "compiled for other bindings");
    return nullptr;
  }

  T* at(Register r) { return registers_.data() + r * kBatch; }

  void store(const std::vector<Register>& components, ir::Type part, std::vector<T>& result) {
    const auto number = [part](T x) {
      if (part == ir::Type::Int) return int_number<T>(bits(x));
      return part == ir::Type::UInt ? uint_number<T>(bits(x)) : x;
    };
    for (size_t c = 0; c < components.size(); ++c) {
      const T* from = at(components[c]);
      for (size_t i = 0; i < lanes_; ++i) result[(first_ + i) * components.size() + c] = number(from[i]);
    }
  }

  void body() {
    size_t begin = 0;
    size_t last = 0;
    std::vector<std::pair<size_t, int32_t>> rounds;  // of the open loops: where they begin, and the round
    for (size_t i = 0; i < program_.body.size(); ++i) {
      const Instruction& instruction = program_.body[i];
      if (instruction.step == Step::LoopBegin) {
        const ir::LightGroup& group = program_.light_groups[instruction.payload];
        begin = i;
        light_ = static_cast<size_t>(group.first);
        first_listed_ = lights_listed_ = nullptr;
        if (group.count == ir::LightGroup::kListed) {
          first_listed_ = at(instruction.args[0]);
          lights_listed_ = at(instruction.args[1]);
          last = 0;
          for (size_t k = 0; k < lanes_; ++k) last = std::max(last, countOf(lights_listed_[k]));
        } else {
          last = group.count == ir::LightGroup::kCounted ? bindings_.lights.size()
                                                         : light_ + static_cast<size_t>(group.count);
        }
        if (light_ >= last) {
          while (program_.body[i].step != Step::LoopEnd) ++i;
        }
      } else if (instruction.step == Step::LoopEnd) {
        if (++light_ < last) i = begin;
      } else if (instruction.step == Step::RoundsBegin) {
        rounds.push_back({i, instruction.element});
        if (!setRound(instruction.outs[0], instruction.args[0], instruction, rounds.back().second)) {
          rounds.pop_back();
          for (size_t depth = 1; depth != 0;) {
            const Step step = program_.body[++i].step;
            depth += step == Step::RoundsBegin ? 1 : 0;
            depth -= step == Step::RoundsEnd ? 1 : 0;
          }
        }
      } else if (instruction.step == Step::RoundsEnd) {
        auto& [first, round] = rounds.back();
        if (setRound(instruction.args[0], instruction.args[1], instruction, ++round))
          i = first;
        else
          rounds.pop_back();
      } else {
        execute(instruction);
      }
    }
  }

  /// Begins a round; false where no point has it.
  bool setRound(Register index, Register end, const Instruction& loop, int32_t round) {
    if (static_cast<int64_t>(round) - loop.element >= static_cast<int64_t>(loop.payload)) return false;
    const T* ends = at(end);
    bool runs = false;
    for (size_t i = 0; i < lanes_; ++i) runs = runs || round < static_cast<int32_t>(bits(ends[i]));
    std::fill_n(at(index), lanes_, whole<T>(static_cast<uint32_t>(round)));
    return runs;
  }

  /// A number from outside as a register has it.
  T taken(const Instruction& instruction, double x) {
    return instruction.whole ? integer(x) : rounding_.input(static_cast<T>(x));
  }
  /// An integer of either kind.
  static T integer(double x) { return whole<T>(x < 0 ? int_of(x) : uint_of(x)); }

  void load(const Column& from, const Instruction& instruction) {
    T* out = at(instruction.outs[0]);
    const auto stride = static_cast<size_t>(from.components);
    const double* source = from.values.data() + instruction.component;
    if (from.per_point) {
      for (size_t i = 0; i < lanes_; ++i) out[i] = taken(instruction, source[(first_ + i) * stride]);
    } else {
      std::fill(out, out + lanes_, taken(instruction, *source));
    }
  }

  /// An Int that counts; 0 where it is negative.
  static size_t countOf(T number) {
    return static_cast<size_t>(std::max(static_cast<int32_t>(bits(number)), 0));
  }
  /// Turns that are not a point's own look at the nearest element, and nobody looks at them.
  static size_t elementOf(T number, size_t count) { return std::min(countOf(number), count - 1); }

  void listedLight(const Instruction& instruction) {
    T* out = at(instruction.outs[0]);
    const T* number = at(instruction.args[0]);
    const size_t lights = bindings_.lights.size();
    for (size_t i = 0; i < lanes_; ++i) {
      if (lights == 0) {
        out[i] = 0;
        continue;
      }
      const size_t light = elementOf(number[i], lights);
      const Column& from = *light_columns_[light * program_.light_fields.size() + instruction.payload];
      const size_t row = from.per_point ? first_ + i : 0;
      const size_t place = row * static_cast<size_t>(from.components) + instruction.component;
      out[i] = rounding_.input(static_cast<T>(from.values[place]));
    }
  }

  void texture(const Instruction& instruction) {
    const Sampler& sampler = *samplers_[instruction.payload];
    for (size_t i = 0; i < lanes_; ++i) {
      std::array<double, 3> coordinate{};
      for (size_t c = 0; c < 3; ++c) {
        if (instruction.args[c] != kNoRegister)
          coordinate[c] = static_cast<double>(at(instruction.args[c])[i]);
      }
      const double lod =
          instruction.args[3] == kNoRegister ? 0 : static_cast<double>(at(instruction.args[3])[i]);
      const std::array<double, 4> texel = sampler(first_ + i, coordinate, lod);
      for (size_t c = 0; c < 4; ++c) at(instruction.outs[c])[i] = rounding_.input(static_cast<T>(texel[c]));
    }
  }

  /// Of a level that is not there: 0.
  void textureSize(const Instruction& instruction) {
    const std::array<int, 3>& size = samplers_[instruction.payload]->size;
    const int longest = std::max(size[0], size[1]);
    for (size_t i = 0; i < lanes_; ++i) {
      const auto level = static_cast<int32_t>(bits(at(instruction.args[0])[i]));
      const bool there = level >= 0 && level < 31 && longest >> level > 0;
      // An array has its layers at every level.
      const int along = size.at(instruction.component);
      const int texels = instruction.component == 2 || !there ? along : std::max(along >> level, 1);
      at(instruction.outs[0])[i] = whole<T>(static_cast<uint32_t>(there ? texels : 0));
    }
  }

  /// `step` is 1 along x and 2 along y. A quad that the last points do not fill has no neighbours there.
  void derivative(const Instruction& instruction, size_t step) {
    const T* a = at(instruction.args[0]);
    T* out = at(instruction.outs[0]);
    for (size_t quad = 0; quad < lanes_; quad += 4) {
      std::array<T, 4> in{};
      for (size_t k = 0; k < 4; ++k) in[k] = a[std::min(quad + k, lanes_ - 1)];
      for (size_t k = 0; k < 4 && quad + k < lanes_; ++k)
        out[quad + k] = rounding_(Op::Sub, in[k | step], in[k & ~step], in[k | step] - in[k & ~step]);
    }
  }

  void execute(const Instruction& instruction) {
    const auto arg = [&](size_t k) {
      const Register r = instruction.args[k];
      return at(r == kNoRegister ? instruction.args[0] : r);
    };
    const Register out = instruction.outs[0];
    switch (instruction.step) {
      case Step::Map:
        if constexpr (std::is_same_v<Rounding, WhereRelaxed>) {
          if (instruction.half) return relaxed(instruction);
        }
        if (instruction.whole) {
          Exactly exactly;
          mapLanes(instruction.op, arg(0), arg(1), arg(2), at(out), lanes_, exactly);
          if constexpr (std::is_same_v<Rounding, Rough>) converted(instruction);
          return;
        }
        if constexpr (std::is_same_v<Rounding, Rough>) rounding_.fuses = instruction.fuses;
        return mapLanes(instruction.op, arg(0), arg(1), arg(2), at(out), lanes_, rounding_);
      case Step::Literal:
        return static_cast<void>(
            std::fill_n(at(out), lanes_, taken(instruction, program_.literals[instruction.payload])));
      case Step::Load: return load(*columns_[instruction.payload], instruction);
      case Step::Light: {
        const size_t light = instruction.element >= 0 ? static_cast<size_t>(instruction.element) : light_;
        return load(*light_columns_[light * program_.light_fields.size() + instruction.payload], instruction);
      }
      case Step::LightIndex:
        for (size_t i = 0; i < lanes_; ++i)
          at(out)[i] = whole<T>(static_cast<uint32_t>(light_) +
                                (first_listed_ == nullptr ? 0U : bits(first_listed_[i])));
        return;
      case Step::ListedLight: return listedLight(instruction);
      case Step::Listed: {
        const std::vector<double>& list = program_.lists[instruction.payload];
        for (size_t i = 0; i < lanes_; ++i)
          at(out)[i] = integer(list.empty() ? 0.0 : list[elementOf(arg(0)[i], list.size())]);
        return;
      }
      case Step::AddListed:
        for (size_t i = 0; i < lanes_; ++i) {
          if (light_ >= countOf(lights_listed_[i])) continue;
          const T sum = arg(0)[i] + arg(1)[i];
          at(out)[i] = rounding_(Op::Add, arg(0)[i], arg(1)[i], sum);
        }
        return;
      case Step::Copy: return static_cast<void>(std::copy_n(arg(0), lanes_, at(out)));
      case Step::Keep:
        for (size_t i = 0; i < lanes_; ++i) {
          if (ir::int_below(bits(arg(1)[i]), bits(arg(2)[i]))) at(out)[i] = arg(0)[i];
        }
        return;
      case Step::Texture: return texture(instruction);
      case Step::TextureSize: return textureSize(instruction);
      case Step::DerivativeX: return derivative(instruction, 1);
      case Step::DerivativeY: return derivative(instruction, 2);
      case Step::LoopBegin:
      case Step::LoopEnd:
      case Step::RoundsBegin:
      case Step::RoundsEnd: return;
    }
  }

  /// A number beyond the integers' range becomes any integer: Vulkan leaves the conversion open, and devices
  /// differ.
  void converted(const Instruction& instruction) {
    if (instruction.op != Op::ToInt && instruction.op != Op::ToUInt) return;
    const double least = instruction.op == Op::ToInt ? -0x1p31 : 0;
    const double end = instruction.op == Op::ToInt ? 0x1p31 : 0x1p32;
    const T* from = at(instruction.args[0]);
    for (size_t i = 0; i < lanes_; ++i) {
      const bool representable = std::trunc(from[i]) >= least && from[i] < end;
      if (!representable) at(instruction.outs[0])[i] = whole<T>(rounding_.anything());
    }
  }

  /// The operands are rounded, too.
  void relaxed(const Instruction& instruction) {
    std::array<std::array<T, kBatch>, 3> operands{};
    for (size_t k = 0; k < operands.size(); ++k) {
      const Register r = instruction.args[k];
      const T* from = at(r == kNoRegister ? instruction.args[0] : r);
      for (size_t i = 0; i < lanes_; ++i) operands[k][i] = rounding_.halves(from[i]);
    }
    rounding_.half = true;
    mapLanes(instruction.op, operands[0].data(), operands[1].data(), operands[2].data(),
             at(instruction.outs[0]), lanes_, rounding_);
    rounding_.half = false;
  }

  const Program& program_;
  const Bindings& bindings_;
  size_t points_;
  Rounding rounding_;
  std::vector<T> registers_;
  std::vector<const Column*> columns_, light_columns_;
  std::vector<const Sampler*> samplers_;
  size_t first_ = 0, lanes_ = 0, light_ = 0;
  const T* first_listed_ = nullptr;   ///< of a loop over listed lights: the first place of each point
  const T* lights_listed_ = nullptr;  ///< and how many there are
};

}  // namespace

template <class T>
std::vector<std::vector<T>> run(const Program& program, const Bindings& bindings, size_t points) {
  return Machine<T>(program, bindings, points).run();
}

std::vector<std::vector<float>> runHalf(const Program& program, const Bindings& bindings, size_t points) {
  return Machine<float, ToHalf>(program, bindings, points).run();
}

std::vector<std::vector<double>> runRough(const Program& program, const Bindings& bindings, size_t points,
                                          uint64_t seed) {
  return Machine<double, Rough>(program, bindings, points, Rough(seed)).run();
}

std::vector<std::vector<double>> runRelaxed(const Program& program, const Bindings& bindings, size_t points,
                                            uint64_t seed) {
  return Machine<double, WhereRelaxed>(program, bindings, points, {Halves(seed)}).run();
}

template <class T>
Result<std::vector<std::vector<T>>> evaluate(const ir::Module& module, std::span<const ir::ValueId> roots,
                                             const Bindings& bindings, size_t points) {
  const Result<Program> program = compile(module, roots, bindings, points);
  if (!program) return tl::make_unexpected(program.error());
  return run<T>(*program, bindings, points);
}

template std::vector<std::vector<float>> run(const Program&, const Bindings&, size_t);
template std::vector<std::vector<double>> run(const Program&, const Bindings&, size_t);
template Result<std::vector<std::vector<float>>> evaluate(const ir::Module&, std::span<const ir::ValueId>,
                                                          const Bindings&, size_t);
template Result<std::vector<std::vector<double>>> evaluate(const ir::Module&, std::span<const ir::ValueId>,
                                                           const Bindings&, size_t);

}  // namespace lacquer::eval
