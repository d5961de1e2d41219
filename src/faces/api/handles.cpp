#include <fmt/format.h>

#include "api/internal.h"
#include "setting/messages.h"

namespace lacquer {

bool filled(const void* impl, std::string_view what, Messages& messages) {
  if (impl != nullptr) return true;
  report(fail("empty-handle", {}, fmt::format("the {} is empty", what),
              "it was never made, was moved from, or could not be made: earlier messages say why")
             .value(),
         {}, messages);
  return false;
}

}  // namespace lacquer
