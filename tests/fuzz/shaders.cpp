// glTF files and graphs through the public library: each of them to its graph, some all the way to SPIR-V.
#include <algorithm>

#include "feeds.h"

namespace lacquer::fuzz {

namespace {

/// Materials of a file that are followed: more of them are the same again.
constexpr size_t kMostMaterials = 3;
/// Of the inputs, one in so many becomes shaders, which takes ten times as long as all that is before it. The
/// oracle's targets make shaders of each.
constexpr uint64_t kShadersEvery = 8;

bool becomesShaders(std::string_view bytes) { return numberOf(bytes) % kShadersEvery == 0; }

}  // namespace

Options optionsOf(std::string_view bytes) {
  uint64_t random = numberOf(bytes, 1);
  const auto below = [&random](uint64_t n) {
    const uint64_t rest = random % n;
    random /= n;
    return rest;
  };
  Options options;
  options.targets = {Target::Spirv};
  options.validate = false;
  options.jobs = 1;
  static constexpr const char* kTemplates[] = {"forward", "forward", "surface", "bsdf"};
  options.template_name = kTemplates[below(4)];
  options.parameters = static_cast<Parameters>(below(3));
  options.permissive = below(4) == 0;
  options.decode_srgb = below(4) == 0;
  options.ibl = below(4) != 0;
  if (below(4) == 0) options.simplify = {"without:coat.absorption", "lod:coat_mean_fresnel"};
  if (below(4) == 0) options.profile = "openpbr";
  constexpr const char* kAs[] = {"", "", "gltf", "materialx"};
  options.as = kAs[below(4)];
  constexpr BindingModel kBindings[] = {BindingModel::Bindless, BindingModel::Arrays, BindingModel::Sets,
                                        BindingModel::Sets};
  options.binding = kBindings[below(4)];
  options.static_samplers = options.binding != BindingModel::Bindless && below(4) == 0;
  return options;
}

std::string errorsOf(const Messages& messages) {
  std::string text;
  for (const Message& message : messages) {
    if (message.level == Message::Level::Error) text += message.text + "\n";
  }
  return text;
}

/// Whether no device has room for what a material puts out in the template, which its graph does not say.
static bool isOverLimit(const Messages& messages) {
  return hasError(messages) && std::all_of(messages.begin(), messages.end(), [](const Message& message) {
           return message.level != Message::Level::Error || message.code == "over-limit";
         });
}

std::string feedGltf(std::string_view bytes) {
  const Options options = optionsOf(bytes);
  const bool whole = becomesShaders(bytes);
  Messages said;
  const Scene scene = Scene::fromMemory(std::string(bytes), "fuzz.gltf", options, said);
  if (!scene && !hasError(said)) return "a file is refused without an error";
  for (size_t i = 0; i < std::min(scene.materialCount(), kMostMaterials); ++i) {
    const std::vector<Attributes> uses = scene.uses(i);
    Messages messages;
    Graph graph = scene.graph(i, uses.empty() ? kUnusedAttributes : uses[0], options, messages);
    if (!graph && !hasError(messages)) return "a material is refused without an error";
    if (!graph) continue;
    messages.clear();
    if (!graph.check(messages, options))
      return "a material that is accepted has a wrong graph:\n" + errorsOf(messages);
    if (!whole) continue;
    const Shader shader = graph.generate(options, messages);
    if (!shader && isOverLimit(messages)) continue;
    if (!shader) return "a material that is accepted makes no shader:\n" + errorsOf(messages);
    if (shader.fragmentSpirv().empty()) return "a shader has no code";
  }
  return {};
}

std::string feedGraph(std::string_view bytes) {
  const Options options = optionsOf(bytes);
  Messages messages;
  Graph graph = Graph::fromJson(bytes, "fuzz.json", messages);
  if (!graph) return hasError(messages) ? "" : "a graph is refused without an error";
  const std::string json = graph.toJson();
  messages.clear();
  const Graph again = Graph::fromJson(json, "again.json", messages);
  if (!again || again.toJson() != json) return "a graph does not read back:\n" + errorsOf(messages) + json;
  messages.clear();
  if (!graph.check(messages, options)) return hasError(messages) ? "" : "a graph fails without an error";
  if (!becomesShaders(bytes)) return {};
  messages.clear();
  const Shader shader = graph.generate(options, messages);
  if (!shader && !hasError(messages)) return "a graph makes no shader, and no error";
  return {};
}

}  // namespace lacquer::fuzz
