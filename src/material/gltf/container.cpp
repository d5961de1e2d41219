// The GLB container (glTF 2.0, section 4).
#include "gltf/container.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>

namespace lacquer::gltf {

namespace {

constexpr std::string_view kMagic = "glTF";
constexpr uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr size_t kHeader = 12;
constexpr size_t kChunkHeader = 8;

/// The error of a chunk that does not fit into the file.
std::optional<std::string> badChunk(std::string_view glb) {
  size_t at = kHeader;
  for (size_t number = 0; at < glb.size(); ++number) {
    if (glb.size() - at < kChunkHeader)
      return fmt::format("chunk {} at byte {} has no complete header", number, at);
    const size_t length = word(glb, at);
    const size_t room = glb.size() - at - kChunkHeader;
    if (length > room) {
      return fmt::format("chunk {} at byte {} claims {} bytes, but only {} follow", number, at, length, room);
    }
    at += kChunkHeader + length;
  }
  return std::nullopt;
}

}  // namespace

uint32_t word(std::string_view bytes, size_t offset) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i)
    value |= static_cast<uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
  return value;
}

Result<std::string_view> jsonText(std::string_view bytes, const std::string& file) {
  const Place place{file, 0, 0, {}};
  const auto truncated = [&](std::string message) {
    return fail("truncated-glb", place, std::move(message));
  };
  if (bytes.empty())
    return fail("empty-file", place, "the file is empty",
                place.file.ends_with(".mtlx") ? "a .mtlx holds an element <materialx>"
                                              : "a .gltf holds a JSON object");
  if (!bytes.starts_with(kMagic)) return bytes;

  if (bytes.size() < kHeader) {
    return truncated(fmt::format("a GLB's header has {} bytes, the file only {}", kHeader, bytes.size()));
  }
  if (const uint32_t version = word(bytes, 4); version != 2) {
    return fail("unsupported-version", place, fmt::format("this is version {} of the GLB container", version),
                "Lacquer reads version 2");
  }
  const size_t length = word(bytes, 8);
  if (length > bytes.size()) {
    return truncated(fmt::format("the GLB's header claims {} bytes, the file has {}", length, bytes.size()));
  }
  if (length < kHeader + kChunkHeader) {
    return truncated(fmt::format("the GLB's header claims {} bytes, too few for a chunk", length));
  }
  const std::string_view glb = bytes.substr(0, length);  // what follows is not the GLB's
  if (std::optional<std::string> message = badChunk(glb)) return truncated(std::move(*message));
  if (word(glb, kHeader + 4) != kJsonChunk) {
    return fail("no-json-chunk", place, "the GLB's first chunk is not JSON",
                "the JSON chunk must come first");
  }
  std::string_view text = glb.substr(kHeader + kChunkHeader, word(glb, kHeader));
  // Chunks are padded with spaces, but some writers pad with zeros.
  while (text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

}  // namespace lacquer::gltf
