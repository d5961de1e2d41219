// Compilers that are run as programs, because they are second opinions and no dependencies.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "support/diagnostic.h"

namespace lacquer::check {

/// The program that a shell would run; empty entries of the PATH, which mean the current folder, are passed
/// over. Nothing where there is none, and on other than POSIX systems.
std::optional<std::filesystem::path> findProgram(const char* name);

/// What tells a program from another one without running it: the file that it leads to, its size and when it
/// was modified. A package's links stay the same when what they lead to is replaced.
std::string identityOf(const std::filesystem::path& program);

/// Shows the line of `text` in which the diagnostic's place lies, where it has one.
void locateInText(Diagnostic& diagnostic, std::string_view text);

}  // namespace lacquer::check
