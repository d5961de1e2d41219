#include "cost/cost.h"

#include <algorithm>

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

/// What a validator says of a module that the driver did not take; empty when it is valid.
std::string complaint(const Subject& subject) {
  for (const Spirv* words : {&subject.vertex, &subject.fragment}) {
    if (words->empty()) continue;
    const Diagnostics wrong = check::validate(*words, false, subject.name);
    if (!wrong.empty()) return ": " + wrong[0].message;
  }
  return {};
}

/// Gives every subject a vertex stage. The reasons why one has none stand in `outcomes`.
std::vector<Subject> complete(const std::vector<Subject>& subjects, std::vector<Outcome>& outcomes) {
  std::vector<Subject> whole = subjects;
  for (size_t i = 0; i < whole.size(); ++i) {
    if (!whole[i].vertex.empty()) continue;
    const Result<check::Interface> fragment = check::reflect(whole[i].fragment, check::Stage::Fragment);
    Result<Spirv> vertex = fragment ? vulkan::passthroughVertex(*fragment) : tl::unexpected(fragment.error());
    if (vertex) {
      whole[i].vertex = std::move(*vertex);
    } else {
      outcomes[i].problem = vertex.error()[0].message;
    }
  }
  return whole;
}

}  // namespace

Measurement measure(const std::vector<Subject>& subjects, const std::string& family, bool disassembly) {
  Measurement result;
  result.outcomes.resize(subjects.size());
  const std::vector<Subject> whole = complete(subjects, result.outcomes);
  for (size_t next = 0; next < whole.size();) {
    Work work = compileApart(whole, next, family, disassembly);
    if (!work.driver.empty()) result.driver = work.driver;
    for (Outcome& outcome : work.outcomes) {
      Outcome& mine = result.outcomes[next];
      if (mine.problem.empty()) mine = std::move(outcome);
      if (!mine.statistics) mine.problem += complaint(whole[next]);
      ++next;
    }
    if (!work.problem.empty()) {
      for (; next < whole.size(); ++next) result.outcomes[next].problem = work.problem;
    } else if (next < whole.size()) {
      Outcome& fatal = result.outcomes[next];
      if (fatal.problem.empty())
        fatal.problem = work.hung ? "the driver took more than a minute" : "the driver crashed";
      fatal.problem += complaint(whole[next++]);
    }
  }
  return result;
}

#else

std::string unavailable() { return "this Lacquer was built without Vulkan (or not on Linux)"; }

std::string driverIdentity() { return {}; }

Measurement measure(const std::vector<Subject>& subjects, const std::string&, bool) {
  Outcome outcome;
  outcome.problem = unavailable();
  return {{}, std::vector<Outcome>(subjects.size(), outcome)};
}

#endif

}  // namespace lacquer::cost
