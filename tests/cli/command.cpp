#include "command.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "support/cases.h"

namespace lacquer::test {

namespace fs = std::filesystem;

Workplace::Workplace() {
  static std::atomic<int> count{0};
  path_ = fs::path(testing::TempDir()) /
          ("lacquer-cli-" + std::to_string(getpid()) + "-" + std::to_string(count++));
  fs::remove_all(path_);
  fs::create_directories(path_);
}

Workplace::~Workplace() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

namespace {

int statusOf(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

void redirect(const fs::path& file, int descriptor) {
  dup2(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), descriptor);
}

}  // namespace

Outcome Workplace::run(std::vector<std::string> arguments, std::chrono::seconds most,
                       const fs::path& to) const {
  arguments.insert(arguments.begin(), LACQUER_PROGRAM);
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  const fs::path out = to.empty() ? fs::path(path_.string() + ".out") : to;
  const fs::path err = path_.string() + ".err";
  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) {
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    redirect(out, STDOUT_FILENO);
    redirect(err, STDERR_FILENO);
    if (chdir(path_.c_str()) == 0) execv(words[0], words.data());
    _exit(127);
  }
  Outcome outcome;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() - begin > most) {
      ADD_FAILURE() << arguments[1] << ": not ended after " << most.count() << " s";
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  outcome.status = statusOf(status);
  if (to.empty()) outcome.out = readFile(out);
  outcome.err = readFile(err);
  if (to.empty()) fs::remove(out);
  fs::remove(err);
  return outcome;
}

Outcome Workplace::shell(const std::string& script) const {
  Outcome outcome;
  const std::string command = "cd '" + path_.string() + "' && { " + script + "; } >sh.out 2>sh.err";
  outcome.status = statusOf(std::system(command.c_str()));
  outcome.out = read("sh.out");
  outcome.err = read("sh.err");
  return outcome;
}

Outcome Workplace::within([[maybe_unused]] int mebibytes, const std::string& arguments,
                          std::chrono::seconds most) const {
#ifdef __SANITIZE_ADDRESS__
  const std::string limit;
#else
  const std::string limit = "ulimit -v " + std::to_string(mebibytes * 1024) + "; ";
#endif
  return shell(limit + "timeout " + std::to_string(most.count()) + " '" LACQUER_PROGRAM "' " + arguments);
}

void Workplace::write(const std::string& name, const std::string& text) const {
  fs::create_directories((path_ / name).parent_path());
  std::ofstream stream(path_ / name, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) ADD_FAILURE() << name << " cannot be written";
}

std::string Workplace::read(const std::string& name) const { return readFile(path_ / name); }

std::set<std::string> Workplace::names(const std::string& except) const {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(path_)) {
    const std::string name = entry.path().lexically_relative(path_).generic_string();
    if (except.empty() || (name != except && !name.starts_with(except + "/"))) names.insert(name);
  }
  return names;
}

nlohmann::json Workplace::manifest(const std::string& folder) const {
  nlohmann::json json = nlohmann::json::parse(read(folder + "/manifest.json"), nullptr, false);
  if (json.is_discarded()) ADD_FAILURE() << folder << "/manifest.json is no JSON";
  // The validator takes a minute for what tests of large inputs write.
  constexpr uintmax_t kLarge = 8U << 20U;
  const std::filesystem::path file = path_ / folder / "manifest.json";
  if (std::filesystem::file_size(file) < kLarge) {
    EXPECT_EQ(schemaErrors({file}).value_or(""), "");
  }
  return json;
}

std::string example(const std::string& name) { return (sourceFolder() / "examples" / name).string(); }

std::string gltfOf(const std::vector<std::string>& materials) {
  std::string list;
  for (const std::string& material : materials) list += (list.empty() ? "" : ",\n") + material;
  return R"({"asset": {"version": "2.0"}, "materials": [)" + list + "]}\n";
}

}  // namespace lacquer::test
