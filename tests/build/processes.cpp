#include "processes.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

namespace lacquer::test {

namespace fs = std::filesystem;

std::string readText(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

Process::Process(std::vector<std::string> arguments, const fs::path& folder) {
  static int count = 0;
  log_ = fs::path(testing::TempDir()) /
         ("lacquer-process-" + std::to_string(getpid()) + "-" + std::to_string(count++));
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  id_ = fork();
  if (id_ != 0) return;
  const int log = open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  if (chdir(folder.c_str()) == 0) execvp(words[0], words.data());
  _exit(127);
}

Process::~Process() {
  kill();
  wait();
  std::error_code ignored;
  fs::remove(log_, ignored);
}

int Process::wait() {
  if (id_ <= 0) return -1;
  int status = 0;
  waitpid(id_, &status, 0);
  id_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void Process::kill() {
  if (id_ > 0) ::kill(id_, SIGKILL);
}

std::string Process::output() const { return readText(log_); }

int runProgram(const std::vector<std::string>& arguments, const fs::path& folder, std::string* output) {
  Process process(arguments, folder);
  const int status = process.wait();
  if (output != nullptr) *output = process.output();
  if (output == nullptr && status != 0) ADD_FAILURE() << arguments[0] << ":\n" << process.output();
  return status;
}

std::map<std::string, FileState> filesBelow(const fs::path& folder) {
  std::map<std::string, FileState> files;
  if (!fs::exists(folder)) return files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[fs::relative(entry.path(), folder).string()] = {readText(entry.path()), entry.last_write_time()};
  }
  return files;
}

std::string differences(const fs::path& a, const fs::path& b) {
  std::string text;
  const auto in_a = filesBelow(a);
  const auto in_b = filesBelow(b);
  for (const auto& [name, state] : in_a) {
    const auto it = in_b.find(name);
    if (it == in_b.end())
      text += "only in the first: " + name + "\n";
    else if (it->second.bytes != state.bytes)
      text += "other bytes: " + name + "\n";
  }
  for (const auto& [name, state] : in_b) {
    if (!in_a.contains(name)) text += "only in the second: " + name + "\n";
  }
  if (in_a.empty()) text += "the first has no files\n";
  return text;
}

fs::path freshFolder(const std::string& name) {
  const fs::path folder =
      fs::path(testing::TempDir()) / ("lacquer-build-test-" + std::to_string(getpid())) / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

void writeText(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace lacquer::test
