// What a shader costs on a GPU that is not there: Mesa's RADV compiles it on its null device and says what it
// made (VK_KHR_pipeline_executable_properties). No GPU is needed and nothing runs; the same driver gives the
// same numbers on every machine and on every run.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacquer::cost {

using Spirv = std::vector<uint32_t>;

/// RADV's statistics of a fragment shader, under RADV's meanings.
struct Statistics {
  uint64_t instructions = 0;      ///< of the final code
  uint64_t sgprs = 0, vgprs = 0;  ///< registers allocated, per wave and per lane
  uint64_t spilled_sgprs = 0, spilled_vgprs = 0;
  uint64_t code_size = 0;           ///< bytes
  uint64_t latency = 0;             ///< cycles from the start of one wave to its end, a static estimate
  uint64_t inverse_throughput = 0;  ///< cycles a busy GPU needs for each wave, a static estimate
  uint64_t vertex_inverse_throughput = 0;  ///< the same of the vertex stage before it; 0 where nobody tells
  bool operator==(const Statistics&) const = default;
};

/// A pipeline to compile. Without a vertex stage one is made that hands each input of the fragment stage
/// through.
struct Subject {
  std::string name;  ///< for messages
  Spirv vertex;      ///< may be empty
  Spirv fragment;
};

/// The same of modules that somebody's files hold. Subjects may share them, and nobody has looked at them.
struct FileSubject {
  std::shared_ptr<const Spirv> vertex;  ///< may be null
  std::shared_ptr<const Spirv> fragment;
};

struct Outcome {
  std::optional<Statistics> statistics;
  std::string disassembly;  ///< the GPU's instructions as text; empty when they were not asked for
  std::string problem;      ///< why there are no statistics; empty when there are some
  double driver_ms = 0;     ///< processor time of making the pipeline: another number on every run
};

/// The GPUs that the table shows: "navi21" (RDNA 2) and "gfx1100" (RDNA 3).
extern const std::vector<std::string> kFamilies;

struct Measurement {
  std::string driver;             ///< "Mesa 22.3.6": numbers of different drivers are not to be compared
  std::vector<Outcome> outcomes;  ///< as many as subjects, in their order
};

/// Why nothing can be measured on this machine: built without Vulkan, no loader, no RADV. Empty when it can.
std::string unavailable();

/// What tells the driver from another one without asking it: its description and, of the library that this
/// names, size and time of modification. Empty where there is no driver or the description names no path.
std::string driverIdentity();

/// The driver of one family, as RADV_FORCE_FAMILY names it, in a child process with an environment of its
/// own: the caller's is neither changed nor passed on, and a driver that crashes or takes more than a minute
/// over one shader, or more than 2 GiB of memory, costs only that shader's numbers. It is begun with the
/// first subject, which takes twenty times as long as a shader, and ends with the object. One caller at a
/// time.
class Driver {
public:
  explicit Driver(const std::string& family);
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;
  ~Driver();

  Measurement measure(const std::vector<Subject>& subjects, bool disassembly);

private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The same with a driver for this call. Safe to call from several threads.
Measurement measure(const std::vector<Subject>& subjects, const std::string& family, bool disassembly);

/// For each of kFamilies, at the same time. Each pair of modules is compiled once, however many subjects have
/// it, and only after it passed as valid for Vulkan 1.1, which is found out in the child process, too. All of
/// them together have ten minutes and a second for each pair, and 256 MiB of disassembly for each family: the
/// rest is a problem.
std::vector<Measurement> measureFiles(const std::vector<FileSubject>& subjects, bool disassembly);

/// Instructions inside functions, labels, line marks and the declarations of local variables not counted:
/// what is left to do for a driver. 0 for words that are no module.
size_t spirvInstructions(const Spirv& words);

}  // namespace lacquer::cost
