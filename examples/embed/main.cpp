// Lacquer as a library: load a file, build a material's graph, edit it, print its shader. All in memory.
#include <lacquer.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: embed FILE.gltf\n"), 2;
  lacquer::Options options;
  options.targets = {lacquer::Target::Glsl};
  lacquer::Messages messages;

  lacquer::Graph graph;
  if (const lacquer::Scene scene = lacquer::Scene::load(argv[1], options, messages)) {
    lacquer::Attributes attributes;
    attributes.texCoord[0] = true;
    if (scene.materialCount() > 0) graph = scene.graph(0, attributes, options, messages);
  }
  if (graph) {
    // The base glows a little, in the colour of its diffuse part.
    graph.addNode("glow", "occluded", messages);
    graph.connect("glow", "light", R"({"node": "base.reflectance", "output": "diffuse"})", messages);
    graph.setParameter("glow_amount", {0.1}, messages);
    graph.connect("glow", "visible", R"({"parameter": "glow_amount"})", messages);
    graph.setOutput("emission", R"({"node": "glow"})", messages);

    const lacquer::Shader shader = graph.generate(options, messages);
    if (shader) std::fputs(shader.fragmentText(lacquer::Target::Glsl).c_str(), stdout);
  }
  for (const lacquer::Message& message : messages) std::fprintf(stderr, "%s\n", message.text.c_str());
  return lacquer::hasError(messages) ? 1 : 0;
}
