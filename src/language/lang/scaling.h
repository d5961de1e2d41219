// How a node's results change when some of its arguments are multiplied by one number: what tells whether
// light that a layer dims is dimmed in all that is made of it.
#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "lang/ast.h"

namespace lacquer::lang {

/// Of a value, when the numbers that are looked at are multiplied by one factor k >= 0.
enum class Scaling : uint8_t {
  Zero,    ///< it is 0 in any case
  Fixed,   ///< it stays as it is
  Scaled,  ///< it is multiplied by k, too
  Other,   ///< nothing is known
};

/// Of a value that is one of two.
Scaling either(Scaling a, Scaling b);

/// Goes through the bodies of nodes, which are checked. What it has found is kept.
class ScalingOfNodes {
public:
  /// Of each result, for these of the parameters; a default's is given, too (scalingOf()).
  const std::vector<Scaling>& of(const NodeDecl& node, std::string_view variant,
                                 const std::vector<Scaling>& arguments);

private:
  struct Key {
    const Body* body;
    std::vector<Scaling> arguments;
    bool operator<(const Key& other) const {
      return std::tie(body, arguments) < std::tie(other.body, other.arguments);
    }
  };
  std::map<Key, std::vector<Scaling>> known_;
};

/// Of a number.
Scaling scalingOf(const ir::Components& constant);
/// Of a parameter's default.
Scaling scalingOf(const Param& param);

}  // namespace lacquer::lang
