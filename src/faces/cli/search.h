// Advice on a name that nothing has: a name near to it, or texts that have the word.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace lacquer::cli {

/// A name with a text about it.
struct Described {
  std::string_view name;
  std::string_view about;
};

/// "did you mean 'noise2d'?" where a name is near; else "'noise2d' and 'noise3d' are about perlin", those
/// that have the word in their names or texts; empty where there are none. Of equal names the first counts.
std::string nearOrAbout(std::string_view word, std::span<const Described> all);

}  // namespace lacquer::cli
