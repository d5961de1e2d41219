#include "support/outputs.h"

#include <filesystem>
#include <set>
#include <utility>

#include "support/file.h"

namespace lacquer {

namespace {

namespace fs = std::filesystem;

/// Where a file lies, or will. A relative path of which nothing is there yet would stay as it is spelled.
fs::path placeOf(const std::string& path) {
  std::error_code error;
  const fs::path whole = fs::absolute(path, error);
  const fs::path place = error ? fs::path() : fs::weakly_canonical(whole, error);
  return error ? fs::path(path) : place;
}

Diagnostic unwritten(std::string code, const std::string& file, std::string message) {
  return {std::move(code),
          Severity::Error,
          {file, 0, 0, {}},
          std::move(message),
          "nothing was written: name another file or folder",
          {}};
}

}  // namespace

std::optional<std::string_view> inTheWay(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status) || fs::is_regular_file(status)) return std::nullopt;
  return fs::is_directory(status) ? "a folder" : "no regular file";
}

Diagnostics clashes(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  std::set<std::pair<uint64_t, uint64_t>> read;
  for (const std::string& input : inputs) {
    if (const auto stamp = stampOf(input)) read.emplace(stamp->device, stamp->inode);
  }
  Diagnostics wrong;
  std::set<fs::path> places;
  for (const std::string& output : outputs) {
    if (const auto blocked = inTheWay(output)) {
      wrong.push_back(unwritten("file-unwritable", output, "this is " + std::string(*blocked)));
      continue;
    }
    const auto stamp = stampOf(output);
    const char* what = stamp && read.contains({stamp->device, stamp->inode}) ? "an input"
                       : !places.insert(placeOf(output)).second              ? "written twice"
                                                                             : nullptr;
    if (what == nullptr) continue;
    wrong.push_back(
        unwritten("output-clash", output, std::string("this file is to be written and is ") + what));
  }
  return wrong;
}

Diagnostics reservedNames(const std::vector<std::string>& folders, const std::vector<std::string>& files,
                          const std::vector<std::string>& outputs) {
  std::set<fs::path> kept_folders, kept_files;
  for (const std::string& folder : folders) kept_folders.insert(placeOf(folder));
  for (const std::string& file : files) kept_files.insert(placeOf(file));
  Diagnostics wrong;
  for (const std::string& output : outputs) {
    const fs::path place = placeOf(output);
    bool kept = kept_files.contains(place);
    for (fs::path above = place; !kept && above.has_relative_path(); above = above.parent_path())
      kept = kept_folders.contains(above);
    if (!kept) continue;
    wrong.push_back(
        unwritten("output-clash", output, "this file is to be written where the output folder's own are"));
  }
  return wrong;
}

}  // namespace lacquer
