#include "cost/cost.h"

#include <algorithm>
#include <deque>
#include <future>
#include <map>
#include <utility>

#include "check/check.h"
#include "check/program.h"
#include "check/reflect.h"
#include "support/file.h"
#include "vulkan/passthrough.h"
#ifdef LACQUER_VULKAN
#include "cost/loader.h"
#include "cost/worker.h"
#endif

namespace lacquer::cost {

const std::vector<std::string> kFamilies = {"navi21", "gfx1100"};

size_t spirvInstructions(const Spirv& words) { return check::instructionCount(words); }

#ifdef LACQUER_VULKAN

std::string unavailable() {
  if (!vulkan::haveLoader()) return "there is no Vulkan loader (libvulkan.so.1) on this machine";
  if (radvManifest().empty()) return "Mesa's RADV (radeon_icd.*.json) is not installed on this machine";
  return {};
}

std::string driverIdentity() {
  std::string identity;
  const std::string manifests = radvManifest();
  for (size_t at = 0; at < manifests.size();) {
    const size_t end = std::min(manifests.find(':', at), manifests.size());
    const Result<std::string> text = readFile(manifests.substr(at, end - at));
    at = end + 1;
    constexpr std::string_view kMember = "\"library_path\"";
    const size_t member = text ? text->find(kMember) : std::string::npos;
    if (member == std::string::npos) return {};
    const size_t first = text->find('"', member + kMember.size());
    const size_t last = text->find('"', first == std::string::npos ? first : first + 1);
    if (last == std::string::npos || (*text)[first + 1] != '/') return {};  // wherever the linker finds it
    identity += *text + check::identityOf(text->substr(first + 1, last - first - 1));
  }
  return identity;
}

namespace {

// GCC's address sanitizer does not take its allocator's locks around fork(): a child that is born while
// another thread has one waits for ever.
#ifdef __SANITIZE_ADDRESS__
constexpr auto kBeside = std::launch::deferred;
#else
constexpr auto kBeside = std::launch::async;
#endif
constexpr std::chrono::minutes kTime{10};          // of all files, and for each pair of them:
constexpr std::chrono::seconds kTimeOfEach{1};     // ten times what a large shader takes
constexpr size_t kDisassembly = size_t{1} << 28U;  // bytes, of all files on one GPU
constexpr const char* kTooLong = "the disassembly of all shaders takes more than 256 MiB";

/// What a validator says of a module of ours that the driver did not take; empty when it is valid. Foreign
/// ones were valid.
std::string complaint(const Stages& subject) {
  for (const auto& [words, foreign] : {std::pair(subject.vertex, subject.foreign_vertex),
                                       std::pair(subject.fragment, subject.foreign_fragment)}) {
    if (words == nullptr || foreign) continue;
    const Diagnostics wrong = check::validate(*words, false, {});
    if (!wrong.empty()) return ": " + wrong[0].message;
  }
  return {};
}

/// Vertex stages for subjects that have none, beside them: a subject's own words are not copied.
class Whole {
public:
  explicit Whole(std::vector<Stages> subjects) : stages(std::move(subjects)), problems(stages.size()) {
    for (size_t i = 0; i < stages.size(); ++i) {
      if (stages[i].vertex == nullptr) complete(stages[i], problems[i]);
    }
  }
  Whole(const Whole&) = delete;
  Whole& operator=(const Whole&) = delete;

  std::vector<Stages> stages;
  std::vector<std::string> problems;  ///< why a subject still has no vertex stage

private:
  void complete(Stages& subject, std::string& problem) {
    const Result<check::Interface> fragment = check::reflect(*subject.fragment, check::Stage::Fragment);
    Result<Spirv> vertex = fragment ? vulkan::passthroughVertex(*fragment) : tl::unexpected(fragment.error());
    if (!vertex) {
      problem = vertex.error()[0].message;
      return;
    }
    made_.push_back(std::move(*vertex));
    subject.vertex = &made_.back();
    subject.foreign_vertex = false;
  }

  std::deque<Spirv> made_;  // what the subjects point to stays where it is
};

/// Until `end`. Where the driver dies it goes on behind the subject that it died of.
Measurement compileAll(const Whole& whole, Worker& worker, bool disassembly, Clock::time_point end) {
  Measurement result;
  const std::vector<Stages>& stages = whole.stages;
  const auto miss = [&](size_t i, const std::string& problem) {
    result.outcomes[i].problem = whole.problems[i].empty() ? problem : whole.problems[i];
  };
  result.outcomes.resize(stages.size());
  size_t text = 0;
  for (size_t next = 0; next < stages.size();) {
    if (Clock::now() >= end) {
      for (; next < stages.size(); ++next) miss(next, "the shaders before it took all of the time");
      break;
    }
    Work work = worker.compile(stages, next, disassembly, end);
    if (!work.driver.empty()) result.driver = work.driver;
    for (Outcome& outcome : work.outcomes) {
      Outcome& mine = result.outcomes[next];
      mine = std::move(outcome);
      text += mine.disassembly.size();
      if (text > kDisassembly && !mine.disassembly.empty()) mine = {{}, {}, kTooLong};
      if (!mine.statistics) miss(next, mine.problem + complaint(stages[next]));
      ++next;
    }
    if (!work.problem.empty()) {
      for (; next < stages.size(); ++next) miss(next, work.problem);
    } else if (next < stages.size()) {
      miss(next, work.fatal + complaint(stages[next]));
      ++next;
    }
  }
  return result;
}

/// Which of the distinct pairs each subject is.
std::vector<size_t> distinct(const std::vector<FileSubject>& subjects, std::vector<Stages>& pairs) {
  std::map<std::pair<const Spirv*, const Spirv*>, size_t> known;
  std::vector<size_t> of;
  of.reserve(subjects.size());
  for (const FileSubject& subject : subjects) {
    const std::pair key(subject.vertex.get(), subject.fragment.get());
    const auto [place, fresh] = known.try_emplace(key, pairs.size());
    if (fresh) pairs.push_back({key.first, key.second, true, true});
    of.push_back(place->second);
  }
  return of;
}

/// The outcomes of pairs as those of subjects. Texts are copied as long as there is room for them.
Measurement spread(const Measurement& pairs, const std::vector<size_t>& of) {
  Measurement result{pairs.driver, {}};
  result.outcomes.reserve(of.size());
  size_t text = 0;
  for (const size_t pair : of) {
    const Outcome& outcome = pairs.outcomes[pair];
    text += outcome.disassembly.size();
    const bool fits = text <= kDisassembly || outcome.disassembly.empty();
    result.outcomes.push_back(fits ? outcome : Outcome{{}, {}, kTooLong});
  }
  return result;
}

}  // namespace

struct Driver::State {
  Worker worker;
};

Driver::Driver(const std::string& family) : state_(new State{Worker(family)}) {}
Driver::~Driver() = default;

Measurement Driver::measure(const std::vector<Subject>& subjects, bool disassembly) {
  std::vector<Stages> stages;
  for (const Subject& subject : subjects)
    stages.push_back({subject.vertex.empty() ? nullptr : &subject.vertex, &subject.fragment});
  return compileAll(Whole(std::move(stages)), state_->worker, disassembly, Clock::time_point::max());
}

std::vector<Measurement> measureFiles(const std::vector<FileSubject>& subjects, bool disassembly) {
  std::vector<Stages> pairs;
  const std::vector<size_t> of = distinct(subjects, pairs);
  // The compiler of the vertex stages has locks, which no process may inherit: it is done before the first
  // one starts.
  const Whole whole(std::move(pairs));
  const Clock::time_point end = Clock::now() + kTime + whole.stages.size() * kTimeOfEach;
  std::vector<std::future<Measurement>> running;
  for (const std::string& family : kFamilies) {
    running.push_back(std::async(kBeside, [&, disassembly] {
      Worker worker(family);
      return compileAll(whole, worker, disassembly, end);
    }));
  }
  std::vector<Measurement> all;
  for (std::future<Measurement>& one : running) all.push_back(spread(one.get(), of));
  return all;
}

#else

std::string unavailable() { return "this Lacquer was built without Vulkan (or not on Linux)"; }

std::string driverIdentity() { return {}; }

struct Driver::State {};
Driver::Driver(const std::string&) {}
Driver::~Driver() = default;

Measurement Driver::measure(const std::vector<Subject>& subjects, bool) {
  Outcome outcome;
  outcome.problem = unavailable();
  return {{}, std::vector<Outcome>(subjects.size(), outcome)};
}

std::vector<Measurement> measureFiles(const std::vector<FileSubject>& subjects, bool) {
  return std::vector<Measurement>(kFamilies.size(),
                                  measure(std::vector<Subject>(subjects.size()), {}, false));
}

#endif

Measurement measure(const std::vector<Subject>& subjects, const std::string& family, bool disassembly) {
  return Driver(family).measure(subjects, disassembly);
}

}  // namespace lacquer::cost
