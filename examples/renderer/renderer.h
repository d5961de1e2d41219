// Draws a scene with the shaders that the library makes of it.
#pragma once

#include <future>
#include <optional>
#include <tuple>

#include "device.h"
#include "environment.h"
#include "scene.h"

namespace renderer {

struct Settings {
  uint32_t width = 960, height = 540;  ///< pixels that are drawn
  std::string environment;             ///< the folder that `lacquer environment` writes
  std::string cache;                   ///< of the library; empty for none
  std::string variant;                 ///< a name of KHR_materials_variants; empty for none
  std::string shown;                   ///< a template whose first colour is drawn in place of the picture
  uint32_t programs = 0;               ///< lacquer::Options::programs
  bool fallback = false;               ///< the first frame is drawn with fallbacks
  size_t camera = 0;                   ///< of those that the scene shows
  bool prepass = false;                ///< depth first: colours are then drawn where they are in front alone
};

/// Everything that is drawn with one template.
struct Stage {
  lacquer::Contract contract;
  struct Code {
    VkShaderModule vertex = VK_NULL_HANDLE, fragment = VK_NULL_HANDLE;
    lacquer::vk::SetLayouts bindings;  ///< of the material's set
    VkDescriptorSetLayout materials = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
  };
  std::vector<Code> code;            ///< by the contract's shaders
  lacquer::vk::SetLayouts bindings;  ///< of the frame's set, which all its shaders share
  VkDescriptorSetLayout frame_layout = VK_NULL_HANDLE;
  VkDescriptorSet frame = VK_NULL_HANDLE;
  std::map<const lacquer::ContractUse*, VkDescriptorSet> materials;
  std::map<std::string, VkPipeline> pipelines;                  ///< by what they are made of
  std::map<std::string, std::shared_future<VkPipeline>> later;  ///< that a thread compiles
};

/// A primitive at a node, ready to be drawn.
struct Item {
  Draw draw;
  Instances instances{{}, {kIdentity}};
  bool mirrored = false;
  lacquer::vk::DrawOrder order;
  VkDescriptorSet object = VK_NULL_HANDLE;
};

class Renderer {
public:
  /// Throws what cannot be drawn at all; what is wrong with a part of the scene goes to stderr.
  Renderer(Device& device, const std::string& file, const Settings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  /// Rows of linear RGBA from the top.
  std::vector<float> draw(float seconds);
  /// Whether the last frame had a fallback in the place of a pipeline that was not there yet.
  bool hadFallbacks() const { return fallbacks_ > 0; }
  /// What was found: primitives, triangles, shaders.
  std::string summary() const;

private:
  enum class Depth : uint8_t { Own, First, Equal };
  /// All that a pipeline is made of: a thread may make it.
  struct Plan {
    lacquer::vk::VertexInput input;
    lacquer::DrawState state;
    bool mirrored = false, colors = true, bias = false;
    Depth mode = Depth::Own;
    VkShaderModule vertex = VK_NULL_HANDLE, fragment = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
  };

  // renderer.cpp: what stays
  void makeStage(Stage& stage, const lacquer::Scene& materials, const std::string& name);
  void makeLayouts(Stage& stage);
  VkDescriptorSet allocate(VkDescriptorSetLayout layout, const lacquer::vk::SetLayouts& bindings,
                           uint32_t set);
  VkSampler samplerOf(const VkSamplerCreateInfo& info);
  const Image& textureOf(const lacquer::UsedTexture& used);
  const Image& imageOf(const std::string& key, uint32_t width, uint32_t height, uint32_t layers,
                       const std::vector<float>& texels);
  const Buffer& bufferOf(const Attribute& attribute);

  // frame.cpp: what changes with the time
  void collect();
  bool lightView();
  View viewOf() const;
  void fillFrame(Stage& stage, const View& view, const Matrix& view_projection);
  static lacquer::Drawn boundOf(const Stage& stage, const lacquer::Drawn& drawn);
  void fillMaterial(Stage& stage, const lacquer::Drawn& drawn);
  void fillObject(Item& item);
  VkPipeline made(const Plan& plan) const;
  void exchange(bool wait);
  VkPipeline pipelineOf(Stage& stage, const lacquer::Drawn& drawn, const Item& item, Depth mode);
  void drawItem(VkCommandBuffer commands, Stage& stage, const lacquer::Drawn& drawn, const Item& item,
                Depth mode);
  const Attribute& standInOf(const std::string& name);
  void record(VkCommandBuffer commands);
  void pass(VkCommandBuffer commands, const Image* color, const Image& depth, bool clear,
            const std::function<void()>& draws);

  Device& device_;
  Settings settings_;
  Scene scene_;
  std::vector<Mesh> meshes_;  ///< by the contract's primitives; last the sky's triangle
  Stage color_, shadow_, depth_, sky_;
  lacquer::vk::SetLayouts object_bindings_;  ///< of the objects' set, which all stages share
  VkDescriptorSetLayout object_layout_ = VK_NULL_HANDLE;
  Environment environment_;
  Image target_, depths_, behind_, shadow_map_;
  std::optional<size_t> variant_;
  std::map<std::tuple<int, bool, std::string>, Image> textures_;
  std::map<std::string, Image> images_;
  std::map<const Attribute*, Buffer> buffers_;
  std::map<std::string, Attribute> stand_ins_;
  std::map<const Mesh*, Buffer> indices_;
  std::map<std::string, VkSampler> samplers_;

  float seconds_ = 0;
  size_t fallbacks_ = 0;
  Moment moment_;
  std::vector<Item> items_;
  Item sky_item_;
  Vec3 low_{}, high_{};             ///< of all that is drawn, in world space
  std::optional<size_t> shadowed_;  ///< of the moment's lights
  Matrix light_projection_ = kIdentity;
};

void complain(const std::string& what);

}  // namespace renderer
