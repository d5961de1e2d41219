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
  std::string file;  ///< its name, or that of the glTF file that it was built from
  passes::LightFacts scene_lights;
  ImagesOf images = ImagesOf::Nothing;
  std::shared_ptr<const std::string> bytes;  ///< the file's, where it was read from memory

  /// The checked graph, flat and simplified as the options want it.
  Result<graph::Graph> flat(const Options& options, const lang::Library& library) const;
  /// Checks the options and the graph, lowers it and runs the passes.
  Result<ir::Module> module(const Options& options, Diagnostics (*check)(const Options&),
                            const AfterPass& after = {}) const;
  bool refuse(std::string code, std::string message, std::string help, Messages& messages) const;
  std::optional<graph::Source> source(std::string_view text, Messages& messages) const;
};

struct Scene::Impl {
  material::Document document;
  std::shared_ptr<const Language> language;  ///< whose declarations the materials follow
  std::shared_ptr<const std::string> bytes;  ///< the file's, where it was read from memory

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
};

/// "empty-handle" where there is nothing behind a handle.
bool filled(const void* impl, std::string_view what, Messages& messages);

}  // namespace lacquer
