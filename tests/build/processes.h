// Running programs from a test, and looking at folders.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lacquer::test {

/// A program that runs beside the test, its output in a file. Killed when it is let go.
class Process {
public:
  /// `arguments[0]` is the program. `folder` is where it runs.
  Process(std::vector<std::string> arguments, const std::filesystem::path& folder);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Its exit status; 128 and more when a signal ended it.
  int wait();
  void kill();
  std::string output() const;

private:
  std::filesystem::path log_;
  int id_ = -1;
};

/// Runs a program to its end. What it printed goes to `output`.
int runProgram(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
               std::string* output = nullptr);

struct FileState {
  std::string bytes;
  std::filesystem::file_time_type time;
};

/// All files below a folder, by their names there.
std::map<std::string, FileState> filesBelow(const std::filesystem::path& folder);

/// What differs between two folders' names and bytes, one line each; empty when nothing does.
std::string differences(const std::filesystem::path& a, const std::filesystem::path& b);

/// An empty folder of that name, for the test that runs.
std::filesystem::path freshFolder(const std::string& name);

/// All bytes of a file; empty when it cannot be read.
std::string readText(const std::filesystem::path& file);
void writeText(const std::filesystem::path& file, const std::string& text);

}  // namespace lacquer::test
