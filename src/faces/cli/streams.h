// The program's standard streams, whatever state they were handed over in.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "lacquer.h"

namespace lacquer::cli {

/// To be called before anything is opened: a stream that is closed must not become the number of a file that
/// is written, and a file that grows too large is an error and no signal.
void prepareStreams();

/// Writes to stderr. That it cannot be written is nobody's concern: there is nowhere to say so.
void put(std::string_view text);

template <class... Arguments>
void say(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  put(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// Errors and warnings, and notes when they are wanted. Their texts have lines of their own and no other.
void print(const Messages& messages, bool notes = false);

}  // namespace lacquer::cli
