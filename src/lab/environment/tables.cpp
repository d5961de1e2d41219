#include "eval/dfg.h"

#include <optional>
#include <string>

#include "eval/sheen.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/file.h"
#include "texture/table.h"

namespace lacquer {

namespace {

bool hasSize(uint32_t size, Messages& messages) {
  constexpr uint32_t kLeastSize = 2;
  constexpr uint32_t kMostSize = 1024;
  const Result<void> good = inRange("the table's size", size, kLeastSize, kMostSize, "texels");
  if (!good) report(good.error(), {}, messages);
  return good.has_value();
}

bool write(const std::string& path, uint32_t size, std::vector<float> (*make)(uint32_t), Messages& messages) {
  if (const Result<void> named = hasPath("the table's file", path); !named) {
    report(named.error(), {}, messages);
    return false;
  }
  if (!hasSize(size, messages)) return false;
  const std::optional<texture::Container> container = texture::containerOf(path);
  if (!container) {
    Diagnostics wrong = fail("table-format", {path, 0, 0, {}}, "the file's name does not say what to write",
                             "it ends in .dds, .ktx2 or .png")
                            .value();
    report(wrong, {}, messages);
    return false;
  }
  const Result<bool> written = writeFile(path, texture::tableFile(*container, size, make(size)));
  if (!written) report(written.error(), {}, messages);
  return written.has_value();
}

}  // namespace

std::vector<float> environmentDfg(uint32_t size, Messages& messages) {
  return hasSize(size, messages) ? eval::environmentDfgTable(size) : std::vector<float>();
}

bool writeEnvironmentDfg(const std::string& path, uint32_t size, Messages& messages) {
  return write(path, size, eval::environmentDfgTable, messages);
}

std::vector<float> environmentSheen(uint32_t size, Messages& messages) {
  return hasSize(size, messages) ? eval::environmentSheenTable(size) : std::vector<float>();
}

bool writeEnvironmentSheen(const std::string& path, uint32_t size, Messages& messages) {
  return write(path, size, eval::environmentSheenTable, messages);
}

}  // namespace lacquer
