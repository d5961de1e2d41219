#include "bench/error_times.h"

#include <algorithm>
#include <cmath>

#include "vulkan/run.h"

namespace lacquer::bench {

namespace {

/// So many that at least one of them is not disturbed.
constexpr int kRounds = 150;

/// An input across the square, each component through its range, no two along the same line.
vulkan::Varying varyingOf(const SubjectInput& input, double turn) {
  const auto components = static_cast<size_t>(input.components);
  vulkan::Varying varying{static_cast<uint32_t>(components), std::vector<float>(3 * components)};
  for (size_t c = 0; c < components; ++c) {
    // Of a unit vector about the pole: its length is not quite 1, which costs the same.
    const bool pole = input.unit && c == 2;
    const double lo = pole ? 0.7 : input.unit ? -0.7 : input.lo;
    const double hi = pole ? 1 : input.unit ? 0.7 : input.hi;
    const double across = std::fmod(turn + 0.618 * static_cast<double>(c), 1);
    varying.values[c] = static_cast<float>(lo);
    varying.values[components + c] = static_cast<float>(lo + (hi - lo) * across);
    varying.values[2 * components + c] = static_cast<float>(lo + (hi - lo) * (1 - across));
  }
  return varying;
}

vulkan::Sweep sweepOf(const Subject& subject, Body body) {
  vulkan::Sweep sweep{std::move(body.spirv), {}};
  for (const std::string& name : body.inputs) {
    const auto input = std::find_if(subject.inputs.begin(), subject.inputs.end(), [&](const SubjectInput& i) {
      return (i.unit ? i.name : "AT_" + i.name) == name;
    });
    sweep.inputs.push_back(varyingOf(*input, 0.37 * static_cast<double>(sweep.inputs.size() + 1)));
  }
  return sweep;
}

}  // namespace

Times lavapipeTimes(const lang::Library& library, const std::vector<Subject>& subjects) {
  Times times;
  const Result<vulkan::Device> device = vulkan::Device::open();
  if (!device) {
    times.problem = device.error()[0].message;
    return times;
  }
  std::vector<vulkan::Sweep> sweeps;
  for (const Subject& subject : subjects) {
    for (const std::string& body : subject.bodies) {
      const ir::Module module = moduleOf(library, subject, body);
      sweeps.push_back(sweepOf(subject, overheadOf(module)));
      sweeps.push_back(sweepOf(subject, bodyOf(module)));
    }
  }
  const Result<std::vector<double>> least = device->time(sweeps, kRounds);
  if (!least) {
    times.problem = least.error()[0].message;
    return times;
  }
  times.device = device->name();
  for (size_t i = 0; i < least->size(); i += 2)
    times.nanoseconds.emplace_back(std::max((*least)[i + 1] - (*least)[i], 0.0));
  return times;
}

}  // namespace lacquer::bench
