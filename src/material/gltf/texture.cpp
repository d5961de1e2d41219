// Textures: the images that they and their extensions name, and their samplers.
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "gltf/reading.h"
#include "support/text.h"

namespace lacquer::gltf {

namespace {

/// Extensions that give a texture an image of another format, those first that engines should prefer. The
/// texture's own `source` is then what there is for those that do not know them.
constexpr std::string_view kImageExtensions[] = {"KHR_texture_basisu", "EXT_texture_webp"};

/// Its options give a texture channels of images.
constexpr std::string_view kSwizzle = "NV_texture_swizzle";
constexpr int kMostChannels = 255;  ///< more than any container of textures has

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

/// The channels of an option; nothing where they are wrong. Those that are not listed are unused, and alpha
/// without being missed: three are an RGB texture.
bool readChannels(const Json& list, const Path& path, Report& report, Channels& out) {
  if (!list.is_array()) return report.wrongType(path, "channels", list, "an array of whole numbers"), false;
  if (list.size() < 1 || list.size() > out.size()) {
    report.error("wrong-length", path, fmt::format("channels has {}", countOf(list.size(), "element")),
                 "it must have 1 to 4: of red, green, blue and alpha");
    return false;
  }
  out.fill(kUnused);
  for (size_t i = 0; i < list.size(); ++i) {
    const Path here(path, i);
    const std::string name = fmt::format("channels[{}]", i);
    const std::optional<double> whole = report.wholeNumber(here, name, list[i], "a whole number");
    if (!whole) return false;
    if (*whole < kUnused || *whole > kMostChannels) {
      report.error(
          "out-of-range", here, fmt::format("{} is {}", name, *whole),
          fmt::format("it must be a channel of the image from 0 to {}, or -1 for none", kMostChannels));
      return false;
    }
    out[i] = static_cast<int>(*whole);
  }
  return true;
}

/// One of the images and channels that may stand for a texture; what is wrong is left out.
void readSwizzle(const Json& option, size_t images, const Path& path, Report& report, Texture& out) {
  Texture::Source made{kSwizzle, -1, kOwnChannels, 0};
  const Json* source = member(option, "source");
  const Json* channels = member(option, "channels");
  for (const auto& [name, found] : {std::pair("source", source), std::pair("channels", channels)}) {
    if (found == nullptr && !isStandIn(option))
      report.error("missing-property", path, fmt::format("the option has no \"{}\"", name),
                   "it must name an image and its channels");
  }
  bool good = source != nullptr && channels != nullptr;
  if (source != nullptr)
    good = report.index(Path(path, "source"), "source", *source, images, "image", made.image) && good;
  if (channels != nullptr)
    good = readChannels(*channels, Path(path, "channels"), report, made.channels) && good;
  if (const Json* layer = member(option, "arrayLayer")) {
    const Path here(path, "arrayLayer");
    const std::optional<double> whole = report.wholeNumber(here, "arrayLayer", *layer, "a whole number");
    if (whole && (*whole < 0 || *whole > kLastLayer)) {
      report.error("out-of-range", here, fmt::format("arrayLayer is {}", *whole),
                   fmt::format("it must be from 0 to {}", kLastLayer));
      good = false;
    }
    good = good && whole;
    if (good) made.layer = static_cast<int>(*whole);
  }
  if (good) out.swizzles.push_back(made);
}

/// NV_texture_swizzle: the first that shaders can take goes before the others, which are as good.
void readSwizzles(const Json& extension, size_t images, const Path& path, Report& report, Texture& out) {
  if (!extension.is_object()) return report.wrongType(path, kSwizzle, extension, "an object");
  const Json* options = member(extension, "options");
  const Path here(path, "options");
  if (options == nullptr || (options->is_array() && options->size() == 0)) {
    return report.error("missing-property", path, fmt::format("{} has no \"options\"", kSwizzle),
                        "it must have one at least");
  }
  eachElement(report, *options, here, "option", [&](const Json& option, const Path& at, size_t) {
    readSwizzle(option, images, at, report, out);
  });
  const auto first = std::find_if(out.swizzles.begin(), out.swizzles.end(), sampled);
  if (first != out.swizzles.end()) std::rotate(out.swizzles.begin(), first, first + 1);
  if (!out.swizzled() || sampled(out.swizzles[0])) return;
  report.note("image-channels", path,
              "shaders sample four channels of one layer, and the texture has others of its image",
              "the application makes an image of them: the manifest lists the channels");
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
  if (sampler >= 0) readSampler(json::at(root, "samplers")[static_cast<size_t>(sampler)], path, nullptr, out);
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
  if (const Json* extension = extensionOf(texture, kSwizzle))
    readSwizzles(*extension, images, Path(extensions, kSwizzle), report, out);
  return out;
}

}  // namespace lacquer::gltf
