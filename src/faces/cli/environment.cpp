#include "cli/environment.h"

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/checks.h"
#include "cli/table.h"

namespace lacquer::cli {

void addEnvironment(CLI::App& verb, EnvironmentFlags& flags, OptionFlags& options) {
  verb.add_option("picture", flags.picture,
                  "equirectangular, Radiance HDR (.hdr) or OpenEXR (.exr), a cube map (.ktx2), or a .gltf or "
                  ".glb file with "
                  "an environment")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("-o,--output", flags.environment.output, "the folder to write to")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("--scene", flags.environment.scene, "of a .gltf or .glb file, from 0; its own if absent")
      ->check(CLI::NonNegativeNumber)
      ->check(kWhole);
  verb.add_option("--size", flags.environment.size, "texels in a row of environment_specular's faces")
      ->check(CLI::IsMember({32, 64, 128, 256, 512, 1024}))
      ->capture_default_str();
  verb.add_option("--samples", flags.environment.samples,
                  "about how many parts of the picture each texel is made of")
      ->check(CLI::Range(64, 65536))
      ->check(kWhole)
      ->capture_default_str();
  verb.add_flag(
      "--draft", flags.environment.draft,
      "for a first look: at most 64 texels and 64 samples, nothing finer than a texel, tables of 32 x 32");
  verb.add_option("--container", flags.container, "ktx2 or dds")
      ->check(CLI::IsMember({"ktx2", "dds"}))
      ->capture_default_str();
  verb.add_option("--texels", flags.texels, "of the cubes: half (floats) or rgb9e5, which has half the bytes")
      ->check(CLI::IsMember({"half", "rgb9e5"}))
      ->capture_default_str();
  addJobs(verb, options);
  addAllow(verb, options, "cube maps of a glTF file");
  verb.add_flag("--json", flags.json, "what was written, as environment.json has it");
  verb.add_flag("-q,--quiet", flags.quiet, "no table, no progress");
  addLimit(verb, options);
}

namespace {

void printWritten(const EnvironmentMaps& maps) {
  for (const EnvironmentTexture& of : maps.textures) {
    fmt::print("{:<24} {:>4} x {:<4} {} level{}, {}\n", of.slot, of.size, of.size, of.levels,
               of.levels == 1 ? "" : "s", of.format);
  }
  fmt::print("environment_max_lod is {}; in {}\n", maps.max_lod, printable(maps.output));
}

}  // namespace

int runEnvironment(EnvironmentFlags& flags, const Options& options) {
  flags.environment.dds = flags.container == "dds";
  flags.environment.shared_exponents = flags.texels == "rgb9e5";
  return answerTo({flags.json, flags.quiet, "rows of texels", false, 64}, printWritten,
                  [&](Messages& messages, const Progress& progress) {
                    return writeEnvironment(flags.environment, flags.picture, options, messages, progress);
                  });
}

}  // namespace lacquer::cli
