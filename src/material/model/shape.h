// Materials that have one graph but for its numbers: most materials of a file. What decides of a graph is
// which numbers and textures a material has, and whether a number is one that the model compares it with; the
// rest are values that the graph's parameters are given.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "graph/graph.h"
#include "material/material.h"
#include "model/model.h"

namespace lacquer::model {

/// Where a parameter of a graph has its value from.
struct Origin {
  enum class Kind : uint8_t {
    Number,    ///< of the material
    Member,    ///< of the textureInfo of `property`
    Offset,    ///< of the transform of `property`
    Rotation,  ///< likewise
    Scale,     ///< likewise
  };
  Kind kind = Kind::Number;
  uint16_t property = 0;  ///< in Schema::properties
  int member = -1;
};

/// Of a graph's parameters and of its textures, in their order.
struct Origins {
  std::vector<Origin> parameters;
  std::vector<uint16_t> textures;  ///< properties
};

/// The value that a material gives to a parameter. `otherwise`: of a number that its file does not have.
ir::Components valueOf(const Origin& origin, const material::Material& material,
                       const ir::Components& otherwise);
/// The JSON pointer of that value. Of a member and of a transform the material must have the texture.
std::string pointerOf(const Origin& origin, const material::Material& material,
                      const material::Schema& schema);

/// What build() looks at in a material.
class Shapes {
public:
  explicit Shapes(const Model& model);

  /// Equal for two materials whose graphs, for equal options, are equal but for names, JSON pointers, indices
  /// of textures and the values of parameters.
  std::string keyOf(const material::Material& material, const gltf::VertexAttributes& attributes) const;

private:
  /// A number that may be compared.
  struct Compared {
    bool raw = false;  ///< a bool or a choice
    size_t components = 1;
    std::vector<ir::Components> special;  ///< that some condition or default compares it with
  };
  Compared comparedOf(const lang::PropertyDecl& decl) const;
  static void add(const Compared& compared, const ir::Components& value, std::string& key);

  std::vector<Compared> numbers_;               ///< by property
  std::vector<std::vector<Compared>> members_;  ///< by property and member
};

}  // namespace lacquer::model
