// What verbs do whose answer is a value: progress while they work, then messages, a table or JSON.
#pragma once

#include <fmt/format.h>

#include "answer/answer.h"
#include "cli/build.h"
#include "cli/streams.h"
#include "cli/table.h"

namespace lacquer::cli {

struct Answering {
  bool json = false, quiet = false;
  const char* pieces = nullptr;  ///< of the progress: "materials"; none is shown without
  bool notes = false;            ///< messages of the lowest level are printed, too
  size_t step = 1;               ///< pieces from one line of progress to the next
};

/// `find` is given where messages and progress go. The exit status: 1 where nothing was found, or with an
/// error.
template <class Show, class Find>
int answerTo(const Answering& how, const Show& show, const Find& find) {
  Messages messages;
  decltype(find(messages, Progress())) found;
  {
    ProgressLine line(terminalWidth() > 0 && !how.quiet && how.pieces != nullptr, how.pieces);
    found = find(messages, [&](size_t done, size_t known) {
      if (done % how.step == 0 || done == known) line(done, known);
    });
  }
  print(messages, how.notes);
  if (found && how.json) fmt::print("{}", answerJson(*found));
  if (found && !how.json && !how.quiet) show(*found);
  return !found || hasError(messages) ? 1 : 0;
}

}  // namespace lacquer::cli
