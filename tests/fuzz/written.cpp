// What is written for other tools, from any file: it is read again, and says the same.
#include "feeds.h"
#include "lacquer/exchange.h"

namespace lacquer::fuzz {

namespace {

/// Names of materials, each on a line.
std::string namesOf(const Scene& scene) {
  std::string names;
  for (size_t i = 0; i < scene.materialCount(); ++i) names += scene.materialName(i) + "\n";
  return names;
}

/// How many materials have a graph.
size_t goodMaterials(const Scene& scene) {
  size_t count = 0;
  for (size_t i = 0; i < scene.materialCount(); ++i) {
    Messages said;
    if (scene.graph(i, kUnusedAttributes, {}, said)) ++count;
  }
  return count;
}

/// The document as `as` reads it, written and read again.
std::string documentOut(std::string_view bytes, std::string_view as) {
  Messages said;
  Options options;
  options.as = as;
  const Scene scene = Scene::fromMemory(std::string(bytes), "fuzz.mtlx", options, said);
  if (!scene) return hasError(said) ? "" : "a file is refused without an error";
  said.clear();
  const std::string text = toMaterialX(scene, {}, {}, {}, {}, said);
  if (text.empty()) return hasError(said) ? "" : "nothing is written, without an error";
  said.clear();
  const Scene again = Scene::fromMemory(text, "written.mtlx", options, said);
  if (!again) return "what is written is not read:\n" + errorsOf(said) + text;
  // A document with MaterialX's own surfaces is written with what is wrong in it.
  const size_t good = as == "gltf" ? again.materialCount() : goodMaterials(scene);
  if (goodMaterials(again) < good) return "a material that is written is wrong:\n" + errorsOf(said) + text;
  said.clear();
  const std::string second = toMaterialX(again, {}, {}, {}, {}, said);
  return second.empty() ? "what is read again is not written:\n" + errorsOf(said) + text : "";
}

}  // namespace

std::string feedDocumentOut(std::string_view bytes) {
  const std::string translated = documentOut(bytes, "gltf");
  return translated.empty() ? documentOut(bytes, "materialx") : translated;
}

std::string feedProceduralsOut(std::string_view bytes) {
  Options options;
  options.jobs = 1;
  Messages said;
  const bool document = bytes.find('<') < bytes.find('{');
  const Scene scene =
      Scene::fromMemory(std::string(bytes), document ? "fuzz.mtlx" : "fuzz.gltf", options, said);
  if (!scene) return hasError(said) ? "" : "a file is refused without an error";
  said.clear();
  const std::string text = toGltf(scene, {}, 1, options, said);
  if (text.empty()) return hasError(said) ? "" : "nothing is written, without an error";
  said.clear();
  const Scene again = Scene::fromMemory(text, "written.gltf", options, said);
  if (!again) return "what is written is not read:\n" + errorsOf(said) + text;
  if (document && goodMaterials(again) != again.materialCount())
    return "a material that is written is wrong:\n" + errorsOf(said) + text;
  if (!document && namesOf(again) != namesOf(scene)) return "the materials are others:\n" + text;
  return {};
}

}  // namespace lacquer::fuzz
