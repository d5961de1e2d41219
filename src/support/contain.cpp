#include "support/contain.h"

#include <limits.h>

#include <algorithm>
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

}  // namespace lacquer
