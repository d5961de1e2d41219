// `lacquer convert`, `lacquer bake`, and `lacquer graph --format mtlx`: materials for other tools.
#pragma once

#include <string>

#include "cli/options.h"
#include "lacquer/exchange.h"

namespace lacquer::cli {

struct ExchangeFlags {
  std::string file, output, surface;
  Strings materials, also;
  Bake bake;
  Conversion conversion;
  bool quiet = false;
};

void addConvert(CLI::App& verb, ExchangeFlags& flags, OptionFlags& options);
int runConvert(ExchangeFlags& flags, const OptionFlags& options);

void addBake(CLI::App& verb, ExchangeFlags& flags, OptionFlags& options);
int runBake(ExchangeFlags& flags, const OptionFlags& options);

/// Prints the document of a file's materials; of glTF with fallback images of that size.
int printDocument(const OptionFlags& flags, const std::string& format, uint32_t size, const std::string& file,
                  const Strings& materials);

}  // namespace lacquer::cli
