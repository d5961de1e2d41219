// The validator of JSON schemas, which starts once for each schema: its start takes six times as long as a
// file.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <map>
#include <string>

#include "command.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

/// A process that validates files by one schema of docs/ until the test program ends.
class Validator {
public:
  explicit Validator(const std::string& schema) {
    const std::string script = (sourceFolder() / "tests/cli/validate_manifest.py").string();
    const std::string file = (sourceFolder() / "docs" / (schema + ".schema.json")).string();
    int ends[2];
    // No program that a test starts has the socket, too: the validator would wait for it.
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return;
    child_ = fork();
    if (child_ == 0) {
      for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO}) dup2(ends[1], descriptor);
      execlp("python3", "python3", script.c_str(), "--serve", file.c_str(), nullptr);
      _exit(kNoProgram);
    }
    close(ends[1]);
    if (child_ < 0) {
      close(ends[0]);
      return;
    }
    socket_ = ends[0];
    stream_ = fdopen(socket_, "r");
    if (line() == "ready") return;
    end();
    // That there is none the caller is told; that it is broken is a failure.
    if (status_ != kNoLibrary && status_ != kNoProgram) ADD_FAILURE() << "the validator does not start";
  }
  ~Validator() { end(); }
  Validator(const Validator&) = delete;
  Validator& operator=(const Validator&) = delete;

  bool there() const { return stream_ != nullptr; }

  /// What is wrong with a file, a line each.
  std::string errorsOf(const std::filesystem::path& file) {
    const std::string asked = file.string() + '\n';
    if (send(socket_, asked.data(), asked.size(), MSG_NOSIGNAL) < 0) return "the validator failed";
    std::string said;
    for (std::string one = line(); !one.empty(); one = line()) said += one + '\n';
    return feof(stream_) != 0 ? said + "the validator failed" : said;
  }

private:
  static constexpr int kNoLibrary = 77, kNoProgram = 127;

  /// Without its end.
  std::string line() {
    std::string text;
    for (int c = fgetc(stream_); c != EOF && c != '\n'; c = fgetc(stream_)) text += static_cast<char>(c);
    return text;
  }

  void end() {
    if (stream_ == nullptr) return;
    fclose(stream_);
    stream_ = nullptr;
    int status = 0;
    waitpid(child_, &status, 0);
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  }

  pid_t child_ = -1;
  int socket_ = -1;
  FILE* stream_ = nullptr;  ///< what comes out of the socket
  int status_ = 1;
};

}  // namespace

std::optional<std::string> schemaErrors(const std::vector<std::filesystem::path>& files,
                                        const std::string& schema) {
  static std::map<std::string, Validator> validators;
  Validator& validator = validators.try_emplace(schema, schema).first->second;
  if (!validator.there()) return std::nullopt;
  std::string said;
  for (const std::filesystem::path& file : files) said += validator.errorsOf(file);
  return said;
}

}  // namespace lacquer::test
