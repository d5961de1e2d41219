#include "support/contain.h"

#include <limits.h>

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <unistd.h>
#endif
#ifdef __linux__
#include <linux/openat2.h>
#include <sys/syscall.h>
#endif

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

namespace lacquer {

namespace fs = std::filesystem;

namespace {

constexpr int kMostLinks = 40;  // as Linux has it

class Walk {
public:
  explicit Walk(std::vector<fs::path> roots) : roots_(std::move(roots)), at_(roots_[0]) {}

  std::optional<std::string> to(const fs::path& relative) {
    push(relative);
    while (!pending_.empty()) {
      const fs::path part = std::move(pending_.back());
      pending_.pop_back();
      if (!step(part)) return std::nullopt;
    }
    if (!inside(at_)) return std::nullopt;
    return at_.string();
  }

private:
  void push(const fs::path& path) {
    const std::vector<fs::path> parts(path.begin(), path.end());
    pending_.insert(pending_.end(), parts.rbegin(), parts.rend());
  }

  bool inside(const fs::path& path) const {
    return std::any_of(roots_.begin(), roots_.end(), [&](const fs::path& root) {
      return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
    });
  }

  /// False when there are too many links. Outside of the roots names are only strung together.
  bool step(const fs::path& part) {
    if (part.empty() || part == ".") return true;
    if (part == "..") {
      at_ = at_.parent_path();
      return true;
    }
    const fs::path next = part.is_absolute() ? part : at_ / part;
    std::error_code error;
    if (inside(next) && fs::is_symlink(fs::symlink_status(next, error))) {
      push(fs::read_symlink(next, error));
      return ++links_ <= kMostLinks && !error;
    }
    at_ = next;
    return true;
  }

  std::vector<fs::path> roots_;
  fs::path at_;
  std::vector<fs::path> pending_;  ///< parts, the next one last
  int links_ = 0;
};

}  // namespace

std::optional<std::string> resolveBelow(const std::string& folder, const std::string& relative,
                                        const std::vector<std::string>& allowed) {
  // No file has a longer name, and the way there takes its square.
  if (relative.size() > PATH_MAX) return std::nullopt;
  std::error_code error;
  std::vector<fs::path> roots{fs::canonical(folder.empty() ? "." : folder, error)};
  if (error) return std::nullopt;
  for (const std::string& other : allowed) {
    fs::path root = fs::canonical(other, error);
    if (!error) roots.push_back(std::move(root));
  }
  return Walk(std::move(roots)).to(relative);
}

#if defined(__unix__) || defined(__APPLE__)

namespace {

/// Folder by folder, each from the descriptor of the one before.
int walkWithoutLinks(const std::string& path, int flags) {
#ifdef O_PATH
  constexpr int kFolder = O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
#else
  constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
#endif
  int at = ::open(path.starts_with('/') ? "/" : ".", kFolder & ~O_NOFOLLOW);
  for (size_t begin = 0; at >= 0;) {
    begin = path.find_first_not_of('/', begin);
    if (begin == std::string::npos) break;
    const size_t end = std::min(path.find('/', begin), path.size());
    const std::string part = path.substr(begin, end - begin);
    const bool last = path.find_first_not_of('/', end) == std::string::npos;
    const int next = part == ".." ? -1 : ::openat(at, part.c_str(), last ? flags | O_NOFOLLOW : kFolder);
    // A link that is to be a folder is told as none.
    const int why = part == ".." || errno == ENOTDIR ? ELOOP : errno;
    ::close(at);
    errno = why;
    if (last) return next;
    at = next;
    begin = end;
  }
  if (at >= 0) ::close(at);
  return -1;
}

}  // namespace

int openWithoutLinks(const std::string& path, int flags, bool by_kernel) {
#ifdef SYS_openat2
  if (by_kernel) {
    struct open_how how {};
    how.flags = static_cast<uint64_t>(flags);
    how.resolve = RESOLVE_NO_SYMLINKS;
    const auto fd = static_cast<int>(::syscall(SYS_openat2, AT_FDCWD, path.c_str(), &how, sizeof how));
    // A sandbox that does not know it answers EPERM.
    if (fd >= 0 || (errno != ENOSYS && errno != EPERM)) return fd;
  }
#else
  (void)by_kernel;
#endif
  return walkWithoutLinks(path, flags);
}

#endif

}  // namespace lacquer
