#include "spirv/interpreter.h"

#include <spirv/unified1/GLSL.std.450.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <spirv/unified1/spirv.hpp>
#include <stdexcept>

namespace lacquer::spirv_test {
namespace {

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

struct DeclaredType {
  spv::Op op = spv::OpNop;
  uint32_t element = 0;  ///< of vectors, matrices, arrays, pointers
  uint32_t count = 1;
  std::vector<uint32_t> members;
};

struct Variable {
  uint32_t set = 0, binding = 0;
  std::string name;
};

struct Pointer {
  uint32_t variable = 0;
  uint32_t offset = 0;
  uint32_t type = 0;
};

struct Instruction {
  spv::Op op;
  const uint32_t* args;
  size_t count;
};

double componentwise(uint32_t code, double a, double b, double c) {
  switch (code) {
    case GLSLstd450FAbs: return std::abs(a);
    case GLSLstd450FSign: return (a > 0) - (a < 0);
    case GLSLstd450Floor: return std::floor(a);
    case GLSLstd450Fract: return a - std::floor(a);
    case GLSLstd450Sqrt: return std::sqrt(a);
    case GLSLstd450InverseSqrt: return 1 / std::sqrt(a);
    case GLSLstd450Exp2: return std::exp2(a);
    case GLSLstd450Log2: return std::log2(a);
    case GLSLstd450Exp: return std::exp(a);
    case GLSLstd450Log: return std::log(a);
    case GLSLstd450Sin: return std::sin(a);
    case GLSLstd450Cos: return std::cos(a);
    case GLSLstd450Acos: return std::acos(a);
    case GLSLstd450FMin: return b < a ? b : a;
    case GLSLstd450FMax: return a < b ? b : a;
    case GLSLstd450Pow: return std::pow(a, b);
    case GLSLstd450Atan2: return std::atan2(a, b);
    case GLSLstd450Ceil: return std::ceil(a);
    case GLSLstd450RoundEven: return std::nearbyint(a);
    case GLSLstd450Trunc: return std::trunc(a);
    case GLSLstd450Asin: return std::asin(a);
    case GLSLstd450Tanh: return std::tanh(a);
    case GLSLstd450Fma: return a * b + c;
    case GLSLstd450FMix: return a * (1 - c) + b * c;
    case GLSLstd450FClamp: return a < b ? b : (c < a ? c : a);
    default: fail("GLSL.std.450 instruction " + std::to_string(code));
  }
}

double dotOf(const Cell& a, const Cell& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b.at(i);
  return sum;
}

class Machine {
public:
  Machine(const std::vector<uint32_t>& words, const World& world) : world_(world) {
    for (size_t at = 5; at < words.size();) {
      const uint32_t length = words[at] >> spv::WordCountShift;
      if (length == 0 || at + length > words.size()) fail("a broken length");
      code_.push_back({static_cast<spv::Op>(words[at] & spv::OpCodeMask), words.data() + at + 1, length - 1});
      at += length;
    }
    for (size_t i = 0; i < code_.size(); ++i) {
      if (code_[i].op == spv::OpLabel) labels_[code_[i].args[0]] = i;
    }
  }

  Outcome run() {
    size_t at = 0;
    for (; code_.at(at).op != spv::OpFunction; ++at) declare(code_[at]);
    for (++at; running_;) {
      if (++steps_ > 1'000'000) fail("a loop without end");
      at = step(at);
    }
    return std::move(outcome_);
  }

private:
  static std::string text(const uint32_t* words) {
    return reinterpret_cast<const char*>(words);  // little-endian machines only, which the tests run on
  }

  void declare(const Instruction& in) {
    const uint32_t* a = in.args;
    switch (in.op) {
      case spv::OpName: variables_[a[0]].name = text(a + 1); return;
      case spv::OpMemberDecorate:
        if (a[2] == spv::DecorationOffset) offsets_[{a[0], a[1]}] = a[3];
        return;
      case spv::OpDecorate:
        if (a[1] == spv::DecorationDescriptorSet) variables_[a[0]].set = a[2];
        if (a[1] == spv::DecorationBinding) variables_[a[0]].binding = a[2];
        if (a[1] == spv::DecorationArrayStride) strides_[a[0]] = a[2];
        return;
      case spv::OpTypeVector:
      case spv::OpTypeMatrix: types_[a[0]] = {in.op, a[1], a[2], {}}; return;
      case spv::OpTypePointer: types_[a[0]] = {in.op, a[2], 1, {}}; return;
      case spv::OpTypeArray: types_[a[0]] = {in.op, a[1], 1, {}}; return;
      case spv::OpTypeStruct: types_[a[0]] = {in.op, 0, 1, {a + 1, a + in.count}}; return;
      case spv::OpTypeBool:
      case spv::OpTypeInt:
      case spv::OpTypeFloat:
      case spv::OpTypeImage:
      case spv::OpTypeSampledImage: types_[a[0]] = {in.op, 0, 1, {}}; return;
      case spv::OpConstantTrue: cells_[a[1]] = {1}; return;
      case spv::OpConstantFalse: cells_[a[1]] = {0}; return;
      case spv::OpConstant: {
        const bool whole = types_.at(a[0]).op == spv::OpTypeInt;
        cells_[a[1]] = {whole ? number(a[2]) : double(std::bit_cast<float>(a[2]))};
        return;
      }
      case spv::OpConstantComposite: cells_[a[1]] = concat(a + 2, in.count - 2); return;
      case spv::OpVariable: pointers_[a[1]] = {a[1], 0, types_.at(a[0]).element}; return;
      default: return;  // nothing that a value depends on
    }
  }

  Cell concat(const uint32_t* ids, size_t count) const {
    Cell all;
    for (size_t i = 0; i < count; ++i) all.insert(all.end(), cell(ids[i]).begin(), cell(ids[i]).end());
    return all;
  }

  const Cell& cell(uint32_t id) const { return cells_.at(id); }
  double scalar(uint32_t id) const {
    if (cell(id).size() != 1) fail("a scalar is wanted");
    return cell(id)[0];
  }

  size_t jump(uint32_t label) {
    before_ = block_;
    return labels_.at(label);
  }

  size_t step(size_t at) {
    const Instruction& in = code_.at(at);
    const uint32_t* a = in.args;
    switch (in.op) {
      case spv::OpLabel: block_ = a[0]; return phis(at + 1);
      case spv::OpBranch: return jump(a[0]);
      case spv::OpBranchConditional: return jump(scalar(a[0]) != 0 ? a[1] : a[2]);
      case spv::OpKill: outcome_.dropped = true; [[fallthrough]];
      case spv::OpReturn: running_ = false; return at;
      case spv::OpVariable:  // a local one
        pointers_[a[1]] = {a[1], 0, types_.at(a[0]).element};
        locals_[a[1]] = Cell(types_.at(pointers_[a[1]].type).count);
        return at + 1;
      case spv::OpStore: store(pointers_.at(a[0]), cell(a[1])); return at + 1;
      case spv::OpAccessChain: pointers_[a[1]] = chain(in); return at + 1;
      case spv::OpLine:
      case spv::OpNoLine:
      case spv::OpLoopMerge:
      case spv::OpSelectionMerge: return at + 1;
      case spv::OpLoad: load(a[1], pointers_.at(a[2])); return at + 1;
      case spv::OpImage: textures_[a[1]] = textures_.at(a[2]); return at + 1;
      default: cells_[a[1]] = compute(in); return at + 1;
    }
  }

  /// All phis of a block read at once.
  size_t phis(size_t at) {
    std::map<uint32_t, Cell> fresh;
    for (; code_[at].op == spv::OpPhi; ++at) {
      const uint32_t* a = code_[at].args;
      bool found = false;
      for (size_t i = 2; i + 1 < code_[at].count; i += 2) {
        if (a[i + 1] != before_) continue;
        fresh[a[1]] = cell(a[i]);
        found = true;
      }
      if (!found) fail("a phi without its predecessor");
    }
    for (auto& [id, value] : fresh) cells_[id] = value;
    return at;
  }

  Pointer chain(const Instruction& in) {
    Pointer p = pointers_.at(in.args[2]);
    for (size_t i = 3; i < in.count; ++i) {
      const auto index = static_cast<uint32_t>(scalar(in.args[i]));
      const DeclaredType& type = types_.at(p.type);
      if (type.op == spv::OpTypeStruct) {
        const auto offset = offsets_.find({p.type, index});
        p.offset += offset == offsets_.end() ? 0 : offset->second;
        p.type = type.members.at(index);
      } else {
        constexpr uint32_t kColumn = 16;
        const uint32_t scalar = type.op == spv::OpTypeMatrix ? kColumn : 4;
        p.offset += index * (type.op == spv::OpTypeArray ? strides_.at(p.type) : scalar);
        p.type = type.element;
      }
    }
    return p;
  }

  void store(const Pointer& to, const Cell& value) {
    const auto local = locals_.find(to.variable);
    if (local != locals_.end()) {
      std::copy(value.begin(), value.end(), local->second.begin() + to.offset / 4);
      return;
    }
    // glslang's position is a member of a block without a name.
    const std::string& name = variables_[to.variable].name;
    outcome_.outputs[name.empty() ? "gl_Position" : name] = value;
  }

  void load(uint32_t id, const Pointer& from) {
    const auto take = [&](const Cell& whole) {
      const auto begin = whole.begin() + from.offset / 4;
      cells_[id] = Cell(begin, begin + types_.at(from.type).count);
    };
    if (const auto local = locals_.find(from.variable); local != locals_.end()) return take(local->second);
    const Variable& variable = variables_.at(from.variable);
    const DeclaredType& type = types_.at(from.type);
    if (type.op == spv::OpTypeSampledImage) {
      textures_[id] = from.variable;
      return;
    }
    if (const auto input = world_.inputs.find(variable.name); input != world_.inputs.end()) {
      take(input->second);
      return;
    }
    const std::vector<uint8_t>& bytes = world_.blocks.at({variable.set, variable.binding});
    const size_t count = type.op == spv::OpTypeMatrix ? 16 : type.count;
    Cell read(count);
    for (size_t i = 0; i < count; ++i) {
      uint32_t word = 0;
      if (from.offset + i * 4 + 4 > bytes.size()) fail("a read behind the block");
      std::memcpy(&word, bytes.data() + from.offset + i * 4, 4);
      read[i] = type.op == spv::OpTypeInt ? number(word) : double(std::bit_cast<float>(word));
    }
    cells_[id] = read;
  }

  Cell texel(uint32_t sampler, const Cell& at, double lod) const {
    const Variable& v = variables_.at(textures_.at(sampler));
    return world_.texel(v.set, v.binding, at, lod);
  }

  template <class F>
  Cell each(const uint32_t* ids, size_t count, const F& f) const {
    Cell result(cell(ids[0]).size());
    for (size_t k = 1; k < count; ++k) {
      if (cell(ids[k]).size() != result.size()) fail("operands of different widths");
    }
    for (size_t i = 0; i < result.size(); ++i) {
      const auto at = [&](size_t k) { return k < count ? cell(ids[k])[i] : 0.0; };
      result[i] = f(at(0), at(1), at(2));
    }
    return result;
  }

  /// An integer is the number of the signed one with its bits.
  static uint32_t word(double x) { return static_cast<uint32_t>(static_cast<int32_t>(x)); }
  static double number(uint32_t x) { return static_cast<int32_t>(x); }
  template <class F>
  Cell wholes(const uint32_t* ids, size_t count, const F& f) const {
    return each(ids, count, [&](double x, double y, double) { return number(f(word(x), word(y))); });
  }

  Cell compute(const Instruction& in) const {
    const uint32_t* a = in.args + 2;
    const size_t count = in.count - 2;
    switch (in.op) {
      case spv::OpExtInst: return extended(a[1], a + 2, count - 2);
      case spv::OpFNegate: return each(a, 1, [](double x, double, double) { return -x; });
      case spv::OpFAdd: return each(a, 2, [](double x, double y, double) { return x + y; });
      case spv::OpIAdd: return wholes(a, 2, [](uint32_t x, uint32_t y) { return x + y; });
      case spv::OpISub: return wholes(a, 2, [](uint32_t x, uint32_t y) { return x - y; });
      case spv::OpIMul: return wholes(a, 2, [](uint32_t x, uint32_t y) { return x * y; });
      case spv::OpSDiv:
        return wholes(a, 2, [](uint32_t x, uint32_t y) {
          return static_cast<uint32_t>(static_cast<int32_t>(x) / static_cast<int32_t>(y));
        });
      case spv::OpUDiv: return wholes(a, 2, [](uint32_t x, uint32_t y) { return x / y; });
      case spv::OpBitwiseAnd: return wholes(a, 2, [](uint32_t x, uint32_t y) { return x & y; });
      case spv::OpBitwiseOr: return wholes(a, 2, [](uint32_t x, uint32_t y) { return x | y; });
      case spv::OpBitwiseXor: return wholes(a, 2, [](uint32_t x, uint32_t y) { return x ^ y; });
      case spv::OpNot: return wholes(a, 1, [](uint32_t x, uint32_t) { return ~x; });
      case spv::OpShiftLeftLogical: return wholes(a, 2, [](uint32_t x, uint32_t y) { return x << y; });
      case spv::OpShiftRightLogical: return wholes(a, 2, [](uint32_t x, uint32_t y) { return x >> y; });
      case spv::OpShiftRightArithmetic:
        return wholes(
            a, 2, [](uint32_t x, uint32_t y) { return static_cast<uint32_t>(static_cast<int32_t>(x) >> y); });
      case spv::OpULessThan: return {double(word(scalar(a[0])) < word(scalar(a[1])))};
      case spv::OpBitcast: return cell(a[0]);
      case spv::OpConvertFToS: return each(a, 1, [](double x, double, double) { return std::trunc(x); });
      case spv::OpConvertFToU:
        return each(a, 1, [](double x, double, double) { return number(static_cast<uint32_t>(x)); });
      case spv::OpConvertSToF: return cell(a[0]);
      case spv::OpConvertUToF: return each(a, 1, [](double x, double, double) { return double(word(x)); });
      case spv::OpFSub: return each(a, 2, [](double x, double y, double) { return x - y; });
      case spv::OpFMul: return each(a, 2, [](double x, double y, double) { return x * y; });
      case spv::OpFDiv: return each(a, 2, [](double x, double y, double) { return x / y; });
      case spv::OpFOrdLessThan:
      case spv::OpSLessThan: return {double(scalar(a[0]) < scalar(a[1]))};
      case spv::OpFOrdLessThanEqual:
      case spv::OpSLessThanEqual: return {double(scalar(a[0]) <= scalar(a[1]))};
      case spv::OpFOrdEqual:
      case spv::OpIEqual: return {double(scalar(a[0]) == scalar(a[1]))};
      case spv::OpLogicalAnd: return {double(scalar(a[0]) != 0 && scalar(a[1]) != 0)};
      case spv::OpLogicalOr: return {double(scalar(a[0]) != 0 || scalar(a[1]) != 0)};
      case spv::OpLogicalNot: return {double(scalar(a[0]) == 0)};
      case spv::OpSelect: return each(a, 3, [](double c, double x, double y) { return c != 0 ? x : y; });
      case spv::OpDot: return {dotOf(cell(a[0]), cell(a[1]))};
      case spv::OpCompositeConstruct: return concat(a, count);
      case spv::OpCompositeExtract: return {cell(a[0]).at(a[1])};
      case spv::OpVectorShuffle: {
        const Cell both = concat(a, 2);
        Cell result;
        for (size_t i = 2; i < count; ++i) result.push_back(both.at(a[i]));
        return result;
      }
      case spv::OpVectorTimesScalar: {
        Cell result = cell(a[0]);
        for (double& x : result) x *= scalar(a[1]);
        return result;
      }
      case spv::OpMatrixTimesVector: {
        Cell result(4);
        for (size_t i = 0; i < 16; ++i) result[i % 4] += cell(a[0]).at(i) * cell(a[1]).at(i / 4);
        return result;
      }
      case spv::OpImageSampleImplicitLod: return texel(a[0], cell(a[1]), -1);
      case spv::OpImageSampleExplicitLod:
        // A made-up level tells the two derivatives apart.
        if (a[2] == spv::ImageOperandsGradMask)
          return texel(a[0], cell(a[1]), cell(a[3]).at(0) + 3 * cell(a[4]).at(1));
        return texel(a[0], cell(a[1]), scalar(a[3]));
      case spv::OpImageQuerySizeLod: {
        const Variable& v = variables_.at(textures_.at(a[0]));
        return world_.size(v.set, v.binding, scalar(a[1]));
      }
      // Derivatives of a flat picture would hide a mistake; these tell the two, and the value, apart.
      case spv::OpDPdx: return each(a, 1, [](double x, double, double) { return x * 0.5 + 1; });
      case spv::OpDPdy: return each(a, 1, [](double x, double, double) { return x * 0.25 + 2; });
      default: fail("opcode " + std::to_string(in.op));
    }
  }

  Cell extended(uint32_t code, const uint32_t* a, size_t count) const {
    if (code == GLSLstd450Length) return {std::sqrt(dotOf(cell(a[0]), cell(a[0])))};
    if (code == GLSLstd450Normalize) {
      const double length = std::sqrt(dotOf(cell(a[0]), cell(a[0])));
      return each(a, 1, [length](double x, double, double) { return x / length; });
    }
    if (code == GLSLstd450Cross) {
      const Cell& x = cell(a[0]);
      const Cell& y = cell(a[1]);
      return {x.at(1) * y.at(2) - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
    }
    return each(a, count, [code](double x, double y, double z) { return componentwise(code, x, y, z); });
  }

  const World& world_;
  std::vector<Instruction> code_;
  std::map<uint32_t, size_t> labels_;
  std::map<uint32_t, DeclaredType> types_;
  std::map<uint32_t, Variable> variables_;
  std::map<uint32_t, Pointer> pointers_;
  std::map<uint32_t, Cell> locals_;
  std::map<uint32_t, Cell> cells_;
  std::map<uint32_t, uint32_t> textures_;  ///< loaded samplers: their variables
  std::map<uint32_t, uint32_t> strides_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> offsets_;
  uint32_t block_ = 0, before_ = 0;
  bool running_ = true;
  int steps_ = 0;
  Outcome outcome_;
};

}  // namespace

Outcome interpret(const std::vector<uint32_t>& words, const World& world) {
  return Machine(words, world).run();
}

}  // namespace lacquer::spirv_test
