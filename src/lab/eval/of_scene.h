// What the tools make of a material that a scene has in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lacquer/tools.h"
#include "setting/language.h"

namespace lacquer {

/// A material that was read by the language's declarations.
struct SceneMaterial {
  const material::Material& material;
  const Language& language;
  const std::string& file;                   ///< its path, or what stands for it
  std::shared_ptr<const std::string> bytes;  ///< the file's, where it was read from memory
};

/// evaluate() of it.
std::string evaluateOf(const SceneMaterial& of, const std::string& points, Engine engine,
                       const Strings& texels, const Options& options, Messages& messages);
/// drawBall() of it.
std::vector<uint8_t> drawBallOf(const SceneMaterial& of, uint32_t size, const Strings& texels,
                                const Options& options, Messages& messages);

}  // namespace lacquer
