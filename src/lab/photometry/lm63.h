// IES files (LM-63): how brightly a lamp shines in the directions in which it was measured.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "support/diagnostic.h"

namespace lacquer::photometry {

/// How the directions of measurement are counted (LM-75): by the pole of the angles.
enum class Web : uint8_t {
  C,  ///< the pole is where the lamp is aimed at; horizontal angles go around it
  B,  ///< the pole is to the side, horizontal angles are latitudes; floodlights
  A,  ///< the pole is above, vertical angles are latitudes; headlights
};

/// What a file says, with all of its factors multiplied in.
struct Measured {
  std::string_view standard;  ///< "LM-63-1995"
  Web web = Web::C;
  std::vector<double> vertical, horizontal;  ///< degrees, ascending; of the web's range
  std::vector<double> candela;               ///< for each horizontal angle those of all vertical ones
};

/// Angles on an axis, and values of a file.
inline constexpr size_t kMostAngles = 8192;
inline constexpr size_t kMostValues = size_t{1} << 22;
/// No lamp has more candela.
inline constexpr double kMostCandela = 1e15;

/// Reads a file of any of the standards from 1986 to 2019. Tilt factors that are in the file are passed over.
/// Warnings: "profile-tilt" for those, "profile-version", "profile-angles" for angles that no standard has
/// and that have a meaning all the same, "profile-trailing". Errors: "profile-unreadable", "profile-tilt" for
/// factors in a file of their own, "profile-range", "profile-angles", "profile-too-large".
Result<Measured> readLm63(std::string_view bytes, const Place& place, Diagnostics& warnings);

}  // namespace lacquer::photometry
