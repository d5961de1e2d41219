// E3: what physics says that a node's result is, for nodes of which it says something.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/error_subjects.h"

namespace lacquer::bench {

struct Truth {
  std::string what;  ///< for the page
  eval::Columns columns;
  size_t points = 0;
  std::vector<double> values;  ///< three alike for each point, as the modules give them
};

/// The exact answers at points of their own, since inputs that are free of each other mean nothing here.
std::optional<Truth> truthOf(const Subject& subject);

}  // namespace lacquer::bench
