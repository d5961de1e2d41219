// What CLI11 takes and no option means: wrong usage, told before anything is done.
#pragma once

#include <CLI/CLI.hpp>

namespace lacquer::cli {

/// An empty text is a script's unset variable. As a folder it would lead to the root of the file system, as a
/// name it would silently mean the default.
extern const CLI::Validator kNotEmpty;
/// Digits of a number below 2^64: CLI11 takes a sign, more digits than there is room for, and octal numbers.
extern const CLI::Validator kWhole;
extern const CLI::Validator kNumber;
/// In place of CLI::Range, which takes what is no number for one in every range.
CLI::Validator numberFrom(double low, double high);
/// A limit as the library takes it.
extern const CLI::Validator kLimit;

}  // namespace lacquer::cli
