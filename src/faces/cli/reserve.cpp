#include "cli/reserve.h"

#include <cstdlib>
#include <new>

namespace lacquer::cli {

namespace {

/// More than all arguments need but those that a file has written.
constexpr size_t kReserved = size_t{1} << 20;

void* reserved = nullptr;

/// Called by `new` when there is no memory; it tries again as long as there is a handler.
void giveBack() {
  std::free(reserved);
  reserved = nullptr;
  std::set_new_handler(nullptr);
}

}  // namespace

Reserve::Reserve() {
  reserved = std::malloc(kReserved);
  if (reserved != nullptr) std::set_new_handler(giveBack);
}

Reserve::~Reserve() { giveBack(); }

}  // namespace lacquer::cli
