// The bytes and the sampler behind a texture, for those who look into images. Generation does not.
#pragma once

#include <string>
#include <vector>

#include "gltf/facts.h"
#include "gltf/json.h"
#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer::gltf {

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

/// A file's JSON and its binary chunk, opened to look for textures.
class TextureFile {
public:
  /// Reads a .gltf or .glb.
  static Result<TextureFile> open(const std::string& path, const TextureAccess& access);

  /// The texture of that index. Errors: "image-missing".
  Result<TextureSource> texture(int index) const;

  /// Its image, encoded. Images are files in the glTF's folder or below it (by a relative URI), data
  /// URIs or buffer views. Errors: "image-missing" when there is none or it cannot be read, "image-outside"
  /// for a path that leads elsewhere, which nobody looks at.
  Result<std::string> image(const TextureSource& source) const;

  /// Those that image() has read, as paths.
  const std::vector<std::string>& filesRead() const { return read_; }

private:
  Result<std::string> uriBytes(const std::string& uri, const Place& place) const;
  Result<std::string> imageBytes(const Json& image, const Place& place) const;
  Result<std::string> viewBytes(size_t index, const Place& place) const;

  std::string path_, binary_;
  TextureAccess access_;
  mutable std::vector<std::string> read_;
  Json root_;
};

}  // namespace lacquer::gltf
