// The files that are made of a picture, in memory.
#include <fmt/format.h>

#include <bit>

#include "environment/maps.h"
#include "environment/read.h"
#include "eval/dfg.h"
#include "eval/sheen.h"
#include "json/json.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/jobs.h"
#include "texture/table.h"

namespace lacquer {

namespace {

constexpr uint32_t kLeastFace = 32, kMostFace = 1024;
constexpr uint32_t kLeastDraws = 64, kMostDraws = 65536;
constexpr uint32_t kDfgSize = 128, kSheenSize = 64, kDraftTableSize = 32;
constexpr const char* kSlots[] = {"environment_specular", "environment_charlie", "environment_irradiance",
                                  "environment_dfg", "environment_sheen"};

std::string fileName(const Environment& of, std::string_view slot) {
  return fmt::format("{}.{}", slot, of.dds ? "dds" : "ktx2");
}

/// The files' bytes; `textures` is given what is in them.
Strings bytesOf(const Environment& of, const environment::Maps& maps,
                std::vector<EnvironmentTexture>& textures) {
  const texture::Container container = of.dds ? texture::Container::Dds : texture::Container::Ktx2;
  const auto texels = of.shared_exponents ? texture::CubeTexels::Rgb9e5 : texture::CubeTexels::Half;
  Strings files;
  const auto add = [&](const char* type, const char* format, uint32_t size, size_t levels,
                       std::string bytes) {
    const char* slot = kSlots[files.size()];
    textures.push_back({slot, fileName(of, slot), type, format, size, static_cast<uint32_t>(levels)});
    files.push_back(std::move(bytes));
  };
  const auto cube = [&](const std::vector<texture::CubeLevel>& levels) {
    add("samplerCube", of.shared_exponents ? "E5B9G9R9_UFLOAT_PACK32" : "R16G16B16A16_SFLOAT", levels[0].size,
        levels.size(), texture::cubeFile(container, texels, levels));
  };
  cube(maps.specular);
  cube(maps.charlie);
  cube({maps.irradiance});
  const auto table = [&](uint32_t size, const std::vector<float>& values) {
    add("sampler2D", of.dds ? "R16G16_UNORM" : "R16G16_SFLOAT", size, 1,
        texture::tableFile(container, size, values));
  };
  const uint32_t dfg = of.draft ? kDraftTableSize : kDfgSize, sheen = of.draft ? kDraftTableSize : kSheenSize;
  table(dfg, eval::environmentDfgTable(dfg));
  table(sheen, eval::environmentSheenTable(sheen));
  return files;
}

}  // namespace

Result<void> checkEnvironment(const Environment& of) {
  if (Result<void> good = inRange("the size of a face", of.size, kLeastFace, kMostFace, "texels"); !good)
    return good;
  if (!std::has_single_bit(of.size)) {
    return fail("out-of-range", {}, fmt::format("the size of a face is {} texels", of.size),
                "it is a power of two from 32 to 1024");
  }
  if (of.scene < -1)
    return fail("out-of-range", {}, fmt::format("the scene is {}", of.scene), "scenes count from 0");
  return inRange("the number of samples", of.samples, kLeastDraws, kMostDraws, {});
}

Strings environmentFiles(const Environment& of) {
  Strings names;
  for (const char* slot : kSlots) names.push_back(fileName(of, slot));
  names.emplace_back("environment.json");
  return names;
}

EnvironmentFiles filesOf(const Environment& of, const environment::Surroundings& surroundings,
                         const Progress& progress) {
  environment::MapOptions how{of.size, of.samples};
  if (of.draft) how = environment::draftOf(how);
  const environment::Maps maps = environment::mapsOf(surroundings, how, progress);
  EnvironmentFiles made{{of.output, {}, maps.lastLevel(), maps.harmonics, surroundings.box}, {}, {}};
  made.files = bytesOf(of, maps, made.maps.textures);
  made.description = environmentJson(made.maps);
  return made;
}

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
  if (maps.box) json["box"] = {{"min", maps.box->min}, {"max", maps.box->max}};
  return json::dump(json, 2) + "\n";
}

std::optional<EnvironmentFiles> filterEnvironment(const Environment& environment, const std::string& picture,
                                                  const std::string& name, const Options& options,
                                                  Messages& messages, const Progress& progress) {
  const auto made = [&]() -> Result<EnvironmentFiles> {
    if (Result<void> good = checkEnvironment(environment); !good) return tl::make_unexpected(good.error());
    const Result<Limits> limits = limitsOf(options);
    if (!limits) return tl::make_unexpected(limits.error());
    Diagnostics warnings;
    const Result<environment::Surroundings> surroundings = environment::readSurroundings(
        picture, name, true, {*limits, options.allow, environment.scene}, warnings);
    report(warnings, name, messages);
    if (!surroundings) return tl::make_unexpected(surroundings.error());
    return filesOf(environment, *surroundings, progress);
  };
  Result<EnvironmentFiles> files;
  withJobs(options.jobs, [&] { files = made(); });
  return valueOf(std::move(files), name, messages);
}

}  // namespace lacquer
