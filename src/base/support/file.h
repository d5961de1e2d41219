// Files: read whole, written whole or not at all.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer {

/// Symbolic links on the way to a file that is read.
enum class Links : uint8_t {
  Follow,
  Refuse,  ///< the last part of the path may be none
  None,    ///< no part of it: of a path that resolveBelow() gives, from which a link would lead elsewhere
};

/// The bytes of a regular file: no folder, no pipe, no device. Errors: "file-unreadable", "file-too-large"
/// for more bytes than `largest`. The file is looked at by its descriptor alone.
Result<std::string> readFile(const std::string& path, uint64_t largest = Limits{}.file,
                             Links links = Links::Follow);
/// Its first bytes, so many at most; none where readFile() would fail.
std::string startOf(const std::string& path, size_t most, Links links = Links::Follow);
/// The bytes of the standard input, with the same errors.
Result<std::string> readStandardInput(uint64_t largest = Limits{}.file);

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
/// has such locks), and the folder itself goes with the last of them. A link in its place is not followed,
/// and what has no name of ours or is no regular file is left alone.
///
/// A note there is what a run that does not come to its end leaves to the next one.
class Scratch {
public:
  explicit Scratch(const std::string& folder);
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::string& path() const { return path_; }
  /// Where it is below a folder.
  static std::string below(const std::string& folder);

  /// The notes of earlier runs that were killed before forget().
  const std::vector<std::string>& notes() const { return notes_; }
  /// Leaves this to the next Scratch in place of notes(). A note that cannot be written is none.
  void note(std::string_view text);
  /// Removes the notes.
  void forget();

private:
  void remove(const std::vector<std::string>& names) const;

  std::string path_;
  std::vector<std::string> notes_, noted_;  ///< texts, and the names of the notes that there are
  std::FILE* note_ = nullptr;               ///< open, and so locked, as long as this process lives
};

/// The names in a folder, "." and ".." among them, in no order; none where there is no folder, or a link in
/// its place. Memory that runs out is an exception, where the standard library's own listing would end the
/// process.
std::vector<std::string> namesIn(const std::string& folder);

struct Writing {
  const Scratch* scratch = nullptr;  ///< where the file is written; without one, beside its place
  /// The bytes are on the disk before the file gets its name: it is whole even after a power cut.
  bool sync = true;
};

/// A file that takes the place of `path` in one step at finish(), and only when its bytes differ: as long as
/// what is appended is what the old file holds, nothing is written. It holds a few hundred KiB, however long
/// the file becomes.
class ReplacingFile {
public:
  explicit ReplacingFile(std::string path, const Writing& how = {});
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
  bool of_scratch_, sync_;
  std::string pending_;
  std::FILE* old_ = nullptr;  ///< while everything so far is what it holds
  std::FILE* fresh_ = nullptr;
  uint64_t same_ = 0;  ///< bytes of `old_` that were compared
  std::string wrong_;  ///< why it cannot be written
};

/// Puts these bytes in place of what `path` holds, in one step; missing folders are made. A file that holds
/// them already is left alone (false). Errors: "file-unwritable".
Result<bool> writeFile(const std::string& path, std::string_view bytes, const Writing& how = {});

}  // namespace lacquer
