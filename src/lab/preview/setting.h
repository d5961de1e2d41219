// What `lacquer preview --compare` can put side by side, by name.
#pragma once

#include <string>

#include "lacquer.h"
#include "support/diagnostic.h"

namespace lacquer {

struct PreviewSetting {
  std::string name;
  Options options;
  bool in_float = true;
  std::string variant;  ///< used by every node that has one of that name
};

/// "double", "baked+no-ibl", "variant:fast": words joined by `+`, applied in their order to `base`. Errors:
/// "unknown-setting".
Result<PreviewSetting> previewSetting(const std::string& text, PreviewSetting base);

}  // namespace lacquer
