// The bytes and the sampler behind a texture, for those who look into images. Generation does not.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gltf/facts.h"
#include "gltf/json.h"
#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer::gltf {

/// A URI's path as the file's name: "%20" is " ". A percent sign that starts no such code stands for itself.
std::string percentDecoded(std::string_view uri);

/// A texture with the image that is looked into. That is its own, a PNG or a JPEG, even where an extension
/// gives another: those formats are not decoded here.
struct TextureSource {
  Texture texture;
  size_t image = 0;  ///< index
  Place place;       ///< of the image
};

/// Where a file's images may come from.
struct TextureAccess {
  Limits limits;
  std::vector<std::string> allow;  ///< folders beside the file's own
};

/// A file's JSON and its binary chunks, opened to look for textures.
class TextureFile {
public:
  /// Reads a .gltf or .glb.
  static Result<TextureFile> open(const std::string& path, const TextureAccess& access);
  /// The same from its bytes; `name` stands for the file in messages. Its images are in it: no file is read.
  static Result<TextureFile> fromMemory(std::string_view bytes, const std::string& name,
                                        const TextureAccess& access);

  /// No glTF file, but one beside which images lie; with `in_memory` none but data URIs.
  static TextureFile beside(const std::string& path, const TextureAccess& access, bool in_memory);

  /// The texture of that index. Errors: "image-missing".
  Result<TextureSource> texture(int index) const;

  /// Its image, encoded. Images are files in the glTF's folder or below it (by a relative URI), data
  /// URIs or buffer views. Errors: "image-missing" when there is none or it cannot be read, "image-outside"
  /// for a path that leads elsewhere, which nobody looks at.
  Result<std::string> image(const TextureSource& source) const;

  /// The URIs of buffers and images that lie in files of their own, each once, in the order of the JSON.
  std::vector<std::string> fileUris() const;
  /// The bytes behind a URI of a file, or a data URI. Errors: those of image().
  Result<std::string> fileBytes(const std::string& uri, const std::string& pointer = {}) const {
    return uriBytes(uri, {path_, 0, 0, pointer});
  }

  /// The bytes behind an object with a `uri` or a `bufferView`. Errors: those of image().
  Result<std::string> bytesOf(const Json& owner, const Place& place) const;

  /// A whole buffer: a file, a data URI or a chunk of the GLB, the one that it names, or for the first buffer
  /// the one that need not be named. Errors: those of image(), and "image-missing" where the buffers are
  /// together larger than a file may be. Each is read once, and held.
  Result<std::shared_ptr<const std::string>> bufferBytes(size_t index, const Place& place) const;
  /// The file's JSON, which nobody has checked.
  const Json& root() const { return root_; }

  /// Those that image(), fileBytes() and bufferBytes() have read, as paths.
  const std::vector<std::string>& filesRead() const { return read_; }

private:
  Result<std::string> uriBytes(const std::string& uri, const Place& place) const;
  Result<std::string> viewBytes(size_t index, const Place& place) const;
  /// Of a buffer without a `uri`.
  Result<std::shared_ptr<const std::string>> chunkBytes(const Json& buffer, size_t index,
                                                        const Place& place) const;

  std::string path_;
  std::vector<std::shared_ptr<const std::string>> chunks_;  ///< of a GLB; nullptr for those of other types
  uint32_t glb_version_ = 2;
  TextureAccess access_;
  bool in_memory_ = false;
  mutable std::vector<std::string> read_;
  mutable std::map<std::string, std::shared_ptr<const std::string>>
      buffers_;                ///< by URI, those in one by index
  mutable uint64_t held_ = 0;  ///< bytes of these
  Json root_;
};

}  // namespace lacquer::gltf
