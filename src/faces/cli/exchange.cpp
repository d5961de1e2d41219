#include "cli/exchange.h"

#include <fmt/format.h>

#include "cli/build.h"
#include "cli/checks.h"
#include "cli/streams.h"
#include "cli/table.h"
#include "support/text.h"

namespace lacquer::cli {

namespace {

void addReading(CLI::App& verb, OptionFlags& options) {
  verb.add_flag("--permissive", options.options.permissive,
                "drop an extension that must not be there instead of failing");
  addNodeFolders(verb, options);
  addLimit(verb, options);
  addSyncFlag(verb, options);
}

/// Of a call that has failed: a graph is no input of these verbs.
int statusFor(const std::string& file) { return isGraphFile(file) ? 2 : 1; }

}  // namespace

void addConvert(CLI::App& verb, ExchangeFlags& flags, OptionFlags& options) {
  verb.add_option("file", flags.file, "a .gltf, .glb or .mtlx file")->required()->check(kNotEmpty);
  verb.add_option("-o,--output", flags.output, "the .mtlx file to write")->required()->check(kNotEmpty);
  verb.add_option("--as", flags.surface,
                  "gltf_pbr or open_pbr_surface; without it the one that says more of a material")
      ->check(CLI::IsMember({"gltf_pbr", "open_pbr_surface"}));
  verb.add_option("--picture", flags.conversion.picture,
                  "a PNG file: lit balls of each material before and after, and their difference")
      ->check(kNotEmpty);
  verb.add_option("--size", flags.conversion.size, "pixels of a ball")
      ->check(CLI::Range(16, 2048))
      ->check(kWhole)
      ->capture_default_str();
  verb.add_flag("-q,--quiet", flags.quiet, "no numbers of how different the materials look");
  addJobs(verb, options);
  addAllow(verb, options, "images");
  addReading(verb, options);
}

int runConvert(ExchangeFlags& flags, const OptionFlags& options) {
  Messages messages;
  flags.conversion.output = flags.output;
  flags.conversion.surface = flags.surface;
  flags.conversion.measured = !flags.quiet;
  const std::optional<Converted> converted =
      convert(flags.conversion, flags.file, {}, options.options, messages);
  print(messages);
  if (converted && !flags.quiet) {
    if (!converted->differences.empty()) fmt::print("{:>12} {:>12} {:>12}  material\n", "max", "mean", "rms");
    for (const PreviewDifference& of : converted->differences) {
      fmt::print("{:>12.3e} {:>12.3e} {:>12.3e}  {}\n", of.largest, of.mean, of.root_mean_square,
                 printable(of.material));
    }
  }
  return converted && !hasError(messages) ? 0 : statusFor(flags.file);
}

void addBake(CLI::App& verb, ExchangeFlags& flags, OptionFlags& options) {
  verb.add_option("file", flags.file, "a .gltf or .mtlx file, or a graph: .json")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("-o,--output", flags.bake.output,
                  "the .gltf file to write, images beside it; or the image alone: .png, .ktx2 or .exr")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("--material", flags.materials, "only materials of this name (may be repeated)")
      ->allow_extra_args(false);
  verb.add_option("--node", flags.bake.nodes,
                  "the output of a node, as for eval, instead of procedural textures; * for all of all nodes "
                  "(may be repeated)")
      ->allow_extra_args(false)
      ->check(kNotEmpty);
  verb.add_option("--size", flags.bake.size, "texels along each side of an image")
      ->check(CLI::Range(1, 8192))
      ->check(kWhole)
      ->capture_default_str();
  verb.add_option("--samples", flags.bake.samples,
                  "places along each side of a texel that it is the mean of: 2, 4, 6, 8 or 16")
      ->check(CLI::IsMember({2, 4, 6, 8, 16}))
      ->capture_default_str();
  verb.add_flag("--mips", flags.bake.levels,
                "with mip levels: in .ktx2 and .exr, of PNG beside it as NAME_1.png and on");
  verb.add_option("--also", flags.also,
                  "beside a .gltf file: ktx2 or exr of each image, too (may be repeated)")
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"ktx2", "exr"}));
  verb.add_option("--bits", flags.bake.bits, "of a number: 8 or 16 in KTX2, 16 or 32 in OpenEXR; the lesser")
      ->check(CLI::IsMember({8, 16, 32}));
  verb.add_flag("--srgb", flags.bake.srgb, "encode what nodes give in an image of 8 bits");
  verb.add_flag("-q,--quiet", flags.quiet, "no table, no progress");
  addJobs(verb, options);
  addAllow(verb, options, "images");
  addReading(verb, options);
}

int runBake(ExchangeFlags& flags, const OptionFlags& options) {
  for (const std::string& form : flags.also)
    flags.bake.also.push_back(form == "exr" ? Texels::Exr : Texels::Ktx2);
  Messages messages;
  std::optional<Baked> baked;
  {
    ProgressLine line(terminalWidth() > 0 && !flags.quiet, "rows");
    baked = bake(flags.bake, flags.file, flags.materials, options.options, messages,
                 [&](size_t done, size_t known) { line(done, known); });
  }
  print(messages);
  if (baked && !flags.quiet) {
    for (const std::string& image : baked->images) fmt::print("{}\n", printable(image));
    if (!baked->output.empty())
      fmt::print("{} in {}\n", countOf(baked->textures, "texture"), printable(baked->output));
  }
  return baked && !hasError(messages) ? 0 : 1;
}

int printDocument(const OptionFlags& flags, const std::string& format, uint32_t size, const std::string& file,
                  const Strings& materials) {
  Messages messages;
  const bool gltf = format == "gltf";
  const std::string text = gltf ? toGltf(file, materials, size, flags.options, messages)
                                : toMaterialX(file, materials, {}, flags.options, messages);
  fmt::print("{}", text);
  print(messages);
  if (!text.empty() && !hasError(messages)) return 0;
  return gltf ? 1 : statusFor(file);
}

}  // namespace lacquer::cli
