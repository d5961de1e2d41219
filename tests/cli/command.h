// The program as a child process: what it prints, how it ends, how long it takes.
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace lacquer::test {

struct Outcome {
  int status = -1;  ///< exit status; 128 and the signal's number when one ended it
  std::string out, err;
  double seconds = 0;
  /// Both texts, for a failed test.
  std::string all() const { return "status " + std::to_string(status) + "\n" + out + err; }
};

/// A folder of its own, in which the program runs.
class Workplace {
public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  /// Runs the program. One that takes longer than `most` is killed and fails the test. Its standard output
  /// goes to `out` where one is given.
  Outcome run(std::vector<std::string> arguments, std::chrono::seconds most = std::chrono::seconds(120),
              const std::filesystem::path& out = {}) const;
  /// Runs a command of the shell in the folder.
  Outcome shell(const std::string& script) const;
  /// Runs the program, its arguments in a shell's words, with so many MiB of address space, which sanitizers
  /// need more of, and for so long at most.
  Outcome within(int mebibytes, const std::string& arguments,
                 std::chrono::seconds most = std::chrono::seconds(60)) const;
  /// Writes a file below the folder.
  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  bool has(const std::string& name) const { return std::filesystem::exists(path_ / name); }
  /// Everything below the folder, without `except` and what is in it.
  std::set<std::string> names(const std::string& except = {}) const;
  /// The parsed manifest of an output folder, which must be as its schema says.
  nlohmann::json manifest(const std::string& folder) const;

private:
  std::filesystem::path path_;
};

/// What is wrong with manifests by docs/manifest.schema.json, or with other files by another schema of docs/,
/// a line each; nothing where there is no library of schemas to ask (Debian: python3-jsonschema).
std::optional<std::string> schemaErrors(const std::vector<std::filesystem::path>& files,
                                        const std::string& schema = "manifest");

/// A file of examples/, absolute.
std::string example(const std::string& name);

/// A glTF file of these materials, each `{…}`, without a mesh.
std::string gltfOf(const std::vector<std::string>& materials);

}  // namespace lacquer::test
