#include "bench/drivers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "cost/cost.h"
#include "support/file.h"

namespace lacquer::bench {

namespace {

/// So many that at least one of them is not disturbed.
constexpr size_t kRepetitions = 7;

/// Once for each repetition. Empty with a message where the file cannot be read.
std::vector<cost::Subject> repeated(const std::string& file) {
  const Result<std::string> bytes = readFile(file);
  if (!bytes) {
    fmt::print(stderr, "bench: {}\n", bytes.error()[0].message);
    return {};
  }
  cost::Subject subject{file, {}, cost::Spirv(bytes->size() / sizeof(uint32_t))};
  std::memcpy(subject.fragment.data(), bytes->data(), subject.fragment.size() * sizeof(uint32_t));
  return std::vector<cost::Subject>(kRepetitions, subject);
}

}  // namespace

int printDriverTimes(const std::vector<std::string>& files) {
  nlohmann::json times = nlohmann::json::array();
  for (const std::string& file : files) {
    const std::vector<cost::Subject> subjects = repeated(file);
    if (subjects.empty()) return 1;
    double least = 0;
    for (const cost::Outcome& outcome : cost::measure(subjects, cost::kFamilies[0], false).outcomes) {
      if (!outcome.statistics) {
        fmt::print(stderr, "bench: {}: {}\n", file, outcome.problem);
        return 1;
      }
      least = least == 0 ? outcome.driver_ms : std::min(least, outcome.driver_ms);
    }
    times.push_back(least);
  }
  fmt::print("{}\n", times.dump());
  return 0;
}

}  // namespace lacquer::bench
