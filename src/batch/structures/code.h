// The code of a distinct shader: printed, compiled and validated, or found in the cache.
#pragma once

#include <map>

#include "shader/print.h"
#include "structures/structures.h"

namespace lacquer {

/// The bytes of one target's files, and whether they have been found valid.
struct TargetCode {
  bool made = false;
  bool validated = false;
  std::array<std::string, 2> bytes;  ///< by stage
};

struct ShaderCode {
  std::map<Target, TargetCode> targets;
  bool cached = false;  ///< nothing had to be made
  Diagnostics wrong;    ///< places are paths below the output folder
  /// All of it is there.
  bool complete() const;
};

/// May be used from several threads at once.
class Coder {
public:
  explicit Coder(const Setting& setting);
  /// What the cache lacks is made. Takes the module where that has to be printed, and makes it where it is
  /// not there.
  ShaderCode code(const std::string& id, Distinct& shader) const;

private:
  Key keyOf(const std::string& id, Target target) const;
  TargetCode load(const Key& key) const;
  void save(const Key& key, const TargetCode& code) const;
  void print(const std::string& id, Distinct& shader, const std::vector<Target>& targets,
             ShaderCode& code) const;

  const Setting& setting_;
  std::map<Target, std::string> programs_;  ///< that check the code, beside what is linked
};

}  // namespace lacquer
