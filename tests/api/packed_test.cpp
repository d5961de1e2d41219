// A packed manifest says what the contract says, is made of a folder with the same bytes, and damage does not
// lead its reader out of it.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <set>

#include "inputs.h"
#include "support/packed_walk.h"

namespace lacquer::test {
namespace {

void compareTextures(const PackedFile& packed, const lacquer_packed_use& use, const ContractUse& made,
                     const lacquer_packed_shader& shader) {
  const auto textures = packed.all<lacquer_packed_use_texture>(use.textures);
  const auto slots = packed.all<lacquer_packed_texture>(shader.textures);
  ASSERT_EQ(textures.size(), made.textures.size());
  for (size_t i = 0; i < textures.size(); ++i) {
    ASSERT_LT(textures[i].slot, slots.size());
    EXPECT_EQ(packed.text(slots[textures[i].slot].slot), made.textures[i].slot);
    EXPECT_EQ(static_cast<int>(textures[i].texture), made.textures[i].texture);
    EXPECT_EQ(static_cast<int>(textures[i].texcoord), made.textures[i].texcoord.value_or(-1));
    const TextureTransform at = made.textures[i].transform.value_or(TextureTransform{});
    EXPECT_EQ(textures[i].scale[1], static_cast<float>(at.scale[1]));
    EXPECT_EQ(textures[i].rotation, static_cast<float>(at.rotation));
    EXPECT_EQ(textures[i].stand_in != 0, made.textures[i].stand_in.has_value());
    EXPECT_EQ(packed.text(textures[i].file), made.textures[i].file);
  }
}

void compareUses(const PackedFile& packed, const lacquer_packed_material& material,
                 const ContractMaterial& made) {
  const auto uses = packed.all<lacquer_packed_use>(material.uses);
  const auto shaders = packed.all<lacquer_packed_shader>(packed.top->shaders);
  ASSERT_EQ(uses.size(), made.uses.size());
  for (size_t i = 0; i < uses.size(); ++i) {
    ASSERT_EQ(uses[i].shader, made.uses[i].shader);
    const std::string_view block = packed.bytes(uses[i].block);
    const auto& bytes = made.uses[i].block;
    ASSERT_EQ(block.size(), bytes.size());
    EXPECT_TRUE(bytes.empty() || std::memcmp(block.data(), bytes.data(), block.size()) == 0) << made.name;
    const auto parameters = packed.all<lacquer_packed_parameter>(uses[i].parameters);
    ASSERT_EQ(parameters.size(), made.uses[i].parameters.size());
    for (size_t k = 0; k < parameters.size(); ++k) {
      const UsedParameter& from = made.uses[i].parameters[k];
      EXPECT_EQ(packed.text(parameters[k].name), from.name);
      EXPECT_TRUE(from.pointer.ends_with(packed.text(parameters[k].pointer)));
      EXPECT_EQ(parameters[k].components, from.value.size());
      EXPECT_EQ(parameters[k].value[0], static_cast<float>(from.value[0]));
      EXPECT_EQ(parameters[k].animated != 0, from.animated);
    }
    compareTextures(packed, uses[i], made.uses[i], shaders.at(uses[i].shader));
    const auto fallbacks = packed.all<lacquer_packed_use>(uses[i].fallback);
    ASSERT_EQ(fallbacks.size(), made.uses[i].fallback ? 1U : 0U);
    if (fallbacks.empty()) continue;
    EXPECT_EQ(fallbacks[0].shader, made.uses[i].fallback->shader);
    EXPECT_EQ(fallbacks[0].block.count, made.uses[i].fallback->block.size());
    compareTextures(packed, fallbacks[0], *made.uses[i].fallback, shaders.at(fallbacks[0].shader));
  }
}

void compareFile(const PackedFile& packed, const lacquer_packed_file& file, const Contract& made) {
  EXPECT_EQ(packed.text(file.source), made.source);
  const auto materials = packed.all<lacquer_packed_material>(file.materials);
  std::vector<ContractMaterial> all = made.materials;
  if (made.default_material) all.push_back(*made.default_material);
  ASSERT_EQ(materials.size(), all.size());
  for (size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(packed.text(materials[i].name), all[i].name);
    EXPECT_EQ(materials[i].index, all[i].index);
    EXPECT_EQ(materials[i].pass, static_cast<uint8_t>(all[i].state.pass));
    EXPECT_EQ(materials[i].alpha_mode, static_cast<uint8_t>(all[i].state.alpha_mode));
    EXPECT_EQ(materials[i].double_sided != 0, all[i].state.double_sided);
    EXPECT_EQ(materials[i].depth_write != 0, all[i].state.depth_write);
    EXPECT_EQ(materials[i].blend[0] == 1 && materials[i].blend[1] == 0, !all[i].state.blend.has_value());
    compareUses(packed, materials[i], all[i]);
  }
  const auto primitives = packed.all<lacquer_packed_primitive>(file.primitives);
  ASSERT_EQ(primitives.size(), made.primitives.size());
  for (size_t i = 0; i < primitives.size(); ++i) {
    EXPECT_EQ(primitives[i].material, made.primitives[i].material);
    EXPECT_EQ(primitives[i].use, made.primitives[i].use.value_or(LACQUER_PACKED_NONE));
    EXPECT_EQ(packed.all<lacquer_packed_attribute>(primitives[i].attributes).size(),
              made.primitives[i].attributes.size());
    const auto variants = packed.all<lacquer_packed_variant>(primitives[i].variants);
    ASSERT_EQ(variants.size(), made.primitives[i].variants.size());
    for (size_t k = 0; k < variants.size(); ++k)
      EXPECT_EQ(packed.all<uint32_t>(variants[k].variants).size(),
                made.primitives[i].variants[k].variants.size());
  }
  const auto images = packed.all<lacquer_packed_image>(file.images);
  ASSERT_EQ(images.size(), made.images.size());
  for (size_t i = 0; i < images.size(); ++i) EXPECT_EQ(packed.text(images[i].uri), made.images[i].uri);
  EXPECT_EQ(packed.all<lacquer_packed_file_texture>(file.textures).size(), made.textures.size());
  EXPECT_EQ(packed.texts(file.variants).size(), made.variants.size());
}

void compareShader(const PackedFile& packed, const lacquer_packed_shader& shader, const Shader& made) {
  EXPECT_EQ(packed.text(shader.id), made.id());
  for (const lacquer_packed_code& code : packed.all<lacquer_packed_code>(shader.codes)) {
    Target target = Target::Glsl;
    ASSERT_TRUE(findTarget(packed.text(code.target), target));
    const bool vertex = packed.text(code.stage) == "vert";
    const auto& words = vertex ? made.vertexSpirv() : made.fragmentSpirv();
    const std::string& text = vertex ? made.vertexText(target) : made.fragmentText(target);
    const std::string_view bytes = packed.bytes(code.code);
    ASSERT_EQ(bytes.size(), target == Target::Spirv ? words.size() * 4 : text.size());
    EXPECT_EQ(std::memcmp(bytes.data(),
                          target == Target::Spirv ? static_cast<const void*>(words.data()) : text.data(),
                          bytes.size()),
              0);
    EXPECT_EQ(bytes.data()[bytes.size()], '\0');
    EXPECT_EQ((bytes.data() - reinterpret_cast<const char*>(packed.file.bytes)) % 16, 0);
  }
  const Reflection& reflection = made.reflection();
  const auto blocks = packed.all<lacquer_packed_block>(shader.blocks);
  ASSERT_EQ(blocks.size(), reflection.blocks.size());
  for (size_t i = 0; i < blocks.size(); ++i) {
    const UniformBlock& from = reflection.blocks[i];
    EXPECT_EQ(packed.text(blocks[i].name), from.name);
    EXPECT_EQ(blocks[i].place.binding, from.at.binding);
    EXPECT_EQ(blocks[i].place.set, from.at.set);
    EXPECT_EQ(blocks[i].place.stages, (from.vertex ? 1U : 0U) + (from.fragment ? 2U : 0U));
    EXPECT_NE(blocks[i].place.stages, 0U);
    EXPECT_EQ(blocks[i].size, from.size);
    const auto fields = packed.all<lacquer_packed_field>(blocks[i].fields);
    ASSERT_EQ(fields.size(), from.fields.size());
    for (size_t k = 0; k < fields.size(); ++k) {
      EXPECT_EQ(packed.text(fields[k].name), from.fields[k].name);
      EXPECT_EQ(packed.text(fields[k].type), from.fields[k].type);
      EXPECT_EQ(fields[k].offset, from.fields[k].offset);
    }
  }
  const auto textures = packed.all<lacquer_packed_texture>(shader.textures);
  ASSERT_EQ(textures.size(), reflection.textures.size());
  for (size_t i = 0; i < textures.size(); ++i) {
    const ReflectedTexture& from = reflection.textures[i];
    EXPECT_EQ(packed.text(textures[i].array), from.array);
    EXPECT_EQ(textures[i].number, from.number);
    EXPECT_EQ(textures[i].layered != 0, from.layered);
    EXPECT_EQ(textures[i].has_static_sampler != 0, from.static_sampler.has_value());
    EXPECT_EQ(textures[i].static_register, from.static_register);
    const TextureSampler sampler = from.static_sampler.value_or(TextureSampler{});
    EXPECT_EQ(textures[i].wrap_t, static_cast<uint8_t>(sampler.wrap_t));
    EXPECT_EQ(textures[i].min_filter, static_cast<uint8_t>(sampler.min_filter));
    EXPECT_EQ(textures[i].place.stages, (from.vertex ? 1U : 0U) + (from.fragment ? 2U : 0U));
  }
  EXPECT_EQ(packed.all<lacquer_packed_input>(shader.inputs).size(), reflection.inputs.size());
  EXPECT_EQ(packed.all<lacquer_packed_output>(shader.outputs).size(), reflection.outputs.size());
  EXPECT_EQ(packed.all<lacquer_packed_spec_constant>(shader.spec_constants).size(),
            reflection.spec_constants.size());
}

/// The contract of a file; `source` as its manifest has it.
Contract contractIn(const std::string& file, const Options& options, const std::string& manifest) {
  Messages messages;
  const Scene scene = Scene::load(file, options, messages);
  Contract made = contract(scene, {}, options, messages);
  made.source = sourceIn(manifest);
  return made;
}

void comparePacked(const std::string& file, const Options& options) {
  SCOPED_TRACE(file);
  const std::filesystem::path folder = emptyFolder();
  Messages messages;
  generate({file}, {}, folder.string(), options, messages);
  const Contract made = contractIn(file, options, readBytes(folder / "manifest.json"));
  const std::string path = (folder / "all.lqpm").string();
  messages.clear();
  ASSERT_TRUE(pack(folder.string(), {}, path, options, messages))
      << (messages.empty() ? "" : messages[0].text);
  const std::string bytes = readBytes(path);
  const std::string in_memory = packedManifest(made, messages);
  EXPECT_TRUE(bytes == in_memory);

  const PackedFile packed(bytes);
  ASSERT_NE(packed.top, nullptr);
  EXPECT_EQ(packed.text(packed.top->lacquer), version());
  const auto files = packed.all<lacquer_packed_file>(packed.top->files);
  ASSERT_EQ(files.size(), 1U);
  compareFile(packed, files[0], made);
  const auto shaders = packed.all<lacquer_packed_shader>(packed.top->shaders);
  ASSERT_EQ(shaders.size(), made.shaders.size());
  for (size_t i = 0; i < shaders.size(); ++i) compareShader(packed, shaders[i], made.shaders[i].shader);
}

Options forPacking() {
  Options options = quick();
  options.targets = {Target::Glsl, Target::Spirv};
  return options;
}

TEST(Packed, saysWhatTheContractSays) {
  for (const std::string& file : examples()) comparePacked(file, forPacking());
}

TEST(Packed, hasFallbacks) {
  Options options = forPacking();
  options.fallback = true;
  for (const std::string& file : examples()) comparePacked(file, options);
}

TEST(Packed, saysItWhateverTheOptions) {
  const std::string file = std::string(LACQUER_EXAMPLES) + "/coat.gltf";
  Options options = forPacking();
  options.parameters = Parameters::Spec;
  comparePacked(file, options);
  options.parameters = Parameters::Uniform;
  options.targets.insert(options.targets.end(), {Target::Wgsl, Target::Msl, Target::Hlsl});
  options.argument_buffers = true;
  comparePacked(file, options);
  options.binding = BindingModel::Arrays;
  options.static_samplers = true;
  comparePacked(std::string(LACQUER_EXAMPLES) + "/car_paint.gltf", options);
  options.binding = BindingModel::Sets;
  options.static_samplers = false;
  options.template_name = "surface";
  comparePacked(std::string(LACQUER_EXAMPLES) + "/core.gltf", options);
  options.template_name.clear();
  options.programs = 1;
  options.programs_model = true;
  comparePacked(file, options);
}

TEST(Packed, hasTheTargetsThatAreNamed) {
  const std::filesystem::path folder = emptyFolder();
  Messages messages;
  generate({std::string(LACQUER_EXAMPLES) + "/coat.gltf"}, {}, folder.string(), forPacking(), messages);
  const std::string path = (folder / "spirv.lqpm").string();
  messages.clear();
  ASSERT_TRUE(pack(folder.string(), {Target::Spirv}, path, {}, messages));
  const std::string bytes = readBytes(path);
  const PackedFile packed(bytes);
  ASSERT_NE(packed.top, nullptr);
  for (const auto& shader : packed.all<lacquer_packed_shader>(packed.top->shaders)) {
    for (const auto& code : packed.all<lacquer_packed_code>(shader.codes))
      EXPECT_EQ(packed.text(code.target), "spirv");
  }
  EXPECT_FALSE(pack(folder.string(), {Target::Hlsl}, path, {}, messages));
  EXPECT_EQ(errorsOf(messages), "no-such-target");
  messages.clear();
  EXPECT_FALSE(pack(folder.string(), {}, (folder / "manifest.json").string(), {}, messages));
  EXPECT_EQ(errorsOf(messages), "output-clash");
  messages.clear();
  EXPECT_FALSE(pack((folder / "none").string(), {}, path, {}, messages));
  EXPECT_EQ(errorsOf(messages), "file-unreadable");
  EXPECT_EQ(readBytes(path), bytes);
}

/// The shaders' files below a folder.
std::set<std::string> shadersIn(const std::filesystem::path& folder) {
  std::set<std::string> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) all.insert(entry.path().lexically_relative(folder).generic_string());
  }
  return all;
}

TEST(Packed, isWrittenInPlaceOfTheManifest) {
  const std::filesystem::path root = emptyFolder();
  const std::string coat = std::string(LACQUER_EXAMPLES) + "/coat.gltf";
  const std::string core = std::string(LACQUER_EXAMPLES) + "/core.gltf";
  Options options = forPacking();
  Messages messages;
  const auto packedBy = [&](const Strings& files, const std::string& name) {
    const std::string folder = (root / name).string(), file = (root / (name + ".lqpm")).string();
    EXPECT_TRUE(generate(files, {}, folder, options, messages).ok);
    EXPECT_TRUE(pack(folder, {}, file, options, messages));
    return readBytes(file);
  };
  const std::string both = packedBy({coat, core}, "both"), one = packedBy({coat}, "one");
  std::set<std::string> of_one = shadersIn(root / "one");
  ASSERT_EQ(of_one.erase("manifest.json"), 1U);
  options.packed = (root / "all.lqpm").string();
  const auto run = [&](const Strings& files, const std::string& folder) {
    return generate(files, {}, (root / folder).string(), options, messages).ok;
  };
  ASSERT_TRUE(run({coat, core}, "out"));
  EXPECT_TRUE(readBytes(options.packed) == both);
  EXPECT_FALSE(std::filesystem::exists(root / "out/manifest.json"));
  // What the last run needed and this one does not goes, whichever form said it.
  ASSERT_TRUE(run({coat}, "out"));
  EXPECT_TRUE(readBytes(options.packed) == one);
  EXPECT_EQ(shadersIn(root / "out"), of_one);
  ASSERT_TRUE(run({coat}, "both"));
  EXPECT_EQ(shadersIn(root / "both"), of_one);
  // A run that fails leaves what was there.
  EXPECT_FALSE(run({coat, (root / "none.gltf").string()}, "out"));
  EXPECT_TRUE(readBytes(options.packed) == one);
}

/// What lies in the file's place may be anybody's: a thousand shaders of four thousand million codes each,
/// and a hundred thousand whose one name is 16 MiB long, end the run as soon as none would.
class PackedOver : public testing::TestWithParam<bool> {};

TEST_P(PackedOver, replacesAFileWithoutAnEnd) {
  const bool long_names = GetParam();
  const std::filesystem::path root = emptyFolder();
  const std::string coat = std::string(LACQUER_EXAMPLES) + "/coat.gltf";
  Options options = forPacking();
  options.packed = (root / "all.lqpm").string();
  Messages messages;
  ASSERT_TRUE(generate({coat}, {}, (root / "out").string(), options, messages).ok);
  const std::string good = readBytes(options.packed);
  lacquer_packed_header top{};
  lacquer_packed_shader shader{};
  std::memcpy(&top, good.data(), sizeof(top));
  std::memcpy(&shader, good.data() + top.shaders.at, sizeof(shader));
  std::string hostile = good;
  if (long_names) {
    constexpr uint32_t kName = 1U << 24;
    shader.id = {static_cast<uint32_t>(hostile.size()), kName};
    hostile.append(kName, 'a').push_back('\0');
  } else {
    shader.codes.count = 0xffffffff;
  }
  const uint32_t shaders = long_names ? 100'000 : 1000;
  hostile.resize((hostile.size() + 15) / 16 * 16);
  top.shaders = {static_cast<uint32_t>(hostile.size()), shaders};
  for (uint32_t i = 0; i < shaders; ++i)
    hostile.append(reinterpret_cast<const char*>(&shader), sizeof(shader));
  top.size = static_cast<uint32_t>(hostile.size());
  std::memcpy(hostile.data(), &top, sizeof(top));
  std::ofstream(options.packed, std::ios::binary) << hostile;
  EXPECT_TRUE(generate({coat}, {}, (root / "out").string(), options, messages).ok);
  EXPECT_TRUE(readBytes(options.packed) == good);
}

INSTANTIATE_TEST_SUITE_P(All, PackedOver, testing::Bool());

TEST(Packed, isWrittenByAMerge) {
  const std::filesystem::path root = emptyFolder();
  const Options options = forPacking();
  Messages messages;
  Strings manifests;
  for (const std::string name : {"coat", "core"}) {
    const std::filesystem::path folder = root / name;
    ASSERT_TRUE(generate({std::string(LACQUER_EXAMPLES) + "/" + name + ".gltf"}, {}, folder.string(), options,
                         messages)
                    .ok);
    std::filesystem::copy(
        folder, root / "all",
        std::filesystem::copy_options::recursive | std::filesystem::copy_options::skip_existing);
    manifests.push_back((folder / "manifest.json").string());
  }
  const std::string folder = (root / "all").string(), file = (root / "merged.lqpm").string();
  std::filesystem::remove(root / "all/manifest.json");
  ASSERT_TRUE(merge(manifests, folder, messages, file)) << messages.back().text;
  EXPECT_FALSE(std::filesystem::exists(root / "all/manifest.json"));
  ASSERT_TRUE(merge(manifests, folder, messages));
  const std::string packed = (root / "packed.lqpm").string();
  ASSERT_TRUE(pack(folder, {}, packed, options, messages));
  EXPECT_TRUE(readBytes(file) == readBytes(packed));
  // A shader whose code is not in the folder is said, and nothing is written.
  std::filesystem::remove_all(root / "all/glsl");
  messages.clear();
  EXPECT_FALSE(merge(manifests, folder, messages, file));
  EXPECT_EQ(errorsOf(messages), "file-unreadable");
  EXPECT_TRUE(readBytes(file) == readBytes(packed));
}

/// A manifest may be anybody's.
TEST(Packed, isNotMadeOfASizeThatNoBlockHas) {
  const std::filesystem::path folder = emptyFolder();
  Messages messages;
  generate({std::string(LACQUER_EXAMPLES) + "/coat.gltf"}, {}, folder.string(), forPacking(), messages);
  std::string manifest = readBytes(folder / "manifest.json");
  const size_t block = manifest.find("\"role\": \"material\"");
  const size_t size = manifest.find("\"size\": ", block) + std::strlen("\"size\": ");
  ASSERT_NE(block, std::string::npos);
  manifest.replace(size, manifest.find(',', size) - size, "4294967280");
  std::ofstream(folder / "manifest.json", std::ios::binary) << manifest;
  messages.clear();
  EXPECT_FALSE(pack(folder.string(), {}, (folder / "all.lqpm").string(), {}, messages));
  EXPECT_EQ(errorsOf(messages), "too-large");
}

/// The folder may be anybody's, too: a link in it must not bring another file into the pack.
TEST(Packed, takesNoCodeFromOutsideOfTheFolder) {
  const std::filesystem::path folder = emptyFolder();
  Messages messages;
  generate({std::string(LACQUER_EXAMPLES) + "/coat.gltf"}, {}, (folder / "out").string(), forPacking(),
           messages);
  std::ofstream(folder / "secret") << "secret";
  const std::filesystem::path code = std::filesystem::directory_iterator(folder / "out/glsl")->path();
  std::filesystem::remove(code);
  std::filesystem::create_symlink(folder / "secret", code);
  messages.clear();
  EXPECT_FALSE(pack((folder / "out").string(), {}, (folder / "all.lqpm").string(), {}, messages));
  EXPECT_EQ(errorsOf(messages), "manifest-outside");
}

/// Small enough to damage each of its bytes.
std::string smallBytes() {
  Options options = quick();
  options.template_name = "depth";
  Messages messages;
  const Scene scene = paintScene();
  return packedManifest(contract(scene, {}, options, messages), messages);
}

TEST(Packed, isRefusedWhereItIsNotWhole) {
  const std::string bytes = smallBytes();
  ASSERT_NE(PackedFile(bytes).top, nullptr);
  for (size_t size = 0; size < bytes.size(); ++size)
    ASSERT_EQ(PackedFile(std::string_view(bytes).substr(0, size)).top, nullptr) << size;
  std::string other = bytes;
  other[4] = LACQUER_PACKED_VERSION + 1;
  EXPECT_EQ(PackedFile(other).top, nullptr);
  std::vector<uint64_t> memory(bytes.size() / 8 + 2);
  char* const shifted = reinterpret_cast<char*>(memory.data()) + 4;
  std::memcpy(shifted, bytes.data(), bytes.size());
  lacquer_packed file;
  EXPECT_EQ(lacquer_packed_open(&file, shifted, bytes.size()), nullptr);
}

TEST(Packed, keepsItsReaderWithinWhateverTheDamage) {
  const std::string bytes = smallBytes();
  const PackedFile packed_whole(bytes);
  const std::optional<uint64_t> whole = PackedWalk(packed_whole).sum();
  ASSERT_TRUE(whole);
  size_t noticed = 0;
  for (size_t at = sizeof(lacquer_packed_header) - 24; at < bytes.size(); ++at) {
    for (const unsigned char flip : {0x01, 0x80, 0xff}) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(static_cast<unsigned char>(damaged[at]) ^ flip);
      const PackedFile packed(damaged);
      const std::optional<uint64_t> sum = PackedWalk(packed, size_t{1} << 16).sum();
      if (sum != whole) ++noticed;
    }
  }
  EXPECT_GT(noticed, bytes.size());
}

}  // namespace
}  // namespace lacquer::test
