#include "support/say_once.h"

#include <algorithm>
#include <utility>

namespace lacquer {

void addOnce(Diagnostics& to, const Diagnostics& more) {
  const auto before = static_cast<ptrdiff_t>(to.size());
  for (const Diagnostic& one : more) {
    const auto same = [&](const Diagnostic& other) {
      return one.place.line != 0 && other.place == one.place && other.code == one.code;
    };
    if (std::none_of(to.begin(), to.begin() + before, same)) to.push_back(one);
  }
}

void addBoundedOnce(Diagnostics& to, Diagnostic one) {
  if (hasRoom(to) && std::find(to.begin(), to.end(), one) != to.end()) return;
  addBounded(to, std::move(one));
}

}  // namespace lacquer
