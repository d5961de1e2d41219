// The bytes and the sampler behind a texture, for those who look into images. Generation does not.
#pragma once

#include <string>

#include "gltf/json.h"
#include "support/diagnostic.h"

namespace lacquer::gltf {

/// A texture's sampler as glTF has it (OpenGL's numbers), with glTF's defaults, and its encoded image.
struct TextureSource {
  int wrapS = 10497, wrapT = 10497;  ///< 33071 clamp, 33648 mirror, 10497 repeat
  int magFilter = 9729;              ///< 9728 nearest, 9729 linear
  std::string bytes;                 ///< PNG or JPEG
  Place place;                       ///< of the image
};

/// A file's JSON and its binary chunk, opened to look for textures.
class TextureFile {
public:
  /// Reads a .gltf or .glb.
  static Result<TextureFile> open(const std::string& path);

  /// The texture of that index. Images are files beside the glTF (by a relative URI), data URIs or buffer
  /// views. Errors: "image-missing" when there is none or it cannot be read, "wrong-type" and the like for
  /// broken JSON.
  Result<TextureSource> texture(int index) const;

private:
  Result<std::string> uriBytes(const std::string& uri, const Place& place) const;
  Result<std::string> imageBytes(const Json& image, const Place& place) const;
  Result<std::string> viewBytes(size_t index, const Place& place) const;

  std::string path_, binary_;
  Json root_;
};

}  // namespace lacquer::gltf
