// Folders that generate() writes, and what lies in them.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lacquer.h"

namespace lacquer::test {

using Json = nlohmann::ordered_json;

/// An empty folder below the system's temporary one, gone with the object.
class Folder {
public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

private:
  std::filesystem::path path_;
};

/// The process's working folder is another one as long as the object lives.
class WorkingFolder {
public:
  explicit WorkingFolder(const std::filesystem::path& folder);
  ~WorkingFolder();
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

private:
  std::filesystem::path before_;
};

void writeText(const std::filesystem::path& file, const std::string& text);

/// The bytes of all files below a folder, by their names there with `/`.
std::map<std::string, std::string> filesOf(const std::filesystem::path& folder);

/// The parsed manifest.json of an output folder; a test failure and null when there is none.
Json manifestOf(const std::filesystem::path& folder);

/// All messages as the command line prints them.
std::string textOf(const Messages& messages);

/// examples/*.gltf, relative to the source folder, in the order in which `./dev` gives them to the program.
std::vector<std::string> exampleFiles();

/// The example files' JSON by their names.
std::map<std::string, Json> exampleJson();

/// generate() into a folder; a test failure unless all of it is good. Gives the manifest.
Json generateWell(const std::vector<std::string>& files, const std::filesystem::path& folder,
                  const Options& options);

/// A shader's code of all targets, for comparing and showing: "glsl frag" and the like, to the bytes.
std::map<std::string, std::string> codeOf(const Shader& shader);

}  // namespace lacquer::test
