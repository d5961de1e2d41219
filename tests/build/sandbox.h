// A place for a program that holds what it is given and nothing else: made with bubblewrap.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lacquer::test {

enum class Clock {
  Still,  ///< it is 1970
  Wild,   ///< each look finds another time, of a century, backwards too
};

/// In it are the system's libraries and programs (/usr), devices of its own, and what is given. There is no
/// environment, no home, no network and no other process, the user and the machine have other names. Time is
/// answered by a library in place of libc's functions, and refused by the kernel. What is left is the
/// processor's counter, for a program that reads it by itself.
class Sandbox {
public:
  /// Puts what it needs into a folder.
  Sandbox(const std::filesystem::path& folder, Clock clock);

  bool works() const { return why_.empty(); }
  const std::string& why() const { return why_; }
  /// To stand in front of a command that runs in `place`: there what is relative of `inputs` can only be
  /// read.
  std::vector<std::string> around(const std::filesystem::path& place,
                                  const std::vector<std::string>& inputs) const;
  /// The number of a system call that tells the time.
  static long clockCall();

private:
  std::filesystem::path folder_;
  std::string why_;
};

}  // namespace lacquer::test
