#include "support/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <random>
#include <utility>

#if defined(__unix__) || defined(__APPLE__)
#define LACQUER_POSIX 1
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace lacquer {

namespace fs = std::filesystem;

namespace {

constexpr size_t kBlock = size_t{1} << 18;
constexpr std::string_view kScratch = "/.lacquer-tmp";

/// A name that no other process or thread takes at the same time.
std::string temporaryName(const std::string& folder) {
  static const uint64_t process =
      (static_cast<uint64_t>(std::random_device{}()) << 32) | std::random_device{}();
  static std::atomic<uint64_t> counter{0};
  return fmt::format("{}/lacquer-{:016x}-{}.tmp", folder, process, counter++);
}

/// Opens a new file for writing, locked as long as it is open. Null with errno when it cannot be made.
std::FILE* createLocked(const std::string& path) {
#ifdef LACQUER_POSIX
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) return nullptr;
  struct stat status {};
  // Somebody who clears up may have been quicker than the lock: then the file has no name any more.
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0 || ::fstat(fd, &status) != 0 || status.st_nlink == 0) {
    ::close(fd);
    errno = EAGAIN;
    return nullptr;
  }
  return ::fdopen(fd, "wb");
#else
  return std::fopen(path.c_str(), "wbx");
#endif
}

/// Removes a file that no living process writes.
void removeAbandoned([[maybe_unused]] const std::string& path) {
#ifdef LACQUER_POSIX
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return;
  if (::flock(fd, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
  ::close(fd);
#endif
}

}  // namespace

Result<std::string> readFile(const std::string& path) {
  const Place place{path, 0, 0, {}};
  std::error_code error;
  if (fs::is_directory(path, error)) return fail("file-unreadable", place, "this is a folder", "name a file");
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) {
    return fail("file-unreadable", place, "the file cannot be opened", "check the path and its permissions");
  }
  std::setvbuf(file, nullptr, _IONBF, 0);
  std::string bytes;
  const uint64_t size = fs::file_size(path, error);
  // One byte more than expected, so that the end shows with the first read.
  bytes.resize(error ? kBlock : static_cast<size_t>(size) + 1);
  size_t used = 0;
  while (const size_t got = std::fread(bytes.data() + used, 1, bytes.size() - used, file)) {
    used += got;
    if (used == bytes.size()) bytes.resize(2 * used);
  }
  const bool bad = std::ferror(file) != 0;
  std::fclose(file);
  if (bad) return fail("file-unreadable", place, "the file cannot be read to its end");
  bytes.resize(used);
  return bytes;
}

std::optional<FileStamp> stampOf([[maybe_unused]] const std::string& path) {
#ifdef LACQUER_POSIX
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
#ifdef __APPLE__
  const auto [modified, changed] = std::pair(status.st_mtimespec, status.st_ctimespec);
#else
  const auto [modified, changed] = std::pair(status.st_mtim, status.st_ctim);
#endif
  const auto nanoseconds = [](const timespec& time) {
    return static_cast<int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
  };
  return FileStamp{static_cast<uint64_t>(status.st_dev), static_cast<uint64_t>(status.st_ino),
                   static_cast<uint64_t>(status.st_size), nanoseconds(modified), nanoseconds(changed)};
#else
  return std::nullopt;
#endif
}

Result<bool> makeFolder(const std::string& path) {
  const Place place{path, 0, 0, {}};
  if (path.empty()) {
    return fail("file-unwritable", place, "the name of the folder is empty", "the current folder is .");
  }
  std::error_code error;
  const bool made = fs::create_directories(path, error);
  if (error) return fail("file-unwritable", place, "the folder cannot be made: " + error.message());
#ifdef LACQUER_POSIX
  if (::access(path.c_str(), W_OK | X_OK) != 0) {
    return fail("file-unwritable", place,
                fmt::format("the folder cannot be written to: {}", std::strerror(errno)));
  }
#endif
  return made;
}

Scratch::Scratch(std::string folder) : path_(std::move(folder)) {
  path_ += kScratch;
  std::error_code error;
  for (fs::directory_iterator it(path_, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".tmp") removeAbandoned(it->path().string());
  }
  fs::remove(path_, error);
}

Scratch::~Scratch() {
  std::error_code error;
  fs::remove(path_, error);  // fails while another process has a file in it, which is right
}

ReplacingFile::ReplacingFile(std::string path, const Scratch* scratch) : path_(std::move(path)) {
  const std::string parent = fs::path(path_).parent_path().string();
  folder_ = scratch != nullptr ? scratch->path() : parent.empty() ? "." : parent;
  std::error_code error;
  if (fs::is_regular_file(path_, error)) old_ = std::fopen(path_.c_str(), "rb");
  if (old_ == nullptr)
    create();
  else
    std::setvbuf(old_, nullptr, _IONBF, 0);
}

ReplacingFile::~ReplacingFile() {
  if (old_ != nullptr) std::fclose(old_);
  if (fresh_ == nullptr) return;
  std::fclose(fresh_);
  std::error_code error;
  fs::remove(temporary_, error);
}

void ReplacingFile::create() {
  for (int attempt = 0; attempt < 100; ++attempt) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) {
      wrong_ = fmt::format("its folder cannot be made: {}", error.message());
      return;
    }
    temporary_ = temporaryName(folder_);
    fresh_ = createLocked(temporary_);
    if (fresh_ != nullptr) return;
    // The scratch folder went with another process's last file, or the file was taken for an abandoned one.
    if (errno != ENOENT && errno != EAGAIN) break;
  }
  wrong_ = fmt::format("the file cannot be made: {}", std::strerror(errno));
}

bool ReplacingFile::matches(std::string_view bytes) {
  std::array<char, 1 << 14> block;
  while (!bytes.empty()) {
    const size_t n = std::min(bytes.size(), block.size());
    if (std::fread(block.data(), 1, n, old_) != n || std::memcmp(block.data(), bytes.data(), n) != 0)
      return false;
    bytes.remove_prefix(n);
  }
  return true;
}

/// From here on the new file differs: what they share is copied.
void ReplacingFile::diverge() {
  create();
  std::rewind(old_);
  std::string block(std::min<uint64_t>(kBlock, same_), '\0');
  while (fresh_ != nullptr && same_ > 0) {
    const size_t n = std::min<uint64_t>(block.size(), same_);
    if (std::fread(block.data(), 1, n, old_) != n) wrong_ = "what it held cannot be read again";
    std::fwrite(block.data(), 1, n, fresh_);
    same_ -= n;
  }
  std::fclose(old_);
  old_ = nullptr;
}

void ReplacingFile::flush(std::string_view bytes) {
  if (old_ != nullptr) {
    if (matches(bytes)) {
      same_ += bytes.size();
      return;
    }
    diverge();
  }
  if (fresh_ != nullptr) std::fwrite(bytes.data(), 1, bytes.size(), fresh_);
}

void ReplacingFile::append(std::string_view bytes) {
  if (pending_.size() + bytes.size() < kBlock) {
    pending_ += bytes;
    return;
  }
  flush(pending_);
  pending_.clear();
  if (bytes.size() >= kBlock)
    flush(bytes);
  else
    pending_ = bytes;
}

Result<bool> ReplacingFile::failed(std::string message, std::string help) {
  return fail("file-unwritable", {path_, 0, 0, {}}, std::move(message), std::move(help));
}

Result<bool> ReplacingFile::finish() {
  flush(pending_);
  pending_.clear();
  if (old_ != nullptr) {
    char more = 0;
    if (std::fread(&more, 1, 1, old_) == 0) return false;
    diverge();
  }
  if (!wrong_.empty() || fresh_ == nullptr) return failed(wrong_);
  if (std::fflush(fresh_) != 0 || std::ferror(fresh_) != 0) {
    return failed("the file cannot be written", "check space and permissions");
  }
#ifndef LACQUER_POSIX
  std::fclose(std::exchange(fresh_, nullptr));  // an open file cannot be renamed everywhere
#endif
  const fs::path parent = fs::path(path_).parent_path();
  std::error_code error;
  if (!parent.empty()) fs::create_directories(parent, error);
  fs::rename(temporary_, path_, error);
  // The scratch folder may lie on another file system than a folder that is a link.
  if (error == std::errc::cross_device_link) {
    error.clear();
    const std::string beside = temporaryName(parent.string());
    fs::copy_file(temporary_, beside, error);
    if (!error) fs::rename(beside, path_, error);
    fs::remove(temporary_);
  }
  if (error) return failed(fmt::format("the file cannot be put in place: {}", error.message()));
  if (fresh_ != nullptr)
    std::fclose(std::exchange(fresh_, nullptr));  // the lock lasts until the name is gone
  return true;
}

Result<bool> writeFile(const std::string& path, std::string_view bytes, const Scratch* scratch) {
  ReplacingFile file(path, scratch);
  file.append(bytes);
  return file.finish();
}

}  // namespace lacquer
