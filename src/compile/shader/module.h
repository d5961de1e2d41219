// From a material to the module of its shader, as the options want it.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "graph/graph.h"
#include "model/shape.h"
#include "passes/pipeline.h"
#include "setting/language.h"

namespace lacquer {

passes::LightFacts lightsOf(const gltf::Scene& scene);
/// The graph of a material as the options want it: the profile, then what is to be simpler. `origins`: as of
/// model::build().
Result<graph::Graph> buildGraph(const material::Material& material, const gltf::VertexAttributes& attributes,
                                const Language& language, const Options& options, Diagnostics& warnings,
                                model::Origins* origins = nullptr);

/// Puts the samplers that are known into the graph: those of its own images, and of the file's textures by
/// the material, where there is one.
void addSamplers(graph::Graph& graph, const material::Material* material);

using AfterPass = std::function<void(std::string_view pass, const ir::Module&)>;

/// A checked graph to a placed module.
Result<ir::Module> toModule(const graph::Graph& graph, const lang::Library& library, const Options& options,
                            const passes::LightFacts& scene_lights, const AfterPass& after = {},
                            const passes::Choose& choose = {});

/// The passes over a lowered module. Errors: "unknown-light", where the template does not have the lights;
/// "slot-clash".
Result<ir::Module> throughPasses(ir::Module module, const passes::PipelineOptions& options);

/// Says where Options::half has no effect on a module: the note "half-unused".
Diagnostics aboutHalf(const ir::Module& module, const Options& options);

/// True when the module has something to draw with at vertices.
bool hasVertexStage(const ir::Module& module);

/// True when it reads scene_behind: a picture of what was drawn before it.
bool looksThrough(const ir::Module& module);

/// "forward-coat-" and 32 hexadecimal digits.
std::string shaderId(const ir::Module& module, const lang::Library& library);
/// The same where passes::contentDigest() is known.
std::string shaderId(const ir::Module& module, const lang::Library& library, const Digest& digest);
/// True for what shaderId() may give: an id from elsewhere is asked for this before it becomes part of a
/// path.
bool isShaderId(std::string_view id);

}  // namespace lacquer
