#include "lang/suggest.h"

#include "support/text.h"

namespace lacquer::lang {

std::string_view nearest(std::string_view name, std::span<const std::string_view> candidates) {
  return closest(name, candidates);
}

std::string didYouMean(std::string_view name, std::span<const std::string_view> candidates,
                       std::string otherwise) {
  const std::string_view found = closest(name, candidates);
  return found.empty() ? std::move(otherwise) : "did you mean '" + std::string(found) + "'?";
}

}  // namespace lacquer::lang
