#include <fmt/format.h>

#include <algorithm>

#include "c/handles.h"

using namespace lacquer::c;
using lacquer::Messages;

lacquer_text* lacquer_nodes(const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr),
                 [&](Messages& to) { return textFrom(lacquer::nodesJson(optionsOf(options).options, to)); });
}

int lacquer_check_nodes(const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, 0,
                 [&](Messages& to) { return lacquer::checkNodes(optionsOf(options).options, to) ? 1 : 0; });
}

static int table(std::vector<float> (*make)(uint32_t, Messages&), uint32_t size, float* pairs,
                 size_t capacity, lacquer_messages* messages) {
  return guarded(messages, 0, [&](Messages& to) {
    const std::vector<float> made = make(size, to);
    if (made.empty()) return 0;
    if (pairs == nullptr || capacity < made.size()) {
      sayError(messages, "block-too-small", fmt::format("there is room for {} numbers", capacity),
               fmt::format("the table has {}", made.size()));
      return 0;
    }
    std::copy(made.begin(), made.end(), pairs);
    return 1;
  });
}

int lacquer_environment_dfg(uint32_t size, float* pairs, size_t capacity, lacquer_messages* messages) {
  return table(lacquer::environmentDfg, size, pairs, capacity, messages);
}

int lacquer_environment_sheen(uint32_t size, float* pairs, size_t capacity, lacquer_messages* messages) {
  return table(lacquer::environmentSheen, size, pairs, capacity, messages);
}
