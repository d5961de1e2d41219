// What the public classes hold.
#pragma once

#include <memory>
#include <optional>

#include "eval/in_memory.h"
#include "lacquer.h"
#include "material/material.h"
#include "setting/language.h"
#include "shader/module.h"
#include "shader/preshader.h"
#include "shader/print.h"

namespace lacquer {

struct Graph::Impl {
  graph::Graph graph;
  std::string file;                          ///< its name, or that of the glTF file that it was built from
  std::shared_ptr<const Language> language;  ///< that edits are checked against
  Limits limits;
  passes::LightFacts scene_lights{};
  ImagesOf images = ImagesOf::Nothing;
  std::shared_ptr<const std::string> bytes{};  ///< the file's, where it was read from memory

  Strings built_with{};  ///< words of Options::simplify that the graph was built with: they hold already

  /// What the last generation was given, and what was edited since.
  struct Made {
    Options options;
    std::shared_ptr<const Language> language;
    std::string key;  ///< graph::programKey()
    graph::Graph graph;
    bool numbers = false;    ///< values of parameters were set
    bool structure = false;  ///< anything else was edited
  };
  std::optional<Made> made{};
  /// For each parameter what it may be; empty after an edit of anything but numbers.
  std::vector<ir::Range> may_be{};

  /// Makes an edit; false, and messages, on an error.
  template <class Edit>
  bool edit(Messages& messages, const Edit& edit);
  void edited();

  /// The checked graph, flat and simplified as the options want it.
  Result<graph::Graph> flat(const Options& options, const lang::Library& library) const;
  /// What a module is made of, checked.
  struct Prepared {
    std::shared_ptr<const Language> language;
    graph::Graph flat;
  };
  Result<Prepared> prepared(const Options& options, Diagnostics (*check)(const Options&)) const;
  /// Lowers it and runs the passes.
  Result<ir::Module> module(const Prepared& of, const Options& options, const AfterPass& after = {}) const;
};

/// A file's materials, and what they were read from.
struct SceneData {
  material::Document document;
  std::shared_ptr<const Language> language;  ///< whose declarations the materials follow
  std::shared_ptr<const std::string> bytes;  ///< the file's, where it was read from memory
  Options options;                           ///< that it was read with

  /// Reads a file; nothing, and messages, on an error.
  static std::optional<SceneData> load(const std::string& path, const Options& options, Messages& messages);

  /// Reads a file's bytes by the language and the options.
  Result<void> read(const std::string& of, const std::string& name);
  /// Whether surfaces of a MaterialX document are closures that glTF's properties may stand for.
  bool hasOwnFormulas() const;
  /// The file's bytes.
  Result<std::string> text() const;
  /// Texts of the files that it includes; null where they are read.
  const std::vector<std::pair<std::string, std::string>>* included() const;
  /// The same with its surfaces as glTF's properties; a message where it cannot be read so.
  std::optional<SceneData> translated(Messages& messages) const;
};

struct Scene::Impl : SceneData {
  explicit Impl(SceneData data) : SceneData(std::move(data)) {}
  Impl() = default;

  /// A material of that index; null, and "no-such-material", when there is none.
  const material::Material* material(size_t index, Messages& messages) const;
};

struct Shader::Impl : ShaderData {
  Preshader preshader;
  Reflection reflection;
  std::string entry;              ///< the same in the manifest
  bool argument_buffers = false;  ///< of its MSL

  /// Writes the whole of `block`, which has as many bytes as the material's.
  void pack(const Values& value, std::span<std::byte> block, Messages* messages) const;
};

struct ShaderMaker {
  /// A shader of what was printed. `schema`: whose prose says what the parameters are; may be null.
  static Shader make(ShaderData data, const material::Schema* schema, const Options& options);
  static bool argumentBuffers(const Shader& shader) { return shader.impl().argument_buffers; }
  /// The bytes of a stage's file.
  static std::string_view code(const Shader& shader, Target target, int stage);
};

/// "empty-handle" where there is nothing behind a handle.
bool filled(const void* impl, std::string_view what, Messages& messages);

}  // namespace lacquer
