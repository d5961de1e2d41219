#include "support/relative.h"

#include <filesystem>

namespace lacquer {

namespace fs = std::filesystem;

namespace {

/// Without `.` and `..`, as long as that leads to the same place: `link/..` need not be where `link` is.
fs::path plain(const fs::path& path) {
  std::error_code ignored;
  const fs::path normal = path.lexically_normal();
  if (normal == path || !fs::exists(path, ignored) || fs::equivalent(normal, path, ignored)) return normal;
  const fs::path real = fs::weakly_canonical(path.parent_path(), ignored);
  return real.empty() ? normal : real / path.filename();
}

}  // namespace

std::string relativeTo(const std::string& folder, const std::string& path) {
  // A call that fails ends the run: without it the path would be another one, and the manifest say so.
  const fs::path here = fs::current_path();
  fs::path from = fs::weakly_canonical(here / folder);
  if (!from.has_filename()) from = from.parent_path();  // "a/" is "a" and an empty name
  const fs::path to = plain(here / path);
  const fs::path relative = to.lexically_relative(from);
  return relative.empty() ? to.generic_string() : relative.generic_string();
}

std::string fromFolder(const std::string& folder, const std::string& path) {
  return (fs::path(folder) / path).generic_string();
}

std::string folderOf(const std::string& path) {
  const std::string parent = fs::path(path).parent_path().string();
  return parent.empty() ? "." : parent;
}

}  // namespace lacquer
