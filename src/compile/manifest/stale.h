// Shaders that an earlier run has left and a later one does not need.
#pragma once

#include <string>
#include <vector>

#include "support/file.h"

namespace lacquer {

/// The shaders' files, as paths below the folder, that the manifest at `path` lists; of these only what a
/// manifest of Lacquer's may list: `TARGET/ID.frag.EXTENSION` and the like. Nothing where there is no
/// manifest or it is none of Lacquer's.
std::vector<std::string> listedShaders(const std::string& path);

/// Removes those of `earlier` that are regular files below the folder, not among `kept` and none of `inputs`,
/// and the folders of targets that are empty then.
void removeStale(const std::string& folder, const std::vector<std::string>& earlier,
                 const std::vector<std::string>& kept, const std::vector<std::string>& inputs);

/// The shaders that a folder may hold and its list does not name: an earlier run's, those of one that was
/// killed, and this one's. They are noted in the scratch folder, so that the next run knows them where this
/// one does not come to its end.
class LeftShaders {
public:
  LeftShaders(std::string folder, Scratch& scratch, std::vector<std::string> earlier);
  /// Before these, paths below the folder, are written.
  void expect(const std::vector<std::string>& paths);
  /// Once a list names those that are `kept`: as removeStale().
  void remove(const std::vector<std::string>& kept, const std::vector<std::string>& inputs);

private:
  std::string folder_;
  Scratch& scratch_;
  std::vector<std::string> earlier_;
};

/// Removes the manifest at `path`, if it is one of Lacquer's and lists shaders: it was an earlier run's.
void removeManifest(const std::string& path);

}  // namespace lacquer
