// DXC, where it is installed: run as a program, because it is a second opinion and not a dependency.
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "check/check.h"
#include "check/program.h"

#if defined(__unix__) || defined(__APPLE__)
#define LACQUER_POSIX 1
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

extern char** environ;
#endif

namespace lacquer::check {
namespace {

namespace fs = std::filesystem;

Diagnostic dxcError(const char* code, const std::string& name, std::string message) {
  return {code, Severity::Error, {name, 0, 0, {}}, std::move(message), {}, {}};
}

#ifdef LACQUER_POSIX

/// A folder of our own that is gone with everything in it at the end.
class TemporaryFolder {
public:
  TemporaryFolder() {
    std::error_code ignored;
    std::string pattern = (fs::temp_directory_path(ignored) / "lacquer-dxc-XXXXXX").string();
    if (mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }  ///< empty when none could be made

private:
  fs::path path_;
};

/// Runs a program without a shell, all that it says going to the file `log`. Its exit status, or nothing when
/// it could not be started or was killed.
std::optional<int> runProgram(std::vector<std::string> arguments, const fs::path& log) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  if (posix_spawn_file_actions_init(&actions) != 0) return std::nullopt;
  pid_t process = 0;
  const bool started =
      posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0) == 0 &&
      posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                       0600) == 0 &&
      posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO) == 0 &&
      posix_spawn(&process, argv[0], &actions, nullptr, argv.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  if (!started) return std::nullopt;

  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return std::nullopt;
  }
  if (!WIFEXITED(status)) return std::nullopt;
  return WEXITSTATUS(status);
}

#endif

/// `FILE:12:5: error: message`, with the file as it was given to dxc, as a diagnostic.
std::optional<Diagnostic> diagnosticOf(std::string_view line, const std::string& file,
                                       const std::string& text, const std::string& name) {
  if (!line.starts_with(file + ":")) return std::nullopt;
  line.remove_prefix(file.size() + 1);
  uint32_t numbers[2] = {};
  for (uint32_t& number : numbers) {
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
    if (error != std::errc() || end == line.data() + line.size() || *end != ':') return std::nullopt;
    line.remove_prefix(static_cast<size_t>(end + 1 - line.data()));
  }
  Diagnostic diagnostic;
  diagnostic.code = "dxc";
  diagnostic.place = {name, numbers[0], numbers[1], {}};
  const auto take = [&line](std::string_view prefix) {
    const bool found = line.starts_with(prefix);
    if (found) line.remove_prefix(prefix.size());
    return found;
  };
  if (take(" warning: ")) {
    diagnostic.severity = Severity::Warning;
  } else if (take(" note: ")) {
    diagnostic.severity = Severity::Note;
  } else if (!take(" error: ") && !take(" fatal error: ")) {
    return std::nullopt;
  }
  diagnostic.message = line;

  locateInText(diagnostic, text);
  return diagnostic;
}

/// What dxc said, after a failure: at least one error.
[[maybe_unused]] Diagnostics diagnosticsOf(const std::string& log, const std::string& file,
                                           const std::string& text, const std::string& name) {
  Diagnostics list;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    if (auto diagnostic = diagnosticOf(line, file, text, name)) list.push_back(std::move(*diagnostic));
  }
  if (!hasError(list)) list.push_back(dxcError("dxc", name, "dxc failed: " + log));
  return list;
}

}  // namespace

#ifdef LACQUER_POSIX

bool haveDxc() { return findProgram("dxc").has_value(); }

std::string dxcIdentity() {
  const auto program = findProgram("dxc");
  return program ? identityOf(*program) : std::string();
}

Diagnostics compileWithDxc(const std::string& text, Stage stage, const std::string& name) {
  const auto program = findProgram("dxc");
  if (!program) return {dxcError("dxc-missing", name, "there is no `dxc` on the PATH")};
  const TemporaryFolder folder;
  if (folder.path().empty()) return {dxcError("dxc", name, "no temporary folder could be made")};
  const std::string source = (folder.path() / "shader.hlsl").string();
  std::ofstream(source, std::ios::binary) << text;

  const fs::path log_file = folder.path() / "log.txt";
  const char* profile = stage == Stage::Vertex ? "vs_6_0" : "ps_6_0";
  std::vector<std::string> words = {program->string(),
                                    "-nologo",
                                    "-T",
                                    profile,
                                    "-E",
                                    "main",
                                    "-Fo",
                                    (folder.path() / "shader.dxil").string()};
  // It says what of the shader its root signature does not bind.
  constexpr const char* kSignature = "LACQUER_ROOT_SIGNATURE";
  if (text.find(std::string("#define ") + kSignature + ' ') != std::string::npos)
    words.insert(words.end(), {"-rootsig-define", kSignature});
  words.push_back(source);
  const auto status = runProgram(std::move(words), log_file);
  if (!status) return {dxcError("dxc", name, fmt::format("{} could not be run", program->string()))};
  if (*status == 0) return {};
  std::ostringstream log;
  log << std::ifstream(log_file, std::ios::binary).rdbuf();
  return diagnosticsOf(log.str(), source, text, name);
}

#else

bool haveDxc() { return false; }

std::string dxcIdentity() { return {}; }

Diagnostics compileWithDxc(const std::string&, Stage, const std::string& name) {
  return {dxcError("dxc-missing", name, "dxc is run on POSIX systems only")};
}

#endif

}  // namespace lacquer::check
