#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "gltf/lights_ies.h"
#include "gltf/texture_source.h"
#include "lacquer/tools.h"
#include "photometry/distribution.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/file.h"
#include "support/letters.h"
#include "support/outputs.h"
#include "support/text.h"
#include "texture/table.h"

namespace lacquer {

namespace {

using photometry::Distribution;

/// A light's `profile` names no more.
constexpr size_t kMostLayers = 2048;
constexpr uint32_t kLeastWidth = 2, kMostSide = 2048, kUsualHeight = 128;

constexpr std::string_view kIes = "EXT_lights_ies";

std::string_view nameOf(photometry::Web web) {
  return web == photometry::Web::C ? "C" : web == photometry::Web::B ? "B" : "A";
}

std::string_view nameOf(photometry::Symmetry symmetry) {
  switch (symmetry) {
    case photometry::Symmetry::Round: return "round";
    case photometry::Symmetry::Quadrants: return "quadrants";
    case photometry::Symmetry::Halves: return "halves";
    case photometry::Symmetry::None: break;
  }
  return "none";
}

bool isGltf(std::string_view path) {
  const std::string lower = lowered(path);
  return lower.ends_with(".gltf") || lower.ends_with(".glb");
}

/// What is wrong with the numbers of a call.
Result<void> checkSizes(const ProfileTables& tables) {
  if (Result<void> good = inRange("the table's width", tables.width, kLeastWidth, kMostSide, "texels"); !good)
    return good;
  return inRange("the table's height", tables.height, 0, kMostSide, "texels");
}

/// A profile that is read, and what is said of it.
struct Profile {
  LightProfile said;
  Distribution distribution;

  bool round() const { return distribution.symmetry() == photometry::Symmetry::Round; }

  void makeTable(uint32_t width, uint32_t height) {
    photometry::Table table = photometry::tableOf(distribution, width, height);
    const photometry::Errors errors = photometry::errorsOf(table, distribution);
    said.error = errors.most;
    said.mean_error = errors.mean;
    said.width = width;
    said.height = height;
    said.texels = std::move(table.texels);
  }
};

Result<Profile> readProfile(std::string_view bytes, const std::string& file, int light, const Place& place,
                            Diagnostics& warnings) {
  const Result<photometry::Measured> measured = photometry::readLm63(bytes, place, warnings);
  if (!measured) return tl::make_unexpected(measured.error());
  Profile made{{}, Distribution(*measured)};
  made.said.file = file;
  made.said.light = light;
  made.said.standard = measured->standard;
  made.said.photometry = nameOf(measured->web);
  made.said.symmetry = nameOf(made.distribution.symmetry());
  made.said.vertical = static_cast<uint32_t>(measured->vertical.size());
  made.said.horizontal = static_cast<uint32_t>(measured->horizontal.size());
  made.said.peak = made.distribution.peak();
  made.said.lumens = made.distribution.lumens();
  return made;
}

uint32_t heightOf(const ProfileTables& tables, const std::vector<Profile>& profiles) {
  if (tables.height != 0) return tables.height;
  return std::all_of(profiles.begin(), profiles.end(), [](const Profile& p) { return p.round(); })
             ? 1
             : kUsualHeight;
}

class ProfileReader {
public:
  ProfileReader(const ProfileTables& tables, const Options& options, Messages& messages)
      : of_(tables), options_(options), messages_(messages) {}

  Result<LightProfiles> make(const Strings& files) {
    if (Result<void> good = check(files); !good) return tl::make_unexpected(good.error());
    for (const std::string& file : files) {
      if (Result<void> read = isGltf(file) ? readGltf(file) : readIes(file); !read)
        return tl::make_unexpected(read.error());
    }
    LightProfiles made;
    const uint32_t height = heightOf(of_, profiles_);
    for (Profile& profile : profiles_) {
      profile.makeTable(of_.width, height);
      made.layers.push_back(std::move(profile.said));
    }
    if (Result<void> written = write(made); !written) return tl::make_unexpected(written.error());
    return made;
  }

private:
  Result<void> check(const Strings& files) {
    if (Result<void> good = checkSizes(of_); !good) return good;
    const Result<Limits> limits = limitsOf(options_);
    if (!limits) return tl::make_unexpected(limits.error());
    limits_ = *limits;
    if (files.empty())
      return fail("no-profile", {}, "there is no file to read", "name an IES or a glTF file");
    if (of_.output.empty()) return {};
    container_ = texture::containerOf(of_.output);
    if (!container_) {
      return fail("table-format", {of_.output, 0, 0, {}}, "the file's name does not say what to write",
                  "it ends in .ktx2, .dds or, for one profile, .png");
    }
    if (Diagnostics wrong = clashes(files, {of_.output}); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    return {};
  }

  Result<void> readIes(const std::string& file) {
    const Result<std::string> bytes = readFile(file, limits_.file);
    if (!bytes) return tl::make_unexpected(bytes.error());
    return add(*bytes, file, -1, {file, 0, 0, {}});
  }

  Result<void> readGltf(const std::string& file) {
    const Result<gltf::TextureFile> opened = gltf::TextureFile::open(file, {limits_, options_.allow});
    if (!opened) return tl::make_unexpected(opened.error());
    const json::Json* extensions = json::member(opened->root(), "extensions");
    const json::Json* ies = extensions == nullptr ? nullptr : json::member(*extensions, kIes);
    if (ies == nullptr) {
      return fail("no-profile", {file, 0, 0, {}}, fmt::format("the file has no lights of {}", kIes),
                  "they stand in the extensions of the file's root");
    }
    if (Diagnostics wrong = gltf::checkIes(opened->root(), file); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    const json::Json* lights = json::member(*ies, "lights");
    for (size_t i = 0; i < lights->size(); ++i) {
      Place place{file, 0, 0, fmt::format("/extensions/{}/lights/{}", kIes, i)};
      const size_t files_read = opened->filesRead().size();
      Result<std::string> bytes = opened->bytesOf((*lights)[i], place);
      if (!bytes) return tl::make_unexpected(missing(std::move(bytes.error())));
      // In a file of its own lines have numbers.
      if (opened->filesRead().size() > files_read && json::member((*lights)[i], "uri") != nullptr) {
        place = {opened->filesRead().back(), 0, 0, {}};
        if (Diagnostics wrong = clashes({place.file}, outputs()); !wrong.empty())
          return tl::make_unexpected(std::move(wrong));
      }
      if (Result<void> added = add(*bytes, file, static_cast<int>(i), place); !added) return added;
    }
    return {};
  }

  Strings outputs() const { return of_.output.empty() ? Strings() : Strings{of_.output}; }

  /// What is said of images that are not there is meant of a profile.
  static Diagnostics missing(Diagnostics all) {
    for (Diagnostic& one : all) {
      const bool outside = one.code == "image-outside";
      one.code = outside ? "profile-outside" : "profile-missing";
      one.help = outside ? "--allow DIR lets profiles lie in another folder, too"
                         : "a profile is a file beside the glTF file, a data URI in base64 or a bufferView";
    }
    return all;
  }

  Result<void> add(std::string_view bytes, const std::string& file, int light, const Place& place) {
    if (profiles_.size() == kMostLayers) {
      return fail("profile-too-large", place, fmt::format("there are more than {} profiles", kMostLayers),
                  "a light's `profile` names no layer beyond them");
    }
    // Views may overlap: each is read once more.
    if (bytes.size() > limits_.file - held_) {
      return fail("profile-too-large", place,
                  fmt::format("the profiles have more than {} bytes together", limits_.file),
                  raising("file"));
    }
    held_ += bytes.size();
    Diagnostics warnings;
    Result<Profile> profile = readProfile(bytes, file, light, place, warnings);
    report(warnings, file, messages_);
    if (!profile) return tl::make_unexpected(profile.error());
    profiles_.push_back(std::move(*profile));
    return {};
  }

  Result<void> write(LightProfiles& made) const {
    if (!container_) return {};
    if (*container_ == texture::Container::Png && made.layers.size() > 1) {
      return fail("table-format", {of_.output, 0, 0, {}},
                  fmt::format("there are {} profiles, and a PNG has no layers", made.layers.size()),
                  "write .ktx2 or .dds");
    }
    std::vector<float> values;
    for (const LightProfile& layer : made.layers)
      values.insert(values.end(), layer.texels.begin(), layer.texels.end());
    const texture::Layers layers{made.layers[0].width, made.layers[0].height,
                                 static_cast<uint32_t>(made.layers.size())};
    const Result<bool> written =
        writeFile(of_.output, texture::layersFile(*container_, layers, values), {nullptr, options_.sync});
    if (!written) return tl::make_unexpected(written.error());
    made.output = of_.output;
    made.format = *container_ == texture::Container::Ktx2  ? "R16_SFLOAT"
                  : *container_ == texture::Container::Dds ? "R16_UNORM"
                                                           : "R16G16B16_UNORM";
    return {};
  }

  const ProfileTables& of_;
  const Options& options_;
  Messages& messages_;
  Limits limits_;
  std::optional<texture::Container> container_;
  std::vector<Profile> profiles_;
  uint64_t held_ = 0;  ///< bytes of all that were read
};

}  // namespace

std::optional<LightProfiles> lightProfiles(const ProfileTables& tables, const Strings& files,
                                           const Options& options, Messages& messages) {
  return valueOf(ProfileReader(tables, options, messages).make(files), {}, messages);
}

std::optional<LightProfile> lightProfile(std::string_view bytes, const std::string& name,
                                         const ProfileTables& tables, Messages& messages) {
  if (const Result<void> good = checkSizes(tables); !good)
    return valueOf(Result<LightProfile>(tl::make_unexpected(good.error())), {}, messages);
  Diagnostics warnings;
  Result<Profile> read = readProfile(bytes, name, -1, {name, 0, 0, {}}, warnings);
  report(warnings, name, messages);
  if (!read) return valueOf(Result<LightProfile>(tl::make_unexpected(read.error())), name, messages);
  read->makeTable(tables.width, heightOf(tables, {*read}));
  return std::move(read->said);
}

}  // namespace lacquer
