// Paths as a file names them that lies in another folder than the working one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "support/diagnostic.h"

namespace lacquer {

/// `path`, as seen from `folder`, with `/` between the parts: what the two were given by, the working folder
/// included, does not show. Links in `folder` are followed, so that `..` leads where it says; the folder need
/// not exist. On systems with several roots a path on another one stays absolute.
std::string relativeTo(const std::string& folder, const std::string& path);

/// "file-unwritable" where relativeTo() would end the run for that folder and one of these paths, or Moved
/// for a folder to move to: the working folder is gone, or the system takes no such name.
Result<void> hasPlace(const std::string& folder, const std::vector<std::string>& paths = {});

/// What paths in files of the folder `from` are in those of the folder `to`. Of the paths the words decide
/// alone: they may be those of others, and nothing is looked at where they lead. Where both folders are below
/// the working one, their words do, too: neither where that is shows nor what is there; else links in them
/// are followed. Where both are one, nothing is looked at.
class Moved {
public:
  Moved(const std::string& from, const std::string& to);
  std::string operator()(const std::string& path) const;

private:
  bool below_;                       ///< both are below the working folder
  std::filesystem::path from_, to_;  ///< by their words then; else `from_` is absolute, and `to_` is not used
  std::filesystem::path absolute_to_;
};

/// The folder that a file lies in: "." for one without.
std::string folderOf(const std::string& path);

}  // namespace lacquer
