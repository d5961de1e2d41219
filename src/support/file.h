// Files: read whole, written whole or not at all.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "support/diagnostic.h"

namespace lacquer {

/// The bytes of a file. Errors: "file-unreadable".
Result<std::string> readFile(const std::string& path);

/// What the file system knows of a file, without a look at its bytes. Whoever changes them changes `changed`,
/// which nobody can set.
struct FileStamp {
  uint64_t device = 0, inode = 0, size = 0;
  int64_t modified = 0, changed = 0;  ///< nanoseconds since 1970
  bool operator==(const FileStamp&) const = default;
};
/// Nothing where there is no such file, and on systems that do not tell.
std::optional<FileStamp> stampOf(const std::string& path);

/// Makes a folder with those above it (true), or finds it there, to be written to (false). Errors:
/// "file-unwritable".
Result<bool> makeFolder(const std::string& path);

/// A folder for files that are being written, below `folder` and made with the first of them. What killed
/// processes left there is removed by the next Scratch (a writer holds a lock on its file, where the system
/// has such locks), and the folder itself goes with the last of them.
class Scratch {
public:
  explicit Scratch(std::string folder);
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::string& path() const { return path_; }

private:
  std::string path_;
};

/// A file that takes the place of `path` in one step at finish(), and only when its bytes differ: as long as
/// what is appended is what the old file holds, nothing is written. It holds a few hundred KiB, however long
/// the file becomes.
class ReplacingFile {
public:
  /// Without a scratch folder the file is written beside `path`.
  explicit ReplacingFile(std::string path, const Scratch* scratch = nullptr);
  ~ReplacingFile();
  ReplacingFile(const ReplacingFile&) = delete;
  ReplacingFile& operator=(const ReplacingFile&) = delete;

  void append(std::string_view bytes);
  /// True when the file was (re)placed, false when it held these bytes already. Errors: "file-unwritable".
  Result<bool> finish();

private:
  void flush(std::string_view bytes);
  bool matches(std::string_view bytes);
  void diverge();
  void create();
  Result<bool> failed(std::string message, std::string help = {});

  std::string path_, folder_, temporary_;
  std::string pending_;
  std::FILE* old_ = nullptr;  ///< while everything so far is what it holds
  std::FILE* fresh_ = nullptr;
  uint64_t same_ = 0;  ///< bytes of `old_` that were compared
  std::string wrong_;  ///< why it cannot be written
};

/// Puts these bytes in place of what `path` holds, in one step; missing folders are made. A file that holds
/// them already is left alone (false). Errors: "file-unwritable".
Result<bool> writeFile(const std::string& path, std::string_view bytes, const Scratch* scratch = nullptr);

}  // namespace lacquer
