#include "support/relative.h"

#include <algorithm>

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

/// From the root of the file system.
fs::path whole(const std::string& path) {
  const fs::path given(path);
  return given.is_absolute() ? given : fs::current_path() / given;
}

/// The same with links followed, and without a slash at the end. A call that fails ends the run: without it
/// the path would be another one, and the manifest say so.
fs::path followed(const std::string& folder) { return withoutSlash(fs::weakly_canonical(whole(folder))); }

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
  const fs::path to = plain(whole(path));
  const fs::path relative = to.lexically_relative(followed(folder));
  return relative.empty() ? to.generic_string() : relative.generic_string();
}

Result<void> hasPlace(const std::string& folder, const std::vector<std::string>& paths) {
  const auto is_relative = [](const std::string& path) { return !fs::path(path).is_absolute(); };
  std::error_code error;
  fs::path here;
  if (is_relative(folder) || std::any_of(paths.begin(), paths.end(), is_relative))
    here = fs::current_path(error);
  if (!error) (void)fs::weakly_canonical(here / folder, error);
  if (!error) return {};
  return fail("file-unwritable", {folder, 0, 0, {}},
              "where this folder is cannot be told: " + error.message(), "nothing was written");
}

Moved::Moved(const std::string& from, const std::string& to)
    : below_(from == to || (isBelow(from) && isBelow(to))) {
  if (from != to) absolute_to_ = followed(to);
  from_ = below_ ? fs::path(from) : followed(from);
  if (below_) to_ = withoutSlash(fs::path(to).lexically_normal());
}

std::string Moved::operator()(const std::string& path) const {
  const fs::path there = (from_ / path).lexically_normal();
  // Of a folder that stays the words will do, but for what does not begin there; a module without files has
  // no working folder.
  std::error_code none;
  const bool elsewhere = absolute_to_.empty() && there.is_absolute() && !to_.is_absolute();
  if (elsewhere && fs::current_path(none).empty()) return there.generic_string();
  const fs::path whole_to = elsewhere ? followed(to_.string()) : absolute_to_.empty() ? to_ : absolute_to_;
  const fs::path relative = there.lexically_relative(there.is_absolute() ? whole_to : to_);
  return relative.empty() ? there.generic_string() : relative.generic_string();
}

std::string folderOf(const std::string& path) {
  const std::string parent = fs::path(path).parent_path().string();
  return parent.empty() ? "." : parent;
}

}  // namespace lacquer
