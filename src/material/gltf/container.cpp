// The GLB container (glTF 2.0, section 4; the draft of glTF 2.1 for version 3).
#include "gltf/container.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace lacquer::gltf {

namespace {

constexpr std::string_view kMagic = "glTF";
constexpr uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr uint32_t kBinaryChunk = 0x004E4942;  // "BIN\0"

/// Four bytes as a number; they must be there.
uint32_t word(std::string_view bytes, size_t offset) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i)
    value |= static_cast<uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
  return value;
}

uint64_t longWord(std::string_view bytes, size_t offset) {
  return word(bytes, offset) | static_cast<uint64_t>(word(bytes, offset + 4)) << 32;
}

/// What the versions differ in.
struct Layout {
  size_t header, chunk_header, alignment;
  bool wide;  ///< version 3: lengths have 64 bits, and stand after the chunk's type and encoding
};
constexpr Layout kVersion2{12, 8, 1, false}, kVersion3{16, 16, 8, true};

/// Takes the chunks of a GLB apart, which is no longer than its header claims.
class ChunkReader {
public:
  ChunkReader(std::string_view glb, const Layout& layout) : glb_(glb), layout_(layout) {}

  /// The error of a chunk that does not fit into the file.
  std::optional<std::string> read(std::vector<Chunk>& chunks) const {
    for (size_t at = layout_.header; at < glb_.size();) {
      const size_t number = chunks.size();
      if (glb_.size() - at < layout_.chunk_header)
        return fmt::format("chunk {} at byte {} has no complete header", number, at);
      const uint64_t length = layout_.wide ? longWord(glb_, at + 8) : word(glb_, at);
      const size_t room = glb_.size() - at - layout_.chunk_header;
      if (length > room)
        return fmt::format("chunk {} at byte {} claims {} bytes, but only {} follow", number, at, length,
                           room);
      const uint32_t type = word(glb_, layout_.wide ? at : at + 4);
      chunks.push_back({type == kJsonChunk     ? Chunk::Kind::Json
                        : type == kBinaryChunk ? Chunk::Kind::Binary
                                               : Chunk::Kind::Other,
                        layout_.wide ? word(glb_, at + 4) : 0,
                        glb_.substr(at + layout_.chunk_header, static_cast<size_t>(length))});
      at += layout_.chunk_header + static_cast<size_t>(length);
      // What is left of a chunk's last eight bytes need not be there behind the last chunk.
      at = (at + layout_.alignment - 1) / layout_.alignment * layout_.alignment;
    }
    return std::nullopt;
  }

private:
  std::string_view glb_;
  const Layout& layout_;
};

}  // namespace

bool isGlb(std::string_view bytes) { return bytes.starts_with(kMagic); }

Result<Container> containerOf(std::string_view bytes, const std::string& file) {
  const Place place{file, 0, 0, {}};
  const auto truncated = [&](std::string message) {
    return fail("truncated-glb", place, std::move(message));
  };
  if (bytes.size() < kVersion2.header) {
    return truncated(
        fmt::format("a GLB's header has {} bytes, the file only {}", kVersion2.header, bytes.size()));
  }
  const uint32_t version = word(bytes, 4);
  if (version != 2 && version != 3) {
    return fail("unsupported-version", place, fmt::format("this is version {} of the GLB container", version),
                "Lacquer reads versions 2 and 3");
  }
  const Layout& layout = version == 2 ? kVersion2 : kVersion3;
  if (bytes.size() < layout.header) {
    return truncated(fmt::format("the header of a GLB of version 3 has {} bytes, the file only {}",
                                 layout.header, bytes.size()));
  }
  const uint64_t length = layout.wide ? longWord(bytes, 8) : word(bytes, 8);
  if (length > bytes.size()) {
    return truncated(fmt::format("the GLB's header claims {} bytes, the file has {}", length, bytes.size()));
  }
  if (length < layout.header + layout.chunk_header) {
    return truncated(fmt::format("the GLB's header claims {} bytes, too few for a chunk", length));
  }
  Container container{version, {}, {}};
  // What follows is not the GLB's.
  const std::string_view glb = bytes.substr(0, static_cast<size_t>(length));
  if (std::optional<std::string> message = ChunkReader(glb, layout).read(container.chunks))
    return truncated(std::move(*message));
  const auto json = std::find_if(container.chunks.begin(), container.chunks.end(), [&](const Chunk& chunk) {
    return version == 2 || chunk.kind == Chunk::Kind::Json;
  });
  if (json == container.chunks.end())
    return fail("no-json-chunk", place, "the GLB has no chunk of JSON", "it must have one");
  if (json->kind != Chunk::Kind::Json) {
    return fail("no-json-chunk", place, "the GLB's first chunk is not JSON",
                "the JSON chunk must come first");
  }
  if (json->encoding != 0) {
    return fail("unsupported-version", place,
                fmt::format("the GLB's chunk of JSON has the encoding {}", json->encoding),
                "glTF 2.1 defines 0 alone, for bytes as they are");
  }
  container.json = json->data;
  // Chunks are padded with spaces, but some writers pad with zeros.
  while (container.json.ends_with('\0')) container.json.remove_suffix(1);
  return container;
}

Result<std::string_view> jsonText(std::string_view bytes, const std::string& file) {
  if (bytes.empty())
    return fail(
        "empty-file", {file, 0, 0, {}}, "the file is empty",
        file.ends_with(".mtlx") ? "a .mtlx holds an element <materialx>" : "a .gltf holds a JSON object");
  if (!isGlb(bytes)) return bytes;
  const Result<Container> container = containerOf(bytes, file);
  if (!container) return tl::make_unexpected(container.error());
  return container->json;
}

}  // namespace lacquer::gltf
