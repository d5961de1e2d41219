// How a renderer binds a shader without reading JSON: what is said here is what it does with OpenGL. The
// numbers for Vulkan, HLSL, WGSL and MSL stand beside those in lacquer/reflection.h.
#include <lacquer.h>

#include <cstdio>
#include <vector>

namespace {

const char* contentsOf(lacquer::BlockRole role) {
  switch (role) {
    case lacquer::BlockRole::Frame: return "the camera, once for a picture";
    case lacquer::BlockRole::Lights: return "the scene's lights";
    case lacquer::BlockRole::Material: return "what pack() makes, once for a material";
    case lacquer::BlockRole::Object: return "the object's matrices, for each object";
    case lacquer::BlockRole::List: return "a list that the template reads";
  }
  return "";
}

/// The file's texture behind a slot; -1 for none.
int textureOf(const lacquer::Graph& graph, const std::string& slot) {
  for (const lacquer::TextureUse& use : graph.textures())
    if (use.name == slot) return use.texture;
  return -1;
}

void bind(const lacquer::Graph& graph, const lacquer::Shader& shader) {
  const lacquer::Reflection& reflection = shader.reflection();
  std::printf("%s\n", shader.id().c_str());
  for (const lacquer::ShaderInput& input : reflection.inputs)
    std::printf("attribute %u: %s, %s\n", input.location, input.name.c_str(), input.type.c_str());
  for (const lacquer::UniformBlock& block : reflection.blocks) {
    const unsigned bytes = block.array > 1 ? block.array * block.size : block.size;
    std::printf("%s %u: %s, %u bytes%s: %s\n", block.list.empty() ? "buffer" : "storage buffer",
                block.at.flat, block.name.c_str(), bytes, block.list.empty() ? "" : " each",
                contentsOf(block.role));
  }
  for (const lacquer::ReflectedTexture& texture : reflection.textures) {
    std::printf("unit %u: %s, ", texture.at.flat, texture.name.c_str());
    if (texture.role == lacquer::TextureRole::Material)
      std::printf("textures[%d] of the file%s\n", textureOf(graph, texture.slot),
                  texture.srgb ? ", sRGB" : "");
    else
      std::printf("the scene's\n");
  }
  for (const lacquer::ShaderOutput& output : reflection.outputs)
    std::printf("colour %u: %s\n", output.location, output.name.c_str());

  std::vector<std::byte> block(shader.uniformSize());
  if (!shader.pack({}, block)) return;
  std::printf("the material's block, which goes into its buffer:");
  for (size_t i = 0; i < block.size(); ++i)
    std::printf("%s%02x", i % 16 == 0 ? "\n " : i % 4 == 0 ? " " : "", std::to_integer<unsigned>(block[i]));
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: bind FILE.gltf\n"), 2;
  lacquer::Options options;
  options.targets = {lacquer::Target::GlslGl};
  lacquer::Messages messages;
  const lacquer::Scene scene = lacquer::Scene::load(argv[1], options, messages);
  for (size_t i = 0; i < scene.materialCount(); ++i) {
    for (const lacquer::Attributes& attributes : scene.uses(i)) {
      lacquer::Graph graph = scene.graph(i, attributes, options, messages);
      if (const lacquer::Shader shader = graph.generate(options, messages)) bind(graph, shader);
    }
  }
  for (const lacquer::Message& message : messages) std::fprintf(stderr, "%s\n", message.text.c_str());
  return lacquer::hasError(messages) ? 1 : 0;
}
