// Textures: the images that they and their extensions name, and their samplers.
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "gltf/reading.h"

namespace lacquer::gltf {

namespace {

/// Extensions that give a texture an image of another format, those first that engines should prefer. The
/// texture's own `source` is then what there is for those that do not know them.
constexpr std::string_view kImageExtensions[] = {"KHR_texture_basisu", "EXT_texture_webp"};

constexpr int kWraps[] = {33071, 33648, 10497};
constexpr int kMagFilters[] = {9728, 9729};
constexpr int kMinFilters[] = {9728, 9729, 9984, 9985, 9986, 9987};

/// One of a sampler's numbers. What is none of glTF's is left as it was and, where there is a report, said.
void enumerator(const Json& sampler, std::string_view name, std::span<const int> allowed, const Path& path,
                Report* report, int& out) {
  const Json* value = member(sampler, name);
  if (value == nullptr) return;
  const auto found = std::find_if(allowed.begin(), allowed.end(), [&](int one) { return *value == one; });
  if (found != allowed.end()) {
    out = *found;
  } else if (report != nullptr) {
    report->warning("unknown-value", Path(path, name), fmt::format("{} is none of glTF's numbers", name),
                    fmt::format("it must be one of {}", fmt::join(allowed, ", ")));
  }
}

void readSampler(const Json& sampler, const Path& path, Report* report, Texture& out) {
  enumerator(sampler, "wrapS", kWraps, path, report, out.wrapS);
  enumerator(sampler, "wrapT", kWraps, path, report, out.wrapT);
  enumerator(sampler, "magFilter", kMagFilters, path, report, out.magFilter);
  enumerator(sampler, "minFilter", kMinFilters, path, report, out.minFilter);
}

}  // namespace

void checkSampler(const Json& sampler, const Path& path, Report& report) {
  Texture unused;
  readSampler(sampler, path, &report, unused);
}

Texture readTexture(const Json& root, const Json& texture, const Path& path, Report& report) {
  Texture out;
  const size_t images = arraySize(root, "images");
  if (const Json* source = member(texture, "source"))
    report.index(Path(path, "source"), "source", *source, images, "image", out.source);
  int sampler = -1;
  if (const Json* index = member(texture, "sampler"))
    report.index(Path(path, "sampler"), "sampler", *index, arraySize(root, "samplers"), "sampler", sampler);
  if (sampler >= 0) readSampler(root["samplers"][static_cast<size_t>(sampler)], path, nullptr, out);
  const Path extensions(path, "extensions");
  for (const std::string_view name : kImageExtensions) {
    const Json* extension = extensionOf(texture, name);
    if (extension == nullptr) continue;
    const Path here(extensions, name);
    const Json* source = member(*extension, "source");
    Texture::Source image{name, -1};
    if (source == nullptr) {
      report.warning("missing-property", here, fmt::format("{} has no \"source\"", name),
                     "it must name an image");
    } else if (report.index(Path(here, "source"), "source", *source, images, "image", image.image)) {
      out.sources.push_back(image);
    }
  }
  return out;
}

}  // namespace lacquer::gltf
