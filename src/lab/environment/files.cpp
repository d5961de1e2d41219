#include <fmt/format.h>

#include <bit>

#include "environment/maps.h"
#include "environment/read.h"
#include "eval/dfg.h"
#include "eval/sheen.h"
#include "json/json.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/file.h"
#include "support/jobs.h"
#include "support/outputs.h"
#include "texture/table.h"

namespace lacquer {

namespace {

constexpr uint32_t kLeastFace = 32, kMostFace = 1024;
constexpr uint32_t kLeastDraws = 64, kMostDraws = 65536;
constexpr uint32_t kDfgSize = 128, kSheenSize = 64;

class EnvironmentWriter {
public:
  EnvironmentWriter(const Environment& environment, const Options& options, Messages& messages)
      : of_(environment), options_(options), messages_(messages) {}

  Result<EnvironmentMaps> write(const std::string& picture, const Progress& progress) {
    if (Result<void> good = checkNumbers(); !good) return tl::make_unexpected(good.error());
    const Strings outputs = paths();
    if (Diagnostics wrong = clashes({picture}, outputs); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    const Result<environment::Panorama> panorama = panoramaOf(picture, options_, messages_);
    if (!panorama) return tl::make_unexpected(panorama.error());
    // Before what takes a while.
    if (const Result<bool> usable = makeFolder(of_.output); !usable)
      return tl::make_unexpected(usable.error());
    const environment::MapOptions how{of_.size, of_.samples};
    const environment::LightTree tree(*panorama, environment::treeSizeOf(*panorama, how));
    const environment::Maps maps = environment::makeMaps(tree, how, progress);
    EnvironmentMaps made{of_.output, {}, maps.lastLevel(), maps.harmonics};
    Strings files = filesOf(maps, made.textures);
    files.push_back(environmentJson(made));
    for (size_t i = 0; i < files.size(); ++i) {
      if (Result<bool> done = writeFile(outputs[i], files[i], {nullptr, options_.sync}); !done)
        return tl::make_unexpected(std::move(done.error()));
    }
    return made;
  }

private:
  static constexpr const char* kSlots[] = {"environment_specular", "environment_charlie",
                                           "environment_irradiance", "environment_dfg", "environment_sheen"};

  Result<void> checkNumbers() const {
    if (Result<void> path = hasPath("the folder", of_.output); !path) return path;
    if (Result<void> good = inRange("the size of a face", of_.size, kLeastFace, kMostFace, "texels"); !good)
      return good;
    if (!std::has_single_bit(of_.size)) {
      return fail("out-of-range", {}, fmt::format("the size of a face is {} texels", of_.size),
                  "it is a power of two from 32 to 1024");
    }
    return inRange("the number of samples", of_.samples, kLeastDraws, kMostDraws, {});
  }

  std::string fileName(std::string_view slot) const {
    return fmt::format("{}.{}", slot, of_.dds ? "dds" : "ktx2");
  }

  /// Of all files, the description last.
  Strings paths() const {
    Strings paths;
    for (const char* slot : kSlots) paths.push_back(fmt::format("{}/{}", of_.output, fileName(slot)));
    paths.push_back(of_.output + "/environment.json");
    return paths;
  }

  /// The files' bytes; `textures` is given what is in them.
  Strings filesOf(const environment::Maps& maps, std::vector<EnvironmentTexture>& textures) const {
    const texture::Container container = of_.dds ? texture::Container::Dds : texture::Container::Ktx2;
    const auto texels = of_.shared_exponents ? texture::CubeTexels::Rgb9e5 : texture::CubeTexels::Half;
    Strings files;
    const auto add = [&](const char* type, const char* format, uint32_t size, size_t levels,
                         std::string bytes) {
      const char* slot = kSlots[files.size()];
      textures.push_back({slot, fileName(slot), type, format, size, static_cast<uint32_t>(levels)});
      files.push_back(std::move(bytes));
    };
    const auto cube = [&](const std::vector<texture::CubeLevel>& levels) {
      add("samplerCube", of_.shared_exponents ? "E5B9G9R9_UFLOAT_PACK32" : "R16G16B16A16_SFLOAT",
          levels[0].size, levels.size(), texture::cubeFile(container, texels, levels));
    };
    cube(maps.specular);
    cube(maps.charlie);
    cube({maps.irradiance});
    const auto table = [&](uint32_t size, const std::vector<float>& values) {
      add("sampler2D", of_.dds ? "R16G16_UNORM" : "R16G16_SFLOAT", size, 1,
          texture::tableFile(container, size, values));
    };
    table(kDfgSize, eval::environmentDfgTable(kDfgSize));
    table(kSheenSize, eval::environmentSheenTable(kSheenSize));
    return files;
  }

  const Environment& of_;
  const Options& options_;
  Messages& messages_;
};

}  // namespace

std::string environmentJson(const EnvironmentMaps& maps) {
  json::Json json = {{"generator", fmt::format("Lacquer {}", version())},
                     {"environment_max_lod", maps.max_lod}};
  json::Json& textures = json["textures"] = json::Json::object();
  for (const EnvironmentTexture& texture : maps.textures) {
    textures[texture.slot] = {{"file", texture.file},
                              {"type", texture.type},
                              {"format", texture.format},
                              {"size", texture.size},
                              {"levels", texture.levels}};
  }
  json["irradiance_harmonics"] = maps.irradiance_harmonics;
  return json.dump(2) + "\n";
}

Result<environment::Panorama> panoramaOf(const std::string& path, const Options& options,
                                         Messages& messages) {
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return tl::make_unexpected(limits.error());
  const Result<std::string> bytes = readFile(path, limits->file);
  if (!bytes) return tl::make_unexpected(bytes.error());
  Diagnostics warnings;
  Result<environment::Panorama> panorama =
      environment::readPanorama(*bytes, limits->image, {path, 0, 0, {}}, warnings);
  report(warnings, path, messages);
  return panorama;
}

std::optional<EnvironmentMaps> writeEnvironment(const Environment& environment, const std::string& picture,
                                                const Options& options, Messages& messages,
                                                const Progress& progress) {
  Result<EnvironmentMaps> made;
  withJobs(options.jobs,
           [&] { made = EnvironmentWriter(environment, options, messages).write(picture, progress); });
  return valueOf(std::move(made), {}, messages);
}

}  // namespace lacquer
