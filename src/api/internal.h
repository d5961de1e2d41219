// What the public classes hold, and the steps between them.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "api/preshader.h"
#include "api/times.h"
#include "gltf/material.h"
#include "graph/build.h"
#include "lacquer.h"
#include "lang/library.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "support/limits.h"

namespace lacquer {

Message toMessage(const Diagnostic& diagnostic);
/// Appends, filling in `file` where a diagnostic has none.
void report(const Diagnostics& diagnostics, const std::string& file, Messages& messages);
Diagnostic toDiagnostic(const Message& message);

/// The node files of a folder, sorted by name.
Result<std::vector<lang::SourceFile>> nodeFiles(const std::string& folder);

/// The built-in library with the options' folders added. The built-in one alone is made once.
Result<std::shared_ptr<const lang::Library>> libraryFor(const Options& options);

struct Graph::Impl {
  graph::Graph graph;
  std::string file;  ///< for messages
  passes::LightFacts scene_lights;
};

struct Scene::Impl {
  gltf::Document document;
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

passes::LightFacts lightFacts(const Options& options, const passes::LightFacts& scene);
passes::LightFacts lightsOf(const gltf::Document& document);
/// The graph of a material as the options want it: the profile, then the variants that the budget allows.
graph::Graph buildGraph(const gltf::Material& material, const gltf::VertexAttributes& attributes,
                        const Options& options, Diagnostics& warnings);

/// A checked graph to a placed module.
Result<ir::Module> toModule(const graph::Graph& graph, const lang::Library& library, const Options& options,
                            const passes::LightFacts& scene_lights,
                            const std::function<void(std::string_view, const ir::Module&)>& after = {});

/// "forward-coat-0123456789abcdef"
std::string shaderId(const ir::Module& module);

/// What is wrong with the code of each target.
using Wrong = std::array<Diagnostics, kTargetCount>;

/// Prints every target that the options name, and compiles and validates them when asked. Validation failures
/// go to `wrong`; the code is there all the same.
void print(ShaderData& shader, const Options& options, Wrong& wrong, StageTimes* times = nullptr);

/// The shader's entry in the manifest, without "files" and "validated".
std::string interfaceJson(const ir::Module& module, bool has_vertex);

/// The first of the stages, 0 or 1, that have a file; the last is 1. Target::Cpp has one file.
inline int firstStage(Target target, bool has_vertex) { return has_vertex && target != Target::Cpp ? 0 : 1; }

/// Some compiler or validator checks the target's code.
inline bool hasValidator(Target target) { return target != Target::Cpp; }

/// What inputs may be at most, with the options' changes. Errors: those of setLimit().
Result<Limits> limitsOf(const Options& options);
/// A glTF file as the options want it read. Errors: those of limitsOf(), readFile() and gltf::readText().
Result<gltf::Document> readDocument(const std::string& path, const Options& options);

/// An error for every output that is one of the inputs, which must not be written then, or another output.
Diagnostics clashes(const Strings& inputs, const Strings& outputs);

/// What the options ask for and cannot be had together; empty when all is well.
Diagnostics checkOptions(const Options& options);

lower::ParameterMode parameterMode(const Options& options);

/// True for what shaderId() may give: an id from elsewhere is asked for this before it becomes part of a
/// path.
bool isShaderId(std::string_view id);
/// The path below the output folder: "glsl/ID.frag.glsl", "cpp/ID.h".
std::string shaderPath(Target target, const std::string& id, int stage);

/// True when the module has something to draw with at vertices.
bool hasVertexStage(const ir::Module& module);

}  // namespace lacquer
