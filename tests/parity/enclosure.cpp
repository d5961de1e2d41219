#include "parity/enclosure.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "eval/program.h"
#include "ir/fold.h"

namespace lacquer::parity {

using analysis::Range;
using ir::Op;
using ir::ValueId;

namespace {

constexpr double kUlp = 0x1p-23;
constexpr double kPi = 3.14159265358979323846;

Range boolean(bool yes, bool no) { return {yes ? 1.0 : 0.0, no ? 0.0 : 1.0, false}; }

Range comparison(Op op, const Range& a, const Range& b) {
  const bool nan = a.nan || b.nan;
  if (op == Op::Less) return boolean(a.hi < b.lo && !nan, a.lo >= b.hi && !nan);
  if (op == Op::LessEqual) return boolean(a.hi <= b.lo && !nan, a.lo > b.hi && !nan);
  return boolean(a.lo == a.hi && a == b && !nan, (a.hi < b.lo || b.hi < a.lo) && !nan);
}

}  // namespace

Enclosure::Enclosure(const ir::Module& module, const eval::Bindings& bindings,
                     const std::map<std::string, TextureSize>& sizes, const EnclosureOptions& options)
    : module_(module),
      dag_(module.dag),
      bindings_(bindings),
      sizes_(sizes),
      options_(options),
      math_(analysis::Arithmetic::Vulkan),
      values_(module.dag.size()) {
  std::vector<ValueId> all(dag_.size());
  std::iota(all.begin(), all.end(), ValueId{0});
  loops_ = ir::Loops(dag_, all);
  for (ValueId id = 0; id < dag_.size(); ++id) {
    if (dag_[id].op == Op::SumOverLights) bodies_[id] = ir::reachable(dag_, {{dag_[id].args[0]}});
  }
}

int Enclosure::width(ValueId id) const { return std::min(ir::componentCount(dag_[id].type), 4); }

const Range& Enclosure::get(ValueId id, size_t component) const {
  return values_[id][width(id) == 1 ? 0 : component];
}

bool Enclosure::varies(ValueId id) const { return dag_[id].rate == ir::Rate::Light; }

std::vector<Range> Enclosure::at(size_t point, const std::vector<ValueId>& roots) {
  point_ = point;
  for (const ValueId id : ir::reachable(dag_, roots)) {
    if (!varies(id)) value(id, -1);
  }
  std::vector<Range> result;
  for (const ValueId root : roots) {
    for (int c = 0; c < width(root); ++c) result.push_back(get(root, static_cast<size_t>(c)));
  }
  return result;
}

/// A value that stands in the body of a loop, or of none; what stands deeper comes with its own loop.
void Enclosure::value(ValueId id, int32_t loop) {
  if (loops_.of(id) == loop) value(id);
}

void Enclosure::value(ValueId id) {
  const ir::Value& v = dag_[id];
  Ranges& out = values_[id];
  if (ir::makesLoop(v.op)) {
    const int32_t own = loops_.indexOf(id);
    if (loops_[own].last == id) rounds(own);
    return;
  }
  switch (v.op) {
    case Op::Carried: out = left_.at({v.args[0], v.payload}); return;
    case Op::Constant:
      for (size_t c = 0; c < 4; ++c) {
        const double x = dag_.constantOf(id)[c];
        out[c] = ir::isWhole(v.type) ? Range{x, x, false} : math_.constant(x);
      }
      return;
    case Op::Input: return input(id);
    case Op::Interpolate: out = values_[v.args[0]]; return;
    case Op::Swizzle:
      for (int c = 0; c < width(id); ++c) {
        out[static_cast<size_t>(c)] = get(v.args[0], static_cast<size_t>(ir::swizzleComponent(v.payload, c)));
      }
      return;
    case Op::Construct: {
      if (v.count == 1) return out.fill(get(v.args[0], 0));
      size_t next = 0;
      for (const ValueId part : v.operands()) {
        for (int c = 0; c < width(part); ++c) out[next++] = get(part, static_cast<size_t>(c));
      }
      return;
    }
    case Op::Dot: return out.fill(dot(v.args[0], v.args[1]));
    case Op::Length: return out.fill(math_.sqrt(dot(v.args[0], v.args[0])));
    case Op::Normalize: return normalize(id);
    case Op::Cross:
      for (size_t c = 0; c < 3; ++c) {
        const size_t i = (c + 1) % 3;
        const size_t j = (c + 2) % 3;
        out[c] = math_.sub(math_.mul(get(v.args[0], i), get(v.args[1], j)),
                           math_.mul(get(v.args[0], j), get(v.args[1], i)));
      }
      return;
    case Op::MatMul: return matrixTimesVector(id);
    case Op::Texture:
    case Op::TextureLod:
    case Op::TextureGrad: return texture(id);
    case Op::TextureSize: {
      const eval::Sampler& sampler =
          bindings_.textures.find(module_.textures[dag_.inputOf(v.args[0]).field].name)->second;
      const double texels = sampler.size.at(v.payload);
      return out.fill({texels, texels, false});
    }
    case Op::DFdx: return derivative(id, 1);
    case Op::DFdy: return derivative(id, 2);
    case Op::SumOverLights: return sumOverLights(id);
    case Op::ToInt:
      return out.fill(
          {std::trunc(get(v.args[0], 0).lo), std::trunc(get(v.args[0], 0).hi), get(v.args[0], 0).nan});
    case Op::Element: return element(id);
    default: return componentWise(id);
  }
}

/// A loop's rounds, and what is left of what it carries.
void Enclosure::rounds(int32_t number) {
  const ir::Loop& loop = loops_[number];
  std::vector<Ranges> state;
  for (const ir::Carry& carry : loop.carries) state.push_back(values_[carry.first]);
  const Range& end = get(loop.end, 0);
  const int32_t first = ir::firstRound(dag_, loop);
  const auto past = static_cast<double>(first) + ir::mostRounds(dag_, loop);
  // A number of rounds that is not known leaves nothing known.
  if (end.lo != end.hi)
    std::for_each(state.begin(), state.end(), [&](Ranges& one) { one.fill(math_.whole(true)); });
  const std::vector<ValueId> body = loops_.bodyOf(number);
  for (int32_t round = first; end.lo == end.hi && round < std::min(end.lo, past); ++round) {
    values_[loop.index].fill({static_cast<double>(round), static_cast<double>(round), false});
    for (size_t k = 0; k < state.size(); ++k) values_[loop.carries[k].value] = state[k];
    for (const ValueId part : body) value(part, number);
    for (size_t k = 0; k < state.size(); ++k) state[k] = values_[loop.carries[k].next];
  }
  for (size_t k = 0; k < state.size(); ++k)
    left_[{loop.last, dag_.inputOf(loop.carries[k].value).index}] = state[k];
}

void Enclosure::input(ValueId id) {
  const ir::Input& in = dag_.inputOf(id);
  if (ir::ofLoop(in.kind)) return;  // of this round
  if (in.kind == ir::InputKind::Texture || in.type == ir::Type::Mat4) return;
  if (in.kind == ir::InputKind::LightIndex) {
    return values_[id].fill({static_cast<double>(light_), static_cast<double>(light_), false});
  }
  const bool block = in.kind == ir::InputKind::BlockField;
  const bool lights = block && module_.blocks[in.block].role == ir::BlockRole::Lights;
  const size_t light = in.element >= 0 ? static_cast<size_t>(in.element) : light_;
  const eval::Columns& columns = lights ? bindings_.lights[light] : bindings_.columns;
  const auto column = columns.find(in.name);
  const bool material = in.kind == ir::InputKind::SpecConstant ||
                        (block && module_.blocks[in.block].role == ir::BlockRole::Material);
  for (int c = 0; c < width(id); ++c) {
    double x = 0;
    if (column != columns.end()) {
      const auto n = static_cast<size_t>(column->second.components);
      x = column->second.values[(column->second.per_point ? point_ * n : 0) + static_cast<size_t>(c)];
    } else {
      x = module_.parameters[in.field].value[static_cast<size_t>(c)];
    }
    const auto f = static_cast<double>(static_cast<float>(x));
    // A subnormal number may be read as zero.
    const bool small = std::abs(f) < FLT_MIN;
    const Range exact{small ? std::min(f, 0.0) : f, small ? std::max(f, 0.0) : f, false};
    if (bindings_.quads && in.kind == ir::InputKind::Varying && column->second.per_point) {
      double largest = 0;
      for (size_t k = 0; k < 4; ++k) {
        const size_t n = static_cast<size_t>(column->second.components);
        largest = std::max(
            largest, std::abs(column->second.values[(point_ / 4 * 4 + k) * n + static_cast<size_t>(c)]));
      }
      values_[id][static_cast<size_t>(c)] = math_.widened(exact, 0, 8 * kUlp * largest);
      continue;
    }
    values_[id][static_cast<size_t>(c)] =
        material && options_.rounded_parameters ? math_.widened(exact, kUlp, 0) : exact;
  }
}

void Enclosure::sumOverLights(ValueId id) {
  const ir::Value& v = dag_[id];
  const ir::LightGroup& group = module_.light_groups[v.payload];
  auto first = static_cast<size_t>(group.first);
  size_t last = group.count < 0 ? bindings_.lights.size() : first + static_cast<size_t>(group.count);
  Ranges sum{};
  if (group.count == ir::LightGroup::kListed) {
    // A range that is not known has a sum that is not known.
    const Range& from = get(v.args[1], 0);
    const Range& count = get(v.args[2], 0);
    if (from.lo != from.hi || count.lo != count.hi) return values_[id].fill(math_.whole(true));
    first = static_cast<size_t>(from.lo);
    last = first + static_cast<size_t>(count.lo);
  }
  for (light_ = first; light_ < last; ++light_) {
    for (const ValueId part : bodies_[id]) {
      if (varies(part)) value(part, -1);
    }
    for (size_t c = 0; c < 4; ++c) sum[c] = math_.add(sum[c], get(v.args[0], c));
  }
  values_[id] = sum;
}

/// All that elements of those numbers have.
void Enclosure::element(ValueId id) {
  const ir::ListField from = ir::ListField::of(dag_[id]);
  const ir::Block& block = module_.blocks[from.block];
  const Range& number = get(dag_[id].args[0], 0);
  const bool lights = block.role == ir::BlockRole::Lights;
  const std::vector<double> list =
      lights ? std::vector<double>() : eval::listValues(module_, bindings_, from);
  const auto most = static_cast<double>(lights ? bindings_.lights.size() : list.size()) - 1;
  const auto begin = static_cast<size_t>(std::clamp(number.lo, 0.0, most));
  const auto end = static_cast<size_t>(std::clamp(number.hi, 0.0, most));
  for (int c = 0; c < width(id); ++c) {
    std::optional<Range> all;
    for (size_t i = begin; i <= end; ++i) {
      double x = lights ? 0 : list[i];
      if (lights) {
        const eval::Column& column =
            bindings_.lights[i].at(block.instance + "." + block.fields[from.field].name);
        const auto n = static_cast<size_t>(column.components);
        x = column.values[(column.per_point ? point_ * n : 0) + static_cast<size_t>(c)];
      }
      all = all ? Range{std::min(all->lo, x), std::max(all->hi, x), false} : Range{x, x, false};
    }
    values_[id][static_cast<size_t>(c)] = *all;
  }
  for (size_t c = static_cast<size_t>(width(id)); c < 4; ++c) values_[id][c] = values_[id][0];
}

void Enclosure::texture(ValueId id) {
  const ir::Value& v = dag_[id];
  const std::string& name = module_.textures[dag_.inputOf(v.args[0]).field].name;
  const eval::Sampler& sampler = bindings_.textures.find(name)->second;
  const auto size = sizes_.find(name);
  std::array<std::array<double, 3>, 2> tries{};
  std::array<double, 3> middle{};
  for (int c = 0; c < width(v.args[1]); ++c) {
    const auto i = static_cast<size_t>(c);
    const Range& x = get(v.args[1], i);
    middle[i] = (x.lo + x.hi) / 2;
    // A coordinate is scaled by the size, in floats, and then cut to the filter's bits.
    const double texels = size == sizes_.end() ? 1 : c == 0 ? size->second.width : size->second.height;
    const double slack =
        std::exp2(-static_cast<double>(options_.sub_texel_bits)) / texels + 4 * kUlp * std::abs(middle[i]);
    tries[0][i] = x.lo - slack;
    tries[1][i] = x.hi + slack;
  }
  const std::array<double, 4> exact = sampler(point_, middle, 0);
  for (size_t c = 0; c < 4; ++c) values_[id][c] = {exact[c], exact[c], false};
  if (size == sizes_.end()) return;
  // So far out that floats do not tell texels apart: any of them (they are in [0, 1]).
  const double apart = std::max((tries[1][0] - tries[0][0]) * size->second.width,
                                (tries[1][1] - tries[0][1]) * size->second.height);
  if (!(apart < 0.5)) return values_[id].fill({0, 1, false});
  for (const double u : {tries[0][0], middle[0], tries[1][0]}) {
    for (const double w : {tries[0][1], middle[1], tries[1][1]}) {
      const std::array<double, 4> texel = sampler(point_, {u, w, 0}, 0);
      for (size_t c = 0; c < 4; ++c) values_[id][c] = hull(values_[id][c], {texel[c], texel[c], false});
    }
  }
  // Between those tries there may be a texel's centre, where the filter's slope changes.
  for (Range& range : values_[id]) range = math_.widened(range, 8 * kUlp, (range.hi - range.lo) / 2);
}

Range Enclosure::dot(ValueId a, ValueId b) const {
  std::array<Range, 4> terms;
  const auto n = static_cast<size_t>(width(a));
  for (size_t c = 0; c < n; ++c)
    terms[c] = a == b ? math_.square(get(a, c)) : math_.mul(get(a, c), get(b, c));
  return math_.sum({terms.data(), n});
}

void Enclosure::normalize(ValueId id) {
  const ValueId a = dag_[id].args[0];
  const Range squared = dot(a, a);
  for (int c = 0; c < width(id); ++c) {
    const Range& x = get(a, static_cast<size_t>(c));
    values_[id][static_cast<size_t>(c)] =
        hull(math_.mul(x, math_.inverseSqrt(squared)), math_.div(x, math_.sqrt(squared)));
  }
}

Range Enclosure::wave(const Range& a, double (*f)(double)) const {
  if (!a.finite() || a.lo < -kPi || a.hi > kPi) return math_.wave(a);
  const double x = f((a.lo + a.hi) / 2);
  return math_.widened({x, x, false}, 0, (a.hi - a.lo) / 2 + 0x1p-11);
}

/// `step` leads to the neighbour within the quad.
void Enclosure::derivative(ValueId id, size_t step) {
  Ranges& out = values_[id];
  if (!bindings_.quads) return out.fill({0, 0, false});  // all corners of the triangle are the same
  const ValueId a = dag_[id].args[0];
  const std::vector<ValueId> needed = ir::reachable(dag_, {{a}});
  const size_t here = point_;
  const std::vector<Ranges> kept = values_;
  std::array<Ranges, 4> at;
  for (size_t k = 0; k < 4; ++k) {
    point_ = here / 4 * 4 + k;
    for (const ValueId part : needed) value(part, -1);
    at[k] = values_[a];
  }
  point_ = here;
  values_ = kept;
  const size_t other = 3 - step;  // the other row or column: a device may give one derivative to all four
  for (size_t c = 0; c < 4; ++c) {
    values_[id][c] = hull(math_.sub(at[step][c], at[0][c]), math_.sub(at[3][c], at[other][c]));
  }
}

/// The matrix is a block's field, by columns.
void Enclosure::matrixTimesVector(ValueId id) {
  const eval::Column& matrix = bindings_.columns.find(dag_.inputOf(dag_[id].args[0]).name)->second;
  for (size_t row = 0; row < 4; ++row) {
    std::array<Range, 4> terms;
    for (size_t c = 0; c < 4; ++c) {
      const double x = matrix.values[4 * c + row];
      terms[c] = math_.mul({x, x, false}, get(dag_[id].args[1], c));
    }
    values_[id][row] = math_.sum(terms);
  }
}

Range Enclosure::regrouped(const Range& sum, const Range& a, const Range& b) const {
  if (!options_.regrouped) return sum;
  const double larger = std::max({std::abs(a.lo), std::abs(a.hi), std::abs(b.lo), std::abs(b.hi)});
  return std::isfinite(larger) ? math_.widened(sum, 0, larger * kUlp) : sum;
}

Range Enclosure::arithmetic(Op op, const Range& a, const Range& b, const Range& c) const {
  switch (op) {
    case Op::Neg: return math_.neg(a);
    case Op::Abs: return math_.abs(a);
    case Op::Sign: return math_.sign(a);
    case Op::Floor: return math_.floor(a);
    case Op::Ceil: return math_.ceil(a);
    case Op::Round: return math_.round(a);
    case Op::Trunc: return math_.trunc(a);
    case Op::Asin: return math_.asin(a);
    case Op::Tanh: return math_.tanh(a);
    case Op::Fract: {
      const bool whole = !a.finite() || std::floor(a.lo) != std::floor(a.hi);
      return whole ? math_.fract(a) : math_.sub(a, math_.floor(a));
    }
    case Op::Sqrt: return math_.sqrt(a);
    case Op::InverseSqrt: return math_.inverseSqrt(a);
    case Op::Exp2: return math_.exp2(a);
    case Op::Log2: return math_.log2(a);
    case Op::Exp: return math_.exp(a);
    case Op::Log: return math_.log(a);
    case Op::Sin: return wave(a, std::sin);
    case Op::Cos: return wave(a, std::cos);
    case Op::Acos: return math_.acos(a);
    case Op::Add: return regrouped(math_.add(a, b), a, b);
    case Op::Sub: return regrouped(math_.sub(a, b), a, b);
    case Op::Mul: return math_.mul(a, b);
    case Op::Div: return math_.div(a, b);
    case Op::Min: return math_.min(a, b);
    case Op::Max: return math_.max(a, b);
    case Op::Pow: return math_.pow(a, b);
    case Op::Atan2: return math_.atan2(a, b);
    case Op::Clamp: return math_.clamp(a, b, c);
    case Op::Mix:
      return hull(math_.add(math_.mul(a, math_.sub(math_.constant(1), c)), math_.mul(b, c)),
                  math_.add(a, math_.mul(math_.sub(b, a), c)));
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal: return comparison(op, a, b);
    case Op::And: return {std::min(a.lo, b.lo), std::min(a.hi, b.hi), false};
    case Op::Or: return {std::max(a.lo, b.lo), std::max(a.hi, b.hi), false};
    case Op::Not: return {1 - a.hi, 1 - a.lo, false};
    case Op::Select: return a.lo == 1 ? b : a.hi == 0 ? c : hull(b, c);
    default: return math_.whole(true);
  }
}

void Enclosure::componentWise(ValueId id) {
  const ir::Value& v = dag_[id];
  for (int c = 0; c < width(id); ++c) {
    const auto i = static_cast<size_t>(c);
    const Range& a = get(v.args[0], i);
    const Range& b = v.count > 1 ? get(v.args[1], i) : a;
    const Range& t = v.count > 2 ? get(v.args[2], i) : a;
    if (ir::isWhole(dag_[v.args[0]].type) && v.op != Op::Select) {  // integers are what they are
      const bool points = a.lo == a.hi && b.lo == b.hi && !a.nan && !b.nan;
      const double exact = points ? ir::foldComponent<double>(v.op, a.lo, b.lo, t.lo) : 0;
      values_[id][i] = points ? Range{exact, exact, false} : math_.whole(true);
      continue;
    }
    const bool square = v.op == Op::Mul && v.args[0] == v.args[1];
    values_[id][i] = square ? math_.square(a) : arithmetic(v.op, a, b, t);
  }
}

}  // namespace lacquer::parity
