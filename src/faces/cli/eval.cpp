#include "cli/eval.h"

#include <fmt/format.h>

#include "answer/answer.h"
#include "cli/build.h"
#include "cli/checks.h"
#include "cli/streams.h"
#include "cli/table.h"
#include "cli/trial.h"

namespace lacquer::cli {

void addEval(CLI::App& verb, EvalFlags& flags, OptionFlags& options) {
  verb.add_option("file", flags.file, "a .gltf, .glb or .mtlx file, or a graph: .json")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("--material", flags.material, "the material's name; not needed for a file with one");
  verb.add_option("--points", flags.points,
                  "a JSON file with points (docs/eval.md); - for the standard input")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("--engine", flags.engine,
                  "double or float: on the CPU; vulkan: the shader on a Vulkan device")
      ->check(CLI::IsMember({"float", "double", "vulkan"}))
      ->capture_default_str();
  verb.add_option(
          "--spirv-from", flags.spirv_from,
          "what --engine vulkan runs: direct, or through glslang: its GLSL (glslang), its HLSL (hlsl)")
      ->check(CLI::IsMember({"direct", "glslang", "hlsl"}))
      ->capture_default_str();
  verb.add_option("--texel", flags.texels,
                  "SLOT=r,g,b,a: a constant, linear, instead of an image (may be repeated)")
      ->allow_extra_args(false);
  addParameters(verb, flags.trial.parameters);
  addClock(verb, flags.trial.time, flags.trial.frame);
  verb.add_option(
          "--node", flags.trial.node,
          "the output of a node instead of the colour: coat.f0, or coat.split.half of several; rust/mix in "
          "a group")
      ->check(kNotEmpty);
  addAllow(verb, options, "images");
  addMaterialFlags(verb, options);
}

namespace {

Engine engineOf(const EvalFlags& flags) {
  if (flags.engine == "double") return Engine::Double;
  if (flags.engine == "float") return Engine::Float;
  if (flags.spirv_from == "glslang") return Engine::VulkanGlsl;
  return flags.spirv_from == "hlsl" ? Engine::VulkanHlsl : Engine::Vulkan;
}

}  // namespace

int runEval(const EvalFlags& flags, const Options& options) {
  Messages messages;
  const std::optional<Evaluation> found =
      evaluate(flags.file, flags.material, {}, flags.points, engineOf(flags), flags.texels, options, messages,
               flags.trial);
  print(messages, true);
  if (found) fmt::print("{}", answerJson(*found));
  return !found || hasError(messages) ? 1 : 0;
}

}  // namespace lacquer::cli
