// What the tools make of a material or a graph that is in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "eval/subject.h"
#include "lacquer/tools.h"
#include "setting/language.h"

namespace lacquer {

/// A material that was read by the language's declarations, or a graph.
struct InMemory {
  EvalSubject subject;
  const Language& language;
  const std::string& file;                   ///< its path, or what stands for it
  std::shared_ptr<const std::string> bytes;  ///< the file's, where it was read from memory
  bool has_file = true;                      ///< whether there is a glTF file, with images
};

/// evaluate() of it.
std::optional<Evaluation> evaluateOf(const InMemory& of, const std::string& points, Engine engine,
                                     const Strings& texels, const Options& options, Messages& messages);
/// drawBall() of it.
std::vector<uint8_t> drawBallOf(const InMemory& of, uint32_t size, const Strings& texels,
                                const Options& options, Messages& messages);

}  // namespace lacquer
