#include "analysis/intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "analysis/whole_math.h"

namespace lacquer::analysis {

using ir::Op;
using ir::ValueId;

Intervals::Intervals(const ir::Module& module, const IntervalOptions& options)
    : module_(module),
      dag_(module.dag),
      options_(options),
      math_(options.arithmetic),
      values_(1),
      facets_(module.dag.size()) {}

void Intervals::run() {
  std::vector<ValueId> preshader, varyings, roots;
  for (const ir::PreshaderField& field : module_.preshader) preshader.push_back(field.value);
  // The fields of the material block are what the preshader gives, varyings what the vertex stage gives: they
  // come first.
  run(ir::reachable(dag_, preshader));
  for (const ir::Varying& varying : module_.varyings) {
    if (varying.source != ir::kNoValue) varyings.push_back(varying.source);
  }
  run(ir::reachable(dag_, varyings));
  for (const ir::Output& output : module_.outputs) roots.push_back(output.value);
  run(ir::reachable(dag_, roots));
}

void Intervals::run(std::span<const ValueId> ids) {
  if (dag_.hasLoops()) return runWithLoops(ids);
  values_.reserve(values_.size() + ids.size());
  for (const ValueId id : ids) {
    if (!facets_[id].done) evaluateOnce(id);
  }
}

void Intervals::evaluateOnce(ValueId id) {
  if (facets_[id].place == 0) {
    facets_[id].place = static_cast<uint32_t>(values_.size());
    values_.emplace_back();
    look(id);
  }
  const auto fixed = fixed_.find(id);
  if (fixed != fixed_.end()) {
    rangesOf(id) = fixed->second;
    facets_[id].alike = false;
  } else {
    evaluate(id);
  }
  facets_[id].done = true;
  const auto fact = dag_.assumed(id);
  if (!fact) return;
  for (Range& range : rangesOf(id)) range = meet(range, math_.fact(*fact));
}

Range Intervals::all(ValueId id) const {
  Range range = at(id, 0);
  for (int c = 1; c < ir::componentCount(dag_[id].type) && c < 4; ++c) range = hull(range, at(id, c));
  return range;
}

/// What a value is made of, from its operands.
void Intervals::look(ValueId id) {
  const ir::Value& value = dag_[id];
  Facet& facet = facets_[id];
  const bool product = value.op == Op::Mul;
  const bool quotient = value.op == Op::Div && dag_.isConstant(value.args[1]);
  const auto of = [&](size_t k) -> const Facet& { return facets_[value.args[k]]; };
  facet.root =
      value.op == Op::InverseSqrt || (product && (of(0).root || of(1).root)) || (quotient && of(0).root);
  facet.difference = value.op == Op::Sub || (product && (of(0).difference || of(1).difference)) ||
                     (quotient && of(0).difference);
  const auto many = [&](Op first, Op second, uint8_t Facet::*count) {
    size_t constants = 0;
    for (size_t k = 0; k < value.count; ++k) {
      const ir::Value& operand = dag_[value.args[k]];
      if (operand.op == Op::Constant) ++constants;
      if (operand.op == first || operand.op == second || operand.op == Op::Neg) constants += of(k).*count;
    }
    return static_cast<uint8_t>(std::min<size_t>(constants, 2));
  };
  if (value.op == Op::Add || value.op == Op::Sub || value.op == Op::Neg)
    facet.addends = many(Op::Add, Op::Sub, &Facet::addends);
  if (value.op == Op::Mul || value.op == Op::Div || value.op == Op::Neg)
    facet.factors = many(Op::Mul, Op::Div, &Facet::factors);
  // Patterns of a root look for the component's own square.
  facet.alike =
      !ir::isFloatVector(value.type) || ((value.op != Op::Construct || value.count == 1) &&
                                         value.op != Op::Constant && value.op != Op::Cross && !facet.root);
  for (size_t k = 0; k < value.count; ++k) facet.alike &= of(k).alike;
}

void Intervals::evaluate(ValueId id) {
  const ir::Value& value = dag_[id];
  if (value.op == Op::Input) {
    const ir::Input& in = dag_.inputOf(id);
    rangesOf(id).fill(input(in));
    if (in.kind == ir::InputKind::BlockField) materialField(id, in.block, in.field);
    varying(id, in);
    return;
  }
  if (value.op == Op::Element) {
    rangesOf(id).fill(element(value));
    return materialField(id, ir::ListField::of(value).block, ir::ListField::of(value).field);
  }
  if (value.op == Op::MatMul) return matMul(id);
  if (value.op == Op::Column) return static_cast<void>(rangesOf(id).fill(at(value.args[0], 0)));
  if (value.op == Op::Cross || value.op == Op::Construct || value.op == Op::Swizzle ||
      value.op == Op::Normalize) {
    return vectorOp(id);
  }
  for (int c = 0; c < std::min(ir::componentCount(value.type), 4); ++c) {
    Range range = component(id, c);
    pattern(id, c, range);
    if (options_.arithmetic == Arithmetic::Vulkan) range = regrouped(id, c, range);
    rangesOf(id)[static_cast<size_t>(c)] = range;
    if (facets_[id].alike) return rangesOf(id).fill(range);
  }
}

Range Intervals::open(ir::Interval range) const {
  if (options_.arithmetic == Arithmetic::Real) return math_.fact(range);
  const double limit = options_.unbounded;
  if (options_.computed_inputs) {
    const Range wide = math_.fact(range);
    range = {wide.lo, wide.hi};
  }
  return {math_.constant(std::max(range.lo, -limit)).lo, math_.constant(std::min(range.hi, limit)).hi, false};
}

namespace {

/// What glTF asks of vertex data ("Meshes"): normals and tangents are unit vectors, a tangent's sign is 1 or
/// -1, colours are clamped. A BSDF's own directions are unit vectors too (templates/bsdf.node).
ir::Interval vertexRange(const ir::Input& input) {
  for (const std::string_view name : {"NORMAL", "TANGENT", "VIEW", "LIGHT"}) {
    if (input.name == name) return {-1, 1};
  }
  if (input.name.starts_with("COLOR_")) return {0, 1};
  return input.range;
}

}  // namespace

Range Intervals::input(const ir::Input& input) const {
  const ir::Type part = ir::partType(input.type);
  if (part == ir::Type::Bool) return {0, 1, false};
  if (ir::isWhole(part) && input.kind != ir::InputKind::LightIndex) {
    const Range stated{std::max(input.range.lo, kWholes.lo), input.range.hi, false};
    return part == ir::Type::UInt ? uintRange(stated) : meet(kWholes, stated);
  }
  switch (input.kind) {
    case ir::InputKind::FrontFacing: return {0, 1, false};
    case ir::InputKind::LoopIndex: return {input.range.lo, input.range.hi, false};
    case ir::InputKind::LoopValue: return math_.whole(true);  // of a loop that nothing is known of
    case ir::InputKind::LightIndex: return {0, 65535, false};
    case ir::InputKind::Texture: {
      // An environment map's format is the application's: nothing is known, not even that it holds numbers.
      const bool environment =
          input.field < module_.textures.size() && module_.textures[input.field].environment;
      return environment ? math_.whole(true) : Range{0, 1, false};
    }
    case ir::InputKind::Attribute:
    case ir::InputKind::Varying: return open(vertexRange(input));
    case ir::InputKind::Parameter:
    case ir::InputKind::SpecConstant:
    case ir::InputKind::BlockField: return open(input.range);
  }
  return math_.whole(true);
}

void Intervals::materialField(ValueId id, uint32_t block, uint32_t number) {
  if (block >= module_.blocks.size() || module_.blocks[block].role != ir::BlockRole::Material) return;
  for (const ir::PreshaderField& field : module_.preshader) {
    if (field.field != number || !known(field.value)) continue;
    rangesOf(id) = rangesOf(field.value);
    facets_[id].alike = facets_[field.value].alike;
  }
}

void Intervals::varying(ValueId id, const ir::Input& input) {
  if (input.kind != ir::InputKind::Varying || input.field >= module_.varyings.size()) return;
  const ValueId source = module_.varyings[input.field].source;
  if (source == ir::kNoValue || !known(source)) return;
  facets_[id].alike = facets_[source].alike;
  for (int c = 0; c < ir::componentCount(dag_[id].type); ++c) {
    const Range& at_vertices = at(source, c);
    rangesOf(id)[static_cast<size_t>(c)] =
        ir::isFloating(dag_[id].type) ? interpolated(at_vertices) : at_vertices;
  }
}

void Intervals::matMul(ValueId id) {
  const Range element = at(dag_[id].args[0], 0);
  std::array<Range, 4> terms;
  const int width = ir::componentCount(dag_[id].type);
  for (int c = 0; c < width; ++c) terms[static_cast<size_t>(c)] = math_.mul(element, at(dag_[id].args[1], c));
  rangesOf(id).fill(math_.sum({terms.data(), static_cast<size_t>(width)}));
}

void Intervals::vectorOp(ValueId id) {
  const ir::Value& value = dag_[id];
  Ranges& out = rangesOf(id);
  const ValueId a = value.args[0];
  if (value.op == Op::Swizzle) {
    for (int c = 0; c < ir::componentCount(value.type); ++c) {
      out[static_cast<size_t>(c)] = at(a, ir::swizzleComponent(value.payload, c));
    }
  } else if (value.op == Op::Construct && ir::isMatrix(value.type)) {
    Range all = at(a, 0);
    for (const ValueId part : value.operands()) {
      for (int c = 0; c < std::min(ir::componentCount(dag_[part].type), 4); ++c) all = hull(all, at(part, c));
    }
    out.fill(all);
  } else if (value.op == Op::Construct) {
    size_t next = 0;
    for (const ValueId part : value.operands()) {
      for (int c = 0; c < ir::componentCount(dag_[part].type); ++c) out[next++] = at(part, c);
    }
    if (value.count == 1) out.fill(at(a, 0));
  } else if (value.op == Op::Cross) {
    const ValueId b = value.args[1];
    for (int c = 0; c < 3; ++c) {
      const int i = (c + 1) % 3;
      const int j = (c + 2) % 3;
      out[static_cast<size_t>(c)] = math_.sub(math_.mul(at(a, i), at(b, j)), math_.mul(at(a, j), at(b, i)));
    }
  } else {
    const Range squared = dot(a, a);
    const double end = 1 + math_.slack();
    const bool nan =
        squared.nan || squared.contains(0) || squared.hi == std::numeric_limits<double>::infinity();
    for (int c = 0; c < ir::componentCount(value.type); ++c) {
      const Range& x = at(a, c);
      out[static_cast<size_t>(c)] =
          nan ? math_.whole(true) : Range{x.lo >= 0 ? 0 : -end, x.hi <= 0 ? 0 : end, false};
    }
  }
}

Range Intervals::dot(ValueId a, ValueId b) const {
  std::array<Range, 4> terms;
  const int n = ir::componentCount(dag_[a].type);
  for (int c = 0; c < n; ++c) {
    terms[static_cast<size_t>(c)] = a == b ? math_.square(at(a, c)) : math_.mul(at(a, c), at(b, c));
  }
  return math_.sum({terms.data(), static_cast<size_t>(n)});
}

Range Intervals::component(ValueId id, int c) const {
  const ir::Value& value = dag_[id];
  const RangeMath& m = math_;
  const auto x = [&](size_t k) -> const Range& { return at(value.args[k], c); };
  const auto truth = [] { return Range{0, 1, false}; };
  switch (value.op) {
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, work) \
  case Op::e:                                                                                        \
    return range;
#include "ir/facts.def"
#undef FACTS
  }
  return m.whole(true);
}

Range Intervals::literal(ValueId id, int c) const {
  return math_.constant(dag_.constantOf(id)[static_cast<size_t>(c)]);
}

/// Of what evaluate() has said already, for all components at once.
Range Intervals::stored(ValueId id, int c) const {
  return values_[facets_[id].place][static_cast<size_t>(c)];
}

Range Intervals::element(const ir::Value& value) const {
  const auto [block, field] = ir::ListField::of(value);
  const ir::BlockField& of = module_.blocks[block].fields[field];
  return of.type == ir::Type::Int ? meet(kWholes, {of.range.lo, of.range.hi, false}) : open(of.range);
}

Range Intervals::product(ValueId id, int c) const {
  const ValueId a = dag_[id].args[0];
  const ValueId b = dag_[id].args[1];
  if (a == b) return math_.square(at(a, c));
  const Range plain = math_.mul(at(a, c), at(b, c));
  // (k * x) * x has the sign of k.
  for (const auto& [one, other] : {std::pair{a, b}, std::pair{b, a}}) {
    const ir::Value& inner = dag_[one];
    if (inner.op != Op::Mul) continue;
    for (const size_t k : {size_t{0}, size_t{1}}) {
      if (inner.args[k] != other) continue;
      const Range& factor = at(inner.args[1 - k], c);
      const double inf = std::numeric_limits<double>::infinity();
      return meet(plain, {factor.lo >= 0 ? 0 : -inf, factor.hi <= 0 ? 0 : inf, true});
    }
  }
  return plain;
}

Range Intervals::comparison(ValueId id) const {
  const ir::Value& value = dag_[id];
  const Range& a = at(value.args[0], 0);
  const Range& b = value.count > 1 ? at(value.args[1], 0) : a;
  const bool nan = a.nan || b.nan;
  const auto known = [&](bool yes, bool no) {
    return Range{yes && !nan ? 1.0 : 0.0, no && !nan ? 0.0 : 1.0, false};
  };
  if (value.op == Op::Less) return known(a.hi < b.lo, a.lo >= b.hi);
  if (value.op == Op::LessEqual) return known(a.hi <= b.lo, a.lo > b.hi);
  if (value.op == Op::And) return {std::min(a.lo, b.lo), std::min(a.hi, b.hi), false};
  if (value.op == Op::Or) return {std::max(a.lo, b.lo), std::max(a.hi, b.hi), false};
  if (value.op == Op::Not) return {1 - a.hi, 1 - a.lo, false};
  return known(a.lo == a.hi && b.lo == b.hi && a.lo == b.lo, a.hi < b.lo || b.hi < a.lo);  // equal
}

Range Intervals::select(ValueId id, int c) const {
  const ir::Value& value = dag_[id];
  const Range& condition = at(value.args[0], 0);
  const Range& yes = at(value.args[1], c);
  const Range& no = at(value.args[2], c);
  if (condition.lo == 1) return yes;
  if (condition.hi == 0) return no;
  return hull(yes, no);
}

Range Intervals::derivative(ValueId id, int c) const {
  // The difference of two neighbours.
  const Range& a = at(dag_[id].args[0], c);
  return math_.sub(a, a);
}

/// Under multisampling a value may be taken outside of its triangle: by no more than the values in it differ.
/// The exact function is that of points of the triangle.
Range Intervals::interpolated(const Range& a) const {
  if (options_.arithmetic == Arithmetic::Real) return a;
  const Range beyond = math_.sub(a, a);
  return math_.widened(math_.add(a, beyond), math_.slack(), 0);
}

Range Intervals::lights(ValueId id, int c) const {
  const ir::Value& value = dag_[id];
  const Range& a = at(value.args[0], c);
  const double inf = std::numeric_limits<double>::infinity();
  if (value.payload < module_.light_groups.size() &&
      module_.light_groups[value.payload].count == ir::LightGroup::kListed) {
    // However many there are: only the sign is left.
    return {a.lo >= 0 ? 0 : -inf, a.hi <= 0 ? 0 : inf, a.nan || (a.lo < 0 && a.hi > 0)};
  }
  double most = 0;
  for (const ir::Block& block : module_.blocks) {
    if (block.role == ir::BlockRole::Lights) most = block.array;
  }
  double least = 0;
  if (value.payload < module_.light_groups.size() && module_.light_groups[value.payload].count >= 0) {
    least = most = module_.light_groups[value.payload].count;
  }
  const Range count{least, most, false};
  Range total = math_.mul(a, count);
  // `most` additions, each rounded; they keep the sign of terms of one sign.
  const Range wide = math_.widened(total, most * math_.ulp(), 0);
  const double magnitude = std::max(std::abs(wide.lo), std::abs(wide.hi)) * most * math_.ulp();
  const Range wider = math_.widened(wide, 0, std::isfinite(magnitude) ? magnitude : 0);
  total.lo = a.lo >= 0 ? std::max(wider.lo, 0.0) : wider.lo;
  total.hi = a.hi <= 0 ? std::min(wider.hi, 0.0) : wider.hi;
  // An infinite term beside one of the other sign.
  total.nan = a.nan || (total.lo == -inf && total.hi == inf && options_.arithmetic != Arithmetic::Real);
  return total;
}

}  // namespace lacquer::analysis
