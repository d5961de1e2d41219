#include "support/outputs.h"

#include <filesystem>
#include <set>
#include <utility>

#include "support/file.h"

namespace lacquer {

namespace {

/// Where a file lies, or will.
std::string placeOf(const std::string& path) {
  std::error_code error;
  const std::filesystem::path place = std::filesystem::weakly_canonical(path, error);
  return error ? path : place.string();
}

}  // namespace

Diagnostics clashes(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  std::set<std::pair<uint64_t, uint64_t>> read;
  for (const std::string& input : inputs) {
    if (const auto stamp = stampOf(input)) read.emplace(stamp->device, stamp->inode);
  }
  Diagnostics wrong;
  std::set<std::string> places;
  for (const std::string& output : outputs) {
    const auto stamp = stampOf(output);
    const char* what = stamp && read.contains({stamp->device, stamp->inode}) ? "an input"
                       : !places.insert(placeOf(output)).second              ? "written twice"
                                                                             : nullptr;
    if (what == nullptr) continue;
    Diagnostic clash;
    clash.code = "output-clash";
    clash.severity = Severity::Error;
    clash.place.file = output;
    clash.message = std::string("this file is to be written and is ") + what;
    clash.help = "nothing was written: name another file or folder";
    wrong.push_back(std::move(clash));
  }
  return wrong;
}

}  // namespace lacquer
