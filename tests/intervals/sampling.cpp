#include "intervals/sampling.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lacquer::test {

bool drawable(const lang::NodeDecl& node) {
  const auto drawn = [](const lang::Param& param) {
    return !ir::isMatrix(param.type) && !ir::isWhole(ir::partType(param.type));
  };
  if (!std::all_of(node.params.begin(), node.params.end(), drawn) ||
      !std::all_of(node.results.begin(), node.results.end(), drawn))
    return false;
  return !node.origin.file.starts_with("nodes/standard/") || node.name.find('<') == std::string_view::npos ||
         node.name.ends_with("<vec3>");
}

namespace {

/// splitmix64, by Steele, Lea and Flood.
class Random {
public:
  explicit Random(uint64_t seed) : state_(seed) {}
  uint64_t next() {
    state_ += 0x9e3779b97f4a7c15U;
    uint64_t z = state_;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
    z = (z ^ z >> 27) * 0x94d049bb133111ebU;
    return z ^ z >> 31;
  }
  int below(int n) { return static_cast<int>(next() % static_cast<uint64_t>(n)); }
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }

private:
  uint64_t state_;
};

uint64_t mix(uint64_t seed, const void* bytes, size_t size) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (size_t i = 0; i < size; ++i) seed = (seed ^ at[i]) * 0x100000001b3U;
  return seed;
}

float inRange(Random& random, double lo, double hi, double limit) {
  const bool open = lo < -limit || hi > limit;
  lo = std::max(lo, -limit);
  hi = std::min(hi, limit);
  double x = 0;
  switch (random.below(open ? 10 : 6)) {
    case 0: x = lo; break;
    case 1: x = hi; break;
    case 2: x = random.below(2) == 0 ? 0 : lo + (hi - lo) * std::exp2(-30 * random.unit()); break;
    case 3: x = hi - (hi - lo) * std::exp2(-30 * random.unit()); break;
    case 4:
    case 5: x = lo + (hi - lo) * random.unit(); break;
    // Numbers as they occur.
    default: x = std::exp2(40 * random.unit() - 20) * (random.below(2) == 0 ? 1 : -1); break;
  }
  auto f = static_cast<float>(std::clamp(x, lo, hi));
  if (f > hi) f = std::nextafter(f, -INFINITY);
  if (f < lo) f = std::nextafter(f, INFINITY);
  return f;
}

float dot(const Floats& a, const Floats& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Floats scaled(const Floats& a, float s) { return {a[0] * s, a[1] * s, a[2] * s, 0}; }

Floats plus(const Floats& a, const Floats& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2], 0}; }

Floats cross(const Floats& a, const Floats& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0};
}

/// Of unit length up to float32's rounding, or zero.
Floats normalized(const Floats& a, Random& random) {
  const float length = std::sqrt(dot(a, a));
  if (!(length > 0)) return {};
  Floats unit =
      random.below(2) == 0 ? scaled(a, 1 / length) : Floats{a[0] / length, a[1] / length, a[2] / length, 0};
  // A unit in the last place more or less, as another GPU may round.
  for (int c = 0; c < 3; ++c) {
    float& x = unit[static_cast<size_t>(c)];
    if (random.below(4) == 0) x = std::nextafter(x, random.below(2) == 0 ? 2.0F : -2.0F);
    x = std::clamp(x, -1.0F, 1.0F);
  }
  return unit;
}

Floats direction(Random& random) {
  Floats a{};
  switch (random.below(12)) {
    case 0: return {};
    case 1: a[static_cast<size_t>(random.below(3))] = random.below(2) == 0 ? 1.0F : -1.0F; return a;
    default: break;
  }
  // A product of normal numbers is as likely in every direction; their tails do not matter here.
  for (int c = 0; c < 3; ++c) {
    const double radius = std::sqrt(-2 * std::log(1 - random.unit()));
    a[static_cast<size_t>(c)] = static_cast<float>(radius * std::cos(6.283185307179586 * random.unit()));
  }
  return normalized(a, random);
}

/// Near another direction, opposite it, or across it.
Floats related(const Floats& a, Random& random) {
  const Floats any = direction(random);
  switch (random.below(8)) {
    case 0: return a;
    case 1: return scaled(a, -1);
    case 2:
      return normalized(plus(a, scaled(any, static_cast<float>(std::exp2(-30 * random.unit())))), random);
    case 3: return normalized(plus(any, scaled(a, -dot(a, any))), random);
    case 4: {
      const Floats across = normalized(plus(any, scaled(a, -dot(a, any))), random);
      return normalized(plus(across, scaled(a, static_cast<float>(std::exp2(-30 * random.unit())))), random);
    }
    default: return any;
  }
}

}  // namespace

World::World(uint64_t seed, double limit) : seed_(Random(seed).next()), limit_(limit) { makeGeometry(); }

void World::makeGeometry() {
  Random random(seed_);
  n_ = direction(random);
  v_ = related(n_, random);
  l_ = random.below(2) == 0 ? related(v_, random) : related(n_, random);
  const Floats any = direction(random);
  t_ = normalized(plus(any, scaled(n_, -dot(n_, any))), random);
  // Across the normal after rounding too: one more step of Gram and Schmidt.
  t_ = normalized(plus(t_, scaled(n_, -dot(n_, t_))), random);
  b_ = cross(n_, t_);
}

bool World::geometry(std::string_view name, Floats& out) const {
  const auto scalar = [&](float x) { return out = {x, x, x, x}, true; };
  const Floats sum = plus(v_, l_);
  const float n_dot_l = std::clamp(dot(n_, l_), 0.0F, 1.0F);
  if (name == "N") return out = n_, true;
  if (name == "V") return out = v_, true;
  if (name == "L") return out = l_, true;
  if (name == "T") return out = t_, true;
  if (name == "B") return out = b_, true;
  if (name == "sum") return out = sum, true;
  if (name == "length2") return scalar(dot(sum, sum));
  if (name == "NdotL") return scalar(n_dot_l);
  if (name == "NdotV") return scalar(std::abs(dot(n_, v_)));
  if (name == "NdotSum") return scalar(n_dot_l + dot(n_, v_));
  if (name == "BdotV") return scalar(dot(b_, v_));
  if (name == "BdotL") return scalar(dot(b_, l_));
  return false;
}

Floats World::input(const ir::Input& input) const {
  Random random(mix(seed_, input.name.data(), input.name.size()));
  Floats out{};
  if (geometry(input.name, out)) return out;
  const int width = std::min(ir::componentCount(input.type), 4);
  if (input.type == ir::Type::Bool) return {static_cast<float>(random.below(2)), 0, 0, 0};
  const bool is_direction = width >= 2 && input.range.lo == -1 && input.range.hi == 1;
  if (input.name == "light.positional" || input.name == "positional")
    return {static_cast<float>(seed_ >> 7 & 1U)};
  if ((input.name == "light.position" || input.name == "position") && (seed_ >> 7 & 1U) == 0 &&
      input.kind != ir::InputKind::Attribute) {
    // Of a directional light it is the unit direction.
    return direction(random);
  }
  if (is_direction && width == 2) {
    const double angle = 6.283185307179586 * random.unit();
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0, 0};
  }
  if (is_direction || input.name == "VIEW" || input.name == "LIGHT") return direction(random);
  const bool vertex = input.kind == ir::InputKind::Attribute || input.kind == ir::InputKind::Varying;
  if (vertex && (input.name == "NORMAL" || input.name == "TANGENT")) {
    out = direction(random);
    out[3] = random.below(2) == 0 ? 1.0F : -1.0F;
    return out;
  }
  const bool color = vertex && input.name.starts_with("COLOR_");
  for (int c = 0; c < width; ++c) {
    if (color) {
      out[static_cast<size_t>(c)] = inRange(random, 0, 1, limit_);
      continue;
    }
    out[static_cast<size_t>(c)] = inRange(random, input.range.lo, input.range.hi, limit_);
  }
  return out;
}

Floats World::texel(bool environment, std::string_view texture, const Floats& coordinates) const {
  Random random(mix(mix(seed_, texture.data(), texture.size()), coordinates.data(), sizeof coordinates));
  Floats out{};
  // The two channels of a table add up to an albedo, or are in [0, 1], which their nodes state.
  const bool table = texture == "environment_dfg" || texture == "environment_sheen";
  const double least = table ? 0.15 : 0;
  const double most = table ? 0.5 : environment ? 65504 : 1;
  for (float& x : out) x = inRange(random, least, most, limit_);
  return out;
}

Floats World::difference(const Floats& value, int axis) const {
  Random random(mix(seed_ + static_cast<uint64_t>(axis), value.data(), sizeof value));
  Floats out{};
  // Neighbours are alike, or not.
  const double scale = random.below(4) == 0 ? limit_ : std::exp2(20 * random.unit() - 20);
  for (float& x : out) x = inRange(random, -scale, scale, limit_);
  return out;
}

int World::lights(int most) const { return Random(seed_ ^ 0x11U).below(most + 1); }

}  // namespace lacquer::test
