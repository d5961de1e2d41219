#include "sandbox.h"

#ifdef __linux__
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/syscall.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "processes.h"

namespace lacquer::test {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

namespace {

/// A filter in the kernel's form: calls that tell the time do not exist.
std::string filterWithoutClock() {
  const std::vector<long> clocks = {
#ifdef SYS_time
      SYS_time,
#endif
      SYS_clock_gettime, SYS_clock_getres, SYS_gettimeofday, SYS_times, SYS_sysinfo};
  std::vector<sock_filter> code;
  code.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)));
  for (const long call : clocks) {
    code.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<uint32_t>(call), 0, 1));
    code.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSYS));
  }
  code.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  std::string bytes(code.size() * sizeof(sock_filter), '\0');
  std::memcpy(bytes.data(), code.data(), bytes.size());
  return bytes;
}

}  // namespace

long Sandbox::clockCall() { return SYS_clock_gettime; }

Sandbox::Sandbox(const fs::path& folder, Clock clock) : folder_(folder) {
  fs::create_directories(folder / "etc");
  writeText(folder / "filter", filterWithoutClock());
  fs::copy_file(clock == Clock::Still ? LACQUER_STILL_CLOCK : LACQUER_WILD_CLOCK,
                folder / "etc" / "clock.so");
  writeText(folder / "etc" / "ld.so.preload", "/etc/clock.so\n");
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  why_ = "a sanitizer must be the first library";
#else
  Words probe = around(folder, {});
  probe.emplace_back("/bin/true");
  std::string output;
  if (runProgram(probe, folder, &output) != 0) why_ = "it says: " + output;
#endif
}

Words Sandbox::around(const fs::path& place, const Words& inputs) const {
  // bubblewrap is given the filter as an open file.
  Words words{"/bin/sh", "-c", "exec 9<\"$0\"; exec \"$@\"", (folder_ / "filter").string(), "bwrap"};
  words.insert(words.end(), {"--unshare-all",
                             "--unshare-user",
                             "--uid",
                             "4321",
                             "--gid",
                             "1234",
                             "--hostname",
                             "elsewhere",
                             "--seccomp",
                             "9",
                             "--clearenv",
                             "--die-with-parent",
                             "--dev",
                             "/dev",
                             "--tmpfs",
                             "/tmp",
                             "--ro-bind",
                             "/usr",
                             "/usr",
                             "--ro-bind",
                             (folder_ / "etc").string(),
                             "/etc"});
  for (const char* link : {"/lib", "/lib64", "/bin"}) {
    if (fs::is_symlink(link)) words.insert(words.end(), {"--symlink", fs::read_symlink(link).string(), link});
  }
  words.insert(words.end(), {"--bind", place.string(), "/place"});
  for (const std::string& input : inputs) {
    const bool absolute = fs::path(input).is_absolute();
    words.insert(words.end(), {"--ro-bind", absolute ? input : (place / input).string(),
                               absolute ? input : "/place/" + input});
  }
  words.insert(words.end(), {"--chdir", "/place", "--"});
  return words;
}

}  // namespace lacquer::test

#else

namespace lacquer::test {

Sandbox::Sandbox(const std::filesystem::path&, Clock) : why_("it is for Linux") {}

std::vector<std::string> Sandbox::around(const std::filesystem::path&,
                                         const std::vector<std::string>&) const {
  return {};
}

long Sandbox::clockCall() { return 0; }

}  // namespace lacquer::test

#endif
