// lacquer/vulkan.h fills Vulkan's structs as docs/bindings.md says.
#include <gtest/gtest.h>
#include <lacquer/vulkan.h>

#include <memory>
#include <utility>

#include "inputs.h"

namespace lacquer::test {
namespace {

/// A material with textures on a mesh with everything.
const char* const kFile = R"({"asset": {"version": "2.0"}, "images": [{"uri": "n.png"}],
"extensionsUsed": ["KHR_materials_transmission"], "textures": [{"source": 0}],
"materials": [{"doubleSided": true, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "roughnessFactor": 0.5},
  "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}},
  {"pbrMetallicRoughness": {"roughnessFactor": 0.25}}]})";

Shader shaderOf(const std::string& template_name, size_t material = 0,
                Parameters parameters = Parameters::Uniform) {
  Options options = quick();
  options.targets = {Target::Spirv};
  options.template_name = template_name;
  options.parameters = parameters;
  Messages messages;
  Attributes attributes;
  attributes.texCoord[0] = true;
  attributes.skin[0] = attributes.morph = attributes.instances = true;
  const Scene scene = Scene::fromMemory(kFile, "file.gltf", options, messages);
  Shader shader = scene.graph(material, attributes, options, messages).generate(options, messages);
  EXPECT_EQ(errorsOf(messages), "");
  return shader;
}

float floatAt(const std::vector<unsigned char>& bytes, size_t at) {
  float x = 0;
  EXPECT_LE(at + 4, bytes.size());
  std::memcpy(&x, &bytes[at], 4);
  return x;
}

TEST(Vulkan, SetLayoutsHaveAllThatIsRead) {
  const Shader shader = shaderOf("forward_clustered");
  vk::SetLayouts layouts;
  EXPECT_TRUE(layouts.add(shader.reflection()));
  EXPECT_TRUE(layouts.add(shader.reflection())) << "twice is once";
  size_t bindings = 0;
  for (uint32_t set = 0; set < vk::kSets; ++set) {
    const VkDescriptorSetLayoutCreateInfo info = layouts.info(set);
    bindings += info.bindingCount;
    for (uint32_t i = 1; i < info.bindingCount; ++i)
      EXPECT_LT(info.pBindings[i - 1].binding, info.pBindings[i].binding);
  }
  EXPECT_EQ(bindings, shader.reflection().blocks.size() + shader.reflection().textures.size());
  const auto typeOf = [&](const BindingPoint& at) {
    for (const auto& binding : layouts.sets[at.set]) {
      if (binding.binding == at.binding) return binding.descriptorType;
    }
    return VK_DESCRIPTOR_TYPE_MAX_ENUM;
  };
  EXPECT_EQ(typeOf(vk::findBlock(shader.reflection(), "Frame")->at), VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
  EXPECT_EQ(typeOf(vk::findBlock(shader.reflection(), "Clusters")->at), VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  EXPECT_EQ(typeOf(vk::findTexture(shader.reflection(), "scene_behind")->at),
            VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
  EXPECT_EQ(vk::findBlock(shader.reflection(), "Nothing"), nullptr);
  uint32_t sized = 0;
  for (const VkDescriptorPoolSize& size : layouts.poolSizes(vk::kObjectSet, 3)) sized += size.descriptorCount;
  EXPECT_EQ(sized, 3 * layouts.info(vk::kObjectSet).bindingCount);
}

TEST(Vulkan, DynamicBlocksAreThoseThatAreAskedFor) {
  vk::SetLayouts layouts;
  const Shader shader = shaderOf("forward");
  EXPECT_TRUE(layouts.add(shader.reflection(), {true, true}));
  EXPECT_EQ(layouts.sets[vk::kMaterialSet][0].descriptorType, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC);
  EXPECT_EQ(layouts.sets[vk::kObjectSet][0].descriptorType, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC);
  EXPECT_EQ(layouts.sets[vk::kFrameSet][0].descriptorType, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
}

/// What objects are given has one place in all templates for meshes, so that one set does for all passes.
TEST(Vulkan, TemplatesShareTheObjectsSet) {
  vk::SetLayouts layouts;
  for (const char* name : {"forward", "forward_clustered", "surface", "depth", "shadow", "sky"}) {
    EXPECT_TRUE(layouts.add(shaderOf(name).reflection(), {}, vk::kObjectSet, vk::kObjectSet)) << name;
  }
  // What only they have stands behind it.
  vk::SetLayouts own = layouts;
  EXPECT_TRUE(own.add(shaderOf("motion").reflection(), {}, vk::kObjectSet, vk::kObjectSet));
  own = layouts;
  EXPECT_TRUE(own.add(shaderOf("id").reflection(), {}, vk::kObjectSet, vk::kObjectSet));
  // The frames' sets are each template's own.
  vk::SetLayouts frames;
  EXPECT_TRUE(frames.add(shaderOf("forward").reflection(), {}, vk::kFrameSet, vk::kFrameSet));
  EXPECT_FALSE(frames.add(shaderOf("forward_clustered").reflection(), {}, vk::kFrameSet, vk::kFrameSet));
}

TEST(Vulkan, CopiedLayoutsPointToTheirOwnSamplers) {
  Reflection reflection;
  for (const uint32_t binding : {0U, 1U, 2U}) {
    ReflectedTexture& texture = reflection.textures.emplace_back();
    texture.name = std::string(1, static_cast<char>('a' + binding));
    texture.at = {vk::kMaterialSet, binding};
    texture.static_sampler = TextureSampler{};
    if (binding == 2) texture.static_sampler->wrap_s = Wrap::Clamp;
  }
  uintptr_t made = 0;
  const auto make = [&](const VkSamplerCreateInfo&) { return reinterpret_cast<VkSampler>(++made); };
  const auto samplersOf = [](const vk::SetLayouts& layouts) {
    std::vector<const VkSampler*> samplers;
    for (const auto& binding : layouts.sets[vk::kMaterialSet]) samplers.push_back(binding.pImmutableSamplers);
    return samplers;
  };
  auto original = std::make_unique<vk::SetLayouts>();
  EXPECT_TRUE(original->add(reflection));
  EXPECT_TRUE(original->fixSamplers(reflection, make));
  const vk::SetLayouts copy(*original);
  vk::SetLayouts assigned;
  assigned = *original;
  const std::vector<const VkSampler*> before = samplersOf(*original);
  for (const vk::SetLayouts* one : {&copy, &std::as_const(assigned)}) {
    const std::vector<const VkSampler*> own = samplersOf(*one);
    ASSERT_EQ(own.size(), 3U);
    EXPECT_EQ(own[0], own[1]);
    for (size_t i = 0; i < own.size(); ++i) EXPECT_NE(own[i], before[i]) << i;
  }
  original.reset();  // the sanitizers see what still points there
  for (const vk::SetLayouts* one : {&copy, &std::as_const(assigned)}) {
    EXPECT_EQ(reinterpret_cast<uintptr_t>(*samplersOf(*one)[0]), 1U);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(*samplersOf(*one)[2]), 2U);
  }
  EXPECT_TRUE(assigned.fixSamplers(reflection, make)) << "they are known there, too";
  EXPECT_EQ(made, 2U);
  const vk::SetLayouts moved(std::move(assigned));
  EXPECT_EQ(reinterpret_cast<uintptr_t>(*samplersOf(moved)[2]), 2U);
}

TEST(Vulkan, BlocksHaveTheirFieldsAtTheirOffsets) {
  const Shader shader = shaderOf("forward");
  const UniformBlock& frame = *vk::findBlock(shader.reflection(), "Frame");
  vk::BlockBytes bytes(frame);
  EXPECT_EQ(bytes.bytes().size(), 96U);
  EXPECT_TRUE(bytes.set("camera_position", std::array<float, 3>{1, 2, 3}));
  EXPECT_TRUE(bytes.set("environment_max_lod", 5.0F));
  EXPECT_TRUE(bytes.set("light_count", int32_t{2}));
  EXPECT_EQ(floatAt(bytes.bytes(), 68), 2);
  EXPECT_EQ(floatAt(bytes.bytes(), 80), 5);
  EXPECT_EQ(bytes.bytes()[84], 2);
  EXPECT_FALSE(bytes.set("no_such_field", 1.0F));
  EXPECT_FALSE(bytes.set("camera_position", std::array<float, 4>{})) << "more than it takes";
  EXPECT_FALSE(bytes.set("camera_position", std::array<float, 3>{}, 1)) << "there is one element";
  const UniformBlock& lights = *vk::findBlock(shader.reflection(), "Lights");
  EXPECT_EQ(vk::BlockBytes(lights).bytes().size(), 1024U);
  const UniformBlock& morph = *vk::findBlock(shader.reflection(), "Morph");
  vk::BlockBytes of_morph(morph);
  EXPECT_TRUE(of_morph.set("weights", std::array<float, 4>{1, 2, 3, 4}, 0, 1));
  EXPECT_EQ(floatAt(of_morph.bytes(), 16), 1);
  EXPECT_FALSE(of_morph.set("weights", std::array<float, 4>{}, 0, 2));
}

TEST(Vulkan, LightsFillTheirElements) {
  const Shader shader = shaderOf("forward");
  vk::BlockBytes bytes(*vk::findBlock(shader.reflection(), "Lights"));
  vk::PunctualLight sun;
  sun.direction = {0, -1, 0};
  sun.intensity = 3;
  vk::setLight(bytes, 0, sun);
  EXPECT_EQ(floatAt(bytes.bytes(), 4), 1) << "towards it";
  EXPECT_EQ(floatAt(bytes.bytes(), 12), 0);
  EXPECT_EQ(floatAt(bytes.bytes(), 16), 3);
  EXPECT_EQ(floatAt(bytes.bytes(), 48), 1) << "no cone";
  vk::PunctualLight spot;
  spot.kind = vk::PunctualLight::Kind::Spot;
  spot.position = {1, 2, 3};
  spot.range = 2;
  spot.inner_cone_angle = 0.2F;
  spot.outer_cone_angle = 0.5F;
  vk::setLight(bytes, 1, spot);
  EXPECT_EQ(floatAt(bytes.bytes(), 64 + 8), 3);
  EXPECT_EQ(floatAt(bytes.bytes(), 64 + 12), 1);
  EXPECT_EQ(floatAt(bytes.bytes(), 64 + 28), 1.0F / 16);
  const float scale = 1 / (std::cos(0.2F) - std::cos(0.5F));
  EXPECT_FLOAT_EQ(floatAt(bytes.bytes(), 64 + 44), scale);
  EXPECT_FLOAT_EQ(floatAt(bytes.bytes(), 64 + 48), -std::cos(0.5F) * scale);
}

TEST(Vulkan, NormalsGoThroughTheInverseTranspose) {
  const vk::Matrix stretched{2, 0, 0, 0, 0, 4, 0, 0, 0, 0, -1, 0, 5, 6, 7, 1};
  const vk::Matrix normal = vk::normalMatrix(stretched);
  EXPECT_FLOAT_EQ(normal[0], 0.5F);
  EXPECT_FLOAT_EQ(normal[5], 0.25F);
  EXPECT_FLOAT_EQ(normal[10], -1);
  EXPECT_FLOAT_EQ(normal[12], 0);
  EXPECT_TRUE(vk::mirrors(stretched));
  const vk::Matrix sheared{1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_FALSE(vk::mirrors(sheared));
  EXPECT_FLOAT_EQ(vk::normalMatrix(sheared)[1], -1);
  // Flat: the cofactors.
  const vk::Matrix flat{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  EXPECT_FLOAT_EQ(vk::normalMatrix(flat)[10], 1);
}

TEST(Vulkan, PointsAreFoundOnPictures) {
  // Clip space: x / w and y / w from -1 to 1.
  const vk::Matrix projection{2, 0, 0, 0, 0, -2, 0, 0, 0, 0, -1, -1, 0, 0, -0.1F, 0};
  const auto at = [](const std::array<float, 4>& row, float x, float y, float z) {
    return row[0] * x + row[1] * y + row[2] * z + row[3];
  };
  for (const bool flipped : {false, true}) {
    const vk::PictureRows rows = vk::pictureRows(projection, flipped);
    const float w = at(rows.w, 0.25F, 0.5F, -2);
    EXPECT_FLOAT_EQ(w, 2);
    EXPECT_FLOAT_EQ(at(rows.u, 0.25F, 0.5F, -2) / w, 0.625F);
    EXPECT_FLOAT_EQ(at(rows.v, 0.25F, 0.5F, -2) / w, flipped ? 0.75F : 0.25F);
    EXPECT_FLOAT_EQ(at(rows.z, 0.25F, 0.5F, -2) / w, 0.95F);
  }
}

TEST(Vulkan, MorphTakesTheWeightsThatCountMost) {
  const Shader shader = shaderOf("depth");
  vk::BlockBytes bytes(*vk::findBlock(shader.reflection(), "Morph"));
  vk::setMorph(bytes, {0, 0.1F, -0.9F, 0, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.7F}, 32, 4);
  const float weights[] = {-0.9F, 0.7F, 0.6F, 0.5F, 0.4F, 0.3F, 0.2F, 0.1F};
  const float targets[] = {2, 9, 8, 7, 6, 5, 4, 1};
  for (size_t i = 0; i < 8; ++i) {
    EXPECT_FLOAT_EQ(floatAt(bytes.bytes(), 4 * i), weights[i]);
    EXPECT_FLOAT_EQ(floatAt(bytes.bytes(), 32 + 4 * i), targets[i]);
  }
  EXPECT_EQ(floatAt(bytes.bytes(), 64), 32);
  const std::vector<float> rows = vk::jointTexels({{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}});
  EXPECT_EQ(rows, (std::vector<float>{1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15, 0, 0, 0, 0}));
}

TEST(Vulkan, VertexFormats) {
  const auto of = [](const char* type, const char* component, bool normalized, const char* semantic = "X") {
    return vk::vertexStream({semantic, type, component, normalized});
  };
  EXPECT_EQ(of("VEC3", "FLOAT", false).format, VK_FORMAT_R32G32B32_SFLOAT);
  EXPECT_EQ(of("VEC3", "FLOAT", false).stride, 12U);
  EXPECT_EQ(of("VEC3", "SHORT", false).format, VK_FORMAT_R16G16B16A16_SNORM);
  EXPECT_EQ(of("VEC3", "SHORT", false).scale, 32767);
  EXPECT_EQ(of("VEC3", "SHORT", false).stride, 8U);
  EXPECT_EQ(of("VEC3", "BYTE", true).stride, 4U);
  EXPECT_EQ(of("VEC3", "BYTE", true).scale, 1);
  EXPECT_EQ(of("VEC4", "UNSIGNED_BYTE", false).scale, 255);
  EXPECT_EQ(of("VEC2", "UNSIGNED_SHORT", true).format, VK_FORMAT_R16G16_UNORM);
  EXPECT_EQ(of("VEC3", "UNSIGNED_BYTE", true, "COLOR_0").format, VK_FORMAT_UNDEFINED)
      << "its alpha is not there";
  EXPECT_EQ(of("VEC4", "UNSIGNED_BYTE", true, "COLOR_0").format, VK_FORMAT_R8G8B8A8_UNORM);
  EXPECT_EQ(of("VEC4", "UNSIGNED_INT", false).format, VK_FORMAT_UNDEFINED);
  EXPECT_EQ(of("MAT4", "FLOAT", false).stride, 4U) << "no attribute of glTF";
  EXPECT_EQ(of("", "FLOAT", false).format, VK_FORMAT_R32_SFLOAT);
}

/// Integers for an input of integers, and none where the bits would be another number.
TEST(Vulkan, VertexFormatsOfIntegers) {
  const auto of = [](const char* type, const char* component, const char* input, bool normalized = false) {
    return vk::vertexStream({"_KIND", type, component, normalized}, {"_KIND", input, 9});
  };
  EXPECT_EQ(of("SCALAR", "UNSIGNED_SHORT", "uint").format, VK_FORMAT_R16_UINT);
  EXPECT_EQ(of("SCALAR", "UNSIGNED_SHORT", "uint").stride, 4U);
  EXPECT_EQ(of("SCALAR", "UNSIGNED_SHORT", "uint").scale, 1);
  EXPECT_EQ(of("SCALAR", "SHORT", "int").format, VK_FORMAT_R16_SINT);
  EXPECT_EQ(of("VEC3", "BYTE", "ivec3").format, VK_FORMAT_R8G8B8A8_SINT);
  EXPECT_EQ(of("VEC2", "UNSIGNED_INT", "uvec2").format, VK_FORMAT_R32G32_UINT);
  EXPECT_EQ(of("VEC3", "UNSIGNED_INT", "uvec3").stride, 12U);
  EXPECT_EQ(of("SCALAR", "UNSIGNED_SHORT", "int").format, VK_FORMAT_UNDEFINED) << "another sign";
  EXPECT_EQ(of("SCALAR", "FLOAT", "int").format, VK_FORMAT_UNDEFINED);
  EXPECT_EQ(of("SCALAR", "UNSIGNED_SHORT", "uint", true).format, VK_FORMAT_UNDEFINED);
  EXPECT_EQ(of("SCALAR", "UNSIGNED_SHORT", "float").format, VK_FORMAT_R16_UNORM);
  EXPECT_EQ(vk::wideFormat({"_KIND", "int", 9}), VK_FORMAT_R32G32B32A32_SINT);
  EXPECT_EQ(vk::wideFormat({"_KIND", "uvec2", 9}), VK_FORMAT_R32G32B32A32_UINT);
  EXPECT_EQ(vk::wideFormat({"_KIND", "vec2", 9}), VK_FORMAT_R32G32B32A32_SFLOAT);
}

TEST(Vulkan, VertexInputHasABindingForEachInput) {
  const Shader shader = shaderOf("forward");
  const vk::VertexInput input(shader.reflection(), [](const ShaderInput& of) -> vk::VertexStream {
    if (of.name == "SCALE") return {VK_FORMAT_R32G32B32A32_SFLOAT, 0, 1};
    return {VK_FORMAT_R32G32B32A32_SFLOAT, 16, 1};
  });
  const VkPipelineVertexInputStateCreateInfo info = input.info();
  ASSERT_EQ(info.vertexBindingDescriptionCount, shader.reflection().inputs.size());
  for (uint32_t i = 0; i < info.vertexBindingDescriptionCount; ++i) {
    const ShaderInput& of = shader.reflection().inputs[i];
    EXPECT_EQ(info.pVertexAttributeDescriptions[i].location, of.location);
    EXPECT_EQ(info.pVertexAttributeDescriptions[i].binding, i);
    const bool instance = of.name == "TRANSLATION" || of.name == "ROTATION";
    EXPECT_EQ(info.pVertexBindingDescriptions[i].inputRate == VK_VERTEX_INPUT_RATE_INSTANCE, instance)
        << of.name;
  }
  EXPECT_EQ(vk::standIn("ROTATION")[3], 1);
  EXPECT_EQ(vk::standIn("SCALE")[0], 1);
  EXPECT_EQ(vk::standIn("TEXCOORD_0")[0], 0);
}

TEST(Vulkan, NumbersAsSpecializationConstants) {
  Options options = quick();
  options.targets = {Target::Spirv};
  options.parameters = Parameters::Spec;
  Messages messages;
  const Contract made =
      contract(Scene::fromMemory(kFile, "file.gltf", options, messages), {}, options, messages);
  const Drawn drawn = made.drawn(1, 0);
  ASSERT_TRUE(drawn);
  const vk::Specialization numbers(drawn.shader->shader.reflection(), drawn.use->parameters);
  const VkSpecializationInfo info = numbers.info();
  ASSERT_GT(info.mapEntryCount, 0U);
  EXPECT_EQ(info.dataSize, 4 * numbers.data.size());
  bool found = false;
  for (const SpecConstant& constant : drawn.shader->shader.reflection().spec_constants) {
    if (constant.name != "roughness_factor") continue;
    for (uint32_t i = 0; i < info.mapEntryCount; ++i) {
      if (info.pMapEntries[i].constantID != constant.id) continue;
      float x = 0;
      std::memcpy(&x, static_cast<const char*>(info.pData) + info.pMapEntries[i].offset, 4);
      EXPECT_EQ(x, 0.25F);
      found = true;
    }
  }
  EXPECT_TRUE(found);
  EXPECT_EQ(vk::Specialization(shaderOf("forward").reflection(), {}).info().mapEntryCount, 0U);
}

TEST(Vulkan, SamplersAreTheFiles) {
  TextureSampler from;
  EXPECT_EQ(vk::samplerInfo(from).mipmapMode, VK_SAMPLER_MIPMAP_MODE_LINEAR);
  EXPECT_EQ(vk::samplerInfo(from).maxLod, VK_LOD_CLAMP_NONE);
  from = {Wrap::Clamp, Wrap::Mirror, Filter::Nearest, Filter::NearestMipmapLinear};
  VkSamplerCreateInfo info = vk::samplerInfo(from);
  EXPECT_EQ(info.addressModeU, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  EXPECT_EQ(info.addressModeV, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT);
  EXPECT_EQ(info.magFilter, VK_FILTER_NEAREST);
  EXPECT_EQ(info.minFilter, VK_FILTER_NEAREST);
  EXPECT_EQ(info.mipmapMode, VK_SAMPLER_MIPMAP_MODE_LINEAR);
  from.min_filter = Filter::LinearMipmapNearest;
  info = vk::samplerInfo(from);
  EXPECT_EQ(info.minFilter, VK_FILTER_LINEAR);
  EXPECT_EQ(info.mipmapMode, VK_SAMPLER_MIPMAP_MODE_NEAREST);
  from.min_filter = Filter::Linear;
  EXPECT_EQ(vk::samplerInfo(from).maxLod, 0.25F);
  const Shader shader = shaderOf("forward");
  EXPECT_EQ(vk::samplerInfo(*vk::findTexture(shader.reflection(), "joint_matrices")).magFilter,
            VK_FILTER_NEAREST);
  EXPECT_EQ(vk::samplerInfo(*vk::findTexture(shader.reflection(), "environment_specular")).magFilter,
            VK_FILTER_LINEAR);
  EXPECT_EQ(vk::viewType(*vk::findTexture(shader.reflection(), "environment_specular")),
            VK_IMAGE_VIEW_TYPE_CUBE);
  EXPECT_EQ(vk::viewType(*vk::findTexture(shader.reflection(), "morph_deltas")), VK_IMAGE_VIEW_TYPE_2D_ARRAY);
  EXPECT_EQ(vk::textureFormat(true), VK_FORMAT_R8G8B8A8_SRGB);
}

TEST(Vulkan, StatesAreTheMaterials) {
  DrawState state;
  vk::PipelineStates plain({}, state, false, 1);
  EXPECT_EQ(plain.raster.cullMode, static_cast<VkCullModeFlags>(VK_CULL_MODE_BACK_BIT));
  EXPECT_EQ(plain.raster.frontFace, VK_FRONT_FACE_COUNTER_CLOCKWISE);
  EXPECT_EQ(plain.depth.depthWriteEnable, VK_TRUE);
  EXPECT_EQ(plain.blends[0].blendEnable, VK_FALSE);
  state.double_sided = true;
  state.depth_write = false;
  state.blend.emplace();
  vk::PipelineStates blended({}, state, true, 1);
  EXPECT_EQ(blended.raster.cullMode, static_cast<VkCullModeFlags>(VK_CULL_MODE_NONE));
  EXPECT_EQ(blended.raster.frontFace, VK_FRONT_FACE_CLOCKWISE);
  EXPECT_EQ(blended.depth.depthWriteEnable, VK_FALSE);
  EXPECT_EQ(blended.blends[0].blendEnable, VK_TRUE);
  EXPECT_EQ(blended.blends[0].srcColorBlendFactor, VK_BLEND_FACTOR_SRC_ALPHA);
  EXPECT_EQ(blended.blends[0].dstAlphaBlendFactor, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA);
  blended.setStages(VK_NULL_HANDLE, VK_NULL_HANDLE);
  EXPECT_EQ(blended.info.stageCount, 1U) << "depth alone";
  EXPECT_EQ(blended.info.pColorBlendState->attachmentCount, 1U);
}

TEST(Vulkan, FramesAreDrawnInOrder) {
  const auto before = [](Pass a, float at, Pass b, float bt) { return vk::drawnBefore({a, at}, {b, bt}); };
  EXPECT_TRUE(before(Pass::Opaque, 9, Pass::Masked, 1));
  EXPECT_TRUE(before(Pass::Masked, 1, Pass::LooksThrough, 9));
  EXPECT_TRUE(before(Pass::LooksThrough, 1, Pass::Blended, 9));
  EXPECT_TRUE(before(Pass::Opaque, 1, Pass::Opaque, 2)) << "from front to back";
  EXPECT_TRUE(before(Pass::Blended, 2, Pass::Blended, 1)) << "from back to front";
  EXPECT_FALSE(before(Pass::Blended, 1, Pass::Blended, 1));
}

}  // namespace
}  // namespace lacquer::test
