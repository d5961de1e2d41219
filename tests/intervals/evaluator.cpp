#include "intervals/evaluator.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "ir/fold.h"
#include "ir/loops.h"

namespace lacquer::test {

namespace {

using ir::Op;
using ir::ValueId;

class Evaluation {
public:
  Evaluation(const ir::Module& module, const World& world, std::vector<Floats>& values)
      : module_(module), dag_(module.dag), world_(world), values_(values) {}

  Floats value(ValueId id) const {
    const ir::Value& v = dag_[id];
    const Floats a = v.count > 0 ? values_[v.args[0]] : Floats{};
    const Floats b = v.count > 1 ? values_[v.args[1]] : Floats{};
    const int width = v.count > 0 ? std::min(ir::componentCount(dag_[v.args[0]].type), 4) : 0;
    switch (v.op) {
      case Op::Constant: {
        const ir::Components& c = dag_.constantOf(id);
        Floats out{};
        const bool whole = ir::isWhole(ir::partType(v.type));
        for (size_t i = 0; i < 4; ++i)
          out[i] = whole ? ir::whole<float>(ir::bits(c[i])) : static_cast<float>(c[i]);
        return spread(out, v.type);
      }
      case Op::Input: {
        Floats out = world_.input(dag_.inputOf(id));
        if (ir::isWhole(ir::partType(v.type)))
          for (float& x : out) x = ir::whole<float>(x < 0 ? ir::int_of(x) : ir::uint_of(x));
        return spread(out, v.type);
      }
      case Op::Swizzle: {
        Floats out{};
        for (int c = 0; c < ir::componentCount(v.type); ++c) {
          out[static_cast<size_t>(c)] = a[static_cast<size_t>(ir::swizzleComponent(v.payload, c))];
        }
        return spread(out, v.type);
      }
      case Op::Construct: return construct(v);
      case Op::Dot: return splat(dot(a, b, width));
      case Op::Length: return splat(std::sqrt(dot(a, a, width)));
      case Op::Normalize: {
        const float length = std::sqrt(dot(a, a, width));
        return {a[0] / length, a[1] / length, a[2] / length, a[3] / length};
      }
      case Op::Cross:
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0};
      // The matrix's elements are all of one range and not told apart here: one column, repeated.
      case Op::MatMul: return splat(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
      case Op::Select: return a[0] != 0 ? b : values_[v.args[2]];
      case Op::Texture:
      case Op::TextureLod:
      case Op::TextureGrad: {
        const ir::Input& texture = dag_.inputOf(v.args[0]);
        return world_.texel(module_.textures[texture.field].environment, texture.name, b);
      }
      case Op::TextureSize: return splat(ir::whole<float>(uint32_t{7}));
      case Op::DFdx: return spread(difference(v.args[0], 0), v.type);
      case Op::DFdy: return spread(difference(v.args[0], 1), v.type);
      case Op::Column: return a;  // as with a product
      case Op::Interpolate: return a;
      case Op::SumOverLights: {
        const int32_t fixed = module_.light_groups[v.payload].count;
        const int count = fixed >= 0 ? fixed : world_.lights(16);
        Floats out{};
        for (int i = 0; i < count; ++i) {
          for (size_t c = 0; c < 4; ++c) out[c] += a[c];
        }
        return out;
      }
      default: break;
    }
    Floats out{};
    for (size_t c = 0; c < 4; ++c)
      out[c] = ir::foldComponent<float>(v.op, a[c], b[c], v.count > 2 ? values_[v.args[2]][c] : 0);
    return out;
  }

private:
  /// Of neighbours: an input is in its range there, too.
  Floats difference(ValueId id, int axis) const {
    const Floats& here = values_[id];
    Floats out = world_.difference(here, axis);
    if (dag_[id].op != Op::Input) return out;
    const ir::Interval& range = dag_.inputOf(id).range;
    for (size_t c = 0; c < 4; ++c) {
      const double there = std::clamp<double>(here[c] + out[c], range.lo, range.hi);
      out[c] = static_cast<float>(there) - here[c];
    }
    return out;
  }

  static Floats splat(float x) { return {x, x, x, x}; }
  /// Every component of a scalar is the scalar, so that it may stand beside a vector.
  static Floats spread(const Floats& x, ir::Type type) {
    return ir::componentCount(type) == 1 ? splat(x[0]) : x;
  }

  static float dot(const Floats& a, const Floats& b, int width) {
    float sum = 0;
    for (int c = 0; c < width; ++c) sum += a[static_cast<size_t>(c)] * b[static_cast<size_t>(c)];
    return sum;
  }

  Floats construct(const ir::Value& v) const {
    if (v.count == 1) return splat(values_[v.args[0]][0]);
    Floats out{};
    size_t next = 0;
    for (const ValueId part : v.operands()) {
      for (int c = 0; c < ir::componentCount(dag_[part].type); ++c)
        out[next++] = values_[part][static_cast<size_t>(c)];
    }
    return out;
  }

  const ir::Module& module_;
  const ir::Dag& dag_;
  const World& world_;
  const std::vector<Floats>& values_;
};

}  // namespace

namespace {

/// The values in their order, loops round by round.
class Run {
public:
  Run(const ir::Module& module, std::span<const ValueId> ids, const World& world, std::vector<Floats>& values,
      const std::function<void(ValueId)>& visit)
      : dag_(module.dag),
        ids_(ids),
        loops_(module.dag, ids),
        evaluation_(module, world, values),
        values_(values),
        visit_(visit) {}

  void within(int32_t loop) {
    for (const ValueId id : ids_) {
      if (loops_.of(id) != loop) continue;
      const Op op = dag_[id].op;
      if (op == Op::Input && ir::ofLoop(dag_.inputOf(id).kind)) continue;  // of this round
      if (ir::makesLoop(op)) {
        const int32_t own = loops_.indexOf(id);
        if (loops_[own].last == id) rounds(own);
        continue;
      }
      if (op != Op::Carried) values_[id] = evaluation_.value(id);
      if (op == Op::Carried) values_[id] = left_.at({dag_[id].args[0], dag_[id].payload});
      if (visit_) visit_(id);
    }
  }

private:
  void rounds(int32_t number) {
    const ir::Loop& loop = loops_[number];
    std::vector<Floats> state;
    for (const ir::Carry& carry : loop.carries) state.push_back(values_[carry.first]);
    const auto end = static_cast<int32_t>(ir::bits(values_[loop.end][0]));
    const int32_t first = ir::firstRound(dag_, loop);
    const int32_t past = first + static_cast<int32_t>(ir::mostRounds(dag_, loop));
    for (int32_t round = first; round < end && round < past; ++round) {
      values_[loop.index].fill(ir::whole<float>(static_cast<uint32_t>(round)));
      if (visit_) visit_(loop.index);
      for (size_t k = 0; k < state.size(); ++k) {
        values_[loop.carries[k].value] = state[k];
        if (visit_) visit_(loop.carries[k].value);
      }
      within(number);
      for (size_t k = 0; k < state.size(); ++k) state[k] = values_[loop.carries[k].next];
    }
    for (size_t k = 0; k < state.size(); ++k)
      left_[{loop.last, dag_.inputOf(loop.carries[k].value).index}] = state[k];
  }

  const ir::Dag& dag_;
  std::span<const ValueId> ids_;
  ir::Loops loops_;
  Evaluation evaluation_;
  std::vector<Floats>& values_;
  const std::function<void(ValueId)>& visit_;
  std::map<std::pair<ValueId, uint32_t>, Floats> left_;
};

}  // namespace

void evaluate(const ir::Module& module, std::span<const ValueId> ids, const World& world,
              std::vector<Floats>& values, const std::function<void(ValueId)>& visit) {
  values.resize(module.dag.size());
  Run(module, ids, world, values, visit).within(-1);
}

std::vector<ValueId> everything(const ir::Module& module) {
  std::vector<ValueId> roots;
  for (const ir::Output& output : module.outputs) roots.push_back(output.value);
  for (const ir::Varying& varying : module.varyings) {
    if (varying.source != ir::kNoValue) roots.push_back(varying.source);
  }
  for (const ir::PreshaderField& field : module.preshader) roots.push_back(field.value);
  return ir::reachable(module.dag, roots);
}

}  // namespace lacquer::test
