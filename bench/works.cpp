#include "bench/works.h"

#include "check/check.h"

namespace lacquer::bench {

const std::vector<Work> kWorks = {
    {"W0L", "w0.gltf", false, "base, no IBL", {88, 156}},
    {"W0", "w0.gltf", true, "base", {173, 297}},
    {"W1L", "w1.gltf", false, "clearcoat, no IBL", {109, 196}},
    {"W1", "w1.gltf", true, "clearcoat", {200, 346}},
    {"W1off", "w1off.gltf", true, "clearcoat of factor 0", {173, 297}},
    {"W2", "w2.gltf", true, "clearcoat, six textures", {320, 522}},
    {"W3L", "w3.gltf", false, "all of coat, no IBL", {312, 549}},
    {"W3", "w3.gltf", true, "all of coat", {522, 1009}},
    {"AL", "a.gltf", false, "specular, IOR, sheen, no IBL", {178, 262}},
    {"A", "a.gltf", true, "specular, IOR, sheen", {290, 440}},
    {"BL", "b.gltf", false, "transmission, volume, clearcoat, no IBL", {230, 390}},
    {"B", "b.gltf", true, "transmission, volume, clearcoat", {325, 540}},
    {"CL", "c.gltf", false, "anisotropy, iridescence, specular, no IBL", {370, 680}},
    {"C", "c.gltf", true, "anisotropy, iridescence, specular", {520, 940}},
};

namespace {

void complain(const Work& work, const std::string& text, Messages& messages) {
  Message message;
  message.code = "work";
  message.file = work.file;
  message.message = text;
  message.text = work.file + ": error: " + text;
  messages.push_back(message);
}

/// What a peer's shader went through. The module is emptied on an error.
void optimize(const Work& work, cost::Spirv& words, Messages& messages) {
  Result<cost::Spirv> optimized = check::optimize(words, work.file);
  if (!optimized) complain(work, format(optimized.error()[0]), messages);
  words = optimized ? std::move(*optimized) : cost::Spirv();
}

}  // namespace

cost::Subject build(const Work& work, const std::string& folder, bool multiple_scattering, Route route,
                    Messages& messages) {
  Options options;
  options.targets = {Target::Spirv};
  options.lights.mode = Lights::Mode::Fixed;
  options.lights.counts = {{"directional", 1}};
  options.ibl = work.ibl;
  options.multiple_scattering = multiple_scattering;
  options.validate = false;
  options.spirv_route = route == Route::Direct ? SpirvRoute::Direct : SpirvRoute::Glslang;
  cost::Subject subject;
  subject.name = work.name;
  const Scene scene = Scene::load(folder + "/" + work.file, options, messages);
  if (!scene || scene.materialCount() != 1 || scene.uses(0).size() != 1) {
    complain(work, "a work has one material and one primitive", messages);
    return subject;
  }
  Graph graph = scene.graph(0, scene.uses(0)[0], options, messages);
  const Shader shader = graph ? graph.generate(options, messages) : Shader();
  if (!shader) return subject;
  subject.vertex = shader.vertexSpirv();
  subject.fragment = shader.fragmentSpirv();
  if (route == Route::Optimized) {
    optimize(work, subject.vertex, messages);
    optimize(work, subject.fragment, messages);
  }
  return subject;
}

Table measureWorks(const std::string& folder, bool multiple_scattering, Route route,
                   const std::vector<std::string>& families, Messages& messages) {
  Table table;
  std::vector<cost::Subject> subjects;
  for (const Work& work : kWorks) {
    subjects.push_back(build(work, folder, multiple_scattering, route, messages));
    table.rows.push_back({cost::spirvInstructions(subjects.back().fragment), {}});
  }
  if (hasError(messages)) return table;
  for (const std::string& family : families) {
    cost::Measurement measurement = cost::measure(subjects, family, false);
    table.driver = measurement.driver;
    for (size_t i = 0; i < subjects.size(); ++i) {
      const cost::Outcome& outcome = measurement.outcomes[i];
      if (!outcome.statistics) complain(kWorks[i], family + ": " + outcome.problem, messages);
      table.rows[i].gpus[family] = outcome;
    }
  }
  return table;
}

}  // namespace lacquer::bench
