#include "cli/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

#include "cli/answer.h"
#include "cli/checks.h"
#include "cli/table.h"
#include "support/text.h"

namespace lacquer::cli {

namespace {

/// False for what is neither "256" nor "256x128", with sides from 1 to 2048.
bool readSize(std::string_view text, ProfileTables& to) {
  constexpr uint32_t kMost = 2048;
  const size_t cross = std::min(text.find('x'), text.size());
  const auto side = [](std::string_view digits, uint32_t& number) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return error == std::errc() && end == digits.data() + digits.size() && number > 0 && number <= kMost;
  };
  if (!side(text.substr(0, cross), to.width) || to.width < 2) return false;
  return cross == text.size() || side(text.substr(cross + 1), to.height);
}

}  // namespace

void addProfile(CLI::App& verb, ProfileFlags& flags, OptionFlags& options) {
  verb.add_option("files", flags.files, "IES files, or .gltf and .glb files with EXT_lights_ies")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("-o,--output", flags.tables.output,
                  "the file to write light_profiles to: .ktx2 (half floats), .dds (16-bit UNORM) or of one "
                  "profile .png (16 bits)")
      ->check(kNotEmpty);
  verb.add_option("--size", flags.size,
                  "texels of a table, such as 256x128; without a height one row where all profiles are alike "
                  "all round, else 128 (256 in a row)")
      ->check([&flags](const std::string& text) {
        return readSize(text, flags.tables) ? ""
                                            : "must be a width from 2 to 2048, or it and a height: 256x128";
      });
  addAllow(verb, options, "IES files that a glTF file names");
  verb.add_flag("--json", flags.json, "what was found, as JSON");
  verb.add_flag("-q,--quiet", flags.quiet, "no table");
  addLimit(verb, options);
  addSyncFlag(verb, options);
}

namespace {

void printProfiles(const LightProfiles& found) {
  for (size_t i = 0; i < found.layers.size(); ++i) {
    const LightProfile& of = found.layers[i];
    fmt::print("{:>4}  {}{}\n", i, cli::printable(of.file),
               of.light < 0 ? "" : fmt::format(", light {}", of.light));
    fmt::print("      {}, type {}, {} vertical and {} horizontal angles, symmetry: {}\n", of.standard,
               of.photometry, of.vertical, of.horizontal, of.symmetry);
    fmt::print("      peak {:.6g} cd, {:.6g} lm\n", of.peak, of.lumens);
    fmt::print("      a table of {} x {}, off by {:.2g} % of the peak in the mean, {:.2g} % at most\n",
               of.width, of.height, 100 * of.mean_error, 100 * of.error);
  }
  if (!found.output.empty()) {
    fmt::print("{}, {}; in {}\n", countOf(found.layers.size(), "layer"), found.format,
               cli::printable(found.output));
  }
}

}  // namespace

int runProfile(const ProfileFlags& flags, const Options& options) {
  return answerTo({flags.json, flags.quiet, nullptr, false}, printProfiles,
                  [&](Messages& messages, const Progress&) {
                    return lightProfiles(flags.tables, flags.files, options, messages);
                  });
}

}  // namespace lacquer::cli
