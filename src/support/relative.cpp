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

fs::path withoutSlash(const fs::path& path) { return path.has_filename() ? path : path.parent_path(); }

/// Below the working folder, and not through links: `..` in a path that begins there means what it says.
bool isBelow(const fs::path& folder) {
  const fs::path words = folder.lexically_normal();
  if (words.is_absolute() || words.empty() || *words.begin() == "..") return false;
  std::error_code ignored;
  const fs::path here = fs::weakly_canonical(fs::current_path(ignored), ignored);
  return !here.empty() &&
         fs::weakly_canonical(here / folder, ignored) == withoutSlash((here / folder).lexically_normal());
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

std::string moved(const std::string& path, const std::string& from, const std::string& to) {
  const std::string here = fromFolder(from, path);
  if (fs::path(path).is_absolute() || !isBelow(from) || !isBelow(to)) return relativeTo(to, here);
  const fs::path words = fs::path(here).lexically_normal();
  return words.lexically_relative(withoutSlash(fs::path(to).lexically_normal())).generic_string();
}

std::string folderOf(const std::string& path) {
  const std::string parent = fs::path(path).parent_path().string();
  return parent.empty() ? "." : parent;
}

}  // namespace lacquer
