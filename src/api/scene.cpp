#include <fmt/format.h>

#include "api/internal.h"
#include "passes/pipeline.h"
#include "support/file.h"

namespace lacquer {

Result<gltf::Document> readDocument(const std::string& path, const Options& options) {
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return tl::make_unexpected(limits.error());
  const Result<std::string> bytes = readFile(path, limits->file);
  if (!bytes) return tl::make_unexpected(bytes.error());
  return gltf::readText(*bytes, path, {options.permissive, *limits});
}

Scene Scene::load(const std::string& path, const Options& options, Messages& messages) {
  Scene scene;
  Result<gltf::Document> document = readDocument(path, options);
  if (!document) {
    report(document.error(), path, messages);
    return scene;
  }
  report(document->diagnostics, path, messages);
  scene.impl_ = std::make_shared<Impl>(Impl{std::move(*document)});
  return scene;
}

Scene Scene::fromMemory(const std::string& bytes, const std::string& name, const Options& options,
                        Messages& messages) {
  Scene scene;
  const Result<Limits> limits = limitsOf(options);
  Result<gltf::Document> document = limits ? gltf::readText(bytes, name, {options.permissive, *limits})
                                           : tl::make_unexpected(limits.error());
  if (!document) {
    report(document.error(), name, messages);
    return scene;
  }
  report(document->diagnostics, name, messages);
  scene.impl_ = std::make_shared<Impl>(Impl{std::move(*document)});
  return scene;
}

size_t Scene::materialCount() const { return impl_->document.materials.size(); }

const std::string& Scene::materialName(size_t material) const {
  return impl_->document.materials[material].name;
}

std::vector<Attributes> Scene::uses(size_t material) const {
  std::vector<Attributes> uses;
  for (const gltf::VertexAttributes& a : impl_->document.uses[material]) {
    uses.push_back({a.normal, a.tangent, a.color0, a.texCoord});
  }
  return uses;
}

Graph Scene::graph(size_t material, const Attributes& attributes, const Options& options,
                   Messages& messages) const {
  Graph result;
  const gltf::Material& m = impl_->document.materials[material];
  report(m.diagnostics, impl_->document.path, messages);
  if (lacquer::hasError(m.diagnostics)) return result;
  if (const Diagnostics wrong = checkOptions(options); !wrong.empty()) {
    report(wrong, {}, messages);
    return result;
  }
  Diagnostics warnings;
  const gltf::VertexAttributes a{attributes.normal, attributes.tangent, attributes.color0,
                                 attributes.texCoord};
  graph::Graph graph = buildGraph(m, a, options, warnings);
  report(warnings, impl_->document.path, messages);
  result.impl_ = std::make_shared<Graph::Impl>(
      Graph::Impl{std::move(graph), impl_->document.path, lightsOf(impl_->document)});
  return result;
}

Graph Graph::fromJson(std::string_view text, const std::string& name, Messages& messages) {
  Graph result;
  Result<graph::Graph> graph = graph::fromJson(text, name);
  if (!graph) {
    report(graph.error(), name, messages);
    return result;
  }
  result.impl_ = std::make_shared<Impl>(Impl{std::move(*graph), name, {}});
  return result;
}

std::string Graph::toJson() const { return graph::toJson(impl_->graph); }
std::string Graph::toDot() const { return graph::toDot(impl_->graph); }

bool Graph::addNode(const std::string& id, const std::string& type) {
  if (impl_->graph.find(id) != nullptr) return false;
  impl_->graph.add(id, type);
  return true;
}

bool Graph::removeNode(const std::string& id) { return impl_->graph.remove(id); }

bool Graph::connect(const std::string& node, const std::string& input, std::string_view source) {
  graph::Node* found = impl_->graph.find(node);
  if (found == nullptr) return false;
  const Result<graph::Source> parsed = graph::sourceFromJson(source);
  if (!parsed) return false;
  graph::Graph::connect(*found, input, *parsed);
  return true;
}

bool Graph::setOutput(const std::string& port, std::string_view source) {
  const Result<graph::Source> parsed = graph::sourceFromJson(source);
  if (!parsed) return false;
  for (auto& [name, value] : impl_->graph.outputs) {
    if (name != port) continue;
    value = *parsed;
    return true;
  }
  impl_->graph.outputs.emplace_back(port, *parsed);
  return true;
}

bool Graph::setParameter(const std::string& name, const std::vector<double>& value) {
  if (value.empty() || value.size() > 4) return false;
  ir::Components components{};
  std::copy(value.begin(), value.end(), components.begin());
  const ir::Type type = ir::floatType(static_cast<int>(value.size()));
  if (ir::Parameter* parameter = impl_->graph.findParameter(name)) {
    if (parameter->type != type) return false;
    parameter->value = components;
    return true;
  }
  impl_->graph.parameters.push_back({name, type, components, {}, {}});
  return true;
}

bool Graph::check(Messages& messages, const Options& options) {
  const auto library = libraryFor(options);
  if (!library) {
    report(library.error(), {}, messages);
    return false;
  }
  const Diagnostics found = graph::check(impl_->graph, **library);
  report(found, impl_->file, messages);
  return !lacquer::hasError(found);
}

Shader Graph::generate(const Options& options, Messages& messages) {
  Shader shader;
  if (const Diagnostics wrong = checkOptions(options); !wrong.empty()) {
    report(wrong, impl_->file, messages);
    return shader;
  }
  if (!check(messages, options)) return shader;
  Result<ir::Module> module = toModule(impl_->graph, **libraryFor(options), options, impl_->scene_lights);
  if (!module) {
    report(module.error(), impl_->file, messages);
    return shader;
  }
  auto impl = std::make_shared<Shader::Impl>();
  impl->id = shaderId(*module);
  impl->has_vertex = lacquer::hasVertexStage(*module);
  impl->interface = interfaceJson(*module, impl->has_vertex);
  impl->preshader = Preshader(*module);
  impl->module = std::move(*module);
  Wrong wrong;
  print(*impl, options, wrong);
  for (const Diagnostics& of_target : wrong) report(of_target, impl_->file, messages);
  shader.impl_ = std::move(impl);
  return shader;
}

std::string Graph::dump(const Options& options, std::string_view pass, Messages& messages) {
  if (!check(messages, options)) return {};
  std::string text;
  const auto keep = [&](std::string_view name, const ir::Module& module) {
    if (pass.empty() || name == pass) text = ir::dump(module);
  };
  const Result<ir::Module> module =
      toModule(impl_->graph, **libraryFor(options), options, impl_->scene_lights, keep);
  if (!module) report(module.error(), impl_->file, messages);
  return text;
}

}  // namespace lacquer
