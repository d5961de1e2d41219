# Script mode: writes OUTPUT with one hash of TEXT and of the files in LIST, by their names below ROOT (see
# fingerprint.cmake).
file(STRINGS "${LIST}" files)
set(all "${TEXT}\n")
foreach(file IN LISTS files)
  file(SHA256 "${file}" hash)
  file(RELATIVE_PATH name "${ROOT}" "${file}")
  string(APPEND all "${name} ${hash}\n")
endforeach()
string(SHA256 hash "${all}")
file(WRITE "${OUTPUT}" "// Made by cmake/fingerprint_files.cmake.
#include \"cache/fingerprint.h\"

namespace lacquer {

std::string_view fingerprint() { return \"${hash}\"; }

}  // namespace lacquer
")
