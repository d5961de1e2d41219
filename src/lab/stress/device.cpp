#include "stress/device.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace lacquer::stress {

namespace {

constexpr size_t kBatch = 8192;  ///< samples of a run; a multiple of 4
/// What differs by less, relative to the value and absolutely, needs no explanation.
constexpr double kRelative = 1e-3;
constexpr double kAbsolute = 1e-6;
/// Evaluations of what differs with other results that Vulkan allows, from few to many as long as it stays
/// unexplained.
constexpr uint64_t kTries[] = {16, 112, 384};
/// A device may go as far again beyond what those reach.
constexpr double kBeyond = 1;

using Key = std::pair<Fault, std::string>;

struct Difference {
  uint64_t count = 0;
  double value = 0;
  std::vector<double> input;  ///< the group of the first
};
using Differences = std::map<Key, Difference>;

/// What the CPU may give for a number: the ends of all that was seen.
struct Seen {
  double lo = std::numeric_limits<double>::infinity();
  double hi = -lo;
  bool vague = false;  ///< no number, or none that is finite, was among them

  void add(double x) {
    vague |= !std::isfinite(x);
    lo = std::min(lo, x);
    hi = std::max(hi, x);
  }
  bool explains(double x) const {
    if (vague) return true;
    const double size = std::max(std::abs(lo), std::abs(hi));
    const double room = kBeyond * (hi - lo) + kRelative * size + kAbsolute;
    return x >= lo - room && x <= hi + room;
  }
};

size_t widthOf(const Subject& subject) { return subject.space.width(); }

/// A number of the device's that the CPU's float does not explain.
struct Suspect {
  size_t root = 0, component = 0;
  double value = 0;
  Seen seen;
};

/// By sample.
using Suspects = std::map<size_t, std::vector<Suspect>>;

/// The groups of samples that are suspect, one after the other.
std::vector<double> groupsOf(const Subject& subject, const Suspects& suspects,
                             std::span<const double> samples) {
  const size_t size = subject.group * widthOf(subject);
  std::vector<double> groups;
  for (const auto& [sample, of] : suspects) {
    const std::span<const double> group = samples.subspan(sample / subject.group * size, size);
    groups.insert(groups.end(), group.begin(), group.end());
  }
  return groups;
}

/// Adds an evaluation of those groups to what was seen.
void add(const Subject& subject, const Values& values, Suspects& suspects) {
  size_t place = 0;
  for (auto& [sample, of] : suspects) {
    const size_t own = place++ * subject.group + sample % subject.group;
    for (Suspect& suspect : of) {
      const auto n = static_cast<size_t>(subject.roots[suspect.root].components);
      suspect.seen.add(values[suspect.root][own * n + suspect.component]);
    }
  }
}

/// Leaves what stays unexplained.
void sift(Suspects& suspects) {
  for (auto& [sample, of] : suspects)
    std::erase_if(of, [](const Suspect& suspect) { return suspect.seen.explains(suspect.value); });
  std::erase_if(suspects, [](const auto& one) { return one.second.empty(); });
}

Suspects suspectsOf(const Subject& subject, const Shown& shown, std::span<const double> samples,
                    size_t count) {
  const Values cpu = subject.evaluate(Arithmetic::Float, samples, count);
  const std::vector<bool> defined = subject.defined(samples, count);
  Suspects suspects;
  for (size_t r = 0; r < subject.roots.size(); ++r) {
    const auto n = static_cast<size_t>(subject.roots[r].components);
    for (size_t i = 0; i < shown.values[r].size(); ++i) {
      const double x = shown.values[r][i];
      if (shown.dropped[i / n] || !defined[i / n] || !std::isfinite(x)) continue;
      Suspect suspect{r, i % n, x, {}};
      suspect.seen.add(cpu[r][i]);
      if (!suspect.seen.explains(x)) suspects[i / n].push_back(suspect);
    }
  }
  return suspects;
}

void compare(const Subject& subject, const Shown& shown, std::span<const double> samples, size_t count,
             Differences& finds) {
  Suspects suspects = suspectsOf(subject, shown, samples, count);
  uint64_t seed = 1;
  for (const uint64_t tries : kTries) {
    if (suspects.empty()) return;
    const std::vector<double> groups = groupsOf(subject, suspects, samples);
    const size_t points = suspects.size() * subject.group;
    if (seed == 1) add(subject, subject.evaluate(Arithmetic::Double, groups, points), suspects);
    for (uint64_t k = 0; k < tries; ++k)
      add(subject, subject.evaluateRough(groups, points, seed++), suspects);
    sift(suspects);
  }
  const size_t size = subject.group * widthOf(subject);
  for (const auto& [sample, of] : suspects) {
    Difference& found = finds[{Fault::Device, subject.roots[of.front().root].name}];
    if (found.count++ > 0) continue;
    found.value = of.front().value;
    const std::span<const double> group = samples.subspan(sample / subject.group * size, size);
    found.input.assign(group.begin(), group.end());
  }
}

/// What is wrong with the device's numbers themselves.
void check(const Subject& subject, const Shown& shown, std::span<const double> samples, Differences& finds) {
  const size_t size = subject.group * widthOf(subject);
  for (size_t r = 0; r < subject.roots.size(); ++r) {
    const auto n = static_cast<size_t>(subject.roots[r].components);
    for (size_t i = 0; i < shown.values[r].size() / n; ++i) {
      Fault fault{};
      double value = 0;
      if (shown.dropped[i] || !faultAt(subject.roots[r], shown.values[r], i, fault, value)) continue;
      Difference& found = finds[{fault, subject.roots[r].name}];
      if (found.count++ > 0) continue;
      found.value = value;
      const std::span<const double> group = samples.subspan(i / subject.group * size, size);
      found.input.assign(group.begin(), group.end());
    }
  }
}

Result<Differences> findsOf(const Subject& subject, std::span<const double> samples, size_t count,
                            const Shower& device) {
  const Result<Shown> shown = device(samples, count);
  if (!shown) return tl::make_unexpected(shown.error());
  Differences finds;
  check(subject, *shown, samples, finds);
  compare(subject, *shown, samples, count, finds);
  return finds;
}

/// One number made plainer in every sample of a group.
struct Plainer {
  size_t component = 0;
  double value = 0;
};

std::vector<double> with(const Subject& subject, std::vector<double> input,
                         std::span<const Plainer> changes) {
  for (const Plainer& change : changes) {
    for (size_t i = change.component; i < input.size(); i += widthOf(subject)) input[i] = change.value;
  }
  return input;
}

/// Which of these inputs, groups each, still show it. One run.
Result<std::vector<bool>> showing(const Subject& subject, const Finding& finding,
                                  const std::vector<std::vector<double>>& inputs, const Shower& device) {
  std::vector<double> samples;
  for (const std::vector<double>& input : inputs) samples.insert(samples.end(), input.begin(), input.end());
  const Result<Shown> shown = device(samples, inputs.size() * subject.group);
  if (!shown) return tl::make_unexpected(shown.error());
  std::vector<bool> shows;
  for (size_t i = 0; i < inputs.size(); ++i) {
    Shown own;
    own.dropped.assign(shown->dropped.begin() + static_cast<ptrdiff_t>(i * subject.group),
                       shown->dropped.begin() + static_cast<ptrdiff_t>((i + 1) * subject.group));
    for (size_t r = 0; r < subject.roots.size(); ++r) {
      const auto n =
          static_cast<ptrdiff_t>(subject.roots[r].components) * static_cast<ptrdiff_t>(subject.group);
      const auto& from = shown->values[r];
      own.values.emplace_back(from.begin() + (from.empty() ? 0 : static_cast<ptrdiff_t>(i) * n),
                              from.begin() + (from.empty() ? 0 : static_cast<ptrdiff_t>(i + 1) * n));
    }
    Differences finds;
    check(subject, own, inputs[i], finds);
    if (finding.fault == Fault::Device) compare(subject, own, inputs[i], subject.group, finds);
    shows.push_back(finds.contains({finding.fault, finding.what}));
  }
  return shows;
}

/// Replaces numbers by plainer ones as long as the fault stays: all changes that do it no harm alone, then as
/// many of them together as halving finds.
Result<void> minimise(const Subject& subject, Finding& finding, const Shower& device) {
  std::vector<Plainer> changes;
  std::vector<std::vector<double>> inputs;
  for (const Variable& variable : subject.space.variables()) {
    for (size_t c = variable.first; c < variable.first + static_cast<size_t>(variable.components); ++c) {
      for (const double x : plainer(variable, finding.input[c])) {
        changes.push_back({c, x});
        inputs.push_back(with(subject, finding.input, {&changes.back(), 1}));
      }
    }
  }
  const auto shows = showing(subject, finding, inputs, device);
  if (!shows) return tl::make_unexpected(shows.error());
  std::vector<Plainer> good;  // of each number the plainest
  for (size_t i = 0; i < changes.size(); ++i) {
    if ((*shows)[i] && (good.empty() || good.back().component != changes[i].component))
      good.push_back(changes[i]);
  }
  for (size_t begin = 0, size = good.size(); begin < good.size() && size > 0;) {
    size = std::min(size, good.size() - begin);
    std::vector<double> candidate = with(subject, finding.input, std::span(good).subspan(begin, size));
    const auto still = showing(subject, finding, {candidate}, device);
    if (!still) return tl::make_unexpected(still.error());
    if ((*still)[0]) finding.input = std::move(candidate);
    if ((*still)[0] || size == 1)
      begin += size;
    else
      size /= 2;
  }
  return {};
}

Report reportOf(const Subject& subject, uint64_t samples, Differences finds) {
  Report report;
  report.name = subject.name;
  report.is_node = subject.is_node;
  report.samples = samples;
  for (auto& [key, found] : finds)
    report.findings.push_back({key.first, key.second, found.count, found.value, std::move(found.input), {}});
  return report;
}

}  // namespace

Result<Report> attackOnDevice(const Subject& subject, const Plan& plan, const Shower& device) {
  Differences all;
  std::vector<double> samples;
  for (uint64_t first = 0; first < plan.samples; first += kBatch) {
    const size_t count = (static_cast<size_t>(std::min<uint64_t>(kBatch, plan.samples - first)) + 3) / 4 * 4;
    drawSamples(subject, plan.seed, first, count, samples);
    Result<Differences> finds = findsOf(subject, samples, count, device);
    if (!finds) return tl::make_unexpected(std::move(finds.error()));
    for (auto& [key, found] : *finds) {
      Difference& sum = all[key];
      const uint64_t count_before = sum.count;
      if (count_before == 0) sum = std::move(found);
      if (count_before > 0) sum.count += found.count;
    }
  }
  Report report = reportOf(subject, plan.samples, std::move(all));
  for (Finding& finding : report.findings) {
    if (Result<void> done = minimise(subject, finding, device); !done)
      return tl::make_unexpected(std::move(done.error()));
    const Result<Differences> finds = findsOf(subject, finding.input, subject.group, device);
    if (!finds) return tl::make_unexpected(finds.error());
    const auto own = finds->find({finding.fault, finding.what});
    if (own != finds->end()) finding.value = own->second.value;
  }
  return report;
}

Result<Report> replayOnDevice(const Subject& subject, std::span<const double> input, const Shower& device) {
  const size_t count = input.size() / widthOf(subject);
  Result<Differences> finds = findsOf(subject, input, count, device);
  if (!finds) return tl::make_unexpected(std::move(finds.error()));
  return reportOf(subject, count, std::move(*finds));
}

}  // namespace lacquer::stress
