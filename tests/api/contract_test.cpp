// A file's contract in memory is what generate() writes into a folder, byte for byte.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <set>
#include <sstream>

#include "inputs.h"

namespace lacquer::test {
namespace {

std::string bytesOf(const std::vector<uint32_t>& words) {
  std::string bytes;
  for (const uint32_t word : words) {
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift & 0xFF);
  }
  return bytes;
}

/// What is read of a manifest's file are the values that it was written of.
void compareRead(const std::filesystem::path& path, const std::string& text, const Contract& made) {
  Messages messages;
  const std::optional<Manifest> read = readManifest(path.string(), {}, messages);
  ASSERT_TRUE(read) << (messages.empty() ? "" : messages[0].text);
  EXPECT_EQ(manifestJson(*read), text);
  ASSERT_EQ(read->files.size(), 1U);
  ASSERT_EQ(read->files[0].materials.size(), made.materials.size());
  for (size_t i = 0; i < made.materials.size(); ++i) {
    const ContractMaterial &a = read->files[0].materials[i], &b = made.materials[i];
    EXPECT_EQ(a.state.pass, b.state.pass);
    EXPECT_EQ(a.state.blend, b.state.blend);
    EXPECT_EQ(a.terms->terms, b.terms->terms);
    EXPECT_EQ(a.messages.size(), b.messages.size());
    ASSERT_EQ(a.uses.size(), b.uses.size());
    for (size_t k = 0; k < a.uses.size(); ++k) {
      EXPECT_EQ(read->shaders.at(a.uses[k].shader).id, made.shaders.at(b.uses[k].shader).shader.id());
      EXPECT_EQ(a.uses[k].attributes.texCoord, b.uses[k].attributes.texCoord);
      EXPECT_EQ(a.uses[k].attributes.skin, b.uses[k].attributes.skin);
      EXPECT_EQ(a.uses[k].uniforms, b.uses[k].uniforms);
      EXPECT_EQ(a.uses[k].shares_program, b.uses[k].shares_program);
      ASSERT_EQ(a.uses[k].textures.size(), b.uses[k].textures.size());
      for (size_t t = 0; t < a.uses[k].textures.size(); ++t) {
        EXPECT_EQ(a.uses[k].textures[t].srgb, b.uses[k].textures[t].srgb);
        EXPECT_EQ(a.uses[k].textures[t].transform, b.uses[k].textures[t].transform);
      }
    }
  }
}

/// Compares the manifest and every file of a shader.
void compare(const std::string& file, const Options& options) {
  SCOPED_TRACE(file);
  const std::filesystem::path folder = emptyFolder();
  Messages messages, in_memory;
  generate({file}, {}, folder.string(), options, messages);
  const Scene scene = Scene::load(file, options, in_memory);
  ASSERT_TRUE(scene);
  const Contract made = contract(scene, {}, options, in_memory);
  const std::string manifest = readBytes(folder / "manifest.json");
  EXPECT_EQ(manifestJson(made, sourceIn(manifest)), manifest);
  compareRead(folder / "manifest.json", manifest, made);
  for (const ContractShader& one : made.shaders) {
    const std::string stem = one.shader.id();
    EXPECT_EQ(one.shader.fragmentText(Target::Glsl), readBytes(folder / "glsl" / (stem + ".frag.glsl")));
    EXPECT_EQ(bytesOf(one.shader.fragmentSpirv()), readBytes(folder / "spirv" / (stem + ".frag.spv")));
    EXPECT_EQ(bytesOf(one.shader.vertexSpirv()), readBytes(folder / "spirv" / (stem + ".vert.spv")));
  }
  const auto codes = [](const Messages& of) {
    std::multiset<std::string> all;
    for (const Message& message : of) all.insert(message.code + message.pointer);
    return all;
  };
  EXPECT_EQ(codes(in_memory), codes(messages));
}

Options forContract() {
  Options options = quick();
  options.targets = {Target::Glsl, Target::Spirv};
  return options;
}

TEST(Contract, OfTheExamplesIsTheManifest) {
  for (const std::string& file : examples()) compare(file, forContract());
}

TEST(Contract, OfTheExamplesIsTheManifestWhateverTheOptions) {
  const std::string file = std::string(LACQUER_EXAMPLES) + "/coat.gltf";
  Options options = forContract();
  options.parameters = Parameters::Spec;
  compare(file, options);
  options.parameters = Parameters::Baked;
  compare(file, options);
  options.parameters = Parameters::Uniform;
  options.targets.insert(options.targets.end(), {Target::Wgsl, Target::Msl, Target::Cpp});
  compare(file, options);
  options.argument_buffers = true;
  compare(file, options);
  options.template_name = "surface";
  compare(std::string(LACQUER_EXAMPLES) + "/core.gltf", options);
  options.template_name.clear();
  options.programs = 1;
  options.programs_model = true;
  compare(file, options);
  options.programs = 0;
  options.validate = true;
  options.cache = (emptyFolder() / "cache").string();
  compare(file, options);
  options.cache = (std::filesystem::temp_directory_path() / "lacquer_contract_cache").string();
  std::filesystem::remove_all(options.cache);
  compare(file, options);
  compare(file, options);  // from the cache
  std::filesystem::remove_all(options.cache);
}

/// Everything that a file may have beside materials.
const char* const kRich = R"({"asset": {"version": "2.0"},
"extensionsUsed": ["KHR_materials_variants", "KHR_mesh_quantization", "KHR_texture_transform",
                   "KHR_texture_basisu", "KHR_materials_transmission", "KHR_materials_ior"],
"extensionsRequired": ["KHR_mesh_quantization"],
"extensions": {"KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}},
"accessors": [{"componentType": 5122, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
  {"componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"},
  {"componentType": 5126, "count": 3, "type": "VEC2"}, {"componentType": 5121, "count": 3, "type": "VEC4"}],
"images": [{"uri": "a.png"}, {"uri": "a.ktx2", "mimeType": "image/ktx2"}],
"samplers": [{"wrapS": 33071, "minFilter": 9985}],
"textures": [{"source": 0, "sampler": 0, "extensions": {"KHR_texture_basisu": {"source": 1}}}],
"meshes": [{"primitives": [
  {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "JOINTS_0": 3}, "material": 0,
   "targets": [{"POSITION": 0}],
   "extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [1]}]}}},
  {"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 0},
  {"attributes": {"POSITION": 0, "NORMAL": 1}},
  {"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 3},
  {"attributes": {"POSITION": 0}, "material": 2}]}],
"materials": [
  {"name": "Leaf", "alphaMode": "MASK", "doubleSided": true, "pbrMetallicRoughness": {"baseColorTexture":
    {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.25, 0], "rotation": 1}}}}},
  {"name": "Ghost", "alphaMode": "BLEND"},
  {"name": "Wrong", "pbrMetallicRoughness": {"metallicFactor": 2}},
  {"name": "Pane", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}},
  {"name": "Nobody's"}]})";

std::string richFile() {
  const std::filesystem::path path = emptyFolder() / "rich.gltf";
  std::ofstream(path) << kRich;
  const std::filesystem::path kept = std::filesystem::temp_directory_path() / "lacquer_rich.gltf";
  std::filesystem::copy_file(path, kept, std::filesystem::copy_options::overwrite_existing);
  return kept.string();
}

TEST(Contract, OfAFileWithEverythingIsTheManifest) {
  compare(richFile(), forContract());
  std::filesystem::remove(richFile());
}

Contract richContract(const Options& options) {
  Messages messages;
  const Scene scene = Scene::fromMemory(kRich, "rich.gltf", options, messages);
  return contract(scene, {}, options, messages);
}

TEST(Contract, PrimitivesFindWhatTheyAreDrawnWith) {
  const Contract made = richContract(forContract());
  EXPECT_FALSE(made.ok);  // "Wrong" is
  ASSERT_EQ(made.primitives.size(), 5U);
  const Drawn leaf = made.drawn(made.primitives[0]);
  ASSERT_TRUE(leaf);
  EXPECT_EQ(leaf.material->name, "Leaf");
  EXPECT_TRUE(leaf.use->attributes.morph);
  EXPECT_FALSE(made.drawn(made.primitives[1]).use->attributes.morph);
  EXPECT_EQ(made.drawn(made.primitives[0], 1).material->name, "Ghost");
  EXPECT_EQ(made.drawn(made.primitives[0], 0).material->name, "Leaf");
  EXPECT_EQ(made.drawn(made.primitives[2]).material->index, -1);
  EXPECT_FALSE(made.drawn(made.primitives[4]));
  EXPECT_FALSE(made.drawn(7, 0));
  EXPECT_FALSE(made.drawn(0, 9));
  EXPECT_EQ(leaf.use->textures.at(0).texture, 0);
  EXPECT_EQ(leaf.use->textures.at(0).transform->rotation, 1);
  EXPECT_EQ(made.textures.at(0).sampler.min_filter, Filter::LinearMipmapNearest);
  EXPECT_EQ(made.images.at(1).mime_type, "image/ktx2");
}

/// An image node of a procedural texture says how it looks up the file's texture, whose sampler does not
/// count.
TEST(Contract, ProceduralsHaveSamplersOfTheirOwn) {
  const std::string file = R"({"asset": {"version": "2.0"},
    "images": [{"uri": "a.png"}], "samplers": [{"wrapS": 33071, "wrapT": 33071, "magFilter": 9728}],
    "textures": [{"source": 0, "sampler": 0}],
    "extensions": {"KHR_texture_procedurals": {"procedurals": [{"nodetype": "nodegraph", "type": "color3",
      "nodes": [{"nodetype": "image", "type": "color3", "inputs": {
        "file": {"nodetype": "input", "type": "filename", "texture": 0},
        "vaddressmode": {"nodetype": "input", "type": "string", "value": "mirror"}}}],
      "outputs": {"out": {"nodetype": "output", "type": "color3", "node": 0}}}]}},
    "materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
      "pbrMetallicRoughness": {"baseColorTexture": {"index": 0,
      "extensions": {"KHR_texture_procedurals": {"index": 0}}}}}]})";
  Messages messages;
  const Options options = forContract();
  const Scene scene = Scene::fromMemory(file, "file.gltf", options, messages);
  const Contract made = contract(scene, {}, options, messages);
  ASSERT_TRUE(made.ok) << messages.at(0).text;
  const TextureSampler own{Wrap::Repeat, Wrap::Mirror, Filter::Linear, Filter::Open};
  size_t found = 0;
  for (const UsedTexture& used : made.materials.at(0).uses.at(0).textures) {
    EXPECT_EQ(used.texture, 0);
    EXPECT_EQ(used.sampler.has_value(), used.slot != "emissive_texture") << used.slot;
    if (!used.sampler) continue;
    EXPECT_EQ(*used.sampler, own);
    ++found;
  }
  EXPECT_EQ(found, 1U);
  const Graph graph = scene.graph(0, {}, options, messages);
  for (const TextureUse& texture : graph.textures())
    EXPECT_EQ(texture.sampler.has_value(), texture.name != "emissive_texture") << texture.name;
  const Graph again = Graph::fromJson(graph.toJson(), "graph.json", messages);
  for (const TextureUse& texture : again.textures())
    EXPECT_EQ(texture.sampler.has_value(), texture.name != "emissive_texture") << texture.name;
}

TEST(Contract, PassesAreTheMaterialsOwnWhateverProgramsTheyShare) {
  for (const uint32_t programs : {0U, 1U}) {
    SCOPED_TRACE(programs);
    Options options = forContract();
    options.programs = programs;
    options.programs_model = true;
    const Contract made = richContract(options);
    const auto passOf = [&](const char* name) {
      for (const ContractMaterial& material : made.materials) {
        if (material.name == name) return std::string(passName(material.state.pass));
      }
      return std::string();
    };
    EXPECT_EQ(passOf("Leaf"), "masked");
    EXPECT_EQ(passOf("Ghost"), "blended");
    EXPECT_EQ(passOf("Pane"), "looks_through");
    EXPECT_EQ(made.default_material->state.pass, Pass::Opaque);
    // One that morphs, one that does not.
    EXPECT_EQ(made.shaders.size() == 2, programs == 1) << made.shaders.size();
    for (const ContractMaterial& material : made.materials)
      EXPECT_EQ(material.state.depth_write, material.name != "Ghost");
  }
  EXPECT_EQ(passName(static_cast<Pass>(77)), "");
}

/// A shared program is for one vertex stage: skins, instances and morph targets are no material's choice.
TEST(Contract, ProgramsAreSharedWithinAVertexStage) {
  const char* const file = R"({"asset": {"version": "2.0"}, "extensionsUsed": ["EXT_mesh_gpu_instancing"],
    "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
      {"componentType": 5121, "count": 3, "type": "VEC4"}, {"componentType": 5126, "count": 3, "type": "VEC4"}],
    "materials": [{}, {"alphaMode": "MASK"}, {"alphaMode": "BLEND"}, {"doubleSided": true, "alphaMode": "BLEND"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}, "material": 0},
      {"attributes": {"POSITION": 0, "NORMAL": 0}, "material": 1},
      {"attributes": {"POSITION": 0, "NORMAL": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}, "material": 2}]},
      {"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}, "material": 3}]}],
    "nodes": [{"mesh": 1, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}}]})";
  Options options = forContract();
  options.programs = 1;
  options.programs_model = true;
  Messages messages;
  const Scene scene = Scene::fromMemory(file, "file.gltf", options, messages);
  const Contract made = contract(scene, {}, options, messages);
  EXPECT_EQ(made.shaders.size(), 3U);
  EXPECT_EQ(errorsOf(messages), "");
  const bool warned = std::any_of(messages.begin(), messages.end(), [](const Message& message) {
    return message.code == "programs" && message.help.find("3 different vertex stages") != std::string::npos;
  });
  EXPECT_TRUE(warned);
  for (const ContractPrimitive& primitive : made.primitives) {
    const Drawn drawn = made.drawn(primitive);
    ASSERT_TRUE(drawn);
    const auto reads = [&](const char* name) {
      const std::vector<ShaderInput>& inputs = drawn.shader->shader.reflection().inputs;
      return std::any_of(inputs.begin(), inputs.end(),
                         [&](const ShaderInput& input) { return input.name == name; });
    };
    EXPECT_EQ(reads("JOINTS_0"), drawn.use->attributes.skin[0]);
    EXPECT_EQ(reads("TRANSLATION"), drawn.use->attributes.instances);
  }
}

/// What a material's shader alone draws, the program that it shares draws, too: it asks for what the material
/// has not.
TEST(Contract, BlocksAreThoseThatPackGives) {
  for (const uint32_t programs : {0U, 1U}) {
    Options options = forContract();
    options.programs = programs;
    options.programs_model = true;
    const Contract made = richContract(options);
    for (const ContractMaterial& material : made.materials) {
      for (const ContractUse& use : material.uses) {
        const Shader& shader = made.shaders.at(use.shader).shader;
        std::vector<std::byte> block(shader.uniformSize());
        ASSERT_TRUE(shader.pack(numbersOf(use), block));
        EXPECT_EQ(block, use.block) << material.name;
        const auto changed = [](std::string_view name, std::span<double> x) {
          if (name == "base_color_factor") x[0] = 0.25;
          return name == "base_color_factor";
        };
        ASSERT_TRUE(shader.pack(numbersOf(use, changed), block));
      }
    }
  }
}

/// Forty-nine materials of seven structures.
std::string many() {
  const char* const kKinds[] = {
      "",
      R"(, "alphaMode": "MASK")",
      R"(, "alphaMode": "BLEND")",
      R"(, "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5}})",
      R"(, "extensions": {"KHR_materials_sheen": {"sheenColorFactor": [1, 0, 0]}})",
      R"(, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}})",
      R"(, "extensions": {"KHR_materials_unlit": {}})",
  };
  std::string text = R"({"asset": {"version": "2.0"}, "materials": [)";
  for (int i = 0; i < 49; ++i) {
    text += std::string(i == 0 ? "" : ", ") + R"({"name": "m)" + std::to_string(i) +
            R"(", "pbrMetallicRoughness": {"baseColorFactor": [)" + std::to_string((i + 1) / 64.0) +
            ", 0.5, 0.5, 1], \"roughnessFactor\": 0.5}" + kKinds[i % 7] + "}";
  }
  return text + "]}";
}

TEST(Contract, MaterialsOfOneStructureAreMadeOnce) {
  const Options options = forContract();
  Messages messages;
  const Scene scene = Scene::fromMemory(many(), "many.gltf", options, messages);
  size_t made = 0;
  const Contract all =
      contract(scene, {}, options, messages, [&](size_t done, size_t) { made = std::max(made, done); });
  EXPECT_EQ(errorsOf(messages), "");
  EXPECT_EQ(all.materials.size(), 49U);
  EXPECT_EQ(all.shaders.size(), 7U);
  EXPECT_EQ(made, 7U);
  std::set<std::string> structures;
  for (size_t i = 0; i < scene.materialCount(); ++i) {
    Graph graph = scene.graph(i, kUnusedAttributes, options, messages);
    const std::string structure = graph.structure(options, messages);
    EXPECT_EQ(structure.size(), 64U);
    EXPECT_EQ(structure, all.materials[i].uses.at(0).structure) << i;
    structures.insert(structure);
    if (i < 7) continue;
    // What its elder of the same structure has generated is its own shader.
    EXPECT_EQ(graph.generate(options, messages).id(),
              all.shaders[all.materials[i % 7].uses[0].shader].shader.id());
  }
  EXPECT_EQ(structures.size(), 7U);
}

TEST(Contract, StructuresDependOnNumbersWhereThoseAreConstants) {
  Options options = forContract();
  options.parameters = Parameters::Baked;
  Messages messages;
  const Scene scene = Scene::fromMemory(many(), "many.gltf", options, messages);
  EXPECT_EQ(contract(scene, {}, options, messages).shaders.size(), 49U);
}

TEST(Contract, OfNamedMaterials) {
  Messages messages;
  const Scene scene = Scene::fromMemory(many(), "many.gltf", {}, messages);
  const Contract made = contract(scene, {"m3", "m10"}, forContract(), messages);
  EXPECT_EQ(made.materials.size(), 2U);
  EXPECT_EQ(made.shaders.size(), 1U);
  EXPECT_TRUE(made.drawn(10, 0));
  EXPECT_EQ(errorsOf(messages), "");
  EXPECT_FALSE(contract(scene, {"m3", "none"}, forContract(), messages).ok);
  EXPECT_EQ(errorsOf(messages), "no-such-material");
}

TEST(Contract, OfNothing) {
  Messages messages;
  EXPECT_FALSE(contract({}, {}, {}, messages).ok);
  EXPECT_EQ(errorsOf(messages), "empty-handle");
  messages.clear();
  Options wrong = forContract();
  wrong.relaxed = 7;
  EXPECT_FALSE(contract(paintScene(), {}, wrong, messages).ok);
  EXPECT_EQ(paintGraph().structure(wrong, messages), "");
  EXPECT_EQ(errorsOf(messages), "out-of-range out-of-range");
  messages.clear();
  Options baked = forContract();
  baked.programs = 1;
  baked.parameters = Parameters::Baked;
  EXPECT_FALSE(contract(paintScene(), {}, baked, messages).ok);
  EXPECT_EQ(errorsOf(messages), "programs-baked");
}

}  // namespace
}  // namespace lacquer::test
