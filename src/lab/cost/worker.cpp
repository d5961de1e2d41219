// The driver reads its settings from the environment when it is opened, serves one family for the life of a
// process, and may crash on a module that no validator has seen. So it lives in a fork: the child alone
// changes its environment, takes one subject after the other from a socket, and sends back what it found. The
// validator works there, too: an untrusted module may break it as well.
#ifdef LACQUER_VULKAN
#include "cost/worker.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
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
#include <set>
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

/// What the parent sends before a subject's words.
struct Order {
  uint32_t vertex_size = 0, fragment_size = 0;  // words
  uint32_t foreign_vertex = 0, foreign_fragment = 0, disassembly = 0;
};

bool writeAll(int pipe, const void* data, size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::send(pipe, at, size, MSG_NOSIGNAL);
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

/// Waits for them. False at the end.
bool take(int pipe, void* data, size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = read(pipe, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<size_t>(got);
  }
  return true;
}

bool takeWords(int pipe, Spirv& words, size_t size) {
  words.resize(size);
  return take(pipe, words.data(), size * sizeof(uint32_t));
}

[[noreturn]] void work(int pipe, const std::string& family) {
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
  Order order;
  Spirv vertex, fragment;
  while (take(pipe, &order, sizeof order) && takeWords(pipe, vertex, order.vertex_size) &&
         takeWords(pipe, fragment, order.fragment_size)) {
    const Stages subject{&vertex, &fragment, order.foreign_vertex != 0, order.foreign_fragment != 0};
    if (!handle(pipe, device, subject, order.disassembly != 0)) break;
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

/// The parent's ends of all lines. A child that kept another's would hide from that one that the parent has
/// ended.
struct Lines {
  std::mutex mutex;
  std::set<int> open;
};
Lines& lines() {
  static Lines& all = *new Lines;
  return all;
}

/// Forks; the child runs `body` with its end of a socket. -1 with a problem's text when that fails.
template <class Body>
pid_t startChild(int& line, std::string& problem, const Body& body) {
  Lines& known = lines();
  const std::lock_guard lock(known.mutex);
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    problem = fmt::format("no socket: {}", std::strerror(errno));
    return -1;
  }
  const pid_t child = fork();
  if (child == 0) {
    // What is thrown must not lead back into the parent's code.
    try {
      close(ends[0]);
      for (const int other : known.open) close(other);
      body(ends[1]);
    } catch (...) {
    }
    _exit(1);
  }
  close(ends[1]);
  line = ends[0];
  if (child < 0) {
    problem = fmt::format("no child process: {}", std::strerror(errno));
    close(ends[0]);
    return child;
  }
  known.open.insert(line);
  return child;
}

bool give(int line, const Stages& subject, bool disassembly) {
  const Order order{static_cast<uint32_t>(subject.vertex->size()),
                    static_cast<uint32_t>(subject.fragment->size()), subject.foreign_vertex ? 1U : 0U,
                    subject.foreign_fragment ? 1U : 0U, disassembly ? 1U : 0U};
  return writeAll(line, &order, sizeof order) &&
         writeAll(line, subject.vertex->data(), subject.vertex->size() * sizeof(uint32_t)) &&
         writeAll(line, subject.fragment->data(), subject.fragment->size() * sizeof(uint32_t));
}

/// Has one subject compiled. `compiling`: whether the driver had it when the child died.
Read compiled(int line, const Stages& subject, bool disassembly, Clock::time_point end, bool& compiling,
              Outcome& outcome) {
  if (!give(line, subject, disassembly)) return Read::End;
  for (Kind kind = Kind::Valid; kind != Kind::Outcome;) {
    outcome = {};
    const Read state = receive(line, kind, outcome, std::min(end, Clock::now() + kPatience));
    if (state != Read::Good) return state;
    compiling = kind == Kind::Valid;
  }
  return Read::Good;
}

/// What a child died of, for a message.
std::string causeOf(Read state, bool compiling) {
  const char* const who = compiling ? "the driver" : "the validator";
  if (state == Read::Hung) return fmt::format("{} took more than a minute", who);
  return fmt::format("{} crashed, or asked for more than {} GiB of memory", who, kMemory >> 30U);
}

}  // namespace

void Worker::end() {
  if (child_ < 0) return;
  {
    Lines& known = lines();
    const std::lock_guard lock(known.mutex);
    known.open.erase(line_);
    close(line_);
  }
  kill(child_, SIGKILL);  // it may hang; what it found has arrived
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
}

/// False with a text in the result when there is no driver.
bool Worker::begin(Work& result, Clock::time_point end) {
  if (child_ < 0) {
    child_ = startChild(line_, result.problem, [&](int line) { work(line, family_); });
    if (child_ < 0) return false;
    Kind kind = Kind::Stop;
    Outcome outcome;
    const Read state = receive(line_, kind, outcome, std::min(end, Clock::now() + kPatience));
    if (state != Read::Good) {
      result.fatal = causeOf(state, true);
    } else if (kind != Kind::Driver) {
      result.problem = outcome.problem;
    }
    if (state != Read::Good || kind != Kind::Driver) {
      this->end();
      return false;
    }
    driver_ = outcome.problem;
  }
  result.driver = driver_;
  return true;
}

Work Worker::compile(const std::vector<Stages>& subjects, size_t first, bool disassembly,
                     Clock::time_point end) {
  Work result;
  while (first + result.outcomes.size() < subjects.size()) {
    const Stages& subject = subjects[first + result.outcomes.size()];
    Outcome outcome;
    if (subject.vertex != nullptr) {
      if (!begin(result, end)) break;
      bool compiling = false;
      const Read state = compiled(line_, subject, disassembly, end, compiling, outcome);
      if (state != Read::Good) {
        result.fatal = causeOf(state, compiling);
        this->end();
        break;
      }
    }
    result.outcomes.push_back(std::move(outcome));
  }
  return result;
}

}  // namespace lacquer::cost
#endif
