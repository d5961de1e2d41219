#include "stress/attack.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "support/jobs.h"

namespace lacquer::stress {

namespace {

constexpr size_t kChunk = 1024;  ///< samples of a task; a multiple of 4
/// Thresholds are probed between the samples of one chunk of so many: a bisection takes many evaluations.
constexpr uint64_t kProbed = 8;
constexpr size_t kMostCrossings = 16;  ///< of a threshold in a chunk
/// Halvings: afterwards the two sides differ in the last bits of a double.
constexpr int kHalvings = 50;
/// How often that begins anew between the sides found: a length that vanishes at one end, such as a normal's,
/// turns within the last step of the first round, and every cosine with it.
constexpr int kRounds = 3;
/// A step of a result that counts as a jump, relative to 1 and to the result: above what steep functions do
/// over two neighbouring doubles, and below what an eye sees.
constexpr double kJump = 1e-3;

/// What a comparison compares moves less than this part of the step where it turns: over two neighbouring
/// doubles even steep numbers move by a millionth.
constexpr double kCarried = 1e-3;

using Key = std::pair<Fault, std::string>;

struct Found {
  uint64_t count = 0;
  std::vector<double> input;  ///< of the first
};
using Finds = std::map<Key, Found>;

/// At half precision the open ends of ranges (beyond all halves) are cut here: that a radiance of 2^27 is
/// infinite there needs no test.
constexpr double kHalfLimit = 1000;

void cutOpenEnds(const Subject& subject, std::span<double> samples) {
  const size_t width = subject.space.width();
  for (const Variable& variable : subject.space.variables()) {
    if (variable.range.hi <= 65530 && variable.range.lo >= -65530) continue;
    for (size_t i = 0; i < samples.size(); i += width) {
      for (int c = 0; c < variable.components; ++c) {
        double& x = samples[i + variable.first + static_cast<size_t>(c)];
        x = std::clamp(x, -kHalfLimit, kHalfLimit);
      }
    }
  }
}

void checkValues(const Subject& subject, const Values& values, std::span<const double> samples, size_t count,
                 Finds& finds) {
  const size_t width = subject.space.width();
  for (size_t r = 0; r < subject.roots.size(); ++r) {
    for (size_t i = 0; i < count; ++i) {
      Fault fault{};
      double value = 0;
      if (!faultAt(subject.roots[r], values[r], i, fault, value)) continue;
      Found& found = finds[{fault, subject.roots[r].name}];
      if (found.count++ > 0) continue;
      const size_t first = i / subject.group * subject.group;
      const std::span<const double> of = samples.subspan(first * width, subject.group * width);
      found.input.assign(of.begin(), of.end());
    }
  }
}

/// Two sides of a threshold, as parts of the way from one sample to the next.
struct Crossing {
  size_t root = 0;
  std::vector<double> a, b;
  double below = 0, above = 1;
  bool turned = false;  ///< the condition at `below`
};

/// The two sides of each crossing, group by group, below first.
std::vector<double> sides(const Subject& subject, const Crossing& c) {
  const size_t width = subject.space.width();
  std::vector<double> samples(2 * subject.group * width);
  for (size_t side = 0; side < 2; ++side) {
    for (size_t g = 0; g < subject.group; ++g) {
      subject.space.between(std::span(c.a).subspan(g * width, width),
                            std::span(c.b).subspan(g * width, width), side == 0 ? c.below : c.above,
                            std::span(samples).subspan((side * subject.group + g) * width, width));
    }
  }
  return samples;
}

/// Whether all directions of these samples have a length: between opposite ones lies none.
bool directed(const Subject& subject, std::span<const double> samples) {
  constexpr double kShort =
      1e-9;  // far above what the halvings leave of the way, far below any that is drawn
  for (size_t first = 0; first < samples.size(); first += subject.space.width()) {
    for (const Variable& variable : subject.space.variables()) {
      if (variable.nature != Nature::Direction) continue;
      const double* x = samples.data() + first + variable.first;
      if (std::hypot(x[0], x[1], x[2]) < kShort) return false;
    }
  }
  return true;
}

/// Goes on between the two sides that were found: the way's parts are the finest near its own ends.
void recentre(const Subject& subject, Crossing& c) {
  const std::vector<double> found = sides(subject, c);
  if (!directed(subject, found)) return;
  const auto middle = found.begin() + static_cast<ptrdiff_t>(found.size() / 2);
  c.a.assign(found.begin(), middle);
  c.b.assign(middle, found.end());
  c.below = 0;
  c.above = 1;
}

/// Halves all of them at once.
void bisect(const Subject& subject, std::vector<Crossing>& crossings) {
  const size_t width = subject.space.width() * subject.group;
  std::vector<double> samples(crossings.size() * width);
  for (int step = 0; step < kRounds * kHalvings; ++step) {
    for (size_t k = 0; k < crossings.size(); ++k) {
      Crossing& c = crossings[k];
      if (step % kHalvings == 0) recentre(subject, c);
      for (size_t g = 0; g < subject.group; ++g) {
        const size_t from = g * subject.space.width();
        subject.space.between(std::span(c.a).subspan(from, subject.space.width()),
                              std::span(c.b).subspan(from, subject.space.width()), 0.5 * (c.below + c.above),
                              std::span(samples).subspan(k * width + from, subject.space.width()));
      }
    }
    const Values values = subject.evaluate(Arithmetic::Double, samples, crossings.size() * subject.group);
    for (size_t k = 0; k < crossings.size(); ++k) {
      Crossing& c = crossings[k];
      const bool here = values[c.root][k * subject.group] != 0;
      (here == c.turned ? c.below : c.above) = 0.5 * (c.below + c.above);
    }
  }
}

/// How far results are apart at the two sides, relative to 1 and to them.
double heightOf(const Subject& subject, const Values& values, size_t below, size_t above) {
  double height = 0;
  for (size_t r = 0; r < subject.roots.size(); ++r) {
    if (subject.roots[r].kind != Root::Kind::Result || subject.roots[r].flag) continue;
    const auto n = static_cast<size_t>(subject.roots[r].components);
    for (size_t c = 0; c < n; ++c) {
      const double x = values[r][below * n + c];
      const double y = values[r][above * n + c];
      const double d = std::abs(x - y) / (1 + std::max(std::abs(x), std::abs(y)));
      height = std::max(height, std::isnan(d) ? 0 : d);  // what is no number has been found before
    }
  }
  return height;
}

/// By how much the numbers that a condition compares move between the two sides; nothing where it compares
/// none.
std::optional<double> movedBy(const Subject& subject, const Values& values, size_t condition, size_t below,
                              size_t above) {
  const size_t gap = condition + 1;
  if (gap == subject.roots.size() || subject.roots[gap].kind != Root::Kind::Gap) return std::nullopt;
  return std::abs(values[gap][below] - values[gap][above]);
}

/// A height that is the condition's own doing, and else 0. What compares numbers that jump themselves has not
/// made the jump: what has made theirs has, a comparison that turns there, too, of numbers that move less.
double blamed(const Subject& subject, const Values& values, size_t condition, size_t below, size_t above) {
  const double height = heightOf(subject, values, below, above);
  const std::optional<double> moved = movedBy(subject, values, condition, below, above);
  if (!moved) return height;
  if (*moved > kCarried * height) return 0;
  for (size_t r = 0; r < subject.roots.size(); ++r) {
    if (subject.roots[r].kind != Root::Kind::Condition || values[r][below] == values[r][above]) continue;
    if (movedBy(subject, values, r, below, above).value_or(*moved) < kCarried * *moved) return 0;
  }
  return height;
}

void probe(const Subject& subject, std::span<const double> samples, size_t count, Finds& finds) {
  const size_t width = subject.space.width() * subject.group;
  const size_t groups = count / subject.group;
  if (groups < 2) return;
  // Flags are those of the first of a pair, or they would turn conditions themselves.
  std::vector<double> ends(2 * (groups - 1) * width);
  for (size_t k = 0; k + 1 < groups; ++k) {
    std::copy_n(samples.data() + k * width, width, ends.data() + 2 * k * width);
    for (size_t g = 0; g < subject.group; ++g) {
      const size_t from = k * width + g * subject.space.width();
      subject.space.between(
          samples.subspan(from, subject.space.width()), samples.subspan(from + width, subject.space.width()),
          1, std::span(ends).subspan((2 * k + 1) * width + g * subject.space.width(), subject.space.width()));
    }
  }
  const Values at_ends = subject.evaluate(Arithmetic::Double, ends, 2 * (groups - 1) * subject.group);
  std::vector<Crossing> crossings;
  for (size_t r = 0; r < subject.roots.size(); ++r) {
    if (subject.roots[r].kind != Root::Kind::Condition) continue;
    size_t taken = 0;
    for (size_t k = 0; k + 1 < groups && taken < kMostCrossings; ++k) {
      const bool first = at_ends[r][2 * k * subject.group] != 0;
      if (first == (at_ends[r][(2 * k + 1) * subject.group] != 0)) continue;
      ++taken;
      const double* a = ends.data() + 2 * k * width;
      crossings.push_back({r, {a, a + width}, {a + width, a + 2 * width}, 0, 1, first});
    }
  }
  if (crossings.empty()) return;
  bisect(subject, crossings);
  std::vector<double> both;
  std::erase_if(crossings, [&](const Crossing& c) { return !directed(subject, sides(subject, c)); });
  for (const Crossing& c : crossings) {
    const std::vector<double> own = sides(subject, c);
    both.insert(both.end(), own.begin(), own.end());
  }
  const Values values = subject.evaluate(Arithmetic::Double, both, 2 * crossings.size() * subject.group);
  for (size_t k = 0; k < crossings.size(); ++k) {
    if (blamed(subject, values, crossings[k].root, 2 * k * subject.group, (2 * k + 1) * subject.group) <
        kJump)
      continue;
    Found& found = finds[{Fault::Jump, subject.roots[crossings[k].root].name}];
    if (found.count++ == 0)
      found.input.assign(both.begin() + static_cast<ptrdiff_t>(2 * k * width),
                         both.begin() + static_cast<ptrdiff_t>(2 * (k + 1) * width));
  }
}

Finds attackChunk(const Subject& subject, const Plan& plan, uint64_t chunk) {
  const uint64_t left = plan.samples - chunk * kChunk;
  const size_t count = (static_cast<size_t>(std::min<uint64_t>(left, kChunk)) + 3) / 4 * 4;
  std::vector<double> samples;
  drawSamples(subject, plan.seed, chunk * kChunk, count, samples);
  if (plan.half) cutOpenEnds(subject, samples);
  Finds finds;
  checkValues(subject, subject.evaluate(plan.half ? Arithmetic::Half : Arithmetic::Float, samples, count),
              samples, count, finds);
  if (!plan.half && chunk % kProbed == 0) probe(subject, samples, count, finds);
  return finds;
}

/// Replaces component by component by plainer numbers as long as the fault stays. The samples of a group, and
/// the sides of a jump, get the same number.
void minimise(const Subject& subject, Finding& finding) {
  const size_t width = subject.space.width();
  for (int round = 0; round < 2; ++round) {
    for (const Variable& variable : subject.space.variables()) {
      for (size_t c = variable.first; c < variable.first + static_cast<size_t>(variable.components); ++c) {
        for (const double x : plainer(variable, finding.input[c])) {
          std::vector<double> candidate = finding.input;
          for (size_t i = c; i < candidate.size(); i += width) candidate[i] = x;
          double value = 0;
          if (!shows(subject, finding.fault, finding.what, candidate, value)) continue;
          finding.input = std::move(candidate);
          break;
        }
      }
    }
  }
  shows(subject, finding.fault, finding.what, finding.input, finding.value);
}

/// At half precision the input still shows it by another value than in float.
void valueAtHalf(const Subject& subject, Finding& finding) {
  const Values values = subject.evaluate(Arithmetic::Half, finding.input, subject.group);
  for (size_t r = 0; r < subject.roots.size(); ++r) {
    for (size_t i = 0; i < subject.group; ++i) {
      Fault fault{};
      double value = 0;
      if (faultAt(subject.roots[r], values[r], i, fault, value) && fault == finding.fault &&
          subject.roots[r].name == finding.what) {
        finding.value = value;
        return;
      }
    }
  }
}

}  // namespace

bool faultAt(const Root& root, const std::vector<double>& values, size_t sample, Fault& fault,
             double& value) {
  if (root.kind == Root::Kind::Gap) return false;
  for (int c = 0; c < root.components; ++c) {
    const double x = values[sample * static_cast<size_t>(root.components) + static_cast<size_t>(c)];
    value = x;
    if (std::isnan(x)) return fault = Fault::NaN, true;
    if (root.kind == Root::Kind::Condition) continue;
    if (std::isinf(x)) return fault = Fault::Infinity, true;
    if (root.allowed.contains(x)) continue;
    fault = root.kind == Root::Kind::Fact   ? Fault::Assume
            : root.allowed.lo == 0 && x < 0 ? Fault::Negative
                                            : Fault::Range;
    return true;
  }
  return false;
}

void drawSamples(const Subject& subject, uint64_t seed, uint64_t first, size_t count,
                 std::vector<double>& samples) {
  const size_t width = subject.space.width();
  samples.resize(count * width);
  const uint64_t own = mixed(seed, subject.name);
  for (size_t i = 0; i < count; ++i) {
    const uint64_t at = first + i;
    subject.space.draw(mixed(mixed(own, at / kChunk), at % kChunk),
                       std::span(samples).subspan(i * width, width));
  }
}

std::vector<double> plainer(const Variable& variable, double x) {
  std::vector<double> tries = {0, 1, 0.5, variable.range.lo, variable.range.hi};
  for (const double scale : {1.0, 10.0, 100.0, 1000.0, 1e5}) tries.push_back(std::round(x * scale) / scale);
  std::erase_if(tries, [&](double y) {
    return !(y >= variable.range.lo && y <= variable.range.hi) || !std::isfinite(y) ||
           (variable.nature == Nature::Flag && y != 0 && y != 1) ||
           (variable.nature == Nature::Whole && y != std::trunc(y)) ||
           (variable.nature == Nature::Index && y > 0 && y < 1);
  });
  // Only what is plainer than `x` itself comes into question, so that this ends.
  const auto own = std::find(tries.begin(), tries.end(), x);
  tries.erase(own, tries.end());
  return tries;
}

bool shows(const Subject& subject, Fault fault, const std::string& what, std::span<const double> input,
           double& value) {
  const size_t count = input.size() / subject.space.width();
  if (fault == Fault::Jump) {
    const Values values = subject.evaluate(Arithmetic::Double, input, count);
    value = 0;
    for (size_t r = 0; r < subject.roots.size(); ++r) {
      if (subject.roots[r].kind == Root::Kind::Condition && subject.roots[r].name == what &&
          values[r][0] != values[r][subject.group])
        value = std::max(value, blamed(subject, values, r, 0, subject.group));
    }
    return value >= kJump;
  }
  const Values values = subject.evaluate(Arithmetic::Float, input, count);
  for (size_t r = 0; r < subject.roots.size(); ++r) {
    if (subject.roots[r].name != what) continue;
    for (size_t i = 0; i < count; ++i) {
      Fault own{};
      if (faultAt(subject.roots[r], values[r], i, own, value) && own == fault) return true;
    }
  }
  return false;
}

Report replay(const Subject& subject, std::span<const double> input) {
  Report report{subject.name, subject.is_node, 1, {}, {}};
  const size_t count = input.size() / subject.space.width();
  Finds finds;
  checkValues(subject, subject.evaluate(Arithmetic::Float, input, count), input, count, finds);
  for (auto& [key, found] : finds)
    report.findings.push_back({key.first, key.second, found.count, 0, found.input, {}});
  for (Finding& finding : report.findings)
    shows(subject, finding.fault, finding.what, finding.input, finding.value);
  for (size_t r = 0; r < subject.roots.size() && count == 2 * subject.group; ++r) {
    double height = 0;
    if (subject.roots[r].kind != Root::Kind::Condition ||
        !shows(subject, Fault::Jump, subject.roots[r].name, input, height))
      continue;
    report.findings.push_back(
        {Fault::Jump, subject.roots[r].name, 1, height, {input.begin(), input.end()}, {}});
  }
  return report;
}

Report attack(const Subject& subject, const Plan& plan) {
  Report report;
  report.name = subject.name;
  report.is_node = subject.is_node;
  report.samples = plan.samples;
  const uint64_t chunks = (plan.samples + kChunk - 1) / kChunk;
  // Some at a time, so that memory does not grow with the samples; added up in their order.
  constexpr uint64_t kAtOnce = 256;
  Finds all;
  for (uint64_t first = 0; first < chunks; first += kAtOnce) {
    std::vector<Finds> finds(static_cast<size_t>(std::min(kAtOnce, chunks - first)));
    inParallel(finds.size(), [&](size_t i) { finds[i] = attackChunk(subject, plan, first + i); });
    for (Finds& own : finds) {
      for (auto& [key, found] : own) {
        Found& sum = all[key];
        if (sum.count == 0) sum.input = std::move(found.input);
        sum.count += found.count;
      }
    }
  }
  for (auto& [key, found] : all) {
    Finding finding{key.first, key.second, found.count, 0, std::move(found.input), {}};
    if (plan.half)
      valueAtHalf(subject, finding);
    else
      minimise(subject, finding);
    if (finding.fault == Fault::Jump) finding.known = knownJump(subject, finding.what);
    report.findings.push_back(std::move(finding));
  }
  // Without tangents it is the same light, four times as dear.
  if (!subject.is_node && !plan.half && subject.lanes == 1) measureLight(subject, plan, report);
  return report;
}

}  // namespace lacquer::stress

namespace lacquer {

std::string_view faultName(Fault fault) {
  switch (fault) {
    case Fault::NaN: return "nan";
    case Fault::Infinity: return "infinity";
    case Fault::Negative: return "negative";
    case Fault::Range: return "range";
    case Fault::Assume: return "assume";
    case Fault::Jump: return "jump";
    case Fault::Reciprocity: return "reciprocity";
    case Fault::Energy: return "energy";
    case Fault::Device: return "device";
    case Fault::Form: return "form";
  }
  return {};  // no enumerator
}

}  // namespace lacquer
