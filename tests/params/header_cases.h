// Headers of the cpp target, compiled by the system's compiler and run on numbers.
#pragma once

#include <string>
#include <vector>

#include "packs.h"

namespace lacquer::test {

struct HeaderCase {
  std::string id;    ///< of the shader: the header's file name
  std::string text;  ///< of the header
  size_t block = 0;  ///< bytes that pack() writes
  std::vector<Numbers> rows;
};

struct Member {
  std::string name;
  size_t width;
  bool boolean;
};

/// The members of `struct Parameters`.
std::vector<Member> membersOf(const std::string& header);

/// Compiles all headers into one program as strict C++11 and runs it. For each case and each row the bytes of
/// the block, in hexadecimal. Numbers of parameters that a header does not have are left out. Empty, and the
/// test failed, when something goes wrong.
std::vector<std::vector<std::string>> packedByCompiler(const std::vector<HeaderCase>& cases);

}  // namespace lacquer::test
