// The programs of a run with --programs: which structures share one, and what each brings to it.
#pragma once

#include "programs/curve.h"
#include "programs/unite.h"
#include "programs/weights.h"
#include "run/structures.h"

namespace lacquer {

/// A material's use of a shader, and its share of the picture.
struct ProgramUse {
  std::string shader;
  double weight = 0;
};

class Programs {
public:
  /// A structure's place in a merged program.
  struct Member {
    std::shared_ptr<const programs::United> united;
    size_t place = 0;
  };

  /// `structures`: those that the run has met; `uses`: of every material. Merges them as the options say.
  Programs(const std::vector<const Structure*>& structures, const std::vector<ProgramUse>& uses,
           size_t materials, const Setting& setting);

  /// Null for a structure that keeps a program of its own.
  const Member* of(const Key& structure) const;
  /// Of everything that it decides.
  const Key& digest() const { return digest_; }
  const programs::Curve& curve() const { return curve_; }

private:
  std::map<Key, Member> members_;
  Key digest_;
  programs::Curve curve_;
};

/// A texture that a material has not: what it binds.
void writeStandIn(const programs::TextureFill& fill, bool srgb, JsonText& json);

}  // namespace lacquer
