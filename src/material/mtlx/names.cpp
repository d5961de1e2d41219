#include "mtlx/names.h"

#include <fmt/format.h>

namespace lacquer::materialx {

std::string NameSet::free(std::string name) {
  if (taken_.insert(name).second) return name;
  size_t& number = next_.try_emplace(name, 2).first->second;
  while (true) {
    std::string free = fmt::format("{}_{}", name, number++);
    if (taken_.insert(free).second) return free;
  }
}

}  // namespace lacquer::materialx
