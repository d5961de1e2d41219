#include "shader/module.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "lower/lower.h"
#include "model/attributes.h"
#include "model/build.h"
#include "model/closures.h"
#include "setting/options.h"
#include "setting/simplify.h"

namespace lacquer {

passes::LightFacts lightsOf(const gltf::Scene& scene) {
  const auto count = [&](gltf::LightType type) {
    const auto it = scene.lights.find(type);
    return it == scene.lights.end() ? 0U : static_cast<uint32_t>(it->second);
  };
  return {false,
          {{"directional", count(gltf::LightType::Directional)},
           {"point", count(gltf::LightType::Point)},
           {"spot", count(gltf::LightType::Spot)},
           {"rect", count(gltf::LightType::Rect)},
           {"disk", count(gltf::LightType::Disk)}}};
}

namespace {

/// A filter that the file leaves open is linear, between mip levels as well.
ir::Sampler samplerOf(const gltf::Sampler& from) {
  constexpr int kClamp = 33071, kMirror = 33648, kNearest = 9728, kLinear = 9729, kFirstMipmap = 9984;
  const auto wrap = [](int number) {
    return number == kClamp    ? ir::Sampler::Wrap::Clamp
           : number == kMirror ? ir::Sampler::Wrap::Mirror
                               : ir::Sampler::Wrap::Repeat;
  };
  constexpr ir::Sampler::Filter kMipmaps[] = {
      ir::Sampler::Filter::NearestMipmapNearest, ir::Sampler::Filter::LinearMipmapNearest,
      ir::Sampler::Filter::NearestMipmapLinear, ir::Sampler::Filter::LinearMipmapLinear};
  ir::Sampler made{wrap(from.wrapS), wrap(from.wrapT)};
  if (from.magFilter == kNearest) made.mag = ir::Sampler::Filter::Nearest;
  if (from.minFilter == kNearest) made.min = ir::Sampler::Filter::Nearest;
  if (from.minFilter == kLinear) made.min = ir::Sampler::Filter::Linear;
  const int mipmap = from.minFilter - kFirstMipmap;
  if (mipmap >= 0 && mipmap < 4) made.min = kMipmaps[mipmap];
  return made;
}

/// Notes what nodes of patterns ask for by `given _NAME` and the primitive has.
void askAttributes(graph::Graph& graph, const gltf::VertexAttributes& attributes,
                   const graph::Graph& patterns, const lang::Library& library) {
  for (const graph::Node& node : graph.nodes) {
    const Result<const lang::NodeDecl*> decl = library.node(node.type);
    for (size_t i = 0; decl && i < (*decl)->params.size(); ++i) {
      const lang::Param& param = (*decl)->params[i];
      const bool connected = std::any_of(node.inputs.begin(), node.inputs.end(),
                                         [&](const auto& input) { return input.first == param.name; });
      if (connected || !graph::isAttributeName(param.given) || graph.hasAttribute(param.given)) continue;
      if (model::hasAttribute(attributes, param.given) || patterns.hasAttribute(param.given))
        graph.attributes.emplace_back(param.given);
    }
  }
}

}  // namespace

Result<graph::Graph> buildGraph(const material::Material& material, const gltf::VertexAttributes& attributes,
                                const Language& language, const Options& options, Diagnostics& warnings,
                                model::Origins* origins) {
  const Result<Simplification> simpler = simplificationOf(options.simplify);
  if (!simpler) return tl::make_unexpected(simpler.error());
  const Result<const model::Model*> model = language.models.of(options.profile, simpler->lods);
  if (!model) return tl::make_unexpected(model.error());
  const Result<const lang::TemplateDecl*> wanted = language.template_(options.template_name);
  if (!wanted) return tl::make_unexpected(wanted.error());
  model::BuildOptions build;
  build.template_name = options.template_name;
  build.decode_srgb = options.decode_srgb;
  build.switches = options.switches;
  build.switches.insert({{"ibl", options.ibl},
                         {"multiple_scattering", options.multiple_scattering},
                         {"dfg_table", options.dfg_table}});
  for (const std::string& name : options.live) {
    if (!name.starts_with('/')) build.live.insert(name);
    const std::optional<std::string_view> path = watchedPath(name, material.index);
    const auto terms = path ? (*model)->keeping(*path) : std::nullopt;
    if (terms) build.live.insert(terms->begin(), terms->end());
  }
  build.without = simpler->without;
  build.texels = simpler->texels;
  for (const auto& [name, value] : simpler->switches) build.switches.insert_or_assign(name, value);
  Result<graph::Graph> graph =
      model::build(**model, **wanted, withoutTextures(material, *(*model)->schema, *simpler), attributes,
                   build, warnings, origins);
  if (!graph) return graph;
  if (!graph->groups.empty()) {
    // What computes texels: a template may not give all that its nodes take.
    if (Diagnostics wrong = graph::check(*graph, language, limitsOf(options).value_or(Limits{}).nodes);
        hasError(wrong))
      return tl::make_unexpected(std::move(wrong));
    *graph = graph::flattened(std::move(*graph), language);
    askAttributes(*graph, attributes, *material.patterns, language);
    if (!material.closures.empty()) model::placeNormals(*graph, attributes, language);
  }
  simplify(*graph, language, *simpler);
  if (knowsSamplers(options)) addSamplers(*graph, &material);
  return graph;
}

void addSamplers(graph::Graph& graph, const material::Material* material) {
  for (graph::Texture& texture : graph.textures) {
    if (texture.type != ir::Type::Texture2D || texture.sampler) continue;
    if (!texture.file.empty() || texture.own_sampler) {
      const auto wrap = [&](size_t i) { return static_cast<ir::Sampler::Wrap>(texture.wrap[i]); };
      texture.sampler = ir::Sampler{wrap(0), wrap(1)};
      if (texture.nearest) texture.sampler->mag = ir::Sampler::Filter::Nearest;
      continue;
    }
    if (material == nullptr || texture.pointer.empty()) continue;
    const auto it = std::find_if(material->textures.begin(), material->textures.end(),
                                 [&](const auto& one) { return one.info.pointer == texture.pointer; });
    if (it != material->textures.end()) texture.sampler = samplerOf(it->info.sampler);
  }
}

Result<ir::Module> toModule(const graph::Graph& graph, const lang::Library& library, const Options& options,
                            const passes::LightFacts& scene_lights, const AfterPass& after,
                            const passes::Choose& choose) {
  Result<ir::Module> module = lower::lower(graph, library, loweringOf(options));
  if (!module) return module;
  if (after) after("lower", *module);
  return throughPasses(std::move(*module), {lightFacts(options, scene_lights),
                                            after,
                                            options.relaxed,
                                            optimization(options),
                                            choose,
                                            {},
                                            options.binding == BindingModel::Bindless,
                                            options.binding == BindingModel::Arrays,
                                            options.static_samplers,
                                            options.half});
}

Result<ir::Module> throughPasses(ir::Module module, const passes::PipelineOptions& options) {
  if (Diagnostics wrong = passes::checkLights(module, options.lights); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  passes::runPipeline(module, options);
  if (Diagnostics wrong = passes::checkPlaces(module); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  return module;
}

Diagnostics aboutHalf(const ir::Module& module, const Options& options) {
  if (!options.half || (module.half && module.half->used)) return {};
  return {{"half-unused",
           Severity::Note,
           {},
           module.half ? std::string("types of 16 bits save no cycles: all numbers have 32")
                       : fmt::format("nothing may be computed at half precision within an error of {}: all "
                                     "numbers have 32 bits",
                                     options.relaxed),
           module.half ? "" : "allow a greater one by `relaxed` (--relaxed)",
           {}}};
}

bool hasVertexStage(const ir::Module& module) {
  return std::any_of(module.outputs.begin(), module.outputs.end(),
                     [](const ir::Output& o) { return o.stage == ir::Stage::Vertex; });
}

bool looksThrough(const ir::Module& module) {
  return std::any_of(module.textures.begin(), module.textures.end(),
                     [](const auto& texture) { return texture.name == "scene_behind"; });
}

std::string shaderId(const ir::Module& module, const lang::Library& library) {
  return shaderId(module, library, passes::contentDigest(module));
}

/// Its middle is the outermost layer that an extension has brought, or else the innermost of all.
std::string shaderId(const ir::Module& module, const lang::Library& library, const Digest& digest) {
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module.outputs) roots.push_back(output.value);
  std::set<std::string_view> parts;
  for (const ir::ValueId id : ir::reachable(module.dag, roots)) {
    const std::string_view term = module.dag.terms()[module.dag.termOf(id)].name;
    if (const size_t point = term.find('.'); point != std::string_view::npos)
      parts.insert(term.substr(0, point));
  }
  std::string_view kind = "graph";
  for (const std::string_view name : library.names(lang::DeclKind::Layers)) {
    const Result<const lang::LayersDecl*> layers = library.layers(name);
    if (!layers || (*layers)->parts.empty()) continue;
    kind = (*layers)->parts[0];
    // From the outside inwards: a part is read only where it is there.
    for (auto part = (*layers)->parts.rbegin(); part != (*layers)->parts.rend(); ++part) {
      if (!parts.contains(*part)) continue;
      const Result<const lang::PartDecl*> decl = library.part(*part);
      if (!decl || (*decl)->of.empty()) continue;
      kind = *part;
      break;
    }
  }
  return fmt::format("{}-{}-{}", module.template_name, kind, passes::contentAddress(digest));
}

bool isShaderId(std::string_view id) {
  constexpr size_t kLongest = 255 - std::string_view(".frag.glsl").size();
  return !id.empty() && id.size() <= kLongest &&
         id.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
             std::string_view::npos;
}

}  // namespace lacquer
