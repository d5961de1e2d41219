#include "shader/times.h"

namespace lacquer {

std::vector<std::pair<std::string, double>> StageTimes::list() const {
  static constexpr std::pair<StageOfRun, const char*> kRows[] = {
      {StageOfRun::Library, "library"}, {StageOfRun::Read, "read"},
      {StageOfRun::Graph, "graph"},     {StageOfRun::Lower, "lower"},
      {StageOfRun::Passes, "passes"},   {StageOfRun::Programs, "programs"},
      {StageOfRun::Driver, "driver"},   {StageOfRun::Manifest, "manifest"},
      {StageOfRun::Print, "print"},     {StageOfRun::Validate, "validate"},
      {StageOfRun::Cache, "cache"},     {StageOfRun::Write, "write"},
      {StageOfRun::Other, "other"},
  };
  std::vector<std::pair<std::string, double>> rows;
  for (const auto& [stage, name] : kRows) {
    const bool by_target = stage == StageOfRun::Print || stage == StageOfRun::Validate;
    for (size_t t = 0; t < kMostTargets; ++t) {
      const int64_t spent = spent_[static_cast<size_t>(stage) * kMostTargets + t].load();
      if (spent == 0) continue;
      std::string row = name;
      if (by_target) row += " " + std::string(targetName(static_cast<Target>(t)));
      rows.emplace_back(std::move(row), static_cast<double>(spent) * 1e-9);
    }
  }
  return rows;
}

}  // namespace lacquer
