// Paths as a file names them that lies in another folder than the working one.
#pragma once

#include <string>

namespace lacquer {

/// `path`, as seen from `folder`, with `/` between the parts: what the two were given by, the working folder
/// included, does not show. Links in `folder` are followed, so that `..` leads where it says; the folder need
/// not exist. On systems with several roots a path on another one stays absolute.
std::string relativeTo(const std::string& folder, const std::string& path);

/// The other way: a path in a file of `folder`, for a program that is in the working folder.
std::string fromFolder(const std::string& folder, const std::string& path);

/// A path in a file of the folder `from`, for a file of the folder `to`. Where both are below the working
/// folder, the words decide alone: neither where that is shows nor what is there.
std::string moved(const std::string& path, const std::string& from, const std::string& to);

/// The folder that a file lies in: "." for one without.
std::string folderOf(const std::string& path);

}  // namespace lacquer
