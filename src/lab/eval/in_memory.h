// What the tools make of a material or a graph that is in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "eval/material.h"
#include "eval/subject.h"
#include "lacquer/tools.h"
#include "setting/language.h"

namespace lacquer {

/// Where images are: in a glTF file or beside it, beside a graph's, or nowhere but in the texts.
enum class ImagesOf : uint8_t { Gltf, Graph, Nothing };

/// A material that was read by the language's declarations, or a graph.
struct InMemory {
  EvalSubject subject;
  const Language& language;
  const std::string& file;                   ///< its path, or what stands for it
  std::shared_ptr<const std::string> bytes;  ///< the file's, where it was read from memory
  ImagesOf images_of = ImagesOf::Gltf;

  FileImages images(const Options& options) const {
    return images_of == ImagesOf::Gltf ? FileImages(file, options, bytes)
                                       : FileImages::ofGraph(file, options, images_of == ImagesOf::Nothing);
  }
};

/// Points as a text, or as arrays.
using GivenPoints = std::variant<const std::string*, const PointArrays*>;
/// evaluate() of it.
std::optional<Evaluation> evaluateOf(const InMemory& of, const GivenPoints& points, Engine engine,
                                     const Strings& texels, const Options& options, Messages& messages,
                                     const Trial& trial);
/// drawBall() of it.
std::vector<uint8_t> drawBallOf(const InMemory& of, uint32_t size, const Strings& texels,
                                const Options& options, Messages& messages, const Trial& trial,
                                const ValueLook& look);

}  // namespace lacquer
