#include "support/file.h"

#include "support/contain.h"
#include "support/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <random>
#include <utility>

#if defined(__unix__) || defined(__APPLE__)
#define LACQUER_POSIX 1
#include <dirent.h>
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
/// The first line of a note, which no other unfinished file of the folder has.
constexpr std::string_view kNote = "lacquer: what a run may leave behind\n";

/// The last part of a name that no other process or thread takes at the same time.
std::string temporaryName() {
  static const uint64_t process =
      (static_cast<uint64_t>(std::random_device{}()) << 32) | std::random_device{}();
  static std::atomic<uint64_t> counter{0};
  return fmt::format("lacquer-{:016x}-{}.tmp", process, counter++);
}

#ifdef LACQUER_POSIX

/// True for what temporaryName() may give, so that nobody else's files are taken for abandoned ones.
bool isTemporaryName(std::string_view name) {
  constexpr std::string_view kHead = "lacquer-";
  constexpr std::string_view kTail = ".tmp";
  constexpr size_t kProcess = 16;
  if (!name.starts_with(kHead) || !name.ends_with(kTail)) return false;
  name = name.substr(kHead.size(), name.size() - kHead.size() - kTail.size());
  const auto made_of = [](std::string_view text, std::string_view of) {
    return !text.empty() && text.find_first_not_of(of) == std::string_view::npos;
  };
  return name.size() > kProcess + 1 && name[kProcess] == '-' &&
         made_of(name.substr(0, kProcess), "0123456789abcdef") &&
         made_of(name.substr(kProcess + 1), "0123456789");
}

/// A stream on an open file, which is closed with it. Null when there is no memory for one: then it is
/// closed.
std::FILE* streamOf(int fd, const char* mode) {
  std::FILE* file = ::fdopen(fd, mode);
  if (file == nullptr) ::close(fd);
  return file;
}

/// Opens a new file for writing, locked as long as it is open. Null with errno when it cannot be made. With
/// `links` refused the folder itself may be no link.
std::FILE* createLocked(const std::string& folder, const std::string& name, Links links) {
  const int flags = O_RDONLY | O_DIRECTORY | O_CLOEXEC | (links == Links::Refuse ? O_NOFOLLOW : 0);
  const int parent = ::open(folder.c_str(), flags);
  if (parent < 0) return nullptr;
  const int fd = ::openat(parent, name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  const int why = errno;
  ::close(parent);
  errno = why;
  if (fd < 0) return nullptr;
  struct stat status {};
  // Somebody who clears up may have been quicker than the lock: then the file has no name any more.
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0 || ::fstat(fd, &status) != 0 || status.st_nlink == 0) {
    ::close(fd);
    errno = EAGAIN;
    return nullptr;
  }
  std::FILE* file = streamOf(fd, "wb");
  if (file == nullptr) std::remove((folder + "/" + name).c_str());
  return file;
}

/// Opens for reading what is a regular file, and waits for nothing: -1 and the reason for all else.
int openRegular(const std::string& path, Links links, std::string& why, struct stat& status) {
  constexpr int kFlags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
  const int fd = links == Links::None
                     ? openWithoutLinks(path, kFlags)
                     : ::open(path.c_str(), kFlags | (links == Links::Refuse ? O_NOFOLLOW : 0));
  if (fd < 0) {
    why = errno == ENOENT ? "there is no such file"
                          : fmt::format("the file cannot be opened: {}", std::strerror(errno));
    return -1;
  }
  if (::fstat(fd, &status) == 0 && S_ISREG(status.st_mode)) return fd;
  why = S_ISDIR(status.st_mode) ? "this is a folder, not a file" : "this is no regular file";
  ::close(fd);
  return -1;
}

/// True for a note, which is kept.
bool isNote(int fd) {
  std::array<char, kNote.size()> head{};
  return ::pread(fd, head.data(), head.size(), 0) == static_cast<ssize_t>(head.size()) &&
         std::string_view(head.data(), head.size()) == kNote;
}

/// Removes a file that no living process writes. A note that is found goes to `notes`, where that is asked
/// for.
void removeAbandoned(int folder, const char* name, std::vector<std::string>* notes) {
  const int fd = ::openat(folder, name, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY);
  if (fd < 0) return;
  struct stat status {};
  const bool regular = ::fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
  bool noted = false;
  if (regular && ::flock(fd, LOCK_EX | LOCK_NB) == 0) {
    noted = notes != nullptr && isNote(fd);
    if (!noted) ::unlinkat(folder, name, 0);
  }
  ::close(fd);
  if (noted) notes->emplace_back(name);
}

/// `notes`: the names of notes that are kept.
void removeAbandonedIn(const std::string& path, std::vector<std::string>* notes = nullptr) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
  if (fd < 0) return;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::fdopendir(fd), ::closedir);
  if (folder == nullptr) {
    ::close(fd);
    return;
  }
  while (const dirent* entry = ::readdir(folder.get())) {
    if (isTemporaryName(entry->d_name)) removeAbandoned(fd, entry->d_name, notes);
  }
}

void listNames(const std::string& path, std::vector<std::string>& names) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
  if (fd < 0) return;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::fdopendir(fd), ::closedir);
  if (folder == nullptr) {
    ::close(fd);
    return;
  }
  while (const dirent* entry = ::readdir(folder.get())) names.emplace_back(entry->d_name);
}

/// Not a link in its place.
void removeFolder(const std::string& path) { ::rmdir(path.c_str()); }

std::FILE* openOld(const std::string& path) {
  std::string why;
  struct stat status {};
  const int fd = openRegular(path, Links::Follow, why, status);
  return fd < 0 ? nullptr : streamOf(fd, "rb");
}

bool synced(std::FILE* file) { return ::fsync(::fileno(file)) == 0; }

#else

std::FILE* createLocked(const std::string& folder, const std::string& name, Links) {
  return std::fopen((folder + "/" + name).c_str(), "wbx");
}

void removeAbandonedIn(const std::string&, std::vector<std::string>* = nullptr) {}

void listNames(const std::string& path, std::vector<std::string>& names) {
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(path, error))) return;
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error))
    names.push_back(it->path().filename().string());
}

void removeFolder(const std::string& path) {
  std::error_code error;
  fs::remove(path, error);
}

std::FILE* openOld(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) ? std::fopen(path.c_str(), "rb") : nullptr;
}

bool synced(std::FILE*) { return true; }

#endif

tl::unexpected<Diagnostics> tooLarge(const Place& place, uint64_t largest) {
  return fail("file-too-large", place, fmt::format("it has more than {} bytes", largest), raising("file"));
}

/// Opens what is a regular file; null and the reason for all else.
std::FILE* openToRead(const std::string& path, Links links, std::string& why, uint64_t& size) {
#ifdef LACQUER_POSIX
  struct stat status {};
  const int fd = openRegular(path, links, why, status);
  if (fd < 0) return nullptr;
  std::FILE* file = streamOf(fd, "rb");
  size = static_cast<uint64_t>(status.st_size);
  if (file == nullptr) why = "the file cannot be opened";
#else
  std::error_code error;
  why = fs::is_directory(path, error)                           ? "this is a folder, not a file"
        : links != Links::Follow && fs::is_symlink(path, error) ? "a link"
                                                                : "";
  std::FILE* file = why.empty() ? std::fopen(path.c_str(), "rb") : nullptr;
  if (file == nullptr && why.empty()) why = "there is no such file";
  size = file == nullptr ? 0 : fs::file_size(path, error);
#endif
  return file;
}

/// What is left of an open file of about `expected` bytes. Closes it.
Result<std::string> readRest(std::FILE* file, uint64_t expected, uint64_t largest, const Place& place) {
  std::setvbuf(file, nullptr, _IONBF, 0);
  // One byte more than expected, so that the end shows with the first read.
  std::string bytes(static_cast<size_t>(std::min(expected, largest)) + 1, '\0');
  size_t used = 0;
  while (const size_t got = std::fread(bytes.data() + used, 1, bytes.size() - used, file)) {
    used += got;
    if (used > largest) break;
    if (used == bytes.size()) bytes.resize(std::max(kBlock, 2 * used));
  }
  const bool bad = std::ferror(file) != 0;
  std::fclose(file);
  if (bad) return fail("file-unreadable", place, "the file cannot be read to its end");
  if (used > largest) return tooLarge(place, largest);
  bytes.resize(used);
  return bytes;
}

/// What killed processes left in a folder of the user's, where files are written beside their places.
void clearOnce(const std::string& folder) {
  static std::mutex mutex;
  static std::string last;  // many files go to one folder, one after the other
  const std::lock_guard lock(mutex);
  if (last == folder) return;
  last = folder;
  removeAbandonedIn(folder);
}

}  // namespace

std::vector<std::string> namesIn(const std::string& folder) {
  std::vector<std::string> names;
  listNames(folder, names);
  return names;
}

Result<std::string> readFile(const std::string& path, uint64_t largest, Links links) {
  const Place place{path, 0, 0, {}};
  std::string why;
  uint64_t size = 0;
  std::FILE* file = openToRead(path, links, why, size);
  if (file == nullptr) return fail("file-unreadable", place, std::move(why));
  if (size > largest) {
    std::fclose(file);
    return tooLarge(place, largest);
  }
  return readRest(file, size, largest, place);
}

std::string startOf(const std::string& path, size_t most, Links links) {
  std::string why;
  uint64_t size = 0;
  std::string bytes(most, '\0');
  std::FILE* file = openToRead(path, links, why, size);
  if (file == nullptr) return {};
  std::setvbuf(file, nullptr, _IONBF, 0);
  bytes.resize(std::fread(bytes.data(), 1, most, file));
  std::fclose(file);
  return bytes;
}

Result<std::string> readStandardInput(uint64_t largest) {
  const Place place{"-", 0, 0, {}};
#ifdef LACQUER_POSIX
  const int fd = ::dup(STDIN_FILENO);
  std::FILE* file = fd < 0 ? nullptr : streamOf(fd, "rb");
#else
  std::FILE* file = stdin;
#endif
  if (file == nullptr) return fail("file-unreadable", place, "there is no standard input");
  return readRest(file, kBlock, largest, place);
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

std::string Scratch::below(const std::string& folder) { return folder + std::string(kScratch); }

Scratch::Scratch(const std::string& folder) : path_(below(folder)) {
  removeAbandonedIn(path_, &noted_);
  for (const std::string& name : noted_) {
    const Result<std::string> text = readFile(path_ + "/" + name, Limits{}.file, Links::Refuse);
    if (text && text->starts_with(kNote)) notes_.push_back(text->substr(kNote.size()));
  }
  removeFolder(path_);
}

Scratch::~Scratch() {
  if (note_ != nullptr) std::fclose(note_);
  removeFolder(path_);  // fails while another process has a file in it, which is right
}

void Scratch::note(std::string_view text) {
  std::error_code error;
  fs::create_directories(path_, error);
  std::string name = temporaryName();
  note_ = createLocked(path_, name, Links::Refuse);
  if (note_ == nullptr) return;
  const bool whole = std::fwrite(kNote.data(), 1, kNote.size(), note_) == kNote.size() &&
                     std::fwrite(text.data(), 1, text.size(), note_) == text.size() &&
                     std::fflush(note_) == 0;
  // Earlier ones stay where this one does not say all that they say.
  if (whole) remove(std::exchange(noted_, {}));
  noted_.push_back(std::move(name));
}

void Scratch::forget() {
  if (note_ != nullptr) std::fclose(std::exchange(note_, nullptr));  // some systems remove no open file
  remove(std::exchange(noted_, {}));
  notes_.clear();
}

void Scratch::remove(const std::vector<std::string>& names) const {
  std::error_code ignored;
  for (const std::string& name : names) fs::remove(path_ + "/" + name, ignored);
}

ReplacingFile::ReplacingFile(std::string path, const Writing& how)
    : path_(std::move(path)), of_scratch_(how.scratch != nullptr), sync_(how.sync) {
  const std::string parent = fs::path(path_).parent_path().string();
  folder_ = of_scratch_ ? how.scratch->path() : parent.empty() ? "." : parent;
  if (const auto what = inTheWay(path_)) {
    wrong_ = fmt::format("this is {}", *what);
    return;
  }
  old_ = openOld(path_);
  if (old_ == nullptr)
    create();
  else
    std::setvbuf(old_, nullptr, _IONBF, 0);
}

ReplacingFile::~ReplacingFile() {
  if (old_ != nullptr) std::fclose(old_);
  if (fresh_ == nullptr) return;
  std::fclose(fresh_);
  std::remove(temporary_.c_str());  // not by a path: this may be where memory has run out
}

void ReplacingFile::create() {
  if (!of_scratch_) clearOnce(folder_);
  for (int attempt = 0; attempt < 100; ++attempt) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) {
      wrong_ = fmt::format("its folder cannot be made: {}", error.message());
      return;
    }
    const std::string name = temporaryName();
    temporary_ = folder_ + "/" + name;
    fresh_ = createLocked(folder_, name, of_scratch_ ? Links::Refuse : Links::Follow);
    if (fresh_ != nullptr) return;
    // The scratch folder went with another process's last file, or the file was taken for an abandoned one.
    // All else stays as it is: a link in the scratch folder's place, say.
    if (errno != ENOENT && errno != EAGAIN) break;
  }
  const char* why = std::strerror(errno);
  std::error_code error;
  const bool link = of_scratch_ && fs::is_symlink(fs::symlink_status(folder_, error));
  wrong_ = link ? fmt::format("{} is a link: remove it", folder_)
                : fmt::format("the file cannot be made: {}", why);
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
  if (std::fflush(fresh_) != 0 || std::ferror(fresh_) != 0 || (sync_ && !synced(fresh_))) {
    return failed(fmt::format("the file cannot be written: {}", std::strerror(errno)),
                  "check space and permissions");
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
    const std::string beside = (parent / temporaryName()).string();
    fs::copy_file(temporary_, beside, error);
    if (std::FILE* copy = !error && sync_ ? std::fopen(beside.c_str(), "rb+") : nullptr) {
      if (!synced(copy)) error = std::make_error_code(std::errc::io_error);
      std::fclose(copy);
    }
    if (!error) fs::rename(beside, path_, error);
    fs::remove(temporary_);
  }
  if (error) return failed(fmt::format("the file cannot be put in place: {}", error.message()));
  if (fresh_ != nullptr)
    std::fclose(std::exchange(fresh_, nullptr));  // the lock lasts until the name is gone
  return true;
}

Result<bool> writeFile(const std::string& path, std::string_view bytes, const Writing& how) {
  ReplacingFile file(path, how);
  file.append(bytes);
  return file.finish();
}

}  // namespace lacquer
