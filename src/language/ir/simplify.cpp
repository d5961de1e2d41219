#include "ir/simplify.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <span>

#include "ir/fold.h"

namespace lacquer::ir {

ValueId Simplifier::splatted(ValueId id) {
  const Value& value = dag_[id];
  if (!isFloatVector(value.type)) return kNoValue;
  if (value.op == Op::Construct && value.count == 1) return value.args[0];
  if (value.op == Op::Constant && dag_.isConstant(id, dag_.constantOf(id)[0])) {
    return dag_.constant(dag_.constantOf(id)[0]);
  }
  return kNoValue;
}

ValueId Simplifier::as(Type type, ValueId id) {
  if (dag_[id].type == type) return id;
  return dag_.construct(type, {id});
}

ValueId Simplifier::simplify(Op op, Type type, std::span<const ValueId> operands, uint32_t) {
  if (const ValueId folded = fold(op, type, operands); folded != kNoValue) return folded;
  if (info(op).signature == Signature::Map) {
    if (const ValueId scalar = unsplat(op, type, operands); scalar != kNoValue) return scalar;
  }
  if (operands.size() == 1 || op == Op::SumOverLights) return unary(op, operands[0]);
  if (operands.size() == 2) return binary(op, type, operands[0], operands[1]);
  return ternary(op, type, operands[0], operands[1], operands[2]);
}

ValueId Simplifier::fold(Op op, Type type, std::span<const ValueId> operands) {
  if (!std::all_of(operands.begin(), operands.end(), [&](ValueId id) { return dag_.isConstant(id); })) {
    return kNoValue;
  }
  if (op == Op::DFdx || op == Op::DFdy) return zero(type);
  if (op == Op::Interpolate) return operands[0];
  if (op == Op::Select) return operands[dag_.constantOf(operands[0])[0] != 0 ? 1 : 2];
  if (facts(op).kind == Kind::Surroundings) return kNoValue;
  std::array<Operand, 4> in{};
  for (size_t k = 0; k < operands.size(); ++k) in[k] = {dag_[operands[k]].type, dag_.constantOf(operands[k])};
  const Components result = foldNumbers(op, type, 0, {in.data(), operands.size()});
  // What is not a number stays an expression: a printed literal must be finite.
  const bool finite = std::all_of(result.begin(), result.end(), [](double x) { return std::isfinite(x); });
  return finite ? dag_.constant(type, result) : kNoValue;
}

ValueId Simplifier::unsplat(Op op, Type type, std::span<const ValueId> operands) {
  if (type == Type::Float) return kNoValue;
  std::array<ValueId, 4> parts{};
  bool changed = false;
  bool vector_left = false;
  for (size_t i = 0; i < operands.size(); ++i) {
    const ValueId scalar = splatted(operands[i]);
    parts[i] = scalar == kNoValue ? operands[i] : scalar;
    changed |= scalar != kNoValue;
    vector_left |= dag_[parts[i]].type != Type::Float;
  }
  if (!changed) return kNoValue;
  const ValueId value = dag_.make(op, {parts.data(), operands.size()});
  return vector_left ? value : dag_.construct(type, {value});
}

ValueId Simplifier::unary(Op op, ValueId a) {
  const Value value = dag_[a];
  if (op == Op::Neg && value.op == Op::Neg) return value.args[0];
  if (op == Op::Neg && value.op == Op::Sub && dag_[value.args[0]].type == dag_[value.args[1]].type)
    return dag_.sub(value.args[1], value.args[0]);
  if (op == Op::Abs && value.op == Op::Neg) return dag_.make(Op::Abs, {value.args[0]});
  if ((op == Op::Abs || op == Op::Normalize) && value.op == op) return a;
  if (op == Op::Not && value.op == Op::Not) return value.args[0];
  if (op == Op::BitNot && value.op == Op::BitNot) return value.args[0];
  if ((op == Op::AsInt && value.op == Op::AsUInt) || (op == Op::AsUInt && value.op == Op::AsInt))
    return value.args[0];
  // What is one object's may be interpolated, so that the vertices compute it.
  if (op == Op::Interpolate && value.rate <= Rate::Frame) return a;
  if ((op == Op::DFdx || op == Op::DFdy) && value.rate < Rate::Vertex) return zero(value.type);
  if (op == Op::SumOverLights && dag_.isConstant(a, 0)) return a;
  return kNoValue;
}

ValueId Simplifier::binary(Op op, Type type, ValueId a, ValueId b) {
  if (op == Op::Add || op == Op::Sub) return sum(op, type, a, b);
  if (op == Op::Mul) return product(type, a, b);
  if (op == Op::Div) return quotient(type, a, b);
  if (op == Op::Min || op == Op::Max) return extremum(op, type, a, b);
  if (op == Op::Pow) return power(type, a, b);
  if (op == Op::And || op == Op::Or) return logic(op, a, b);
  if (op == Op::Dot) return dot(a, b);
  if (op == Op::MatMul && is(a, Op::Construct)) return columns(a, b);
  if (ofWholes(info(op).signature)) return wholes(op, a, b);
  return kNoValue;
}

/// A matrix that is made of columns times a vector.
ValueId Simplifier::columns(ValueId matrix, ValueId vector) {
  const Value m = dag_[matrix];
  ValueId sum = kNoValue;
  for (int k = 0; k < m.count; ++k) {
    const ValueId part = dag_.mul(m.args[static_cast<size_t>(k)], dag_.component(vector, k));
    sum = k == 0 ? part : dag_.add(sum, part);
  }
  return sum;
}

ValueId Simplifier::wholes(Op op, ValueId a, ValueId b) {
  const Type type = dag_[a].type;
  const bool added = op == Op::WholeAdd || op == Op::BitOr || op == Op::BitXor;
  const bool moved = info(op).signature == Signature::Shift;
  if ((added || moved || op == Op::WholeSub) && dag_.isConstant(b, 0)) return a;
  if (added && dag_.isConstant(a, 0)) return b;
  const auto zero = [&] { return dag_.constant(type, {}); };
  if ((op == Op::WholeSub || op == Op::BitXor) && a == b) return zero();
  if (op == Op::WholeMul || op == Op::BitAnd) {
    if (dag_.isConstant(a, 0) || dag_.isConstant(b, 0)) return zero();
    const double neutral = op == Op::WholeMul ? 1 : -1;
    if (dag_.isConstant(a, neutral)) return b;
    if (dag_.isConstant(b, neutral)) return a;
  }
  if ((op == Op::BitAnd || op == Op::BitOr) && a == b) return a;
  if (op == Op::WholeEqual && a == b) return dag_.boolean(true);
  if (op == Op::WholeSub && dag_.isConstant(b) && is(a, op) && dag_.isConstant(dag_[a].args[1])) {
    const Value inner = dag_[a];
    return dag_.make(op, {inner.args[0], dag_.make(Op::WholeAdd, {inner.args[1], b})});
  }
  // (x + c1) + c2 = x + (c1 + c2), and so on: exact, for integers wrap.
  const bool gathers = added || op == Op::WholeMul || op == Op::BitAnd;
  if (gathers && dag_.isConstant(a)) std::swap(a, b);
  if (gathers && dag_.isConstant(b) && is(a, op)) {
    const Value inner = dag_[a];
    for (const size_t k : {size_t{0}, size_t{1}}) {
      if (dag_.isConstant(inner.args[k]))
        return dag_.make(op, {inner.args[1 - k], dag_.make(op, {inner.args[k], b})});
    }
  }
  return kNoValue;
}

ValueId Simplifier::sum(Op op, Type type, ValueId a, ValueId b) {
  if (dag_.isConstant(b, 0)) return as(type, a);
  if (dag_.isConstant(a, 0)) return op == Op::Add ? as(type, b) : dag_.make(Op::Neg, {as(type, b)});
  if (op == Op::Sub && a == b) return zero(type);
  const Value vb = dag_[b];
  if (vb.op == Op::Neg) return dag_.make(op == Op::Add ? Op::Sub : Op::Add, {a, vb.args[0]});
  const Value va = dag_[a];
  if (op == Op::Add && va.op == Op::Neg) return dag_.sub(b, va.args[0]);
  // (v + a) + b for a vector and two Floats: v + (a + b), one vector sum less.
  if (op == Op::Add && type != Type::Float) {
    const auto isFloat = [this](ValueId id) { return dag_[id].type == Type::Float; };
    if (isFloat(a)) std::swap(a, b);
    const Value inner = dag_[a];
    if (isFloat(b) && inner.op == Op::Add && isFloat(inner.args[1])) {
      return dag_.add(inner.args[0], dag_.add(inner.args[1], b));
    }
    if (isFloat(b) && inner.op == Op::Add && isFloat(inner.args[0])) {
      return dag_.add(inner.args[1], dag_.add(inner.args[0], b));
    }
  }
  // 1 - (1 - x): the complement of a complement.
  if (op == Op::Sub && vb.op == Op::Sub && dag_.isConstant(a) && vb.args[0] == a) return as(type, vb.args[1]);
  return kNoValue;
}

ValueId Simplifier::product(Type type, ValueId a, ValueId b) {
  if (dag_.isConstant(a, 0) || dag_.isConstant(b, 0)) return zero(type);
  if (dag_.isConstant(a, 1)) return as(type, b);
  if (dag_.isConstant(b, 1)) return as(type, a);
  if (dag_.isConstant(a, -1)) return dag_.make(Op::Neg, {as(type, b)});
  if (dag_.isConstant(b, -1)) return dag_.make(Op::Neg, {as(type, a)});
  if (is(a, Op::Neg) && is(b, Op::Neg)) return dag_.mul(dag_[a].args[0], dag_[b].args[0]);
  // c1 * (c2 * x) = (c1 * c2) * x
  if (dag_.isConstant(b)) std::swap(a, b);
  if (dag_.isConstant(a) && is(b, Op::Mul)) {
    const Value inner = dag_[b];
    for (const size_t k : {size_t{0}, size_t{1}}) {
      if (dag_.isConstant(inner.args[k])) return dag_.mul(dag_.mul(a, inner.args[k]), inner.args[1 - k]);
    }
  }
  return kNoValue;
}

ValueId Simplifier::quotient(Type type, ValueId a, ValueId b) {
  if (dag_.isConstant(b, 1)) return as(type, a);
  if (dag_.isConstant(a, 0)) return zero(type);
  return kNoValue;
}

ValueId Simplifier::extremum(Op op, Type type, ValueId a, ValueId b) {
  if (a == b) return as(type, a);
  // max(max(x, c1), c2) = max(x, max(c1, c2))
  if (dag_.isConstant(a)) std::swap(a, b);
  if (dag_.isConstant(b) && is(a, op) && dag_.isConstant(dag_[a].args[1])) {
    return dag_.make(op, {dag_[a].args[0], dag_.make(op, {dag_[a].args[1], b})});
  }
  return kNoValue;
}

ValueId Simplifier::power(Type type, ValueId a, ValueId b) {
  if (dag_.isConstant(b, 1)) return as(type, a);
  if (dag_.isConstant(b, 0) || dag_.isConstant(a, 1)) return dag_.constant(type, {1, 1, 1, 1});
  if (!dag_.isConstant(b, 2)) return kNoValue;
  const ValueId base = as(type, a);
  return dag_.mul(base, base);
}

ValueId Simplifier::logic(Op op, ValueId a, ValueId b) {
  if (a == b) return a;
  if (dag_.isConstant(a)) std::swap(a, b);
  if (!dag_.isConstant(b)) return kNoValue;
  const bool truth = dag_.constantOf(b)[0] != 0;
  if (op == Op::And) return truth ? a : b;
  return truth ? b : a;
}

ValueId Simplifier::dot(ValueId a, ValueId b) {
  if (dag_[a].type == Type::Float) return dag_.mul(a, b);
  if (dag_.isConstant(a)) std::swap(a, b);
  if (!dag_.isConstant(b)) return kNoValue;
  if (dag_.isConstant(b, 0)) return dag_.constant(0);
  return kNoValue;
}

ValueId Simplifier::ternary(Op op, Type type, ValueId a, ValueId b, ValueId c) {
  if (op == Op::Select) {
    if (dag_.isConstant(a)) return dag_.constantOf(a)[0] != 0 ? b : c;
    if (b == c) return b;
    if (is(a, Op::Not)) return dag_.make(Op::Select, {dag_[a].args[0], c, b});
    if (type == Type::Bool && dag_.isConstant(b, 1) && dag_.isConstant(c, 0)) return a;
    return kNoValue;
  }
  if (op == Op::Mix) {
    if (dag_.isConstant(c, 0) || a == b) return as(type, a);
    if (dag_.isConstant(c, 1)) return as(type, b);
    if (dag_.isConstant(a, 0)) return as(type, dag_.mul(b, c));
    if (dag_.isConstant(b, 0)) return as(type, dag_.mul(a, dag_.sub(dag_.constant(1), c)));
    return kNoValue;
  }
  if (op == Op::Clamp && is(a, Op::Clamp) && dag_[a].args[1] == b && dag_[a].args[2] == c) return as(type, a);
  return kNoValue;
}

ValueId Simplifier::construct(Type type, std::span<const ValueId> parts) {
  if (parts.size() == 1 && dag_[parts[0]].type == type) return parts[0];
  const bool splat = parts.size() == 1;
  if (splat && dag_.isConstant(parts[0])) {
    const double x = dag_.constantOf(parts[0])[0];
    return dag_.constant(type, {x, x, x, x});
  }
  if (splat) return kNoValue;

  // Per component: the vector (or Float) it comes from and its position there.
  struct Pick {
    ValueId source;
    int index;
  };
  std::array<Pick, 16> storage;  // a Mat4 has the most components
  size_t count = 0;
  for (const ValueId part : parts) {
    const Value value = dag_[part];
    for (int i = 0; i < componentCount(value.type); ++i) {
      const ValueId scalar = componentCount(value.type) == 1 ? part : dag_.component(part, i);
      const Value s = dag_[scalar];
      assert(count < storage.size());
      storage[count++] =
          s.op == Op::Swizzle ? Pick{s.args[0], swizzleComponent(s.payload, 0)} : Pick{scalar, 0};
    }
  }
  const std::span<const Pick> picks(storage.data(), count);
  const auto constantAt = [&](const Pick& p) { return dag_.isConstant(p.source); };
  if (std::all_of(picks.begin(), picks.end(), constantAt)) {
    Components c{};
    for (size_t i = 0; i < picks.size(); ++i) {
      c[i] = dag_.constantOf(picks[i].source)[static_cast<size_t>(picks[i].index)];
    }
    return dag_.constant(type, c);
  }
  const bool one =
      std::all_of(picks.begin(), picks.end(), [&](const Pick& p) { return p.source == picks[0].source; });
  if (one && componentCount(dag_[picks[0].source].type) > 1) {
    if (isComposite(type)) return kNoValue;
    std::array<int, 4> order{};
    for (size_t i = 0; i < count; ++i) order[i] = picks[i].index;
    return dag_.swizzle(picks[0].source, {order.data(), count});
  }
  if (one) return dag_.construct(type, {picks[0].source});
  // A part that is itself a Construct of scalars opens up, so that equal vectors built in two ways are one
  // value.
  for (size_t k = 0; k < parts.size(); ++k) {
    const Value value = dag_[parts[k]];
    if (value.op != Op::Construct || value.count == 1) continue;
    std::vector<ValueId> opened(parts.begin(), parts.end());
    opened.erase(opened.begin() + static_cast<ptrdiff_t>(k));
    opened.insert(opened.begin() + static_cast<ptrdiff_t>(k), value.args.begin(),
                  value.args.begin() + value.count);
    return dag_.construct(type, opened);
  }
  return kNoValue;
}

ValueId Simplifier::swizzle(ValueId id, std::span<const int> components) {
  const Value value = dag_[id];
  const auto n = static_cast<int>(components.size());
  const Type type = vectorType(partType(value.type), n);
  if (componentCount(value.type) == 1) return n == 1 ? id : dag_.construct(type, {id});
  bool identity = n == componentCount(value.type);
  for (int i = 0; i < n; ++i) identity &= components[static_cast<size_t>(i)] == i;
  if (identity) return id;
  if (value.op == Op::Constant) {
    Components c{};
    for (int i = 0; i < n; ++i) {
      c[static_cast<size_t>(i)] =
          dag_.constantOf(id)[static_cast<size_t>(components[static_cast<size_t>(i)])];
    }
    return dag_.constant(type, c);
  }
  if (value.op == Op::Swizzle) {
    std::array<int, 4> composed{};
    for (int i = 0; i < n; ++i) {
      composed[static_cast<size_t>(i)] = swizzleComponent(value.payload, components[static_cast<size_t>(i)]);
    }
    return dag_.swizzle(value.args[0], {composed.data(), static_cast<size_t>(n)});
  }
  if (value.op != Op::Construct) return kNoValue;
  if (value.count == 1) return n == 1 ? value.args[0] : dag_.construct(type, {value.args[0]});
  // From a Construct: the part that holds all of it, or one component.
  int first = 0;
  for (int k = 0; k < value.count; ++k) {
    const ValueId part = value.args[static_cast<size_t>(k)];
    const int width = componentCount(dag_[part].type);
    const bool inside = std::all_of(components.begin(), components.end(),
                                    [&](int c) { return c >= first && c < first + width; });
    if (inside) {
      std::array<int, 4> local{};
      for (int i = 0; i < n; ++i) local[static_cast<size_t>(i)] = components[static_cast<size_t>(i)] - first;
      return dag_.swizzle(part, {local.data(), static_cast<size_t>(n)});
    }
    first += width;
  }
  return kNoValue;
}

}  // namespace lacquer::ir
