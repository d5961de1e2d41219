#include "cli/streams.h"

#include <cstdio>

#include "cli/table.h"

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <unistd.h>
#include <csignal>
#endif

namespace lacquer::cli {

void prepareStreams() {
#if defined(__unix__) || defined(__APPLE__)
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1) continue;
    // Nothing can be read from it or written to it, as before.
    const int flags = stream == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    if (::open("/dev/null", flags) != stream) return;
  }
#endif
}

void put(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); }

void print(const Messages& messages, bool notes) {
  for (const Message& message : messages) {
    if (notes || message.level != Message::Level::Note) say("{}\n", printable(message.text, "\n\t"));
  }
}

}  // namespace lacquer::cli
