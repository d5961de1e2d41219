// Tint, Dawn's compiler of WGSL, where it is installed: a program (checks/wgsl/lacquer-wgsl-check says how it
// is spoken with) that is started for the first text and answers for all.
#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <mutex>
#include <optional>
#include <sstream>

#include "check/check.h"
#include "check/program.h"

#if defined(__unix__) || defined(__APPLE__)
#define LACQUER_POSIX 1
#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

extern char** environ;
#endif

namespace lacquer::check {
namespace {

constexpr const char* kProgram = "lacquer-wgsl-check";

Diagnostic tintError(const char* code, const std::string& name, std::string message, std::string help = {}) {
  return {code, Severity::Error, {name, 0, 0, {}}, std::move(message), std::move(help), {}};
}

#ifdef LACQUER_POSIX

namespace fs = std::filesystem;

#ifndef MSG_NOSIGNAL
#define MSG_NOSIGNAL 0
#endif

/// The folder's package: its version, which the files' sizes and dates need not show.
std::string packageOf(const fs::path& program) {
  std::error_code ignored;
  const fs::path folder = fs::canonical(program, ignored).parent_path();
  std::ostringstream text;
  text << std::ifstream(folder / "node_modules/webgpu/package.json", std::ios::binary).rdbuf();
  return text.str();
}

/// A running program and the socket to it. Nothing that it does can hang or end the caller.
class Process {
public:
  Process() = default;
  ~Process() { stop(); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  bool running() const { return process_ > 0; }

  bool start(const fs::path& program) {
    stop();
    int ends[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return false;
    channel_ = ends[0];
    // Above the number that it gets, so that it is not closed with the others.
    const int theirs = fcntl(ends[1], F_DUPFD_CLOEXEC, kChannel + 1);
    close(ends[1]);
    fcntl(channel_, F_SETFD, FD_CLOEXEC);
    patience();
    const bool spawned = theirs >= 0 && spawn(program.string(), theirs);
    if (theirs >= 0) close(theirs);
    if (!spawned) stop();
    return spawned;
  }

  void stop() {
    if (channel_ >= 0) close(channel_);
    channel_ = -1;
    left_.clear();
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
  }

  bool write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = send(channel_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      bytes.remove_prefix(static_cast<size_t>(n));
    }
    return true;
  }

  /// The next line without its end; nothing where the program is gone or takes too long.
  std::optional<std::string> line() {
    for (;;) {
      if (const size_t end = left_.find('\n'); end != std::string::npos) {
        std::string line = left_.substr(0, end);
        left_.erase(0, end + 1);
        return line;
      }
      char bytes[4096];
      const ssize_t n = recv(channel_, bytes, sizeof bytes, 0);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return std::nullopt;
      left_.append(bytes, static_cast<size_t>(n));
    }
  }

private:
  static constexpr int kChannel = 3;

  void patience() const {
    constexpr timeval kLongest = {60, 0};
    setsockopt(channel_, SOL_SOCKET, SO_SNDTIMEO, &kLongest, sizeof kLongest);
    setsockopt(channel_, SOL_SOCKET, SO_RCVTIMEO, &kLongest, sizeof kLongest);
#ifdef SO_NOSIGPIPE
    constexpr int kOn = 1;
    setsockopt(channel_, SOL_SOCKET, SO_NOSIGPIPE, &kOn, sizeof kOn);
#endif
  }

  bool spawn(std::string program, int theirs) {
    std::string serve = "--serve";
    char* argv[] = {program.data(), serve.data(), nullptr};
    posix_spawn_file_actions_t actions;
    if (posix_spawn_file_actions_init(&actions) != 0) return false;
    const auto nowhere = [&](int number, int mode) {
      return posix_spawn_file_actions_addopen(&actions, number, "/dev/null", mode, 0) == 0;
    };
    const bool started = nowhere(STDIN_FILENO, O_RDONLY) && nowhere(STDOUT_FILENO, O_WRONLY) &&
                         nowhere(STDERR_FILENO, O_WRONLY) &&
                         posix_spawn_file_actions_adddup2(&actions, theirs, kChannel) == 0 &&
                         posix_spawn(&process_, argv[0], &actions, nullptr, argv, environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    if (!started) process_ = 0;
    return started;
  }

  pid_t process_ = 0;
  int channel_ = -1;
  std::string left_;  ///< read and not yet asked for
};

std::string unescaped(std::string_view text) {
  std::string plain;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '\\' && i + 1 < text.size();
    plain += !escape ? text[i] : text[++i] == 'n' ? '\n' : text[i];
  }
  return plain;
}

/// `error 12 5 TEXT`, as a diagnostic.
std::optional<Diagnostic> diagnosticOf(std::string_view line, const std::string& text,
                                       const std::string& name) {
  Diagnostic diagnostic;
  diagnostic.code = "tint";
  const auto take = [&line](std::string_view prefix) {
    const bool found = line.starts_with(prefix);
    if (found) line.remove_prefix(prefix.size());
    return found;
  };
  if (take("warning ")) {
    diagnostic.severity = Severity::Warning;
  } else if (take("info ")) {
    diagnostic.severity = Severity::Note;
  } else if (!take("error ")) {
    return std::nullopt;
  }
  uint32_t numbers[2] = {};
  for (uint32_t& number : numbers) {
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
    if (error != std::errc() || end == line.data() + line.size() || *end != ' ') return std::nullopt;
    line.remove_prefix(static_cast<size_t>(end + 1 - line.data()));
  }
  diagnostic.message = unescaped(line);
  diagnostic.place = {name, numbers[0], numbers[1], {}};
  locateInText(diagnostic, text);
  return diagnostic;
}

/// The one program that all threads ask, one after the other.
class Tint {
public:
  Diagnostics compile(const fs::path& program, const std::string& text, const std::string& name) {
    const std::lock_guard lock(mutex_);
    const std::string identity = identityOf(program);
    if (!process_.running() || identity != identity_) {
      identity_ = identity;
      if (Diagnostics wrong = start(program, name); !wrong.empty()) return wrong;
    }
    std::optional<Diagnostics> answer = ask(text, name);
    if (answer) return std::move(*answer);
    process_.stop();
    return {tintError("tint", name, fmt::format("{} gave no answer", program.string()))};
  }

private:
  Diagnostics start(const fs::path& program, const std::string& name) {
    const bool started = process_.start(program);
    const std::string hello = started ? process_.line().value_or("") : "";
    if (hello == "lacquer-wgsl-check 1") return {};
    process_.stop();
    if (hello.starts_with("missing ")) {
      return {tintError("tint-missing", name,
                        fmt::format("{} has no compiler: {}", program.string(), unescaped(hello.substr(8))),
                        "`npm ci` in its folder installs it")};
    }
    return {tintError("tint", name, fmt::format("{} could not be run", program.string()))};
  }

  std::optional<Diagnostics> ask(const std::string& text, const std::string& name) {
    if (!process_.write(fmt::format("{}\n", text.size())) || !process_.write(text)) return std::nullopt;
    Diagnostics list;
    for (;;) {
      const std::optional<std::string> line = process_.line();
      if (!line) return std::nullopt;
      if (*line == "end") return list;
      std::optional<Diagnostic> diagnostic = diagnosticOf(*line, text, name);
      if (!diagnostic) return std::nullopt;
      list.push_back(std::move(*diagnostic));
    }
  }

  std::mutex mutex_;
  Process process_;
  std::string identity_;  ///< of the program that runs
};

#endif

}  // namespace

#ifdef LACQUER_POSIX

bool haveTint() { return findProgram(kProgram).has_value(); }

std::string tintIdentity() {
  const auto program = findProgram(kProgram);
  return program ? identityOf(*program) + '\n' + packageOf(*program) : std::string();
}

Diagnostics compileWithTint(const std::string& text, const std::string& name) {
  static Tint tint;
  const auto program = findProgram(kProgram);
  if (program) return tint.compile(*program, text, name);
  return {tintError("tint-missing", name, fmt::format("there is no `{}` on the PATH", kProgram))};
}

#else

bool haveTint() { return false; }

std::string tintIdentity() { return {}; }

Diagnostics compileWithTint(const std::string&, const std::string& name) {
  return {tintError("tint-missing", name, fmt::format("{} is run on POSIX systems only", kProgram))};
}

#endif

}  // namespace lacquer::check
