// Scalars that scale vectors: gathered, so that one product does the work of three, or left out where nobody
// asks.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "passes/passes.h"
#include "passes/rewrite.h"

namespace lacquer::passes {

namespace {

using ir::Op;
using ir::ValueId;

/// A vector times a Float, either way round: the vector's position among the operands, or -1.
int scaledVector(const ir::Dag& dag, ValueId id) {
  const ir::Value& value = dag[id];
  if (value.op != Op::Mul || !ir::isFloatVector(value.type)) return -1;
  if (dag[value.args[1]].type == ir::Type::Float) return 0;
  return dag[value.args[0]].type == ir::Type::Float ? 1 : -1;
}

/// (v a) s = v (a s), and (v a + b) s = v (a s) + b s for a Float b: the products of Floats replace products
/// of vectors. Only where nothing else reads the inner value, which would have to be computed all the same.
class Gather {
public:
  explicit Gather(ir::Module& module) : module_(module) {}

  void run() {
    Rewriter rewriter(module_);
    uses_.assign(rewriter.dag().size(), 0);
    for (const ValueId id : rewriter.live()) {
      for (const ValueId operand : rewriter.dag()[id].operands()) ++uses_[operand];
    }
    rewriter.run([this](Rewriter& r, ValueId id, std::span<const ValueId> operands) {
      if (const ValueId hoisted = hoistFactor(r, id, operands); hoisted != ir::kNoValue) return hoisted;
      const int vector = scaledVector(r.dag(), id);
      if (vector < 0) return r.copy(id, operands);
      const auto v = static_cast<size_t>(vector);
      const ValueId inner = r.dag()[id].args[v];
      if (uses_[inner] != 1 || !worthwhile(r.dag(), operands[v])) return r.copy(id, operands);
      return scale(r.dag(), operands[v], operands[1 - v]);
    });
  }

private:
  /// m (p + q y) = (m p) + (m q) y for m, p and q of the material's rate or constant: two products go to the
  /// preshader.
  ValueId hoistFactor(Rewriter& r, ValueId id, std::span<const ValueId> operands) const {
    const ir::Value value = r.dag()[id];
    if (value.op != Op::Mul || value.type != ir::Type::Float || value.rate <= ir::Rate::Material)
      return ir::kNoValue;
    ir::Dag& dag = r.dag();
    const auto low = [&](ValueId v) { return dag[v].rate <= ir::Rate::Material; };
    for (const size_t k : {size_t{0}, size_t{1}}) {
      // m (n y) = (m n) y
      const ir::Value product = dag[operands[1 - k]];
      if (!low(operands[k]) || product.op != Op::Mul || product.type != ir::Type::Float) continue;
      for (const size_t n : {size_t{0}, size_t{1}}) {
        if (low(product.args[n])) return dag.mul(dag.mul(operands[k], product.args[n]), product.args[1 - n]);
      }
    }
    for (const size_t k : {size_t{0}, size_t{1}}) {
      const ir::Value sum = dag[operands[1 - k]];
      if (!low(operands[k]) || sum.op != Op::Add || uses_[value.args[1 - k]] != 1) continue;
      for (const size_t p : {size_t{0}, size_t{1}}) {
        const ir::Value product = dag[sum.args[1 - p]];
        if (!low(sum.args[p]) || product.op != Op::Mul) continue;
        const size_t q = low(product.args[0]) ? 0 : 1;
        if (!low(product.args[q])) continue;
        const ValueId slope = dag.mul(operands[k], product.args[q]);
        const ValueId rise = dag.mul(slope, product.args[1 - q]);
        const ValueId start = dag.mul(operands[k], sum.args[p]);
        return dag.add(start, rise);
      }
    }
    return ir::kNoValue;
  }

  /// What is of the material's rate is computed already.
  static bool worthwhile(const ir::Dag& dag, ValueId vector) {
    const ir::Value& value = dag[vector];
    if (value.rate <= ir::Rate::Material) return false;
    if (scaledVector(dag, vector) >= 0) return true;
    if (value.op != Op::Add || !ir::isFloatVector(value.type)) return false;
    const auto scaled = [&](ValueId id) {
      return dag[id].rate > ir::Rate::Material && scaledVector(dag, id) >= 0;
    };
    if (scaled(value.args[0]) && scaled(value.args[1])) return true;
    return dag[value.args[0]].type == ir::Type::Float || dag[value.args[1]].type == ir::Type::Float;
  }

  static ValueId scale(ir::Dag& dag, ValueId vector, ValueId s) {
    const ir::Value value = dag[vector];
    if (value.rate <= ir::Rate::Material) return dag.mul(vector, s);
    if (const int v = scaledVector(dag, vector); v >= 0) {
      return dag.mul(value.args[static_cast<size_t>(v)], dag.mul(value.args[static_cast<size_t>(1 - v)], s));
    }
    if (!worthwhile(dag, vector)) return dag.mul(vector, s);
    const ValueId second = scale(dag, value.args[1], s);
    const ValueId first = scale(dag, value.args[0], s);
    return dag.add(first, second);
  }

  ir::Module& module_;
  std::vector<int> uses_;
};

/// A cube map does not ask for its direction's length: a positive factor common to all of it is left out.
class Directions {
public:
  static bool lookup(const ir::Dag& dag, ValueId id) {
    const ir::Value& value = dag[id];
    // Derivatives are those of the direction as it is.
    return ir::readsTexture(value.op) && value.op != Op::TextureGrad &&
           dag[value.args[0]].type == ir::Type::TextureCube;
  }

  static ValueId stripped(ir::Dag& dag, ValueId direction) {
    std::vector<ValueId> candidates;
    collect(dag, direction, candidates, 0);
    for (const ValueId factor : candidates) {
      const ValueId without = remove(dag, direction, factor, 0);
      if (without != ir::kNoValue) return without;
    }
    return direction;
  }

private:
  /// Reciprocal lengths among the factors: they are positive.
  static void collect(const ir::Dag& dag, ValueId id, std::vector<ValueId>& found, int depth) {
    const ir::Value& value = dag[id];
    if (value.op == Op::InverseSqrt && std::find(found.begin(), found.end(), id) == found.end())
      found.push_back(id);
    if (depth > kDeepest) return;
    if (value.op != Op::Mul && value.op != Op::Add && value.op != Op::Sub) return;
    for (const ValueId operand : value.operands()) collect(dag, operand, found, depth + 1);
  }

  /// The value divided by one factor that all of it has, or kNoValue.
  static ValueId remove(ir::Dag& dag, ValueId id, ValueId factor, int depth) {
    if (id == factor) return dag.constant(1);
    if (depth > kDeepest) return ir::kNoValue;
    const ir::Value value = dag[id];
    if (value.op == Op::Mul) {
      for (const size_t k : {size_t{0}, size_t{1}}) {
        const ValueId part = remove(dag, value.args[k], factor, depth + 1);
        if (part != ir::kNoValue) return dag.mul(part, value.args[1 - k]);
      }
      return ir::kNoValue;
    }
    if (value.op != Op::Add && value.op != Op::Sub) return ir::kNoValue;
    const ValueId a = remove(dag, value.args[0], factor, depth + 1);
    const ValueId b = a == ir::kNoValue ? a : remove(dag, value.args[1], factor, depth + 1);
    return b == ir::kNoValue ? b : dag.make(value.op, {a, b});
  }

  static constexpr int kDeepest = 8;
};

/// dot(v s, w) = dot(v, w) s where the scaled vector is otherwise only added to something: then it never
/// stands in registers, the sum being a fused multiply-add. And what only scales a cube map's direction goes.
void pullOut(ir::Module& module) {
  Rewriter rewriter(module);
  const ir::Dag& old = module.dag;
  std::vector<int> dots(old.size(), 0);
  std::vector<uint8_t> needed(old.size(), false);
  const std::vector<ValueId>& live = rewriter.live();
  for (const ValueId id : live) {
    const ir::Value& value = old[id];
    for (const ValueId operand : value.operands()) {
      if (value.op == Op::Dot)
        ++dots[operand];
      else if (value.op != Op::Add && value.op != Op::Sub)
        needed[operand] = true;
    }
    if (value.op == Op::Dot && value.args[0] == value.args[1]) needed[value.args[0]] = true;
  }
  for (const ir::Output& output : module.outputs) needed[output.value] = true;
  const auto pays = [&](ValueId id) { return scaledVector(old, id) >= 0 && !needed[id] && dots[id] <= 2; };
  const auto changes = [&](ValueId id) {
    if (old[id].op == Op::Dot) return pays(old[id].args[0]) || pays(old[id].args[1]);
    return Directions::lookup(old, id);
  };
  if (std::none_of(live.begin(), live.end(), changes)) return;
  rewriter.run([&](Rewriter& r, ValueId id, std::span<const ValueId> operands) {
    const ir::Value value = r.dag()[id];
    if (Directions::lookup(r.dag(), id)) {
      std::array<ValueId, 4> changed{};
      std::copy(operands.begin(), operands.end(), changed.begin());
      changed[1] = Directions::stripped(r.dag(), changed[1]);
      return r.copy(id, {changed.data(), operands.size()});
    }
    if (value.op != Op::Dot) return r.copy(id, operands);
    ValueId factor = r.dag().constant(1);
    std::array<ValueId, 2> sides{operands[0], operands[1]};
    for (size_t k = 0; k < 2; ++k) {
      if (!pays(value.args[k])) continue;
      const ir::Value scaled = r.dag()[sides[k]];
      const int v = scaledVector(r.dag(), sides[k]);
      if (v < 0) continue;
      factor = r.dag().mul(factor, scaled.args[static_cast<size_t>(1 - v)]);
      sides[k] = scaled.args[static_cast<size_t>(v)];
    }
    return r.dag().mul(r.dag().make(Op::Dot, {sides[0], sides[1]}), factor);
  });
}

/// |x s| = |x| s for a reciprocal length s, which is positive: where the product's sign is asked for in sums
/// alone, each of which is a fused multiply-add, only its magnitude ever stands in a register.
void takeMagnitudes(ir::Module& module) {
  Rewriter rewriter(module);
  const ir::Dag& old = module.dag;
  std::vector<uint8_t> needed(old.size(), false);
  const std::vector<ValueId>& live = rewriter.live();
  for (const ValueId id : live) {
    const Op op = old[id].op;
    if (op == Op::Abs || op == Op::Add || op == Op::Sub) continue;
    for (const ValueId operand : old[id].operands()) needed[operand] = true;
  }
  const auto changes = [&](ValueId id) {
    if (old[id].op != Op::Abs || needed[old[id].args[0]]) return false;
    const ir::Value& product = old[old[id].args[0]];
    return product.op == Op::Mul &&
           (old[product.args[0]].op == Op::InverseSqrt || old[product.args[1]].op == Op::InverseSqrt);
  };
  if (std::none_of(live.begin(), live.end(), changes)) return;
  rewriter.run([&](Rewriter& r, ValueId id, std::span<const ValueId> operands) {
    if (r.dag()[id].op != Op::Abs || needed[old[id].args[0]]) return r.copy(id, operands);
    const ir::Value product = r.dag()[operands[0]];
    if (product.op != Op::Mul) return r.copy(id, operands);
    for (const size_t k : {size_t{0}, size_t{1}}) {
      if (r.dag()[product.args[k]].op != Op::InverseSqrt) continue;
      const ValueId magnitude = r.dag().make(Op::Abs, {product.args[1 - k]});
      const ValueId result = r.dag().mul(magnitude, product.args[k]);
      // What is known of the product holds for its magnitude; the new operations cannot show it.
      if (const auto known = old.assumed(old[id].args[0]))
        r.dag().assume(result, {0, std::max(std::abs(known->lo), std::abs(known->hi))});
      return result;
    }
    return r.copy(id, operands);
  });
}

}  // namespace

void placeScales(ir::Module& module) {
  Gather(module).run();
  pullOut(module);
  takeMagnitudes(module);
}

}  // namespace lacquer::passes
