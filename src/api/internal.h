// What the public classes hold, and the steps between them.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "api/language.h"
#include "api/preshader.h"
#include "api/times.h"
#include "lacquer.h"
#include "lang/library.h"
#include "lower/lower.h"
#include "material/material.h"
#include "model/build.h"
#include "passes/pipeline.h"
#include "support/limits.h"

namespace lacquer {

Message toMessage(const Diagnostic& diagnostic);
/// Appends, filling in `file` where a diagnostic has none.
void report(const Diagnostics& diagnostics, const std::string& file, Messages& messages);
Diagnostic toDiagnostic(const Message& message);

/// The node files of a folder, sorted by name.
Result<std::vector<lang::SourceFile>> nodeFiles(const std::string& folder);

using AfterPass = std::function<void(std::string_view pass, const ir::Module&)>;

struct Graph::Impl {
  graph::Graph graph;
  std::string file;  ///< for messages
  passes::LightFacts scene_lights;

  /// Checks the options and the graph, lowers it and runs the passes.
  Result<ir::Module> module(const Options& options, Diagnostics (*check)(const Options&),
                            const AfterPass& after = {});
  bool refuse(std::string code, std::string message, std::string help, Messages& messages) const;
  std::optional<graph::Source> source(std::string_view text, Messages& messages) const;
};

struct Scene::Impl {
  material::Document document;
  std::shared_ptr<const Language> language;  ///< whose declarations the materials follow
};

inline constexpr size_t kTargetCount = static_cast<size_t>(Target::Cpp) + 1;

/// One distinct shader.
struct ShaderData {
  ir::Module module;  ///< placed and bound
  std::string id;
  bool has_vertex = false;
  std::string text[kTargetCount]
                  [2];  ///< by target, by stage; Target::Cpp's one file stands with the fragments
  std::vector<uint32_t> spirv[2];
  std::string interface;
};

struct Shader::Impl : ShaderData {
  Preshader preshader;
};

/// Puts the library's defaults in where no template or no profile is named.
Result<void> resolveNames(const lang::Library& library, Options& options);
passes::LightFacts lightFacts(const Options& options, const passes::LightFacts& scene);
passes::LightFacts lightsOf(const gltf::Scene& scene);
/// The graph of a material as the options want it: the profile, then the variants that the budget allows.
Result<graph::Graph> buildGraph(const material::Material& material, const gltf::VertexAttributes& attributes,
                                const Language& language, const Options& options, Diagnostics& warnings);

/// A checked graph to a placed module.
Result<ir::Module> toModule(const graph::Graph& graph, const lang::Library& library, const Options& options,
                            const passes::LightFacts& scene_lights, const AfterPass& after = {});

/// The passes over a lowered module. Errors: "unknown-light", where the template does not have the lights;
/// "slot-clash".
Result<ir::Module> throughPasses(ir::Module module, const passes::PipelineOptions& options);

/// "forward-coat-0123456789abcdef"
std::string shaderId(const ir::Module& module, const lang::Library& library);

/// What is wrong with the code of each target.
using Wrong = std::array<Diagnostics, kTargetCount>;

/// Prints every target that the options name, and compiles and validates them when asked. Validation failures
/// go to `wrong`; the code is there all the same.
void print(ShaderData& shader, const Options& options, Wrong& wrong, StageTimes* times = nullptr);

/// The shader's entry in the manifest, without "files" and "validated".
std::string interfaceJson(const ir::Module& module, bool has_vertex, const material::Schema* schema);

/// The first of the stages, 0 or 1, that have a file; the last is 1. Target::Cpp has one file.
inline int firstStage(Target target, bool has_vertex) { return has_vertex && target != Target::Cpp ? 0 : 1; }

/// Some compiler or validator checks the target's code.
inline bool hasValidator(Target target) { return target != Target::Cpp; }

/// What inputs may be at most, with the options' changes. Errors: those of setLimit().
Result<Limits> limitsOf(const Options& options);

/// An error for every output that is one of the inputs, which must not be written then, or another output.
Diagnostics clashes(const Strings& inputs, const Strings& outputs);

/// What is wrong with the options that a graph and its module depend on; empty when all is well.
Diagnostics checkReading(const Options& options);
/// The same, and what is wrong with the targets.
Diagnostics checkOptions(const Options& options);

/// "out-of-range" where a number of an argument is.
Result<void> inRange(std::string_view what, uint64_t value, uint64_t least, uint64_t most,
                     std::string_view unit);
/// "no-path" where a file or folder to write has no name: it would be the root of the file system, or
/// nothing.
Result<void> hasPath(std::string_view what, const std::string& path);
/// "empty-handle" where there is nothing behind a handle.
bool filled(const void* impl, std::string_view what, Messages& messages);

/// Scene::findMaterial().
Result<size_t> findMaterial(const material::Document& document, const std::optional<std::string>& name,
                            Diagnostics& warnings);

lower::ParameterMode parameterMode(const Options& options);

/// True for what shaderId() may give: an id from elsewhere is asked for this before it becomes part of a
/// path.
bool isShaderId(std::string_view id);
/// The path below the output folder: "glsl/ID.frag.glsl", "cpp/ID.h".
std::string shaderPath(Target target, const std::string& id, int stage);

/// True when the module has something to draw with at vertices.
bool hasVertexStage(const ir::Module& module);

}  // namespace lacquer
