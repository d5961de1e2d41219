#include "check/program.h"

#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#define LACQUER_POSIX 1
#endif

namespace lacquer::check {

namespace fs = std::filesystem;

std::optional<fs::path> findProgram([[maybe_unused]] const char* name) {
#ifdef LACQUER_POSIX
  const char* path = std::getenv("PATH");
  if (path == nullptr) return std::nullopt;
  std::istringstream entries(path);
  for (std::string entry; std::getline(entries, entry, ':');) {
    if (entry.empty()) continue;
    fs::path file = fs::path(entry) / name;
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0) return file;
  }
#endif
  return std::nullopt;
}

std::string identityOf(const fs::path& program) {
  std::error_code ignored;
  const fs::path file = fs::canonical(program, ignored);
  const uintmax_t size = fs::file_size(file, ignored);
  const auto time = fs::last_write_time(file, ignored).time_since_epoch().count();
  return fmt::format("{} {} {}", file.string(), size, time);
}

void locateInText(Diagnostic& diagnostic, std::string_view text) {
  size_t begin = 0;
  for (uint32_t i = 1; i < diagnostic.place.line && begin != std::string_view::npos; ++i) {
    begin = text.find('\n', begin);
    if (begin != std::string_view::npos) ++begin;
  }
  if (diagnostic.place.line == 0 || begin == std::string_view::npos || diagnostic.place.column == 0) return;
  locate(diagnostic, text, begin + diagnostic.place.column - 1);
}

}  // namespace lacquer::check
