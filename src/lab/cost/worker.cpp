// The driver reads its settings from the environment when it is opened, serves one family for the life of a
// process, and may crash on a module that no validator has seen. So it lives in a fork: the child alone
// changes its environment, and sends what it found through a pipe. The validator works there, too: an
// untrusted module may break it as well.
#ifdef LACQUER_VULKAN
#include "cost/worker.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <new>
#include <utility>

#include "check/check.h"
#include "cost/loader.h"
#include "cost/pipeline.h"
#include "support/text.h"

namespace lacquer::cost {
namespace {

constexpr std::chrono::milliseconds kPatience{60'000};  // for one shader
constexpr rlim_t kMemory = rlim_t{2} << 30U;  // bytes; a large shader takes a tenth, with Mesa's libraries
constexpr size_t kMaxProblem = 300;           // characters
constexpr uint32_t kMaxText = 64U << 20U;     // bytes; more is no disassembly

// A message of the child: `Head`, then the two texts.
enum class Kind : uint32_t {
  Driver,
  Valid,  // the next subject goes to the driver
  Outcome,
  Stop
};  // the driver's name or the reason to stop is the problem's text
struct Head {
  Kind kind = Kind::Outcome;
  uint32_t has_statistics = 0;
  uint32_t problem_size = 0, disassembly_size = 0;
  double driver_ms = 0;
  Statistics statistics;
};

bool writeAll(int pipe, const void* data, size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(pipe, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written;
    size -= static_cast<size_t>(written);
  }
  return true;
}

bool send(int pipe, Kind kind, const Outcome& outcome) {
  Head head;
  head.kind = kind;
  head.has_statistics = outcome.statistics ? 1 : 0;
  head.problem_size = static_cast<uint32_t>(outcome.problem.size());
  head.disassembly_size = static_cast<uint32_t>(outcome.disassembly.size());
  head.driver_ms = outcome.driver_ms;
  if (outcome.statistics) head.statistics = *outcome.statistics;
  return writeAll(pipe, &head, sizeof head) &&
         writeAll(pipe, outcome.problem.data(), outcome.problem.size()) &&
         writeAll(pipe, outcome.disassembly.data(), outcome.disassembly.size());
}

/// An environment of nothing but what the numbers need: no debugging switches, layers or caches of the
/// user's.
void prepareEnvironment(const std::string& family, const std::string& manifest) {
  clearenv();
  setenv("VK_ICD_FILENAMES", manifest.c_str(), 1);
  setenv("VK_DRIVER_FILES", manifest.c_str(), 1);
  setenv("RADV_FORCE_FAMILY", family.c_str(), 1);
  setenv("RADV_DEBUG", "nocache", 1);
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
  setenv("NODEVICE_SELECT", "1", 1);  // Mesa's layer that sorts devices
  setenv("XDG_RUNTIME_DIR", "/tmp", 1);
}

/// Bytes of the address space that this process has taken; 0 where nobody tells.
rlim_t addressSpace() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

template <class Resource>  // an enumeration in one C library, a number in another
void atMost(Resource resource, rlim_t value) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return;
  limit = {std::min(limit.rlim_cur, value), std::min(limit.rlim_max, value)};
  setrlimit(resource, &limit);
}

/// A driver that asks for more finds none and dies, alone. It comes on top of what the parent holds, which
/// the child is born with.
void limitMemory() {
  atMost(RLIMIT_AS, addressSpace() + kMemory);
  atMost(RLIMIT_CORE, 0);  // a crash leaves no file of that size
}

/// Why an untrusted module does not go to the driver; empty when it may.
std::string objection(const Stages& subject) {
  for (const auto& [words, foreign] : {std::pair(subject.vertex, subject.foreign_vertex),
                                       std::pair(subject.fragment, subject.foreign_fragment)}) {
    if (!foreign) continue;
    const Diagnostics wrong = check::validateForeign(*words, {});
    if (!wrong.empty()) return "the module is not valid: " + wrong[0].message;
  }
  return {};
}

/// False when nobody listens.
bool handle(int pipe, const Device& device, const Stages& subject, bool disassembly) {
  Outcome outcome;
  try {
    if (subject.vertex == nullptr) return send(pipe, Kind::Outcome, outcome);
    outcome.problem = objection(subject);
    if (outcome.problem.empty()) {
      if (!send(pipe, Kind::Valid, {})) return false;
      outcome = compilePipeline(device, subject, disassembly);
    }
  } catch (const std::bad_alloc&) {
    outcome = {};
    outcome.problem = fmt::format("it takes more than {} GiB of memory", kMemory >> 30U);
  }
  return send(pipe, Kind::Outcome, outcome);
}

[[noreturn]] void work(int pipe, const std::vector<Stages>& subjects, size_t first, const std::string& family,
                       bool disassembly) {
  signal(SIGPIPE, SIG_IGN);
  const std::string manifest = radvManifest();
  prepareEnvironment(family, manifest);
  // The driver talks: "not a conformant implementation".
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, stream);
  limitMemory();
  Device device;
  const std::string problem = openDevice(device);
  const bool begun = problem.empty();
  if (!send(pipe, begun ? Kind::Driver : Kind::Stop, {{}, {}, begun ? device.driver : problem}) || !begun)
    _exit(0);
  for (size_t i = first; i < subjects.size(); ++i) {
    if (!handle(pipe, device, subjects[i], disassembly)) break;
  }
  // No destructors: the driver's threads and the parent's objects are not this process' to end.
  _exit(0);
}

enum class Read : uint8_t { Good, End, Hung };

Read readAll(int pipe, void* data, size_t size, Clock::time_point end) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    pollfd waiting{pipe, POLLIN, 0};
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0) return Read::Hung;
    const int ready = poll(&waiting, 1, static_cast<int>(std::min(left, kPatience).count()));
    if (ready == 0) return Read::Hung;
    if (ready < 0 && errno != EINTR) return Read::End;
    if (ready < 0) continue;
    const ssize_t got = read(pipe, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return Read::End;
    at += got;
    size -= static_cast<size_t>(got);
  }
  return Read::Good;
}

Read receive(int pipe, Kind& kind, Outcome& outcome, Clock::time_point end) {
  Head head;
  Read state = readAll(pipe, &head, sizeof head, end);
  if (state != Read::Good) return state;
  if (head.problem_size > kMaxText || head.disassembly_size > kMaxText) return Read::End;
  kind = head.kind;
  outcome.problem.resize(head.problem_size);
  outcome.disassembly.resize(head.disassembly_size);
  outcome.driver_ms = head.driver_ms;
  if (head.has_statistics != 0) outcome.statistics = head.statistics;
  state = readAll(pipe, outcome.problem.data(), outcome.problem.size(), end);
  if (state == Read::Good) state = readAll(pipe, outcome.disassembly.data(), outcome.disassembly.size(), end);
  // A validator's message holds names of the module.
  outcome.problem = printable(outcome.problem, kMaxProblem);
  return state;
}

/// Forks; the child runs `body` with the pipe's writing end. -1 with a problem's text when that fails.
template <class Body>
pid_t startChild(int& reading, std::string& problem, const Body& body) {
  // One at a time: a child that inherits another's writing end would hide that one's death.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    problem = fmt::format("no pipe: {}", std::strerror(errno));
    return -1;
  }
  const pid_t child = fork();
  if (child == 0) {
    // What is thrown must not lead back into the parent's code.
    try {
      body(ends[1]);
    } catch (...) {
    }
    _exit(1);
  }
  close(ends[1]);
  reading = ends[0];
  if (child < 0) {
    problem = fmt::format("no child process: {}", std::strerror(errno));
    close(ends[0]);
  }
  return child;
}

/// What a child died of, for a message.
std::string causeOf(Read state, bool compiling) {
  const char* const who = compiling ? "the driver" : "the validator";
  if (state == Read::Hung) return fmt::format("{} took more than a minute", who);
  return fmt::format("{} crashed, or asked for more than {} GiB of memory", who, kMemory >> 30U);
}

}  // namespace

Work compileApart(const std::vector<Stages>& subjects, size_t first, const std::string& family,
                  bool disassembly, Clock::time_point end) {
  Work result;
  int pipe = -1;
  const pid_t child = startChild(pipe, result.problem,
                                 [&](int writing) { work(writing, subjects, first, family, disassembly); });
  if (child < 0) return result;
  bool compiling = false, begun = false;
  Read state = Read::Good;
  while (result.problem.empty() && first + result.outcomes.size() < subjects.size()) {
    Kind kind = Kind::Outcome;
    Outcome outcome;
    state = receive(pipe, kind, outcome, std::min(end, Clock::now() + kPatience));
    if (state != Read::Good) break;
    compiling = kind == Kind::Valid;
    switch (kind) {
      case Kind::Driver:
        begun = true;
        result.driver = outcome.problem;
        break;
      case Kind::Valid: break;
      case Kind::Outcome: result.outcomes.push_back(std::move(outcome)); break;
      case Kind::Stop: result.problem = outcome.problem; break;
    }
  }
  if (state != Read::Good) result.fatal = causeOf(state, compiling || !begun);
  close(pipe);
  if (state == Read::Hung) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return result;
}

}  // namespace lacquer::cost
#endif
