// In place of src/batch/cache/ and of what src/batch/run/ does for materials that share programs: this build
// keeps nothing between runs, and has no costs.
#include "cache/cache.h"

#include "cache/fingerprint.h"
#include "lacquer/options.h"
#include "run/programs.h"

namespace lacquer {

std::string_view fingerprint() { return version(); }

Cache::Cache(const std::string& folder, uint64_t, std::string)
    : folder_(folder), limit_(0), scratch_(folder) {}
Cache::~Cache() = default;
std::optional<std::string> Cache::get(const Key&, bool*) { return std::nullopt; }
void Cache::put(const Key&, std::string_view, bool) {}
Diagnostics Cache::problems() const { return {}; }
Result<std::string> Cache::secretOf(const std::string& path) {
  return fail("no-cache", {path, 0, 0, {}}, "this build of Lacquer has no cache", "leave `cache_key` out");
}

Result<std::unique_ptr<Sharing>> shareDocument(const material::Document&, const std::vector<std::string>&,
                                               Setting&, Structures&, Diagnostics&) {
  return fail("no-programs", {}, "this build of Lacquer has no programs that materials share",
              "leave `programs` out, or make them with the program");
}

}  // namespace lacquer
