#include "gltf/texture_source.h"
#include "gltf/uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <unordered_set>

#include "gltf/container.h"
#include "gltf/members.h"
#include "gltf/reading.h"
#include "support/contain.h"
#include "support/file.h"
#include "support/letters.h"
#include "support/text.h"

namespace lacquer::gltf {

namespace {

std::optional<std::string> fromBase64(std::string_view text) {
  std::string bytes;
  uint32_t bits = 0;
  int count = 0;
  while (text.ends_with('=')) text.remove_suffix(1);
  for (const char c : text) {
    uint32_t six = 0;
    if (c >= 'A' && c <= 'Z')
      six = static_cast<uint32_t>(c - 'A');
    else if (c >= 'a' && c <= 'z')
      six = static_cast<uint32_t>(c - 'a') + 26;
    else if (c >= '0' && c <= '9')
      six = static_cast<uint32_t>(c - '0') + 52;
    else if (c == '+')
      six = 62;
    else if (c == '/')
      six = 63;
    else
      return std::nullopt;
    bits = (bits << 6 | six) & 0xFFFFFF;
    if (++count % 4 != 1) bytes += static_cast<char>(bits >> (6 - 2 * ((count - 1) % 4)) & 0xFF);
  }
  if (count % 4 == 1) return std::nullopt;
  return bytes;
}

bool isData(std::string_view uri) {
  constexpr std::string_view kScheme = "data:";
  return uri.size() > kScheme.size() && sameLetters(uri.substr(0, kScheme.size()), kScheme);
}

}  // namespace

bool hasScheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  return colon != std::string_view::npos && uri.find_first_of("/?#") > colon;
}

Result<std::string> relativePath(std::string_view uri, const Place& place) {
  std::string relative = percentDecoded(uri);
  if (!hasScheme(uri) && !std::filesystem::path(relative).is_absolute() &&
      relative.find('\0') == std::string::npos)
    return relative;
  return fail("image-missing", place, fmt::format("{} is no relative path", quote(uri)),
              "images are looked for beside the file");
}

std::string percentDecoded(std::string_view uri) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    c = static_cast<char>(c | 0x20);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
  };
  std::string text;
  for (size_t i = 0; i < uri.size(); ++i) {
    const bool code = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
    text += code ? static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i];
    if (code) i += 2;
  }
  return text;
}

Result<TextureFile> TextureFile::open(const std::string& path, const TextureAccess& access) {
  const Result<std::string> bytes = readFile(path, access.limits.file);
  if (!bytes) return tl::make_unexpected(bytes.error());
  Result<TextureFile> file = fromMemory(*bytes, path, access);
  if (file) file->in_memory_ = false;
  return file;
}

Result<TextureFile> TextureFile::fromMemory(std::string_view bytes, const std::string& name,
                                            const TextureAccess& access) {
  const Result<std::string_view> text = jsonText(bytes, name);
  if (!text) return tl::make_unexpected(text.error());
  Result<Json> root = parseJson(*text, name, access.limits);
  if (!root) return tl::make_unexpected(std::move(root.error()));
  TextureFile file;
  if (isGlb(bytes)) {
    const Result<Container> container = containerOf(bytes, name);
    file.glb_version_ = container->version;
    for (const Chunk& chunk : container->chunks) {
      const bool buffer = chunk.kind == Chunk::Kind::Binary && chunk.encoding == 0;
      file.chunks_.push_back(buffer ? std::make_shared<const std::string>(chunk.data) : nullptr);
    }
  }
  file.path_ = name;
  file.access_ = access;
  file.in_memory_ = true;
  file.root_ = std::move(*root);
  return file;
}

TextureFile TextureFile::beside(const std::string& path, const TextureAccess& access, bool in_memory) {
  TextureFile file;
  file.path_ = path;
  file.access_ = access;
  file.in_memory_ = in_memory;
  return file;
}

Result<std::string> TextureFile::uriBytes(const std::string& uri, const Place& place) const {
  const auto missing = [&](std::string message, std::string help) {
    return fail("image-missing", place, std::move(message), std::move(help));
  };
  if (isData(uri)) {
    const size_t comma = uri.find(',');
    const bool base64 =
        comma != std::string::npos && std::string_view(uri).substr(0, comma).ends_with(";base64");
    std::optional<std::string> bytes;
    if (base64) bytes = fromBase64(std::string_view(uri).substr(comma + 1));
    if (!bytes) return missing("the data URI cannot be decoded", "it must be base64");
    return *bytes;
  }
  if (in_memory_) {
    return missing(fmt::format("{} is a file, and what names it was read from memory", quote(uri)),
                   "images must be in it, as data URIs or buffer views");
  }
  const Result<std::string> relative = relativePath(uri, place);
  if (!relative) return tl::make_unexpected(relative.error());
  constexpr size_t kLongestPath = 4095;  // of Linux; a name within it has 255 bytes
  if (relative->size() > kLongestPath)
    return missing(fmt::format("the name of the file has {} bytes", relative->size()),
                   fmt::format("a path has at most {}", kLongestPath));
  const std::string folder = std::filesystem::path(path_).parent_path().string();
  const std::optional<std::string> file = resolveBelow(folder, *relative, access_.allow);
  if (!file) {
    return fail("image-outside", place, fmt::format("{} leads out of the file's folder", quote(uri)),
                "--allow DIR lets images lie in another folder, too");
  }
  Result<std::string> bytes = readFile(*file, access_.limits.file, Links::None);
  if (bytes) read_.push_back(*file);
  if (!bytes) return missing(fmt::format("{} cannot be read: {}", quote(uri), bytes.error()[0].message), {});
  return bytes;
}

Result<std::shared_ptr<const std::string>> TextureFile::bufferBytes(size_t index, const Place& place) const {
  const Json* buffer = element(root_, "buffers", index);
  if (buffer == nullptr) return fail("image-missing", place, fmt::format("there is no buffer {}", index));
  const Json* uri = member(*buffer, "uri");
  if (uri == nullptr) return chunkBytes(*buffer, index, place);
  if (!uri->is_string()) return fail("image-missing", place, "the buffer's uri is no string");
  // Buffers may name one file, again and again, and images lie in one buffer.
  const auto [known, fresh] =
      buffers_.try_emplace(isData(json::text(*uri)) ? fmt::format("data:{}", index) : json::text(*uri));
  if (!fresh && known->second != nullptr) return known->second;
  Result<std::string> bytes = uriBytes(json::text(*uri), place);
  if (!bytes) return tl::make_unexpected(bytes.error());
  if (bytes->size() > access_.limits.file - held_) {
    return fail("image-missing", place,
                fmt::format("its buffers have more than {} bytes together", access_.limits.file),
                raising("file"));
  }
  held_ += bytes->size();
  return known->second = std::make_shared<const std::string>(std::move(*bytes));
}

Result<std::shared_ptr<const std::string>> TextureFile::chunkBytes(const Json& buffer, size_t index,
                                                                   const Place& place) const {
  static const auto kEmpty = std::make_shared<const std::string>();
  if (member(buffer, "chunk") != nullptr) {
    const std::optional<size_t> chunk = wholeMember(buffer, "chunk");
    if (chunk && *chunk < chunks_.size() && chunks_[*chunk] != nullptr) return chunks_[*chunk];
    return fail("image-missing", place,
                fmt::format("buffer {} names a chunk that is no binary one of the file", index),
                chunks_.empty() ? "chunks are a GLB's"
                                : fmt::format("the GLB has {}, and the first has the number 0",
                                              countOf(chunks_.size(), "chunk")));
  }
  if (index != 0) return kEmpty;
  // Version 2 has one binary chunk, wherever it is; in version 3 what goes without saying is chunk 1.
  if (glb_version_ == 3) return chunks_.size() > 1 && chunks_[1] != nullptr ? chunks_[1] : kEmpty;
  const auto first =
      std::find_if(chunks_.begin(), chunks_.end(), [](const auto& one) { return one != nullptr; });
  return first == chunks_.end() ? kEmpty : *first;
}

Result<std::string> TextureFile::viewBytes(size_t index, const Place& place) const {
  const auto broken = [&](std::string message) { return fail("image-missing", place, std::move(message)); };
  const Json* view = element(root_, "bufferViews", index);
  if (view == nullptr) return broken(fmt::format("there is no bufferView {}", index));
  const std::optional<size_t> buffer_index = wholeMember(*view, "buffer");
  if (element(root_, "buffers", buffer_index) == nullptr) return broken("the bufferView has no buffer");
  const Result<std::shared_ptr<const std::string>> bytes = bufferBytes(*buffer_index, place);
  if (!bytes) return tl::make_unexpected(bytes.error());
  const std::optional<size_t> offset = wholeOr(*view, "byteOffset", 0);
  const size_t length = wholeMember(*view, "byteLength").value_or(0);
  if (length == 0 || !offset || *offset > (*bytes)->size() || length > (*bytes)->size() - *offset) {
    return broken("the bufferView lies outside of its buffer");
  }
  return (*bytes)->substr(*offset, length);
}

Result<std::string> TextureFile::bytesOf(const Json& owner, const Place& place) const {
  const Json* uri = member(owner, "uri");
  if (uri != nullptr && uri->is_string()) return uriBytes(uri->get<std::string>(), place);
  const std::optional<size_t> view = wholeMember(owner, "bufferView");
  if (!view) return fail("image-missing", place, "there is neither a uri nor a bufferView");
  return viewBytes(*view, place);
}

Result<TextureSource> TextureFile::texture(int index) const {
  const Place place{path_, 0, 0, fmt::format("/textures/{}", index)};
  const Json* texture = index < 0 ? nullptr : element(root_, "textures", static_cast<size_t>(index));
  if (texture == nullptr) return fail("image-missing", place, "there is no such texture");
  TextureSource source;
  Diagnostics ignored;  // whoever reads the scene says them
  Report report(path_, ignored);
  source.texture = readTexture(root_, *texture, Path(), report);
  const int image = source.texture.source >= 0 ? source.texture.source : source.texture.image();
  if (image < 0 || element(root_, "images", static_cast<size_t>(image)) == nullptr)
    return fail("image-missing", place, "the texture has no image");
  if (source.texture.swizzled() && !sampled(source.texture.swizzles[0]))
    return fail(
        "image-missing", place,
        fmt::format("the texture has other channels of image {} than the first four, or another layer",
                    image),
        "images of four channels and one layer are decoded here");
  source.image = static_cast<size_t>(image);
  source.place = {path_, 0, 0, fmt::format("/images/{}", image)};
  return source;
}

std::vector<std::string> TextureFile::fileUris() const {
  std::vector<std::string> uris;
  std::unordered_set<std::string_view> seen;
  for (const std::string_view array : {"buffers", "images"}) {
    const Json* all = member(root_, array);
    if (all == nullptr || !all->is_array()) continue;
    for (const Json& object : *all) {
      const Json* uri = member(object, "uri");
      if (uri == nullptr || !uri->is_string()) continue;
      if (!isData(json::text(*uri)) && seen.insert(json::text(*uri)).second) uris.push_back(json::text(*uri));
    }
  }
  return uris;
}

Result<std::string> TextureFile::image(const TextureSource& source) const {
  return bytesOf(*element(root_, "images", source.image), source.place);
}

}  // namespace lacquer::gltf
