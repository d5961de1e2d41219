#include "cli/eval.h"

#include <fmt/format.h>

#include "cli/build.h"
#include "cli/checks.h"
#include "cli/streams.h"
#include "cli/table.h"

namespace lacquer::cli {

CLI::App* addEval(CLI::App& app, EvalFlags& flags) {
  CLI::App* verb = app.add_subcommand(
      "eval", "the linear colours of a material at points, computed on the CPU or by a GPU");
  verb->add_option("file", flags.file, "a .gltf or .glb file")->required()->check(kNotEmpty);
  verb->add_option("--material", flags.material, "the material's name; not needed for a file with one");
  verb->add_option("--points", flags.points,
                   "a JSON file with points (docs/eval.md); - for the standard input")
      ->required()
      ->check(kNotEmpty);
  verb->add_option("--engine", flags.engine,
                   "double or float: on the CPU; vulkan: the shader on a Vulkan device")
      ->check(CLI::IsMember({"float", "double", "vulkan"}))
      ->capture_default_str();
  verb->add_option("--template", flags.options.template_name,
                   "a template that puts out a colour; without it the default")
      ->check(kNotEmpty);
  verb->add_option("--profile", flags.options.profile,
                   "the reading of the specification, one of `lacquer nodes`; without it the default")
      ->check(kNotEmpty);
  verb->add_option(
          "--spirv-from", flags.spirv_from,
          "what --engine vulkan runs: direct, or through glslang: its GLSL (glslang), its HLSL (hlsl)")
      ->check(CLI::IsMember({"direct", "glslang", "hlsl"}))
      ->capture_default_str();
  verb->add_option("--params", flags.params, "uniform, baked or spec, as for gen; the colours are the same")
      ->check(CLI::IsMember({"uniform", "baked", "spec"}))
      ->capture_default_str();
  verb->add_option("--texel", flags.texels,
                   "SLOT=r,g,b,a: a constant, linear, instead of an image (may be repeated)")
      ->allow_extra_args(false);
  verb->add_option("--live", flags.options.live, "terms to keep though today's value would remove them")
      ->delimiter(',');
  verb->add_flag("--no-multiple-scattering", flags.no_multiple_scattering,
                 "do not compensate image-based light for multiple scattering");
  verb->add_option("--dfg", flags.dfg,
                   "the split sum's factors: from the texture environment_dfg, or a fit without one")
      ->check(CLI::IsMember({"table", "fit"}))
      ->capture_default_str();
  verb->add_flag("--permissive", flags.options.permissive,
                 "drop an extension that must not be there instead of failing");
  verb->add_option("--nodes", flags.options.node_directories, "a folder with more node files")
      ->check(kNotEmpty);
  addLimit(*verb, flags.options);
  verb->add_option("--allow", flags.options.allow,
                   "a folder in which images may lie, beside the file's own (may be repeated)")
      ->check(kNotEmpty)
      ->allow_extra_args(false);
  return verb;
}

namespace {

Engine engineOf(const EvalFlags& flags) {
  if (flags.engine == "double") return Engine::Double;
  if (flags.engine == "float") return Engine::Float;
  if (flags.spirv_from == "glslang") return Engine::VulkanGlsl;
  return flags.spirv_from == "hlsl" ? Engine::VulkanHlsl : Engine::Vulkan;
}

}  // namespace

int runEval(EvalFlags& flags) {
  flags.options.parameters = flags.params == "baked"  ? Parameters::Baked
                             : flags.params == "spec" ? Parameters::Spec
                                                      : Parameters::Uniform;
  flags.options.multiple_scattering = !flags.no_multiple_scattering;
  flags.options.dfg_table = flags.dfg == "table";
  Messages messages;
  const std::string answer = evaluate(flags.file, flags.material, {}, flags.points, engineOf(flags),
                                      flags.texels, flags.options, messages);
  print(messages, true);
  fmt::print("{}", answer);
  return answer.empty() || hasError(messages) ? 1 : 0;
}

}  // namespace lacquer::cli
