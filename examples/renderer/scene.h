// A glTF file as a renderer wants it: vertices, and what there is to draw at a time.
#pragma once

#include <tiny_gltf.h>

#include <map>
#include <string>
#include <vector>

#include "math.h"

namespace renderer {

/// An attribute of all vertices, or of all instances, as a vertex buffer has it.
struct Attribute {
  lacquer::vk::VertexStream stream;
  std::vector<unsigned char> bytes;
};
using Attributes = std::map<std::string, Attribute, std::less<>>;

/// A node's instances (EXT_mesh_gpu_instancing).
struct Instances {
  Attributes attributes;       ///< once for each
  std::vector<Matrix> places;  ///< in the node's space
};

/// A primitive's triangles.
struct Mesh {
  Attributes attributes;
  std::vector<uint32_t> indices;
  uint32_t targets = 0, width = 1, height = 1;  ///< of `deltas`: three layers for each target
  std::vector<float> deltas;
  Vec3 low{}, high{};
};

/// A primitive at a node.
struct Draw {
  size_t primitive = 0;  ///< of the contract
  Matrix model = kIdentity;
  const std::vector<float>* weights = nullptr;  ///< of the morph targets
  int skin = -1, instances_of = -1;             ///< a node for the latter
};

struct View {
  Matrix node = kIdentity;
  float yfov = 0.8F, near = 0.1F, far = 0;
  float half_width = 0, half_height = 0;  ///< of an orthographic one; else 0
  Matrix viewProjection(float aspect) const;
};

/// What an animation gives a property of the file, by its JSON pointer.
using Pointers = std::map<std::string, std::vector<float>, std::less<>>;

/// The file at a time.
struct Moment {
  std::vector<Draw> draws;
  std::vector<lacquer::vk::PunctualLight> lights;
  std::vector<lacquer::vk::AreaLight> areas;
  std::vector<View> cameras;
  std::vector<std::vector<Matrix>> joints;  ///< by skin
  Pointers pointers;
};

class Scene {
public:
  /// Throws what is wrong with the file as a whole; what is wrong with a part goes to stderr.
  explicit Scene(const std::string& path);
  /// Reads the primitives that can be drawn, in the contract's order; an empty mesh for one that cannot.
  std::vector<Mesh> meshes(const lacquer::Contract& contract) const;
  Moment at(float seconds, const lacquer::Contract& contract);
  /// Whether the file has lights of EXT_lights_area.
  bool hasAreas() const { return model_.extensions.find("EXT_lights_area") != model_.extensions.end(); }
  /// One in the node's own place where they cannot be read.
  Instances instances(int node) const;
  const tinygltf::Model& model() const { return model_; }

private:
  struct Node {
    Vec3 translation{}, scale{1, 1, 1};
    Vec4 rotation{0, 0, 0, 1};
    Matrix matrix = kIdentity;  ///< where there is one, or all three together
    bool decomposed = true;
    std::vector<float> weights;
    Matrix world = kIdentity;
    bool shown = false;   ///< the scene has it
    bool visible = true;  ///< it says so (KHR_node_visibility)
    bool hidden = false;  ///< it or one above it does not
  };
  void animate(float seconds, Pointers& pointers);
  void place(int node, const Matrix& parent, bool hidden, int depth);
  const unsigned char* bytesOf(int view, size_t offset, size_t size, size_t count, size_t& stride) const;
  template <class T>
  bool read(int accessor, int type, std::vector<T>& numbers) const;
  bool readAttribute(int accessor, const lacquer::StoredAttribute& stored, size_t& count,
                     Attribute& made) const;
  bool readMesh(const lacquer::ContractPrimitive& from, Mesh& mesh) const;
  bool readColumns(int index, const lacquer::StoredAttribute& stored, size_t& count, Mesh& mesh) const;
  bool readTargets(const tinygltf::Primitive& from, size_t vertices, Mesh& mesh) const;

  tinygltf::Model model_;
  std::vector<Node> nodes_;
};

}  // namespace renderer
