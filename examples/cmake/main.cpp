// What a viewer does first: it finds the shaders that the build made. It also makes one itself, with the
// library.
#include <lacquer.h>

#include <cstdio>

int main() {
  std::FILE* manifest = std::fopen(SHADER_MANIFEST, "rb");
  if (manifest == nullptr) return std::fprintf(stderr, "%s is missing\n", SHADER_MANIFEST), 1;
  std::fclose(manifest);

  lacquer::Options options;
  options.targets = {lacquer::Target::Spirv};
  options.validate = false;
  lacquer::Messages messages;
  const lacquer::Scene scene = lacquer::Scene::fromMemory(
      R"({"asset": {"version": "2.0"}, "materials": [{"name": "made at run time"}]})", "memory", options,
      messages);
  if (!scene) return 1;
  lacquer::Graph graph = scene.graph(0, {}, options, messages);
  if (!graph) return 1;
  const lacquer::Shader shader = graph.generate(options, messages);
  if (!shader) return 1;
  std::printf("Lacquer %s, shaders in %s, and %s with %zu words\n", lacquer::version().data(),
              SHADER_MANIFEST, shader.id().c_str(), shader.fragmentSpirv().size());
  return 0;
}
