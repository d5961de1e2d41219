// Documents as a studio's library of definitions, halves of them as the files that it consists of.
#include "feeds.h"
#include "lang/library.h"
#include "materialx/materialx.h"

namespace lacquer::fuzz {

std::string feedDefinitions(std::string_view bytes) {
  static const lang::Library kLibrary = lang::Library::embedded();
  const size_t end = bytes.find("</materialx>");
  const size_t half = end == std::string_view::npos ? bytes.size() : bytes.find('<', end + 1);
  std::vector<lang::SourceFile> files{{"a.mtlx", std::string(bytes.substr(0, half))}};
  if (half < bytes.size()) files.push_back({"b.mtlx", std::string(bytes.substr(half))});
  const auto definitions = materialx::readDefinitions(files, Limits{});
  if (!definitions)
    return lacquer::hasError(definitions.error()) ? "" : "definitions are refused without an error";
  (void)materialx::checkDefinitions(*definitions, kLibrary, Limits{});
  return {};
}

}  // namespace lacquer::fuzz
